//! Materials: recipes that textures fill in, compiled once into tables without names.

use crate::bsdf::Phong as PhongLobe;
use crate::surface::Surface;
use crate::texture::TextureTable;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

mod checkerboard;
mod phong;

/// A material's place in the [`MaterialTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MaterialId(pub u32);

/// A material written in place, or the name of one of the scene's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum MaterialRef {
    /// Name of a material of the scene.
    Name(String),
    /// The material itself.
    Inline(Box<AnyMaterial>),
}

impl Default for MaterialRef {
    fn default() -> Self {
        Self::Inline(Box::new(Phong::default().into()))
    }
}

/// What a description becomes: all names looked up.
#[derive(Clone, Debug)]
pub enum Compiled {
    /// The classic model.
    Phong(phong::CompiledPhong),
    /// Two materials in alternating cells.
    Checkerboard(checkerboard::CompiledCheckerboard),
}

/// Why a material cannot be compiled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MaterialError {
    /// A texture that the scene has not.
    #[error(transparent)]
    UnknownTexture(#[from] crate::texture::UnknownTexture),
    /// A material that the scene has not.
    #[error("no material is called `{name}`")]
    UnknownMaterial {
        /// The field that names it.
        field: &'static str,
        /// The name.
        name: String,
    },
    /// Checkerboards within checkerboards without end.
    #[error("the material `{name}` contains itself")]
    Cycle {
        /// The field that closes the circle.
        field: &'static str,
        /// The name.
        name: String,
    },
}

/// Looks up what a material names while it is compiled.
pub trait Resolver {
    /// The scene's textures.
    fn textures(&self) -> &TextureTable;
    /// Compiles (once) the material that `field` refers to.
    fn material(&mut self, field: &'static str, material: &MaterialRef) -> Result<MaterialId, MaterialError>;
}

/// A recipe.
pub trait Material: Send + Sync {
    /// Looks up every name, once.
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError>;
}

closed_set! {
    /// Every material. In JSON: `{"phong": {"diffuse": [0.8, 0.1, 0.1]}}`.
    pub enum AnyMaterial: Material { phong::Phong, checkerboard::Checkerboard }
}

/// All materials of a world by number, with the textures they use.
#[derive(Debug, Default)]
pub struct MaterialTable {
    /// The compiled materials.
    pub materials: Vec<Compiled>,
    /// Their textures.
    pub textures: TextureTable,
}

impl MaterialTable {
    /// The numbers of material `id` at a point of a surface (world space, normals as the shape gives them).
    pub fn phong(&self, id: MaterialId, surface: &Surface) -> PhongLobe {
        let mut id = id;
        // A checkerboard may hold checkerboards; compiling refused circles, so this ends.
        loop {
            match &self.materials[id.0 as usize] {
                Compiled::Phong(phong) => return phong.eval(surface, &self.textures),
                Compiled::Checkerboard(board) => id = board.pick(surface),
            }
        }
    }
}
