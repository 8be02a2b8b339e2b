//! A picture as Open Image Denoise reads it.

use std::ffi::CString;

/// Three numbers a pixel, row by row from the top left.
#[cfg_attr(target_family = "wasm", allow(dead_code, reason = "nothing reads a picture where no library can be opened"))]
pub(crate) struct Image {
    /// The filter's name for it: `color`, `albedo` or `normal`.
    pub name: CString,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Exactly `3 × width × height` numbers; at least one pixel.
    pub numbers: Vec<f32>,
}

impl Image {
    /// `None` unless there are three numbers for each of `width × height` pixels, and any.
    pub fn new(name: &str, width: usize, height: usize, numbers: Vec<f32>) -> Option<Self> {
        let wanted = width.checked_mul(height)?.checked_mul(3)?;
        let name = CString::new(name).ok()?;
        (wanted > 0 && numbers.len() == wanted).then_some(Self { name, width, height, numbers })
    }
}
