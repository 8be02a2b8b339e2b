//! Compiles each material once and reports errors at the place of its description.

use super::images;
use super::labels::Names;
use super::meshes::Files;
use super::surface_coordinates::OverUv;
use crate::description::{Description, Object};
use crate::item::Item;
use crate::path::{Path, PathRef};
use crate::report::Finding;
use juggler_material::{
    AnyMaterial, IneffectiveSetting, MaterialCompiler, MaterialError, MaterialId, MaterialRef, MaterialResolver,
    MaterialTable,
};
use juggler_texture::TextureTable;
use std::sync::Arc;

/// Compiler of the materials that objects request.
pub struct Materials {
    compiler: MaterialCompiler,
    default_material: Option<MaterialId>,
    has_emission: bool,
    /// Requested materials, in order.
    requested: Vec<MaterialId>,
    /// Materials that need surface coordinates.
    pub over_uv: OverUv,
}

impl Materials {
    /// Compiles the scene's textures and collects its named materials.
    pub fn new(scene: &Description, files: Files<'_>, findings: &mut Vec<Finding>) -> Self {
        files.decode_pictures(scene);
        let named = scene.textures.iter().map(|(name, texture)| (name.clone(), (**texture).clone()));
        let (textures, errors) = TextureTable::compile(named, &files);
        // Unknown names are reported already by `validate::names`.
        for (name, error) in errors.iter().filter(|(_, error)| !error.is_unknown_name()) {
            let kind = scene.textures.get(name).map_or("", |texture| texture.name());
            let path = files.texture_path(name).key(kind);
            findings.push(Finding::error(error.to_string()).at(path.join(error.path())));
        }
        images::warn_of_images(scene, &files, findings);
        for (name, material) in scene.materials.iter() {
            warn_of_ineffective_settings(material, &PathRef::Root.key("materials").key(name), findings);
        }
        let named = scene.materials.iter().map(|(name, material)| (name.clone(), (**material).clone()));
        let over_uv = OverUv::new(scene, &textures);
        let compiler = MaterialCompiler::new(textures, named);
        Self {
            compiler,
            default_material: None,
            has_emission: scene.materials.values().any(|material| has_emission(material)),
            requested: Vec::new(),
            over_uv,
        }
    }

    /// Compiles the material at `path`. Returns the default material after an error.
    pub fn get(&mut self, material: &MaterialRef, path: &PathRef<'_>, findings: &mut Vec<Finding>) -> MaterialId {
        let compiled = match material {
            MaterialRef::Inline(material) => {
                self.has_emission |= has_emission(material);
                warn_of_ineffective_settings(material, path, findings);
                self.compiler.compile(material)
            }
            MaterialRef::Name(_) => self.compiler.material("", material),
        };
        let id = compiled.unwrap_or_else(|error| {
            findings.extend(finding(&error, &path.into()));
            self.default_material()
        });
        self.requested.push(id);
        id
    }

    /// Requests the materials of a scene's objects in the order of
    /// [`place`](super::placing::place).
    pub fn request_all(&mut self, scene: &Description, findings: &mut Vec<Finding>) {
        let groups = PathRef::Root.key("groups");
        scene.groups.iter().for_each(|(name, objects)| self.request_objects(objects, &groups.key(name), findings));
        self.request_objects(&scene.objects, &PathRef::Root.key("objects"), findings);
        self.default_material();
    }

    fn request_objects(&mut self, objects: &[Item<Object>], path: &PathRef<'_>, findings: &mut Vec<Finding>) {
        for (i, object) in objects.iter().enumerate().filter(|(_, object)| object.is_visible()) {
            let path = path.index(i);
            if let Some(material) = &object.material {
                self.get(material, &path.key("material"), findings);
            }
            if object.shape.is_none() && object.group.is_none() {
                self.request_objects(object.inner(), &path.key("objects"), findings);
            }
        }
    }

    /// Default material, of objects without one.
    pub fn default_material(&mut self) -> MaterialId {
        let compiler = &mut self.compiler;
        *self.default_material.get_or_insert_with(|| match MaterialRef::default() {
            MaterialRef::Inline(material) => compiler.compile(&material).unwrap_or(MaterialId(0)),
            MaterialRef::Name(_) => MaterialId(0),
        })
    }

    /// Whether any material emits light.
    pub fn has_emission(&self) -> bool {
        self.has_emission
    }

    /// Returns the table of all compiled materials, empty if a named material is invalid, and the
    /// requested materials in order. Stores the names of materials in `names`.
    pub fn finish(self, names: &mut Names, findings: &mut Vec<Finding>) -> (MaterialTable, Arc<Vec<MaterialId>>) {
        let named = self.compiler.compiled().map(|(name, id)| (id, name.to_owned()));
        names.materials = named.collect();
        names.materials.sort_by_key(|(id, _)| id.0);
        let table = self.compiler.finish().unwrap_or_else(|errors| {
            for (name, error) in errors {
                findings.extend(finding(&error, &Path::root().key("materials").key(name)));
            }
            MaterialTable::default()
        });
        (table, Arc::new(self.requested))
    }
}

/// Finding for an error; `None` for an unknown name, which `validate::names` reports.
fn finding(error: &MaterialError, path: &Path) -> Option<Finding> {
    (!error.is_unknown_name()).then(|| Finding::error(error.to_string()).at(path.join(&error.path())))
}

/// Warns of settings without effect in the material at `path` and in inline materials inside it.
fn warn_of_ineffective_settings(material: &AnyMaterial, path: &PathRef<'_>, findings: &mut Vec<Finding>) {
    let path = path.key(material.name());
    for IneffectiveSetting { field, replaced_by } in material.ineffective_settings() {
        let message = format!("`{field}` has no effect, because `{replaced_by}` replaces it");
        findings
            .push(Finding::warning(message).at(&path.key(field)).help(format!("remove `{field}` or `{replaced_by}`")));
    }
    for (field, nested) in material.nested_materials() {
        if let MaterialRef::Inline(material) = nested {
            warn_of_ineffective_settings(material, &path.key(field), findings);
        }
    }
}

fn has_emission(material: &AnyMaterial) -> bool {
    let inline = |(_, material): (_, &MaterialRef)| match material {
        MaterialRef::Inline(material) => has_emission(material),
        MaterialRef::Name(_) => false,
    };
    material.has_emission() || material.nested_materials().into_iter().any(inline)
}
