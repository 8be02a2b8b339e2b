//! Round trips: files restore their contents bit by bit.

use super::super::pack::{pack, unpack};
use crate::testing::{clamped_tiles, description, place, tile, tiles};
use crate::*;
use juggler_camera::film::{Rect, SampleRun, Sum, Tile, Tiling};
use juggler_imaging::Viewpoint;
use proptest::prelude::*;

const REGION: Rect = Rect { x: 5, y: 3, width: 40, height: 20 };

/// Bit patterns, which distinguish signed zeros and NaNs.
fn bits(sums: &[Sum]) -> Vec<([u64; 3], [u32; 3], u32)> {
    let bits =
        |sum: &Sum| (sum.total.map(f64::to_bits), sum.squared_deviations.map(f32::to_bits), sum.clamped.to_bits());
    sums.iter().map(bits).collect()
}

#[test]
fn a_partial_render_is_read_back() {
    let (_folder, path) = place("a.jfilm");
    let description = description(REGION, 100);
    let tiles = tiles(REGION, 0..100);
    let bytes = write(&path, &description, tiles.clone()).unwrap();
    assert_eq!(bytes, std::fs::metadata(&path).unwrap().len());
    let partial_render = PartialRender::open(&path).unwrap();
    assert_eq!((partial_render.bytes(), partial_render.name()), (bytes, path.to_str().unwrap()));
    assert_eq!(partial_render.description(), &description);
    assert_eq!(partial_render.tiles().collect::<Vec<_>>(), (0..6).collect::<Vec<_>>());
    assert_eq!(partial_render.tiles_in(2, 5).collect::<Vec<_>>(), [2, 3, 4]);
    assert_eq!(partial_render.tiles_in(5, 3).len(), 0);
    partial_render.verify().unwrap();
    for (number, tile) in tiles {
        assert_eq!(partial_render.tile(number).unwrap(), tile);
    }
    assert!(matches!(partial_render.tile(6), Err(PartialRenderError::Damaged { .. })), "no such tile");
}

/// In memory, a partial render has the bytes of the file, and is read alike.
#[test]
fn a_partial_render_in_memory_is_that_of_the_file() {
    let (_folder, path) = place("a.jfilm");
    let description = description(REGION, 100);
    write(&path, &description, tiles(REGION, 0..100)).unwrap();
    let mut writer = PartialRenderWriter::in_memory("a", &description).unwrap();
    for (number, tile) in tiles(REGION, 0..100) {
        writer.add(number, &Chunk::encode(&tile, description.clamped)).unwrap();
    }
    let bytes = writer.into_bytes().unwrap();
    assert_eq!(bytes, std::fs::read(&path).unwrap());
    let (file, memory) = (PartialRender::open(&path).unwrap(), PartialRender::from_bytes("a", bytes.clone()).unwrap());
    assert_eq!((memory.name(), memory.bytes()), ("a", file.bytes()));
    assert_eq!((memory.description(), &*memory.to_bytes().unwrap()), (file.description(), bytes.as_slice()));
    assert_eq!(*file.to_bytes().unwrap(), bytes);
    for number in 0..6 {
        assert_eq!(memory.tile(number).unwrap(), file.tile(number).unwrap());
    }
}

#[test]
fn damage_in_memory_is_reported_as_in_files() {
    let (_folder, path) = place("a.jfilm");
    let description = description(REGION, 100);
    write(&path, &description, tiles(REGION, 0..20)).unwrap();
    let good = std::fs::read(&path).unwrap();
    let reported = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let read = |opened: Result<PartialRender, PartialRenderError>| opened.and_then(|read| read.verify()).err();
        let [file, memory] = [PartialRender::open(&path), PartialRender::from_bytes("a.jfilm", bytes)].map(read);
        let file = file.map(|error| error.to_string().replace(path.to_str().unwrap(), "a.jfilm"));
        assert_eq!(file, memory.map(|error| error.to_string()));
        file
    };
    assert_eq!(reported(&good), None);
    for cut in [0, 3, 20, 200, good.len() / 2, good.len() - 1] {
        assert!(reported(&good[..cut]).is_some(), "{cut} bytes");
    }
    for at in (0..good.len()).step_by(good.len() / 97) {
        let mut bad = good.clone();
        bad[at] ^= 4;
        assert!(reported(&bad).is_some(), "byte {at}");
    }
    assert!(reported(&[good.as_slice(), b"x"].concat()).is_some());
}

/// A file that another one replaces between opening and reading is not mistaken for it.
#[test]
fn the_bytes_of_a_replaced_file_are_refused() {
    let (_folder, path) = place("a.jfilm");
    write(&path, &description(REGION, 100), tiles(REGION, 0..20)).unwrap();
    let opened = PartialRender::open(&path).unwrap();
    write(&path, &description(REGION, 101), tiles(REGION, 0..20)).unwrap();
    assert!(matches!(opened.to_bytes(), Err(PartialRenderError::Damaged { .. })));
    std::fs::write(&path, b"short").unwrap();
    assert!(matches!(opened.to_bytes(), Err(PartialRenderError::Damaged { .. })));
}

#[test]
fn tiles_may_be_in_any_order_or_missing() {
    let (_folder, path) = place("a.jfilm");
    let tiling = Tiling::new(REGION);
    let some = [5, 1, 4].map(|number| (number, tile(tiling.tile(number).unwrap(), 0..16)));
    write(&path, &description(REGION, 100), some.clone()).unwrap();
    let partial_render = PartialRender::open(&path).unwrap();
    assert_eq!(partial_render.tiles().collect::<Vec<_>>(), [1, 4, 5]);
    for (number, tile) in some {
        assert_eq!(partial_render.tile(number).unwrap(), tile);
    }
    assert_eq!(partial_render.tile(3).unwrap(), Tile::new(tiling.tile(3).unwrap()));
}

#[test]
fn header_is_readable_json_text() {
    let (_folder, path) = place("a.jfilm");
    write(&path, &description(REGION, 100), []).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    let header = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let text = std::str::from_utf8(&bytes[32..32 + header]).unwrap();
    assert!(text.starts_with("{\n") && text.ends_with("}\n"), "{text}");
    assert!(text.contains("\"command\": \"juggler render ball --size 64x48\""), "{text}");
    assert!(is_partial_render(&bytes) && !is_partial_render(b"\x89PNG\r\n\x1a\n"));
}

#[test]
fn tiles_of_other_pixels_and_tiles_given_twice_are_refused() {
    let (folder, path) = place("a.jfilm");
    let tiling = Tiling::new(REGION);
    let one = tile(tiling.tile(1).unwrap(), 0..16);
    let refused = |tiles: &[(u64, Tile)]| write(&path, &description(REGION, 100), tiles.to_vec()).unwrap_err();
    assert!(refused(&[(2, one.clone())]).to_string().contains("tile 2 has other pixels"));
    assert!(refused(&[(8, one.clone())]).to_string().contains("tile 8 has other pixels"));
    assert!(refused(&[(1, one.clone()), (1, one)]).to_string().contains("tile 1 occurs twice"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is left behind");
}

#[test]
fn invalid_render_descriptions_are_rejected() {
    let (_folder, path) = place("a.jfilm");
    let good = description(REGION, 100);
    let wrong = [
        RenderDescription { size: [44, 100], ..good.clone() },
        RenderDescription { region: Rect { x: u32::MAX, ..REGION }, ..good.clone() },
        RenderDescription { frame: f64::NAN, ..good.clone() },
        RenderDescription { stop: Stop::Noise { level: f64::INFINITY }, ..good.clone() },
        RenderDescription { shard: ShardDescription { index: 1, ..ShardDescription::whole(100) }, ..good.clone() },
        RenderDescription { shard: ShardDescription::whole(101), ..good.clone() },
        RenderDescription { command: "x".repeat(1 << 24), ..good.clone() },
    ];
    for description in wrong {
        assert!(matches!(write(&path, &description, []), Err(PartialRenderError::Invalid { .. })), "{description:?}");
    }
    assert!(!path.exists());
}

#[test]
fn mismatches_are_named() {
    let mut one = description(REGION, 100);
    one.fingerprint.insert("materials".into(), "0a".repeat(16));
    assert_eq!(one.mismatches(&RenderDescription { command: String::new(), finished: false, ..one.clone() }), []);
    let mut other = RenderDescription { stop: Stop::Noise { level: 0.01 }, size: [50, 60], ..one.clone() };
    other.fingerprint.remove("seed");
    other.fingerprint.insert("scene".into(), "0".into());
    other.fingerprint.insert("zeal".into(), "1".into());
    other.fingerprint.insert("materials".into(), "0b".repeat(16));
    let words: Vec<String> = one.mismatches(&other).iter().map(ToString::to_string).collect();
    let expected = [
        "size: 50x60 instead of 45x23",
        "stop: noise 0.01 instead of samples",
        "materials: not the same",
        "scene: 0 instead of 5ce4e",
        "seed: nothing instead of 7",
        "zeal: 1 instead of nothing",
    ];
    assert_eq!(words, expected);
}

fn sum() -> impl Strategy<Value = Sum> {
    // All bit patterns, including signed zeros, subnormals, infinities and NaNs.
    let total = prop_oneof![any::<u64>().prop_map(f64::from_bits), (-1e6..1e6f64), Just(0.0)];
    let squared_deviations = prop_oneof![any::<u32>().prop_map(f32::from_bits), (0.0..1e3f32), Just(0.0)];
    let clamped = prop_oneof![any::<u32>().prop_map(f32::from_bits), Just(0.0)];
    let parts = (prop::array::uniform3(total), prop::array::uniform3(squared_deviations), clamped);
    parts.prop_map(|(total, squared_deviations, clamped)| Sum { total, squared_deviations, clamped })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn arbitrary_sums_round_trip_bit_for_bit(sums in prop::collection::vec(sum(), 0..300)) {
        let packed = pack(&sums, true);
        prop_assert_eq!(bits(&unpack(&packed, sums.len(), true).unwrap()), bits(&sums));
        prop_assert!(unpack(&packed, sums.len() + 64, true).is_none());
        prop_assert!(sums.is_empty() || unpack(&packed, sums.len(), false).is_none());
        let unclamped: Vec<Sum> = sums.iter().map(|sum| Sum { clamped: 0.0, ..*sum }).collect();
        let packed = pack(&sums, false);
        prop_assert_eq!(bits(&unpack(&packed, sums.len(), false).unwrap()), bits(&unclamped));
        prop_assert!(sums.is_empty() || unpack(&packed, sums.len(), true).is_none());
    }

    #[test]
    fn any_partial_render_is_read_back(
        (x, y, width, height) in (0..40u32, 0..40u32, 1..50u32, 1..50u32),
        kept in any::<u64>(),
        (start, blocks, open) in (0..9u32, 0..9u32, 0..16u32),
    ) {
        let region = Rect { x, y, width, height };
        let (_folder, path) = place("a.jfilm");
        let samples = start * 16..(start + blocks) * 16 + open;
        let tiles: Vec<_> = tiles(region, samples).into_iter().filter(|(number, _)| kept >> number & 1 == 1).collect();
        write(&path, &description(region, 1000), tiles.clone()).unwrap();
        let partial_render = PartialRender::open(&path).unwrap();
        prop_assert_eq!(partial_render.tiles().collect::<Vec<_>>(), tiles.iter().map(|(number, _)| *number).collect::<Vec<_>>());
        for (number, tile) in tiles {
            prop_assert_eq!(partial_render.tile(number).unwrap(), tile);
        }
    }
}

#[test]
fn clamped_radiance_round_trips() {
    let (_folder, path) = place("a.jfilm");
    let clamped = RenderDescription { clamped: true, ..description(REGION, 100) };
    let made = clamped_tiles(REGION, 0..100);
    assert!(made.iter().all(|(_, tile)| tile.clamped().total() > 0.0));
    write(&path, &clamped, made.clone()).unwrap();
    let partial_render = PartialRender::open(&path).unwrap();
    assert!(partial_render.description().clamped);
    for (number, tile) in made {
        assert_eq!(partial_render.tile(number).unwrap(), tile);
        let mut writer = PartialRenderWriter::create(&path, &clamped).unwrap();
        let refused = writer.add(number, &Chunk::encode(&tile, false)).unwrap_err().to_string();
        assert!(refused.contains("clamped"), "{refused}");
    }
    // Files of unclamped images contain no trace of clamping.
    let header = |description: &RenderDescription| {
        write(&path, description, tiles(REGION, 0..16)).unwrap();
        String::from_utf8_lossy(&std::fs::read(&path).unwrap()).contains("clamped")
    };
    assert!(!header(&description(REGION, 100)) && header(&clamped));
}

#[test]
fn smooth_pixels_compress_to_a_quarter() {
    let sums: Vec<Sum> =
        (0..256).map(|i| Sum { total: [1.0 + f64::from(i as f32 / 1000.0); 3], ..Sum::default() }).collect();
    let size = pack(&sums, false).len();
    assert!(size < sums.len() * 36 / 4, "{size}");
}

#[test]
fn a_tile_in_too_many_runs_is_refused() {
    let (_folder, path) = place("a.jfilm");
    let region = Rect { x: 0, y: 0, width: 1, height: 1 };
    let mut tile = Tile::new(region);
    for number in 0..4097 {
        tile.add(SampleRun::new(number * 32..number * 32 + 16, vec![Sum::default()])).unwrap();
    }
    let error = write(&path, &description(region, 1 << 20), [(0, tile)]).unwrap_err();
    assert!(error.to_string().contains("4097 runs"), "{error}");
}

#[test]
fn camera_matrices_round_trip_bit_for_bit() {
    let (_folder, path) = place("a.jfilm");
    let number = |i: usize| ((i * 37 % 11) as f32 - 4.3) / 3.0 * 10f32.powi(i as i32 % 9 - 6);
    let matrix =
        |first: usize| std::array::from_fn(|row| std::array::from_fn(|column| number(first + row * 4 + column)));
    let viewpoint = Some(Viewpoint { world_to_camera: matrix(1), world_to_ndc: matrix(50) });
    let whole = RenderDescription { viewpoint, ..description(REGION, 100) };
    write(&path, &whole, []).unwrap();
    assert_eq!(*PartialRender::open(&path).unwrap().description(), whole);
}
