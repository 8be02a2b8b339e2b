//! Formats of model files that the program knows.

use juggler_import::gltf::GltfFormat;
use juggler_import::obj::ObjFormat;
use juggler_import::stl::StlFormat;
use juggler_scene::Loader;
use juggler_scene::model::ModelFormat;

/// All formats of model files.
pub const MODEL_FORMATS: &[&dyn ModelFormat] = &[
    &GltfFormat { limits: None }, //
    &ObjFormat,
    &StlFormat,
];

/// Loader of scenes that knows all formats of model files.
///
/// ```no_run
/// let scene = juggler::loader().load("car.glb")?;
/// let image = juggler::render(&scene, &juggler::Settings::default())?;
/// # Ok::<(), juggler::Error>(())
/// ```
pub const fn loader() -> Loader {
    Loader::new(MODEL_FORMATS)
}
