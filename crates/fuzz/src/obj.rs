//! OBJ models and libraries of materials (MTL): seeds and the readers under test.

use juggler::mesh::{MeshLimits, parse_obj};
use juggler::scene::model::{ModelChoice, ModelFormat, ModelParts};
use juggler_import::obj::ObjFormat;
use std::collections::BTreeMap;
use std::path::Path;

/// An OBJ with two materials.
const MODEL: &str =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\nusemtl b c\nf 1/1 2/1 3/1\n";
/// A picture of one gray pixel (PFM).
const PICTURE: &[u8] = b"PF\n1 1\n-1.0\n\0\0\0\x3f\0\0\0\x3f\0\0\0\x3f";

/// Valid libraries.
pub const LIBRARIES: [&str; 2] = [
    "# x\nnewmtl a\nKd 0.5 0.25 0\nKs .1\nNs 250\nNi 1.45\nTf 1 1 .5\nillum 7\nmap_Kd -s 2 3 1 -o 0.5 -1 a.pfm\n\
     newmtl b c\nKe 2 0 0\nPr .1\nPm .2\nPs .3\nPc .4\nPcr .5\naniso .6\nanisor .7\nd 0.5\nTr 0.5\nmap_d -mm .1 .5 a.pfm\n\
     map_Pr -imfchan g -clamp on a.pfm\nnorm -bm 2 a.pfm\n",
    "newmtl a\r\nKa 1 1 1\r\nillum 3\r\nd \\\r\n 1\nmap_Ke \"a.pfm\"\nmap_Bump a.pfm -bm 0.5\nnewmtl b c\nmap_Ka a.pfm\n",
];

/// Parts of a model; `None` if it is refused.
fn parts(obj: &[u8], files: &BTreeMap<String, Vec<u8>>) -> Option<ModelParts> {
    let opened = ObjFormat.open("a.obj", obj.to_vec(), files);
    let opened = match opened {
        Ok(opened) => opened,
        Err(error) => {
            let plain = |fault: &String| fault.contains("a.obj") && !fault.contains('\u{1b}');
            assert!(!error.faults.is_empty() && error.faults.iter().all(plain), "no plain words: {error}");
            return None;
        }
    };
    let parts = opened.parts(&ModelChoice::default(), "").ok();
    let is_whole = |parts: &ModelParts| !parts.objects.is_empty() && !parts.materials.is_empty();
    assert!(parts.as_ref().is_some_and(is_whole), "an opened model has no objects");
    parts
}

/// Reads an OBJ as a model without its libraries; whether it is valid.
pub fn read_model(bytes: &[u8]) -> bool {
    if let Ok(model) = parse_obj(Path::new("a.obj"), bytes, &MeshLimits::default()) {
        let starts = model.sections.iter().map(|section| section.first);
        assert!(starts.clone().is_sorted(), "sections overlap");
        assert!(starts.max().is_none_or(|last| last <= model.mesh.triangles.len()), "a section is out of range");
        assert_eq!(model.positions.len(), model.mesh.positions.len(), "a vertex has no position of the file");
    }
    parts(bytes, &BTreeMap::new()).is_some()
}

/// Reads a library of materials; whether it is valid and everything in it is understood.
pub fn read_library(bytes: &[u8]) -> bool {
    let files = [("a.mtl", bytes), ("a.pfm", PICTURE)];
    let files = files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect();
    parts(MODEL.as_bytes(), &files).is_some_and(|parts| parts.warnings.is_empty())
}
