//! STL as a format of model files: each solid that [`juggler_mesh::parse`] finds is an object.

use crate::gltf::Warnings;
use crate::obj::{DEFAULT_MATERIAL, gray, parts};
use indexmap::IndexMap;
use juggler_math::BuildControl;
use juggler_mesh::{MAX_SOLIDS, MeshFile, MeshLimits, STL, has_several_solids, parse_with_control};
use juggler_scene::Object;
use juggler_scene::model::{
    AnimationChoice, FileDigest, Files, ModelChoice, ModelError, ModelFile, ModelFormat, ModelParts, ModelSummary,
};
use juggler_shape::Mesh;
use std::path::Path;
use std::sync::Arc;

/// The format STL, text or binary: `.stl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StlFormat;

impl ModelFormat for StlFormat {
    fn name(&self) -> &'static str {
        STL.name
    }

    fn extensions(&self) -> &'static [&'static str] {
        &[STL.extension]
    }

    fn is_content(&self, _head: &[u8]) -> bool {
        false
    }

    /// Whether the file has at most one solid.
    fn is_plain_mesh(&self, bytes: &[u8]) -> bool {
        !has_several_solids(bytes)
    }

    fn open(&self, name: &str, bytes: Vec<u8>, files: &dyn Files) -> Result<Arc<dyn ModelFile>, ModelError> {
        self.open_with_control(name, bytes, files, &BuildControl::default())
    }

    fn open_with_control(
        &self,
        name: &str,
        bytes: Vec<u8>,
        _files: &dyn Files,
        control: &BuildControl,
    ) -> Result<Arc<dyn ModelFile>, ModelError> {
        let shown = name.rsplit(['/', '\\']).next().unwrap_or(name).to_owned();
        let file = parse_with_control(Path::new(name), &bytes, &MeshLimits::default(), control);
        let file = file.map_err(|error| ModelError::new(error.to_string()))?;
        let mut warnings = Warnings::default();
        file.warnings.iter().for_each(|warning| warnings.add(&shown, warning, 1));
        let text = format!("has more than {MAX_SOLIDS} solids; they are one object");
        warnings.add(&shown, text, u64::from(file.solids.len() > MAX_SOLIDS));
        let objects = objects(file);
        Ok(Arc::new(StlModel { name: shown, objects, warnings, digest: blake3::hash(&bytes).into() }))
    }
}

/// Meshes of the solids with their names. A file that has one solid, no solids or too many is one
/// object.
fn objects(file: MeshFile) -> Vec<(String, Mesh)> {
    let MeshFile { mesh, solids, .. } = file;
    let name = |number: usize| {
        let name = solids.get(number).and_then(|solid| solid.name.clone());
        name.unwrap_or_else(|| format!("solid {number}"))
    };
    if solids.len() < 2 || solids.len() > MAX_SOLIDS {
        return vec![(name(0), Mesh::from(mesh))];
    }
    let mut part = parts(&mesh);
    let ends = solids.iter().skip(1).map(|solid| solid.first).chain([mesh.triangles.len()]);
    let triangles = solids.iter().zip(ends).map(|(solid, end)| mesh.triangles.get(solid.first..end));
    // A solid without facets has no mesh.
    let triangles = triangles.map(Option::unwrap_or_default).enumerate().filter(|(_, list)| !list.is_empty());
    triangles.map(|(number, list)| (name(number), Mesh::from(part(list)))).collect()
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

    fn files(&self) -> &[FileDigest] {
        &[]
    }

    fn moves(&self, _choice: &ModelChoice) -> bool {
        false
    }

    fn is_z_up(&self) -> bool {
        STL.is_z_up
    }

    fn parts(&self, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, ModelError> {
        let has_clip = matches!(choice.animation, AnimationChoice::Clip(_));
        if choice.scene.is_some() || choice.variant.is_some() || has_clip {
            return Err(ModelError::new(format!("{}: an STL has no scenes, variants and animations", self.name)));
        }
        let material = format!("{prefix}{DEFAULT_MATERIAL}");
        let object = |(name, mesh): &(String, Mesh)| {
            Object::new(mesh.clone()).named(format!("{prefix}{name}")).material_named(&*material).into()
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
            format: STL.name.to_owned(),
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
    fn a_file_of_too_many_solids_is_one_object() {
        let name = |count: usize| {
            let text: String = (0..count).map(|i| format!("solid s{i}\n{FACET}endsolid\n")).collect();
            let model = StlFormat.open("a.stl", text.into_bytes(), &BTreeMap::new()).unwrap();
            let parts = model.parts(&ModelChoice::default(), "").unwrap();
            (parts.objects.len(), parts.objects.last().and_then(|object| object.name.clone()), parts.warnings)
        };
        assert_eq!(name(MAX_SOLIDS), (MAX_SOLIDS, Some("s65535".to_owned()), Vec::new()));
        let warning = "a.stl: has more than 65536 solids; they are one object".to_owned();
        assert_eq!(name(MAX_SOLIDS + 1), (1, Some("s0".to_owned()), vec![warning]));
    }

    #[test]
    fn solids_have_the_meshes_of_files_of_their_own() {
        let other = FACET.replace("vertex 0 0 0", "vertex 1 1 0");
        let (first, second) =
            (format!("solid a\n{other}{FACET}endsolid\n"), format!("solid b\n{FACET}{other}endsolid\n"));
        let mesh = |text: &str, number: usize| {
            let model = StlFormat.open("a.stl", text.as_bytes().to_vec(), &BTreeMap::new()).unwrap();
            let parts = model.parts(&ModelChoice::default(), "").unwrap();
            parts.objects[number].mesh().unwrap().arrays().clone()
        };
        let both = format!("{first}solid\nendsolid\n{second}");
        assert_eq!([mesh(&both, 0), mesh(&both, 1)], [mesh(&first, 0), mesh(&second, 0)]);
    }

    #[test]
    fn binary_files_and_files_of_other_formats_are_one_object() {
        let mut binary = b"solid part\r\nsolid b\n".to_vec();
        binary.resize(80, b' ');
        binary.extend([1, 0, 0, 0]);
        binary.extend([0; 12].into_iter().chain((0..9_u8).flat_map(|i| f32::from(i % 4).to_le_bytes())).chain([0; 2]));
        assert!(StlFormat.is_plain_mesh(&binary));
        let named = |bytes: Vec<u8>| {
            let model = StlFormat.open("a.stl", bytes, &BTreeMap::new()).unwrap();
            let parts = model.parts(&ModelChoice::default(), "").unwrap();
            let names: Vec<String> = parts.objects.iter().filter_map(|object| object.name.clone()).collect();
            (names, parts.warnings.len())
        };
        assert_eq!(named(binary), (vec!["part".to_owned()], 0));
        assert_eq!(named(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".to_vec()), (vec!["solid 0".to_owned()], 1));
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
