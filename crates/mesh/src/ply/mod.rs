//! Stanford PLY (Greg Turk, "The PLY Polygon File Format", 1994): text, little-endian or
//! big-endian.
//!
//! The reader uses the element `vertex` with `x y z`, `nx ny nz` and the first of `u v`, `s t` and
//! `texture_u texture_v`, and the element `face` with its list `vertex_indices` (or
//! `vertex_index`), in any order and of any number type, and triangle strips in `tristrips`. The
//! list `texcoord` of faces has u and v of each corner. Colors `red green blue` of vertices or
//! faces, perhaps with `alpha`, become the attribute `color`: integers are decoded as sRGB, floats
//! are linear. The columns `u1 v1` are the second set of surface coordinates, and `tx ty tz tw` the
//! tangents with the sign of the bitangent, as [`ply_bytes`] writes them. Columns `attribute.NAME`, or
//! `attribute.NAME.0` to `attribute.NAME.3`, of vertices or faces are the attribute NAME. The comment
//! `TextureFile` names a picture for a scene around the file ([`texture_file`]). The reader ignores
//! everything else with a warning that names it, including lines of the header that are neither
//! declarations nor comments, such as `Created by Blender3D`. In a text, each line is one row of an
//! element, as the header describes it. [`parse_points`] reads the rows of `vertex` alone, as points.

mod ascii;
mod attributes;
mod binary;
mod body;
mod colors;
mod corners;
mod declared;
mod header;
mod points;
mod rows;
mod strips;
#[cfg(test)]
mod tests;
mod values;
mod vertices;
mod write;

pub(crate) use attributes::NamedAttributes;
use declared::{DeclaredCounts, declared};
pub(crate) use points::declared_points;
pub use points::{PointFile, parse_points};
pub use write::{ply_bytes, points_bytes};

use crate::error::MeshErrorKind;
use crate::format::{MeshFormat, MeshFormatInfo};
use crate::limits::MeshLimits;
use crate::mesh_file::MeshFile;
use crate::pieces::PieceReader;
use crate::sampling::{Counts, FACE, FileSampler, lines, scaled, words};
use crate::text::Scanner;
use ascii::{AsciiValues, read_text};
use body::Body;
pub use header::texture_file;
use header::{Encoding, Header};
use std::io;

/// The format Stanford PLY.
pub const PLY: MeshFormatInfo = MeshFormatInfo { name: "PLY", extension: "ply", is_z_up: false };

/// Stanford PLY.
pub(crate) struct Ply;

impl MeshFormat for Ply {
    fn info(&self) -> MeshFormatInfo {
        PLY
    }

    fn is_content(&self, bytes: &[u8]) -> bool {
        let mut scanner = Scanner::with_obj_rules(bytes);
        scanner.word_anywhere() == Some(b"ply") && scanner.word().is_none()
    }

    fn read(&self, bytes: &[u8], limits: &MeshLimits, pieces: PieceReader<'_>) -> Result<MeshFile, MeshErrorKind> {
        let mut scanner = Scanner::new(bytes);
        let header = Header::read(&mut scanner)?;
        let body = Body::new(&header, limits, pieces);
        match header.encoding {
            Encoding::Ascii => {
                read_text(&AsciiValues::new(scanner), |values| body.read(values), |mesh| &mut mesh.warnings)
            }
            Encoding::Binary(order) => body.read(binary::BinaryValues::new(bytes, scanner.position(), order)),
        }
    }

    fn counts(&self, file: &mut FileSampler) -> io::Result<Counts> {
        polygons(file)
    }
}

/// Estimates the counts of a PLY. The header gives the number of vertices and faces. The number of
/// triangles follows from the length of a binary file, or from the last rows of a text.
fn polygons(file: &mut FileSampler) -> io::Result<Counts> {
    let Some(DeclaredCounts { vertices, vertex_bytes, face_bytes, faces, corners }) = declared(&file.head, file.size)
    else {
        return Ok(Counts::default());
    };
    let triangles = match corners {
        Some(corners) => corners.saturating_sub(faces.saturating_mul(2)),
        None => {
            let tail = file.tail()?;
            let rows = lines(&tail).skip(1).filter_map(|line| words(line).next()?.parse::<u64>().ok());
            let rows = rows.filter(|corners| *corners >= 3);
            let (rows, sum) = rows.fold((0, 0), |(rows, sum), corners| (rows + 1, sum + corners.min(1 << 10) - 2));
            scaled(sum, faces, rows)
        }
    }
    .max(faces);
    // Polygons are kept as runs of triangles. Arrays that turn out too small are copied into larger
    // ones.
    let temporary_bytes = if triangles > faces { faces * 32 + triangles * FACE } else { 0 };
    Ok(Counts { vertices, triangles, vertex_bytes, face_bytes, temporary_bytes })
}
