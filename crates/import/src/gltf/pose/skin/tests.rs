use super::super::testing::{difference, random_affine, random_f64};
use super::*;
use glam::DMat4;
use juggler_math::testing::Random;

/// Joints and weights of the sets of influences.
type Sets = Vec<(Vec<[u16; 4]>, Vec<[f32; 4]>)>;

/// Influences with random joints and weights, which sum to about 1 over all sets.
fn random_sets(random: &mut Random, sets: usize, vertices: usize, joints: usize) -> Sets {
    let mut influences: Sets = (0..sets).map(|_| (Vec::new(), Vec::new())).collect();
    for _ in 0..vertices {
        let weights: Vec<[f32; 4]> = (0..sets).map(|_| [(); 4].map(|()| random.f32())).collect();
        let sum: f32 = weights.iter().flatten().sum();
        for ((joint_array, weight_array), weights) in influences.iter_mut().zip(weights) {
            joint_array.push([(); 4].map(|()| random.below(joints) as u16));
            weight_array.push(weights.map(|weight| weight / sum));
        }
    }
    influences
}

fn borrowed(sets: &Sets) -> Vec<InfluenceSet<'_>> {
    sets.iter().map(|(joints, weights)| InfluenceSet { joints, weights }).collect()
}

fn points(positions: Vec<DVec3>) -> MorphedVertices {
    MorphedVertices { positions, normals: Vec::new(), tangents: Vec::new(), texcoords: Vec::new(), colors: Vec::new() }
}

/// One joint that influences the only vertex with a weight.
fn single(joint: u16, weight: f32) -> Sets {
    vec![(vec![[joint, 0, 0, 0]], vec![[weight, 0.0, 0.0, 0.0]])]
}

#[test]
fn vertices_are_blended_by_their_influences() {
    let mut random = Random::new(71);
    for sets in [1, 2, 3] {
        let (vertices, joints) = (50, 9);
        let matrices: Vec<DAffine3> = (0..joints).map(|_| random_affine(&mut random)).collect();
        let influences = random_sets(&mut random, sets, vertices, joints);
        let positions: Vec<DVec3> = (0..vertices).map(|_| random.point(2.0).as_dvec3()).collect();
        let normals: Vec<DVec3> = (0..vertices).map(|_| random.unit_vector().as_dvec3()).collect();
        let base = MorphedVertices { normals: normals.clone(), tangents: normals.clone(), ..points(positions.clone()) };
        let binding = SkinBinding { joint_matrices: &matrices, influences: &borrowed(&influences) };
        let (skinned, counts) = binding.skin(base).unwrap();
        assert_eq!((counts.renormalized, counts.unweighted), (0, 0));
        for vertex in 0..vertices {
            // Sum positions instead of matrices, influence by influence.
            let (mut position, mut matrix, mut sum) = (DVec3::ZERO, DMat4::ZERO, 0.0);
            for (joints, weights) in &influences {
                for i in 0..4 {
                    let (joint, weight) = (usize::from(joints[vertex][i]), f64::from(weights[vertex][i]));
                    position += matrices[joint].transform_point3(positions[vertex]) * weight;
                    matrix += DMat4::from(matrices[joint]) * weight;
                    sum += weight;
                }
            }
            assert!(skinned.positions[vertex].abs_diff_eq(position / sum, 1e-12));
            let normal = matrix.inverse().transpose().transform_vector3(normals[vertex]).normalize();
            assert!(skinned.normals[vertex].abs_diff_eq(normal, 1e-9));
            let tangent = matrix.transform_vector3(normals[vertex]).normalize();
            assert!(skinned.tangents[vertex].abs_diff_eq(tangent, 1e-12));
        }
    }
}

#[test]
fn joint_matrices_undo_the_bind_pose() {
    let mut random = Random::new(72);
    let worlds: Vec<DAffine3> = (0..5).map(|_| random_affine(&mut random)).collect();
    let columns = |map: &DAffine3| DMat4::from(map.inverse()).to_cols_array().map(|element| element as f32);
    let (joints, inverse_binds) = ([3, 1, 4], [3, 1, 4].map(|node: usize| columns(&worlds[node])));
    let skin = Skin::new(&joints, Some(&inverse_binds)).unwrap();
    for matrix in skin.joint_matrices(&worlds).unwrap() {
        assert!(difference(&matrix, &DAffine3::IDENTITY) < 1e-4, "{matrix}");
    }
    // Without matrices the joints' own transforms remain.
    let bare = Skin::new(&joints, None).unwrap();
    assert_eq!(bare.joint_matrices(&worlds).unwrap(), [worlds[3], worlds[1], worlds[4]]);
}

/// Joints that left their bind pose: inverse bind matrices apply before the joints' transforms.
#[test]
fn joint_matrices_apply_the_inverse_bind_matrix_first() {
    let mut random = Random::new(74);
    let worlds: Vec<DAffine3> = (0..5).map(|_| random_affine(&mut random)).collect();
    let inverse_binds: Vec<DAffine3> = (0..3).map(|_| random_affine(&mut random)).collect();
    let columns = |map: &DAffine3| DMat4::from(*map).to_cols_array().map(|element| element as f32);
    let (joints, columns) = ([3, 1, 4], inverse_binds.iter().map(columns).collect::<Vec<_>>());
    let matrices = Skin::new(&joints, Some(&columns)).unwrap().joint_matrices(&worlds).unwrap();
    for ((matrix, node), inverse_bind) in matrices.iter().zip(joints).zip(&inverse_binds) {
        let point = random.point(2.0).as_dvec3();
        let expected = worlds[node].transform_point3(inverse_bind.transform_point3(point));
        let found = matrix.transform_point3(point);
        assert!(found.abs_diff_eq(expected, 1e-4 * expected.length().max(1.0)), "{found} for {expected}");
    }
}

#[test]
fn normals_stay_perpendicular_to_the_deformed_surface() {
    // M shears, so it turns normals and tangents differently.
    let mut random = Random::new(73);
    let bend = juggler_math::quaternion::from_axis_degrees(DVec3::Z, 40.0).unwrap();
    let matrices =
        [DAffine3::IDENTITY, DAffine3::from_scale_rotation_translation(DVec3::new(1.0, 2.0, 0.5), bend, DVec3::Y)];
    for _ in 0..100 {
        let (n, along) = (random.unit_vector().as_dvec3(), random.unit_vector().as_dvec3());
        let weight = random.f32();
        let influences = vec![(vec![[0, 1, 0, 0]], vec![[1.0 - weight, weight, 0.0, 0.0]])];
        let binding = SkinBinding { joint_matrices: &matrices, influences: &borrowed(&influences) };
        let base = MorphedVertices { normals: vec![n], tangents: vec![n.cross(along)], ..points(vec![n]) };
        let (skinned, counts) = binding.skin(base).unwrap();
        assert!(skinned.normals[0].dot(skinned.tangents[0]).abs() < 1e-12 && counts.mirrored == 0);
        assert!((skinned.normals[0].length() - 1.0).abs() < 1e-14);
    }
}

#[test]
fn mirrored_joints_keep_normals_outside() {
    let mirror = [DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0))];
    let influences = single(0, 1.0);
    let binding = SkinBinding { joint_matrices: &mirror, influences: &borrowed(&influences) };
    let base = MorphedVertices { normals: vec![DVec3::X], ..points(vec![DVec3::X * 2.0]) };
    let (skinned, counts) = binding.skin(base).unwrap();
    assert_eq!((skinned.positions[0], skinned.normals[0], counts.mirrored), (DVec3::X * -2.0, -DVec3::X, 1));
}

#[test]
fn weights_are_divided_by_their_sum() {
    let mut random = Random::new(74);
    let matrices = [random_affine(&mut random)];
    let point = DVec3::new(1.0, 2.0, 3.0);
    for (weight, renormalized, unweighted) in
        [(1.0, 0, 0), (0.9995, 0, 0), (0.5, 1, 0), (3.0, 1, 0), (0.0, 0, 1), (-1.0, 0, 1)]
    {
        let influences = single(0, weight);
        let binding = SkinBinding { joint_matrices: &matrices, influences: &borrowed(&influences) };
        let (skinned, counts) = binding.skin(points(vec![point])).unwrap();
        assert_eq!((counts.renormalized, counts.unweighted), (renormalized, unweighted), "{weight}");
        let expected = if weight > 0.0 { matrices[0].transform_point3(point) } else { point };
        assert!(skinned.positions[0].abs_diff_eq(expected, 1e-14), "{weight}");
    }
}

#[test]
fn zero_normals_and_collapsed_joints_give_zero() {
    let matrices = [DAffine3::from_scale(DVec3::ZERO)];
    let influences = single(0, 1.0);
    let binding = SkinBinding { joint_matrices: &matrices, influences: &borrowed(&influences) };
    let base = MorphedVertices { normals: vec![DVec3::Z], tangents: vec![DVec3::X], ..points(vec![DVec3::ONE]) };
    let (skinned, _) = binding.skin(base).unwrap();
    assert_eq!(
        (skinned.positions[0], skinned.normals[0], skinned.tangents[0]),
        (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO)
    );
    let binding = SkinBinding { joint_matrices: &[DAffine3::IDENTITY], ..binding };
    let base = MorphedVertices { normals: vec![DVec3::ZERO], ..points(vec![DVec3::ONE]) };
    assert_eq!(binding.skin(base).unwrap().0.normals, [DVec3::ZERO]);
}

#[test]
fn malformed_skins_are_errors() {
    let identity = DMat4::IDENTITY.to_cols_array().map(|element| element as f32);
    assert_eq!(Skin::new(&[0, 1], Some(&[identity])), Err(SkinError::InverseBindCount { found: 1, joints: 2 }));
    assert!(Skin::new(&[0], Some(&[identity, identity])).is_ok());
    let error = Skin::new(&[0, 0], Some(&[identity, [f32::NAN; 16]])).unwrap_err();
    assert_eq!(error.to_string(), "inverse bind matrix 1: element 0 of the matrix is NaN; all 16 must be finite");
    let outside = Skin::new(&[0, 7], None).unwrap().joint_matrices(&[DAffine3::IDENTITY]);
    assert_eq!(outside, Err(SkinError::Node { joint: 1, node: 7, nodes: 1 }));
}

#[test]
fn malformed_influences_are_errors() {
    let matrices = [DAffine3::IDENTITY];
    let skin = |sets: &Sets, vertices: usize| {
        let binding = SkinBinding { joint_matrices: &matrices, influences: &borrowed(sets) };
        binding.skin(points(vec![DVec3::ONE; vertices])).map(|(skinned, _)| skinned.positions)
    };
    assert_eq!(skin(&single(1, 0.5), 1), Err(SkinError::Joint { vertex: 0, joint: 1, joints: 1 }));
    assert_eq!(skin(&single(u16::MAX, 0.0), 1), Ok(vec![DVec3::ONE]));
    assert!(matches!(skin(&single(0, f32::NAN), 1), Err(SkinError::Weight { vertex: 0, .. })));
    assert_eq!(skin(&single(0, 1.0), 2), Err(SkinError::Count { set: 0, found: 1, expected: 2 }));
    assert_eq!(
        skin(&vec![(vec![[0; 4]; 3], vec![[1.0; 4]; 2])], 3),
        Err(SkinError::Count { set: 0, found: 2, expected: 3 })
    );
    assert_eq!(skin(&Vec::new(), 2), Ok(vec![DVec3::ONE; 2]));
    let mut random = Random::new(75);
    assert!(skin(&single(0, random_f64(&mut random, 0.1, 1.0) as f32), 1).is_ok());
}
