//! Intel Open Image Denoise (<https://www.openimagedenoise.org>, Apache-2.0), version 2: a neural
//! network that denoises path-traced pictures. The library is optional and opened only on request.
//! Its results may differ between machines.
//!
//! Opening a library runs its code: a path must come from the user, never from a received file.

#[cfg_attr(target_family = "wasm", path = "absent.rs")]
mod ffi;
mod image;

use image::FilterImage;
use juggler_math::{Rgb, Vec3};
use std::path::{Path, PathBuf};

/// File names of the library on this system, in the order of search.
pub const NAMES: &[&str] = if cfg!(target_os = "windows") {
    &["OpenImageDenoise.dll"]
} else if cfg!(target_os = "macos") {
    &["libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"]
} else {
    &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so"]
};

/// Error of denoising.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The library does not exist or cannot be opened.
    #[error("Open Image Denoise was not found: looked for {}", tried.join("; "))]
    NotFound {
        /// Each name or path that was tried, with the system's error message.
        tried: Vec<String>,
    },
    /// The opened library is not a supported version of Open Image Denoise.
    #[error("{} is not Open Image Denoise 2: {reason}", path.display())]
    Unsupported {
        /// Path of the library.
        path: PathBuf,
        /// Reason why it is not supported.
        reason: String,
    },
    /// The number of pixels of an image does not match its size.
    #[error("{image} has {found} pixels instead of {width} × {height}")]
    Size {
        /// Name of the image: `color`, `albedo` or `normal`.
        image: &'static str,
        /// Number of pixels of the image.
        found: usize,
        /// Expected width in pixels.
        width: usize,
        /// Expected height in pixels.
        height: usize,
    },
    /// The library reported an error.
    #[error("Open Image Denoise failed: {0}")]
    Failed(String),
}

/// Open library.
#[derive(Debug)]
pub struct Oidn {
    api: ffi::Api,
    version: [u32; 3],
}

impl Oidn {
    /// Opens the library at `path`, or in that folder; without a path, the library that the system
    /// finds under [`NAMES`].
    pub fn open(path: Option<&Path>) -> Result<Self, Error> {
        let candidates: Vec<PathBuf> = match path {
            Some(folder) if folder.is_dir() => NAMES.iter().map(|name| folder.join(name)).collect(),
            Some(file) => vec![file.to_path_buf()],
            None => NAMES.iter().map(PathBuf::from).collect(),
        };
        let mut tried = Vec::new();
        for candidate in candidates {
            match ffi::open(&candidate) {
                Ok(library) => return Self::from_library(&candidate, library),
                Err(reason) => tried.push(format!("{} ({reason})", candidate.display())),
            }
        }
        Err(Error::NotFound { tried })
    }

    fn from_library(path: &Path, library: ffi::Library) -> Result<Self, Error> {
        let unsupported = |reason: String| Error::Unsupported { path: path.to_path_buf(), reason };
        let api = ffi::Api::new(library).map_err(unsupported)?;
        let number = api.device().map_err(|error| unsupported(error.to_string()))?.version();
        let version = [number / 10_000, number / 100 % 100, number % 100];
        if version[0] == 2 { Ok(Self { api, version }) } else { Err(unsupported(format!("its version is {number}"))) }
    }

    /// Version of the library: major, minor and patch.
    pub fn version(&self) -> [u32; 3] {
        self.version
    }

    /// Denoises a picture. `color` is linear radiance without upper bound; `albedo` is between 0
    /// and 1; `normal` has a length of at most 1, in any space. All are row by row from the top
    /// left. Numbers that are not finite count as 0. Returns an error if a size does not match or
    /// the library fails.
    pub fn denoise(
        &self,
        width: usize,
        height: usize,
        color: &[Rgb],
        albedo: Option<&[Rgb]>,
        normal: Option<&[Vec3]>,
    ) -> Result<Vec<Rgb>, Error> {
        let image = |name: &'static str, found: usize, numbers: Vec<f32>| {
            FilterImage::new(name, width, height, numbers).ok_or(Error::Size { image: name, found, width, height })
        };
        let mut images = vec![image("color", color.len(), flatten_finite(color.iter().map(|c| c.to_array())))?];
        if let Some(albedo) = albedo {
            images.push(image("albedo", albedo.len(), flatten_finite(albedo.iter().map(|c| c.to_array())))?);
        }
        if let Some(normal) = normal {
            images.push(image("normal", normal.len(), flatten_finite(normal.iter().map(|n| n.to_array())))?);
        }
        let numbers = self.api.device()?.filter(&images, width, height)?;
        Ok(numbers.chunks_exact(3).map(|pixel| Rgb::new(pixel[0], pixel[1], pixel[2])).collect())
    }
}

/// Flattens pixels to numbers and replaces those that are not finite by 0.
fn flatten_finite(pixels: impl Iterator<Item = [f32; 3]>) -> Vec<f32> {
    pixels.flatten().map(|number| if number.is_finite() { number } else { 0.0 }).collect()
}
