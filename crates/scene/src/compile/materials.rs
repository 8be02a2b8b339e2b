//! Materials: compiled once each, mistakes charged to the place where they stand.

use super::labels::Names;
use super::meshes::Files;
use crate::description::Description;
use crate::path::{Path, Trail};
use crate::report::Finding;
use juggler_tracer::material::{
    AnyMaterial, MaterialCompiler, MaterialError, MaterialId, MaterialRef, MaterialTable, Resolver,
};
use juggler_tracer::texture::{Input, TextureTable};

/// Compiles materials as objects ask for them.
pub struct Materials {
    compiler: MaterialCompiler,
    plain: Option<MaterialId>,
    glows: bool,
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
        Self { compiler, plain: None, glows: scene.materials.values().any(|material| glows(material)) }
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
        compiled.unwrap_or_else(|error| {
            findings.extend(finding(&error, &path.into()));
            self.plain()
        })
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
    pub fn finish(self, names: &mut Names, findings: &mut Vec<Finding>) -> MaterialTable {
        let named = self.compiler.compiled().map(|(name, id)| (id, name.to_owned()));
        names.materials = named.collect();
        names.materials.sort_by_key(|(id, _)| id.0);
        self.compiler.finish().unwrap_or_else(|errors| {
            for (name, error) in errors {
                findings.extend(finding(&error, &Path::root().key("materials").key(name)));
            }
            MaterialTable::default()
        })
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
    match material {
        AnyMaterial::Phong(phong) => !matches!(&phong.emission, Input::Value(color) if color.is_black()),
        AnyMaterial::Emissive(_) => true,
        AnyMaterial::Checkerboard(board) => inline(&board.even) || inline(&board.odd),
        AnyMaterial::Mask(mask) => inline(&mask.material),
        AnyMaterial::Mix(mix) => inline(&mix.a) || inline(&mix.b),
        AnyMaterial::NormalMap(map) => inline(&map.material),
        AnyMaterial::BumpMap(map) => inline(&map.material),
        AnyMaterial::Principled(principled) => principled.glows(),
        AnyMaterial::Diffuse(_)
        | AnyMaterial::Conductor(_)
        | AnyMaterial::Dielectric(_)
        | AnyMaterial::Plastic(_)
        | AnyMaterial::Velvet(_)
        | AnyMaterial::Translucent(_)
        | AnyMaterial::Boundary(_) => false,
    }
}
