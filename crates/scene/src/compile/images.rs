//! Image files of textures. Each file is read and prepared once and shared by all textures, frames
//! and copies of a scene.

use super::file_cache::file_stamp;
use super::meshes::{AssetCache, Files, NEVER_CANCELLED, read_error_message};
use crate::description::Description;
use crate::item::Item;
use crate::path::Path;
use crate::picture_reading::PictureReading;
use crate::report::Finding;
use crate::store::{MAX_FILE_BYTES, Store};
use crate::texel_array::TexelArray;
pub use crate::texel_array::{MAX_SIDE, MAX_TEXELS};
use juggler_imaging::raster::{RasterLayout, decode_raster};
use juggler_imaging::{ImageError, Raster, RasterSamples, TransferFunction, raster_head};
use juggler_math::{BuildControl, Rgb};
use juggler_texture::{AnyTexture, ColorSpace, Image, Images, MipMap};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::SystemTime;

/// Limits that are checked before an image is decoded.
pub(super) const IMAGE_LIMITS: juggler_imaging::Limits =
    juggler_imaging::Limits { max_pixels: MAX_TEXELS, longest_side: MAX_SIDE };

/// File, and the color space that its samples are decoded from.
pub type ImageKey = (PathBuf, ColorSpace);

/// Cache of loaded images. Assets of equal bytes share an entry.
#[derive(Clone, Debug, Default)]
pub struct ImageCache {
    reading: PictureReading,
    entries: Arc<Mutex<BTreeMap<ImageKey, Arc<ImageFile>>>>,
}

/// Image file.
#[derive(Debug)]
struct ImageFile {
    /// Hash of the content; zeros if the file could not be read.
    digest: [u8; 32],
    /// Mipmap pyramid, or an error message.
    pixels: Result<Arc<MipMap>, String>,
    /// Length and modification time, taken before the file was read; `None` for an asset.
    stamp: Option<(u64, SystemTime)>,
    /// Number of pixels that are infinite in the file.
    infinite: u64,
    /// Whether the file holds more images than the one that is used.
    is_first_of_several: bool,
}

/// Key of the image of a file: its canonical name, or the hash of an asset.
pub(super) fn image_key(path: &std::path::Path, space: ColorSpace, store: &Store) -> ImageKey {
    let is_encoded = store.assets.at(path).is_some_and(|asset| asset.bytes().is_some());
    match path.to_str().and_then(|path| path.split_once('/')).filter(|_| is_encoded) {
        Some((digest, _)) => (digest.into(), space),
        None => (store.canonical_name(path), space),
    }
}

impl ImageCache {
    /// Empty cache.
    pub fn new(reading: PictureReading) -> Self {
        Self { reading, ..Self::default() }
    }

    /// Cache without the files that have changed.
    pub fn without_changed_files(&self) -> Self {
        let entries = self.entries();
        let same = |path: &PathBuf, entry: &ImageFile| entry.stamp.is_some() && entry.stamp == file_stamp(path);
        let kept = entries.iter().filter(|((path, _), entry)| same(path, entry));
        let kept = kept.map(|(name, entry)| (name.clone(), Arc::clone(entry))).collect();
        Self { reading: self.reading, entries: Arc::new(Mutex::new(kept)) }
    }

    /// What is read of pictures.
    pub(super) fn reading(&self) -> PictureReading {
        self.reading
    }

    fn entries(&self) -> MutexGuard<'_, BTreeMap<ImageKey, Arc<ImageFile>>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether the image of a file is loaded.
    pub(super) fn is_loaded(&self, (path, space): &ImageKey, store: &Store) -> bool {
        self.loaded(path, *space, store).is_some()
    }

    /// Loaded image of a file.
    fn loaded(&self, path: &std::path::Path, space: ColorSpace, store: &Store) -> Option<Arc<ImageFile>> {
        let entries = self.entries();
        // The message of a broken asset names it.
        let found = entries.get(&image_key(path, space, store));
        found.or_else(|| entries.get(&(store.canonical_name(path), space))).cloned()
    }

    /// Loads an image without holding the lock, as for meshes. If `control` is cancelled, the image
    /// has a message and is not kept.
    fn load(&self, path: &std::path::Path, space: ColorSpace, store: &Store, control: &BuildControl) -> Arc<ImageFile> {
        if let Some(known) = self.loaded(path, space, store) {
            return known;
        }
        if let Err(cancelled) = control.check() {
            return Arc::new(ImageFile::new([0; 32], Err(cancelled.to_string())));
        }
        let image = Arc::new(ImageFile::load(path, space, store, self.reading));
        let is_broken = image.pixels.is_err();
        let key = if is_broken { (store.canonical_name(path), space) } else { image_key(path, space, store) };
        Arc::clone(self.entries().entry(key).or_insert(image))
    }
}

impl AssetCache {
    /// Mipmap pyramid of an image file, or an error message that names the file.
    pub fn image(&self, path: &std::path::Path, space: ColorSpace) -> Result<Arc<MipMap>, String> {
        self.image_with_control(path, space, &NEVER_CANCELLED)
    }

    /// [`AssetCache::image`]; a message if `control` is cancelled.
    pub(super) fn image_with_control(
        &self,
        path: &std::path::Path,
        space: ColorSpace,
        control: &BuildControl,
    ) -> Result<Arc<MipMap>, String> {
        self.images().load(path, space, self.store(), control).pixels.clone()
    }

    /// Hash of an image file's content; zeros for a file that cannot be read, which compilation
    /// reports.
    pub fn image_digest(&self, path: &std::path::Path, space: ColorSpace) -> [u8; 32] {
        self.images().load(path, space, self.store(), &NEVER_CANCELLED).digest
    }
}

impl ImageFile {
    fn load(path: &std::path::Path, space: ColorSpace, store: &Store, reading: PictureReading) -> Self {
        if let Some((image, digest)) = store.assets.image_at(path) {
            return Self::from_image(image, digest, &store.assets.origin(path));
        }
        if let Some((texels, digest)) = store.assets.texels_at(path) {
            return Self::from_raster(Ok(texels.raster()), digest, &store.assets.origin(path), space);
        }
        let stamp = file_stamp(path);
        let bytes = match store.read_bytes(path, MAX_FILE_BYTES) {
            Ok(bytes) => bytes,
            Err(error) => {
                return Self { stamp, ..Self::new([0; 32], Err(read_error_message(path, &error, store))) };
            }
        };
        if reading == PictureReading::Heads {
            return Self { stamp, ..Self::from_head(&bytes, &store.assets.origin(path)) };
        }
        let digest = blake3::hash(&bytes).into();
        let origin = store.assets.origin(path);
        let raster = decode_raster(&origin, Cursor::new(&*bytes), &IMAGE_LIMITS);
        drop(bytes);
        Self { stamp, ..Self::from_raster(raster, digest, &origin, space) }
    }

    /// An image of one texel in place of the pixels of a file.
    fn from_head(bytes: &[u8], origin: &str) -> Self {
        let head = raster_head(origin, Cursor::new(bytes), &IMAGE_LIMITS);
        let texel = |channels: u8| MipMap::from_bytes([1, 1], channels, vec![u8::MAX; channels.into()], |level| level);
        let empty = || format!("`{origin}`: contains no image");
        let pixels = head.map_err(|error| error.to_string());
        Self::new([0; 32], pixels.and_then(|head| texel(head.layout.channels).map(Arc::new).ok_or_else(empty)))
    }

    fn from_raster(raster: Result<Raster, ImageError>, digest: [u8; 32], origin: &str, space: ColorSpace) -> Self {
        let infinite = raster.as_ref().map_or(0, infinite_pixels);
        let is_first_of_several = raster.as_ref().is_ok_and(|raster| raster.is_first_of_several);
        let pixels = raster.map_err(|error: ImageError| error.to_string()).and_then(|raster| {
            mip_map(raster, space).map(Arc::new).ok_or_else(|| format!("`{origin}`: contains no image"))
        });
        Self { infinite, is_first_of_several, ..Self::new(digest, pixels) }
    }

    fn new(digest: [u8; 32], pixels: Result<Arc<MipMap>, String>) -> Self {
        Self { digest, pixels, stamp: None, infinite: 0, is_first_of_several: false }
    }

    /// Creates an image from pixels in linear light; the color space of textures has no effect.
    fn from_image(image: &juggler_math::Image, digest: [u8; 32], origin: &str) -> Self {
        let pixels = MipMap::from_floats([image.width(), image.height()], 3, image.to_floats()).map(Arc::new);
        let pixels = pixels.ok_or_else(|| format!("`{origin}`: contains no image"));
        Self::new(digest, pixels)
    }
}

fn infinite_pixels(raster: &Raster) -> u64 {
    let RasterSamples::Floats(numbers) = &raster.samples else { return 0 };
    let pixels = numbers.chunks(usize::from(raster.layout.channels).max(1));
    pixels.filter(|pixel| pixel.iter().any(|number| number.is_infinite())).count() as u64
}

/// Warning about the infinite pixels of an image file; `None` if there are none.
pub(super) fn infinity_warning(file: &str, count: u64) -> Option<String> {
    let pixels = match count {
        0 => return None,
        1 => "1 pixel is infinite and becomes".to_owned(),
        count => format!("{count} pixels are infinite and become"),
    };
    Some(format!("`{file}`: {pixels} 65504, the largest 16-bit float, or 0 if negative"))
}

/// Warns of infinite pixels in the loaded images of the scene's textures, and of images of which the
/// file holds several.
pub(super) fn warn_of_images(scene: &Description, files: &Files<'_>, findings: &mut Vec<Finding>) {
    for (name, texture) in &scene.textures {
        let AnyTexture::Image(image) = &**texture else { continue };
        let (file, store) = (files.texture_file(name, image), files.asset_cache.store());
        let Some(loaded) = files.asset_cache.images().loaded(&file, image.color_space, store) else { continue };
        let several = format!("`{}` holds several pictures; the texture shows the first", image.file);
        let several = loaded.is_first_of_several.then_some(several);
        for message in infinity_warning(&image.file, loaded.infinite).into_iter().chain(several) {
            findings.push(Finding::warning(message).at(files.texture_path(name)));
        }
    }
}

/// Creates a mipmap pyramid; decodes the samples from `space`.
fn mip_map(raster: Raster, space: ColorSpace) -> Option<MipMap> {
    let transfer_function = match space {
        ColorSpace::Auto => raster.transfer_function,
        ColorSpace::Srgb => TransferFunction::Srgb,
        ColorSpace::Linear => TransferFunction::Linear,
    };
    let RasterLayout { width, height, channels, to_srgb, .. } = raster.layout;
    let size = [width, height];
    let to_srgb = to_srgb.filter(|_| space == ColorSpace::Auto && channels > 2);
    let samples = match (raster.samples, to_srgb) {
        (RasterSamples::Bytes(bytes), None) => {
            return MipMap::from_bytes(size, channels, bytes, |level| transfer_function.decode(level));
        }
        (samples, _) => samples,
    };
    let mut numbers = linear_values(samples, channels, transfer_function);
    for texel in numbers.chunks_exact_mut(usize::from(channels)) {
        if let (Some(matrix), [r, g, b, ..]) = (to_srgb, texel) {
            [*r, *g, *b] = matrix.color(Rgb::new(*r, *g, *b)).to_array();
        }
    }
    MipMap::from_floats(size, channels, numbers)
}

/// Linear values of samples; alpha, the last of 2 or 4 channels, is linear already.
fn linear_values(samples: RasterSamples, channels: u8, transfer_function: TransferFunction) -> Vec<f32> {
    let channels = usize::from(channels);
    let is_alpha = |i: usize| channels.is_multiple_of(2) && i % channels == channels - 1;
    let levels = |count: u32| -> Vec<f32> {
        let top = f64::from(count - 1);
        (0..count).map(|level| transfer_function.decode(f64::from(level) / top) as f32).collect()
    };
    let linear = |table: &[f32], i: usize, level: u16, top: f32| match table.get(usize::from(level)) {
        Some(color) if !is_alpha(i) => *color,
        _ => f32::from(level) / top,
    };
    match samples {
        RasterSamples::Bytes(bytes) => {
            let table = levels(256);
            bytes.iter().enumerate().map(|(i, level)| linear(&table, i, u16::from(*level), 255.0)).collect()
        }
        RasterSamples::Words(words) => {
            let table = levels(65_536);
            words.iter().enumerate().map(|(i, level)| linear(&table, i, *level, 65_535.0)).collect()
        }
        RasterSamples::Floats(mut numbers) => {
            if transfer_function != TransferFunction::Linear {
                let colors = numbers.iter_mut().enumerate().filter(|(i, _)| !is_alpha(*i));
                colors.for_each(|(_, number)| *number = transfer_function.decode(f64::from(*number)) as f32);
            }
            numbers
        }
    }
}

impl Images for Files<'_> {
    fn image(&self, texture: &str, image: &Image) -> Result<Arc<MipMap>, String> {
        self.asset_cache.image_with_control(&self.texture_file(texture, image), image.color_space, self.control)
    }
}

impl Files<'_> {
    /// Path of a texture: in the scene's `textures`, or inline, where its name is a JSON pointer.
    pub fn texture_path(&self, name: &str) -> Path {
        let own = Path::root().key("textures").key(name);
        let in_place = Path::from_pointer(name);
        // An inline texture is part of the source text of its item.
        let place = |path: &Path| self.scene.innermost_item(path).and_then(|(item, _)| item.place());
        match place(&in_place).zip(place(&own)) {
            Some((outer, inner)) if name.starts_with('/') && outer.contains(inner) => in_place,
            _ => own,
        }
    }

    /// Memory of those files that are images in memory; `bytes` converts a number of pixels to
    /// bytes.
    pub(super) fn image_bytes(&self, files: &[PathBuf], bytes: impl Fn(usize) -> usize) -> u64 {
        let assets = &self.asset_cache.store().assets;
        let images = files.iter().filter_map(|file| assets.image_at(file));
        images.map(|(image, _)| bytes(image.pixels().len()) as u64).fold(0, u64::saturating_add)
    }

    /// Memory of those files that are texels in memory.
    pub(super) fn texel_bytes(&self, files: &[PathBuf], bytes: impl Fn(&TexelArray) -> u64) -> u64 {
        let assets = &self.asset_cache.store().assets;
        files.iter().filter_map(|file| assets.texels_at(file)).map(|(texels, _)| bytes(texels)).sum()
    }

    /// File of an image texture.
    fn texture_file(&self, name: &str, image: &Image) -> PathBuf {
        self.locate(&Path::root().key("textures").key(name), &image.file)
    }
}

/// Image files that a scene names, each once.
pub fn image_files(scene: &Description, files: &Files<'_>) -> BTreeSet<ImageKey> {
    let image = |(name, texture): (&String, &Item<AnyTexture>)| match &**texture {
        AnyTexture::Image(image) => Some((files.texture_file(name, image), image.color_space)),
        _ => None,
    };
    scene.textures.iter().filter_map(image).collect()
}
