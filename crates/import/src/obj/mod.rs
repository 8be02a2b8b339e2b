//! The format Wavefront OBJ with libraries of materials (MTL).
//!
//! | module | holds |
//! |---|---|
//! | `format` | the format of models: objects, materials and textures with their names |
//! | `mtl` | parser of libraries of materials |
//! | `library` | the libraries and pictures of an OBJ |
//! | `files` | names of files, as other systems write them |
//! | `materials` | materials as `principled` |
//! | `pieces` | meshes by object and material, smoothing groups |
//! | `needs` | memory that an OBJ needs |
//!
//! The faces are read by [`parse_obj`](juggler_mesh::parse_obj). All bytes may be hostile:
//! sizes are limited, and errors name file and line.

mod files;
mod format;
mod library;
mod materials;
mod mtl;
mod needs;
mod pieces;

pub(crate) use format::DEFAULT_MATERIAL;
pub use format::ObjFormat;
pub(crate) use materials::gray;
pub use mtl::{MtlMap, MtlMaterial, parse_mtl};
pub(crate) use pieces::parts;

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_scene::model::ModelFormat;
    use std::collections::BTreeMap;

    #[test]
    fn messages_repeat_no_control_characters() {
        let obj = b"mtllib a.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n".to_vec();
        let files = |mtl: &str| BTreeMap::from([("a.mtl".to_owned(), mtl.as_bytes().to_vec())]);
        let error = ObjFormat.open("a.obj", obj.clone(), &files("newmtl a\nmap_Kd a\u{1b}[2J.png\n")).err().unwrap();
        assert_eq!(error.faults, ["a.obj: a.mtl:2: a\u{fffd}[2J.png: no such file"]);
        let warned = ObjFormat.open("a.obj", obj, &files("newmtl a\n\u{1b}[2J 1\n")).unwrap();
        let parts = warned.parts(&Default::default(), "").unwrap();
        assert!(!parts.warnings.is_empty() && parts.warnings.iter().all(|text| !text.contains('\u{1b}')));
    }
}
