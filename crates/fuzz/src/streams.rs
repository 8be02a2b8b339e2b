//! Compressed arrays and pictures of glTF files: the streams of the reference encoders that the
//! crate `juggler-import` tests with.

use juggler_import::gltf::meshopt::{Filter, Mode};

const MESHOPT: &str = include_str!("../../import/src/gltf/meshopt/streams.txt");
const DRACO: &str = include_str!("../../import/src/gltf/draco/streams.txt");
const KTX2: &str = include_str!("../../import/src/gltf/ktx2/streams.txt");

/// Size of the head of a meshopt file of these tests, in bytes.
pub const MESHOPT_HEAD: usize = 8;

/// Modes and filters, which the head names by number.
pub const MODES: [Mode; 3] = [Mode::Attributes, Mode::Triangles, Mode::Indices];

/// See [`MODES`].
pub const FILTERS: [Filter; 5] =
    [Filter::None, Filter::Octahedral, Filter::Quaternion, Filter::Exponential, Filter::Color];

/// Meshopt streams, each after a head of what glTF files say about it: numbers of mode and filter,
/// stride in two bytes and count in four, little-endian.
pub fn meshopt() -> Vec<Vec<u8>> {
    let file = |line: &str| {
        let mut words = line.split(' ');
        let (mode, filter) = (Mode::from_name(words.next()?)?, Filter::from_name(words.next()?)?);
        let (count, stride): (u32, u16) = (words.next()?.parse().ok()?, words.next()?.parse().ok()?);
        let mode = MODES.iter().position(|other| *other == mode)?;
        let filter = FILTERS.iter().position(|other| *other == filter)?;
        let numbers = [mode as u8, filter as u8];
        Some([&numbers[..], &stride.to_le_bytes(), &count.to_le_bytes(), &bytes(words.nth(1)?)].concat())
    };
    MESHOPT.lines().filter_map(file).collect()
}

/// Draco streams with positions as attribute 0.
pub fn draco() -> Vec<Vec<u8>> {
    let file = |line: &str| {
        let mut words = line.split(' ');
        let (stream, vertices) = (words.next()?, words.next()?.parse::<u32>().ok()?);
        // The largest mesh exceeds the limit of triangles.
        (vertices < 10_000).then(|| bytes(stream))
    };
    DRACO.lines().filter_map(file).collect()
}

/// KTX2 files.
pub fn ktx2() -> Vec<Vec<u8>> {
    KTX2.lines().filter_map(|line| line.split(' ').next()).map(bytes).collect()
}

/// Bytes of hexadecimal digits.
fn bytes(digits: &str) -> Vec<u8> {
    let pairs = digits.as_bytes().as_chunks::<2>().0.iter();
    pairs.filter_map(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok()).collect()
}
