//! Energy and reciprocity over a grid of roughness, index of refraction and angle.

use super::*;
use crate::bsdf::{Conductor, Dielectric, Fresnel, ThinDielectric};

const ALPHAS: [f32; 6] = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0];
const IORS: [f32; 6] = [1.1, 1.33, 1.5, 2.0, 2.4, 4.0];
const COSINES: [f32; 6] = [0.05, 0.2, 0.4, 0.6, 0.8, 1.0];

/// A direction of this cosine, above or below, turned a little.
fn towards(cos: f32) -> Vec3 {
    let along = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(0.8 * along, 0.6 * along, cos)
}

/// Both sides of each of the angles.
fn ways() -> impl Iterator<Item = Vec3> {
    COSINES.into_iter().flat_map(|cos| [towards(cos), towards(-cos)])
}

#[test]
fn clear_borders_and_panes_keep_all_light_and_add_none() {
    for alpha in ALPHAS.map(Vec2::splat) {
        for ior in IORS {
            let border = (Bsdf::from(Dielectric::new(ior, alpha)), Dielectric::compensated(ior, alpha).into());
            let pane = (Bsdf::from(ThinDielectric::new(ior, alpha)), ThinDielectric::compensated(ior, alpha).into());
            for (once, all) in [border, pane] {
                for wo in ways() {
                    let (once, all) = (furnace(&once, wo, 48).g, furnace(&all, wo, 48).g);
                    assert!(once <= 1.001, "{alpha} {ior} {wo}: {once}");
                    assert!((0.97..=1.04).contains(&all), "{alpha} {ior} {wo}: {all}");
                }
            }
        }
    }
}

#[test]
fn metals_keep_all_light_and_add_none() {
    for alpha in ALPHAS.map(Vec2::splat) {
        for cos in COSINES {
            let mirror = Conductor::compensated(Fresnel::WHITE, alpha).into();
            let energy = furnace(&mirror, towards(cos), 48).g;
            assert!((0.985..=1.015).contains(&energy), "{alpha} {cos}: {energy}");
            for f0 in [0.04, 0.5, 0.9] {
                let fresnel = Fresnel::tinted(Rgb::splat(f0), Rgb::WHITE);
                let [once, all] = [Conductor::new(fresnel, alpha), Conductor::compensated(fresnel, alpha)]
                    .map(|metal| furnace(&metal.into(), towards(cos), 48).g);
                assert!(once <= all + 1e-3 && all <= 1.0, "{alpha} {cos} {f0}: {once} {all}");
            }
        }
    }
}

/// Rougher along x than along y: light may be lost, and none comes of nothing.
#[test]
fn brushed_surfaces_add_no_light() {
    for alpha in [(0.2, 0.02), (0.3, 0.1), (0.5, 0.05), (0.6, 0.3), (1.0, 0.1), (1.0, 0.5)].map(Vec2::from) {
        for turn in [0.0, 0.125, 0.25f32] {
            let (sin, cos) = juggler_math::fun::sin_cos_turns(turn);
            for w in ways() {
                let along = w.x.hypot(w.y);
                let wo = Vec3::new(along * cos, along * sin, w.z);
                for ior in IORS {
                    for bsdf in [
                        Bsdf::from(Dielectric::compensated(ior, alpha)),
                        ThinDielectric::compensated(ior, alpha).into(),
                    ] {
                        let energy = furnace(&bsdf, wo, 32).g;
                        assert!((0.3..=1.06).contains(&energy), "{alpha} {ior} {wo}: {energy}");
                    }
                }
                let energy = furnace(&Conductor::compensated(Fresnel::WHITE, alpha).into(), wo, 32).g;
                let least = if w.z > 0.0 { 0.92 } else { 0.0 };
                assert!((least..=1.03).contains(&energy), "{alpha} {wo}: {energy}");
            }
        }
    }
}

/// Where light goes it comes from alike: by directions that are scattered, so that nothing is compared with nothing. Radiance
/// is that over the square of the index.
#[test]
fn what_is_scattered_may_come_back() {
    let mut random = Random::new(98);
    for alpha in [(0.05, 0.05), (0.2, 0.2), (0.5, 0.5), (1.0, 1.0), (0.6, 0.3), (0.5, 0.05)].map(Vec2::from) {
        for ior in IORS {
            let lobes: [Bsdf; 5] = [
                Dielectric::new(ior, alpha).into(),
                Dielectric::compensated(ior, alpha).into(),
                ThinDielectric::new(ior, alpha).into(),
                ThinDielectric::compensated(ior, alpha).into(),
                Conductor::compensated(Fresnel::Dielectric { ior, color: Rgb::WHITE }, alpha).into(),
            ];
            for (number, bsdf) in lobes.iter().enumerate() {
                let (mut crossed, mut stayed) = (0, 0);
                for wo in ways().flat_map(|wo| [wo; 20]) {
                    let Some(sample) = bsdf.sample(wo, random.vec2(), random.f32()) else { continue };
                    let wi = sample.wi;
                    let there = bsdf.eval(wo, wi).g / wi.z.abs() * sample.ior * sample.ior;
                    let back = bsdf.eval(wi, wo).g / wo.z.abs();
                    let near = (there - back).abs() <= 0.01 * there.max(back) + 1e-4;
                    assert!(near, "{number} {alpha} {ior} {wo} {wi}: {there} {back}");
                    *if sample.is_transmitted(wo) { &mut crossed } else { &mut stayed } += 1;
                }
                assert!(stayed > 2 && (crossed > 2 || number == 4), "{number} {alpha} {ior}: {stayed} {crossed}");
            }
        }
    }
}
