use super::super::testing::{height_field, random_f64, random_vertices};
use super::*;
use juggler_math::testing::Random;

/// Displacements of all attributes of vertices with two sets of texture coordinates.
fn random_deltas(random: &mut Random, count: usize) -> MorphDeltas {
    let vectors = |random: &mut Random| -> Vec<Vec3> { (0..count).map(|_| random.point(1.0)).collect() };
    let [positions, normals, tangents] = [(); 3].map(|()| vectors(random));
    let texcoords = [(); 2].map(|()| (0..count).map(|_| random.vec2() - 0.5).collect()).to_vec();
    let colors = (0..count).map(|_| [(); 4].map(|()| random.range(-1.0, 1.0))).collect();
    MorphDeltas { positions, normals, tangents, texcoords, colors }
}

/// Displacements of positions only.
fn raised(base: &Vertices, by: impl Fn(DVec3) -> f64) -> MorphDeltas {
    let raise = |position: &Vec3| DVec3::new(0.0, 0.0, by(position.as_dvec3())).as_vec3();
    MorphDeltas { positions: base.positions.iter().map(raise).collect(), ..MorphDeltas::default() }
}

#[test]
fn every_attribute_is_the_base_plus_weighted_displacements() {
    let mut random = Random::new(61);
    let base = random_vertices(&mut random, 20);
    let targets: Vec<MorphDeltas> = (0..5).map(|_| random_deltas(&mut random, 20)).collect();
    let weights: Vec<f64> = (0..5).map(|_| random_f64(&mut random, -1.0, 2.0)).collect();
    let morphed = morph(&base, &[], &targets, &weights).unwrap();
    for vertex in 0..20 {
        let sum = |of: &dyn Fn(&MorphDeltas) -> f32| -> f64 {
            targets.iter().zip(&weights).map(|(target, weight)| f64::from(of(target)) * weight).sum()
        };
        for axis in 0..3 {
            let expected = f64::from(base.positions[vertex][axis]) + sum(&|target| target.positions[vertex][axis]);
            assert!((morphed.positions[vertex][axis] - expected).abs() < 1e-14);
        }
        let normal = DVec3::from_array(
            [0, 1, 2].map(|i| f64::from(base.normals[vertex][i]) + sum(&|target| target.normals[vertex][i])),
        );
        assert!(morphed.normals[vertex].abs_diff_eq(normal.normalize(), 1e-13));
        let tangent = DVec3::from_array(
            [0, 1, 2].map(|i| f64::from(base.tangents[vertex][i]) + sum(&|target| target.tangents[vertex][i])),
        );
        assert!(morphed.tangents[vertex].abs_diff_eq(tangent.normalize(), 1e-13));
        for set in 0..2 {
            let u = f64::from(base.texcoords[set][vertex].x) + sum(&|target| target.texcoords[set][vertex].x);
            assert!((f64::from(morphed.texcoords[set][vertex].x) - u).abs() < 1e-6);
        }
        for channel in 0..4 {
            let color = f64::from(base.colors[vertex][channel]) + sum(&|target| target.colors[vertex][channel]);
            assert!((f64::from(morphed.colors[vertex][channel]) - color.clamp(0.0, 1.0)).abs() < 1e-7);
        }
    }
}

#[test]
fn weights_of_zero_leave_all_bits() {
    let mut random = Random::new(62);
    let base = random_vertices(&mut random, 10);
    let targets = [random_deltas(&mut random, 10), random_deltas(&mut random, 10)];
    for weights in [&[0.0, 0.0][..], &[], &[0.0]] {
        let morphed = morph(&base, &[[0, 1, 2]], &targets, weights).unwrap();
        assert!(morphed.positions.iter().zip(&base.positions).all(|(a, b)| a.as_vec3() == *b));
        assert!(morphed.normals.iter().zip(&base.normals).all(|(a, b)| a.as_vec3() == *b));
        assert_eq!((&morphed.texcoords, &morphed.colors), (&base.texcoords, &base.colors));
    }
}

#[test]
fn without_displaced_normals_the_normals_are_those_of_the_surface() {
    let (flat, triangles) = height_field(100, |_, _| 0.0);
    let base = Vertices { normals: vec![Vec3::Z; flat.positions.len()], ..flat };
    let height = |p: DVec3| 0.2 * (3.0 * p.x).sin() * (2.0 * p.y).cos();
    let targets = [raised(&base, height), raised(&base, |p| 0.3 * p.x * p.y)];
    let (weights, step) = ([0.8, 0.5], 1e-5);
    let morphed = morph(&base, &triangles, &targets, &weights).unwrap();
    let mut inner = 0;
    for (position, normal) in base.positions.iter().zip(&morphed.normals) {
        // Finite differences of the deformed surface, away from its border.
        let p = position.as_dvec3();
        let surface = |p: DVec3| weights[0] * height(p) + weights[1] * 0.3 * p.x * p.y;
        let slope = |axis: DVec3| (surface(p + axis * step) - surface(p - axis * step)) / (2.0 * step);
        let expected = DVec3::new(-slope(DVec3::X), -slope(DVec3::Y), 1.0).normalize();
        if p.x.min(p.y) > 0.0 && p.x.max(p.y) < 1.0 {
            assert!(normal.distance(expected) < 1e-3, "{p}: {normal} {expected}");
            inner += 1;
        }
    }
    assert_eq!(inner, 99 * 99);
}

#[test]
fn displaced_normals_win_over_those_of_the_surface() {
    let (flat, triangles) = height_field(2, |_, _| 0.0);
    let count = flat.positions.len();
    let base = Vertices { normals: vec![Vec3::Z; count], ..flat };
    let slope = raised(&base, |p| p.x);
    let with_normals = MorphDeltas { normals: vec![Vec3::X; count], ..slope.clone() };
    // One target of the mesh has normals, even if its weight is 0.
    let targets = [slope, with_normals];
    let normals = |weights: &[f64]| morph(&base, &triangles, &targets, weights).unwrap().normals;
    assert_eq!(normals(&[1.0, 0.0]), vec![DVec3::Z; count]);
    let leaning = DVec3::new(1.0, 0.0, 1.0).normalize();
    assert!(normals(&[0.0, 1.0]).iter().all(|normal| normal.abs_diff_eq(leaning, 1e-15)));
    // Without normals the mesh stays faceted.
    let faceted = Vertices { normals: Vec::new(), ..base };
    assert!(morph(&faceted, &triangles, &targets, &[1.0, 1.0]).unwrap().normals.is_empty());
}

#[test]
fn vectors_that_cancel_become_zero() {
    let base = Vertices { positions: vec![Vec3::ZERO], normals: vec![Vec3::Z], ..Vertices::default() };
    let opposite = MorphDeltas { normals: vec![-Vec3::Z], ..MorphDeltas::default() };
    assert_eq!(morph(&base, &[], &[opposite], &[1.0]).unwrap().normals, [DVec3::ZERO]);
}

#[test]
fn wrong_lengths_and_weights_are_errors() {
    let mut random = Random::new(63);
    let base = random_vertices(&mut random, 4);
    let (short, long) = (random_deltas(&mut random, 3), random_deltas(&mut random, 4));
    let error = morph(&base, &[], &[long.clone(), short.clone()], &[1.0]).unwrap_err();
    assert_eq!(error.to_string(), "morph target 1 has 3 displacements of `POSITION`; the mesh has 4");
    let texcoords = MorphDeltas { texcoords: short.texcoords, ..long.clone() };
    let error = morph(&base, &[], &[texcoords], &[1.0]).unwrap_err();
    assert!(matches!(error, MorphError::Count { attribute: "TEXCOORD", .. }));
    for weight in [f64::NAN, f64::INFINITY] {
        let error = morph(&base, &[], std::slice::from_ref(&long), &[weight]).unwrap_err();
        assert!(matches!(error, MorphError::Weight { target: 0, .. }));
    }
    // Attributes that the mesh lacks have no effect.
    let bare = Vertices { positions: base.positions, ..Vertices::default() };
    let morphed = morph(&bare, &[], &[long], &[1.0]).unwrap();
    assert!(morphed.normals.is_empty() && morphed.texcoords.is_empty() && morphed.colors.is_empty());
}
