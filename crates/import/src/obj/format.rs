//! OBJ as a format of model files.

use super::files::Reader;
use super::library::Library;
use super::materials::{Materials, gray};
use super::needs;
use super::pieces::{MAX_OBJECTS, Piece, pieces};
use crate::gltf::{Warnings, image_size};
use crate::textures::{NamedTextures, VERTEX_COLORS};
use indexmap::IndexMap;
use juggler_math::message::{MAX_QUOTE, excerpt};
use juggler_math::{Aabb, BuildControl};
use juggler_mesh::{MeshLimits, OBJ, is_plain_obj, parse_obj_with_control};
use juggler_scene::Object;
use juggler_scene::model::{
    AnimationChoice, FileDigest, Files, ModelChoice, ModelError, ModelFile, ModelFormat, ModelNeeds, ModelParts,
    ModelSummary,
};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;

/// Name of the material of faces without a known material.
pub const DEFAULT_MATERIAL: &str = "default material";

/// The format Wavefront OBJ with libraries of materials (MTL): `.obj`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ObjFormat;

impl ModelFormat for ObjFormat {
    fn name(&self) -> &'static str {
        OBJ.name
    }

    fn extensions(&self) -> &'static [&'static str] {
        &[OBJ.extension]
    }

    fn is_content(&self, _head: &[u8]) -> bool {
        false
    }

    fn is_plain_mesh(&self, bytes: &[u8]) -> bool {
        is_plain_obj(bytes)
    }

    fn needs(&self, bytes: Vec<u8>, files: &dyn Files) -> ModelNeeds {
        needs::needs(&bytes, files)
    }

    fn open(&self, name: &str, bytes: Vec<u8>, files: &dyn Files) -> Result<Arc<dyn ModelFile>, ModelError> {
        self.open_with_control(name, bytes, files, &BuildControl::default())
    }

    fn open_with_control(
        &self,
        name: &str,
        bytes: Vec<u8>,
        files: &dyn Files,
        control: &BuildControl,
    ) -> Result<Arc<dyn ModelFile>, ModelError> {
        let shown = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let parsed = parse_obj_with_control(Path::new(name), &bytes, &MeshLimits::default(), control);
        let model = parsed.map_err(|error| ModelError::new(error.to_string()))?;
        let digest = blake3::hash(&bytes).into();
        drop(bytes);
        let mut warnings = Warnings::default();
        model.warnings.iter().for_each(|warning| warnings.add(shown, warning, 1));
        let used: BTreeSet<Arc<str>> = model.sections.iter().filter_map(|section| section.material.clone()).collect();
        let mut reader = Reader::new(files);
        let library = Library::read(shown, &model.libraries, &used, &mut reader, &mut warnings);
        let in_file = |fault: String| format!("{name}: {fault}");
        let library = library.map_err(|faults| ModelError { faults: faults.into_iter().map(in_file).collect() })?;
        let bounds = Aabb::from_points(model.mesh.positions.iter().copied());
        let has_colors = model.mesh.attributes.contains_key(VERTEX_COLORS);
        let (pieces, is_merged) = pieces(model);
        let text = format!("has more than {MAX_OBJECTS} objects and groups; faces are joined by material");
        warnings.add(shown, text, u64::from(is_merged));
        let diagonal = (bounds.max - bounds.min).length();
        Ok(Arc::new(ObjFile {
            name: shown.to_owned(),
            pieces,
            library,
            has_colors,
            diagonal: if diagonal.is_finite() { diagonal } else { 1.0 },
            warnings,
            files: reader.read,
            digest,
        }))
    }
}

/// An opened file.
#[derive(Debug)]
struct ObjFile {
    name: String,
    pieces: Vec<Piece>,
    library: Library,
    has_colors: bool,
    /// Diagonal of the bounding box, in scene units.
    diagonal: f32,
    warnings: Warnings,
    files: Vec<FileDigest>,
    digest: [u8; 32],
}

impl ModelFile for ObjFile {
    fn digest(&self) -> [u8; 32] {
        self.digest
    }

    fn files(&self) -> &[FileDigest] {
        &self.files
    }

    fn moves(&self, _choice: &ModelChoice) -> bool {
        false
    }

    fn bytes(&self) -> u64 {
        let pictures = self.library.pictures.iter().filter_map(|picture| picture.asset.bytes());
        pictures.map(|bytes| bytes.len() as u64).fold(0, u64::saturating_add)
    }

    fn parts(&self, choice: &ModelChoice, prefix: &str) -> Result<ModelParts, ModelError> {
        self.check(choice)?;
        let mut translated = Materials {
            prefix,
            pictures: &self.library.pictures,
            has_colors: self.has_colors,
            diagonal: self.diagonal,
            textures: NamedTextures::default(),
            warnings: self.warnings.clone(),
        };
        let mut materials = IndexMap::new();
        let mut objects = Vec::new();
        for piece in &self.pieces {
            let known = piece.material.as_deref().and_then(|name| self.library.materials.get(name));
            if let Some(name) = piece.material.as_deref().filter(|_| known.is_none()) {
                let text = "faces of a material that no library defines are shown gray";
                translated.warnings.add(format!("{}: usemtl {}", self.name, excerpt(name, MAX_QUOTE)), text, 1);
            }
            let name = format!("{prefix}{}", known.map_or(DEFAULT_MATERIAL, |loaded| &loaded.mtl.name));
            if !materials.contains_key(&name) {
                let material = known.map_or_else(|| gray(self.has_colors), |loaded| translated.material(loaded));
                materials.insert(name.clone(), material);
            }
            let shown = piece.name.as_deref().map_or_else(|| format!("object {}", objects.len()), str::to_owned);
            let object = Object::new(piece.mesh.clone()).named(format!("{prefix}{shown}"));
            objects.push(object.material_named(name).into());
        }
        let assets = self.library.pictures.iter();
        let assets = assets.map(|picture| (format!("{prefix}{}", picture.asset_name), picture.asset.clone()));
        Ok(ModelParts {
            assets: assets.collect(),
            textures: translated.textures.by_name,
            materials,
            objects,
            warnings: translated.warnings.texts(),
            ..ModelParts::default()
        })
    }

    fn summary(&self, choice: &ModelChoice) -> Result<ModelSummary, ModelError> {
        let parts = self.parts(choice, "")?;
        let triangles = self.pieces.iter().map(|piece| piece.mesh.arrays().triangles.len() as u64).sum();
        let size = |picture: &super::library::Picture| image_size(picture.asset.bytes()?);
        let pictures = self.library.pictures.iter().map(|picture| (picture.file.clone(), size(picture)));
        Ok(ModelSummary {
            format: OBJ.name.to_owned(),
            materials: parts.materials.keys().cloned().collect(),
            nodes: parts.objects.len(),
            distinct_triangles: triangles,
            drawn_triangles: triangles,
            textures: pictures.collect(),
            warnings: parts.warnings,
            ..ModelSummary::default()
        })
    }
}

impl ObjFile {
    /// Refuses choices that the format does not have.
    fn check(&self, choice: &ModelChoice) -> Result<(), ModelError> {
        let has_clip = matches!(choice.animation, AnimationChoice::Clip(_));
        let chosen =
            [("scenes", choice.scene.is_some()), ("variants", choice.variant.is_some()), ("animations", has_clip)];
        let faults = chosen.iter().filter(|(_, is_chosen)| *is_chosen);
        let faults: Vec<String> = faults.map(|(kind, _)| format!("{}: an OBJ has no {kind}", self.name)).collect();
        if faults.is_empty() { Ok(()) } else { Err(ModelError { faults }) }
    }
}
