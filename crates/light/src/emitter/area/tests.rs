//! Tests of surface samples against their densities and against closed forms of the irradiance.

use super::*;
use juggler_math::testing::{Random, chi_squared, chi_squared_directions, z_test};
use juggler_math::{Frame, portable, vec3, warp};
use std::f64::consts::PI;

/// Significance level of each test: 1e-3 for all of the nearly sixty tests of densities in this
/// file.
const SIGNIFICANCE: f64 = 1.7e-5;
const SAMPLES: u32 = 1_000_000;

fn rectangle(corner: Vec3, a: Vec3, b: Vec3) -> AreaEmitter {
    RectangleEmitter::new(corner, [a, b]).unwrap().into()
}

fn triangle(corners: [Vec3; 3]) -> AreaEmitter {
    TriangleEmitter::new(corners).unwrap().into()
}

fn sphere(center: Vec3, radius: f32) -> AreaEmitter {
    SphereEmitter::new(center, radius).unwrap().into()
}

fn disk(center: Vec3, normal: Vec3, radius: f32) -> AreaEmitter {
    DiskEmitter::new(center, normal, radius).unwrap().into()
}

/// Surfaces near y = 1 that face down, of similar size.
fn examples() -> Vec<AreaEmitter> {
    vec![
        rectangle(vec3(-1.0, 1.0, -1.0), Vec3::X * 2.0, Vec3::Z * 1.5),
        rectangle(vec3(-0.5, 1.0, 0.0), vec3(0.6, 0.8, 0.0), Vec3::Z * 0.1),
        triangle([vec3(-1.0, 1.0, -1.0), vec3(1.0, 1.2, -1.0), vec3(0.0, 0.8, 1.5)]),
        triangle([vec3(-1.0, 1.0, 0.0), vec3(1.0, 1.0, 0.0), vec3(1.0, 1.0, 0.05)]),
        sphere(vec3(0.0, 1.0, 0.0), 0.7),
        disk(vec3(0.0, 1.0, 0.0), vec3(0.3, -2.0, 0.0), 0.8),
    ]
}

/// Shading points: far, near, in the plane of the surface, behind it.
const SHADING_POINTS: [Vec3; 7] = [
    vec3(0.0, 0.0, 0.0),
    vec3(3.0, -2.0, 1.0),
    vec3(0.1, 0.8, 0.1),
    vec3(2.5, 0.9, 0.3),
    vec3(40.0, 3.0, 30.0),
    vec3(-0.3, 2.0, 0.4),
    vec3(0.05, 1.31, 0.1),
];

/// Expected number of `count` samples in each cell of the edges' unit square, for a planar surface,
/// by the midpoint rule.
fn expected_cells(light: &AreaEmitter, from: Vec3, count: f64, point_at: impl Fn(f64, f64) -> Vec3) -> Vec<f64> {
    const FINE: usize = 40;
    let folded = matches!(light, AreaEmitter::Triangle(_));
    let normal = light.light_bounds(1.0, false).axis.as_dvec3();
    let mut cells = vec![0.0; 64];
    for i in 0..8 * FINE {
        for j in 0..8 * FINE {
            let (u, v) = ((i as f64 + 0.5) / (8 * FINE) as f64, (j as f64 + 0.5) / (8 * FINE) as f64);
            // Half of a cell on the diagonal belongs to a triangle.
            let fraction =
                if !folded || i + j + 1 < 8 * FINE { 1.0 } else { f64::from(u8::from(i + j + 1 == 8 * FINE)) * 0.5 };
            let point = point_at(u, v);
            let to_point = point.as_dvec3() - from.as_dvec3();
            let steradians = to_point.normalize().dot(normal).abs() / to_point.length_squared();
            let whole = f64::from(light.area()) * if folded { 2.0 } else { 1.0 } / (64 * FINE * FINE) as f64;
            cells[i / FINE * 8 + j / FINE] += f64::from(light.pdf(from, point)) * steradians * whole * fraction * count;
        }
    }
    cells
}

#[test]
fn planar_samples_follow_their_density() {
    let mut random = Random::new(1101);
    for light in examples() {
        let (corner, edges) = match &light {
            AreaEmitter::Rectangle(r) => (r.corner, r.edges),
            AreaEmitter::Triangle(t) => (t.corner, t.edges),
            _ => continue,
        };
        let point_at = |u: f64, v: f64| (corner + edges[0] * u + edges[1] * v).as_vec3();
        for from in SHADING_POINTS {
            let count = SAMPLES;
            let mut observed = [0.0; 64];
            for _ in 0..count {
                let sample = light.sample(from, random.vec2()).unwrap();
                let cell = |v: f32| ((v * 8.0) as usize).min(7);
                observed[cell(sample.uv.x) * 8 + cell(sample.uv.y)] += 1.0;
                let at = point_at(f64::from(sample.uv.x), f64::from(sample.uv.y));
                assert!(at.distance(sample.point) < 1e-5, "{light:?} {from} {sample:?}");
                let pdf = light.pdf(from, sample.point);
                assert!((pdf / sample.pdf - 1.0).abs() < 1e-3, "{light:?} {from} {sample:?} {pdf}");
            }
            let expected = expected_cells(&light, from, f64::from(count), point_at);
            let total: f64 = expected.iter().sum();
            assert!((total / f64::from(count) - 1.0).abs() < 5e-3, "{light:?} {from}: {total}");
            let fitted: Vec<f64> = expected.iter().map(|cell| cell * f64::from(count) / total).collect();
            chi_squared(&observed, &fitted, SIGNIFICANCE).unwrap_or_else(|e| panic!("{light:?} {from}: {e}"));
        }
    }
}

/// Small solid angles and grazing views, which test the precision of the mapping.
#[test]
fn narrow_views_follow_their_density() {
    let mut random = Random::new(1102);
    for (size, from) in [
        (1.0f32, vec3(0.3, 1.0 + 1e-3, 1.1)),
        (1.0, vec3(-30.0, 0.99, 0.5)),
        (1e-3, vec3(0.2, 0.0, 0.5)),
        (1e-3, vec3(-1.0, 0.98, 0.0)),
    ] {
        let (a, b) = (Vec3::X * size, Vec3::Z * size);
        let corner = vec3(0.0, 1.0, 0.0);
        for light in [rectangle(corner, a, b), triangle([corner, corner + a, corner + b])] {
            let point_at = |u: f64, v: f64| (corner.as_dvec3() + (a.as_dvec3() * u + b.as_dvec3() * v)).as_vec3();
            let mut observed = [0.0; 64];
            for _ in 0..SAMPLES {
                let sample = light.sample(from, random.vec2()).unwrap();
                let cell = |v: f32| ((v * 8.0) as usize).min(7);
                observed[cell(sample.uv.x) * 8 + cell(sample.uv.y)] += 1.0;
            }
            let expected = expected_cells(&light, from, f64::from(SAMPLES), point_at);
            let total: f64 = expected.iter().sum();
            assert!((total / f64::from(SAMPLES) - 1.0).abs() < 0.02, "{light:?} {from}: {total}");
            let fitted: Vec<f64> = expected.iter().map(|cell| cell * f64::from(SAMPLES) / total).collect();
            chi_squared(&observed, &fitted, SIGNIFICANCE).unwrap_or_else(|e| panic!("{light:?} {from}: {e}"));
        }
    }
}

#[test]
fn directions_to_spheres_follow_their_density() {
    let center = vec3(0.0, 1.0, 0.0);
    let (light, mut random) = (sphere(center, 0.7), Random::new(1107));
    for from in SHADING_POINTS.into_iter().chain([center + vec3(0.0, 0.701, 0.0)]).filter(|p| p.distance(center) > 0.7)
    {
        // Uniform over the cone: in 1 - cos and in the azimuth.
        let to_center = center - from;
        let size = 1.0 - (1.0 - 0.49 / to_center.length_squared()).sqrt();
        let frame = Frame::around(to_center.normalize());
        let mut observed = [0.0; 64];
        for _ in 0..SAMPLES {
            let sample = light.sample(from, random.vec2()).unwrap();
            let u = warp::uniform_cone_inverse(frame.to_local(sample.wi), size);
            observed[((u.x * 8.0) as usize).min(7) * 8 + ((u.y * 8.0) as usize).min(7)] += 1.0;
            assert!((sample.pdf / warp::uniform_cone_pdf(size) - 1.0).abs() < 1e-3, "{from}");
            assert!((sample.point.distance(center) - 0.7).abs() < 1e-6);
        }
        chi_squared(&observed, &[f64::from(SAMPLES) / 64.0; 64], SIGNIFICANCE)
            .unwrap_or_else(|e| panic!("{from}: {e}"));
    }
    for from in [center, center + vec3(0.0, 0.0, 0.6), center + vec3(-0.3, 0.1, 0.0)] {
        let hit = |w: Vec3| {
            let (to, w) = ((center - from).as_dvec3(), w.as_dvec3());
            let along = to.dot(w);
            from + (w * (along + (along * along - to.length_squared() + 0.49).sqrt())).as_vec3()
        };
        let pdf = |w: Vec3| light.pdf(from, hit(w));
        chi_squared_directions(|u| Some(light.sample(from, u)?.wi), pdf, SAMPLES, SIGNIFICANCE)
            .unwrap_or_else(|e| panic!("{from}: {e}"));
    }
    let flat = disk(center, Vec3::NEG_Y, 0.8);
    for from in [Vec3::ZERO, vec3(1.0, 0.5, 0.3), vec3(0.1, 1.9, 0.2)] {
        let hit = |w: Vec3| {
            let t = (1.0 - from.y) / w.y;
            let point = from + w * t;
            (t > 0.0 && point.distance(center) < 0.8).then_some(point)
        };
        let pdf = |w: Vec3| hit(w).map_or(0.0, |point| flat.pdf(from, point));
        chi_squared_directions(|u| Some(flat.sample(from, u)?.wi), pdf, SAMPLES, SIGNIFICANCE)
            .unwrap_or_else(|e| panic!("{from}: {e}"));
    }
}

/// Checks the sampled irradiance from radiance 1, at a point with a normal, against the closed
/// form.
fn check_irradiance(light: &AreaEmitter, from: Vec3, normal: Vec3, expected: f64) {
    let mut random = Random::new(1103);
    let value = |sample: AreaSample| f64::from(sample.wi.dot(normal).max(0.0) / sample.pdf);
    let values: Vec<f64> = (0..20_000).map(|_| light.sample(from, random.vec2()).map_or(0.0, value)).collect();
    // The significance level of three standard deviations.
    z_test(&values, expected, 2.7e-3).unwrap_or_else(|e| panic!("{light:?} {from} {normal}: {e}"));
}

/// Lambert's formula for the irradiance from a polygon above the horizon.
fn polygon_irradiance(corners: &[Vec3], from: Vec3, normal: Vec3) -> f64 {
    let directions: Vec<DVec3> = corners.iter().map(|c| (c.as_dvec3() - from.as_dvec3()).normalize()).collect();
    let edge = |i: usize| {
        let (a, b) = (directions[i], directions[(i + 1) % directions.len()]);
        let cross = a.cross(b);
        portable::atan2_f64(cross.length(), a.dot(b)) * cross.normalize().dot(normal.as_dvec3())
    };
    (0.5 * (0..directions.len()).map(edge).sum::<f64>()).abs()
}

#[test]
fn irradiance_of_polygons_matches_lamberts_formula() {
    let mut random = Random::new(1104);
    for height in [2.0f32, 0.3, 0.02, 30.0] {
        for _ in 0..4 {
            let from = vec3(random.range(-2.0, 2.0), 1.0 - height, random.range(-2.0, 2.0));
            let corner = vec3(-1.0, 1.0, -1.0);
            let (a, b) = (Vec3::X * 2.0, Vec3::Z * 1.5);
            let irradiance = |corners: &[Vec3]| polygon_irradiance(corners, from, Vec3::Y);
            check_irradiance(
                &rectangle(corner, a, b),
                from,
                Vec3::Y,
                irradiance(&[corner, corner + a, corner + a + b, corner + b]),
            );
            check_irradiance(
                &triangle([corner, corner + a, corner + b]),
                from,
                Vec3::Y,
                irradiance(&[corner, corner + a, corner + b]),
            );
        }
    }
}

#[test]
fn irradiance_of_spheres_and_disks_is_the_closed_form() {
    for (distance, radius) in [(1.0f32, 0.99), (3.0, 1.0), (1e4, 1.0), (1e9, 2.0)] {
        let from = vec3(0.0, -distance, 0.0);
        let ratio = f64::from(radius / distance);
        check_irradiance(&sphere(Vec3::ZERO, radius), from, Vec3::Y, PI * ratio * ratio);
    }
    let tilted = vec3(0.6, 0.8, 0.0);
    check_irradiance(&sphere(Vec3::ZERO, 1.0), vec3(0.0, -2.0, 0.0), tilted, PI * 0.25 * 0.8);
    for (height, aside) in [(1.0f64, 0.0), (0.5, 0.3), (0.3, 1.5), (4.0, 2.0)] {
        let (h, a, r) = (height, aside, 0.8f64);
        let sum = h * h + a * a + r * r;
        let irradiance = 0.5 * (1.0 - (h * h + a * a - r * r) / (sum * sum - 4.0 * a * a * r * r).sqrt());
        let light = disk(vec3(1.0, 2.0, 3.0), Vec3::NEG_Y, 0.8);
        check_irradiance(&light, vec3(1.0 + aside as f32, 2.0 - height as f32, 3.0), Vec3::Y, PI * irradiance);
    }
}

#[test]
fn samples_lie_on_the_light_and_in_its_bounds_at_all_scales() {
    let mut random = Random::new(1105);
    for exponent in [-45, -20, 0, 20, 45] {
        let size = 2f32.powi(exponent);
        let lights = [
            rectangle(vec3(-1.0, 1.0, -1.0) * size, Vec3::X * size, Vec3::Z * 0.1 * size),
            triangle([vec3(-1.0, 1.0, -1.0), Vec3::ONE, vec3(0.0, -0.8, 1.5)].map(|v| v * size)),
            sphere(vec3(0.3, 1.0, 0.2) * size, size * 0.4),
            disk(vec3(0.1, 1.0, 0.7) * size, vec3(1.0, 2.0, 3.0), size * 0.2),
        ];
        for light in lights {
            let bounds = light.light_bounds(1.0, true).bounds;
            for i in 0..2000 {
                let far = [0.0, 1.0, 1e3, 1e-4, 1e6][i % 5];
                let from = random.point(1.0) * far * size + vec3(0.3, 1.0, 0.2) * size;
                let Some(sample) = light.sample(from, random.vec2()) else { continue };
                assert!(bounds.contains(sample.point), "{light:?} {sample:?} {bounds:?}");
                assert!(sample.pdf.is_finite() && sample.distance > 0.0 && sample.normal.is_normalized());
                let reached = from.as_dvec3() + sample.wi.as_dvec3() * f64::from(sample.distance);
                let scale = f64::from(from.length() + size);
                assert!(reached.distance(sample.point.as_dvec3()) < 1e-6 * scale, "{light:?} {from} {sample:?}");
            }
        }
    }
}

#[test]
fn degenerate_emitters_are_rejected() {
    assert!(RectangleEmitter::new(Vec3::ZERO, [Vec3::X, vec3(0.1, 1.0, 0.0)]).is_none());
    assert!(RectangleEmitter::new(Vec3::ZERO, [Vec3::X, Vec3::ZERO]).is_none());
    assert!(RectangleEmitter::new(Vec3::NAN, [Vec3::X, Vec3::Y]).is_none());
    assert!(TriangleEmitter::new([Vec3::ZERO, Vec3::X, Vec3::X * 2.0]).is_none());
    assert!(TriangleEmitter::new([Vec3::ZERO, Vec3::X, Vec3::INFINITY]).is_none());
    assert!(SphereEmitter::new(Vec3::ZERO, 0.0).is_none() && SphereEmitter::new(Vec3::NAN, 1.0).is_none());
    assert!(DiskEmitter::new(Vec3::ZERO, Vec3::ZERO, 1.0).is_none());
    // No light arrives in the plane of a surface or at a point on it.
    assert_eq!(rectangle(Vec3::ZERO, Vec3::X, Vec3::Z).sample(vec3(3.0, 0.0, 0.0), Vec2::splat(0.3)), None);
    assert_eq!(disk(Vec3::ZERO, Vec3::Y, 1.0).sample(Vec3::ZERO, Vec2::splat(0.5)), None);
}

/// Sampling a near rectangle by solid angle has less variance than sampling it by area.
#[test]
fn solid_angles_vary_less_than_areas() {
    let light = RectangleEmitter::new(vec3(-1.0, 1.0, -1.0), [Vec3::X * 2.0, Vec3::Z * 2.0]).unwrap();
    let (from, mut random) = (vec3(0.2, 0.8, 0.1), Random::new(1106));
    let (mut solid, mut area) = ([0.0; 2], [0.0; 2]);
    for _ in 0..20_000 {
        let u = random.vec2();
        let sample = light.sample(from, u).unwrap();
        let value = f64::from(sample.wi.y / sample.pdf);
        solid = [solid[0] + value, solid[1] + value * value];
        let point = DVec3::new(f64::from(u.x) * 2.0 - 1.0, 1.0, f64::from(u.y) * 2.0 - 1.0);
        let pdf = uniform_area_pdf(from.as_dvec3(), point, DVec3::Y, 4.0);
        let value = (point - from.as_dvec3()).normalize().y / pdf;
        area = [area[0] + value, area[1] + value * value];
    }
    let relative = |[sum, squares]: [f64; 2]| squares * 2e4 / (sum * sum) - 1.0;
    assert!(relative(solid) * 10.0 < relative(area), "{} {}", relative(solid), relative(area));
}
