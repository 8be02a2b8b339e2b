//! STL as a format of model files: each solid of a text is an object. The facets are read by
//! [`juggler_mesh::parse`].

use crate::gltf::Warnings;
use crate::obj::{DEFAULT_MATERIAL, gray};
use indexmap::IndexMap;
use juggler_mesh::MeshLimits;
use juggler_scene::Object;
use juggler_scene::model::{
    AnimationChoice, Files, ModelChoice, ModelError, ModelFile, ModelFormat, ModelParts, ModelSummary,
};
use juggler_shape::Mesh;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

/// Maximum number of solids that become objects. The solids of a file with more are one object.
const MAX_SOLIDS: usize = 65_536;
/// Maximum number of bytes of the name of a solid.
const MAX_NAME: usize = 1024;
/// Number of first bytes of which a text has none that is zero.
const HEAD: usize = 1024;

/// The format STL, text or binary: `.stl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StlFormat;

impl ModelFormat for StlFormat {
    fn name(&self) -> &'static str {
        "STL"
    }

    fn extensions(&self) -> &'static [&'static str] {
        &["stl"]
    }

    fn is_content(&self, _head: &[u8]) -> bool {
        false
    }

    /// Whether the file has at most one solid.
    fn is_plain_mesh(&self, bytes: &[u8]) -> bool {
        solids(bytes).len() < 2
    }

    fn open(&self, name: &str, bytes: Vec<u8>, _files: &dyn Files) -> Result<Arc<dyn ModelFile>, ModelError> {
        let shown = name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned();
        let parse = |bytes: &[u8]| juggler_mesh::parse(Path::new(name), bytes, &MeshLimits::default());
        // Errors of the whole file state its lines.
        let whole = parse(&bytes).map_err(|error| ModelError::new(error.to_string()))?;
        let mut warnings = Warnings::default();
        whole.warnings.iter().for_each(|warning| warnings.add(&shown, warning, 1));
        let ranges = solids(&bytes);
        let text = format!("has more than {MAX_SOLIDS} solids; they are one object");
        warnings.add(&shown, text, u64::from(ranges.len() > MAX_SOLIDS));
        let ranges = if ranges.len() > MAX_SOLIDS { Vec::new() } else { ranges };
        let solid = |(number, range): (usize, Range<usize>)| {
            let solid = bytes.get(range).unwrap_or_default();
            // A solid without facets has no mesh.
            Some((solid_name(solid, number), Mesh::from(parse(solid).ok()?.mesh)))
        };
        let mut objects: Vec<(String, Mesh)> = ranges.into_iter().enumerate().filter_map(solid).collect();
        if triangles(&objects) != whole.mesh.triangles.len() as u64 {
            objects = vec![(solid_name(&bytes, 0), Mesh::from(whole.mesh))];
        }
        Ok(Arc::new(StlModel { name: shown, objects, warnings, digest: blake3::hash(&bytes).into() }))
    }
}

/// Ranges of the solids of a text, each from the line of its keyword `solid` to the next one; none
/// in a binary file.
fn solids(bytes: &[u8]) -> Vec<Range<usize>> {
    if bytes.get(..HEAD).unwrap_or(bytes).contains(&0) {
        return Vec::new();
    }
    let mut starts = Vec::new();
    let mut at = 0;
    for line in bytes.split_inclusive(|byte| matches!(byte, b'\n' | b'\r')) {
        let word = line.trim_ascii_start().split_at_checked(5);
        let is_solid = word.is_some_and(|(word, rest)| {
            word.eq_ignore_ascii_case(b"solid") && rest.first().is_none_or(u8::is_ascii_whitespace)
        });
        starts.extend(is_solid.then_some(at));
        at += line.len();
    }
    let ends = starts.iter().copied().skip(1).chain([bytes.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// Name of the solid that begins a text; its number if the solid has no name, or if the bytes are no
/// text.
fn solid_name(text: &[u8], number: usize) -> String {
    let line = text.trim_ascii_start().split(|byte| matches!(byte, b'\n' | b'\r')).next();
    let word = line.and_then(|line| line.split_at_checked(5)).filter(|(word, _)| word.eq_ignore_ascii_case(b"solid"));
    let name = word.map(|(_, name)| name.trim_ascii()).unwrap_or_default();
    let is_name = !name.is_empty() && name.len() <= MAX_NAME && !name.contains(&0);
    if is_name { String::from_utf8_lossy(name).into_owned() } else { format!("solid {number}") }
}

/// Number of triangles of all objects.
fn triangles(objects: &[(String, Mesh)]) -> u64 {
    objects.iter().map(|(_, mesh)| mesh.arrays().triangles.len() as u64).sum()
}

/// An opened file.
#[derive(Debug)]
struct StlModel {
    name: String,
    /// Meshes of the solids with their names.
    objects: Vec<(String, Mesh)>,
    warnings: Warnings,
    digest: [u8; 32],
}

impl ModelFile for StlModel {
    fn digest(&self) -> [u8; 32] {
        self.digest
    }

    fn files(&self) -> &[String] {
        &[]
    }

    fn is_z_up(&self) -> bool {
        true
    }

    fn parts(&self, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, ModelError> {
        let has_clip = matches!(choice.animation, AnimationChoice::Clip(_));
        if choice.scene.is_some() || choice.variant.is_some() || has_clip {
            return Err(ModelError::new(format!("{}: an STL has no scenes, variants and animations", self.name)));
        }
        let material = format!("{prefix}{DEFAULT_MATERIAL}");
        let object = |(name, mesh): &(String, Mesh)| {
            Object::new(mesh.clone()).named(format!("{prefix}{name}")).material_named(&*material)
        };
        Ok(ModelParts {
            materials: IndexMap::from([(material.clone(), gray(false))]),
            objects: self.objects.iter().map(object).collect(),
            warnings: self.warnings.texts(),
            ..ModelParts::default()
        })
    }

    fn summary(&self, choice: &ModelChoice) -> Result<ModelSummary, ModelError> {
        let parts = self.parts(choice, "")?;
        let triangles = triangles(&self.objects);
        Ok(ModelSummary {
            format: "STL".to_owned(),
            materials: parts.materials.keys().cloned().collect(),
            nodes: parts.objects.len(),
            distinct_triangles: triangles,
            drawn_triangles: triangles,
            warnings: parts.warnings,
            ..ModelSummary::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_scene::model::NameOrIndex;
    use std::collections::BTreeMap;

    const FACET: &str =
        "facet normal 0 0 1\n outer loop\n vertex 0 0 0\n vertex 1 0 0\n vertex 0 1 0\n endloop\nendfacet\n";

    fn objects(text: &str) -> Vec<(String, usize)> {
        let model = StlFormat.open("parts/a.stl", text.as_bytes().to_vec(), &BTreeMap::new()).unwrap();
        assert!(model.is_z_up() && model.files().is_empty());
        let parts = model.parts(&ModelChoice::default(), "a/").unwrap();
        let triangles = |object: &Object| object.mesh().map_or(0, |mesh| mesh.arrays().triangles.len());
        parts.objects.iter().map(|object| (object.name.clone().unwrap(), triangles(object))).collect()
    }

    #[test]
    fn solids_are_objects() {
        let text =
            format!("solid lid\n{FACET}endsolid lid\n  SOLID\n{FACET}{FACET}endsolid\nsolid none\nendsolid none\n");
        assert_eq!(objects(&text), [("a/lid".to_owned(), 1), ("a/solid 1".to_owned(), 2)]);
        assert!(!StlFormat.is_plain_mesh(text.as_bytes()));
        let single = format!("solid solid part\n{FACET}endsolid\n");
        assert_eq!(objects(&single), [("a/solid part".to_owned(), 1)]);
        assert!(StlFormat.is_plain_mesh(single.as_bytes()));
    }

    #[test]
    fn errors_state_the_line_of_the_file_and_choices_are_refused() {
        let text = format!("solid a\n{FACET}endsolid\nsolid b\nfacet normal 0 0 x\nouter lop\n");
        let error = StlFormat.open("a.stl", text.into_bytes(), &BTreeMap::new()).unwrap_err().to_string();
        assert!(error.contains("a.stl: line 12"), "{error}");
        let model = StlFormat.open("a.stl", format!("solid\n{FACET}endsolid").into_bytes(), &BTreeMap::new()).unwrap();
        let choice = ModelChoice { animation: AnimationChoice::Clip(NameOrIndex::Index(0)), ..ModelChoice::default() };
        assert!(model.parts(&choice, "").is_err());
        assert_eq!(model.summary(&ModelChoice::default()).unwrap().drawn_triangles, 1);
    }
}
