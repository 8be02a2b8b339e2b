//! Intel Open Image Denoise (<https://www.openimagedenoise.org>, Apache-2.0), version 2, where it is installed: a
//! neural network that takes the noise out of path traced pictures. The library is opened when somebody asks for it, and is
//! needed for nothing else. What it gives may differ from machine to machine.
//!
//! Whoever names a library lets its code run: a path must come from the user, not from a file that somebody sent.

#[cfg_attr(target_family = "wasm", path = "absent.rs")]
mod ffi;
mod image;

use image::Image;
use juggler_math::{Rgb, Vec3};
use std::path::{Path, PathBuf};

/// The names under which the system knows the library.
pub const NAMES: &[&str] = if cfg!(target_os = "windows") {
    &["OpenImageDenoise.dll"]
} else if cfg!(target_os = "macos") {
    &["libOpenImageDenoise.2.dylib", "libOpenImageDenoise.dylib"]
} else {
    &["libOpenImageDenoise.so.2", "libOpenImageDenoise.so"]
};

/// Why there is no picture without noise.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// There is no such library, or it cannot be opened.
    #[error("Open Image Denoise was not found: looked for {}", tried.join("; "))]
    NotFound {
        /// Each name or path, and what the system said of it.
        tried: Vec<String>,
    },
    /// A library was opened, but it is none that can be called.
    #[error("{} is not Open Image Denoise 2: {reason}", path.display())]
    Unfit {
        /// What was opened.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A picture has not as many pixels as its size says.
    #[error("{what} has {found} pixels instead of {width} × {height}")]
    Size {
        /// Which picture.
        what: &'static str,
        /// How many it has.
        found: usize,
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The library said so.
    #[error("Open Image Denoise failed: {0}")]
    Failed(String),
}

/// The library, opened.
#[derive(Debug)]
pub struct Library {
    api: ffi::Api,
    version: [u32; 3],
}

impl Library {
    /// Opens the library at `path`, or in it if that is a folder, or the one that the system knows.
    pub fn open(path: Option<&Path>) -> Result<Self, Error> {
        let candidates: Vec<PathBuf> = match path {
            Some(folder) if folder.is_dir() => NAMES.iter().map(|name| folder.join(name)).collect(),
            Some(file) => vec![file.to_path_buf()],
            None => NAMES.iter().map(PathBuf::from).collect(),
        };
        let mut tried = Vec::new();
        for candidate in candidates {
            match ffi::open(&candidate) {
                Ok(library) => return Self::checked(&candidate, library),
                Err(reason) => tried.push(format!("{} ({reason})", candidate.display())),
            }
        }
        Err(Error::NotFound { tried })
    }

    fn checked(path: &Path, library: ffi::Library) -> Result<Self, Error> {
        let unfit = |reason: String| Error::Unfit { path: path.to_path_buf(), reason };
        let api = ffi::Api::new(library).map_err(unfit)?;
        let number = api.device().map_err(|error| unfit(error.to_string()))?.version();
        let version = [number / 10_000, number / 100 % 100, number % 100];
        if version[0] == 2 { Ok(Self { api, version }) } else { Err(unfit(format!("its version is {number}"))) }
    }

    /// Major, minor and patch.
    pub fn version(&self) -> [u32; 3] {
        self.version
    }

    /// The picture without noise. `color`: linear light without upper bound; `albedo`: 0..1; `normal`: of length 1 or less, in any
    /// space. All row by row from the top left. What is not finite counts as black.
    pub fn denoise(
        &self,
        width: usize,
        height: usize,
        color: &[Rgb],
        albedo: Option<&[Rgb]>,
        normal: Option<&[Vec3]>,
    ) -> Result<Vec<Rgb>, Error> {
        let image = |name: &'static str, found: usize, numbers: Vec<f32>| {
            Image::new(name, width, height, numbers).ok_or(Error::Size { what: name, found, width, height })
        };
        let mut images = vec![image("color", color.len(), flat(color.iter().map(|c| c.to_array())))?];
        if let Some(albedo) = albedo {
            images.push(image("albedo", albedo.len(), flat(albedo.iter().map(|c| c.to_array())))?);
        }
        if let Some(normal) = normal {
            images.push(image("normal", normal.len(), flat(normal.iter().map(|n| n.to_array())))?);
        }
        let numbers = self.api.device()?.filter(&images, width, height)?;
        Ok(numbers.chunks_exact(3).map(|pixel| Rgb::new(pixel[0], pixel[1], pixel[2])).collect())
    }
}

/// Numbers one after the other, those that are none as zero.
fn flat(pixels: impl Iterator<Item = [f32; 3]>) -> Vec<f32> {
    pixels.flatten().map(|number| if number.is_finite() { number } else { 0.0 }).collect()
}
