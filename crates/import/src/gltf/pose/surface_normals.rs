//! Normals of a morphed mesh whose morph targets displace positions only.
//!
//! The surface normal of a vertex is the sum of the area normals of the triangles at it. Each
//! shading normal turns as the surface normal of its vertex does, so a mesh whose normals are those
//! of its surface gets those of the morphed surface, and any other mesh keeps its creases and its
//! weighting. Vertices that share position and normal, as at a seam of the texture, turn together.

use super::vertices::Vertices;
use glam::DVec3;
use juggler_math::Vec3;

/// Normals of `base` at the positions `moved`, in double precision.
pub(super) fn turned_normals(base: &Vertices, triangles: &[[u32; 3]], moved: &[DVec3]) -> Vec<DVec3> {
    let vertex_groups = vertex_groups(base);
    let still: Vec<DVec3> = base.positions.iter().map(|position| position.as_dvec3()).collect();
    let before = surface_normals(&still, triangles, &vertex_groups);
    let after = surface_normals(moved, triangles, &vertex_groups);
    let normals = base.normals.iter().zip(&vertex_groups);
    let turn = |(normal, group): (&Vec3, &u32)| {
        let ends = before.get(*group as usize).zip(after.get(*group as usize));
        let normal = normal.as_dvec3();
        ends.map_or(normal, |(from, to)| turned(normal, *from, *to))
    };
    normals.map(turn).collect()
}

/// Turns a vector by the smallest rotation from one unit vector to another (Möller and Hughes
/// 1999); unchanged if one of them is zero.
fn turned(vector: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    if from == to || from == DVec3::ZERO || to == DVec3::ZERO || vector == DVec3::ZERO {
        return vector;
    }
    let (axis, cosine) = (from.cross(to), from.dot(to));
    // Half turns have no smallest rotation.
    if cosine < -0.999_999 {
        return -vector;
    }
    let turned = vector * cosine + axis.cross(vector) + axis * (axis.dot(vector) / (1.0 + cosine));
    turned.normalize_or_zero()
}

/// Unit normal of the surface for each group of vertices, at the index of its first vertex; zero
/// where all triangles are degenerate.
fn surface_normals(positions: &[DVec3], triangles: &[[u32; 3]], vertex_groups: &[u32]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| positions.get(corner as usize).copied()) else {
            continue;
        };
        let area_normal = (b - a).cross(c - a);
        // A triangle adds its normal to a group once, even if two of its corners are in the group.
        let groups = corners.map(|corner| vertex_groups.get(corner as usize).copied());
        for (i, group) in groups.iter().enumerate() {
            let sum = group.filter(|_| !groups.iter().take(i).any(|earlier| earlier == group));
            if let Some(sum) = sum.and_then(|group| sums.get_mut(group as usize)) {
                *sum += area_normal;
            }
        }
    }
    sums.into_iter().map(DVec3::normalize_or_zero).collect()
}

/// For each vertex the first vertex with the same position and normal.
fn vertex_groups(base: &Vertices) -> Vec<u32> {
    let vertices = base.positions.iter().zip(&base.normals);
    // Adding 0 turns -0 into 0.
    let bits = |vector: &Vec3| vector.to_array().map(|number| (number + 0.0).to_bits());
    let mut keys: Vec<([u32; 3], [u32; 3], u32)> =
        vertices.zip(0_u32..).map(|((position, normal), i)| (bits(position), bits(normal), i)).collect();
    keys.sort_unstable();
    let mut vertex_groups = vec![0; keys.len()];
    for group in keys.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let Some((_, _, first)) = group.first() else { continue };
        for (_, _, vertex) in group {
            if let Some(slot) = vertex_groups.get_mut(*vertex as usize) {
                *slot = *first;
            }
        }
    }
    vertex_groups
}

#[cfg(test)]
mod tests {
    use super::super::testing::{height_field, random_rotation};
    use super::*;
    use juggler_math::quaternion;
    use juggler_math::testing::Random;

    #[test]
    fn normals_turn_with_their_surface() {
        let (mut base, triangles) = height_field(4, |_, _| 0.0);
        let mut random = Random::new(51);
        // Normals that differ from those of the surface.
        base.normals = base.positions.iter().map(|_| (Vec3::Z + 0.5 * random.unit_vector()).normalize()).collect();
        // About an axis in the surface, the smallest rotation is the rotation.
        for degrees in [1.0, 30.0, 150.0] {
            let rotation = quaternion::from_axis_degrees(DVec3::new(0.6, -0.8, 0.0), degrees).unwrap();
            let moved: Vec<DVec3> = base.positions.iter().map(|p| rotation * p.as_dvec3()).collect();
            for (normal, found) in base.normals.iter().zip(turned_normals(&base, &triangles, &moved)) {
                assert!((rotation * normal.as_dvec3()).distance(found) < 1e-6, "{degrees}");
            }
        }
    }

    #[test]
    fn vertices_at_a_seam_turn_together() {
        // A square whose triangles do not share their vertices, bent along the diagonal.
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
        let base = Vertices { positions: corners.to_vec(), normals: vec![Vec3::Z; 6], ..Vertices::default() };
        let mut moved: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
        moved[4].z = 1.0;
        let normals = turned_normals(&base, &[[0, 1, 2], [3, 4, 5]], &moved);
        assert_eq!((normals[1], normals[2], normals[0]), (normals[3], normals[5], DVec3::Z));
        let bent = DVec3::new(-1.0, -1.0, 1.0);
        assert!(normals[4].abs_diff_eq(bent.normalize(), 1e-12));
        assert!(normals[1].abs_diff_eq((bent + DVec3::Z).normalize(), 1e-12));
        // With different normals the edge is a crease.
        let creased = Vertices { normals: [[Vec3::Z; 3], [Vec3::X; 3]].concat(), ..base };
        let normals = turned_normals(&creased, &[[0, 1, 2], [3, 4, 5]], &moved);
        assert_eq!(&normals[..3], &[DVec3::Z; 3]);
    }

    #[test]
    fn smallest_rotations_move_one_vector_to_the_other() {
        let mut random = Random::new(52);
        for _ in 0..200 {
            let [from, to, other] = [(); 3].map(|()| random.unit_vector().as_dvec3().normalize());
            assert!(turned(from, from, to).abs_diff_eq(to, 1e-12));
            let across = from.cross(to);
            assert!(turned(across, from, to).abs_diff_eq(across.normalize_or_zero(), 1e-12));
            assert!((turned(other, from, to).length() - 1.0).abs() < 1e-12);
            let rotation = random_rotation(&mut random);
            let both = turned(rotation * other, rotation * from, rotation * to);
            assert!(both.abs_diff_eq(rotation * turned(other, from, to), 1e-9));
        }
        assert_eq!(turned(DVec3::X, DVec3::Z, -DVec3::Z), -DVec3::X);
        assert_eq!(turned(DVec3::X, DVec3::ZERO, DVec3::Z), DVec3::X);
        assert_eq!(turned(DVec3::ZERO, DVec3::X, DVec3::Z), DVec3::ZERO);
    }

    #[test]
    fn indices_out_of_range_are_skipped() {
        let base = Vertices { positions: vec![Vec3::ZERO; 2], normals: vec![Vec3::Z; 2], ..Vertices::default() };
        let normals = turned_normals(&base, &[[0, 1, 7], [u32::MAX; 3]], &[DVec3::X, DVec3::Y]);
        assert_eq!(normals, [DVec3::Z; 2]);
        assert!(turned_normals(&Vertices::default(), &[[0, 1, 2]], &[]).is_empty());
    }
}
