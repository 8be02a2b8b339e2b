//! Checkpoints: a `.jfilm` file that each save replaces atomically. Until the render is complete,
//! the previous checkpoint stays beside it as `NAME.previous`.

use crate::partial_render::{PartialRender, PartialRenderError, RenderDescription, Stop, write};
use juggler_camera::film::{Film, Tile, TileError};
use std::ffi::OsString;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A checkpoint file and its predecessor.
#[derive(Debug)]
pub struct Checkpoint {
    path: PathBuf,
    /// Path of the previous checkpoint.
    previous: PathBuf,
    /// Whether the file at `path` is valid, so that the next save keeps it as the previous
    /// checkpoint.
    is_good: bool,
}

/// Result of opening a checkpoint.
#[derive(Debug, Default)]
pub struct OpenedCheckpoint {
    /// The checkpoint to resume from; `None` if no file exists.
    pub partial_render: Option<PartialRender>,
    /// Why the newest checkpoint is unusable, if `partial_render` is the previous one.
    pub damage: Option<PartialRenderError>,
}

/// Why a render cannot resume from a partial render.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ResumeError {
    /// The file cannot be read or is damaged.
    #[error(transparent)]
    PartialRender(#[from] PartialRenderError),
    /// The file belongs to another image.
    #[error("cannot resume from `{file}`: it belongs to another picture: {differences}")]
    OtherImage {
        /// Path of the file.
        file: String,
        /// The settings that differ, with both values.
        differences: String,
    },
    /// The file holds samples outside the requested range, or its stop rule is incompatible.
    #[error("cannot resume from `{file}`: {what}")]
    Incompatible {
        /// Path of the file.
        file: String,
        /// Description of the conflict.
        what: String,
    },
    /// The sample ranges of a tile do not fit together.
    #[error("cannot resume from `{file}`: {error}")]
    Tile {
        /// Path of the file.
        file: String,
        /// Cause.
        error: TileError,
    },
}

impl Checkpoint {
    /// Opens the checkpoint at `path` and verifies all of its bytes. If the newest file is damaged,
    /// the previous checkpoint is used instead.
    ///
    /// # Errors
    ///
    /// The newest checkpoint's error, if it is damaged and no valid previous one exists.
    pub fn open(path: &Path) -> Result<(Self, OpenedCheckpoint), PartialRenderError> {
        let mut name = path.file_name().map_or_else(OsString::new, OsString::from);
        name.push(".previous");
        let previous = path.with_file_name(name);
        let partial_render = open_verified(path);
        let is_good = matches!(partial_render, Ok(Some(_)));
        let checkpoint = Self { path: path.to_owned(), previous, is_good };
        let found = match partial_render {
            Ok(Some(partial_render)) => OpenedCheckpoint { partial_render: Some(partial_render), damage: None },
            // The process was killed while replacing the file, or nothing was saved yet.
            Ok(None) => OpenedCheckpoint { partial_render: open_verified(&checkpoint.previous)?, damage: None },
            Err(damage) => match open_verified(&checkpoint.previous) {
                Ok(Some(partial_render)) => {
                    OpenedCheckpoint { partial_render: Some(partial_render), damage: Some(damage) }
                }
                _ => return Err(damage),
            },
        };
        Ok((checkpoint, found))
    }

    /// Writes all tiles of `film` atomically and keeps the last valid checkpoint as the previous
    /// one. Render threads may add samples meanwhile. Returns the file's length in bytes.
    pub fn save(&mut self, description: &RenderDescription, film: &Film) -> Result<u64, PartialRenderError> {
        if self.is_good {
            // Without hard links the save still replaces the file atomically; only the previous one
            // is lost.
            let _ = fs::remove_file(&self.previous);
            let _ = fs::hard_link(&self.path, &self.previous);
        }
        let bytes = write(&self.path, description, film.tiles())?;
        self.is_good = true;
        Ok(bytes)
    }

    /// Removes the previous checkpoint once the render is complete.
    pub fn close(self) {
        let _ = fs::remove_file(&self.previous);
    }
}

/// Opens and verifies the file at `path`; `None` if it does not exist.
fn open_verified(path: &Path) -> Result<Option<PartialRender>, PartialRenderError> {
    match PartialRender::open(path) {
        Err(PartialRenderError::Read { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
        Ok(partial_render) => partial_render.verify().map(|()| Some(partial_render)),
    }
}

/// Adds all tiles of `partial_render` to `film`, whose render `goal` describes.
///
/// # Errors
///
/// The partial render belongs to another image, its stop rule is incompatible, or it holds samples
/// that `film` does not expect.
pub fn resume(partial_render: &PartialRender, goal: &RenderDescription, film: &Film) -> Result<(), ResumeError> {
    let file = || partial_render.name().to_owned();
    let found = partial_render.description();
    let differences = goal.mismatches(found);
    let differences: Vec<String> = differences
        .iter()
        // The number of samples and the stop rule may differ.
        .filter(|difference| !["samples", "stop"].contains(&difference.name.as_str()))
        .map(ToString::to_string)
        .collect();
    if !differences.is_empty() {
        let differences = if found.scene == goal.scene {
            differences.join("; ")
        } else {
            format!("of the scene `{}`, not `{}`", found.scene, goal.scene)
        };
        return Err(ResumeError::OtherImage { file: file(), differences });
    }
    let incompatible = |what: String| ResumeError::Incompatible { file: file(), what };
    check_stop(found.stop, goal.stop).map_err(&incompatible)?;
    let mut reader = partial_render.reader()?;
    for number in partial_render.tiles() {
        let tile = reader.tile(number)?;
        check_tile(&tile, number, film).map_err(&incompatible)?;
        film.add(number, tile).map_err(|error| ResumeError::Tile { file: file(), error })?;
    }
    Ok(())
}

/// Checks that resuming with stop rule `now` gives the same image as rendering with it from the
/// start.
fn check_stop(before: Stop, now: Stop) -> Result<(), String> {
    match (before, now) {
        (Stop::Noise { level: before }, Stop::Noise { level: now }) if now > before => {
            Err(format!("its noise limit {before} is finer than {now}"))
        }
        (Stop::Samples | Stop::Time { .. }, Stop::Noise { .. }) => {
            Err("it was rendered without a noise limit, which might have stopped it at fewer samples".into())
        }
        _ => Ok(()),
    }
}

/// Checks that the film requests all samples of a tile.
pub(crate) fn check_tile(tile: &Tile, number: u64, film: &Film) -> Result<(), String> {
    let expected = film.requested_of(number);
    let outside = |samples: &Range<u32>| {
        !expected.iter().any(|expected| expected.start <= samples.start && samples.end <= expected.end)
    };
    match tile.runs().iter().map(|run| &run.samples).find(|samples| outside(samples)) {
        None => Ok(()),
        Some(_) if expected.is_empty() => {
            Err(format!("it holds tile {number}, which is outside of the requested region"))
        }
        Some(samples) => {
            let (end, most) = (samples.end, expected.last().map_or(0, |expected| expected.end));
            Err(format!("it has samples up to {end} per pixel; those beyond {most} cannot be removed"))
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::testing::{description, place, tile, tiles};
    use juggler_camera::film::{Rect, Tiling};

    const REGION: Rect = Rect { x: 0, y: 0, width: 40, height: 20 };

    fn film(samples: u32) -> Film {
        Film::new(Tiling::new(REGION), 0..samples)
    }

    fn film_with(held: u32, expected: u32) -> Film {
        let film = film(expected);
        tiles(REGION, 0..held).into_iter().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
        film
    }

    fn found(path: &Path) -> (Checkpoint, OpenedCheckpoint) {
        Checkpoint::open(path).unwrap()
    }

    #[test]
    fn a_render_resumes_from_its_checkpoint() {
        let (_folder, path) = place("a.jfilm");
        let (mut kept, nothing) = found(&path);
        assert!(nothing.partial_render.is_none() && nothing.damage.is_none());
        kept.save(&description(REGION, 64), &film_with(20, 64)).unwrap();
        let partial_render = found(&path).1.partial_render.unwrap();
        for goal in [64, 100] {
            let film = film(goal);
            resume(&partial_render, &description(REGION, goal), &film).unwrap();
            assert_eq!(film.tiles().collect::<Vec<_>>(), film_with(20, 64).tiles().collect::<Vec<_>>());
        }
        let refused = resume(&partial_render, &description(REGION, 16), &film(16)).unwrap_err().to_string();
        assert!(refused.contains("up to 20") && refused.contains("beyond 16"), "{refused}");
    }

    #[test]
    fn another_picture_is_rejected_with_its_differences() {
        let (_folder, path) = place("a.jfilm");
        found(&path).0.save(&description(REGION, 64), &film_with(16, 64)).unwrap();
        let partial_render = found(&path).1.partial_render.unwrap();
        let mut other = description(REGION, 64);
        other.fingerprint.insert("seed".into(), "8".into());
        other.frame = 3.0;
        let refused = resume(&partial_render, &other, &film(64)).unwrap_err().to_string();
        assert!(refused.contains("seed: 7 instead of 8") && refused.contains("frame: 2.4"), "{refused}");
        other.scene = "juggler".into();
        let refused = resume(&partial_render, &other, &film(64)).unwrap_err().to_string();
        assert!(refused.contains("of the scene `") && refused.contains("not `juggler`"), "{refused}");
        let small = Film::from_tiles(Tiling::new(REGION), [(0, 0..64)]);
        let refused = resume(&partial_render, &description(REGION, 64), &small).unwrap_err().to_string();
        assert!(refused.contains("tile 1"), "{refused}");
    }

    #[test]
    fn stop_rules_can_only_become_stricter() {
        let noise = |level| Stop::Noise { level };
        let time = Stop::Time { seconds: 1.0 };
        for (before, now) in [
            (Stop::Samples, Stop::Samples),
            (noise(0.1), noise(0.1)),
            (noise(0.1), noise(0.05)),
            (noise(0.1), Stop::Samples),
            (time, Stop::Samples),
            (Stop::Samples, time),
            (noise(0.1), time),
        ] {
            assert_eq!(check_stop(before, now), Ok(()), "{before} {now}");
        }
        for (before, now) in [(noise(0.05), noise(0.1)), (Stop::Samples, noise(0.1)), (time, noise(0.1))] {
            assert!(check_stop(before, now).is_err(), "{before} {now}");
        }
    }

    #[test]
    fn the_previous_file_replaces_a_damaged_one() {
        let (_folder, path) = place("a.jfilm");
        let (mut kept, _) = found(&path);
        kept.save(&description(REGION, 64), &film_with(16, 64)).unwrap();
        kept.save(&description(REGION, 64), &film_with(32, 64)).unwrap();
        let good = fs::read(&path).unwrap();
        let held = |found: &OpenedCheckpoint| {
            found.partial_render.as_ref().map(|partial_render| partial_render.tile(0).unwrap().gapless_samples())
        };
        for bytes in [good.len() / 2, good.len() - 1, 4, 0] {
            fs::write(&path, &good[..bytes]).unwrap();
            let (mut kept, found) = found(&path);
            assert_eq!((held(&found), found.damage.is_some()), (Some(16), true), "{bytes} bytes");
            // A damaged file must not replace the valid previous checkpoint.
            kept.save(&description(REGION, 64), &film_with(48, 64)).unwrap();
            assert_eq!(held(&self::found(&path).1), Some(48));
            fs::write(&path, "damaged again").unwrap();
            assert_eq!(held(&self::found(&path).1), Some(16));
        }
        // Killed between removing the old file and renaming the new one.
        fs::remove_file(&path).unwrap();
        assert_eq!(held(&found(&path).1), Some(16));
        fs::write(path.with_file_name("a.jfilm.previous"), "no partial_render").unwrap();
        fs::write(&path, &good[..good.len() - 1]).unwrap();
        assert!(matches!(Checkpoint::open(&path), Err(PartialRenderError::Truncated { .. })), "nothing good is left");
    }

    #[test]
    fn closing_a_checkpoint_removes_the_previous_file() {
        let (folder, path) = place("a.jfilm");
        let (mut kept, _) = found(&path);
        kept.save(&description(REGION, 64), &film_with(16, 64)).unwrap();
        kept.save(&description(REGION, 64), &film_with(64, 64)).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        kept.close();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn other_files_are_never_overwritten() {
        let (_folder, path) = place("scene.json");
        fs::write(&path, "{}").unwrap();
        assert!(matches!(Checkpoint::open(&path), Err(PartialRenderError::NotAPartialRender { .. })));
    }

    #[test]
    fn samples_fit_a_tile_of_several_ranges() {
        let (_folder, path) = place("a.jfilm");
        let expected = || Film::from_tiles(Tiling::new(REGION), [(0, 0..16), (0, 16..32), (0, 48..64)]);
        let some = expected();
        assert_eq!(some.add(0, tile(Tiling::new(REGION).tile(0).unwrap(), 0..32)), Ok(true));
        found(&path).0.save(&description(REGION, 64), &some).unwrap();
        let again = expected();
        resume(&found(&path).1.partial_render.unwrap(), &description(REGION, 64), &again).unwrap();
        assert_eq!(again.samples(), 32 * 256);
    }
}
