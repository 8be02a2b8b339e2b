//! Lights: KHR_lights_punctual, EXT_lights_image_based and EXT_lights_ies.

use super::number::Index;
use serde::Deserialize;

/// Point, spot and directional lights (KHR_lights_punctual).
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct PunctualLights {
    /// The lights, which nodes refer to.
    pub lights: Vec<PunctualLight>,
}

/// A point, spot or directional light. It emits along -z.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct PunctualLight {
    /// Kind of light.
    #[serde(rename = "type")]
    pub light_type: LightType,
    /// Linear color.
    #[serde(default = "white")]
    pub color: [f64; 3],
    /// Candela of point and spot lights, lux of directional lights.
    #[serde(default = "one")]
    pub intensity: f64,
    /// Distance at which the light ends; infinite if `None`.
    pub range: Option<f64>,
    /// Cone of a spot light.
    pub spot: Option<SpotCone>,
    /// Name for people.
    pub name: Option<String>,
}

/// Kind of a punctual light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LightType {
    /// Parallel light.
    Directional,
    /// Light from a point in all directions.
    Point,
    /// Light from a point in a cone.
    Spot,
    /// Light of an unknown kind, which is left out.
    #[serde(other)]
    Unknown,
}

/// Cone of a spot light. Angles are between axis and edge, in radians.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase", default)]
pub struct SpotCone {
    /// Angle where the light begins to fall off.
    pub inner_cone_angle: f64,
    /// Angle where the light ends.
    pub outer_cone_angle: f64,
}

impl Default for SpotCone {
    fn default() -> Self {
        Self { inner_cone_angle: 0.0, outer_cone_angle: std::f64::consts::FRAC_PI_4 }
    }
}

/// Environment lights (EXT_lights_image_based).
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct ImageBasedLights {
    /// The lights, which scenes refer to.
    pub lights: Vec<ImageBasedLight>,
}

/// An environment light.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct ImageBasedLight {
    /// Rotation as a quaternion x, y, z, w.
    #[serde(default = "no_rotation")]
    pub rotation: [f64; 4],
    /// Factor of the radiance.
    #[serde(default = "one")]
    pub intensity: f64,
    /// Spherical harmonics of the irradiance, to order 2.
    pub irradiance_coefficients: [[f64; 3]; 9],
    /// Images of the six faces of a cube map, for each level.
    pub specular_images: Vec<[Index; 6]>,
    /// Side of the images of level 0, in pixels.
    pub specular_image_size: Index,
    /// Name for people.
    pub name: Option<String>,
}

/// Light profiles (EXT_lights_ies).
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub struct IesLights {
    /// The profiles, which nodes refer to.
    pub lights: Vec<IesProfile>,
}

/// A light profile: a file of the format IES LM-63.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct IesProfile {
    /// Name of the file, or data.
    pub uri: Option<String>,
    /// Type of the data; a hint.
    pub mime_type: Option<String>,
    /// Index of the buffer view of the data.
    pub buffer_view: Option<Index>,
    /// Name for people.
    pub name: Option<String>,
}

fn one() -> f64 {
    1.0
}

fn white() -> [f64; 3] {
    [1.0; 3]
}

fn no_rotation() -> [f64; 4] {
    [0.0, 0.0, 0.0, 1.0]
}
