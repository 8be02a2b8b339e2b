//! Head of a KTX 2.0 file with a Basis Universal picture (extension `KHR_texture_basisu`), checked
//! before a decoder sees the file.
//!
//! Source: Khronos, "KTX File Format Specification" 2.0, sections 3 to 5. The head has an
//! identifier, the sizes of the picture, an index of four blocks, and one entry per level. The
//! decoder reserves what these numbers demand, so all of them are checked against the length of the
//! file first.

use std::ops::RangeInclusive;

/// Maximum width and height of a picture, in texels.
pub const MAX_SIDE: u32 = 1 << 14;

const IDENTIFIER: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";
const MAX_LEVELS: u32 = 15;
/// Position of the first entry of the level index.
const LEVELS: usize = 80;
/// Size of an entry of the level index, in bytes.
const LEVEL: usize = 24;
/// Size of the head of the global data of ETC1S, and of its entry per level, in bytes.
const GLOBAL_ENTRY: u64 = 20;

/// Encoding of the texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ktx2Encoding {
    /// ETC1S with BasisLZ supercompression.
    Etc1s,
    /// UASTC, with or without Zstandard supercompression.
    Uastc,
}

/// What the head of a file says about its picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ktx2Head {
    /// Width of level 0 in texels, 1 to [`MAX_SIDE`].
    pub width: u32,
    /// Height of level 0 in texels, 1 to [`MAX_SIDE`].
    pub height: u32,
    /// Number of levels of the mipmap pyramid, 1 to 15.
    pub levels: u32,
    /// Encoding of the texels.
    pub encoding: Ktx2Encoding,
}

/// Why a KTX2 file cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Ktx2Error {
    /// This build has no decoder.
    #[error("KHR_texture_basisu cannot be read: this program was built without the feature `ktx2`")]
    Disabled,
    /// The file does not begin as a KTX2 file does.
    #[error("not a KTX2 file")]
    NotKtx2,
    /// The file ends inside of its head.
    #[error("the head needs {needed} bytes, the file has {length}")]
    Truncated {
        /// Number of bytes that the head needs.
        needed: usize,
        /// Length of the file in bytes.
        length: usize,
    },
    /// A field of the head has a value that is invalid or not supported.
    #[error("{field} is {value}, expected {expected}")]
    Field {
        /// Name of the field in the specification.
        field: &'static str,
        /// Value in the file.
        value: u64,
        /// Supported values.
        expected: &'static str,
    },
    /// A range of bytes does not lie inside of what contains it.
    #[error("{block} has {size} bytes from byte {start}, {container} has {length}")]
    Range {
        /// Name of the block.
        block: &'static str,
        /// Position of its first byte.
        start: u64,
        /// Number of bytes.
        size: u64,
        /// Name of what contains the block.
        container: &'static str,
        /// Length of the container in bytes.
        length: u64,
    },
    /// The picture exceeds the limit of the caller.
    #[error("the picture has {width} × {height} texels, the limit is {limit}")]
    TooLarge {
        /// Width in texels.
        width: u32,
        /// Height in texels.
        height: u32,
        /// Maximum number of texels.
        limit: u64,
    },
    /// The decoder refused the content.
    #[error("the picture cannot be decoded: {message}")]
    Decoder {
        /// Message of the decoder.
        message: String,
    },
}

/// Reads and checks the head of a file.
///
/// # Errors
///
/// The file is not KTX2, has a picture that `KHR_texture_basisu` does not allow (an array, a cube
/// map, a volume, another encoding), or its blocks do not lie inside of the file.
pub fn read_head(file: &[u8]) -> Result<Ktx2Head, Ktx2Error> {
    if !file.starts_with(&IDENTIFIER) {
        return Err(Ktx2Error::NotKtx2);
    }
    let head = Fields { file };
    head.expect("vkFormat", 12, 0..=0, "0")?;
    head.expect("typeSize", 16, 1..=1, "1")?;
    let width = head.expect("pixelWidth", 20, 1..=MAX_SIDE, "1 to 16384")?;
    let height = head.expect("pixelHeight", 24, 1..=MAX_SIDE, "1 to 16384")?;
    head.expect("pixelDepth", 28, 0..=0, "0")?;
    head.expect("layerCount", 32, 0..=1, "0 or 1")?;
    head.expect("faceCount", 36, 1..=1, "1")?;
    let levels = head.expect("levelCount", 40, 1..=MAX_LEVELS, "1 to 15")?;
    let scheme = head.expect("supercompressionScheme", 44, 0..=2, "0, 1 or 2")?;
    let (model, has_alpha) = head.descriptor()?;
    let encoding = match (model, scheme) {
        (163, 1) => Ktx2Encoding::Etc1s,
        (166, 0 | 2) => Ktx2Encoding::Uastc,
        _ => {
            let expected = "163 (ETC1S) with scheme 1, or 166 (UASTC) with scheme 0 or 2";
            return Err(Ktx2Error::Field { field: "colorModel", value: u64::from(model), expected });
        }
    };
    head.range("the key/value data", head.u32(56)?.into(), head.u32(60)?.into())?;
    for level in 0..levels {
        let sides = [width, height].map(|side| u64::from((side >> level).max(1).div_ceil(4)));
        head.level(level, scheme, sides[0] * sides[1])?;
    }
    if encoding == Ktx2Encoding::Etc1s {
        head.global_data(levels, has_alpha)?;
    }
    Ok(Ktx2Head { width, height, levels, encoding })
}

/// Fields of a head.
struct Fields<'a> {
    file: &'a [u8],
}

impl Fields<'_> {
    fn bytes<const N: usize>(&self, position: usize) -> Result<[u8; N], Ktx2Error> {
        let bytes = self.file.get(position..).and_then(|rest| rest.first_chunk());
        let needed = position.saturating_add(N);
        bytes.copied().ok_or(Ktx2Error::Truncated { needed, length: self.file.len() })
    }

    fn u32(&self, position: usize) -> Result<u32, Ktx2Error> {
        self.bytes(position).map(u32::from_le_bytes)
    }

    fn u64(&self, position: usize) -> Result<u64, Ktx2Error> {
        self.bytes(position).map(u64::from_le_bytes)
    }

    /// Reads a field whose value must be in `range`.
    fn expect(
        &self,
        field: &'static str,
        position: usize,
        range: RangeInclusive<u32>,
        expected: &'static str,
    ) -> Result<u32, Ktx2Error> {
        let value = self.u32(position)?;
        if range.contains(&value) {
            return Ok(value);
        }
        Err(Ktx2Error::Field { field, value: u64::from(value), expected })
    }

    /// Checks that a block lies inside of the file.
    fn range(&self, block: &'static str, start: u64, size: u64) -> Result<(), Ktx2Error> {
        inside(block, start, size, "the file", self.file.len() as u64)
    }

    /// Color model of the data format descriptor, and whether a picture of ETC1S has alpha.
    fn descriptor(&self) -> Result<(u8, bool), Ktx2Error> {
        let (start, size) = (self.u32(48)?, self.u32(52)?);
        if !matches!(size, 44 | 60) {
            let expected = "44 or 60";
            return Err(Ktx2Error::Field { field: "dfdByteLength", value: size.into(), expected });
        }
        self.range("the data format descriptor", start.into(), size.into())?;
        let [model, _, transfer, _] = self.bytes((start as usize).saturating_add(12))?;
        if !matches!(transfer, 1 | 2) {
            let expected = "1 (linear) or 2 (sRGB)";
            return Err(Ktx2Error::Field { field: "transferFunction", value: transfer.into(), expected });
        }
        Ok((model, size == 60))
    }

    /// Checks a level of this number of blocks of 4×4 texels.
    fn level(&self, level: u32, scheme: u32, blocks: u64) -> Result<(), Ktx2Error> {
        let position = LEVELS + LEVEL * level as usize;
        let (start, size, decoded) = (self.u64(position)?, self.u64(position + 8)?, self.u64(position + 16)?);
        self.range("a level", start, size)?;
        let is_valid = match scheme {
            0 => decoded == blocks * 16 && size == decoded,
            1 => decoded == 0,
            _ => decoded == blocks * 16,
        };
        if is_valid {
            return Ok(());
        }
        let expected = "16 bytes per block of 4×4 texels, or 0 with scheme 1";
        Err(Ktx2Error::Field { field: "uncompressedByteLength", value: decoded, expected })
    }

    /// Checks the codebooks of ETC1S, and where they say that the levels are.
    fn global_data(&self, levels: u32, has_alpha: bool) -> Result<(), Ktx2Error> {
        let (start, size) = (self.u64(64)?, self.u64(72)?);
        self.range("the global data", start, size)?;
        let position = usize::try_from(start).unwrap_or(usize::MAX);
        let mut used = GLOBAL_ENTRY * (1 + u64::from(levels));
        inside("the head of the global data", 0, used, "the global data", size)?;
        // The lengths of endpoints, selectors, tables and extended data.
        for offset in [4, 8, 12, 16] {
            used += u64::from(self.u32(position + offset)?);
        }
        inside("the content of the global data", 0, used, "the global data", size)?;
        for level in 0..levels as usize {
            let length = self.u64(LEVELS + LEVEL * level + 8)?;
            let entry = position + GLOBAL_ENTRY as usize * (1 + level);
            for offset in [4, 12].into_iter().take(1 + usize::from(has_alpha)) {
                let (start, size) = (self.u32(entry + offset)?, self.u32(entry + offset + 4)?);
                inside("a slice", start.into(), size.into(), "its level", length)?;
            }
        }
        Ok(())
    }
}

/// Checks that a block lies inside of a container of this length.
fn inside(block: &'static str, start: u64, size: u64, container: &'static str, length: u64) -> Result<(), Ktx2Error> {
    if start.checked_add(size).is_some_and(|end| end <= length) {
        return Ok(());
    }
    Err(Ktx2Error::Range { block, start, size, container, length })
}
