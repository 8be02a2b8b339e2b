//! Cameras (glTF 2.0, section 3.10).

use serde::Deserialize;

/// A camera. It looks along -z, with y upwards.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Camera {
    /// Projection.
    #[serde(rename = "type")]
    pub camera_type: CameraType,
    /// Parameters of an orthographic projection.
    pub orthographic: Option<Orthographic>,
    /// Parameters of a perspective projection.
    pub perspective: Option<Perspective>,
    /// Name for people.
    pub name: Option<String>,
}

/// Projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CameraType {
    /// Perspective projection.
    Perspective,
    /// Orthographic projection.
    Orthographic,
}

/// Parameters of a perspective projection.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Perspective {
    /// Vertical angle of view in radians.
    pub yfov: f64,
    /// Width divided by height; that of the image if `None`.
    pub aspect_ratio: Option<f64>,
    /// Distance of the near clipping plane.
    pub znear: f64,
    /// Distance of the far clipping plane; infinite if `None`.
    pub zfar: Option<f64>,
}

/// Parameters of an orthographic projection.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Orthographic {
    /// Half of the width.
    pub xmag: f64,
    /// Half of the height.
    pub ymag: f64,
    /// Distance of the near clipping plane.
    pub znear: f64,
    /// Distance of the far clipping plane.
    pub zfar: f64,
}
