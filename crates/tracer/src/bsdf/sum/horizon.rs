//! Light that a leaning shading normal sends below the true surface.
//!
//! Maps of normals and heights turn the shading normal, which is z, away from the normal g of the true surface. The planes
//! of both bound two lunes of directions, which lie above the one and below the other: light that lobes scatter there would
//! end in the surface itself. Schüssler, Heitz, Hanika and Dachsbacher (2017) conserve it by microfacets that z and g imply,
//! between which light is scattered any number of times; that has no closed form, and what they evaluate ends after two.
//!
//! Here, the light of a lune is spread over directions beside it that z and g have on the same side. Let ψ be the angle of a
//! direction about the line in which both planes meet, measured from the plane of g towards the side to which z leans; let
//! β be the angle between z and g. What is scattered up, but below g, has ψ from -β to 0, and goes to -s ψ, with
//! s = min(4, (π - β) / β). Since dω = sin θ dθ dψ (θ from that line), all solid angles grow by s, so values and densities
//! count 1 / s: f(ψ) becomes f(ψ) + f(-ψ / s) / s. Light that goes down, but above g, is spread likewise with all signs
//! turned. That conserves the energy of any sum of lobes for any viewer, and the weights of its samples; it is exact, and
//! there is no seam where ψ = s β, as lobes end at z's own plane. The larger s, the less light that comes in flat is
//! enhanced (s = 1 mirrors at the plane of g, and doubles it), and the wider a highlight that z's plane cuts is blurred.
//!
//! The sum is not the same both ways, as no shading normal is (Veach 1997, section 5.3).

use super::Bsdf;
use crate::bsdf::{BsdfSample, Scatter};
use juggler_math::{Rgb, Vec2, Vec3, fun};
use std::f32::consts::PI;

/// The true surface in the frame of a shading normal z that leans away from its normal g.
#[derive(Clone, Copy, Debug)]
pub(super) struct Horizon {
    /// g: unit, on the side of z.
    normal: Vec3,
    /// Unit vector along the true surface in the direction in which z leans.
    lean: Vec3,
    /// s: how many times as wide as a lune the directions are over which its light is spread.
    stretch: f32,
}

/// The largest stretch.
const WIDEST: f32 = 4.0;

/// Sine of the angle between both normals below which they count as one.
const LEAST_SINE: f32 = 1e-3;

impl Horizon {
    /// Of a unit normal on the side of z; `None` where it hardly differs from z.
    fn new(normal: Vec3) -> Option<Self> {
        let (sine, cosine) = ((normal.x * normal.x + normal.y * normal.y).sqrt(), normal.z);
        if !(sine > LEAST_SINE && cosine > 0.0) {
            return None;
        }
        let angle = fun::atan2(sine, cosine);
        let lean = (Vec3::Z - normal * cosine) / sine;
        Some(Self { normal, lean, stretch: WIDEST.min((PI - angle) / angle) })
    }

    /// Whether z and the true normal have a direction on different sides: whether it lies in a lune.
    #[inline]
    fn divides(&self, w: Vec3) -> bool {
        (w.z < 0.0) != (self.normal.dot(w) < 0.0)
    }

    /// Where light goes that is scattered into a lune.
    fn spread(&self, w: Vec3) -> Vec3 {
        let side = if w.z < 0.0 { -1.0 } else { 1.0 };
        self.turned(w * side, -self.stretch) * side
    }

    /// The direction in a lune from which light is spread to `w`, which lies in none.
    fn source(&self, w: Vec3) -> Option<Vec3> {
        let side = if w.z < 0.0 { -1.0 } else { 1.0 };
        let source = self.turned(w * side, -1.0 / self.stretch);
        (source.z > 0.0).then_some(source * side)
    }

    /// Of ψ `factor` times that of `w`, and the same angle from the line in which both planes meet.
    fn turned(&self, w: Vec3, factor: f32) -> Vec3 {
        let (along, up) = (w.dot(self.lean), w.dot(self.normal));
        let (sin, cos) = fun::sin_cos(fun::atan2(up, along) * factor);
        let radius = (along * along + up * up).sqrt();
        w + self.lean * (radius * cos - along) + self.normal * (radius * sin - up)
    }
}

impl Bsdf {
    /// Says that z leans from the normal of the true surface, which is `normal`, a unit vector in the lobes' frame, on
    /// either side: light that would so be lost is spread over directions that both have on the same side.
    pub fn lean_from(&mut self, normal: Vec3) {
        self.horizon = Horizon::new(if normal.z < 0.0 { -normal } else { normal });
    }

    /// [`Bsdf::eval_pdf`] where z leans.
    pub(super) fn eval_pdf_above(&self, horizon: &Horizon, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if horizon.divides(wi) {
            return (Rgb::BLACK, 0.0);
        }
        let (value, pdf) = self.eval_pdf_of_lobes(wo, wi);
        let Some(source) = horizon.source(wi) else { return (value, pdf) };
        let (more, density) = self.eval_pdf_of_lobes(wo, source);
        (value + more / horizon.stretch, pdf + density / horizon.stretch)
    }

    /// [`Bsdf::sample`] where z leans.
    pub(super) fn sample_above(&self, horizon: &Horizon, wo: Vec3, u: Vec2, choice: f32) -> Option<BsdfSample> {
        let sample = self.sample_of_lobes(wo, u, choice)?;
        let share = 1.0 / horizon.stretch;
        let (wi, own, other) = if horizon.divides(sample.wi) {
            let wi = horizon.spread(sample.wi);
            (wi, share, Some((wi, 1.0)))
        } else {
            (sample.wi, 1.0, horizon.source(sample.wi).map(|source| (source, share)))
        };
        let Some((other, share)) = other.filter(|_| sample.scatter != Scatter::Specular) else {
            return Some(BsdfSample { wi, ..sample });
        };
        // Two directions of the lobes end in this one.
        let (value, density) = self.eval_pdf_of_lobes(wo, other);
        let pdf = sample.pdf * own + density * share;
        let weight = (sample.weight * (sample.pdf * own) + value * share) / pdf;
        Some(BsdfSample { wi, weight, pdf, ..sample })
    }

    /// A delta where z may lean.
    pub(super) fn delta_above(&self, delta: BsdfSample) -> BsdfSample {
        match &self.horizon {
            Some(horizon) if horizon.divides(delta.wi) => BsdfSample { wi: horizon.spread(delta.wi), ..delta },
            _ => delta,
        }
    }
}
