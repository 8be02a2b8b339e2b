//! Memory of the pictures of textures, known from their heads, and decoding of several at once.

use super::images::{IMAGE_LIMITS, ImageKey, image_files, image_key};
use super::lighting;
use super::meshes::Files;
use super::picture_estimate::{DECODED_AT_ONCE, Estimate, PictureNeeds};
use crate::asset::display_name;
use crate::description::Description;
use crate::picture_reading::PictureReading;
use crate::store::Store;
use juggler_texture::ColorSpace;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Memory for an image file or asset that is decoded from a color space, from its size and head;
/// zero for a file that cannot be read.
fn of_file(path: &Path, space: ColorSpace, store: &Store) -> Estimate {
    let is_file = store.assets.at(path).is_none();
    let head = store.picture_head(path, &IMAGE_LIMITS);
    head.map_or_else(Estimate::default, |(head, length)| Estimate::of_head(&head, space, length, is_file))
}

impl Files<'_> {
    /// Pictures of a scene's textures, each once; without those that cannot be read and those that
    /// are pixels in memory already.
    pub(super) fn picture_needs(&self, scene: &Description) -> Vec<PictureNeeds> {
        let estimate = |(file, space): &ImageKey| of_file(file, *space, self.asset_cache.store());
        let needs = |key: ImageKey| PictureNeeds { name: self.picture_name(&key.0), estimate: estimate(&key) };
        let found = self.pictures(scene).into_values().map(needs);
        found.filter(|picture| picture.estimate != Estimate::default()).collect()
    }

    /// Environment maps of these files.
    pub(super) fn panorama_needs(&self, files: &[PathBuf]) -> Vec<PictureNeeds> {
        let estimate = |file: &PathBuf| lighting::estimate(file, self.asset_cache.store());
        files.iter().map(|file| PictureNeeds { name: self.picture_name(file), estimate: estimate(file) }).collect()
    }

    /// Name of a picture: of an asset, or the last part of that of a file.
    fn picture_name(&self, file: &Path) -> String {
        let is_asset = self.asset_cache.store().assets.at(file).is_some();
        let last = || file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if is_asset { display_name(file) } else { last() }
    }

    /// Files of pictures by their keys in the cache.
    fn pictures(&self, scene: &Description) -> BTreeMap<ImageKey, ImageKey> {
        let store = self.asset_cache.store();
        let is_encoded = |(file, _): &ImageKey| store.assets.at(file).is_none_or(|asset| asset.bytes().is_some());
        let encoded = image_files(scene, self).into_iter().filter(is_encoded);
        encoded.map(|(file, space)| (image_key(&file, space, store), (file, space))).collect()
    }

    /// Decodes the pictures of a scene's textures, several at once, into the cache. Messages about
    /// them follow when textures are compiled.
    pub(super) fn decode_pictures(&self, scene: &Description) {
        let (cache, store) = (self.asset_cache, self.asset_cache.store());
        let is_new = |file: &ImageKey| !cache.images().is_loaded(file, store);
        let files: Vec<ImageKey> = self.pictures(scene).into_values().filter(is_new).collect();
        if files.len() < 2 || cache.images().reading() == PictureReading::Heads {
            return;
        }
        let temporary = |(file, space): &ImageKey| of_file(file, *space, store).temporary_bytes();
        let bytes: Vec<u64> = files.iter().map(temporary).collect();
        let mut rest = files.as_slice();
        for count in counts_at_once(&bytes) {
            let (now, later) = rest.split_at(count.min(rest.len()));
            now.par_iter().for_each(|(file, space)| drop(cache.image_with_control(file, *space, self.control)));
            rest = later;
        }
    }
}

/// Splits pictures that need these bytes until they are decoded into runs of those that are decoded
/// at once; returns their lengths.
fn counts_at_once(bytes: &[u64]) -> Vec<usize> {
    let (mut counts, mut sum) = (Vec::new(), u64::MAX);
    for bytes in bytes {
        sum = sum.saturating_add(*bytes);
        match counts.last_mut() {
            Some(count) if sum <= DECODED_AT_ONCE => *count += 1,
            _ => {
                counts.push(1);
                sum = *bytes;
            }
        }
    }
    counts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_that_are_decoded_at_once_keep_within_a_bound() {
        let half = DECODED_AT_ONCE / 2;
        assert_eq!(counts_at_once(&[half, half, 1, half, half, half]), [2, 2, 2]);
        assert_eq!(counts_at_once(&[3 * half, 1, 2, 3 * half, u64::MAX]), [1, 2, 1, 1]);
        assert_eq!(counts_at_once(&[]), [0; 0]);
    }
}
