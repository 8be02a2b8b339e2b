//! Fine relief as a picture of normals.
//!
//! ```json
//! {"normal_map": {"texture": "brick normals", "strength": 1, "material": "brick"}}
//! ```
//!
//! Red, green and blue from 0 to 1 are x, y and z from -1 to 1: x along u, y along v, z outwards. The picture's
//! `color_space` must be `linear`.

use super::input::check_number;
use super::tangent::axes;
use super::{Compiled, Material, MaterialError, MaterialId, MaterialRef, Resolver, View};
use juggler_math::{Rgb, Vec3};
use juggler_texture::{Input, Slot, TextureTable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Another material whose shading normals come from a texture, in tangent space.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct NormalMap {
    /// The normals: (0.5, 0.5, 1) is straight up.
    pub texture: Input<Rgb>,
    /// Factor on how far normals lean to the side: 0 for none of it.
    pub strength: Input<f32>,
    /// The material.
    pub material: MaterialRef,
}

/// What stands for a normal that does not lean.
const STRAIGHT_UP: Rgb = Rgb::new(0.5, 0.5, 1.0);

/// The largest `strength`.
const STRONGEST: f32 = 1000.0;

impl Default for NormalMap {
    fn default() -> Self {
        Self { texture: STRAIGHT_UP.into(), strength: 1.0.into(), material: MaterialRef::default() }
    }
}

/// A [`NormalMap`] with its names looked up.
#[derive(Clone, Debug)]
pub struct CompiledNormalMap {
    texture: Slot<Rgb>,
    strength: Slot<f32>,
    /// The material.
    pub material: MaterialId,
}

impl Material for NormalMap {
    fn compile(&self, resolver: &mut dyn Resolver) -> Result<Compiled, MaterialError> {
        super::input::check_share("texture", &self.texture)?;
        check_number("strength", &self.strength, 0.0, STRONGEST)?;
        let texture = resolver.textures().resolve("texture", &self.texture)?;
        let strength = resolver.textures().resolve("strength", &self.strength)?;
        let material = resolver.material("material", &self.material)?;
        Ok(Compiled::NormalMap(CompiledNormalMap { texture, strength, material }))
    }

    fn parts(&self) -> Vec<&MaterialRef> {
        vec![&self.material]
    }
}

impl CompiledNormalMap {
    /// The shading normal as the texture turns it, on the side of the surface's own.
    pub fn turned(&self, textures: &TextureTable, view: &View) -> Vec3 {
        let at = view.lookup();
        let strength = match &self.strength {
            Slot::Value(strength) => *strength,
            slot => textures.number(slot, &at).clamp(0.0, STRONGEST),
        };
        let color = super::input::share(textures, &self.texture, &at);
        let [x, y, z] = color.to_array().map(|channel| channel * 2.0 - 1.0);
        let (x, y) = (x * strength, y * strength);
        if x == 0.0 && y == 0.0 {
            return view.normal;
        }
        let (u, v) = axes(view.normal, view.tangents);
        (u * x + v * y + view.normal * z.max(0.0)).normalize_or(view.normal)
    }
}

#[cfg(any(test, feature = "testing"))]
impl NormalMap {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        let tiles = Self { texture: Input::Texture("tiles".into()), strength: 0.7.into(), ..Self::default() };
        let leaning = Self {
            texture: Rgb::new(0.9, 0.3, 0.6).into(),
            material: super::Dielectric::default().into(),
            ..Self::default()
        };
        vec![Self::default(), tiles, leaning]
    }
}
