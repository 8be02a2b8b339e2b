//! Image in the layout of Open Image Denoise.

use std::ffi::CString;

/// Image of three numbers per pixel, row by row from the top left.
#[cfg_attr(target_family = "wasm", allow(dead_code, reason = "nothing reads a picture where no library can be opened"))]
pub(crate) struct FilterImage {
    /// Name of the image in the filter: `color`, `albedo` or `normal`.
    pub name: CString,
    /// Width in pixels.
    pub width: usize,
    /// Height in pixels.
    pub height: usize,
    /// Exactly `3 × width × height` numbers; at least one pixel.
    pub numbers: Vec<f32>,
}

impl FilterImage {
    /// Creates an image; `None` unless there are three numbers for each of `width × height` pixels,
    /// and at least one pixel.
    pub fn new(name: &str, width: usize, height: usize, numbers: Vec<f32>) -> Option<Self> {
        let expected = width.checked_mul(height)?.checked_mul(3)?;
        let name = CString::new(name).ok()?;
        (expected > 0 && numbers.len() == expected).then_some(Self { name, width, height, numbers })
    }
}
