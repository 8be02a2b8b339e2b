//! Orientation of pictures by Exif (CIPA DC-008, tag 0x0112): cameras store rows as the sensor has
//! them, and state how to turn them. Readers turn the pixels, as browsers and Pillow do.

use crate::codec::tiff::directory::Directory;
use std::io::Cursor;

/// Orientation that an Exif block states.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Orientation {
    /// Whether rows become columns; applied before the others.
    transposes: bool,
    /// Whether left and right are exchanged.
    mirrors_x: bool,
    /// Whether top and bottom are exchanged.
    mirrors_y: bool,
}

pub(crate) const ORIENTATION: u16 = 0x0112;

impl Orientation {
    /// Orientation of one of the eight codes; the stored one for other codes.
    pub(crate) fn from_code(code: u16) -> Self {
        let [transposes, mirrors_x, mirrors_y] = match code {
            2 => [false, true, false],
            3 => [false, true, true],
            4 => [false, false, true],
            5 => [true, false, false],
            6 => [true, true, false],
            7 => [true, true, true],
            8 => [true, false, true],
            _ => [false; 3],
        };
        Self { transposes, mirrors_x, mirrors_y }
    }

    /// Orientation that an Exif block states; the stored one if there is none.
    pub fn from_exif(exif: Option<&[u8]>) -> Self {
        exif.and_then(code).map_or_else(Self::default, Self::from_code)
    }

    /// Width and height of the turned picture.
    pub fn size<T>(self, (width, height): (T, T)) -> (T, T) {
        if self.transposes { (height, width) } else { (width, height) }
    }

    /// Turns pixels of `channels` samples; `size` is that of the file. Returns them unchanged if
    /// their number is not that of the size.
    pub fn turn<T: Copy>(self, pixels: Vec<T>, (width, height): (u32, u32), channels: usize) -> Vec<T> {
        let (columns, rows) = (width as usize, height as usize);
        let count = columns.checked_mul(rows).and_then(|count| count.checked_mul(channels));
        if self == Self::default() || count != Some(pixels.len()) {
            return pixels;
        }
        let (width, height) = self.size((columns, rows));
        let mut turned = Vec::with_capacity(pixels.len());
        for y in 0..height {
            let y = if self.mirrors_y { height - 1 - y } else { y };
            for x in 0..width {
                let x = if self.mirrors_x { width - 1 - x } else { x };
                let (column, row) = if self.transposes { (y, x) } else { (x, y) };
                let start = (row * columns + column) * channels;
                turned.extend_from_slice(pixels.get(start..start + channels).unwrap_or_default());
            }
        }
        turned
    }
}

/// Code of the tag in the first directory of an Exif block.
fn code(exif: &[u8]) -> Option<u16> {
    let mut tiff = Cursor::new(exif.strip_prefix(b"Exif\0\0").unwrap_or(exif));
    let directory = Directory::first(&mut tiff).ok()??;
    directory.number(ORIENTATION)?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exif block with the orientation after another tag, in either byte order.
    fn exif(code: u8, is_little: bool) -> Vec<u8> {
        let number = |value: u32, bytes: usize| {
            let all = value.to_le_bytes();
            let mut bytes = all[..bytes].to_vec();
            if !is_little {
                bytes.reverse();
            }
            bytes
        };
        let order: &[u8] = if is_little { b"II" } else { b"MM" };
        let entry = |tag, value| [number(tag, 2), number(3, 2), number(1, 4), number(value, 2), vec![0; 2]].concat();
        [order.to_vec(), number(42, 2), number(8, 4), number(2, 2), entry(0x0103, 6), entry(0x0112, code.into())]
            .concat()
    }

    /// The picture is 1 2 3 above 4 5 6; each code states how the file stores it.
    #[test]
    fn eight_orientations_give_one_picture() {
        let stored: [(u8, (u32, u32), [u8; 6]); 8] = [
            (1, (3, 2), [1, 2, 3, 4, 5, 6]),
            (2, (3, 2), [3, 2, 1, 6, 5, 4]),
            (3, (3, 2), [6, 5, 4, 3, 2, 1]),
            (4, (3, 2), [4, 5, 6, 1, 2, 3]),
            (5, (2, 3), [1, 4, 2, 5, 3, 6]),
            (6, (2, 3), [3, 6, 2, 5, 1, 4]),
            (7, (2, 3), [6, 3, 5, 2, 4, 1]),
            (8, (2, 3), [4, 1, 5, 2, 6, 3]),
        ];
        for (code, size, pixels) in stored {
            for is_little in [true, false] {
                let block = exif(code, is_little);
                let orientation = Orientation::from_exif(Some(&block));
                assert_eq!(Orientation::from_exif(Some(&[b"Exif\0\0", block.as_slice()].concat())), orientation);
                assert_eq!(orientation.size(size), (3, 2), "{code}");
                assert_eq!(orientation.turn(pixels.to_vec(), size, 1), [1, 2, 3, 4, 5, 6], "{code}");
                let doubled: Vec<u8> = pixels.iter().flat_map(|value| [*value, 0]).collect();
                assert_eq!(orientation.turn(doubled, size, 2), [1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0], "{code}");
            }
        }
    }

    #[test]
    fn damaged_blocks_state_nothing() {
        let block = exif(6, true);
        for length in 0..block.len() - 3 {
            assert_eq!(Orientation::from_exif(Some(&block[..length])), Orientation::default(), "{length}");
        }
        for other in [exif(0, true), exif(9, false), [b"II*\0".as_slice(), &[255; 4]].concat(), b"MM\0*".to_vec()] {
            assert_eq!(Orientation::from_exif(Some(&other)), Orientation::default());
        }
        assert_eq!(Orientation::from_exif(None).turn(vec![1, 2], (1, 2), 1), [1, 2]);
    }
}
