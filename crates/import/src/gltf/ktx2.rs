//! Pictures of the extension `KHR_texture_basisu`, by the crate `basisu` (feature `ktx2`).
//!
//! [`read_head`] checks a file before the decoder sees it. Without the feature, [`decode`] refuses
//! every file with [`Ktx2Error::Disabled`].

pub use super::ktx2_head::{Ktx2Encoding, Ktx2Error, Ktx2Head, MAX_SIDE, read_head};

/// Level 0 of a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ktx2Picture {
    /// Width in texels.
    pub width: u32,
    /// Height in texels.
    pub height: u32,
    /// Red, green, blue and alpha of each texel, row by row from the first in the file, 4 bytes per
    /// texel. Alpha is 255 where the picture has none.
    pub rgba: Vec<u8>,
}

/// Decodes level 0 of a KTX2 file with ETC1S or UASTC texels, at most `max_texels` of them.
/// Metadata (swizzle, orientation) is ignored, as the extension says.
///
/// # Errors
///
/// Always [`Ktx2Error::Disabled`]: this build has no decoder.
#[cfg(not(feature = "ktx2"))]
pub fn decode(_file: &[u8], _max_texels: u64) -> Result<Ktx2Picture, Ktx2Error> {
    Err(Ktx2Error::Disabled)
}

/// Decodes level 0 of a KTX2 file with ETC1S or UASTC texels, at most `max_texels` of them.
/// Metadata (swizzle, orientation) is ignored, as the extension says.
///
/// # Errors
///
/// The head breaks a rule of [`read_head`], the picture exceeds the limit, or the content is
/// damaged.
#[cfg(feature = "ktx2")]
pub fn decode(file: &[u8], max_texels: u64) -> Result<Ktx2Picture, Ktx2Error> {
    use basisu::{DecodeFlags, TargetFormat, Transcoder};
    let head = read_head(file)?;
    let count = u64::from(head.width) * u64::from(head.height);
    if count > max_texels {
        return Err(Ktx2Error::TooLarge { width: head.width, height: head.height, limit: max_texels });
    }
    // Remove the range of the metadata, which the decoder would search.
    let mut checked = file.to_vec();
    checked.get_mut(56..64).unwrap_or_default().fill(0);
    let refused = |error: basisu::Error| Ktx2Error::Decoder { message: format!("{error:?}") };
    let transcoder = Transcoder::new(&checked).map_err(refused)?;
    let rgba = transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(refused)?;
    if rgba.len() as u64 != 4 * count {
        let message = format!("{} bytes for {} × {} texels", rgba.len(), head.width, head.height);
        return Err(Ktx2Error::Decoder { message });
    }
    Ok(Ktx2Picture { width: head.width, height: head.height, rgba })
}

#[cfg(test)]
mod tests;
