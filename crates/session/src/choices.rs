//! What a user chose beside values of the scene.

use juggler::Settings;
use juggler::camera::AnyCamera;
use juggler::math::Rgb;

/// Settings, cameras and gains of lights that a user chose.
#[derive(Clone, Default)]
pub struct Choices {
    /// Settings that override the scene's.
    pub settings: Settings,
    /// Size that a reset restores; `None` restores the scene's.
    pub size: Option<[u32; 2]>,
    /// Camera that an edit has moved; `None` for the scene's own.
    pub camera: Option<AnyCamera>,
    /// Bookmarked cameras held in memory, by name.
    pub bookmarks: Vec<(String, AnyCamera)>,
    /// RGB gains of light groups, by name; 1 for all others.
    pub gains: Vec<(String, Rgb)>,
}
