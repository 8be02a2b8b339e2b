//! A matt body under a clear coat, polished or rough: plastic, varnish, glazed tiles.
//!
//! The coat mirrors E(μ) of the light; the body gets the rest, spreads it, and what it gives back passes the coat once
//! more: f = C(ρ) (1 - E(μo)) (1 - E(μi)) / (π (1 - Ē)), which is reciprocal and, as C(1) = 1, white where the body is
//! (Ashikhmin and Shirley 2000; Kelemen and Szirmay-Kalos 2001). Light that the coat mirrors back into the body meets
//! its colour again: C(ρ) = ρ (1 - r) / (1 - ρ r), with r what the coat mirrors of even light from within. Without
//! that, C(ρ) = ρ, a texture's colours stay as they are (cf. `nonlinear` in Mitsuba).

use super::{Bsdf, Conductor, Fresnel, OrenNayar, fresnel};
use juggler_math::{Rgb, Vec2};

/// A coated matt surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    /// Colour of the body, 0 to 1.
    pub albedo: Rgb,
    /// Roughness of the body, 0 to 1: see [`OrenNayar`].
    pub body_roughness: f32,
    /// Index of refraction of the coat over that of what is outside, above 1.
    pub ior: f32,
    /// Alpha of the coat along x and y.
    pub alpha: Vec2,
    /// Factor on what the coat mirrors, 0 to 1; white in nature.
    pub reflection: Rgb,
    /// Whether light that is mirrored within takes the body's colour once more, which makes it more saturated.
    pub nonlinear: bool,
}

impl Default for Plastic {
    fn default() -> Self {
        Self {
            albedo: Rgb::splat(0.5),
            body_roughness: 0.0,
            ior: 1.5,
            alpha: Vec2::ZERO,
            reflection: Rgb::WHITE,
            nonlinear: false,
        }
    }
}

impl From<Plastic> for Bsdf {
    fn from(plastic: Plastic) -> Self {
        Self::with_lobes(|bsdf| plastic.add_lobes(bsdf))
    }
}

impl Plastic {
    /// Adds the coat and the body under it to `bsdf`.
    pub fn add_lobes(&self, bsdf: &mut Bsdf) {
        let coat = Conductor::compensated(Fresnel::Dielectric { ior: self.ior, color: self.reflection }, self.alpha);
        let within = 1.0 - (1.0 - fresnel::dielectric_average(self.ior)) / (self.ior * self.ior);
        let again = |a: f32| a * (1.0 - within) / (1.0 - a * within);
        let albedo = if self.nonlinear { self.albedo.map(again) } else { self.albedo };
        bsdf.push_layer(coat, 1.0);
        bsdf.push_diffuse(albedo, self.body_roughness, 1.0);
    }
}

impl Bsdf {
    /// Adds a matt lobe: Lambert's, or a rough one.
    pub fn push_diffuse(&mut self, albedo: Rgb, roughness: f32, weight: f32) {
        if roughness > 0.0 {
            self.push_scaled(OrenNayar::new(albedo, roughness), weight);
        } else {
            self.push_scaled(super::Lambert { albedo }, weight);
        }
    }
}
