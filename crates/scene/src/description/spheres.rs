//! Rows of spheres: how bodies are built of nothing else (Eric Graham's Juggler, 1986; Michael Birken's, 2010).
//!
//! ```json
//! {"chain": {"from": {"center": [0, 0, 0], "radius": 16}, "to": {"center": [0, 32, 0], "radius": 20}, "count": 8}}
//! ```

use super::{Bones, Misplaced, positive_items};
use juggler_math::{DVec3, Vec3};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A sphere at one end of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ControlSphere {
    /// Its centre.
    #[schemars(with = "[f32; 3]")]
    pub center: Vec3,
    /// Its radius.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub radius: f32,
}

/// Spheres in a row, position and radius in even steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Chain {
    /// The first sphere.
    pub from: ControlSphere,
    /// The last sphere.
    pub to: ControlSphere,
    /// How many spheres there are.
    #[schemars(range(min = 1, max = 100_000))]
    pub count: u32,
    /// Whether `to` is one of them; without it the row stops one step before, where the next chain begins.
    #[serde(default = "yes")]
    pub include_last: bool,
}

fn yes() -> bool {
    true
}

/// Two bones that meet in a joint: an arm or a leg, with spheres along both.
///
/// The joint lies in the plane through `from` that `plane_normal` is perpendicular to, on the side of the cross
/// product (to − from) × normal. Its place follows from the two lengths alone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Limb {
    /// One end: a hand or a foot.
    #[schemars(with = "[f32; 3]")]
    pub from: Vec3,
    /// The other end: a shoulder or a hip.
    #[schemars(with = "[f32; 3]")]
    pub to: Vec3,
    /// Lengths of the bone at `from` and of the bone at `to`.
    #[schemars(transform = positive_items)]
    pub lengths: [f32; 2],
    /// Normal of the plane in which the limb bends; need not be unit.
    #[schemars(with = "[f32; 3]")]
    pub plane_normal: Vec3,
    /// How many spheres stand on each bone; the joint has one more.
    #[serde(default = "eight")]
    #[schemars(inner(range(min = 1, max = 100_000)))]
    pub counts: [u32; 2],
    /// Whether the bones keep their lengths although `plane_normal` is not perpendicular to the line between the
    /// ends. Without it the joint comes nearer to that line, as in the Juggler of 2010: its forearms are up to 1 %
    /// short.
    #[serde(default = "yes")]
    pub keep_lengths: bool,
    /// Radii at `from`, at the joint and at `to`; in between they change in even steps.
    #[schemars(transform = positive_items)]
    pub radii: [f32; 3],
}

fn eight() -> [u32; 2] {
    [8, 8]
}

/// One sphere of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bead {
    /// Its centre.
    pub center: Vec3,
    /// Its radius.
    pub radius: f32,
}

impl Chain {
    /// Its spheres.
    pub fn beads(&self) -> impl Iterator<Item = Bead> + '_ {
        let steps = if self.include_last { self.count.saturating_sub(1) } else { self.count }.max(1);
        row(self.from.center.as_dvec3(), self.to.center.as_dvec3(), self.count, steps).map(move |(k, center)| {
            let radius = between(self.from.radius, self.to.radius, k, steps);
            Bead { center: center.as_vec3(), radius }
        })
    }
}

impl Limb {
    /// Its spheres: the bone at `from`, the joint, the bone at `to`.
    pub fn beads(&self) -> Result<Vec<Bead>, Misplaced> {
        let joint = self.joint()?;
        let bone = |end: Vec3, radius: f32, count: u32| {
            row(end.as_dvec3(), joint, count, count.max(1)).map(move |(k, center)| Bead {
                center: center.as_vec3(),
                radius: between(radius, self.radii[1], k, count.saturating_sub(1).max(1)),
            })
        };
        let mut beads: Vec<Bead> = bone(self.from, self.radii[0], self.counts[0]).collect();
        beads.push(Bead { center: joint.as_vec3(), radius: self.radii[1] });
        beads.extend(bone(self.to, self.radii[2], self.counts[1]));
        Ok(beads)
    }

    /// Where the bones meet.
    fn joint(&self) -> Result<DVec3, Misplaced> {
        let [from, to, plane_normal] = [self.from, self.to, self.plane_normal].map(|v| v.as_dvec3());
        Bones { from, to, lengths: self.lengths.map(f64::from), plane_normal, keep_lengths: self.keep_lengths }.joint()
    }
}

/// Points k / steps of the way, for k below `count`.
fn row(from: DVec3, to: DVec3, count: u32, steps: u32) -> impl Iterator<Item = (u32, DVec3)> {
    (0..count).map(move |k| (k, from + (to - from) * (f64::from(k) / f64::from(steps))))
}

fn between(from: f32, to: f32, k: u32, steps: u32) -> f32 {
    let (from, to) = (f64::from(from), f64::from(to));
    (from + (to - from) * (f64::from(k) / f64::from(steps))) as f32
}
