//! Surface coordinates of face corners, as MeshLab writes them: the list `texcoord` of an element
//! `face` holds u and v of each corner. Corners of one vertex with equal coordinates stay one vertex;
//! others become vertices of their own.

use super::header::{Element, Scalar};
use super::values::{Values, list_length};
use crate::assemble::MeshParts;
use crate::error::MeshErrorKind;
use crate::limits::MeshLimits;
use crate::text::finite;
use crate::weld::{Key, Welded, WeldedPiece};
use juggler_math::{BuildControl, Vec2, vec2};

/// Vertices of all faces by position and surface coordinates.
#[derive(Default)]
pub(super) struct CornerVertices {
    /// Welded corners and faces.
    pub welded: Welded,
    /// Number of faces whose list does not fit their corners.
    pub missing: u64,
}

/// Column of the coordinates of corners; `None` if there is none.
pub(super) fn column(element: &Element) -> Option<usize> {
    let column = element.column("texcoord")?;
    element.properties.get(column).filter(|property| property.length.is_some()).map(|_| column)
}

/// Reads a list of coordinates into `coordinates`.
pub(super) fn read_coordinates(
    values: &mut impl Values,
    (length, item): (Scalar, Scalar),
    coordinates: &mut Vec<f32>,
) -> Result<(), MeshErrorKind> {
    coordinates.clear();
    for _ in 0..list_length(values, length)? {
        let place = values.place();
        let number = values.real(item, "texcoord")?;
        finite(number, place, "texcoord")?;
        coordinates.push(number);
    }
    Ok(())
}

/// Adds a face whose corners have these coordinates, or 0 0 if their number does not fit. Returns
/// whether it fits.
pub(super) fn push(
    piece: &mut WeldedPiece,
    corners: &mut [u32],
    coordinates: &[f32],
    limits: &MeshLimits,
) -> Result<bool, MeshErrorKind> {
    let fits = coordinates.len() == corners.len().saturating_mul(2);
    let mut pairs = coordinates.as_chunks::<2>().0.iter().filter(|_| fits);
    for corner in corners.iter_mut() {
        // Adding 0 turns negative zeros positive, so that equal coordinates have equal bits.
        let uv = pairs.next().map_or([0; 2], |uv| uv.map(|number| (number + 0.0).to_bits()));
        *corner = piece.corners.index([*corner, uv[0], uv[1]], limits)?;
    }
    piece.faces.push(corners, limits)?;
    Ok(fits)
}

impl CornerVertices {
    /// Replaces the vertices and faces of `parts` by these.
    pub fn replace(
        self,
        parts: &mut MeshParts,
        limits: &MeshLimits,
        control: &BuildControl,
    ) -> Result<(), MeshErrorKind> {
        let (keys, faces) = self.welded.finish(limits, control)?;
        if self.missing > 0 {
            parts.warnings.push(format!("faces without texture coordinates, which get 0 0: {}", self.missing));
        }
        parts.positions = gather(&keys, &parts.positions);
        parts.normals = gather(&keys, &parts.normals);
        parts.uvs1 = gather(&keys, &parts.uvs1);
        parts.tangents = gather(&keys, &parts.tangents);
        let channels = parts.vertex_colors.channels.max(1);
        let colors: Vec<&[f32]> = parts.vertex_colors.values.chunks(channels).collect();
        parts.vertex_colors.values = gather(&keys, &colors).concat();
        for (_, attribute) in &mut parts.vertex_attributes {
            *attribute = attribute.with_positions(keys.iter().map(|[vertex, ..]| *vertex as usize));
        }
        parts.uvs = keys.iter().map(|[_, u, v]| coordinates(*u, *v)).collect();
        parts.faces = faces;
        Ok(())
    }
}

fn coordinates(u: u32, v: u32) -> Vec2 {
    vec2(f32::from_bits(u), f32::from_bits(v))
}

/// Values of the welded vertices, none if there are none.
fn gather<T: Copy>(keys: &[Key], values: &[T]) -> Vec<T> {
    keys.iter().filter_map(|[vertex, ..]| values.get(*vertex as usize).copied()).collect()
}
