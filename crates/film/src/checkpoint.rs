//! Work that is kept while it is done: a film part that is replaced again and again, and beside it the one before,
//! until the end.

use crate::part::{Description, Part, PartError, Stop, write};
use juggler_camera::film::{Film, Tile, TileError};
use std::ffi::OsString;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A checkpoint's file.
#[derive(Debug)]
pub struct Checkpoint {
    path: PathBuf,
    /// Where the one before is kept.
    previous: PathBuf,
    /// Whether the file is good, so that it may become the one before.
    is_good: bool,
}

/// What was found when a checkpoint was opened.
#[derive(Debug, Default)]
pub struct Found {
    /// The work so far.
    pub part: Option<Part>,
    /// Why that is not the newest, but the one before.
    pub damage: Option<PartError>,
}

/// Why a render cannot go on from a part.
#[derive(Debug, thiserror::Error)]
pub enum ResumeError {
    /// Its file cannot be trusted.
    #[error(transparent)]
    Part(#[from] PartError),
    /// It is of another picture.
    #[error("{file}: holds the work on another picture: {differences}")]
    Foreign {
        /// The file.
        file: String,
        /// What differs, with both values.
        differences: String,
    },
    /// It holds more than was asked for, or other samples.
    #[error("{file}: {what}")]
    Beyond {
        /// The file.
        file: String,
        /// What.
        what: String,
    },
    /// Its samples do not fit together.
    #[error("{file}: {error}")]
    Tile {
        /// The file.
        file: String,
        /// Why.
        error: TileError,
    },
}

impl Checkpoint {
    /// Looks for work that was kept. A file that is damaged is not used, and the one before it is when there is one;
    /// an error when there is none.
    pub fn open(path: &Path) -> Result<(Self, Found), PartError> {
        let mut name = path.file_name().map_or_else(OsString::new, OsString::from);
        name.push(".previous");
        let previous = path.with_file_name(name);
        let part = trusted(path);
        let is_good = matches!(part, Ok(Some(_)));
        let checkpoint = Self { path: path.to_owned(), previous, is_good };
        let found = match part {
            Ok(Some(part)) => Found { part: Some(part), damage: None },
            // Killed between two steps of replacing it, or never written.
            Ok(None) => Found { part: trusted(&checkpoint.previous)?, damage: None },
            Err(damage) => match trusted(&checkpoint.previous) {
                Ok(Some(part)) => Found { part: Some(part), damage: Some(damage) },
                _ => return Err(damage),
            },
        };
        Ok((checkpoint, found))
    }

    /// Keeps what a film holds now; it may be exposed meanwhile. Returns how many bytes were written.
    pub fn save(&mut self, description: &Description, film: &Film) -> Result<u64, PartError> {
        if self.is_good {
            // What cannot be linked is replaced all the same, at once and whole.
            let _ = fs::remove_file(&self.previous);
            let _ = fs::hard_link(&self.path, &self.previous);
        }
        let bytes = write(&self.path, description, film.tiles())?;
        self.is_good = true;
        Ok(bytes)
    }

    /// The work is done: the one before is of no use any more.
    pub fn close(self) {
        let _ = fs::remove_file(&self.previous);
    }
}

/// The part in a file, all of it verified; nothing where no file is.
fn trusted(path: &Path) -> Result<Option<Part>, PartError> {
    match Part::open(path) {
        Err(PartError::Read { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
        Ok(part) => part.verify().map(|()| Some(part)),
    }
}

/// Puts what a part holds on a film that is to become what `goal` says.
pub fn resume(part: &Part, goal: &Description, film: &Film) -> Result<(), ResumeError> {
    let file = || part.path().display().to_string();
    let found = part.description();
    let differences = goal.mismatches(found);
    let differences: Vec<String> = differences
        .iter()
        // How far it went before may differ.
        .filter(|difference| !["samples", "stop"].contains(&difference.name.as_str()))
        .map(ToString::to_string)
        .collect();
    if !differences.is_empty() {
        let differences = if found.scene == goal.scene {
            differences.join("; ")
        } else {
            format!("of the scene `{}`, not `{}`", found.scene, goal.scene)
        };
        return Err(ResumeError::Foreign { file: file(), differences });
    }
    let beyond = |what: String| ResumeError::Beyond { file: file(), what };
    check_stop(found.stop, goal.stop).map_err(&beyond)?;
    let mut reader = part.reader()?;
    for number in part.tiles() {
        let tile = reader.tile(number)?;
        check_tile(&tile, number, film).map_err(&beyond)?;
        film.add(number, tile).map_err(|error| ResumeError::Tile { file: file(), error })?;
    }
    Ok(())
}

/// Whether a picture that was to end by one rule can be gone on with by another and be as if it had always been that
/// one.
fn check_stop(before: Stop, now: Stop) -> Result<(), String> {
    match (before, now) {
        (Stop::Noise { level: before }, Stop::Noise { level: now }) if now > before => {
            Err(format!("was to end at noise {before}, which is finer than {now}"))
        }
        (Stop::Samples | Stop::Time { .. }, Stop::Noise { .. }) => {
            Err("was not ended by noise: by that rule it might have fewer samples".into())
        }
        _ => Ok(()),
    }
}

fn check_tile(tile: &Tile, number: u64, film: &Film) -> Result<(), String> {
    let wanted = film.wanted_of(number);
    let outside =
        |samples: &Range<u32>| !wanted.iter().any(|wanted| wanted.start <= samples.start && samples.end <= wanted.end);
    match tile.runs().iter().map(|run| &run.samples).find(|samples| outside(samples)) {
        None => Ok(()),
        Some(_) if wanted.is_empty() => Err(format!("holds tile {number}, which is no part of what is asked for")),
        Some(samples) => {
            let (end, most) = (samples.end, wanted.last().map_or(0, |wanted| wanted.end));
            Err(format!("holds samples up to {end} of a pixel; what is there beyond {most} cannot be taken back"))
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::testing::{description, place, tile, tiles};
    use juggler_camera::film::{Layout, Rect};

    const REGION: Rect = Rect { x: 0, y: 0, width: 40, height: 20 };

    fn film(samples: u32) -> Film {
        Film::new(Layout::new(REGION), 0..samples)
    }

    fn exposed(held: u32, wanted: u32) -> Film {
        let film = film(wanted);
        tiles(REGION, 0..held).into_iter().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
        film
    }

    fn found(path: &Path) -> (Checkpoint, Found) {
        Checkpoint::open(path).unwrap()
    }

    #[test]
    fn what_was_kept_is_gone_on_with() {
        let (_folder, path) = place("a.jfilm");
        let (mut kept, nothing) = found(&path);
        assert!(nothing.part.is_none() && nothing.damage.is_none());
        kept.save(&description(REGION, 64), &exposed(20, 64)).unwrap();
        let part = found(&path).1.part.unwrap();
        for goal in [64, 100] {
            let film = film(goal);
            resume(&part, &description(REGION, goal), &film).unwrap();
            assert_eq!(film.tiles().collect::<Vec<_>>(), exposed(20, 64).tiles().collect::<Vec<_>>());
        }
        let refused = resume(&part, &description(REGION, 16), &film(16)).unwrap_err().to_string();
        assert!(refused.contains("up to 20") && refused.contains("beyond 16"), "{refused}");
    }

    #[test]
    fn another_picture_is_refused_with_what_differs() {
        let (_folder, path) = place("a.jfilm");
        found(&path).0.save(&description(REGION, 64), &exposed(16, 64)).unwrap();
        let part = found(&path).1.part.unwrap();
        let mut other = description(REGION, 64);
        other.fingerprint.insert("seed".into(), "8".into());
        other.frame = 3.0;
        let refused = resume(&part, &other, &film(64)).unwrap_err().to_string();
        assert!(refused.contains("seed: 7 instead of 8") && refused.contains("frame: 2.4"), "{refused}");
        other.scene = "juggler".into();
        let refused = resume(&part, &other, &film(64)).unwrap_err().to_string();
        assert!(refused.contains("of the scene `") && refused.contains("not `juggler`"), "{refused}");
        let small = Film::of(Layout::new(REGION), [(0, 0..64)]);
        let refused = resume(&part, &description(REGION, 64), &small).unwrap_err().to_string();
        assert!(refused.contains("tile 1"), "{refused}");
    }

    #[test]
    fn rules_to_stop_can_be_made_stricter_only() {
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
    fn a_damaged_file_gives_way_to_the_one_before() {
        let (_folder, path) = place("a.jfilm");
        let (mut kept, _) = found(&path);
        kept.save(&description(REGION, 64), &exposed(16, 64)).unwrap();
        kept.save(&description(REGION, 64), &exposed(32, 64)).unwrap();
        let good = fs::read(&path).unwrap();
        let held = |found: &Found| found.part.as_ref().map(|part| part.tile(0).unwrap().samples());
        for bytes in [good.len() / 2, good.len() - 1, 4, 0] {
            fs::write(&path, &good[..bytes]).unwrap();
            let (mut kept, found) = found(&path);
            assert_eq!((held(&found), found.damage.is_some()), (Some(16), true), "{bytes} bytes");
            // What is damaged does not push the good one out.
            kept.save(&description(REGION, 64), &exposed(48, 64)).unwrap();
            assert_eq!(held(&self::found(&path).1), Some(48));
            fs::write(&path, "damaged again").unwrap();
            assert_eq!(held(&self::found(&path).1), Some(16));
        }
        // Killed between taking the old one away and putting the new one in its place.
        fs::remove_file(&path).unwrap();
        assert_eq!(held(&found(&path).1), Some(16));
        fs::write(path.with_file_name("a.jfilm.previous"), "no part").unwrap();
        fs::write(&path, &good[..good.len() - 1]).unwrap();
        assert!(matches!(Checkpoint::open(&path), Err(PartError::Truncated { .. })), "nothing good is left");
    }

    #[test]
    fn the_end_leaves_one_file() {
        let (folder, path) = place("a.jfilm");
        let (mut kept, _) = found(&path);
        kept.save(&description(REGION, 64), &exposed(16, 64)).unwrap();
        kept.save(&description(REGION, 64), &exposed(64, 64)).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        kept.close();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn other_files_are_never_written_over() {
        let (_folder, path) = place("scene.json");
        fs::write(&path, "{}").unwrap();
        assert!(matches!(Checkpoint::open(&path), Err(PartError::NotAPart { .. })));
    }

    #[test]
    fn a_part_of_a_tile_that_is_wanted_in_pieces_fits() {
        let (_folder, path) = place("a.jfilm");
        let wanted = || Film::of(Layout::new(REGION), [(0, 0..16), (0, 16..32), (0, 48..64)]);
        let some = wanted();
        assert_eq!(some.add(0, tile(Layout::new(REGION).tile(0).unwrap(), 0..32)), Ok(true));
        found(&path).0.save(&description(REGION, 64), &some).unwrap();
        let again = wanted();
        resume(&found(&path).1.part.unwrap(), &description(REGION, 64), &again).unwrap();
        assert_eq!(again.samples(), 32 * 256);
    }
}
