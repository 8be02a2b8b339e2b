//! Colors of vertices and faces of a PLY: `red green blue` and perhaps `alpha`. Integers are
//! encoded as sRGB, as MeshLab and Blender write them; numbers of type float are linear.

use super::header::{Element, Scalar};
use juggler_math::color::srgb_decode;

const NAMES: [[&str; 4]; 2] =
    [["red", "green", "blue", "alpha"], ["diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"]];

/// Columns of a color, and their decoder.
pub(super) struct ColorColumns {
    /// Columns of red, green, blue and perhaps alpha.
    columns: Vec<usize>,
    /// Linear values of the integers from 0 to 255, for colors of that type.
    levels: Vec<f32>,
    /// Largest value of the type; 1 for numbers of type float, which are not decoded.
    largest: f32,
}

impl ColorColumns {
    /// Colors of an element; `None` unless red, green and blue are numbers of one type that has
    /// colors.
    pub fn of(element: &Element) -> Option<Self> {
        NAMES.iter().find_map(|names| {
            let number = |name: &str| {
                let column = element.column(name)?;
                let property = element.properties.get(column).filter(|property| property.length.is_none())?;
                Some((column, property.item))
            };
            let [red, green, blue, alpha] = names.map(number);
            let (first, kind) = red?;
            let mut columns = vec![first, green.filter(|(_, item)| *item == kind)?.0];
            columns.push(blue.filter(|(_, item)| *item == kind)?.0);
            columns.extend(alpha.filter(|(_, item)| *item == kind).map(|(column, _)| column));
            let largest = match kind {
                Scalar::U8 => 255.0,
                Scalar::U16 => 65535.0,
                Scalar::F32 | Scalar::F64 => 1.0,
                _ => return None,
            };
            let levels = (0..=255_u8).filter(|_| kind == Scalar::U8);
            let levels = levels.map(|level| srgb_decode(f32::from(level) / 255.0)).collect();
            Some(Self { columns, levels, largest })
        })
    }

    /// Number of channels: 3 or 4.
    pub fn channels(&self) -> usize {
        self.columns.len()
    }

    /// Channel of a column; `None` for other columns.
    pub fn channel(&self, column: usize) -> Option<usize> {
        self.columns.iter().position(|other| *other == column)
    }

    /// Linear value of a number in the file.
    pub fn linear(&self, channel: usize, number: f32) -> f32 {
        if self.largest == 1.0 {
            return number;
        }
        match self.levels.get(number as usize) {
            _ if channel == 3 => number / self.largest,
            Some(level) => *level,
            None => srgb_decode(number / self.largest),
        }
    }

    /// Bytes of a color in the mesh.
    pub fn bytes(&self) -> u64 {
        4 * self.channels() as u64
    }
}
