//! Displayable frames.

/// Tone-mapped image for display, with 8 bits per channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Sequence number, which increases with every frame of the session.
    pub number: u64,
    /// Number of edits that the frame includes; see [`Session::edit`](crate::Session::edit).
    pub revision: u64,
    /// Width of `rgba`, in pixels.
    pub width: u32,
    /// Height of `rgba`, in pixels.
    pub height: u32,
    /// RGBA pixels with alpha 255, row by row from the top; `4 * width * height` bytes.
    pub rgba: Vec<u8>,
    /// Width and height of the full-resolution image; larger than `width` and `height` for a coarse
    /// frame.
    pub size: [u32; 2],
    /// Mean number of samples per pixel; 0 for a coarse frame.
    pub samples: f32,
}
