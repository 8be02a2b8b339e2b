//! Energy of lobes around a shading normal that a map has perturbed.
//!
//! Normal maps and bump maps turn the shading normal, which is z, away from the geometric normal g.
//! The planes of z and g bound two lunes of directions that lie above one plane and below the
//! other. A path that the lobes send into a lune ends in the surface itself, so its energy is lost.
//! Schüssler, Heitz, Hanika and Dachsbacher (2017) conserve it with a microsurface of two facets,
//! between which light is scattered any number of times; their closed form stops after two bounces.
//!
//! Here, a bijection spreads the light of a lune over directions that both normals have on the same
//! side. Let ψ be the angle of a direction about the line in which both planes meet, measured from
//! the plane of g towards the side to which z leans, and let β be the angle between z and g.
//! Reflected directions below the plane of g have ψ between -β and 0, and go to -s ψ, with s =
//! min(4, (π - β) / β). Since dω = sin θ dθ dψ, with θ measured from that line, the bijection
//! scales solid angles by s. Values and densities therefore become f(ψ) + f(-ψ / s) / s.
//! Transmitted directions above the plane of g are spread likewise, with all signs turned.
//!
//! The bijection conserves the energy of any sum of lobes for any viewer, and the weight of each
//! sample. Lobes end at the plane of z, so no seam shows at ψ = s β. A small s brightens grazing
//! light (s = 1 reflects a lune at the plane of g, and doubles grazing light); a large s blurs
//! highlights that the plane of g cuts.
//!
//! Diffuse reflection keeps to n·l instead, as Cycles, three.js and Filament do: light in a lune is
//! absorbed, so that a bump has the contrast of a surface with the shading normal. Its furnace is
//! (1 + cos β) / 2, the part of the cosine lobe above both planes. Where the shading normal of the
//! other lobes is bent towards the viewer, n stays the normal of the map ([`Bsdf::tilt_diffuse`]).
//!
//! The result is not reciprocal, as with any shading normal (Veach 1997, section 5.3). Reflections
//! at shading normals inside of a solid may therefore gather light in orbits of total reflection,
//! which it never leaves and which no light entered. [`BsdfView::sample_exit`] ends them.

use super::{Bsdf, BsdfView, Role, WeightedLobe};
use crate::tilted_diffuse::{Diffuse, TiltedDiffuse};
use crate::{BsdfSample, Lobe, Scatter};
use juggler_math::{Frame, Rgb, Vec2, Vec3, portable, warp};
use std::f32::consts::PI;

/// The geometric surface in the frame of a shading normal z that differs from its normal g.
#[derive(Clone, Copy, Debug)]
pub(super) struct Horizon {
    /// g: unit, on the side of z.
    normal: Vec3,
    /// Unit vector along the geometric surface, in the direction in which z leans.
    lean: Vec3,
    /// s: factor by which the light of a lune is spread.
    stretch: f32,
}

/// Largest stretch.
const WIDEST: f32 = 4.0;

/// Sine of the angle between both normals below which they count as the same.
const LEAST_SINE: f32 = 1e-3;

impl Horizon {
    /// Horizon of a unit geometric normal on the side of z; `None` where the normal hardly differs
    /// from z.
    fn new(normal: Vec3) -> Option<Self> {
        let (sine, cosine) = ((normal.x * normal.x + normal.y * normal.y).sqrt(), normal.z);
        if !(sine > LEAST_SINE && cosine > 0.0) {
            return None;
        }
        let angle = portable::atan2(sine, cosine);
        let lean = (Vec3::Z - normal * cosine) / sine;
        Some(Self { normal, lean, stretch: WIDEST.min((PI - angle) / angle) })
    }

    /// Whether a direction lies in a lune: z and the geometric normal have it on different sides.
    #[inline]
    fn divides(&self, w: Vec3) -> bool {
        (w.z < 0.0) != (self.normal.dot(w) < 0.0)
    }

    /// Maps a direction in a lune to the direction in which its light goes on.
    fn spread(&self, w: Vec3) -> Vec3 {
        let side = if w.z < 0.0 { -1.0 } else { 1.0 };
        self.rotated(w * side, -self.stretch) * side
    }

    /// Inverse of [`Horizon::spread`] for a direction `w` outside of both lunes; `None` where no
    /// direction of a lune maps to `w`.
    fn source(&self, w: Vec3) -> Option<Vec3> {
        let side = if w.z < 0.0 { -1.0 } else { 1.0 };
        let source = self.rotated(w * side, -1.0 / self.stretch);
        (source.z > 0.0).then_some(source * side)
    }

    /// Direction with ψ `factor` times that of `w` and the same angle from the line in which both
    /// planes meet.
    fn rotated(&self, w: Vec3, factor: f32) -> Vec3 {
        let (along, up) = (w.dot(self.lean), w.dot(self.normal));
        let (sin, cos) = portable::sin_cos(portable::atan2(up, along) * factor);
        let radius = (along * along + up * up).sqrt();
        w + self.lean * (radius * cos - along) + self.normal * (radius * sin - up)
    }
}

/// Whether a lobe is the diffuse reflection of an opaque surface.
#[inline]
fn is_diffuse_reflection(one: &WeightedLobe) -> bool {
    one.role == Role::Upright && matches!(one.lobe, Lobe::Lambert(_) | Lobe::OrenNayar(_) | Lobe::TiltedDiffuse(_))
}

impl Bsdf {
    /// Sets the geometric normal, a unit vector in the frame of the lobes on either side of the
    /// surface, where a map has turned the shading normal. No light is then scattered to directions
    /// that both normals have on different sides; its energy is spread over other directions, except
    /// that of diffuse reflection, which is absorbed.
    pub fn set_geometric_normal(&mut self, normal: Vec3) {
        self.horizon = Horizon::new(if normal.z < 0.0 { -normal } else { normal });
    }

    /// Turns diffuse reflection about `normal`, a unit vector in the frame of the lobes: the normal
    /// of a map, where the frame has another.
    pub fn tilt_diffuse(&mut self, normal: Vec3) {
        for one in &mut self.lobes {
            let diffuse = match one.lobe {
                Lobe::Lambert(lobe) if one.role == Role::Upright => Diffuse::Lambert(lobe),
                Lobe::OrenNayar(lobe) if one.role == Role::Upright => Diffuse::OrenNayar(lobe),
                _ => continue,
            };
            one.lobe = TiltedDiffuse::new(diffuse, normal).into();
        }
    }

    /// Maps a delta's direction out of the lunes.
    pub(super) fn delta_above(&self, delta: BsdfSample) -> BsdfSample {
        match &self.horizon {
            Some(horizon) if horizon.divides(delta.wi) => BsdfSample { wi: horizon.spread(delta.wi), ..delta },
            _ => delta,
        }
    }
}

impl BsdfView<'_> {
    /// [`BsdfView::eval_pdf`] with a horizon.
    pub(super) fn eval_pdf_above(&self, horizon: &Horizon, wi: Vec3) -> (Rgb, f32) {
        if horizon.divides(wi) {
            return (Rgb::BLACK, 0.0);
        }
        let (value, pdf) = self.eval_pdf_of_lobes(wi);
        let Some(source) = horizon.source(wi) else { return (value, pdf) };
        let (more, density) = self.eval_pdf_to_spread(source);
        (value + more / horizon.stretch, pdf + density / horizon.stretch)
    }

    /// Value and density of the light that the lobes scatter to a direction in a lune. The value is
    /// without diffuse reflection, which is absorbed there, while the density counts its samples.
    fn eval_pdf_to_spread(&self, source: Vec3) -> (Rgb, f32) {
        let lobes = &self.bsdf.lobes;
        let (value, pdf) = self.eval_pdf_of_lobes(source);
        if !lobes.iter().any(is_diffuse_reflection) {
            return (value, pdf);
        }
        if lobes.iter().all(is_diffuse_reflection) {
            return (Rgb::BLACK, pdf);
        }
        let diffuse = lobes.iter().enumerate().filter(|(_, one)| is_diffuse_reflection(one));
        let absorbed = diffuse.fold(Rgb::BLACK, |sum, (index, one)| {
            let weight = one.weight * self.layer_attenuation(index, source);
            sum + self.bsdf.eval_pdf_of_one(one, self.wo, source).0 * weight
        });
        ((value - absorbed).map(|channel| channel.max(0.0)), pdf)
    }

    /// [`BsdfView::sample`] with a horizon.
    pub(super) fn sample_above(&self, horizon: &Horizon, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        let sample = self.sample_of_lobes(u, u_choice)?;
        let share = 1.0 / horizon.stretch;
        if !horizon.divides(sample.wi) {
            let source = horizon.source(sample.wi).filter(|_| sample.scatter != Scatter::Specular);
            let Some(source) = source else { return Some(sample) };
            // Two directions of the lobes map to this one: combine their values and densities.
            let (value, density) = self.eval_pdf_to_spread(source);
            let pdf = sample.pdf + density * share;
            return Some(BsdfSample { weight: (sample.weight * sample.pdf + value * share) / pdf, pdf, ..sample });
        }
        let wi = horizon.spread(sample.wi);
        if sample.scatter == Scatter::Specular {
            return Some(BsdfSample { wi, ..sample });
        }
        let spread = if self.bsdf.lobes.iter().any(is_diffuse_reflection) {
            self.eval_pdf_to_spread(sample.wi).0
        } else {
            sample.weight * sample.pdf
        };
        let (value, density) = self.eval_pdf_of_lobes(wi);
        let pdf = sample.pdf * share + density;
        Some(BsdfSample { wi, weight: (spread * share + value) / pdf, pdf, ..sample })
    }

    /// Sample that lets light leave a smooth solid where `reflected`, a sample for a viewer inside of
    /// the solid, is a total reflection about a perturbed normal. The direction is cosine-distributed
    /// about the geometric normal, by `u` in the unit square. `None` if the reflection is not total
    /// or the normal is not perturbed.
    pub fn sample_exit(&self, reflected: &BsdfSample, u: Vec2) -> Option<BsdfSample> {
        let horizon = self.bsdf.horizon.as_ref()?;
        let is_reflected = self.wo.z < 0.0 && reflected.wi.z < 0.0 && reflected.scatter == Scatter::Specular;
        if !is_reflected || self.deltas().any(|delta| delta.wi.z > 0.0) {
            return None;
        }
        let ior = self.bsdf.lobes.iter().find_map(|one| match &one.lobe {
            Lobe::Dielectric(dielectric) => Some(dielectric.ior()),
            _ => None,
        })?;
        let wi = Frame::around(horizon.normal).to_world(warp::cosine_hemisphere(u));
        // Mirror directions below the perturbed horizon.
        let wi = Vec3 { z: wi.z.abs(), ..wi };
        // Radiance in the solid is that outside times the square of the index of refraction.
        Some(BsdfSample { wi, weight: reflected.weight * (ior * ior), ior: 1.0 / ior, ..*reflected })
    }
}
