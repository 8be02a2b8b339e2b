//! Stands in for `ffi.rs` on WebAssembly, where shared libraries do not exist: [`open`] always fails, and the types below have
//! no values, so that no call can be missing.

use crate::Error;
use crate::image::Image;
use std::path::Path;

/// An open library; there is none.
#[derive(Debug)]
pub(crate) enum Library {}

/// Fails: WebAssembly cannot open libraries.
pub(crate) fn open(_path: &Path) -> Result<Library, String> {
    Err("WebAssembly cannot open libraries".to_owned())
}

/// The functions of an open library.
#[derive(Debug)]
pub(crate) enum Api {}

impl Api {
    /// Finds the functions of `library`.
    pub fn new(library: Library) -> Result<Self, String> {
        match library {}
    }

    /// A device on the processor.
    pub fn device(&self) -> Result<Device, Error> {
        match *self {}
    }
}

/// A device of an open library.
pub(crate) enum Device {}

impl Device {
    /// 10,000 × major + 100 × minor + patch.
    pub fn version(&self) -> u32 {
        match *self {}
    }

    /// Runs the filter on `images`.
    pub fn filter(&self, _images: &[Image], _width: usize, _height: usize) -> Result<Vec<f32>, Error> {
        match *self {}
    }
}
