//! Diffuse reflection around another normal than the shading normal: under a normal map whose
//! normal the frame of the lobes cannot have, since its mirror direction would be below the
//! surface.
//!
//! Diffuse reflection follows n·l with the normal n of the map, from whatever side it is seen, as
//! in Cycles, three.js and Filament. Light below the plane of n is absorbed.

use super::{BsdfSample, Lambert, OrenNayar, ScatteringLobe};
use juggler_math::{Frame, Rgb, Vec2, Vec3};

/// A diffuse lobe around a normal of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TiltedDiffuse {
    diffuse: Diffuse,
    /// Unit normal of the lobe in the shading frame.
    normal: Vec3,
}

/// The lobe in the frame of its own normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Diffuse {
    /// Smooth.
    Lambert(Lambert),
    /// Rough.
    OrenNayar(OrenNayar),
}

impl TiltedDiffuse {
    /// Lobe around `normal`, a unit vector in the shading frame.
    pub fn new(diffuse: Diffuse, normal: Vec3) -> Self {
        Self { diffuse, normal }
    }

    /// The direction of view in the lobe's frame, on the lit side of a lobe that is seen from
    /// behind.
    fn viewed(frame: &Frame, wo: Vec3) -> Vec3 {
        let local = frame.to_local(wo);
        Vec3 { z: local.z.abs().max(f32::MIN_POSITIVE), ..local }
    }
}

impl ScatteringLobe for TiltedDiffuse {
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let frame = Frame::around(self.normal);
        let (wo, wi) = (Self::viewed(&frame, wo), frame.to_local(wi));
        match &self.diffuse {
            Diffuse::Lambert(lobe) => lobe.eval_pdf(wo, wi),
            Diffuse::OrenNayar(lobe) => lobe.eval_pdf(wo, wi),
        }
    }

    fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        let frame = Frame::around(self.normal);
        let local = Self::viewed(&frame, wo);
        let sample = match &self.diffuse {
            Diffuse::Lambert(lobe) => lobe.sample(local, u, u_choice),
            Diffuse::OrenNayar(lobe) => lobe.sample(local, u, u_choice),
        }?;
        let wi = frame.to_world(sample.wi);
        (wo.z > 0.0 && wi.z > 0.0).then_some(BsdfSample { wi, ..sample })
    }

    /// Albedo of the lobe in its own frame, less the light that goes below the plane of the shading
    /// normal.
    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z <= 0.0 {
            return Rgb::BLACK;
        }
        let local = Self::viewed(&Frame::around(self.normal), wo);
        let albedo = match &self.diffuse {
            Diffuse::Lambert(lobe) => lobe.albedo(local),
            Diffuse::OrenNayar(lobe) => lobe.albedo(local),
        };
        albedo * (0.5 * (1.0 + self.normal.z)).max(1e-3)
    }

    fn attenuates_as_diffuse(&self) -> bool {
        true
    }

    /// The albedo depends on the azimuth.
    fn is_anisotropic(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::close;
    use std::f32::consts::FRAC_1_PI;

    fn lambert(normal: Vec3) -> TiltedDiffuse {
        TiltedDiffuse::new(Diffuse::Lambert(Lambert { albedo: Rgb::splat(0.8) }), normal)
    }

    #[test]
    fn light_follows_the_normal_of_the_lobe_from_every_view() {
        let normal = Vec3::new(0.6, 0.0, 0.8);
        for wo in [Vec3::Z, normal, Vec3::new(-0.9, 0.1, 0.4).normalize()] {
            for wi in [Vec3::Z, Vec3::new(0.8, 0.0, 0.6), Vec3::new(-0.7, 0.2, 0.4).normalize()] {
                let (value, pdf) = lambert(normal).eval_pdf(wo, wi);
                let cosine = normal.dot(wi).max(0.0) * FRAC_1_PI;
                assert!(close(value.g, 0.8 * cosine, 1e-6) && close(pdf, cosine, 1e-6), "{wo} {wi}");
            }
        }
        assert_eq!(lambert(normal).eval_pdf(Vec3::Z, -Vec3::Z), (Rgb::BLACK, 0.0));
    }

    #[test]
    fn a_lobe_without_tilt_is_the_diffuse_lobe() {
        let rough = OrenNayar::new(Rgb::new(0.9, 0.5, 0.2), 0.7);
        let tilted = TiltedDiffuse::new(Diffuse::OrenNayar(rough), Vec3::Z);
        let (wo, wi) = (Vec3::new(0.3, 0.4, 0.5).normalize(), Vec3::new(-0.6, 0.1, 0.7).normalize());
        assert_eq!(tilted.eval_pdf(wo, wi), rough.eval_pdf(wo, wi));
        assert_eq!(tilted.albedo(wo), rough.albedo(wo));
        let u = Vec2::new(0.3, 0.6);
        assert_eq!(tilted.sample(wo, u, 0.5), rough.sample(wo, u, 0.5));
    }
}
