//! Mesh files: readers of Wavefront OBJ, Stanford PLY and STL, and a writer of PLY.
//!
//! [`load`] reads a file of any of these formats as one mesh, with the solids of an STL, and
//! [`parse_obj`] an OBJ with what its statements say about the faces. [`ply_bytes`] writes a PLY.
//! [`parse_points`] and [`points_bytes`] read and write the vertices of a PLY alone, for instances.
//!
//! The readers are written here because the available crates do not say where a file is wrong (tobj
//! 4.0.5 has an enum without a position, stl_io 0.11.0 an `io::Error` without an offset, ply-rs-bw
//! 4.0.1 no offset in binary files) and take 1.5 to 4 times as long on a million triangles (binary
//! PLY at 177 MB/s, here 697 MB/s). The readers share the scanner of words and numbers ([`text`]),
//! triangulation (`faces`) and vertex welding (`weld`).
//!
//! Memory use is bounded by the actual size of a file: counts declared by a header are checked
//! against it and against [`MeshLimits`] before memory is allocated.

mod assemble;
mod detect;
mod error;
mod estimate;
mod faces;
mod format;
mod formats;
mod limits;
mod load;
mod mesh_file;
mod obj;
mod pieces;
mod ply;
mod sampling;
mod stl;
#[cfg(test)]
mod tests;
pub mod text;
mod unsupported;
mod weld;

pub use detect::FileContent;
pub use error::{FilePosition, MeshError, MeshErrorKind};
pub use estimate::{MeshEstimate, PointEstimate, estimate, estimate_bytes, estimate_points, points_of_head};
pub use format::MeshFormatInfo;
pub use limits::MeshLimits;
pub use load::{load, parse, parse_with_control};
pub use mesh_file::{MAX_SOLIDS, MeshFile, StlSolid};
pub use obj::{OBJ, ObjModel, ObjSection, is_plain_obj, parse_obj, parse_obj_with_control};
pub use ply::{PLY, PointFile, parse_points, ply_bytes, points_bytes, texture_file};
pub use stl::{STL, has_several_solids};
pub use unsupported::UnsupportedFormat;
