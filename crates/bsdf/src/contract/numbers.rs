//! All results are finite numbers.

use super::*;

#[test]
fn everything_is_finite_and_not_negative() {
    let mut random = Random::new(95);
    let odd = [
        Vec3::X,
        Vec3::NEG_Y,
        Vec3::Z,
        Vec3::NEG_Z,
        Vec3::new(1.0, 0.0, 1e-7),
        Vec3::new(1.0, 0.0, -1e-30),
        Vec3::new(0.0, -1.0, f32::MIN_POSITIVE),
        Vec3::new(1e-4, 0.0, 1.0),
    ];
    let us = [0.0, 0.25, 0.5, 1f32.next_down()];
    let fine = |color: Rgb| color.is_finite() && color.r >= 0.0 && color.g >= 0.0 && color.b >= 0.0;
    for Example { name, bsdf, .. } in examples() {
        let directions: Vec<Vec3> = odd.into_iter().chain((0..20).map(|_| random.unit_vector())).collect();
        for wo in &directions {
            for wi in &directions {
                let (value, pdf) = bsdf.eval_pdf(*wo, *wi);
                assert!(fine(value) && pdf.is_finite() && pdf >= 0.0, "{name} {wo} {wi}: {value:?} {pdf}");
            }
            assert!(fine(bsdf.albedo(*wo)), "{name} {wo}");
            assert!(bsdf.deltas(*wo).iter().all(|delta| fine(delta.weight)), "{name} {wo}");
            for (x, y) in us.into_iter().flat_map(|x| us.map(|y| (x, y))) {
                if let Some(sample) = bsdf.sample(*wo, Vec2::new(x, y), random.f32()) {
                    assert!(
                        fine(sample.weight) && sample.pdf > 0.0 && sample.pdf.is_finite(),
                        "{name} {wo} {sample:?}"
                    );
                    assert!((sample.wi.length() - 1.0).abs() < 1e-4, "{name} {wo} {sample:?}");
                }
            }
        }
    }
}

#[test]
fn opaque_lobes_are_black_from_below() {
    let mut random = Random::new(96);
    for Example { name, bsdf, .. } in examples().into_iter().filter(|e| !e.both_sides && !e.name.contains("glass")) {
        for _ in 0..100 {
            let wo = -random.unit_vector().abs();
            assert!(bsdf.sample(wo, random.vec2(), random.f32()).is_none() && bsdf.albedo(wo).is_black(), "{name}");
            assert!(bsdf.eval_pdf(wo, random.unit_vector()) == (Rgb::BLACK, 0.0), "{name}");
        }
    }
}

#[test]
fn matched_indices_transmit_without_refraction() {
    use crate::{Dielectric, ThinDielectric};
    let mut random = Random::new(97);
    for _ in 0..1000 {
        let wo = random.unit_vector();
        for bsdf in [Bsdf::from(Dielectric::new(1.0, Vec2::ZERO)), ThinDielectric::new(1.0, Vec2::ZERO).into()] {
            let sample = bsdf.sample(wo, random.vec2(), random.f32()).unwrap();
            assert_eq!((sample.wi, sample.weight, sample.pdf, sample.ior), (-wo, Rgb::WHITE, 1.0, 1.0));
            assert_eq!(bsdf.deltas(wo).len(), 1);
        }
    }
}
