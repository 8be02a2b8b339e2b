//! Any partition of an image, in any order, merges to the whole image; error messages are exact.

use super::*;
use crate::partial_render::{ShardDescription, Stop, write};
use crate::shard::{Work, whole_tiles};
use crate::testing::{clamped_tiles, description, tile, tiles};
use juggler_camera::film::Rect;
use juggler_math::testing::Random;
use std::path::PathBuf;

const REGION: Rect = Rect { x: 5, y: 3, width: 70, height: 40 };
const SAMPLES: u32 = 100;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a partial render that holds the given sample ranges of the given tiles.
    fn partial_render(&self, name: &str, description: &RenderDescription, units: &[(u64, Range<u32>)]) -> PathBuf {
        let tiling = description.tiling();
        let tiles =
            units.iter().map(|(number, samples)| (*number, tile(tiling.tile(*number).unwrap(), samples.clone())));
        let path = self.path(name);
        let mut joined: std::collections::BTreeMap<u64, Tile> = Default::default();
        for (number, tile) in tiles {
            joined.entry(number).or_insert_with(|| Tile::new(tile.pixels())).merge(tile).unwrap();
        }
        write(&path, description, joined).unwrap();
        path
    }

    /// Writes shard `index` of `count`.
    fn shard(&self, index: u32, count: u32) -> PathBuf {
        let shard = ShardDescription { index, count, ..ShardDescription::whole(SAMPLES) };
        let description = RenderDescription { shard, ..description(REGION, SAMPLES) };
        let units = Work::from_description(&description).shard(index, count);
        let units: Vec<_> = units.into_iter().map(|unit| (unit.tile, unit.samples)).collect();
        self.partial_render(&format!("{index}.jfilm"), &description, &units)
    }

    fn problems(&self, files: &[PathBuf]) -> String {
        let error = Merge::open(files, MergeGoal::Whole).unwrap_err();
        error.to_string().replace(&format!("{}/", self.0.path().display()), "")
    }
}

#[test]
fn partial_renders_in_memory_merge_as_files() {
    let folder = Folder::new();
    let files = [2, 0, 1].map(|index| folder.shard(index, 3));
    let in_memory = |files: &[PathBuf]| {
        let read = |file: &PathBuf| PartialRender::from_bytes(file.to_str().unwrap(), std::fs::read(file).unwrap());
        files.iter().map(|file| read(file).unwrap()).collect::<Vec<_>>()
    };
    let proceed = || Ok::<(), PartialRenderError>(());
    let from_files = Merge::open(&files, MergeGoal::PartialRender).unwrap();
    from_files.write(&folder.path("whole.jfilm"), proceed).unwrap();
    let from_memory = Merge::new(in_memory(&files), MergeGoal::PartialRender).unwrap();
    let bytes = from_memory.to_bytes("whole", proceed).unwrap();
    assert_eq!(bytes, std::fs::read(folder.path("whole.jfilm")).unwrap());
    let rows = |merge: &Merge| merge.rows(|_| Ok::<(), PartialRenderError>(())).unwrap();
    let whole = Merge::new(vec![PartialRender::from_bytes("whole", bytes).unwrap()], MergeGoal::Whole).unwrap();
    assert_eq!(rows(&whole), rows(&from_files));
    // What is wrong is reported in the same words.
    for wrong in [&files[..2], &[files[0].clone(), files[0].clone()], &[]] {
        let reported = Merge::new(in_memory(wrong), MergeGoal::Whole).unwrap_err().to_string();
        assert_eq!(reported, Merge::open(wrong, MergeGoal::Whole).unwrap_err().to_string());
    }
    let cancelled =
        from_memory.to_bytes("whole", || Err(PartialRenderError::NotAPartialRender { file: "stop".into() }));
    assert!(cancelled.is_err());
}

/// An image of the largest size with no tiles is reported at once and in little memory.
#[test]
fn a_large_image_without_tiles_is_reported_at_once() {
    let folder = Folder::new();
    let region = Rect { x: 0, y: 0, width: 65_536, height: 32_768 };
    let shards = [
        ShardDescription::whole(SAMPLES),
        ShardDescription { index: 7, count: u32::MAX, ..ShardDescription::whole(SAMPLES) },
    ];
    for shard in shards {
        let file =
            folder.partial_render("large.jfilm", &RenderDescription { shard, ..description(region, SAMPLES) }, &[]);
        let start = std::time::Instant::now();
        let problems = folder.problems(&[file]);
        assert!(start.elapsed().as_secs() < 5, "{:?}", start.elapsed());
        let expected = "still to do: samples 0..100 of 8388608 tiles (the first at 0,0)";
        assert!(problems.contains(expected), "{problems}");
    }
}

#[test]
fn differences_are_reported_in_a_few_printable_words() {
    let folder = Folder::new();
    let mut other = description(REGION, SAMPLES);
    other.fingerprint.insert("seed".into(), format!("\u{1b}[31m{}", "x".repeat(1_000_000)));
    let files = [folder.shard(0, 1), folder.partial_render("b.jfilm", &other, &[])];
    let problems = folder.problems(&files);
    assert!(problems.len() < 1000 && problems.contains("x…x") && !problems.contains('\u{1b}'), "{problems}");
}

/// Pixels and digest of the complete image.
fn whole() -> (Vec<Rgb>, FilmSummary) {
    let Rect { x, y, width, height } = REGION;
    let mut pixels = vec![Rgb::BLACK; REGION.area() as usize];
    for (_, tile) in tiles(REGION, 0..SAMPLES) {
        let place = tile.pixels();
        for (pixel, mean) in (0..).zip(tile.means()) {
            let (column, row) = (place.x - x + pixel % place.width, place.y - y + pixel / place.width);
            pixels[(row * width + column) as usize] = mean;
        }
    }
    let mut digest = FilmDigest::new(width, height);
    digest.update(&pixels);
    (pixels, digest.finish())
}

fn merged(files: &[PathBuf]) -> (Vec<Rgb>, FilmSummary) {
    let merge = Merge::open(files, MergeGoal::Whole).unwrap();
    assert!(merge.description().finished && merge.description().shard == ShardDescription::whole(SAMPLES));
    let mut pixels = Vec::new();
    let summary = merge.rows(|rows| {
        assert_eq!(rows.len() % REGION.width as usize, 0);
        pixels.extend_from_slice(rows);
        Ok::<(), PartialRenderError>(())
    });
    (pixels, summary.unwrap())
}

fn shuffle<T>(items: &mut [T], random: &mut Random) {
    (1..items.len()).for_each(|i| items.swap(i, random.below(i + 1)));
}

#[test]
fn shards_merge_in_any_order_to_the_whole_film() {
    let mut random = Random::new(3);
    let expected = whole();
    for count in 1..=7 {
        let folder = Folder::new();
        let mut files: Vec<PathBuf> = (0..count).map(|index| folder.shard(index, count)).collect();
        shuffle(&mut files, &mut random);
        assert_eq!(merged(&files), expected, "{count} shares");
    }
}

#[test]
fn clamped_energy_is_summed_over_all_partial_renders() {
    let lost: juggler_camera::film::ClampedRadiance =
        clamped_tiles(REGION, 0..SAMPLES).iter().map(|(_, tile)| tile.clamped()).sum();
    let expected = lost.total() / REGION.area() as f64;
    assert!(expected > 0.0);
    for cut in [16, 48] {
        let folder = Folder::new();
        let partial_render = |name: &str, samples: Range<u32>| {
            let shard = ShardDescription { samples: samples.clone(), ..ShardDescription::whole(SAMPLES) };
            let path = folder.path(name);
            let description = RenderDescription { shard, clamped: true, ..description(REGION, SAMPLES) };
            write(&path, &description, clamped_tiles(REGION, samples)).unwrap();
            path
        };
        let mut files = vec![partial_render("b.jfilm", cut..SAMPLES), partial_render("a.jfilm", 0..cut)];
        assert_eq!(merged(&files).1.clamped, expected);
        let joined = folder.path("joined.jfilm");
        Merge::open(&files, MergeGoal::PartialRender)
            .unwrap()
            .write(&joined, || Ok::<(), PartialRenderError>(()))
            .unwrap();
        assert_eq!(merged(&[joined]).1.clamped, expected);
        files.push(folder.shard(0, 1));
        assert!(folder.problems(&files).contains("clamped"), "{}", folder.problems(&files));
    }
}

#[test]
fn any_partition_and_merge_order_gives_the_whole_film() {
    let mut random = Random::new(4);
    let expected = whole();
    let tiling = Tiling::new(REGION);
    for round in 0..6 {
        let folder = Folder::new();
        let mut parts: Vec<Vec<(u64, Range<u32>)>> = vec![Vec::new(); 2 + round];
        for tile in 0..tiling.tile_count() {
            let mut cuts: Vec<u32> =
                (0..random.below(4)).map(|_| 16 * random.below(7) as u32).chain([0, SAMPLES]).collect();
            cuts.sort_unstable();
            for cut in cuts.windows(2).filter(|cut| cut[0] < cut[1]) {
                let chosen = random.below(parts.len());
                parts[chosen].push((tile, cut[0]..cut[1]));
            }
        }
        let description = description(REGION, SAMPLES);
        let partial_render =
            |(i, units): (usize, &Vec<_>)| folder.partial_render(&format!("{i}.jfilm"), &description, units);
        let mut files: Vec<PathBuf> = parts.iter().enumerate().map(partial_render).collect();
        shuffle(&mut files, &mut random);
        assert_eq!(merged(&files), expected);
        // Merge one half into one file, then merge that file with the others.
        let half = files.split_off(files.len() / 2);
        let joined = folder.path("joined.jfilm");
        let first = Merge::open(&half, MergeGoal::PartialRender).unwrap();
        assert!(!first.description().finished);
        first.write(&joined, || Ok::<(), PartialRenderError>(())).unwrap();
        files.push(joined);
        assert_eq!(merged(&files), expected);
        let one = folder.path("one.jfilm");
        Merge::open(&files, MergeGoal::Whole).unwrap().write(&one, || Ok::<(), PartialRenderError>(())).unwrap();
        assert_eq!(merged(std::slice::from_ref(&one)), expected);
        let all = folder.path("all.jfilm");
        write(&all, &description, tiles(REGION, 0..SAMPLES)).unwrap();
        assert_eq!(std::fs::read(one).unwrap(), std::fs::read(all).unwrap(), "the very file of a single render");
    }
}

#[test]
fn the_order_of_files_does_not_change_the_merged_partial_render() {
    let folder = Folder::new();
    let mut files: Vec<PathBuf> = (0..3).map(|index| folder.shard(index, 3)).collect();
    let (a, b) = (folder.path("a.jfilm"), folder.path("b.jfilm"));
    Merge::open(&files, MergeGoal::Whole).unwrap().write(&a, || Ok::<(), PartialRenderError>(())).unwrap();
    files.reverse();
    Merge::open(&files, MergeGoal::Whole).unwrap().write(&b, || Ok::<(), PartialRenderError>(())).unwrap();
    assert_eq!(std::fs::read(a).unwrap(), std::fs::read(b).unwrap());
}

#[test]
fn all_problems_are_reported_at_once() {
    let folder = Folder::new();
    let mut files: Vec<PathBuf> = (0..20).map(|index| folder.shard(index, 20)).collect();
    // Shards 3, 7, 8 and 9 are missing; 11 is damaged, 12 truncated, 13 of another scene, 14
    // present twice.
    let bytes = std::fs::read(&files[11]).unwrap();
    let middle = bytes.len() - 200;
    std::fs::write(&files[11], [&bytes[..middle], &[bytes[middle] ^ 1], &bytes[middle + 1..]].concat()).unwrap();
    let bytes = std::fs::read(&files[12]).unwrap();
    std::fs::write(&files[12], &bytes[..700]).unwrap();
    let mut other = PartialRender::open(&files[13]).unwrap().description().clone();
    other.fingerprint.insert("scene".into(), "other".into());
    other.frame = 3.0;
    files[13] = folder.partial_render("13.jfilm", &other, &[]);
    std::fs::copy(&files[14], folder.path("14b.jfilm")).unwrap();
    files.insert(15, folder.path("14b.jfilm"));
    files.drain(7..10);
    files.remove(3);
    let tiles = Work::from_description(&description(REGION, SAMPLES)).shard(14, 20).len();
    let expected = format!(
        "the partial renders `0.jfilm` and 16 more cannot be merged:
  cannot read `12.jfilm`: unexpected end of file at byte 700 of {}
  `13.jfilm` is of another picture than `0.jfilm`: frame: 3 instead of 2.4000000000000004; scene: other instead of 5ce4e
  `11.jfilm` is damaged: the checksum of its header and index is wrong
  `14b.jfilm` repeats samples of `14.jfilm` in {tiles} tiles
  still to do: shards 3,7-9,11-13 of 20 (--shard 3/20)",
        bytes.len()
    );
    let mut found: Vec<String> = folder.problems(&files).lines().map(String::from).collect();
    let mut expected: Vec<String> = expected.lines().map(String::from).collect();
    found.sort();
    expected.sort();
    assert_eq!(found, expected);
    let error = Merge::open(&files, MergeGoal::Whole).unwrap_err();
    assert!(error.has_file_errors());
    assert_eq!(
        error.remaining_work(),
        Some(&RemainingWork::Shards { shards: vec![3, 7, 8, 9, 11, 12, 13], count: 20 })
    );
}

#[test]
fn missing_samples_of_partial_renders_without_shards_are_named() {
    let folder = Folder::new();
    let description = description(REGION, SAMPLES);
    let units: Vec<_> = (0..14).map(|tile| (tile, 0..48)).collect();
    let files = [
        folder.partial_render("a.jfilm", &description, &units),
        folder.partial_render("b.jfilm", &description, &[(1, 48..64)]),
    ];
    let expected = "the partial renders `a.jfilm` and 1 more cannot be merged:
  still to do: samples 0..100 of 1 tile (the first at 64,32), samples 48..100 of 13 tiles (the first at 5,3), \
        samples 64..100 of 1 tile (the first at 16,3)";
    assert_eq!(folder.problems(&files), expected);
    assert!(!Merge::open(&files, MergeGoal::Whole).unwrap_err().has_file_errors());
    let partial_render = Merge::open(&files, MergeGoal::PartialRender).unwrap();
    assert!(!partial_render.description().finished);
}

#[test]
fn merging_a_file_twice_is_rejected_as_repeated_samples() {
    let folder = Folder::new();
    let file = folder.shard(0, 1);
    let tiles = Tiling::new(REGION).tile_count();
    let expected = format!(
        "the partial renders `0.jfilm` and 1 more cannot be merged:\n  `0.jfilm` repeats samples of `0.jfilm` in {tiles} tiles"
    );
    assert_eq!(folder.problems(&[file.clone(), file.clone()]), expected);
    assert!(Merge::open(&[file.clone(), file], MergeGoal::PartialRender).is_err());
}

#[test]
fn damaged_chunks_are_found_before_anything_is_merged() {
    let folder = Folder::new();
    let files: Vec<PathBuf> = (0..3).map(|index| folder.shard(index, 3)).collect();
    let mut bytes = std::fs::read(&files[1]).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 16;
    std::fs::write(&files[1], bytes).unwrap();
    let problems = folder.problems(&files);
    assert!(problems.contains("`1.jfilm` is damaged: the checksum of tile"), "{problems}");
    assert!(problems.contains("still to do: shard 1 of 3 (--shard 1/3)"), "{problems}");
}

#[test]
fn partial_renders_with_a_noise_target_have_as_many_samples_as_they_needed() {
    let folder = Folder::new();
    let noise = RenderDescription { stop: Stop::Noise { level: 0.1 }, ..description(REGION, SAMPLES) };
    let half = |index| RenderDescription {
        shard: ShardDescription { index, count: 2, ..ShardDescription::whole(SAMPLES) },
        ..noise.clone()
    };
    let units = |index| {
        Work::from_description(&noise)
            .shard(index, 2)
            .into_iter()
            .map(|unit| (unit.tile, 0..16 + 16 * (unit.tile as u32 % 3)))
    };
    let units = |index| units(index).collect::<Vec<_>>();
    let files =
        [folder.partial_render("0.jfilm", &half(0), &units(0)), folder.partial_render("1.jfilm", &half(1), &units(1))];
    assert!(Merge::open(&files, MergeGoal::Whole).unwrap().description().finished);
    let unfinished = RenderDescription { finished: false, ..half(1) };
    folder.partial_render("1.jfilm", &unfinished, &units(1));
    let expected = "the partial renders `0.jfilm` and 1 more cannot be merged:
  `1.jfilm` is not finished; run its command again to continue
  still to do: shard 1 of 2 (--shard 1/2)";
    assert_eq!(folder.problems(&files), expected);
}

#[test]
fn crops_are_partial_renders_too() {
    let folder = Folder::new();
    let tiling = Tiling::new(REGION);
    let half = |name: &str, crop: Rect| {
        let shard = ShardDescription { crop: Some(whole_tiles(&REGION, &crop)), ..ShardDescription::whole(SAMPLES) };
        let description = RenderDescription { shard, ..description(REGION, SAMPLES) };
        let units = Work::from_description(&description).shard(0, 1);
        assert!(!units.is_empty() && units.len() < tiling.tile_count() as usize);
        folder.partial_render(
            name,
            &description,
            &units.into_iter().map(|unit| (unit.tile, unit.samples)).collect::<Vec<_>>(),
        )
    };
    let files = [half("a.jfilm", Rect { width: 27, ..REGION }), half("b.jfilm", Rect { x: 32, width: 43, ..REGION })];
    assert_eq!(merged(&files), whole());
}

#[test]
fn merging_a_single_shard_names_the_missing_shards() {
    let folder = Folder::new();
    let message = folder.problems(&[folder.shard(1, 2)]);
    assert_eq!(message, "the partial render `1.jfilm` cannot be merged:\n  still to do: shard 0 of 2 (--shard 0/2)");
}

#[test]
fn merging_no_files_is_an_error() {
    let error = Merge::open::<PathBuf>(&[], MergeGoal::Whole).unwrap_err();
    assert_eq!(error.to_string(), "the partial renders cannot be merged:\n  no partial render was given");
}
