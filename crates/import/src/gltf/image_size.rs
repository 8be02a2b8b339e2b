//! Sizes of pictures by their heads, without decoding.

use super::ktx2;

/// Numbers of pixels (width, height) of a PNG, JPEG, WebP or KTX2; `None` if the head cannot be
/// read.
pub fn image_size(bytes: &[u8]) -> Option<[u32; 2]> {
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        return Some([number(bytes, 16, 4)?, number(bytes, 20, 4)?]);
    }
    if bytes.starts_with(&[0xff, 0xd8]) {
        return jpeg_size(bytes);
    }
    if bytes.starts_with(b"RIFF") && bytes.get(8..12) == Some(b"WEBP") {
        return webp_size(bytes);
    }
    ktx2::read_head(bytes).ok().map(|head| [head.width, head.height])
}

/// File name extension of a PNG, JPEG or WebP by its first bytes, with the dot; empty for others.
pub fn picture_extension(bytes: &[u8]) -> &'static str {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => ".png",
        [0xff, 0xd8, ..] => ".jpg",
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => ".webp",
        _ => "",
    }
}

/// Big-endian number of `count` bytes.
fn number(bytes: &[u8], at: usize, count: usize) -> Option<u32> {
    let bytes = bytes.get(at..at.checked_add(count)?)?;
    Some(bytes.iter().fold(0, |number, byte| number << 8 | u32::from(*byte)))
}

/// Size in the first frame header of a JPEG.
fn jpeg_size(bytes: &[u8]) -> Option<[u32; 2]> {
    let mut at = 2_usize;
    // Each segment is a marker of two bytes, its length, and as many bytes as the length says.
    loop {
        let marker = number(bytes, at, 2)?;
        match marker {
            0xffff => at = at.checked_add(1)?,
            // Frame headers; C4, C8 and CC are tables.
            0xffc0..=0xffcf if !matches!(marker, 0xffc4 | 0xffc8 | 0xffcc) => {
                return Some([number(bytes, at.checked_add(7)?, 2)?, number(bytes, at.checked_add(5)?, 2)?]);
            }
            0xff01..=0xfffe => {
                let length = number(bytes, at.checked_add(2)?, 2)? as usize;
                at = at.checked_add(2)?.checked_add(length.max(2))?;
            }
            _ => return None,
        }
    }
}

/// Size in the first chunk of a WebP.
fn webp_size(bytes: &[u8]) -> Option<[u32; 2]> {
    let little = |at: usize, count: usize| {
        let bytes = bytes.get(at..at + count)?;
        Some(bytes.iter().rev().fold(0_u32, |number, byte| number << 8 | u32::from(*byte)))
    };
    match bytes.get(12..16)? {
        b"VP8X" => Some([little(24, 3)? + 1, little(27, 3)? + 1]),
        b"VP8L" => {
            let bits = little(21, 4)?;
            Some([(bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1])
        }
        b"VP8 " => Some([little(26, 2)? & 0x3fff, little(28, 2)? & 0x3fff]),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heads_tell_sizes() {
        let png = [&b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"[..], &[0, 0, 1, 0, 0, 0, 0, 7]].concat();
        assert_eq!(image_size(&png), Some([256, 7]));
        let jpeg = [&[0xff, 0xd8, 0xff, 0xe0, 0, 4, 1, 2][..], &[0xff, 0xc2, 0, 11, 8, 0, 5, 1, 0, 3]].concat();
        assert_eq!(image_size(&jpeg), Some([256, 5]));
        let webp = [&b"RIFF\0\0\0\0WEBPVP8X\x0a\0\0\0"[..], &[0, 0, 0, 0, 9, 0, 0, 4, 1, 0]].concat();
        assert_eq!(image_size(&webp), Some([10, 261]));
        for cut in [&png[..20], &jpeg[..14], &webp[..26], b"", b"\xff\xd8\xff", b"BM"] {
            assert_eq!(image_size(cut), None);
        }
    }
}
