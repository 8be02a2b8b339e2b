//! Strategies by which a path finds light that has an extent: light sampling, BSDF sampling, or
//! both.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Strategy for direct lighting from emitters that a ray can hit: surfaces that emit, and the
/// background.
///
/// All three have the same expected value and differ in noise. Lights without an extent (point,
/// spot, directional) are always light-sampled; light through mirrors and clear glass, and light
/// from surfaces that cannot be sampled, is always found by the path itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Sampling {
    /// Multiple importance sampling: light samples and BSDF samples, combined by the power
    /// heuristic (Veach 1997, section 9.2.2, exponent 2). The least noise.
    #[default]
    Mis,
    /// Light samples only (next-event estimation): noisy where a glossy surface reflects a large
    /// emitter.
    Light,
    /// BSDF samples only: noisy where an emitter is small.
    Bsdf,
}

impl Sampling {
    /// Whether this is the default, which scene files leave out.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks by reference")]
    pub(super) fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Weight of a light sample that has density `light` and that BSDF sampling finds with density
    /// `bsdf`.
    #[inline]
    pub fn light_weight(self, light: f32, bsdf: f32) -> f32 {
        match self {
            Self::Mis => power_heuristic(light, bsdf),
            Self::Light => 1.0,
            Self::Bsdf => 0.0,
        }
    }

    /// Weight of a BSDF sample that has density `bsdf` and that light sampling finds with density
    /// `light`.
    #[inline]
    pub fn bsdf_weight(self, bsdf: f32, light: f32) -> f32 {
        match self {
            Self::Mis => power_heuristic(bsdf, light),
            Self::Light if light > 0.0 => 0.0,
            Self::Light | Self::Bsdf => 1.0,
        }
    }
}

/// Weight of a sample of density `own` that another strategy finds with density `other` (Veach
/// 1997, section 9.2.2, exponent 2).
#[inline]
fn power_heuristic(own: f32, other: f32) -> f32 {
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}
