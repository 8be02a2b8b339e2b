//! Smooth shading normals, up to a crease angle, for a mesh without normals: corners of triangles
//! that share an edge are smoothed together where the triangles' normals differ by no more than the
//! angle, as in Blender's "shade smooth by angle". Positions are split where corners are not
//! smoothed together.

use super::MeshData;
use crate::attribute::MeshAttribute;
use crate::{InvalidShape, check};
use juggler_math::{BuildControl, Cancelled, DVec3, portable};

/// Maximum number of triangles, so that the index of every corner fits a `u32`.
const MAX_TRIANGLES: usize = 1 << 30;
/// Number of items that are treated between tests for cancellation.
const CHECKED: usize = 1 << 16;
/// Number of positions whose edges or corners are sorted together.
const POSITIONS_OF_LIST: usize = 1 << 16;

/// Smoothing groups of a mesh's corners.
pub struct SmoothingGroups {
    /// Index triples into the split positions, one for each triangle.
    triangles: Vec<[u32; 3]>,
    /// For each split position, the original position and its smoothing group: the first split
    /// position of the group.
    corners: Vec<(u32, u32)>,
}

impl SmoothingGroups {
    /// Smoothing groups of a mesh. Edges are creases where the normals of their two triangles
    /// differ by more than the angle, in degrees; edges of one triangle, and of more than two, are
    /// creases too. Coincident positions count as one.
    pub fn new(data: &MeshData, angle_degrees: f32, control: &BuildControl) -> Result<Self, InvalidShape> {
        check::number("crease_angle_degrees", angle_degrees, 0.0, 180.0)?;
        data.check()?;
        if data.triangles.len() > MAX_TRIANGLES {
            let message = format!("a mesh with a crease angle has at most {MAX_TRIANGLES} triangles");
            return Err(check::invalid("crease_angle_degrees", message));
        }
        let groups = groups(data, f64::from(portable::cos(angle_degrees.to_radians())), control)?;
        let firsts = first_corners(data, &groups, control)?;
        let (mut corners, mut indices) = (Vec::new(), Vec::with_capacity(firsts.len()));
        let all = data.triangles.as_flattened().iter().zip(groups).zip(firsts);
        for (corner, ((position, group), first)) in all.enumerate() {
            if corner.is_multiple_of(CHECKED) {
                control.check()?;
            }
            // Split positions before this corner are known, and the first corner of a group or of a split
            // position is not behind others of it.
            let next = corners.len() as u32;
            let split = |indices: &Vec<u32>, corner: u32| indices.get(corner as usize).copied().unwrap_or(next);
            if first as usize == corner {
                corners.push((*position, split(&indices, group)));
            }
            indices.push(split(&indices, first));
        }
        Ok(Self { triangles: indices.as_chunks().0.to_vec(), corners })
    }

    /// Mesh of the split positions with the normals of their groups: means of the triangles'
    /// normals weighted by area. A mesh that has normals stays unchanged.
    pub fn smoothed(&self, data: MeshData, control: &BuildControl) -> Result<MeshData, Cancelled> {
        if !data.normals.is_empty() {
            return Ok(data);
        }
        let mut sums = vec![DVec3::ZERO; self.corners.len()];
        for (number, corners) in self.triangles.iter().enumerate() {
            if number.is_multiple_of(CHECKED) {
                control.check()?;
            }
            let Some(triangle) = data.triangle_geometry(number) else { continue };
            for corner in corners {
                let group = self.corners.get(*corner as usize).and_then(|(_, group)| sums.get_mut(*group as usize));
                group.into_iter().for_each(|sum| *sum += triangle.area_normal());
            }
        }
        let normal = |group: u32| sums.get(group as usize).copied().unwrap_or_default().normalize_or_zero().as_vec3();
        let mut normals = Vec::with_capacity(self.corners.len());
        for corners in self.corners.chunks(CHECKED) {
            control.check()?;
            normals.extend(corners.iter().map(|(_, group)| normal(*group)));
        }
        let attributes = data.attributes.iter().map(|(name, values)| (name.clone(), self.split_attribute(values)));
        Ok(MeshData {
            positions: self.split(&data.positions),
            triangles: self.triangles.clone(),
            normals,
            uvs: self.split(&data.uvs),
            uvs1: self.split(&data.uvs1),
            tangents: self.split(&data.tangents),
            attributes: attributes.collect(),
        })
    }
}

impl SmoothingGroups {
    /// Values of the split positions.
    fn split<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.corners.iter().filter_map(|(position, _)| values.get(*position as usize).copied()).collect()
    }

    fn split_attribute(&self, attribute: &MeshAttribute) -> MeshAttribute {
        attribute.with_positions(self.corners.iter().map(|(position, _)| *position as usize))
    }
}

/// An edge of a triangle by the coincident positions of its ends, the lower one first, and the corners
/// at its ends.
type Edge = ([u32; 2], [u32; 2]);

/// Unit normal of the triangle of a corner; zero without an area, `None` beyond the mesh.
fn normal_at(data: &MeshData, corner: u32) -> Option<DVec3> {
    data.triangle_geometry(corner as usize / 3).map(|triangle| triangle.area_normal().normalize_or_zero())
}

/// Items in `count` lists, so that the sorting of each list is short. Each item is beside the index of
/// its list.
fn lists<T>(
    count: usize,
    items: impl Iterator<Item = (usize, T)>,
    control: &BuildControl,
) -> Result<Vec<Vec<T>>, Cancelled> {
    let mut lists: Vec<Vec<T>> = (0..count).map(|_| Vec::new()).collect();
    for (number, (index, item)) in items.enumerate() {
        if number.is_multiple_of(CHECKED) {
            control.check()?;
        }
        if let Some(list) = lists.get_mut(index) {
            list.push(item);
        }
    }
    Ok(lists)
}

/// For each corner of each triangle, the index of its smoothing group.
fn groups(data: &MeshData, least_cosine: f64, control: &BuildControl) -> Result<Vec<u32>, Cancelled> {
    let mut groups: Vec<u32> = (0..3 * data.triangles.len() as u32).collect();
    for mut edges in edges(data, control)? {
        control.check()?;
        edges.sort_unstable();
        control.check()?;
        for shared in edges.chunk_by(|a, b| a.0 == b.0) {
            let [(_, one), (_, other)] = shared else { continue };
            let (Some(a), Some(b)) = (normal_at(data, one[0]), normal_at(data, other[0])) else { continue };
            // Tolerance, so that an edge of exactly the angle is smooth despite rounding.
            if a.dot(b) >= least_cosine - 1e-6 {
                (0..2).for_each(|end| join(&mut groups, one[end], other[end]));
            }
        }
    }
    for corner in 0..groups.len() {
        if corner.is_multiple_of(CHECKED) {
            control.check()?;
        }
        let root = root(&mut groups, corner as u32);
        groups.get_mut(corner).into_iter().for_each(|group| *group = root);
    }
    Ok(groups)
}

/// Edges of triangles with an area, in lists by ranges of their lower positions.
fn edges(data: &MeshData, control: &BuildControl) -> Result<Vec<Vec<Edge>>, Cancelled> {
    let places = coincident_positions(data, control)?;
    let place = |position: u32| places.get(position as usize).copied().unwrap_or(position);
    let triangles = (0u32..).step_by(3).zip(&data.triangles);
    let with_area = triangles.filter(|(first, _)| normal_at(data, *first).is_some_and(|normal| normal != DVec3::ZERO));
    let edges = with_area.flat_map(|(first, triangle)| {
        let ends = triangle.map(place);
        [(0, 1), (1, 2), (2, 0)].map(|(from, to)| {
            let corners = [first + from as u32, first + to as u32];
            let [a, b] = [ends[from], ends[to]];
            if a <= b { ([a, b], corners) } else { ([b, a], [corners[1], corners[0]]) }
        })
    });
    let in_lists = edges.map(|edge: Edge| (edge.0[0] as usize / POSITIONS_OF_LIST, edge));
    lists(number_of_lists(data), in_lists, control)
}

/// Number of lists for edges and corners by their positions.
fn number_of_lists(data: &MeshData) -> usize {
    data.positions.len() / POSITIONS_OF_LIST + 1
}

/// For each position, the lowest index of a coincident position.
fn coincident_positions(data: &MeshData, control: &BuildControl) -> Result<Vec<u32>, Cancelled> {
    let count = number_of_lists(data);
    let bits = data.positions.iter().map(|at| (*at + 0.0).to_array().map(f32::to_bits));
    let in_lists = bits.zip(0u32..).map(|(bits, position)| {
        let hash = bits.iter().fold(0u32, |hash, bits| (hash.rotate_left(15) ^ bits).wrapping_mul(0x9e37_79b9));
        (hash as usize % count, (bits, position))
    });
    let mut places = vec![0; data.positions.len()];
    for mut positions in lists(count, in_lists, control)? {
        control.check()?;
        positions.sort_unstable();
        for same in positions.chunk_by(|a, b| a.0 == b.0) {
            for (_, position) in same {
                if let (Some(place), Some((_, first))) = (places.get_mut(*position as usize), same.first()) {
                    *place = *first;
                }
            }
        }
    }
    Ok(places)
}

/// For each corner of each triangle, the first corner of the same position and smoothing group.
fn first_corners(data: &MeshData, groups: &[u32], control: &BuildControl) -> Result<Vec<u32>, Cancelled> {
    let corners = data.triangles.as_flattened().iter().zip(groups).zip(0u32..);
    let in_lists = corners
        .map(|((position, group), corner)| (*position as usize / POSITIONS_OF_LIST, (*position, *group, corner)));
    let mut firsts = vec![0; groups.len()];
    for mut corners in lists(number_of_lists(data), in_lists, control)? {
        control.check()?;
        corners.sort_unstable();
        for same in corners.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            for (.., corner) in same {
                if let (Some(slot), Some((.., first))) = (firsts.get_mut(*corner as usize), same.first()) {
                    *slot = *first;
                }
            }
        }
    }
    Ok(firsts)
}

/// Lowest corner of a group; shortens the path to it (union-find by path halving).
fn root(groups: &mut [u32], mut corner: u32) -> u32 {
    while let Some(next) = groups.get(corner as usize).copied()
        && next != corner
    {
        let beyond = groups.get(next as usize).copied().unwrap_or(next);
        if let Some(group) = groups.get_mut(corner as usize) {
            *group = beyond;
        }
        corner = beyond;
    }
    corner
}

fn join(groups: &mut [u32], a: u32, b: u32) {
    let (a, b) = (root(groups, a), root(groups, b));
    if let Some(group) = groups.get_mut(a.max(b) as usize) {
        *group = a.min(b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_math::testing::close3;
    use juggler_math::{Vec2, Vec3};

    /// Strip of quads, bent by these angles at the edges between them, without duplicate positions.
    fn strip(angles: &[f32]) -> MeshData {
        let (mut at, mut turn) = (Vec3::ZERO, 0.0f32);
        let mut data = MeshData::default();
        let line = |data: &mut MeshData, at: Vec3| data.positions.extend([at, at + Vec3::Y]);
        line(&mut data, at);
        for (i, angle) in std::iter::once(&0.0).chain(angles).enumerate() {
            turn += angle.to_radians();
            let (sin, cos) = portable::sin_cos(turn);
            at += Vec3::new(cos, 0.0, -sin);
            line(&mut data, at);
            let i = 2 * i as u32;
            data.triangles.extend([[i, i + 2, i + 1], [i + 1, i + 2, i + 3]]);
        }
        data
    }

    fn smooth(data: MeshData, angle: f32) -> MeshData {
        let control = BuildControl::default();
        SmoothingGroups::new(&data, angle, &control).unwrap().smoothed(data, &control).unwrap()
    }

    #[test]
    fn edges_up_to_the_angle_are_smooth_and_others_are_creases() {
        let bent = smooth(strip(&[20.0, 60.0]), 30.0);
        assert_eq!(bent.triangles.len(), 6);
        // The edge bent by 60 degrees is split.
        assert_eq!(bent.positions.len(), 8 + 2);
        bent.check().unwrap();
        let normal_of = |triangle: usize, corner: usize| bent.normals[bent.triangles[triangle][corner] as usize];
        let turned = |degrees: f32| {
            let (sin, cos) = portable::sin_cos(degrees.to_radians());
            Vec3::new(sin, 0.0, cos)
        };
        assert!(close3(normal_of(2, 1), turned(20.0), 1e-6), "before the crease");
        assert!(close3(normal_of(4, 0), turned(80.0), 1e-6), "after the crease");
        // Both corners of the smooth edge have one normal, weighted by area; one of them has two
        // triangles of one side.
        for (triangle, corner) in [(0, 1), (2, 0)] {
            let normal = normal_of(triangle, corner);
            assert!(normal.dot(turned(10.0)) > 0.99 && (normal.length() - 1.0).abs() < 1e-6, "{normal}");
        }
        assert_eq!(normal_of(0, 1), normal_of(2, 0));
        assert_eq!(smooth(strip(&[30.0]), 30.0).positions.len(), 6, "the angle itself is smooth");
        assert_eq!(smooth(strip(&[30.1]), 30.0).positions.len(), 8);
    }

    #[test]
    fn coincident_positions_share_smooth_normals_and_keep_their_uvs() {
        // Triangles that share no positions, as in files without indices.
        let whole = strip(&[20.0]);
        let positions: Vec<Vec3> =
            whole.triangles.as_flattened().iter().map(|at| whole.positions[*at as usize]).collect();
        let uvs: Vec<Vec2> = (0..positions.len()).map(|i| Vec2::new(i as f32, 0.5)).collect();
        let triangles = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let soup = smooth(MeshData { positions, triangles, uvs: uvs.clone(), ..MeshData::default() }, 30.0);
        assert_eq!((soup.positions.len(), soup.uvs), (12, uvs));
        let welded = smooth(whole, 30.0);
        for (soup_corner, corner) in soup.triangles.as_flattened().iter().zip(welded.triangles.as_flattened()) {
            assert_eq!(soup.normals[*soup_corner as usize], welded.normals[*corner as usize]);
        }
    }

    #[test]
    fn crease_angle_0_is_flat_and_180_is_smooth() {
        let data = strip(&[20.0, 60.0, 170.0]);
        let round = smooth(data.clone(), 180.0);
        assert_eq!(round.positions.len(), data.positions.len());
        let flat = smooth(data.clone(), 0.0);
        for (number, corners) in flat.triangles.iter().enumerate() {
            let normal = data.triangle_geometry(number).unwrap().area_normal().normalize().as_vec3();
            assert!(corners.iter().all(|corner| close3(flat.normals[*corner as usize], normal, 1e-5)));
        }
        let own = MeshData { normals: vec![Vec3::Y; data.positions.len()], ..data.clone() };
        assert_eq!(smooth(own.clone(), 30.0), own, "a mesh with normals keeps them");
        assert_eq!(
            SmoothingGroups::new(&data, 181.0, &BuildControl::default()).err().unwrap().field,
            "crease_angle_degrees"
        );
        assert!(
            SmoothingGroups::new(&MeshData { triangles: vec![[0, 1, 99]], ..data }, 30.0, &BuildControl::default())
                .is_err()
        );
    }
}
