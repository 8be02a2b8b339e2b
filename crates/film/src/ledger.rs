//! Adds partial renders of several workers to one film. They may come in any order, twice or not at
//! all: the film names what is missing ([`Work::missing`](crate::shard::Work::missing)), samples that
//! it holds already are dropped, and sums are joined along the fixed tree, so that the pixels do not
//! depend on the workers.

use crate::checkpoint::check_tile;
use crate::partial_render::{PartialRender, PartialRenderError, RenderDescription, Stop};
use juggler_camera::film::{Film, SampleRun, Tile};

/// What a partial render added to a film.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Added {
    /// Samples of all pixels that the film did not hold before.
    pub samples: u64,
    /// Samples of all pixels that the film held already.
    pub duplicates: u64,
}

/// Why a partial render cannot be added to a film.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AddError {
    /// The partial render is damaged.
    #[error(transparent)]
    PartialRender(#[from] PartialRenderError),
    /// The partial render belongs to another image or to other settings, or it does not fit the film.
    #[error("cannot add `{file}`: {what}")]
    Unfit {
        /// Name of the partial render.
        file: String,
        /// Description of the conflict.
        what: String,
    },
}

/// Adds the samples of `partial_render` to `film`, whose render `goal` describes. Nothing is added if
/// any tile is wrong.
///
/// # Errors
///
/// The partial render is damaged or of another image, it lacks samples under a noise limit, or it holds
/// samples that the film does not request, or of which the film holds some and lacks others.
pub fn add(partial_render: &PartialRender, goal: &RenderDescription, film: &Film) -> Result<Added, AddError> {
    let unfit = |what: String| AddError::Unfit { file: partial_render.name().to_owned(), what };
    let found = partial_render.description();
    let mismatches: Vec<String> = goal.mismatches(found).iter().map(ToString::to_string).collect();
    if !mismatches.is_empty() {
        return Err(unfit(format!("it belongs to another picture: {}", mismatches.join("; "))));
    }
    if goal.stop != Stop::Samples && !found.finished {
        return Err(unfit("it is not finished".into()));
    }
    let (mut added, mut reader, mut tiles) = (Added::default(), partial_render.reader()?, Vec::new());
    for number in partial_render.tiles() {
        let tile = reader.tile(number)?;
        check_tile(&tile, number, film).map_err(&unfit)?;
        tiles.push((number, new_samples(tile, number, film, &mut added).map_err(&unfit)?));
    }
    for (number, tile) in tiles {
        film.add(number, tile).map_err(|error| unfit(format!("tile {number}: {error}")))?;
    }
    Ok(added)
}

/// The runs of a tile that the film lacks.
fn new_samples(tile: Tile, number: u64, film: &Film, added: &mut Added) -> Result<Tile, String> {
    let pixels = tile.pixels();
    let held = film.tile_of(number);
    let mut fresh = Tile::new(pixels);
    for run in tile.into_runs() {
        let SampleRun { samples, .. } = &run;
        let count = pixels.area() * samples.len() as u64;
        let missing = held.as_ref().map_or(Some(samples.clone()), |held| held.missing(samples.clone()));
        match missing {
            None => added.duplicates += count,
            Some(missing) if missing == *samples => {
                added.samples += count;
                fresh.add(run).map_err(|error| format!("tile {number}: {error}"))?;
            }
            Some(_) => {
                let (start, end) = (samples.start, samples.end);
                return Err(format!("some of its samples {start} to {end} of tile {number} are there already"));
            }
        }
    }
    Ok(fresh)
}

/// Prepares a film that a checkpoint filled for workers, which begin each block of samples and, under a
/// noise limit, each tile anew: removes incomplete blocks of tiles that need more samples, and tiles
/// for which `is_finished` is false under a noise limit. `is_finished` takes the index of a tile.
pub fn remove_incomplete(film: &Film, stop: Stop, is_finished: impl Fn(usize) -> bool) {
    for index in 0..film.len() {
        let needs_more = stop != Stop::Samples && !is_finished(index);
        let requested = film.requested(index).to_vec();
        let Some(mut tile) = film.tile(index) else { continue };
        if needs_more {
            *tile = Tile::new(tile.pixels());
        }
        for missing in requested.into_iter().flat_map(|requested| tile.all_missing(requested)).collect::<Vec<_>>() {
            drop(tile.take_open_block(missing.start));
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::partial_render::{Chunk, PartialRenderWriter, ShardDescription};
    use crate::shard::{Units, Work, WorkUnit};
    use crate::testing::{description, tile, tiles};
    use juggler_camera::film::{Rect, Tiling};
    use std::ops::Range;

    const REGION: Rect = Rect { x: 0, y: 0, width: 40, height: 20 };
    const SAMPLES: u32 = 100;

    fn goal() -> RenderDescription {
        description(REGION, SAMPLES)
    }

    fn film() -> Film {
        Film::new(Tiling::new(REGION), 0..SAMPLES)
    }

    fn of_tiles(description: &RenderDescription, tiles: &[(u64, Tile)]) -> PartialRender {
        let mut writer = PartialRenderWriter::in_memory("part", description).unwrap();
        for (number, tile) in tiles {
            writer.add(*number, &Chunk::encode(tile, description.clamped)).unwrap();
        }
        PartialRender::from_bytes("part", writer.into_bytes().unwrap()).unwrap()
    }

    /// Partial render of these units.
    fn part(units: &[WorkUnit]) -> PartialRender {
        let tiling = Tiling::new(REGION);
        let film = Film::from_tiles(tiling, units.iter().map(|unit| (unit.tile, unit.samples.clone())));
        for WorkUnit { tile: number, samples } in units {
            film.add(*number, tile(tiling.tile(*number).unwrap(), samples.clone())).unwrap();
        }
        let shard = ShardDescription::of_units(SAMPLES, Units::new(units));
        of_tiles(&RenderDescription { shard, ..goal() }, &film.tiles().collect::<Vec<_>>())
    }

    fn unit(tile: u64, samples: Range<u32>) -> WorkUnit {
        WorkUnit { tile, samples }
    }

    #[test]
    fn partial_renders_in_any_order_and_twice_give_the_film() {
        let expected = tiles(REGION, 0..SAMPLES);
        for (seed, count) in [(1, 1), (7, 3), (5, 40)] {
            let film = film();
            let work = Work::from_description(&goal());
            let mut units = work.missing(&film, count);
            units.sort_by_key(|unit| juggler_math::hash::combine(unit.tile as u32 ^ seed, unit.samples.start));
            for some in units.chunks(2) {
                let count = |units: &[WorkUnit]| {
                    units
                        .iter()
                        .map(|unit| Tiling::new(REGION).tile(unit.tile).unwrap().area() * unit.samples.len() as u64)
                        .sum::<u64>()
                };
                let part = part(some);
                assert_eq!(add(&part, &goal(), &film).unwrap(), Added { samples: count(some), duplicates: 0 });
                assert_eq!(add(&part, &goal(), &film).unwrap(), Added { samples: 0, duplicates: count(some) });
            }
            assert_eq!(film.tiles().collect::<Vec<_>>(), expected);
            assert_eq!(work.missing(&film, count), []);
        }
    }

    #[test]
    fn a_film_names_the_units_that_it_lacks() {
        let (film, work) = (film(), Work::from_description(&goal()));
        add(&part(&[unit(0, 0..100), unit(1, 16..32), unit(4, 32..100)]), &goal(), &film).unwrap();
        let missing = work.missing(&film, 0);
        let whole = |tile: u64| unit(tile, 0..100);
        let expected = [unit(1, 0..16), unit(1, 32..100), whole(2), whole(3), unit(4, 0..32), whole(5)];
        assert_eq!(missing, expected);
        let round = Work { samples: 0..16, ..work };
        assert_eq!(round.missing(&film, 0).len(), 5);
    }

    #[test]
    fn foreign_damaged_and_overlapping_partial_renders_add_nothing() {
        let film = film();
        add(&part(&[unit(1, 0..16)]), &goal(), &film).unwrap();
        let before: Vec<_> = film.tiles().collect();
        let refused = |part: &PartialRender| add(part, &goal(), &film).unwrap_err().to_string();
        let overlapping = refused(&part(&[unit(0, 0..64), unit(1, 0..64)]));
        assert_eq!(overlapping, "cannot add `part`: some of its samples 0 to 64 of tile 1 are there already");
        let mut other = goal();
        other.fingerprint.insert("seed".into(), "8".into());
        let other = refused(&of_tiles(&other, &[]));
        assert!(other.contains("another picture: seed: 8 instead of 7"), "{other}");
        let bytes = part(&[unit(2, 0..16), unit(3, 0..16)]).to_bytes().unwrap();
        for at in (0..bytes.len()).step_by(bytes.len() / 61) {
            let mut bad = bytes.to_vec();
            bad[at] ^= 4;
            let added = PartialRender::from_bytes("part", bad).map_err(AddError::from);
            assert!(added.and_then(|part| add(&part, &goal(), &film)).is_err(), "byte {at}");
        }
        assert_eq!(film.tiles().collect::<Vec<_>>(), before);
    }

    #[test]
    fn tiles_under_a_noise_limit_come_finished() {
        let stop = Stop::Noise { level: 0.1 };
        let (film, goal) = (film(), RenderDescription { stop, ..goal() });
        let some = [(1, tile(Tiling::new(REGION).tile(1).unwrap(), 0..64))];
        let open = of_tiles(&RenderDescription { finished: false, ..goal.clone() }, &some);
        assert!(add(&open, &goal, &film).unwrap_err().to_string().contains("not finished"));
        add(&of_tiles(&goal, &some), &goal, &film).unwrap();
        let missing: Vec<u64> = Work::from_description(&goal).missing(&film, 9).iter().map(|unit| unit.tile).collect();
        assert_eq!(missing, [0, 2, 3, 4, 5]);
    }

    #[test]
    fn incomplete_blocks_and_tiles_of_checkpoints_begin_anew() {
        let tiling = Tiling::new(REGION);
        let filled = |samples: Range<u32>| {
            let film = film();
            film.add(0, tile(tiling.tile(0).unwrap(), samples)).unwrap();
            film
        };
        let held = |film: &Film| film.tile(0).unwrap().gapless_samples();
        for (samples, kept) in [(20, 16), (16, 16), (7, 0), (100, 100), (98, 96)] {
            let film = filled(0..samples);
            remove_incomplete(&film, Stop::Samples, |_| false);
            assert_eq!(held(&film), kept, "{samples}");
            for is_finished in [true, false] {
                let film = filled(0..samples);
                remove_incomplete(&film, Stop::Noise { level: 0.1 }, |_| is_finished);
                assert!(is_finished || held(&film) == 0);
            }
        }
    }
}
