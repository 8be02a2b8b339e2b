//! Damaged and forged files: rejected with an error that names the file, without a panic, in
//! bounded memory.

use super::super::format::{Entry, Header, Layer, layers};
use crate::testing::{description, place, tile, tiles};
use crate::*;
use juggler_camera::film::{Rect, Tiling};
use juggler_math::testing::Random;
use std::path::Path;

/// A region of two pixels; 21 samples make two runs.
const TINY: Rect = Rect { x: 15, y: 0, width: 1, height: 2 };
/// File written when the format was introduced.
const GOLDEN: &[u8] = include_bytes!("tiny.jfilm");

fn tiny() -> Vec<u8> {
    let (_folder, path) = place("a.jfilm");
    write(&path, &description(TINY, 21), tiles(TINY, 0..21)).unwrap();
    std::fs::read(&path).unwrap()
}

/// Writes `bytes` to `path` and reads them completely.
fn read(path: &Path, bytes: &[u8]) -> Result<(), PartialRenderError> {
    std::fs::write(path, bytes).unwrap();
    PartialRender::open(path)?.verify()
}

#[test]
fn file_format_matches_the_golden_file() {
    let bytes = tiny();
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        let place = concat!(env!("CARGO_MANIFEST_DIR"), "/src/partial_render/tests/tiny.jfilm");
        std::fs::write(place, &bytes).unwrap();
        return;
    }
    let (_folder, path) = place("golden.jfilm");
    std::fs::write(&path, GOLDEN).unwrap();
    let partial_render = PartialRender::open(&path).unwrap();
    assert_eq!(partial_render.description(), &description(TINY, 21));
    assert_eq!(partial_render.tile(0).unwrap(), tile(TINY, 0..21));
    // Other versions of the compressor may produce other bytes; old files must stay readable.
    assert_eq!(bytes, GOLDEN, "other bytes are written");
}

#[test]
fn no_truncated_partial_render_is_accepted() {
    let (_folder, path) = place("short.jfilm");
    let bytes = tiny();
    for length in 0..bytes.len() {
        let error = read(&path, &bytes[..length]).unwrap_err();
        assert!(matches!(error, PartialRenderError::Truncated { .. }), "{length}: {error}");
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
                0..8 => matches!(error, PartialRenderError::NotAPartialRender { .. }),
                8..12 => matches!(error, PartialRenderError::Version { .. }),
                16..24 => matches!(error, PartialRenderError::Truncated { .. } | PartialRenderError::Damaged { .. }),
                _ => matches!(error, PartialRenderError::Damaged { .. }),
            };
            assert!(fits, "byte {at}: {error}");
        }
    }
}

#[test]
fn trailing_bytes_are_rejected() {
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
    assert!(matches!(read(&path, b"{\"version\": 1}"), Err(PartialRenderError::NotAPartialRender { .. })));
    let folder = PartialRender::open(path.parent().unwrap()).unwrap_err();
    assert!(matches!(folder, PartialRenderError::Read { .. }), "{folder}");
    assert!(matches!(PartialRender::open(Path::new("none.jfilm")), Err(PartialRenderError::Read { .. })));
}

#[test]
fn swapped_chunks_are_rejected() {
    let (_folder, path) = place("a.jfilm");
    let region = Rect { x: 0, y: 0, width: 32, height: 16 };
    let tiling = Tiling::new(region);
    // Both chunks have the same length.
    let same = |number: u64| Chunk::encode(&tile(tiling.tile(number).unwrap(), 0..16), false);
    let chunks = [same(0), same(1)];
    let mut writer = PartialRenderWriter::create(&path, &description(region, 16)).unwrap();
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

/// A file assembled as README.md specifies, with any content and valid hashes.
struct Forged {
    version: u32,
    header: Vec<u8>,
    header_length: Option<u32>,
    length: Option<u64>,
    count: Option<u64>,
    chunks: Vec<(u64, Vec<u8>)>,
    chunk_length: Option<u32>,
}

impl Forged {
    fn new() -> Self {
        let header = Header { layers: layers(&description(TINY, 21)), partial_render: description(TINY, 21) };
        let chunk = Chunk::encode(&tile(TINY, 0..21), false).bytes;
        let header = serde_json::to_vec(&header).unwrap();
        let chunks = vec![(0, chunk)];
        Self { version: 1, header, header_length: None, length: None, count: None, chunks, chunk_length: None }
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
        let length = 32 + self.header.len() + chunks.len() + index.len() + 32;
        let mut prelude = b"\x89JFILM\r\n".to_vec();
        prelude.extend(self.version.to_le_bytes());
        prelude.extend(self.header_length.unwrap_or(self.header.len() as u32).to_le_bytes());
        prelude.extend(self.length.unwrap_or(length as u64).to_le_bytes());
        prelude.extend(self.count.unwrap_or(self.chunks.len() as u64).to_le_bytes());
        let seal = blake3::hash(&[prelude.as_slice(), &self.header, &index].concat());
        [prelude.as_slice(), &self.header, &chunks, &index, seal.as_bytes()].concat()
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
fn forged_counts_and_lengths_are_rejected() {
    let counts = [2, 1 << 32, u64::MAX / 44, u64::MAX / 43, u64::MAX];
    for count in counts {
        Forged { count: Some(count), ..Forged::new() }.refused();
    }
    for header_length in [0, 1, 1 << 24, (1 << 24) + 1, u32::MAX] {
        Forged { header_length: Some(header_length), ..Forged::new() }.refused();
    }
    for length in [0, 31, 32, u64::MAX] {
        Forged { length: Some(length), ..Forged::new() }.refused();
    }
    for length in [0, 1, u32::MAX] {
        Forged { chunk_length: Some(length), ..Forged::new() }.refused();
    }
}

#[test]
fn tiles_outside_the_region_and_duplicate_tiles_are_rejected() {
    let chunk = Forged::new().chunks[0].1.clone();
    let forged = |chunks: Vec<(u64, Vec<u8>)>| Forged { chunks, ..Forged::new() }.refused();
    assert!(forged(vec![(1, chunk.clone())]).contains("tile 1 is outside of its region"));
    assert!(forged(vec![(u64::MAX, chunk.clone())]).contains("outside of its region"));
    assert!(forged(vec![(0, chunk.clone()), (0, chunk)]).contains("tile 0 occurs twice"));
}

#[test]
fn malformed_sample_runs_are_rejected() {
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
    assert!(refused(good(0, 32)).contains("samples up to 32, but its picture has 21"));
    assert!(refused(good(16, 0)).contains("do not align with blocks"));
    assert!(refused(good(3, 9)).contains("do not align with blocks"));
    assert!(refused([good(0, 16), good(0, 16)].concat()).contains("twice"));
}

#[test]
fn malformed_headers_are_rejected() {
    let header = |header: &[u8]| Forged { header: header.to_vec(), ..Forged::new() }.refused();
    assert!(header(b"").contains("its header is malformed") && header(b"\xff").contains("its header is malformed"));
    assert!(header("[".repeat(100_000).as_bytes()).contains("its header is malformed"));
    let with = |change: &dyn Fn(&mut Header)| {
        let mut header = Header { layers: layers(&description(TINY, 21)), partial_render: description(TINY, 21) };
        change(&mut header);
        forged_header(&header)
    };
    let depth = Layer { name: "depth".into(), channels: vec!["Z".into()] };
    let error = with(&|header| header.layers.push(depth.clone()));
    assert!(error.contains("radiance (R, G, B), depth (Z); this program supports radiance (R, G, B)"), "{error}");
    assert!(with(&|header| header.partial_render.size = [3, 3]).contains("region is not inside"));
    let error = Forged { version: 2, ..Forged::new() }.refused();
    assert!(error.contains("version 2") && error.contains("versions up to 1"), "{error}");
}

#[test]
fn headers_beyond_the_limits_of_a_render_are_rejected_by_field() {
    let refused = |change: &dyn Fn(&mut RenderDescription)| {
        let mut partial_render = description(TINY, 21);
        // Without any AOVs the header omits `layers`.
        partial_render.aovs.masks = true;
        change(&mut partial_render);
        forged_header(&Header { layers: layers(&partial_render), partial_render })
    };
    let whole = |partial_render: &mut RenderDescription| {
        partial_render.size = [65_536; 2];
        partial_render.region = Rect { x: 0, y: 0, width: 65_536, height: 65_536 };
    };
    assert!(refused(&whole).contains("larger than any that can be rendered"));
    assert!(
        refused(&|partial_render| partial_render.aovs.entries = u32::MAX)
            .contains("more objects (`entries`) than a scene can have")
    );
    assert!(
        refused(&|partial_render| partial_render.aovs.planes = u32::MAX)
            .contains("more AOVs (`planes`) than a picture can hold")
    );
    let groups = |partial_render: &mut RenderDescription| partial_render.aovs.light_groups = vec!["a".into(); 200_000];
    assert!(refused(&groups).contains("more light groups (`light_groups`) than a scene can have"));
    // A valid number of planes is still rejected before allocation if the chunk is too short for
    // it.
    assert!(refused(&|partial_render| partial_render.aovs.planes = 4096).contains("packed AOVs cannot be unpacked"));
}

fn forged_header(header: &Header) -> String {
    Forged { header: serde_json::to_vec(header).unwrap(), ..Forged::new() }.refused()
}
