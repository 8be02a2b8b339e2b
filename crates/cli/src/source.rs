//! Scene sources: files, standard input and built-in scenes.

use crate::failure::Failure;
use crate::format::bytes;
use crate::model_args::ModelArgs;
#[cfg(any(feature = "view", feature = "serve"))]
use crate::stage_args;
use juggler::memory::model_bytes;
use juggler::mesh::{FileContent, estimate};
use juggler::scene::document::{bytes_to_read, read_text};
use juggler::scene::{Loader, Scene, named};
use std::io::Read;
use std::path::Path;

/// Scene name that stands for standard input.
const STANDARD_INPUT: &str = "-";
/// Name of standard input in messages.
const STANDARD_INPUT_NAME: &str = "standard input";
/// Maximum length of standard input, in bytes.
const MAX_BYTES: u64 = 64 << 20;

/// Loads a scene file, a mesh file (in a default scene), or a built-in scene. Fails if reading the
/// file needs more than `most` bytes of memory.
pub fn load(name: &str, most: Option<u64>) -> Result<Scene, Failure> {
    load_by(juggler::loader(), name, most)
}

/// Loads as [`load`], by a loader.
fn load_by(loader: Loader, name: &str, most: Option<u64>) -> Result<Scene, Failure> {
    if name == STANDARD_INPUT {
        let text = standard_input()?;
        check_memory(bytes_to_read(text.as_bytes()), STANDARD_INPUT_NAME, most)?;
        return Ok(loader.from_json(text, STANDARD_INPUT_NAME)?);
    }
    let path = Path::new(name);
    if FileContent::detect(path).is_mesh() {
        check_memory(estimate(path).map_or(0, |mesh| mesh.peak_bytes), name, most)?;
        if most.is_some() && loader.is_model(path) {
            check_memory(model_bytes(&loader.model_needs(path)), name, most)?;
        }
    } else if most.is_some() && path.is_file() {
        check_memory(std::fs::metadata(path).map_or(0, |file| file.len()), name, most)?;
        check_memory(model_bytes(&loader.model_needs(path)), name, most)?;
        check_memory(read_text(path).map_or(0, |text| bytes_to_read(text.as_bytes())), name, most)?;
    }
    let scene = loader.named(name)?;
    if most.is_some() && !scene.is_around_model() {
        check_memory(model_bytes(&scene.model_needs()), name, most)?;
    }
    Ok(scene)
}

/// Loads as [`load`], and selects what a model file shows.
///
/// # Errors
///
/// As [`load`]; also if flags for models are given and the file is no model.
pub fn load_model(name: &str, model: &ModelArgs, most: Option<u64>) -> Result<Scene, Failure> {
    let mut scene = load_by(model.loader(), name, most)?;
    model.apply(name, &mut scene)?;
    Ok(scene)
}

/// Loads as [`load_model`], without a limit of memory and without decoding pictures of textures.
///
/// # Errors
///
/// As [`load_model`].
pub fn load_outline(name: &str, model: &ModelArgs) -> Result<Scene, Failure> {
    let mut scene = load_by(model.loader().with_picture_heads(), name, None)?;
    model.apply(name, &mut scene)?;
    Ok(scene)
}

/// Values of the scene `name` by JSON pointer that select what its model shows, and how.
///
/// # Errors
///
/// As [`load_model`].
#[cfg(any(feature = "view", feature = "serve"))]
pub fn model_values(name: &str, model: &ModelArgs) -> Result<Vec<(String, serde_json::Value)>, Failure> {
    let mut values = model.values();
    if model.lenient || model.stage.is_given() || !values.is_empty() {
        let mut scene = load_by(model.loader(), name, None)?;
        model.choose(name, &mut scene)?;
        values.extend(model.stage().edits(&scene).map_err(stage_args::failure)?);
    }
    Ok(values)
}

/// Checks that a scene file or built-in scene of this name exists, without checking its contents.
#[cfg(feature = "view")]
pub fn find(name: &str) -> Result<(), Failure> {
    let path = Path::new(name);
    let is_foreign =
        matches!(FileContent::detect(path), FileContent::Unsupported(_)) && !juggler::loader().is_model(path);
    if path.exists() && !path.is_dir() && !is_foreign {
        return Ok(());
    }
    juggler::loader().named(name).map(drop).map_err(Failure::from)
}

fn check_memory(needed: u64, name: &str, most: Option<u64>) -> Result<(), Failure> {
    match most {
        Some(most) if needed > most => Err(Failure::Invalid(format!(
            "the scene `{name}` needs about {} of memory to be read, more than --max-memory {}",
            bytes(needed),
            bytes(most)
        ))),
        _ => Ok(()),
    }
}

fn standard_input() -> Result<String, Failure> {
    let mut text = Vec::new();
    let read = std::io::stdin().lock().take(MAX_BYTES + 1).read_to_end(&mut text);
    read.map_err(|error| Failure::file("read", STANDARD_INPUT_NAME, &error))?;
    if text.len() as u64 > MAX_BYTES {
        let most = bytes(MAX_BYTES);
        return Err(Failure::Invalid(format!("{STANDARD_INPUT_NAME} holds more than the limit of {most}")));
    }
    String::from_utf8(text).map_err(|_| Failure::Unreadable(format!("{STANDARD_INPUT_NAME} is not UTF-8 text")))
}

/// File name without folder and extension.
pub fn stem(name: &str) -> &str {
    let stem = Path::new(name).file_stem().and_then(|stem| stem.to_str());
    stem.filter(|stem| *stem != STANDARD_INPUT).unwrap_or("picture")
}

/// Error for a name that is neither a file nor built in.
pub fn unknown<'n>(name: &str, what: &str, built_in: impl IntoIterator<Item = &'n str>) -> Failure {
    named::unknown(name, what, built_in).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn output_names_use_the_stem_of_the_scene() {
        assert_eq!(stem("-"), "picture");
        assert_eq!((stem("juggler"), stem("a/b.scene.json"), stem("..")), ("juggler", "b.scene", "picture"));
    }
}
