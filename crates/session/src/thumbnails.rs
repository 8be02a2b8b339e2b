//! Thumbnails of the built-in scenes, embedded in the program.

/// Thumbnail files by the name of their scene.
macro_rules! thumbnails {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_bytes!(concat!("../thumbnails/", $name, ".jpg")))),+]
    };
}

/// All thumbnails, JPEG files of at most 208 x 208 pixels.
const THUMBNAILS: &[(&str, &[u8])] = thumbnails! {
    "blossom",
    "chess",
    "chess-daylight",
    "chess-opening",
    "cornell-box",
    "cornell-cube",
    "depth-of-field",
    "evening-cradle",
    "first-render",
    "four-spheres-mirrors",
    "furnace",
    "glass-caustics",
    "glossy-plates",
    "graham",
    "juggler",
    "juggler-daylight",
    "many-lights-room",
    "marbles",
    "material-balls",
    "one-sphere",
    "red-cube",
    "scalablitz-ice-cream",
    "scalablitz-nice-light",
    "scalablitz-planet-moon",
    "scalablitz-pool",
    "scalablitz-random",
    "scalablitz-sphere-pyramid",
    "scalablitz-triangles-and-spheres",
    "six-mirror-spheres",
    "sphere-lights",
    "sphere-triangle-shadow",
    "step-08",
    "step-09",
    "step-10",
    "step-11",
    "step-12",
    "step-12b",
    "step-13",
    "step-13-mirror",
    "step-13c",
    "transparent-shadow",
    "triangle-lights",
    "two-spheres-mirrored",
    "two-spheres-refraction",
};

/// Returns the thumbnail of a built-in scene as a JPEG file, or `None` for other names.
pub fn thumbnail(scene: &str) -> Option<&'static [u8]> {
    THUMBNAILS.iter().find(|(name, _)| *name == scene).map(|(_, picture)| *picture)
}
