//! Replacement for `ffi.rs` on WebAssembly, which has no shared libraries: [`open`] always fails.
//! The other types have no values, so their methods are unreachable.

use crate::Error;
use crate::image::FilterImage;
use std::path::Path;

/// Open library; has no values.
#[derive(Debug)]
pub(crate) enum Library {}

/// Fails: WebAssembly cannot open libraries.
pub(crate) fn open(_path: &Path) -> Result<Library, String> {
    Err("WebAssembly cannot open libraries".to_owned())
}

/// Functions of an open library.
#[derive(Debug)]
pub(crate) enum Api {}

impl Api {
    /// Looks up the functions of `library`.
    pub fn new(library: Library) -> Result<Self, String> {
        match library {}
    }

    /// Creates a CPU device.
    pub fn device(&self) -> Result<Device, Error> {
        match *self {}
    }
}

/// Device of an open library.
pub(crate) enum Device {}

impl Device {
    /// Version: 10,000 × major + 100 × minor + patch.
    pub fn version(&self) -> u32 {
        match *self {}
    }

    /// Runs the filter on `images`.
    pub fn filter(&self, _images: &[FilterImage], _width: usize, _height: usize) -> Result<Vec<f32>, Error> {
        match *self {}
    }
}
