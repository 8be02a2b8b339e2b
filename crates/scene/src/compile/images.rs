//! Pictures: each file read and prepared once, shared by all textures, frames and copies of a scene.

use super::meshes::{Files, Library, explain, state};
use crate::description::Description;
use crate::import::Limits;
use crate::item::Item;
use crate::path::Path;
use crate::store::Store;
use juggler_imaging::raster::{Layout, decode_raster, inspect_raster};
use juggler_imaging::{Encoding, ImageError, Raster, Samples};
use juggler_texture::{AnyTexture, ColorSpace, Image, Images, Pyramid};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;

/// The longest side of a picture.
pub const MAX_SIDE: u32 = 65_536;

/// Most pixels of a picture: 16,384 × 16,384.
pub const MAX_TEXELS: u64 = 1 << 28;

/// What is checked of a picture before it is decoded.
pub(super) const MAX_PICTURE: juggler_imaging::Limits =
    juggler_imaging::Limits { most_pixels: MAX_TEXELS, longest_side: MAX_SIDE };

/// A file, and what its numbers are taken for.
pub type Name = (PathBuf, ColorSpace);

/// The pictures that were loaded so far.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    entries: Arc<Mutex<BTreeMap<Name, Arc<Picture>>>>,
}

/// A picture file.
#[derive(Debug)]
struct Picture {
    /// The hash of its content; zeros when it could not be read.
    digest: [u8; 32],
    /// Ready to be looked at; or why not.
    pixels: Result<Arc<Pyramid>, String>,
    /// How long the file was and when it was last written to, before it was read.
    state: Option<(u64, SystemTime)>,
}

impl Pictures {
    /// Those whose files have not changed.
    pub fn renewed(&self) -> Self {
        let entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |path: &PathBuf, entry: &Picture| entry.state.is_some() && entry.state == state(path);
        let kept = entries.iter().filter(|((path, _), entry)| same(path, entry));
        let kept = kept.map(|(name, entry)| (name.clone(), Arc::clone(entry))).collect();
        Self { entries: Arc::new(Mutex::new(kept)) }
    }

    /// As with meshes, files are loaded without the lock.
    fn load(&self, path: &std::path::Path, space: ColorSpace, store: &Store) -> Arc<Picture> {
        let name = (store.true_name(path), space);
        let entries = || self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = entries().get(&name) {
            return Arc::clone(known);
        }
        let picture = Arc::new(Picture::load(path, space, store));
        Arc::clone(entries().entry(name).or_insert(picture))
    }
}

impl Library {
    /// The pixels of a picture file, with its smaller copies; or why there are none, in words that name the file.
    pub fn picture(&self, path: &std::path::Path, space: ColorSpace) -> Result<Arc<Pyramid>, String> {
        self.pictures().load(path, space, self.store()).pixels.clone()
    }

    /// The hash of a picture file's content; zeros for a file that cannot be read, which compiling reports.
    pub fn picture_digest(&self, path: &std::path::Path, space: ColorSpace) -> [u8; 32] {
        self.pictures().load(path, space, self.store()).digest
    }
}

impl Picture {
    fn load(path: &std::path::Path, space: ColorSpace, store: &Store) -> Self {
        if let Some((image, digest)) = store.assets.image_at(path) {
            return Self::from_image(image, digest, path);
        }
        let state = state(path);
        let bytes = match store.mesh(path, &Limits::default()) {
            Ok(bytes) => bytes,
            Err(error) => return Self { digest: [0; 32], pixels: Err(explain(&error)), state },
        };
        let digest = blake3::hash(&bytes).into();
        let raster = decode_raster(&path.display().to_string(), Cursor::new(&*bytes), &MAX_PICTURE);
        drop(bytes);
        let pixels = raster.map_err(|error: ImageError| error.to_string()).and_then(|raster| {
            pyramid(raster, space).map(Arc::new).ok_or_else(|| format!("`{}`: holds no picture", path.display()))
        });
        Self { digest, pixels, state }
    }
}

impl Picture {
    /// Picture of pixels in linear light, whatever the color space that a texture names.
    fn from_image(image: &juggler_math::Image, digest: [u8; 32], path: &std::path::Path) -> Self {
        let pixels = Pyramid::of_numbers([image.width(), image.height()], 3, image.to_floats()).map(Arc::new);
        let pixels = pixels.ok_or_else(|| format!("`{}`: holds no picture", path.display()));
        Self { digest, pixels, state: None }
    }
}

/// A picture with its smaller copies, its numbers taken for what `space` says.
fn pyramid(raster: Raster, space: ColorSpace) -> Option<Pyramid> {
    let encoding = match space {
        ColorSpace::Auto => raster.encoding,
        ColorSpace::Srgb => Encoding::Srgb,
        ColorSpace::Linear => Encoding::Linear,
    };
    let Layout { width, height, channels, .. } = raster.layout;
    let size = [width, height];
    match raster.samples {
        Samples::Bytes(bytes) => Pyramid::of_bytes(size, channels, bytes, |level| encoding.decode(level)),
        Samples::Words(words) => {
            let table: Vec<f32> =
                (0..=u16::MAX).map(|word| encoding.decode(f64::from(word) / 65_535.0) as f32).collect();
            let color = |word: u16| table.get(usize::from(word)).copied().unwrap_or_default();
            let numbers = words.chunks(usize::from(channels)).flat_map(|texel| {
                let alpha = if channels.is_multiple_of(2) { texel.len().checked_sub(1) } else { None };
                let number =
                    move |i: usize, word: u16| if Some(i) == alpha { f32::from(word) / 65_535.0 } else { color(word) };
                texel.iter().enumerate().map(move |(i, word)| number(i, *word))
            });
            Pyramid::of_numbers(size, channels, numbers.collect())
        }
        Samples::Floats(mut numbers) => {
            if encoding != Encoding::Linear {
                let colors = usize::from(channels) - usize::from(channels.is_multiple_of(2));
                for texel in numbers.chunks_mut(usize::from(channels)) {
                    texel.iter_mut().take(colors).for_each(|v| *v = encoding.decode(f64::from(*v)) as f32);
                }
            }
            Pyramid::of_numbers(size, channels, numbers)
        }
    }
}

impl Images for Files<'_> {
    fn image(&self, texture: &str, image: &Image) -> Result<Arc<Pyramid>, String> {
        self.library.picture(&self.of_texture(texture, image), image.color_space)
    }
}

impl Files<'_> {
    /// Where a texture is described: among the scene's textures, or where it is written in place, by the name that it
    /// has got there.
    pub fn texture_path(&self, name: &str) -> Path {
        let own = Path::root().key("textures").key(name);
        let in_place = Path::from_pointer(name);
        // A texture is written in place where the item that it belongs to was written around it.
        let place = |path: &Path| self.scene.item_of(path).and_then(|(item, _)| item.place());
        match place(&in_place).zip(place(&own)) {
            Some((outer, inner)) if name.starts_with('/') && outer.contains(inner) => in_place,
            _ => own,
        }
    }

    /// Bytes that become of images in memory among these files, by their numbers of pixels.
    pub(super) fn image_bytes(&self, files: &[PathBuf], bytes: impl Fn(usize) -> usize) -> u64 {
        let assets = &self.library.store().assets;
        let images = files.iter().filter_map(|file| assets.image_at(file));
        images.map(|(image, _)| bytes(image.pixels().len()) as u64).fold(0, u64::saturating_add)
    }

    /// The file of an image texture.
    fn of_texture(&self, name: &str, image: &Image) -> PathBuf {
        self.locate(&Path::root().key("textures").key(name), &image.file)
    }
}

/// The pictures that a scene names, each once.
pub fn pictures(scene: &Description, files: &Files<'_>) -> BTreeSet<Name> {
    let image = |(name, texture): (&String, &Item<AnyTexture>)| match &**texture {
        AnyTexture::Image(image) => Some((files.of_texture(name, image), image.color_space)),
        _ => None,
    };
    scene.textures.iter().filter_map(image).collect()
}

/// What a picture file takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Estimate {
    /// Bytes that stay.
    pub kept: u64,
    /// Bytes at once while it is read.
    pub peak: u64,
}

/// What a picture file takes at most, by its size and head. Nothing for a file that cannot be read.
pub fn estimate(path: &std::path::Path) -> Estimate {
    let Ok(layout) = inspect_raster(path) else { return Estimate::default() };
    let samples = u64::from(layout.width) * u64::from(layout.height) * u64::from(layout.channels);
    if samples > MAX_TEXELS * 4 {
        return Estimate::default();
    }
    // Kept as bytes or floats, with a third for the smaller copies; decoders hold samples and blocks beside.
    let (kept, beside) = match layout.sample_bytes {
        1 => (1, 4),
        _ => (4, 8),
    };
    let kept = samples * kept * 4 / 3 + 64;
    let file = std::fs::metadata(path).map_or(0, |metadata| metadata.len());
    Estimate { kept, peak: kept + samples * beside + file }
}
