//! Specular reflection and transmission of Whitted's ray tracing (1980): two deltas, each with a
//! color of its own, with or without Fresnel's equations between them.

use super::lobe::{Deltas, delta, nonzero_deltas, sample_delta_pair};
use super::{BsdfSample, fresnel};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3};

/// Specular reflection and transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// Fraction of light that is reflected, 0 to 1.
    pub mirror: Rgb,
    /// Fraction of light that is transmitted, 0 to 1; no channel of the sum of both exceeds 1,
    /// unless `fresnel` divides the light.
    pub transparency: Rgb,
    /// Index of refraction below the surface over that above; 1 transmits in a straight line.
    pub ior: f32,
    /// Whether Fresnel's equations divide the light between reflection and transmission.
    pub fresnel: bool,
}

impl Whitted {
    /// Whether no light leaves along `wo`: `wo` is in the surface, or below an opaque one.
    fn is_black_from(&self, wo: Vec3) -> bool {
        wo.z == 0.0 || wo.z < 0.0 && self.transparency.is_black()
    }

    /// Reflected and refracted delta. Without `fresnel`, total internal reflection also reflects
    /// the transmitted fraction.
    fn delta_pair(&self, wo: Vec3) -> [BsdfSample; 2] {
        let ior = if wo.z < 0.0 { 1.0 / self.ior } else { self.ior };
        let reflectance = if ior == 1.0 { 0.0 } else { fresnel::dielectric_reflectance(wo.z.abs(), ior) };
        let (mut reflected, mut transmitted) = if self.fresnel {
            (self.mirror * reflectance, self.transparency * (1.0 - reflectance))
        } else {
            (self.mirror, self.transparency)
        };
        let wi = fresnel::refract(wo, Vec3::Z, 1.0 / ior);
        if wi.is_none() && !self.fresnel {
            (reflected, transmitted) = (reflected + transmitted, Rgb::BLACK);
        }
        let up = Vec3::new(-wo.x, -wo.y, wo.z);
        [delta(up, reflected, 1.0), delta(wi.unwrap_or(-wo), transmitted / (ior * ior), ior)]
    }
}

impl ScatteringLobe for Whitted {
    #[inline]
    fn eval_pdf(&self, _wo: Vec3, _wi: Vec3) -> (Rgb, f32) {
        (Rgb::BLACK, 0.0)
    }

    /// Selects one of the two deltas.
    fn sample(&self, wo: Vec3, u: Vec2, _u_choice: f32) -> Option<BsdfSample> {
        if self.is_black_from(wo) {
            return None;
        }
        let [reflected, transmitted] = self.delta_pair(wo);
        sample_delta_pair(reflected, transmitted, u.x)
    }

    /// Reflectance plus transmittance.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if self.is_black_from(wo) {
            return Rgb::BLACK;
        }
        let [reflected, transmitted] = self.delta_pair(wo);
        reflected.weight + transmitted.weight * (transmitted.ior * transmitted.ior)
    }

    /// Deltas of nonzero weight.
    fn deltas(&self, wo: Vec3) -> Deltas {
        if self.is_black_from(wo) {
            return Deltas::new();
        }
        nonzero_deltas(self.delta_pair(wo))
    }

    #[inline]
    fn is_specular(&self) -> bool {
        true
    }
}
