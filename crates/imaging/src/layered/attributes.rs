//! OpenEXR headers: a list of attributes, each with name, type and value, in a fixed order, so that
//! equal images are equal files. (OpenEXR file layout, openexr.com.)

use crate::tone::Chromaticities;
use crate::{CropFrame, ExrCompression, ExrWindows, PixelWindow, SampleDepth, Viewpoint};

const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// Format version, and the flags for long names and for multi-part files.
const VERSION: u32 = 2;
const LONG_NAMES: u32 = 0x400;
const MULTI_PART: u32 = 0x1000;
/// Maximum length of names in bytes, without and with the flag for long names.
const SHORT: usize = 31;
const LONG: usize = 255;

/// Magic number and version of a file with names of up to `longest` bytes.
pub fn start(longest: usize, has_several_parts: bool) -> Vec<u8> {
    let long = if longest > SHORT { LONG_NAMES } else { 0 };
    let several = if has_several_parts { MULTI_PART } else { 0 };
    MAGIC.into_iter().chain((VERSION | long | several).to_le_bytes()).collect()
}

/// Attributes of one part.
#[derive(Debug, Default)]
pub struct Attributes {
    bytes: Vec<u8>,
}

impl Attributes {
    /// Appends an attribute.
    pub fn put(&mut self, name: &str, kind: &str, value: &[u8]) {
        self.bytes.extend(name.bytes().filter(|&b| b != 0).take(LONG).chain([0]));
        self.bytes.extend(kind.bytes().chain([0]));
        self.bytes.extend((value.len() as u32).to_le_bytes());
        self.bytes.extend(value);
    }

    /// Appends the channel list; `names` are sorted.
    pub fn channels<'n>(&mut self, names: impl Iterator<Item = &'n str>, depth: SampleDepth) {
        let pixel_type = if depth == SampleDepth::Half { 1u32 } else { 2 };
        let mut channels = Vec::new();
        for name in names {
            channels.extend(name.bytes().filter(|&b| b != 0).chain([0]));
            channels.extend([pixel_type, 0, 1, 1].into_iter().flat_map(u32::to_le_bytes));
        }
        channels.push(0);
        self.put("channels", "chlist", &channels);
    }

    /// Appends the chromaticities of primaries and white point.
    pub fn chromaticities(&mut self, Chromaticities { red, green, blue, white }: Chromaticities) {
        let eight = [red, green, blue, white].into_iter().flatten();
        self.put("chromaticities", "chromaticities", &floats(eight.map(|v| v as f32)));
    }

    /// Appends the other required attributes: compression, windows of an image of this size, which
    /// may be a crop, scanlines from the top, square pixels.
    pub fn frame(&mut self, size: [u32; 2], crop: Option<CropFrame>, compression: ExrCompression) {
        let code = match compression {
            ExrCompression::None => 0,
            ExrCompression::Rle => 1,
            ExrCompression::Zip => 3,
        };
        let window = |PixelWindow { x, y, width, height }: PixelWindow| -> Vec<u8> {
            let last = [(x, width), (y, height)].map(|(first, size)| first.saturating_add_unsigned(size) - 1);
            [x, y].into_iter().chain(last).flat_map(|edge| (edge as i32).to_le_bytes()).collect()
        };
        let ExrWindows { data, display } = ExrWindows::new(size, crop);
        self.put("compression", "compression", &[code]);
        self.put("dataWindow", "box2i", &window(data));
        self.put("displayWindow", "box2i", &window(display));
        self.put("lineOrder", "lineOrder", &[0]);
        self.put("pixelAspectRatio", "float", &1f32.to_le_bytes());
        self.put("screenWindowCenter", "v2f", &[0; 8]);
        self.put("screenWindowWidth", "float", &1f32.to_le_bytes());
    }

    /// Appends the attributes that multi-part files require.
    pub fn part(&mut self, name: &str, blocks: usize) {
        self.put("chunkCount", "int", &(blocks as u32).to_le_bytes());
        self.put("name", "string", name.as_bytes());
        self.put("type", "string", b"scanlineimage");
    }

    /// Appends the camera matrices.
    pub fn viewpoint(&mut self, viewpoint: &Viewpoint) {
        let Viewpoint { world_to_camera, world_to_ndc } = viewpoint;
        for (name, matrix) in [("worldToCamera", world_to_camera), ("worldToNDC", world_to_ndc)] {
            self.put(name, "m44f", &floats(matrix.iter().flatten().copied()));
        }
    }

    /// Appends metadata as strings; pairs without a key are omitted.
    pub fn texts<'t>(&mut self, texts: impl Iterator<Item = &'t (String, String)>) {
        texts.filter(|(key, _)| !key.is_empty()).for_each(|(key, text)| self.put(key, "string", text.as_bytes()));
    }

    /// Returns the header with its terminating zero.
    pub fn finish(mut self) -> Vec<u8> {
        self.bytes.push(0);
        self.bytes
    }
}

fn floats(values: impl Iterator<Item = f32>) -> Vec<u8> {
    values.flat_map(f32::to_le_bytes).collect()
}
