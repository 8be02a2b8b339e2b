//! Lobes whose frame leans away from the geometric normal.

use super::*;
use crate::{Conductor, Dielectric, DiffuseTransmission, Fresnel, Lambert, Plastic, Principled, ThinDielectric};
use juggler_math::testing::close;

/// Angles between z and the geometric normal, in radians.
const LEANS: [f32; 5] = [0.02, 0.2, 0.5, 1.0, 1.5];

/// Names of surfaces that absorb nothing, their lobes, and whether they transmit light.
fn white() -> Vec<(&'static str, Bsdf, bool)> {
    let rough = Vec2::splat(0.3);
    let (half, glass) = (Rgb::splat(0.5), Principled { transmission: 0.5, roughness: 0.6, ..Principled::default() });
    vec![
        ("diffuse", Lambert { albedo: Rgb::WHITE }.into(), false),
        ("metal", Conductor::compensated(Fresnel::WHITE, rough).into(), false),
        ("brushed metal", Conductor::compensated(Fresnel::WHITE, Vec2::new(0.6, 0.3)).into(), false),
        ("plastic", Plastic { albedo: Rgb::WHITE, alpha: rough, ..Plastic::default() }.into(), false),
        ("mirror", Conductor::new(Fresnel::WHITE, Vec2::ZERO).into(), false),
        ("sheet", DiffuseTransmission { reflectance: half, transmittance: half, ior: 1.0 }.into(), true),
        ("pane", ThinDielectric::compensated(1.5, rough).into(), true),
        ("glass", Dielectric::compensated(1.5, rough).into(), true),
        ("dense glass", Dielectric::compensated(1.0 / 2.4, rough).into(), true),
        ("polished glass", Dielectric::new(1.5, Vec2::ZERO).into(), true),
        ("half glass", Bsdf::with_lobes(|bsdf| glass.add_lobes(1.5, bsdf)), true),
    ]
}

/// The geometric normal from which z leans by an angle in radians, towards the azimuth `turn`, in
/// turns.
fn normal(angle: f32, turn: f32) -> Vec3 {
    let ((sin, cos), (y, x)) = (portable::sin_cos(angle), portable::sin_cos_turns(turn));
    Vec3::new(-x * sin, -y * sin, cos)
}

/// Names, lobes without and with a geometric normal, that normal, and views on the same side of z
/// and of that normal.
fn leaning() -> Vec<(String, Bsdf, Bsdf, Vec3, Vec3)> {
    let mut all = Vec::new();
    for (number, (name, upright, is_open)) in white().into_iter().enumerate() {
        for (angle, views) in LEANS.into_iter().zip(std::iter::repeat(views(is_open))) {
            let normal = normal(angle, 0.15 * number as f32);
            let mut bsdf = upright.clone();
            bsdf.set_geometric_normal(normal);
            let seen = views.into_iter().filter(|wo| wo.z * wo.dot(normal) > 0.0);
            all.extend(
                seen.map(|wo| (format!("{name}, {angle} from {wo}"), upright.clone(), bsdf.clone(), normal, wo)),
            );
        }
    }
    all
}

#[test]
fn tilted_shading_normals_keep_the_scattered_energy() {
    for (name, upright, bsdf, _, wo) in leaning() {
        if ["diffuse", "plastic", "half glass"].iter().any(|kind| name.starts_with(kind)) {
            continue;
        }
        let (expected, energy) = (furnace(&upright, wo, 32), furnace(&bsdf, wo, 32));
        // Samples of a single white lobe have a weight of 1 in any direction; samples of panes
        // have this weight on average.
        let near = if name.contains("pane") { 0.015 } else { 1e-3 };
        assert!(close(energy.g, expected.g, near), "{name}: {energy:?}, upright {expected:?}");
        assert_eq!(bsdf.albedo(wo), upright.albedo(wo), "{name}");
    }
}

/// Known answer for a white diffuse surface: the part of its cosine lobe above the plane of the
/// geometric normal is (1 + cos β) / 2 of the whole, and light sampling finds as much. Under a coat,
/// the base loses no more than that.
#[test]
fn diffuse_reflection_loses_the_light_that_a_tilted_normal_sends_below_the_surface() {
    for (name, upright, bsdf, normal, wo) in leaning() {
        let share = (1.0 + normal.z) / 2.0;
        let (expected, energy) = (furnace(&upright, wo, 64).g, furnace(&bsdf, wo, 64).g);
        if name.starts_with("diffuse") {
            assert!(close(energy, share, 0.004), "{name}: {energy}, not {share}");
        } else if name.starts_with("plastic") || name.starts_with("half glass") {
            assert!(energy > expected * share - 0.02 && energy < expected + 0.02, "{name}: {energy}, {share}");
        }
    }
}

#[test]
fn integrals_with_tilted_shading_normals_keep_the_energy() {
    let (rings, sectors) = (400, 256);
    for (angle, turn) in LEANS.into_iter().zip([0.0, 0.1, 0.35, 0.6, 0.8]) {
        let mut bsdf =
            Bsdf::from(DiffuseTransmission { reflectance: Rgb::splat(0.7), transmittance: Rgb::splat(0.3), ior: 1.0 });
        bsdf.set_geometric_normal(normal(angle, turn));
        let (mut sums, mut density) = ([0.0f64; 2], 0.0f64);
        for (i, j) in (0..rings).flat_map(|i| (0..sectors).map(move |j| (i, j))) {
            let z = (i as f32 + 0.5) / rings as f32 * 2.0 - 1.0;
            let (sin, cos) = portable::sin_cos_turns((j as f32 + 0.5) / sectors as f32);
            let along = (1.0 - z * z).sqrt();
            let (value, pdf) = bsdf.eval_pdf(Vec3::Z, Vec3::new(along * cos, along * sin, z));
            let size = 4.0 * std::f64::consts::PI / f64::from(rings * sectors);
            sums[usize::from(z < 0.0)] += f64::from(value.g) * size;
            density += f64::from(pdf) * size;
        }
        assert!((sums[0] - 0.7).abs() < 0.003 && (sums[1] - 0.3).abs() < 0.003, "{angle}: {sums:?}");
        assert!((density - 1.0).abs() < 0.004, "{angle}: {density}");
    }
}

/// Known answers for a direction at the angle ψ above the geometric surface, in the plane of both
/// normals: a white diffuse surface has the value n·l / π, a diffuse sheet, which transmits, has
/// (sin(ψ + β) + sin(β - ψ / s) / s) / π for each half of its light.
#[test]
fn light_below_the_geometric_surface_is_moved_above_it_by_the_closed_form() {
    for (angle, stretch) in [(0.3f32, 4.0f32), (1.0, std::f32::consts::PI - 1.0)] {
        let mut bsdf = Bsdf::from(Lambert { albedo: Rgb::WHITE });
        bsdf.set_geometric_normal(normal(angle, 0.0));
        let mut sheet =
            Bsdf::from(DiffuseTransmission { reflectance: Rgb::WHITE, transmittance: Rgb::BLACK, ior: 1.0 });
        sheet.set_geometric_normal(normal(angle, 0.0));
        for psi in [-0.2f32, -0.01, 0.01, 0.1, 0.5, 1.0, 1.5, 2.0] {
            // z leans towards x.
            let (sin, cos) = portable::sin_cos(psi + angle);
            let value = |bsdf: &Bsdf| bsdf.eval(Vec3::Z, Vec3::new(cos, 0.0, sin)).g;
            let plain = |psi: f32| portable::sin(psi + angle).max(0.0) * std::f32::consts::FRAC_1_PI;
            let [expected, spread] = if psi < 0.0 { [0.0; 2] } else { [plain(psi), plain(-psi / stretch) / stretch] };
            assert!(close(value(&bsdf), expected, 1e-5), "{angle} {psi}: {}, expected {expected}", value(&bsdf));
            let expected = expected + spread;
            assert!(close(value(&sheet), expected, 1e-5), "{angle} {psi}: {}, expected {expected}", value(&sheet));
        }
    }
}

#[test]
fn samples_with_tilted_shading_normals_stay_in_the_common_hemisphere() {
    let mut random = Random::new(103);
    for (name, _, bsdf, normal, wo) in leaning() {
        for _ in 0..200 {
            let Some(sample) = bsdf.sample(wo, random.vec2(), random.f32()) else { continue };
            let BsdfSample { wi, weight, pdf, scatter, ior } = sample;
            // Rounding may put a direction on the other side of a plane that it touches.
            let is_near_a_plane = wi.z.abs().min(wi.dot(normal).abs()) < 1e-5;
            assert!(wi.z * wi.dot(normal) >= 0.0 || is_near_a_plane, "{name}: {sample:?}");
            assert!(close(wi.length(), 1.0, 1e-5) && pdf > 0.0 && weight.is_finite(), "{name}: {sample:?}");
            assert!(ior == 1.0 || sample.is_transmitted(wo), "{name}: {sample:?}");
            if scatter == Scatter::Specular {
                let deltas = bsdf.deltas(wo);
                assert!(deltas.iter().any(|delta| delta.wi.distance(wi) < 1e-4), "{name}: {sample:?} {deltas:?}");
            } else if !is_near_a_plane {
                let (value, density) = bsdf.eval_pdf(wo, wi);
                let near = |a: f32, b: f32| (a - b).abs() <= 0.02 * a.abs().max(b.abs()) + 1e-5;
                assert!(near(density, pdf) && near(value.g, weight.g * pdf), "{name}: {sample:?}, {value:?} {density}");
            }
        }
    }
}

#[test]
fn directions_with_tilted_shading_normals_follow_their_density() {
    let all: Vec<_> = leaning().into_iter().filter(|(_, bsdf, ..)| !bsdf.is_specular()).collect();
    let few: Vec<_> = all.iter().step_by(7).filter(|(.., wo)| wo.z.abs() > 0.3).collect();
    assert!(few.len() > 10);
    for (name, _, bsdf, _, wo) in &few {
        let checked = follows_its_density(bsdf, *wo, 300_000, 1e-3 / few.len() as f64);
        assert!(checked.is_ok(), "{name}: {checked:?}");
    }
}

#[test]
fn slightly_tilted_shading_normals_change_nothing() {
    let mut random = Random::new(104);
    for (name, upright, _) in white() {
        let mut bsdf = upright.clone();
        bsdf.set_geometric_normal(normal(1e-4, 0.3));
        for _ in 0..100 {
            let (wo, wi) = (random.unit_vector(), random.unit_vector());
            assert_eq!(bsdf.eval_pdf(wo, wi), upright.eval_pdf(wo, wi), "{name}");
        }
    }
}
