//! Memory limit of scenes of files in memory.

use juggler::memory::{Effort, Memory};
use juggler::scene::{Bundle, Scene};
use juggler::{Error, Settings};

/// Checks that files in memory, the scene that they make and its film fit in `most` bytes, before the
/// world is built.
///
/// # Errors
///
/// They do not fit, or the settings are invalid.
pub fn check(files: &Bundle, scene: &Scene, settings: &Settings, most: u64) -> Result<(), Error> {
    let effort = Effort { threads: rayon::current_num_threads(), band_pixels: 0 };
    let render = Memory::estimate(scene, settings)?.with_film(None, None, 1).bytes(&effort);
    let needed = render.saturating_add(files.bytes()).saturating_add(files.mesh_bytes());
    if needed <= most {
        return Ok(());
    }
    let [needed, most] = [needed, most].map(|bytes| bytes as f64 / f64::from(1 << 20));
    Err(Error::Settings {
        setting: "max_memory".to_owned(),
        message: format!("the scene needs about {needed:.1} MiB of memory, more than --max-memory {most:.1} MiB"),
        help: None,
    })
}
