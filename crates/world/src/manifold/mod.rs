//! Manifold next-event estimation by way of a polished ball: the ways on which light comes from a place to another one by
//! the mirror that a ball is, or through it (Hanika, Droske, Fascione, Manifold Next Event Estimation, 2015; Zeltner,
//! Georgiev, Jakob, Specular Manifold Sampling, 2020).
//!
//! Those walk over any surface and find some of the ways. A ball has a plane that holds the whole way, so that one angle
//! says it all: here every way is found, and the density of each is known in closed form.
//!
//! Lengths are in units of the ball's radius. With u the sine of the angle of incidence, the same wherever the way touches
//! the ball, and k the radius over the distance of an end from the centre, the way leaves that end at an angle of sine
//! k u to the line to the centre.

use arrayvec::ArrayVec;
use juggler_math::{Vec3, fun};

mod lens;
mod mirror;
#[cfg(test)]
mod tests;

/// How light comes by way of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// It is mirrored on the outside.
    Mirrored,
    /// It goes in and out again.
    Refracted {
        /// Index of refraction inside over outside, above 1.
        ior: f32,
    },
}

/// A ball in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its centre.
    pub center: Vec3,
    /// Its radius, above 0.
    pub radius: f32,
}

/// Where a way begins or ends, as the ball sees it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Unit, from the centre.
    pub toward: Vec3,
    /// Radius over distance: 0 at infinity, below 1.
    pub nearness: f32,
}

/// A way from one end to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Unit, in which it leaves the first end.
    pub direction: Vec3,
    /// Where it touches the ball first and last: unit, from the centre.
    pub touches: [Vec3; 2],
    /// Sine of the angle of incidence.
    pub sine: f32,
}

/// Ways that there can be.
pub const MAX_BENDS: usize = 3;

/// An end nearer than this (its nearness) counts as on the ball.
const NEAREST: f32 = 0.9999;

impl Ball {
    /// A place as the ball sees it; `None` when it is not clearly outside.
    #[inline]
    pub fn end(&self, place: Vec3) -> Option<End> {
        let way = place - self.center;
        let distance = way.length();
        let nearness = self.radius / distance;
        (nearness <= NEAREST).then(|| End { toward: way / distance, nearness })
    }

    /// The share of all directions in which a place with that nearness sees the ball, times 2.
    #[inline]
    pub fn seen(nearness: f32) -> f32 {
        let squared = nearness * nearness;
        squared / (1.0 + (1.0 - squared).max(0.0).sqrt())
    }
}

impl End {
    /// Infinitely far in a direction, a unit vector.
    #[inline]
    pub fn infinity(toward: Vec3) -> Self {
        Self { toward, nearness: 0.0 }
    }
}

/// The plane through both ends and the centre.
#[derive(Clone, Copy, Debug)]
struct Plane {
    /// Unit, to the first end.
    axis: Vec3,
    /// Unit, at a right angle, on the side of the second end.
    across: Vec3,
    /// Of the angle between the ends.
    sin: f32,
    cos: f32,
    angle: f32,
    /// Of both ends.
    nearness: [f32; 2],
}

impl Plane {
    /// `None` when everything lies on a line.
    #[inline]
    fn new(from: &End, to: &End) -> Option<Self> {
        let cos = from.toward.dot(to.toward);
        let across = to.toward - from.toward * cos;
        let sin = across.length();
        let angle = fun::atan2(sin, cos);
        let nearness = [from.nearness, to.nearness];
        (sin > 1e-6).then(|| Self { axis: from.toward, across: across / sin, sin, cos, angle, nearness })
    }

    /// The unit vector from the centre at an angle from the axis.
    #[inline]
    fn at(&self, (sin, cos): (f32, f32)) -> Vec3 {
        self.axis * cos + self.across * sin
    }

    /// The direction of the way of incidence `sine` from the first end; to which `side` of the centre it goes is 1 or -1.
    #[inline]
    fn direction(&self, sine: f32, side: f32) -> Vec3 {
        let sin = self.nearness[0] * sine;
        self.at((side * sin, -cosine(sin)))
    }
}

/// Every way between two ends.
#[inline]
pub fn bends(way: Way, from: &End, to: &End) -> ArrayVec<Bend, MAX_BENDS> {
    let Some(plane) = Plane::new(from, to) else { return ArrayVec::new() };
    match way {
        Way::Mirrored => mirror::bend(&plane).into_iter().collect(),
        Way::Refracted { ior } => lens::bends(&plane, ior),
    }
}

/// Solid angle of the second end, seen from the centre, over solid angle at the first, of a thin bundle around the way of
/// incidence `sine`: places that are picked from the centre with density p are so picked from the first end with density
/// p times this.
///
/// With Φ(u) the angle at the centre between the ends, and a their angles to the way: cos a₁ cos a₂ |Φ'(u)| sin Φ / (u k₁²).
#[inline]
pub fn spread(way: Way, from: &End, to: &End, sine: f32) -> f32 {
    let [near, far] = [from.nearness, to.nearness];
    let cosines = [near, far].map(|nearness| cosine(nearness * sine));
    let slope = match way {
        Way::Mirrored => mirror::slope(sine, [near, far], cosines),
        Way::Refracted { ior } => lens::slope(sine, [near, far], cosines, ior),
    };
    let angle = from.toward.cross(to.toward).length();
    // Along the axis both vanish.
    let around = if sine > 1e-4 { angle / sine } else { slope.abs() };
    cosines[0] * cosines[1] * slope.abs() * around / (near * near)
}

/// Of an angle below 90 degrees, by its sine.
#[inline]
pub fn cosine(sine: f32) -> f32 {
    ((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt()
}
