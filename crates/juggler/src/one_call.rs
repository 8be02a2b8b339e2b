//! Rendering of a scene in one call.

use crate::{Error, Picture, RenderStats, Settings};
use juggler_imaging::{ImageError, ImageFormat, Options};
use juggler_math::Image;
use juggler_render::Control;
use juggler_scene::Scene;
use std::path::Path;
use std::time::Instant;

/// Renders a scene into memory, on the threads of the current rayon pool.
///
/// ```
/// use juggler::prelude::*;
///
/// let scene = Scene::new().size(8, 8).add(Object::new(Sphere::default()));
/// let image = juggler::render(&scene, &Settings { samples: Some(1), ..Settings::default() })?;
/// assert!(image.pixels().iter().any(|pixel| pixel.luminance() > 0.5));
/// # Ok::<(), juggler::Error>(())
/// ```
pub fn render(scene: &Scene, settings: &Settings) -> Result<Image, Error> {
    let image = Picture::new(scene, settings)?.render_in_memory(None, &Control::default())?;
    Ok(image.into_image())
}

/// Renders a scene to a file; the extension selects the format. The file replaces an existing one
/// once it is complete. Rows are written as they are rendered, unless the settings ask for AOVs (which
/// an EXR file contains), for a denoiser, or for a limit of noise or time.
pub fn render_to_file(scene: &Scene, settings: &Settings, path: impl AsRef<Path>) -> Result<RenderStats, Error> {
    let path = path.as_ref();
    let format = ImageFormat::from_path(path)?;
    let picture = Picture::new(scene, settings)?;
    if picture.needs_film() {
        check_file(path)?;
        let image = picture.render_in_memory(None, &Control::default())?;
        let start = Instant::now();
        image.save(path)?;
        return Ok(RenderStats { write: start.elapsed(), ..image.stats().clone() });
    }
    let writer = juggler_imaging::create(path, format, &picture.header(Options::default()))?;
    picture.write(writer, &Control::default())
}

/// Checks before a render that a file can be written in the folder of `path`.
fn check_file(path: &Path) -> Result<(), Error> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match std::fs::metadata(folder) {
        Ok(_) => Ok(()),
        Err(source) => Err(ImageError::Write { file: path.display().to_string(), source }.into()),
    }
}
