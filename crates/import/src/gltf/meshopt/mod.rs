//! Decoder of the meshopt bitstream: glTF extensions `EXT_meshopt_compression` (version 0) and
//! `KHR_meshopt_compression` (versions 0 and 1).
//!
//! A compressed buffer view holds `count` elements of `stride` bytes. One of three codecs
//! ([`Mode`]) restores the bytes, and a [`Filter`] then converts them to what accessors read.
//! Source: appendices A and B of the extension's README (Kapoulkine et al., Khronos Group). Results
//! of filters are rounded to the nearest integer, ties to even, as the WebAssembly build of
//! `meshoptimizer` does; the README allows an error of one unit.
//!
//! ```json
//! {"buffer": 0, "byteOffset": 1024, "byteLength": 347, "byteStride": 16, "count": 148,
//!  "mode": "ATTRIBUTES", "filter": "NONE"}
//! ```

mod filters;
mod index;
mod reader;
mod sequence;
mod vertex;

#[cfg(test)]
mod tests;

/// Maximum number of decoded bytes per byte of a stream. Version 1 of the format stores 4 bytes of
/// each of 256 equal elements in one control byte.
pub const MAX_EXPANSION: u64 = 1024;

/// Number of decoded bytes that a stream of any length may have, in addition to
/// [`MAX_EXPANSION`] per byte.
pub const FREE_BYTES: u64 = 64 << 10;

/// Codec of a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Elements of any kind; the stride is a multiple of 4 from 4 to 256.
    Attributes,
    /// Indices of a triangle list; the stride is 2 or 4, and the count is a multiple of 3.
    Triangles,
    /// Indices in any order; the stride is 2 or 4.
    Indices,
}

impl Mode {
    /// Mode of this name in a glTF file: `ATTRIBUTES`, `TRIANGLES` or `INDICES`.
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Attributes, Self::Triangles, Self::Indices].into_iter().find(|mode| mode.name() == name)
    }

    /// Name in a glTF file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Attributes => "ATTRIBUTES",
            Self::Triangles => "TRIANGLES",
            Self::Indices => "INDICES",
        }
    }
}

/// Conversion of decoded attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Filter {
    /// The bytes stay as they are.
    None,
    /// Unit vectors in octahedral encoding, to normalized integers: four of 8 bits (stride 4) or of
    /// 16 bits (stride 8).
    Octahedral,
    /// Unit quaternions without their largest component, to four normalized 16-bit integers
    /// (stride 8).
    Quaternion,
    /// Mantissa and exponent as integers, to 32-bit floating point numbers (any stride).
    Exponential,
    /// Colors in YCoCg, to normalized unsigned RGBA: four integers of 8 bits (stride 4) or of 16
    /// bits (stride 8). `EXT_meshopt_compression` does not have this filter.
    Color,
}

impl Filter {
    /// Filter of this name in a glTF file: `NONE`, `OCTAHEDRAL`, `QUATERNION`, `EXPONENTIAL` or
    /// `COLOR`.
    pub fn from_name(name: &str) -> Option<Self> {
        let all = [Self::None, Self::Octahedral, Self::Quaternion, Self::Exponential, Self::Color];
        all.into_iter().find(|filter| filter.name() == name)
    }

    /// Name in a glTF file.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "NONE",
            Self::Octahedral => "OCTAHEDRAL",
            Self::Quaternion => "QUATERNION",
            Self::Exponential => "EXPONENTIAL",
            Self::Color => "COLOR",
        }
    }

    /// Condition that the filter sets on strides which its mode accepts; `None` if `stride` meets
    /// it.
    fn unmet_condition(self, stride: usize) -> Option<&'static str> {
        match (self, stride) {
            (Self::None | Self::Exponential, _) | (Self::Octahedral | Self::Color, 4 | 8) | (Self::Quaternion, 8) => {
                None
            }
            (Self::Octahedral | Self::Color, _) => Some("4 or 8"),
            (Self::Quaternion, _) => Some("8"),
        }
    }
}

/// Why a stream cannot be decoded. Bytes are counted from the first byte of the stream.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshoptError {
    /// The mode or the filter does not support the stride.
    #[error("byteStride is {stride}, {name} needs {needed}")]
    Stride {
        /// Stride in bytes.
        stride: usize,
        /// Name of the mode or filter.
        name: &'static str,
        /// Supported strides.
        needed: &'static str,
    },
    /// The mode has no filters.
    #[error("mode {mode} takes no filter, {filter} is given")]
    Filter {
        /// Name of the mode.
        mode: &'static str,
        /// Name of the filter.
        filter: &'static str,
    },
    /// The number of indices of a triangle list is not a multiple of 3.
    #[error("count is {count}, TRIANGLES needs a multiple of 3")]
    Count {
        /// Number of indices.
        count: usize,
    },
    /// The stream is too short for the number of elements that it claims to hold.
    #[error("{count} elements of {stride} bytes exceed the limit of {limit} decoded bytes for {length} bytes of input")]
    TooLarge {
        /// Number of elements.
        count: usize,
        /// Stride in bytes.
        stride: usize,
        /// Maximum number of decoded bytes.
        limit: u64,
        /// Length of the stream in bytes.
        length: usize,
    },
    /// The first byte names no supported codec and version.
    #[error("the stream begins with {}, expected {}", found.map_or("nothing".to_owned(), |byte| hex(&[byte])), hex(supported))]
    Header {
        /// First byte; `None` if the stream is empty.
        found: Option<u8>,
        /// Supported first bytes.
        supported: Vec<u8>,
    },
    /// The stream ends before all elements are decoded.
    #[error("byte {byte}: the stream ends too early")]
    Truncated {
        /// Position of the incomplete item.
        byte: usize,
    },
    /// The stream has more content than its elements need.
    #[error("byte {byte}: {count} bytes are left after the last element")]
    Unread {
        /// Position of the first unread byte.
        byte: usize,
        /// Number of unread bytes.
        count: usize,
    },
    /// An integer of variable length has more than five bytes.
    #[error("byte {byte}: an integer has more than 5 bytes")]
    LongInteger {
        /// Position of the integer.
        byte: usize,
    },
    /// A channel of an attribute stream has an unknown mode.
    #[error("channel {channel} has mode {mode:#04x}, expected 0x00, 0x01 or 0x_2")]
    ChannelMode {
        /// Number of the channel of four bytes.
        channel: usize,
        /// Byte of the mode.
        mode: u8,
    },
    /// The table at the end of a triangle stream breaks its rules.
    #[error("byte {index} of the table at the end: no half of a byte may be 15, and the last two bytes are 0")]
    Table {
        /// Position in the table.
        index: usize,
    },
    /// A triangle refers to an edge before the first one.
    #[error("triangle {triangle} refers to an edge that does not exist")]
    NoRecentEdge {
        /// Number of the triangle.
        triangle: usize,
    },
    /// A triangle refers to a vertex before the first one.
    #[error("triangle {triangle} refers to a vertex that does not exist")]
    NoRecentVertex {
        /// Number of the triangle.
        triangle: usize,
    },
}

/// Bytes in hexadecimal notation, as alternatives.
fn hex(bytes: &[u8]) -> String {
    let words: Vec<String> = bytes.iter().map(|byte| format!("{byte:#04x}")).collect();
    words.join(" or ")
}

/// Decodes a stream of `count` elements of `stride` bytes and applies the filter.
///
/// The result has `count * stride` bytes, at most [`MAX_EXPANSION`] times the length of the stream
/// and [`FREE_BYTES`]. Memory is reserved only after all sizes are checked.
///
/// # Errors
///
/// Mode, filter, count and stride do not fit each other, the result exceeds the limit, or the
/// stream violates the rules of its codec.
pub fn decode(mode: Mode, filter: Filter, count: usize, stride: usize, data: &[u8]) -> Result<Vec<u8>, MeshoptError> {
    check_parameters(mode, filter, count, stride)?;
    let limit = MAX_EXPANSION.saturating_mul(data.len() as u64).saturating_add(FREE_BYTES);
    let size = count.checked_mul(stride).filter(|size| *size as u64 <= limit);
    let size = size.ok_or(MeshoptError::TooLarge { count, stride, limit, length: data.len() })?;
    if mode == Mode::Attributes {
        let mut output = vec![0; size];
        vertex::decode(&mut output, stride, data)?;
        filters::apply(filter, stride, &mut output);
        return Ok(output);
    }
    let mut output = Vec::with_capacity(size);
    let mut emit = |index: u32| match stride {
        2 => output.extend((index as u16).to_le_bytes()),
        _ => output.extend(index.to_le_bytes()),
    };
    match mode {
        Mode::Triangles => index::decode(count / 3, data, |triangle| triangle.into_iter().for_each(&mut emit))?,
        _ => sequence::decode(count, data, emit)?,
    }
    Ok(output)
}

/// Checks that mode, filter, count and stride fit each other.
fn check_parameters(mode: Mode, filter: Filter, count: usize, stride: usize) -> Result<(), MeshoptError> {
    let (is_supported, needed) = match mode {
        Mode::Attributes => ((4..=256).contains(&stride) && stride.is_multiple_of(4), "a multiple of 4 up to 256"),
        Mode::Triangles | Mode::Indices => (matches!(stride, 2 | 4), "2 or 4"),
    };
    if !is_supported {
        return Err(MeshoptError::Stride { stride, name: mode.name(), needed });
    }
    if mode != Mode::Attributes && filter != Filter::None {
        return Err(MeshoptError::Filter { mode: mode.name(), filter: filter.name() });
    }
    if mode == Mode::Triangles && !count.is_multiple_of(3) {
        return Err(MeshoptError::Count { count });
    }
    match filter.unmet_condition(stride) {
        Some(needed) => Err(MeshoptError::Stride { stride, name: filter.name(), needed }),
        None => Ok(()),
    }
}
