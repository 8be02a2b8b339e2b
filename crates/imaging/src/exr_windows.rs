//! Windows of an EXR file: the data window holds pixels, the display window is the image (OpenEXR,
//! "Reading and Writing OpenEXR Image Files"). Pixels outside of the display window (overscan) are
//! cut, and those without data are black.

use std::fmt;

/// Rectangle of pixels with integer coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelWindow {
    /// Left column.
    pub x: i64,
    /// Top row.
    pub y: i64,
    /// Width in pixels.
    pub width: u64,
    /// Height in pixels.
    pub height: u64,
}

impl fmt::Display for PixelWindow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { x, y, width, height } = self;
        write!(f, "{width}x{height} at {x}, {y}")
    }
}

/// Windows of the first part of an EXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExrWindows {
    /// Pixels that the file stores.
    pub data: PixelWindow,
    /// Pixels of the image.
    pub display: PixelWindow,
}

impl ExrWindows {
    /// Windows of an image of `size` pixels, which may be a crop.
    pub fn new(size: [u32; 2], crop: Option<CropFrame>) -> Self {
        let CropFrame { size: frame, corner } = crop.unwrap_or(CropFrame { size, corner: [0, 0] });
        let window = |[x, y]: [u32; 2], [width, height]: [u32; 2]| PixelWindow {
            x: x.into(),
            y: y.into(),
            width: width.into(),
            height: height.into(),
        };
        Self { data: window(corner, size), display: window([0, 0], frame) }
    }
}

/// Frame that an image is a crop of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CropFrame {
    /// Width and height of the frame in pixels.
    pub size: [u32; 2],
    /// Column and row of the image's top left pixel in the frame.
    pub corner: [u32; 2],
}

impl CropFrame {
    /// Frame of `frame` pixels around an image of `size` pixels at `corner`; `None` if the image is
    /// the whole frame.
    pub fn new(frame: [u32; 2], corner: [u32; 2], size: [u32; 2]) -> Option<Self> {
        (frame != size).then_some(Self { size: frame, corner })
    }
}
