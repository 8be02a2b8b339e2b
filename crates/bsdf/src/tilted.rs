//! Conductor whose microfacets are around another normal than the shading normal: a clear coat with
//! normals of its own.
//!
//! Value and density are those of the conductor in its own frame, as for a surface with that
//! shading normal. Light that it would scatter below the surface is absorbed.

use super::lobe::Deltas;
use super::{BsdfSample, Conductor};
use crate::ScatteringLobe;
use juggler_math::{Frame, Rgb, Vec2, Vec3};

/// Smallest cosine between the lobe's normal and the shading normal.
const MIN_COSINE: f32 = 0.05;

/// A [`Conductor`] lobe around a normal of its own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TiltedConductor {
    conductor: Conductor,
    /// x and y of the lobe's unit normal in the shading frame; z is positive.
    tilt: Vec2,
}

impl TiltedConductor {
    /// Lobe of an isotropic conductor around `normal`, a unit vector in the shading frame. A normal
    /// at or below the horizon is lifted above it.
    pub fn new(conductor: Conductor, normal: Vec3) -> Self {
        let normal = Vec3 { z: normal.z.max(MIN_COSINE), ..normal }.normalize_or(Vec3::Z);
        Self { conductor, tilt: Vec2::new(normal.x, normal.y) }
    }

    /// Frame of the lobe within the shading frame.
    fn frame(&self) -> Frame {
        let Vec2 { x, y } = self.tilt;
        Frame::around(Vec3::new(x, y, (1.0 - x * x - y * y).max(0.0).sqrt()))
    }
}

impl ScatteringLobe for TiltedConductor {
    fn eval_pdf(&self, wo: Vec3, wi: Vec3) -> (Rgb, f32) {
        if wo.z <= 0.0 || wi.z <= 0.0 {
            return (Rgb::BLACK, 0.0);
        }
        let frame = self.frame();
        self.conductor.eval_pdf(frame.to_local(wo), frame.to_local(wi))
    }

    fn sample(&self, wo: Vec3, u: Vec2, u_choice: f32) -> Option<BsdfSample> {
        let frame = self.frame();
        let sample = self.conductor.sample(frame.to_local(wo), u, u_choice)?;
        let wi = frame.to_world(sample.wi);
        (wo.z > 0.0 && wi.z > 0.0).then_some(BsdfSample { wi, ..sample })
    }

    fn albedo(&self, wo: Vec3) -> Rgb {
        if wo.z > 0.0 { self.conductor.albedo(self.frame().to_local(wo)) } else { Rgb::BLACK }
    }

    fn deltas(&self, wo: Vec3) -> Deltas {
        let frame = self.frame();
        let upright = |delta: BsdfSample| BsdfSample { wi: frame.to_world(delta.wi), ..delta };
        let deltas = self.conductor.deltas(frame.to_local(wo)).into_iter().map(upright);
        deltas.filter(|delta| wo.z > 0.0 && delta.wi.z > 0.0).collect()
    }

    fn is_specular(&self) -> bool {
        self.conductor.is_specular()
    }

    fn uses_u_choice(&self) -> bool {
        self.conductor.uses_u_choice()
    }

    fn mean_alpha(&self) -> f32 {
        self.conductor.mean_alpha()
    }

    /// The albedo depends on the azimuth, though the microfacets do not.
    fn is_anisotropic(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Fresnel;
    use juggler_math::testing::{Random, close3};
    use std::f32::consts::TAU;

    fn lobe(alpha: f32, normal: Vec3) -> TiltedConductor {
        let fresnel = Fresnel::Dielectric { ior: 1.5, color: Rgb::WHITE };
        TiltedConductor::new(Conductor::compensated(fresnel, Vec2::splat(alpha)), normal.normalize())
    }

    #[test]
    fn a_lobe_without_tilt_is_the_conductor() {
        let (tilted, mut random) = (lobe(0.2, Vec3::Z), Random::new(5));
        for _ in 0..100 {
            let (wo, wi) = (random.unit_vector(), random.unit_vector());
            assert_eq!(tilted.eval_pdf(wo, wi), tilted.conductor.eval_pdf(wo, wi));
            assert_eq!(tilted.albedo(wo), tilted.conductor.albedo(wo));
        }
    }

    #[test]
    fn a_smooth_lobe_reflects_about_its_own_normal() {
        let (tilted, wo) = (lobe(0.0, Vec3::new(0.3, -0.1, 1.0)), Vec3::new(0.1, 0.2, 1.0).normalize());
        let normal = Vec3::new(0.3, -0.1, 1.0).normalize();
        let expected = normal * (2.0 * wo.dot(normal)) - wo;
        let deltas = tilted.deltas(wo);
        assert_eq!(deltas.len(), 1);
        assert!(deltas.iter().all(|delta| close3(delta.wi, expected, 1e-5)), "{deltas:?}");
        assert!(tilted.sample(wo, Vec2::splat(0.5), 0.5).is_some_and(|sample| close3(sample.wi, expected, 1e-5)));
        // The mirror direction is below the surface.
        assert!(tilted.deltas(Vec3::new(-0.8, 0.0, 0.6)).iter().all(|delta| delta.wi.z > 0.0));
        assert!(lobe(0.0, Vec3::new(2.0, 0.0, 1.0)).deltas(Vec3::new(-0.1, 0.0, 0.995)).is_empty());
    }

    /// Samples follow the density, and their weights average to the integral of the values.
    #[test]
    fn samples_agree_with_values_and_densities() {
        for (alpha, normal) in [(0.3, Vec3::new(0.5, 0.2, 1.0)), (0.5, Vec3::new(-1.0, 0.4, 1.0))] {
            let tilted = lobe(alpha, normal);
            for wo in [Vec3::Z, Vec3::new(0.7, 0.1, 0.7).normalize(), Vec3::new(-0.9, 0.3, 0.3).normalize()] {
                let (mut value, mut density) = (0.0, 0.0);
                const STEPS: u32 = 400;
                for (i, j) in (0..STEPS).flat_map(|i| (0..STEPS).map(move |j| (i, j))) {
                    let [z, turn] = [i, j].map(|k| (k as f32 + 0.5) / STEPS as f32);
                    let (sin, r) = ((TAU * turn).sin_cos(), (1.0 - z * z).sqrt());
                    let (f, pdf) = tilted.eval_pdf(wo, Vec3::new(sin.0 * r, sin.1 * r, z));
                    let area = f64::from(TAU) / f64::from(STEPS * STEPS);
                    (value, density) = (value + f64::from(f.g) * area, density + f64::from(pdf) * area);
                }
                const SAMPLES: u32 = 200_000;
                let (mut weight, mut accepted, mut random) = (0.0, 0u32, Random::new(9));
                for _ in 0..SAMPLES {
                    let (u, choice) = (Vec2::new(random.f32(), random.f32()), random.f32());
                    let Some(sample) = tilted.sample(wo, u, choice) else { continue };
                    assert!(sample.wi.z > 0.0);
                    weight += f64::from(sample.weight.g) / f64::from(SAMPLES);
                    accepted += 1;
                }
                let accepted = f64::from(accepted) / f64::from(SAMPLES);
                assert!((weight - value).abs() < 0.01 * value.max(0.02), "{normal} {wo}: {weight}, not {value}");
                assert!((accepted - density).abs() < 0.01, "{normal} {wo}: {accepted}, not {density}");
                assert!(value <= 1.0 && density < 1.005);
            }
        }
    }
}
