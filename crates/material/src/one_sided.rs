//! Materials that only one side of the surface shows, as the field `sides` of a material selects:
//! `front` or `black_behind`.
//!
//! A surface that is absent from behind uses the same machinery as opacity: its opacity is 0 there,
//! so paths and shadow rays pass straight through.

use super::{CompiledMaterial, MaterialId, MaterialResolver};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Sides of a surface on which a material is present. The front is the side of the surface normals:
/// the outside of a solid, the upper side of a rectangle. Transforms keep it, reflections included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum SurfaceSides {
    /// Both sides look alike.
    #[default]
    Both,
    /// The front only. Seen from behind, the surface is absent: rays of all kinds pass straight
    /// through, shadow rays included. Use it for walls that a camera outside looks through.
    Front,
    /// The front only. Seen from behind, the surface is black and blocks light, as Mitsuba's
    /// materials without `twosided`.
    BlackBehind,
}

/// Another material, on the front only.
#[derive(Clone, Copy, Debug)]
pub struct CompiledOneSided {
    /// Material of the front.
    pub material: MaterialId,
    /// Whether the surface is absent from behind; otherwise it is black there.
    pub is_absent_behind: bool,
}

impl SurfaceSides {
    /// Whether this is the default, which scene files leave out.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks by reference")]
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Restricts a material to these sides; `Both` returns the material unchanged.
    pub(super) fn restrict(self, compiled: CompiledMaterial, resolver: &mut dyn MaterialResolver) -> CompiledMaterial {
        if self == Self::Both {
            return compiled;
        }
        let material = resolver.add_nested(compiled);
        CompiledMaterial::OneSided(CompiledOneSided { material, is_absent_behind: self == Self::Front })
    }
}
