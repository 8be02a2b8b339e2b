//! A mirror and a window in one, each with a colour of its own, as Whitted's rays see them (1980): two deltas, with or
//! without Fresnel's equations between them.

use super::lobe::{Deltas, delta, one_of_two, visible};
use super::{BsdfSample, fresnel};
use crate::ScatteringLobe;
use juggler_math::{Rgb, Vec2, Vec3};

/// Mirrored and transparent shares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whitted {
    /// Share that is mirrored, 0 to 1.
    pub mirror: Rgb,
    /// Share that goes through, 0 to 1; no channel of both together is above 1, unless `fresnel` shares light between them.
    pub transparency: Rgb,
    /// Index of refraction below the surface over that above; 1 goes straight on.
    pub ior: f32,
    /// Whether Fresnel's equations share the light.
    pub fresnel: bool,
}

impl Whitted {
    /// Only mirrors are opaque.
    fn is_black_from(&self, wo: Vec3) -> bool {
        wo.z == 0.0 || wo.z < 0.0 && self.transparency.is_black()
    }

    /// Mirrored and refracted light. What cannot go through is mirrored.
    fn both(&self, wo: Vec3) -> [BsdfSample; 2] {
        let ior = if wo.z < 0.0 { 1.0 / self.ior } else { self.ior };
        let share = if ior == 1.0 { 0.0 } else { fresnel::dielectric(wo.z.abs(), ior) };
        let (mut mirrored, mut through) = if self.fresnel {
            (self.mirror * share, self.transparency * (1.0 - share))
        } else {
            (self.mirror, self.transparency)
        };
        let wi = fresnel::refract(wo, Vec3::Z, 1.0 / ior);
        if wi.is_none() && !self.fresnel {
            (mirrored, through) = (mirrored + through, Rgb::BLACK);
        }
        let up = Vec3::new(-wo.x, -wo.y, wo.z);
        [delta(up, mirrored, 1.0), delta(wi.unwrap_or(-wo), through / (ior * ior), ior)]
    }
}

impl ScatteringLobe for Whitted {
    #[inline]
    fn eval_pdf(&self, _wo: Vec3, _wi: Vec3) -> (Rgb, f32) {
        (Rgb::BLACK, 0.0)
    }

    /// One of the two.
    fn sample(&self, wo: Vec3, u: Vec2, _choice: f32) -> Option<BsdfSample> {
        if self.is_black_from(wo) {
            return None;
        }
        let [mirrored, through] = self.both(wo);
        one_of_two(mirrored, through, u.x)
    }

    /// What is mirrored and what goes through.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if self.is_black_from(wo) {
            return Rgb::BLACK;
        }
        let [mirrored, through] = self.both(wo);
        mirrored.weight + through.weight * (through.ior * through.ior)
    }

    /// Those of any weight.
    fn deltas(&self, wo: Vec3) -> Deltas {
        if self.is_black_from(wo) {
            return Deltas::new();
        }
        visible(self.both(wo))
    }

    #[inline]
    fn is_specular(&self) -> bool {
        true
    }
}
