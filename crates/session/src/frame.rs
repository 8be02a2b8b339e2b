//! What is shown.

/// A picture for the screen: tone mapped, 8 bits a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Counts up with every frame of the session.
    pub number: u64,
    /// How many edits it shows; see [`Session::edit`](crate::Session::edit).
    pub revision: u64,
    /// Width of the pixels here.
    pub width: u32,
    /// Height of the pixels here.
    pub height: u32,
    /// Red, green, blue, opaque, row by row from the top; `4 * width * height` bytes.
    pub rgba: Vec<u8>,
    /// Width and height of the picture that they stand for; more than of the pixels when the frame is coarse.
    pub size: [u32; 2],
    /// Samples of a pixel, the mean over the picture; 0 when the frame is coarse.
    pub samples: f32,
}
