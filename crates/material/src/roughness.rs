//! Roughness and anisotropy of materials with microfacets.

use super::input::{check_number, unit_number};
use super::{MaterialError, ShadingView};
use juggler_math::Vec2;
use juggler_texture::{Input, Slot, TextureLookup, TextureTable};

/// Roughness, anisotropy and its rotation, with names resolved.
#[derive(Clone, Debug)]
pub struct Roughness {
    roughness: Slot<f32>,
    anisotropy: Slot<f32>,
    rotation: Slot<f32>,
}

impl Roughness {
    /// Checks and resolves the fields `roughness`, `anisotropy` and `anisotropy_rotation`.
    pub fn new(textures: &TextureTable, inputs: [&Input<f32>; 3]) -> Result<Self, MaterialError> {
        let [roughness, anisotropy, rotation] = inputs;
        check_number("roughness", roughness, 0.0, 1.0)?;
        check_number("anisotropy", anisotropy, -1.0, 1.0)?;
        Ok(Self {
            roughness: textures.resolve("roughness", roughness)?,
            anisotropy: textures.resolve("anisotropy", anisotropy)?,
            rotation: rotation_slot(textures, rotation)?,
        })
    }

    /// Alpha of GGX along x and y of the shading frame.
    pub fn alpha(&self, textures: &TextureTable, at: &TextureLookup) -> Vec2 {
        let anisotropy = match &self.anisotropy {
            Slot::Value(value) => *value,
            slot => textures.number(slot, at).clamp(-1.0, 1.0),
        };
        anisotropic_alpha(unit_number(textures, &self.roughness, at), anisotropy)
    }

    /// Rotation of the shading frame from u towards v, in full turns; `None` for isotropic
    /// roughness.
    pub fn rotation_turns(&self, textures: &TextureTable, view: &ShadingView) -> Option<f32> {
        self.is_anisotropic().then(|| rotation_turns(textures, &self.rotation, view))
    }

    /// Whether the roughness may be anisotropic.
    pub fn is_anisotropic(&self) -> bool {
        !matches!(self.anisotropy, Slot::Value(0.0))
    }

    /// Whether alpha varies over the surface.
    pub fn is_textured(&self) -> bool {
        self.roughness.is_texture() || self.anisotropy.is_texture()
    }
}

/// Checks and resolves the field `anisotropy_rotation`.
pub fn rotation_slot(textures: &TextureTable, rotation: &Input<f32>) -> Result<Slot<f32>, MaterialError> {
    check_number("anisotropy_rotation", rotation, -1e3, 1e3)?;
    Ok(textures.resolve("anisotropy_rotation", rotation)?)
}

/// Rotation of the anisotropy at a point, in full turns.
pub fn rotation_turns(textures: &TextureTable, rotation: &Slot<f32>, view: &ShadingView) -> f32 {
    match rotation {
        Slot::Value(turns) => *turns,
        slot => textures.number(slot, &view.lookup()).clamp(-1e3, 1e3),
    }
}

/// Alpha of GGX along u and v (Burley, Physically Based Shading at Disney, 2012, section 5.4).
/// Negative anisotropy exchanges u and v.
fn anisotropic_alpha(roughness: f32, anisotropy: f32) -> Vec2 {
    let alpha = roughness * roughness;
    if anisotropy == 0.0 {
        return Vec2::splat(alpha);
    }
    let aspect = (1.0 - 0.9 * anisotropy.abs()).sqrt();
    let (long, short) = ((alpha / aspect).min(1.0), alpha * aspect);
    if anisotropy > 0.0 { Vec2::new(long, short) } else { Vec2::new(short, long) }
}
