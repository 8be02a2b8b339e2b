//! Diffuse base under a smooth or rough dielectric coat: plastic, varnish, glazed tiles.
//!
//! The coat reflects E(μ) of the light. The base scatters the rest, which passes the coat once
//! more: f = C(ρ) (1 - E(μo)) (1 - E(μi)) / (π (1 - Ē)), which is reciprocal and, as C(1) = 1,
//! white for a white base (Ashikhmin and Shirley 2000; Kelemen and Szirmay-Kalos 2001). Light that
//! the coat reflects back takes the base's color again: C(ρ) = ρ (1 - r) / (1 - ρ r), with r the
//! coat's reflectance of uniform light from within. Without that, C(ρ) = ρ, and textures keep their
//! colors (cf. `nonlinear` in Mitsuba).

use super::{Bsdf, Conductor, Fresnel, OrenNayar, fresnel};
use juggler_math::{Rgb, Vec2};

/// Coated diffuse surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plastic {
    /// Albedo of the base, 0 to 1.
    pub albedo: Rgb,
    /// Roughness of the base, 0 to 1: see [`OrenNayar`].
    pub base_roughness: f32,
    /// Index of refraction of the coat over that of the medium outside, above 1.
    pub ior: f32,
    /// GGX alpha of the coat along x and y.
    pub alpha: Vec2,
    /// Factor on light that the coat reflects, 0 to 1; white in nature.
    pub reflection: Rgb,
    /// Whether light that the coat reflects back takes the base's color again, which saturates
    /// colors.
    pub nonlinear: bool,
}

impl Default for Plastic {
    fn default() -> Self {
        Self {
            albedo: Rgb::splat(0.5),
            base_roughness: 0.0,
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
    /// Adds the coat and the base under it to `bsdf`.
    pub fn add_lobes(&self, bsdf: &mut Bsdf) {
        let coat = Conductor::compensated(Fresnel::Dielectric { ior: self.ior, color: self.reflection }, self.alpha);
        let within = 1.0 - (1.0 - fresnel::mean_dielectric_reflectance(self.ior)) / (self.ior * self.ior);
        let again = |a: f32| a * (1.0 - within) / (1.0 - a * within);
        let albedo = if self.nonlinear { self.albedo.map(again) } else { self.albedo };
        bsdf.push_layer(coat, 1.0);
        bsdf.push_diffuse(albedo, self.base_roughness, 1.0);
    }
}

impl Bsdf {
    /// Adds a diffuse lobe: [`OrenNayar`] where `roughness` is above 0, else Lambertian.
    pub fn push_diffuse(&mut self, albedo: Rgb, roughness: f32, weight: f32) {
        if roughness > 0.0 {
            self.push_scaled(OrenNayar::new(albedo, roughness), weight);
        } else {
            self.push_scaled(super::Lambert { albedo }, weight);
        }
    }
}
