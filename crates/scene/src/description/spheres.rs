//! Rows of spheres, of which whole figures are built (Eric Graham's Juggler, 1986; Michael
//! Birken's, 2010).
//!
//! ```json
//! {"chain": {
//!   "from": {"center": [0, 0, 0], "radius": 16},
//!   "to": {"center": [0, 32, 0], "radius": 20},
//!   "count": 8}}
//! ```

use super::{Bones, PlacementError, positive_items};
use juggler_math::{DVec3, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sphere at one end of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ControlSphere {
    /// Center, in object space.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub center: Vec3,
    /// Radius, in units of object space.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub radius: f32,
}

impl ControlSphere {
    /// Creates a sphere of a center and a radius.
    pub fn new(center: impl Into<Vec3>, radius: f32) -> Self {
        Self { center: center.into(), radius }
    }
}

/// Spheres in a row, with centers and radii interpolated linearly.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Chain {
    /// First sphere.
    pub from: ControlSphere,
    /// Sphere at the other end.
    pub to: ControlSphere,
    /// Number of spheres.
    #[schemars(range(min = 1, max = 100_000))]
    pub count: u32,
    /// Whether the row includes the sphere `to`. With `false`, it ends one step before, so that the
    /// next chain can begin there without a duplicate sphere.
    #[serde(default = "yes")]
    pub include_last: bool,
}

fn yes() -> bool {
    true
}

/// Arm or leg: spheres along two bones that meet in a joint.
///
/// The limb bends from the line between its ends toward the direction of the cross product
/// (to − from) × `plane_normal`. The distance between the ends must not exceed the sum of the
/// lengths, nor fall below their difference.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Limb {
    /// One end, in object space: a hand or a foot.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub from: Vec3,
    /// Other end, in object space: a shoulder or a hip.
    #[schemars(with = "[f32; 3]", extend("x-unit" = "scene units"))]
    pub to: Vec3,
    /// Lengths of the bones at `from` and at `to`.
    #[schemars(transform = positive_items, extend("x-unit" = "scene units"))]
    pub lengths: [f32; 2],
    /// Normal of the plane in which the limb bends, in the space of `from` and `to`. It has any
    /// length except zero and must not be parallel to `to − from`.
    #[schemars(with = "[f32; 3]")]
    pub plane_normal: Vec3,
    /// Number of spheres on the bones at `from` and at `to`; the joint has one more sphere.
    #[serde(default = "eight")]
    #[schemars(inner(range(min = 1, max = 100_000)))]
    pub counts: [u32; 2],
    /// Whether the bones keep their lengths if `plane_normal` is not perpendicular to `to − from`.
    /// With `false`, the joint moves closer to the line between the ends, as in the Juggler of
    /// 2010, whose forearms are up to 1 % too short.
    #[serde(default = "yes")]
    pub keep_lengths: bool,
    /// Radii at `from`, at the joint and at `to`, interpolated linearly in between.
    #[schemars(transform = positive_items, extend("x-unit" = "scene units"))]
    pub radii: [f32; 3],
}

fn eight() -> [u32; 2] {
    [8, 8]
}

/// Sphere of a chain or a limb, in object space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainSphere {
    /// Center.
    pub center: Vec3,
    /// Radius.
    pub radius: f32,
}

impl Chain {
    /// Creates a row of spheres that includes both ends.
    pub fn new(from: ControlSphere, to: ControlSphere, count: u32) -> Self {
        Self { from, to, count, include_last: true }
    }

    /// Spheres of the chain.
    pub fn spheres(&self) -> impl Iterator<Item = ChainSphere> + '_ {
        let steps = if self.include_last { self.count.saturating_sub(1) } else { self.count }.max(1);
        segment_points(self.from.center.as_dvec3(), self.to.center.as_dvec3(), self.count, steps).map(
            move |(k, center)| {
                let radius = lerp(self.from.radius, self.to.radius, k, steps);
                ChainSphere { center: center.as_vec3(), radius }
            },
        )
    }
}

impl Limb {
    /// Creates a limb of eight spheres per bone, with the lengths of both bones and the radii at
    /// `from`, at the joint and at `to`.
    pub fn new(
        from: impl Into<Vec3>,
        to: impl Into<Vec3>,
        lengths: [f32; 2],
        plane_normal: impl Into<Vec3>,
        radii: [f32; 3],
    ) -> Self {
        let (from, to, plane_normal) = (from.into(), to.into(), plane_normal.into());
        Self { from, to, lengths, plane_normal, counts: eight(), keep_lengths: true, radii }
    }

    /// Spheres of the limb: the bone at `from`, the joint, the bone at `to`. Returns an error if
    /// the bones cannot connect the ends.
    pub fn spheres(&self) -> Result<Vec<ChainSphere>, PlacementError> {
        let joint = self.joint()?;
        let bone = |end: Vec3, radius: f32, count: u32| {
            segment_points(end.as_dvec3(), joint, count, count.max(1)).map(move |(k, center)| ChainSphere {
                center: center.as_vec3(),
                radius: lerp(radius, self.radii[1], k, count.saturating_sub(1).max(1)),
            })
        };
        let mut spheres: Vec<ChainSphere> = bone(self.from, self.radii[0], self.counts[0]).collect();
        spheres.push(ChainSphere { center: joint.as_vec3(), radius: self.radii[1] });
        spheres.extend(bone(self.to, self.radii[2], self.counts[1]));
        Ok(spheres)
    }

    /// Position of the joint.
    fn joint(&self) -> Result<DVec3, PlacementError> {
        let [from, to, plane_normal] = [self.from, self.to, self.plane_normal].map(|v| v.as_dvec3());
        Bones { from, to, lengths: self.lengths.map(f64::from), plane_normal, keep_lengths: self.keep_lengths }.joint()
    }
}

/// Points of the segment at the parameters k / steps for k = 0 to `count` − 1.
fn segment_points(from: DVec3, to: DVec3, count: u32, steps: u32) -> impl Iterator<Item = (u32, DVec3)> {
    (0..count).map(move |k| (k, from + (to - from) * (f64::from(k) / f64::from(steps))))
}

fn lerp(from: f32, to: f32, k: u32, steps: u32) -> f32 {
    let (from, to) = (f64::from(from), f64::from(to));
    (from + (to - from) * (f64::from(k) / f64::from(steps))) as f32
}
