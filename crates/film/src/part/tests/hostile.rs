//! Files that are not what was written, by accident or malice: refused by name, without a panic, in bounded memory.

use super::super::format::{Entry, Head, Layer, layers};
use crate::testing::{description, place, tile, tiles};
use crate::*;
use juggler_camera::film::{Layout, Rect};
use juggler_math::testing::Random;
use std::path::Path;

/// Two pixels of one tile, 21 samples: two runs.
const TINY: Rect = Rect { x: 15, y: 0, width: 1, height: 2 };
/// As the program wrote it when the format was made.
const GOLDEN: &[u8] = include_bytes!("tiny.jfilm");

fn tiny() -> Vec<u8> {
    let (_folder, path) = place("a.jfilm");
    write(&path, &description(TINY, 21), tiles(TINY, 0..21)).unwrap();
    std::fs::read(&path).unwrap()
}

/// What reading everything of such a file comes to.
fn read(path: &Path, bytes: &[u8]) -> Result<(), PartError> {
    std::fs::write(path, bytes).unwrap();
    Part::open(path)?.verify()
}

#[test]
fn the_format_does_not_change_unseen() {
    let bytes = tiny();
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        let place = concat!(env!("CARGO_MANIFEST_DIR"), "/src/part/tests/tiny.jfilm");
        std::fs::write(place, &bytes).unwrap();
        return;
    }
    let (_folder, path) = place("golden.jfilm");
    std::fs::write(&path, GOLDEN).unwrap();
    let part = Part::open(&path).unwrap();
    assert_eq!(part.description(), &description(TINY, 21));
    assert_eq!(part.tile(0).unwrap(), tile(TINY, 0..21));
    // Another version of the compressor may pack differently; old files must stay readable all the same.
    assert_eq!(bytes, GOLDEN, "other bytes are written");
}

#[test]
fn no_part_that_is_cut_short_is_taken() {
    let (_folder, path) = place("short.jfilm");
    let bytes = tiny();
    for length in 0..bytes.len() {
        let error = read(&path, &bytes[..length]).unwrap_err();
        assert!(matches!(error, PartError::Truncated { .. }), "{length}: {error}");
        assert!(error.to_string().contains("short.jfilm"), "{error}");
    }
}

#[test]
fn no_changed_byte_is_overlooked() {
    let (_folder, path) = place("flipped.jfilm");
    let bytes = tiny();
    read(&path, &bytes).unwrap();
    for at in 0..bytes.len() {
        for change in [0x01, 0x80, 0xff] {
            let mut bytes = bytes.clone();
            bytes[at] ^= change;
            let error = read(&path, &bytes).expect_err(&format!("byte {at}"));
            let fits = match at {
                0..8 => matches!(error, PartError::NotAPart { .. }),
                8..12 => matches!(error, PartError::Version { .. }),
                16..24 => matches!(error, PartError::Truncated { .. } | PartError::Damaged { .. }),
                _ => matches!(error, PartError::Damaged { .. }),
            };
            assert!(fits, "byte {at}: {error}");
        }
    }
}

#[test]
fn bytes_that_follow_are_seen() {
    let (_folder, path) = place("long.jfilm");
    for more in [1, 32, 5000] {
        let mut bytes = tiny();
        bytes.resize(bytes.len() + more, 0);
        let error = read(&path, &bytes).unwrap_err().to_string();
        assert!(error.contains(&format!("{more} bytes follow its end")), "{error}");
    }
}

#[test]
fn garbage_is_refused() {
    let (_folder, path) = place("garbage.jfilm");
    let mut random = Random::new(5);
    for round in 0..300 {
        let mut bytes: Vec<u8> = (0..random.below(400)).map(|_| random.bits() as u8).collect();
        if round % 2 == 0 {
            let start = tiny()[..8 + random.below(200)].to_vec();
            bytes.splice(0..0, start);
        }
        assert!(read(&path, &bytes).is_err());
    }
    assert!(matches!(read(&path, b"{\"version\": 1}"), Err(PartError::NotAPart { .. })));
    let folder = Part::open(path.parent().unwrap()).unwrap_err();
    assert!(matches!(folder, PartError::Read { .. }), "{folder}");
    assert!(matches!(Part::open(Path::new("none.jfilm")), Err(PartError::Read { .. })));
}

#[test]
fn chunks_that_changed_places_are_seen() {
    let (_folder, path) = place("a.jfilm");
    let region = Rect { x: 0, y: 0, width: 32, height: 16 };
    let layout = Layout::new(region);
    // Chunks of the same length.
    let same = |number: u64| Chunk::encode(&tile(layout.tile(number).unwrap(), 0..16), false);
    let chunks = [same(0), same(1)];
    let mut writer = PartWriter::create(&path, &description(region, 16)).unwrap();
    writer.add(0, &chunks[0]).unwrap();
    writer.add(1, &chunks[1]).unwrap();
    writer.finish().unwrap();
    let mut bytes = std::fs::read(&path).unwrap();
    let at = 32 + u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    let length = chunks[0].bytes.len();
    bytes[at..at + length + chunks[1].bytes.len()].rotate_left(length);
    let error = read(&path, &bytes).unwrap_err().to_string();
    assert!(error.contains("tile 0"), "{error}");
}

/// A file as README.md of the crate describes it, whatever it holds, with hashes that fit.
struct Forged {
    version: u32,
    head: Vec<u8>,
    head_length: Option<u32>,
    length: Option<u64>,
    count: Option<u64>,
    chunks: Vec<(u64, Vec<u8>)>,
    chunk_length: Option<u32>,
}

impl Forged {
    fn new() -> Self {
        let head = Head { layers: layers(&description(TINY, 21)), part: description(TINY, 21) };
        let chunk = Chunk::encode(&tile(TINY, 0..21), false).bytes;
        let head = serde_json::to_vec(&head).unwrap();
        let chunks = vec![(0, chunk)];
        Self { version: 1, head, head_length: None, length: None, count: None, chunks, chunk_length: None }
    }

    fn with_chunk(chunk: Vec<u8>) -> Self {
        Self { chunks: vec![(0, chunk)], ..Self::new() }
    }

    fn bytes(&self) -> Vec<u8> {
        let mut index = Vec::new();
        for (tile, chunk) in &self.chunks {
            let length = self.chunk_length.unwrap_or(chunk.len() as u32);
            Entry { tile: *tile, length, hash: *blake3::hash(chunk).as_bytes() }.append_to(&mut index);
        }
        let chunks: Vec<u8> = self.chunks.iter().flat_map(|(_, chunk)| chunk.clone()).collect();
        let length = 32 + self.head.len() + chunks.len() + index.len() + 32;
        let mut prelude = b"\x89JFILM\r\n".to_vec();
        prelude.extend(self.version.to_le_bytes());
        prelude.extend(self.head_length.unwrap_or(self.head.len() as u32).to_le_bytes());
        prelude.extend(self.length.unwrap_or(length as u64).to_le_bytes());
        prelude.extend(self.count.unwrap_or(self.chunks.len() as u64).to_le_bytes());
        let seal = blake3::hash(&[prelude.as_slice(), &self.head, &index].concat());
        [prelude.as_slice(), &self.head, &chunks, &index, seal.as_bytes()].concat()
    }

    fn refused(&self) -> String {
        let (_folder, path) = place("forged.jfilm");
        read(&path, &self.bytes()).unwrap_err().to_string()
    }
}

#[test]
fn a_file_as_the_readme_describes_it_is_read() {
    let (_folder, path) = place("a.jfilm");
    read(&path, &Forged::new().bytes()).unwrap();
}

#[test]
fn claims_are_not_believed() {
    let counts = [2, 1 << 32, u64::MAX / 44, u64::MAX / 43, u64::MAX];
    for count in counts {
        Forged { count: Some(count), ..Forged::new() }.refused();
    }
    for head_length in [0, 1, 1 << 24, (1 << 24) + 1, u32::MAX] {
        Forged { head_length: Some(head_length), ..Forged::new() }.refused();
    }
    for length in [0, 31, 32, u64::MAX] {
        Forged { length: Some(length), ..Forged::new() }.refused();
    }
    for length in [0, 1, u32::MAX] {
        Forged { chunk_length: Some(length), ..Forged::new() }.refused();
    }
}

#[test]
fn tiles_are_those_of_the_region_and_come_once() {
    let chunk = Forged::new().chunks[0].1.clone();
    let forged = |chunks: Vec<(u64, Vec<u8>)>| Forged { chunks, ..Forged::new() }.refused();
    assert!(forged(vec![(1, chunk.clone())]).contains("tile 1 is none of its region"));
    assert!(forged(vec![(u64::MAX, chunk.clone())]).contains("none of its region"));
    assert!(forged(vec![(0, chunk.clone()), (0, chunk)]).contains("tile 0 is there twice"));
}

#[test]
fn chunks_hold_runs_of_samples() {
    let run = |start: u32, end: u32, length: u32, packed: &[u8]| {
        [&start.to_le_bytes()[..], &end.to_le_bytes(), &length.to_le_bytes(), packed].concat()
    };
    let packed = super::super::pack::pack(&[Default::default(); 2], false);
    let good = |start: u32, end: u32| run(start, end, packed.len() as u32, &packed);
    let refused = |bytes: Vec<u8>| Forged::with_chunk(bytes).refused();
    assert!(refused(vec![1]).contains("ends too early"));
    assert!(refused(run(0, 16, u32::MAX, &packed)).contains("ends too early"));
    assert!(refused(run(0, 16, 1, &packed)).contains("cannot be unpacked"));
    assert!(refused(run(0, 16, 5, b"\xff\xff\xff\xff\xff")).contains("cannot be unpacked"));
    assert!(refused(good(0, 32)).contains("samples up to 32, its picture 21"));
    assert!(refused(good(16, 0)).contains("no whole run"));
    assert!(refused(good(3, 9)).contains("no whole run"));
    assert!(refused([good(0, 16), good(0, 16)].concat()).contains("twice"));
}

#[test]
fn heads_are_checked() {
    let head = |head: &[u8]| Forged { head: head.to_vec(), ..Forged::new() }.refused();
    assert!(head(b"").contains("head cannot be read") && head(b"\xff").contains("head cannot be read"));
    assert!(head("[".repeat(100_000).as_bytes()).contains("head cannot be read"));
    let with = |change: &dyn Fn(&mut Head)| {
        let mut head = Head { layers: layers(&description(TINY, 21)), part: description(TINY, 21) };
        change(&mut head);
        forged_head(&head)
    };
    let depth = Layer { name: "depth".into(), channels: vec!["Z".into()] };
    let error = with(&|head| head.layers.push(depth.clone()));
    assert!(error.contains("radiance (R, G, B), depth (Z); this program knows radiance (R, G, B)"), "{error}");
    assert!(with(&|head| head.part.size = [3, 3]).contains("region is not inside"));
    let error = Forged { version: 2, ..Forged::new() }.refused();
    assert!(error.contains("version 2") && error.contains("versions up to 1"), "{error}");
}

#[test]
fn heads_of_what_no_picture_can_be_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut Description)| {
        let mut part = description(TINY, 21);
        // A head without any layers says nothing of them.
        part.layers.masks = true;
        change(&mut part);
        forged_head(&Head { layers: layers(&part), part })
    };
    let whole = |part: &mut Description| {
        part.size = [65_536; 2];
        part.region = Rect { x: 0, y: 0, width: 65_536, height: 65_536 };
    };
    assert!(refused(&whole).contains("larger than any that can be rendered"));
    assert!(refused(&|part| part.layers.entries = u32::MAX).contains("more objects (`entries`) than a scene can have"));
    assert!(refused(&|part| part.layers.planes = u32::MAX).contains("more layers (`planes`) than a picture can keep"));
    let groups = |part: &mut Description| part.layers.light_groups = vec!["a".into(); 200_000];
    assert!(refused(&groups).contains("more groups of lights (`light_groups`) than a scene can have"));
    // What a picture may have is not made room for if its chunk is too short for it.
    assert!(refused(&|part| part.layers.planes = 4096).contains("packed layers cannot be unpacked"));
}

fn forged_head(head: &Head) -> String {
    Forged { head: serde_json::to_vec(head).unwrap(), ..Forged::new() }.refused()
}
