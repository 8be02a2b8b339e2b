//! Materials: compiled once each, mistakes charged to the place where they stand.

use super::labels::Names;
use super::meshes::Files;
use crate::description::{Description, Object};
use crate::item::Item;
use crate::path::{Path, Trail};
use crate::report::Finding;
use juggler_material::{
    AnyMaterial, MaterialCompiler, MaterialError, MaterialId, MaterialRef, MaterialTable, Resolver,
};
use juggler_texture::TextureTable;
use std::sync::Arc;

/// Compiles materials as objects ask for them.
pub struct Materials {
    compiler: MaterialCompiler,
    plain: Option<MaterialId>,
    glows: bool,
    /// The materials that were asked for, in order.
    given: Vec<MaterialId>,
}

impl Materials {
    /// Takes the scene's textures and named materials.
    pub fn new(scene: &Description, files: Files<'_>, findings: &mut Vec<Finding>) -> Self {
        let named = scene.textures.iter().map(|(name, texture)| (name.clone(), (**texture).clone()));
        let (textures, errors) = TextureTable::compile(named, &files);
        // Unknown names have been reported: `validate::names`.
        for (name, error) in errors.iter().filter(|(_, error)| !error.is_unknown_name()) {
            let kind = scene.textures.get(name).map(crate::kind::name_of).unwrap_or_default();
            let path = files.texture_path(name).key(kind);
            findings.push(Finding::error(error.to_string()).at(path.join(error.path())));
        }
        let named = scene.materials.iter().map(|(name, material)| (name.clone(), (**material).clone()));
        let compiler = MaterialCompiler::new(textures, named);
        Self {
            compiler,
            plain: None,
            glows: scene.materials.values().any(|material| glows(material)),
            given: Vec::new(),
        }
    }

    /// The material that stands at `path`; a plain one where there is a mistake.
    pub fn get(&mut self, material: &MaterialRef, path: &Trail<'_>, findings: &mut Vec<Finding>) -> MaterialId {
        let compiled = match material {
            MaterialRef::Inline(material) => {
                self.glows |= glows(material);
                self.compiler.compile(material)
            }
            MaterialRef::Name(_) => self.compiler.material("", material),
        };
        let id = compiled.unwrap_or_else(|error| {
            findings.extend(finding(&error, &path.into()));
            self.plain()
        });
        self.given.push(id);
        id
    }

    /// Asks for the materials of a scene's objects in the order in which [`place`](super::placing::place) does.
    pub fn get_all(&mut self, scene: &Description, findings: &mut Vec<Finding>) {
        let groups = Trail::Root.key("groups");
        scene.groups.iter().for_each(|(name, objects)| self.get_of(objects, &groups.key(name), findings));
        self.get_of(&scene.objects, &Trail::Root.key("objects"), findings);
        self.plain();
    }

    fn get_of(&mut self, objects: &[Item<Object>], path: &Trail<'_>, findings: &mut Vec<Finding>) {
        for (i, object) in objects.iter().enumerate().filter(|(_, object)| object.is_visible()) {
            let path = path.index(i);
            if let Some(material) = &object.material {
                self.get(material, &path.key("material"), findings);
            }
            if object.shape.is_none() && object.group.is_none() {
                self.get_of(object.inner(), &path.key("objects"), findings);
            }
        }
    }

    /// What things are made of that say nothing.
    pub fn plain(&mut self) -> MaterialId {
        let compiler = &mut self.compiler;
        *self.plain.get_or_insert_with(|| match MaterialRef::default() {
            MaterialRef::Inline(material) => compiler.compile(&material).unwrap_or(MaterialId(0)),
            MaterialRef::Name(_) => MaterialId(0),
        })
    }

    /// Whether any material gives off light of its own.
    pub fn glows(&self) -> bool {
        self.glows
    }

    /// All that was compiled, and its names; nothing when a named material is wrong.
    /// The last is which materials were asked for, in order.
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
        (table, Arc::new(self.given))
    }
}

/// What to say of an error. Names are looked up in the whole scene before (`validate::names`): one that is unknown
/// here belongs to something that has been complained about already.
fn finding(error: &MaterialError, path: &Path) -> Option<Finding> {
    (!error.is_unknown_name()).then(|| Finding::error(error.to_string()).at(path.join(&error.path())))
}

fn glows(material: &AnyMaterial) -> bool {
    let inline = |material: &MaterialRef| match material {
        MaterialRef::Inline(material) => glows(material),
        MaterialRef::Name(_) => false,
    };
    material.has_emission() || material.parts().into_iter().any(inline)
}
