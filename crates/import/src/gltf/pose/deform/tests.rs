use super::super::skin::InfluenceSet;
use super::super::testing::{height_field, is_rounded, random_affine, random_vertices};
use super::*;
use glam::{DAffine3, DVec3};
use juggler_math::testing::Random;
use juggler_math::{Vec2, Vec3};

#[test]
fn morph_targets_apply_before_the_skin_and_results_are_rounded_once() {
    let mut random = Random::new(81);
    let count = 40;
    let base = random_vertices(&mut random, count);
    let deltas = MorphDeltas { positions: (0..count).map(|_| random.point(1.0)).collect(), ..MorphDeltas::default() };
    let matrices = [random_affine(&mut random), random_affine(&mut random)];
    let joints = vec![[0, 1, 0, 0]; count];
    let weights: Vec<[f32; 4]> = (0..count).map(|_| random.f32()).map(|w| [w, 1.0 - w, 0.0, 0.0]).collect();
    let influences = [InfluenceSet { joints: &joints, weights: &weights }];
    let skin = SkinBinding { joint_matrices: &matrices, influences: &influences };
    let morphs = MorphBinding { targets: std::slice::from_ref(&deltas), weights: &[0.75] };
    let deformed = deform(&base, &[], morphs, Some(&skin)).unwrap();
    for (vertex, weights) in weights.iter().enumerate() {
        let morphed = base.positions[vertex].as_dvec3() + deltas.positions[vertex].as_dvec3() * 0.75;
        let [a, b] = [0, 1].map(|i| matrices[i].transform_point3(morphed) * f64::from(weights[i]));
        let sum = f64::from(weights[0]) + f64::from(weights[1]);
        assert!(is_rounded(deformed.vertices.positions[vertex], (a + b) / sum));
        assert!(deformed.bounds.contains(deformed.vertices.positions[vertex]));
        assert_eq!(deformed.vertices.tangents[vertex][3], base.tangents[vertex][3]);
    }
    assert_eq!((&deformed.vertices.texcoords, &deformed.vertices.colors), (&base.texcoords, &base.colors));
    // Skin, then morph, is another surface.
    let skinned = deform(&base, &[], MorphBinding::default(), Some(&skin)).unwrap();
    let swapped = deform(&skinned.vertices, &[], morphs, None).unwrap();
    assert!(swapped.vertices.positions[0].distance(deformed.vertices.positions[0]) > 0.01);
}

#[test]
fn bounds_are_the_smallest_box() {
    let base = Vertices { positions: vec![Vec3::ZERO, Vec3::new(1.0, -2.0, 3.0)], ..Vertices::default() };
    let deformed = deform(&base, &[], MorphBinding::default(), None).unwrap();
    assert_eq!((deformed.bounds.min, deformed.bounds.max), (Vec3::new(0.0, -2.0, 0.0), Vec3::new(1.0, 0.0, 3.0)));
    assert_eq!(deformed.vertices, base);
    let empty = deform(&Vertices::default(), &[], MorphBinding::default(), None).unwrap();
    assert!(empty.bounds.is_empty() && empty.vertices == Vertices::default());
}

#[test]
fn normals_of_a_deformed_surface_match_finite_differences() {
    // A morph target raises a wave from a sheet, and two joints shear it.
    let wave = |x: f64, y: f64| 0.1 * (4.0 * x).sin() * (3.0 * y).cos();
    let cells = 80;
    let (flat, triangles) = height_field(cells, |_, _| 0.0);
    let raise = |p: &Vec3| Vec3::Z * wave(p.x.into(), p.y.into()) as f32;
    let deltas = MorphDeltas { positions: flat.positions.iter().map(raise).collect(), ..MorphDeltas::default() };
    let base = Vertices { normals: vec![Vec3::Z; flat.positions.len()], ..flat };
    let turn = juggler_math::quaternion::from_axis_degrees(DVec3::new(0.3, 1.0, 0.2), 25.0).unwrap();
    let matrices =
        [DAffine3::IDENTITY, DAffine3::from_scale_rotation_translation(DVec3::new(1.0, 1.3, 0.8), turn, DVec3::ZERO)];
    let constant = 0.4;
    let joints = vec![[0, 1, 0, 0]; base.positions.len()];
    let weights = vec![[1.0 - constant, constant, 0.0, 0.0]; base.positions.len()];
    let skin =
        SkinBinding { joint_matrices: &matrices, influences: &[InfluenceSet { joints: &joints, weights: &weights }] };
    let morphs = MorphBinding { targets: &[deltas], weights: &[1.0] };
    let deformed = deform(&base, &triangles, morphs, Some(&skin)).unwrap();
    let surface = |x: f64, y: f64| {
        let point = DVec3::new(x, y, wave(x, y));
        point * (1.0 - f64::from(constant)) + matrices[1].transform_point3(point) * f64::from(constant)
    };
    let step = 1e-5;
    for (p, normal) in base.positions.iter().zip(&deformed.vertices.normals) {
        let (x, y) = (f64::from(p.x), f64::from(p.y));
        let expected = (surface(x + step, y) - surface(x - step, y)).cross(surface(x, y + step) - surface(x, y - step));
        if x.min(y) > 0.0 && x.max(y) < 1.0 {
            assert!(normal.as_dvec3().distance(expected.normalize()) < 2e-3, "{p}: {normal}");
        }
    }
}

#[test]
fn poses_beyond_the_range_of_numbers_are_errors() {
    let base = Vertices { positions: vec![Vec3::ZERO, Vec3::ONE], normals: vec![Vec3::Z; 2], ..Vertices::default() };
    let weights = [[1.0, 0.0, 0.0, 0.0]; 2];
    let influences = [InfluenceSet { joints: &[[0; 4]; 2], weights: &weights }];
    for scale in [1e39, 1e300, f64::INFINITY, f64::NAN] {
        let matrices =
            [DAffine3 { matrix3: DAffine3::from_scale(DVec3::splat(scale)).matrix3, translation: DVec3::ZERO }];
        let skin = SkinBinding { joint_matrices: &matrices, influences: &influences };
        let error = deform(&base, &[], MorphBinding::default(), Some(&skin)).unwrap_err();
        assert!(matches!(error, DeformError::NotFinite { .. }), "{scale}: {error}");
    }
    let far = MorphDeltas { positions: vec![Vec3::splat(f32::MAX); 2], ..MorphDeltas::default() };
    let morphs = MorphBinding { targets: &[far], weights: &[1e300] };
    assert_eq!(deform(&base, &[], morphs, None), Err(DeformError::NotFinite { vertex: 0 }));
    let base = Vertices { texcoords: vec![vec![Vec2::ZERO]], colors: vec![[0.0; 4]], ..Vertices::default() };
    let (texcoords, colors) = (vec![vec![Vec2::splat(2.0)]], vec![[2.0, -2.0, 0.0, 0.0]]);
    let targets = vec![MorphDeltas { texcoords, colors, ..MorphDeltas::default() }; 2];
    let morphs = MorphBinding { targets: &targets, weights: &[1e307, -1e307] };
    assert!(deform(&base, &[], morphs, None).is_ok_and(|deformed| deformed.vertices == base));
    let morphs = MorphBinding { weights: &[f64::MAX, -f64::MAX], ..morphs };
    assert_eq!(deform(&base, &[], morphs, None), Err(DeformError::NotFinite { vertex: 0 }));
    // Colors are clamped.
    let colored = Vertices { texcoords: Vec::new(), ..base };
    let channels = deform(&colored, &[], morphs, None).unwrap().vertices.colors[0];
    assert!(channels.iter().all(|channel| (0.0..=1.0).contains(channel)));
}
