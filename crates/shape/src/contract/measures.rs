//! Areas, and points sampled on shapes with their densities.

use super::*;
use crate::surface::Surface;
use crate::testing::distance;
use crate::{ShapeSample, SurfacePoint};
use juggler_math::testing::z_test;
use std::f32::consts::PI;

fn bounded() -> impl Iterator<Item = AnyShape> {
    shapes().into_iter().filter(|shape| shape.bounds().is_finite())
}

/// Among random lines through a sphere of radius R, a surface of area A is crossed A / (2 π R²)
/// times on average (Cauchy and Crofton).
#[test]
fn areas_agree_with_random_lines() {
    let mut random = Random::new(11);
    for shape in bounded() {
        let sphere = bounding_sphere(&shape);
        let count = if shape.triangles() > 1 { 8_000 } else { 40_000 };
        let lines = (0..count).map(|_| line(&mut random, sphere, 1.5));
        let crossings: Vec<f64> = lines.map(|ray| all_hits(&shape, &ray).len() as f64).collect();
        let expected = f64::from(shape.area() / (2.0 * PI * sphere.1 * sphere.1));
        z_test(&crossings, expected, SIGNIFICANCE).unwrap_or_else(|error| panic!("{shape:?}: {error}"));
    }
    assert!(shapes().iter().all(|shape| shape.area() > 0.0 && shape.bounds().is_finite() == shape.area().is_finite()));
}

/// Smallest extent; of flat shapes, in their plane.
fn thickness(shape: &AnyShape) -> f32 {
    shape.bounds().extent().to_array().into_iter().filter(|e| *e > 0.0).fold(f32::INFINITY, f32::min)
}

/// Reference points: near the shape, far away, and inside solids.
fn reference_points(shape: &AnyShape, random: &mut Random) -> Vec<Vec3> {
    let (center, radius) = bounding_sphere(shape);
    let mut reference_points =
        [1.1, 1.5, 4.0, 1000.0].map(|away| center + random.unit_vector() * (away * radius)).to_vec();
    if is_solid(shape) && thickness(shape) > 0.1 * radius {
        reference_points.push(center);
        reference_points.push(center + (shape.bounds().extent() * 0.3) * random.point(1.0));
    }
    reference_points
}

/// Direction to the sample, and the point that a ray hits there unless the shape occludes it.
fn look_at_sample(shape: &AnyShape, from: Vec3, sample: &ShapeSample) -> (Vec3, Option<SurfacePoint>) {
    let offset = sample.point.as_dvec3() - from.as_dvec3();
    let direction = offset.normalize().as_vec3();
    let ray = Ray::new(from, direction);
    let found = shape.intersect(&ray).map(|hit| (shape.surface(&ray, &hit), hit.primitive));
    let found = found.map(|(Surface { point, normal, .. }, primitive)| SurfacePoint { point, normal, primitive });
    let near = 3e-3 * bounding_sphere(shape).1 + 1e-5 * from.abs().max_element();
    let same = |s: &SurfacePoint| s.point.distance(sample.point) < near && s.normal.dot(sample.normal) > 0.999;
    (direction, found.filter(same))
}

#[test]
fn samples_lie_on_the_surface_and_have_the_density_of_their_direction() {
    let mut random = Random::new(12);
    for shape in bounded() {
        let radius = bounding_sphere(&shape).1;
        for from in reference_points(&shape, &mut random) {
            let (mut visible, mut hidden) = (0, 0);
            for _ in 0..200 {
                let Some(sample) = shape.sample(from, random.vec2()) else { continue };
                let off = distance(&shape, sample.point.as_dvec3());
                let rounding = f64::from(f32::EPSILON * (4.0 * radius + 2.0 * sample.point.length()));
                assert!(off <= rounding, "{shape:?} {from}: {off}");
                assert!((sample.normal.length() - 1.0).abs() < 1e-6 && sample.pdf > 0.0 && sample.pdf.is_finite());
                let (direction, found) = look_at_sample(&shape, from, &sample);
                hidden += usize::from(found.is_none());
                // Edge-on, a density changes from one float to the next.
                let cosine = direction.dot(sample.normal).abs();
                if let Some(at) = found.filter(|_| cosine > 0.05) {
                    visible += 1;
                    let pdf = shape.pdf(from, &at);
                    let difference = (pdf / sample.pdf - 1.0).abs();
                    let tolerance = (1e-4 + 1e-6 * from.distance(sample.point) / thickness(&shape)) / (cosine * cosine);
                    assert!(difference < tolerance, "{shape:?} {from}: {pdf} {sample:?}");
                }
            }
            // From very far, f32 directions miss thin shapes.
            let excused = !is_convex(&shape) || from.distance(bounding_sphere(&shape).0) > 10.0 * radius;
            assert!(excused || hidden <= 4, "{shape:?} {from}: {hidden} samples are hidden, {visible} seen");
        }
    }
}

/// Integrals over the directions to a shape must be the same by its own samples and by uniformly
/// distributed directions.
#[test]
fn densities_integrate_to_the_solid_angle() {
    let functions: [fn(Vec3) -> f32; 4] = [|_| 1.0, |w| w.x * w.x, |w| w.y * w.y, |w| (w.x + 2.0 * w.z) * w.y + 1.0];
    let (mut random, mut tested) = (Random::new(13), 0);
    for shape in bounded() {
        let (center, radius) = bounding_sphere(&shape);
        for from in reference_points(&shape, &mut random) {
            let (axis, sin) = ((center - from).normalize_or(Vec3::X), radius / center.distance(from));
            let size = if sin < 1.0 { 1.0 - (1.0 - sin * sin).sqrt() } else { 2.0 };
            // So far away, f32 directions are too coarse for this test.
            if sin < 0.01 {
                continue;
            }
            let frame = Frame::around(axis);
            let count = if shape.triangles() > 1 { 3_000 } else { 10_000 };
            let even: Vec<(Vec3, f32)> = (0..count)
                .map(|_| frame.to_world(warp::uniform_cone(random.vec2(), size)))
                .map(|w| (w, if shape.occludes(&Ray::new(from, w)) { 2.0 * PI * size } else { 0.0 }))
                .collect();
            let own: Vec<(Vec3, f32)> = (0..count).map(|_| sample_weight(&shape, from, random.vec2())).collect();
            // Too few of the uniform directions hit thin shapes.
            if even.iter().filter(|(_, weight)| *weight > 0.0).count() < 100 {
                continue;
            }
            tested += 1;
            for function in functions {
                compare(&even, &own, function).unwrap_or_else(|error| panic!("{shape:?} from {from}: {error}"));
            }
        }
    }
    assert!(tested > 70, "{tested}");
}

/// Direction of a sample and its weight, 1 / pdf; 0 if the shape occludes it.
fn sample_weight(shape: &AnyShape, from: Vec3, u: juggler_math::Vec2) -> (Vec3, f32) {
    let Some(sample) = shape.sample(from, u) else { return (Vec3::X, 0.0) };
    let (direction, found) = look_at_sample(shape, from, &sample);
    (direction, if found.is_some() { 1.0 / sample.pdf } else { 0.0 })
}

fn compare(a: &[(Vec3, f32)], b: &[(Vec3, f32)], function: fn(Vec3) -> f32) -> Result<(), String> {
    let differences = a.iter().zip(b).map(|(a, b)| f64::from(function(a.0) * a.1) - f64::from(function(b.0) * b.1));
    let differences: Vec<f64> = differences.collect();
    // Without variance (a sphere seen from its center), only rounding is left.
    let rounding = 1e-5 * b.iter().map(|(_, weight)| f64::from(*weight)).sum::<f64>();
    if differences.iter().sum::<f64>().abs() < rounding { Ok(()) } else { z_test(&differences, 0.0, SIGNIFICANCE) }
}
