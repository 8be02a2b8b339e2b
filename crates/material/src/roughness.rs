//! How wide highlights are, and which way they are stretched: what materials with microfacets have in common.

use super::input::{check_number, fraction};
use super::{MaterialError, View};
use juggler_math::Vec2;
use juggler_texture::{Input, Lookup, Slot, TextureTable};

/// Roughness, anisotropy and its rotation, looked up.
#[derive(Clone, Copy, Debug)]
pub struct Roughness {
    roughness: Slot<f32>,
    anisotropy: Slot<f32>,
    rotation: Slot<f32>,
}

impl Roughness {
    /// Checks and looks up the fields `roughness`, `anisotropy` and `anisotropy_rotation`.
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

    /// Widths of GGX along x and y of the frame.
    pub fn alpha(&self, textures: &TextureTable, at: &Lookup) -> Vec2 {
        let anisotropy = match &self.anisotropy {
            Slot::Value(value) => *value,
            slot => textures.number(slot, at).clamp(-1.0, 1.0),
        };
        stretched(fraction(textures, &self.roughness, at), anisotropy)
    }

    /// How far the frame is turned from u towards v, in whole turns; `None` where that makes no difference.
    pub fn turns(&self, textures: &TextureTable, view: &View) -> Option<f32> {
        self.is_stretched().then(|| turns(textures, &self.rotation, view))
    }

    /// Whether it matters which way along the surface is which.
    pub fn is_stretched(&self) -> bool {
        !matches!(self.anisotropy, Slot::Value(0.0))
    }

    /// Whether alphas differ from place to place.
    pub fn is_textured(&self) -> bool {
        self.roughness.is_texture() || self.anisotropy.is_texture()
    }
}

/// Checks and looks up the field `anisotropy_rotation`.
pub fn rotation_slot(textures: &TextureTable, rotation: &Input<f32>) -> Result<Slot<f32>, MaterialError> {
    check_number("anisotropy_rotation", rotation, -1e3, 1e3)?;
    Ok(textures.resolve("anisotropy_rotation", rotation)?)
}

/// A rotation at a point, in turns.
pub fn turns(textures: &TextureTable, rotation: &Slot<f32>, view: &View) -> f32 {
    match rotation {
        Slot::Value(turns) => *turns,
        slot => textures.number(slot, &view.lookup()).clamp(-1e3, 1e3),
    }
}

/// Widths of GGX along u and v (Burley, Physically Based Shading at Disney, 2012, section 5.4, with the sign to
/// tell along from across).
fn stretched(roughness: f32, anisotropy: f32) -> Vec2 {
    let alpha = roughness * roughness;
    if anisotropy == 0.0 {
        return Vec2::splat(alpha);
    }
    let aspect = (1.0 - 0.9 * anisotropy.abs()).sqrt();
    let (long, short) = ((alpha / aspect).min(1.0), alpha * aspect);
    if anisotropy > 0.0 { Vec2::new(long, short) } else { Vec2::new(short, long) }
}
