//! Cryptomatte ID mattes: the coverage of each pixel by named objects or materials, from which
//! compositing programs extract masks (Friedman and Jones, Fully Automatic ID Mattes with Support
//! for Motion Blur and Transparency, 2015; the Cryptomatte specification, version 1.2.0).
//!
//! A name's ID is its MurmurHash3 as a float. Each pixel lists pairs of ID and coverage, ranked by
//! coverage.

use juggler_imaging::layered::LayerHeader;
use std::collections::BTreeMap;

/// Number of ranks: ID and coverage pairs per pixel.
const RANKS: usize = 6;
/// Number of channels: two per rank.
pub const CHANNELS: usize = 2 * RANKS;

/// Returns the layer headers for a matte of these names, with the manifest.
pub fn headers(name: &str, names: &[String]) -> Vec<LayerHeader> {
    let layer = |number: usize| LayerHeader::new(&format!("{name}{number:02}"), &["R", "G", "B", "A"]);
    let mut headers: Vec<LayerHeader> = (0..RANKS / 2).map(layer).collect();
    let key = format!("cryptomatte/{}", &hex(hash(name))[..7]);
    let text = |what: &str, value: &str| (format!("{key}/{what}"), value.to_owned());
    // A map lists each name once, in order.
    let manifest: BTreeMap<&str, String> = names.iter().map(|name| (name.as_str(), hex(hash(name)))).collect();
    let manifest = serde_json::to_string(&manifest).unwrap_or_default();
    let texts = [
        text("name", name),
        text("hash", "MurmurHash3_32"),
        text("conversion", "uint32_to_float32"),
        text("manifest", &manifest),
    ];
    for header in &mut headers {
        header.metadata.extend(texts.iter().cloned());
    }
    headers
}

/// Appends the channels of a pixel with the given coverages.
pub fn append(coverages: Vec<(u32, f32)>, name: impl Fn(u32) -> String, row: &mut Vec<f32>) {
    // Sum the coverage of equal names.
    let mut by_hash: BTreeMap<u32, f32> = BTreeMap::new();
    for (id, coverage) in coverages.into_iter().filter(|(_, coverage)| *coverage > 0.0) {
        *by_hash.entry(hash(&name(id))).or_default() += coverage;
    }
    let mut ranks: Vec<(u32, f32)> = by_hash.into_iter().collect();
    // Ties stay in the order of their hashes.
    ranks.sort_by(|a, b| b.1.total_cmp(&a.1));
    for rank in 0..RANKS {
        let (hash, coverage) = ranks.get(rank).copied().unwrap_or((0, 0.0));
        row.extend([f32::from_bits(hash), coverage]);
    }
}

fn hex(hash: u32) -> String {
    format!("{hash:08x}")
}

/// Returns the ID of a name: its MurmurHash3 (32 bits, seed 0). A flipped exponent bit avoids
/// zeros, subnormals, infinities and NaN (specification, section "Hashing").
fn hash(name: &str) -> u32 {
    let hash = murmur3(name.as_bytes());
    match hash >> 23 & 255 {
        0 | 255 => hash ^ 1 << 23,
        _ => hash,
    }
}

/// MurmurHash3, x86, 32 bits, seed 0 (Appleby 2011).
fn murmur3(bytes: &[u8]) -> u32 {
    let scramble = |word: u32| word.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let (words, tail) = bytes.as_chunks::<4>();
    let mut hash = 0u32;
    for word in words {
        hash ^= scramble(u32::from_le_bytes(*word));
        hash = hash.rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64);
    }
    if !tail.is_empty() {
        hash ^= scramble(tail.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte)));
    }
    hash ^= bytes.len() as u32;
    hash = (hash ^ hash >> 16).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ hash >> 13).wrapping_mul(0xc2b2_ae35);
    hash ^ hash >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn murmur3_matches_known_hashes() {
        // Appleby's own test vectors, and names whose IDs appear in the specification's sample
        // images.
        for (text, expected) in [("", 0), ("a", 0x3c25_69b2), ("abc", 0xb3dd_93fa), ("Hello, world!", 0xc036_3e43)] {
            assert_eq!(murmur3(text.as_bytes()), expected, "{text}");
        }
    }

    #[test]
    fn objects_are_ranked_by_coverage_and_equal_names_are_merged() {
        let name = |number: u32| if number < 2 { "twin".to_owned() } else { format!("{number}") };
        let mut row = Vec::new();
        append(vec![(0, 0.25), (1, 0.125), (2, 0.3), (3, 0.0)], name, &mut row);
        assert_eq!(row.len(), 2 * RANKS);
        assert_eq!((row[0].to_bits(), row[1]), (hash("twin"), 0.375));
        assert_eq!((row[2].to_bits(), row[3]), (hash("2"), 0.3));
        assert_eq!(row[4..], [0.0; 8]);
    }

    #[test]
    fn every_name_is_a_finite_float() {
        for number in 0..20_000 {
            let value = f32::from_bits(hash(&number.to_string()));
            assert!(value.is_normal(), "{number}: {value}");
        }
    }
}
