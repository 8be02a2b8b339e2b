//! Energy and reciprocity over a grid of roughness, index of refraction and angle.

use super::*;
use crate::{Conductor, Dielectric, Fresnel, Principled, ThinDielectric};

const ALPHAS: [f32; 6] = [0.05, 0.1, 0.2, 0.4, 0.7, 1.0];
const IORS: [f32; 6] = [1.1, 1.33, 1.5, 2.0, 2.4, 4.0];
const COSINES: [f32; 6] = [0.05, 0.2, 0.4, 0.6, 0.8, 1.0];

/// Direction of this cosine, above or below, between the x and y axes.
fn towards(cos: f32) -> Vec3 {
    let along = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(0.8 * along, 0.6 * along, cos)
}

/// Directions of all cosines on both sides.
fn directions() -> impl Iterator<Item = Vec3> {
    COSINES.into_iter().flat_map(|cos| [towards(cos), towards(-cos)])
}

#[test]
fn compensated_interfaces_and_panes_conserve_energy() {
    for alpha in ALPHAS.map(Vec2::splat) {
        for ior in IORS {
            let interface = (Bsdf::from(Dielectric::new(ior, alpha)), Dielectric::compensated(ior, alpha).into());
            let pane = (Bsdf::from(ThinDielectric::new(ior, alpha)), ThinDielectric::compensated(ior, alpha).into());
            for ((once, all), near) in [(interface, 0.002), (pane, 0.035)] {
                for wo in directions() {
                    let (once, all) = (furnace(&once, wo, 48).g, furnace(&all, wo, 48).g);
                    assert!(once <= 1.001, "{alpha} {ior} {wo}: {once}");
                    assert!((all - 1.0).abs() <= near, "{alpha} {ior} {wo}: {all}");
                }
            }
        }
    }
}

#[test]
fn compensated_metals_conserve_energy() {
    for alpha in ALPHAS.map(Vec2::splat) {
        for cos in COSINES {
            let mirror = Conductor::compensated(Fresnel::WHITE, alpha).into();
            let energy = furnace(&mirror, towards(cos), 48).g;
            assert!((0.985..=1.015).contains(&energy), "{alpha} {cos}: {energy}");
            for f0 in [0.04, 0.5, 0.9] {
                let fresnel = Fresnel::tinted(Rgb::splat(f0), Rgb::WHITE);
                let [once, all] = [Conductor::new(fresnel, alpha), Conductor::compensated(fresnel, alpha)]
                    .map(|metal| furnace(&metal.into(), towards(cos), 192).g);
                assert!(once <= all + 1e-3 && all <= 1.0, "{alpha} {cos} {f0}: {once} {all}");
            }
        }
    }
}

/// Integral of the values over all directions, by the midpoints of cells uniform in cosine-weighted
/// directions: the energy that light sampling finds, whatever directions the lobe samples.
fn integral(bsdf: &Bsdf, wo: Vec3, ior: f32) -> f64 {
    let (rings, sectors) = (300, 64);
    let mut sum = 0.0;
    for (i, j) in (0..rings).flat_map(|i| (0..sectors).map(move |j| (i, j))) {
        let (z, size) = (((i as f32 + 0.5) / rings as f32).sqrt(), 1.0 / rings as f32);
        let (sin, cos) = portable::sin_cos_turns((j as f32 + 0.5) / sectors as f32);
        let along = (1.0 - z * z).sqrt();
        for z in [z, -z] {
            let scale = if z * wo.z > 0.0 {
                1.0
            } else if wo.z > 0.0 {
                ior * ior
            } else {
                1.0 / (ior * ior)
            };
            let value = bsdf.eval(wo, Vec3::new(along * cos, along * sin, z)).g * scale / z.abs();
            sum += f64::from(value * size * std::f32::consts::PI) / f64::from(sectors);
        }
    }
    sum
}

#[test]
fn integrals_of_compensated_interfaces_conserve_energy() {
    for alpha in [(0.5, 0.5), (0.8, 0.8), (1.0, 1.0), (0.9, 0.4), (0.5, 0.7)].map(Vec2::from) {
        for ior in [1.5, 1.9, 2.4] {
            for wo in directions().filter(|wo| wo.z.abs() > 0.1) {
                let energy = integral(&Dielectric::compensated(ior, alpha).into(), wo, ior);
                let near = if alpha.x == alpha.y { 0.01 } else { 0.03 };
                assert!((energy - 1.0).abs() < near, "{alpha} {ior} {wo}: {energy}");
            }
        }
    }
}

/// Energy of the values of rough glass under layers, which its samples need not follow exactly.
#[test]
fn weighted_glass_under_layered_lobes_conserves_energy_on_average() {
    let white = Principled { transmission: 1.0, sheen_roughness: 0.5, ..Principled::default() };
    for (clearcoat, sheen) in [(1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
        for roughness in [0.55, 0.9] {
            let numbers = Principled { clearcoat, sheen_color: Rgb::splat(sheen), roughness, ..white };
            let bsdf = Bsdf::with_lobes(|bsdf| numbers.add_lobes(1.5, bsdf));
            let cosines = (0..6u8).map(|i| ((f32::from(i) + 0.5) / 6.0).sqrt());
            let mean = cosines.map(|cos| integral(&bsdf, towards(-cos), 1.5)).sum::<f64>() / 6.0;
            assert!((mean - 1.0).abs() < 0.01, "{clearcoat} {sheen} {roughness}: {mean}");
        }
    }
}

/// Surfaces that are rougher along x than along y.
#[test]
fn anisotropic_surfaces_conserve_energy() {
    for alpha in [(0.2, 0.02), (0.3, 0.1), (0.5, 0.05), (0.6, 0.3), (1.0, 0.1), (1.0, 0.5)].map(Vec2::from) {
        for turn in [0.0, 0.125, 0.25f32] {
            let (sin, cos) = portable::sin_cos_turns(turn);
            for w in directions() {
                let along = w.x.hypot(w.y);
                let wo = Vec3::new(along * cos, along * sin, w.z);
                for ior in IORS {
                    let energy = furnace(&Dielectric::compensated(ior, alpha).into(), wo, 32).g;
                    assert!((energy - 1.0).abs() <= 0.002, "{alpha} {ior} {wo}: {energy}");
                    let energy = furnace(&ThinDielectric::compensated(ior, alpha).into(), wo, 32).g;
                    assert!((energy - 1.0).abs() <= 0.03, "{alpha} {ior} {wo}: {energy}");
                }
                let energy = furnace(&Conductor::compensated(Fresnel::WHITE, alpha).into(), wo, 32).g;
                let expected = if w.z > 0.0 { 1.0 } else { 0.0 };
                assert!((energy - expected).abs() <= 0.03, "{alpha} {wo}: {energy}");
            }
        }
    }
}

/// Reciprocity between sampled directions, where values are not all 0. Radiance over the square of
/// the index is reciprocal. Brushed metal is not, as `metals.rs` says.
#[test]
fn sampled_directions_are_reciprocal() {
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
            let reciprocal = if alpha.x == alpha.y { 5 } else { 4 };
            for (number, bsdf) in lobes.iter().take(reciprocal).enumerate() {
                let (mut crossed, mut stayed) = (0, 0);
                for wo in directions().flat_map(|wo| [wo; 20]) {
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

/// Factors on the Fresnel reflectance of glass move light from reflection to transmission, and total
/// reflection keeps all of it (KHR_materials_specular).
#[test]
fn glass_of_any_specular_weight_conserves_energy() {
    let clear = Principled { transmission: 1.0, ..Principled::default() };
    for (specular, thin_walled) in [0.0, 0.3, 0.7].into_iter().flat_map(|weight| [(weight, false), (weight, true)]) {
        for (roughness, anisotropy) in [(0.0, 0.0), (0.3, 0.0), (0.6, 0.5), (0.8, 0.0), (1.0, 0.0)] {
            let glass = Principled { specular, thin_walled, roughness, anisotropy, ..clear };
            let bsdf = Bsdf::with_lobes(|bsdf| glass.add_lobes(1.5, bsdf));
            for wo in directions() {
                let energy = furnace(&bsdf, wo, 48).g;
                let near = if roughness == 0.0 || !thin_walled { 0.002 } else { 0.035 };
                assert!((energy - 1.0).abs() <= near, "{glass:?} {wo}: {energy}");
                let albedo = bsdf.albedo(wo).g;
                assert!((albedo - 1.0).abs() < 1e-4, "{glass:?} {wo}: {albedo}");
                if roughness > 0.4 && wo.z.abs() > 0.1 {
                    // The tables hold the loss of a plain interface, which loses more near grazing.
                    let integral = integral(&bsdf, wo, if thin_walled { 1.0 } else { 1.5 });
                    assert!((integral - 1.0).abs() < 0.08, "{glass:?} {wo}: {integral}");
                }
            }
        }
    }
}

/// Closed forms of the extension: reflectance w c F, transmittance 1 - w max(c) F; total reflection
/// of all light whatever both are.
#[test]
fn polished_glass_follows_its_specular_weight_and_color() {
    let f = 0.04f32;
    for (specular, color) in [(1.0, Rgb::WHITE), (0.5, Rgb::WHITE), (0.5, Rgb::new(0.2, 0.8, 0.4)), (1.0, Rgb::BLACK)] {
        let base =
            Principled { transmission: 1.0, roughness: 0.0, specular, specular_color: color, ..Principled::default() };
        let weight = |thin_walled: bool, wo: Vec3, is_transmitted: bool| {
            let bsdf = Bsdf::with_lobes(|bsdf| Principled { thin_walled, ..base }.add_lobes(1.5, bsdf));
            let found = bsdf.deltas(wo).into_iter().find(|delta| delta.is_transmitted(wo) == is_transmitted);
            found.map_or(Rgb::BLACK, |delta| energy_of(&delta)).to_array()
        };
        let most = color.max_channel();
        for (channel, c) in color.to_array().into_iter().enumerate() {
            let is =
                |value: f32, expected: f32| assert!((value - expected).abs() < 1e-5, "{base:?}: {value} {expected}");
            for wo in [Vec3::Z, Vec3::NEG_Z] {
                is(weight(false, wo, false)[channel], specular * c * f);
                is(weight(false, wo, true)[channel], 1.0 - specular * most * f);
            }
            let once = specular * most * f;
            is(weight(true, Vec3::Z, true)[channel], (1.0 - once) / (1.0 + once));
            let tint = if most > 0.0 { c / most } else { 0.0 };
            is(weight(true, Vec3::Z, false)[channel], 2.0 * once / (1.0 + once) * tint);
            is(weight(false, towards(-0.5), false)[channel], 1.0);
            is(weight(false, towards(-0.5), true)[channel], 0.0);
        }
    }
}
