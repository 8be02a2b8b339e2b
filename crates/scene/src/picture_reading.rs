//! What is read of the pictures of textures.

/// What is read of the pictures of textures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureReading {
    /// All pixels.
    #[default]
    Whole,
    /// The heads, which are checked; one texel stands for the pixels.
    Heads,
}
