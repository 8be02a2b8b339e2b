//! Named attributes of a mesh: numbers per vertex or per face, such as vertex colors (as in glTF
//! 2.0, section 3.7.2.1, and in the element `face` of a PLY).

use crate::InvalidShape;
use crate::check::{self, invalid};
use juggler_math::Vec2;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Part of a mesh that has one value of an attribute each.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum AttributeDomain {
    /// One value per position, interpolated over each triangle.
    #[default]
    Vertex,
    /// One value per triangle, constant over it.
    Face,
}

/// Numbers of an attribute, all channels of the first value first. Integers are normalized: the
/// largest one stands for 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "AttributeArray")]
pub enum AttributeData {
    /// Integers from 0 to 255, which stand for 0 to 1.
    U8(Vec<u8>),
    /// Integers from 0 to 65535, which stand for 0 to 1.
    U16(Vec<u16>),
    /// Numbers of any size.
    F32(Vec<f32>),
}

impl Default for AttributeData {
    fn default() -> Self {
        Self::F32(Vec::new())
    }
}

impl AttributeData {
    /// Number of stored numbers.
    pub fn len(&self) -> usize {
        match self {
            Self::U8(values) => values.len(),
            Self::U16(values) => values.len(),
            Self::F32(values) => values.len(),
        }
    }

    /// Whether no numbers are stored.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        match self {
            Self::U8(values) => size_of_val(values.as_slice()),
            Self::U16(values) => size_of_val(values.as_slice()),
            Self::F32(values) => size_of_val(values.as_slice()),
        }
    }

    /// Number at an index; 0 beyond the end.
    fn number(&self, index: usize) -> f32 {
        match self {
            Self::U8(values) => values.get(index).map_or(0.0, |value| f32::from(*value) / 255.0),
            Self::U16(values) => values.get(index).map_or(0.0, |value| f32::from(*value) / 65535.0),
            Self::F32(values) => values.get(index).copied().unwrap_or(0.0),
        }
    }

    /// Runs of `channels` numbers at these indices, one after the other. Indices beyond the end are
    /// left out.
    fn selected(&self, channels: usize, indices: impl Iterator<Item = usize>) -> Self {
        fn select<T: Copy>(values: &[T], channels: usize, indices: impl Iterator<Item = usize>) -> Vec<T> {
            indices.filter_map(|index| values.chunks_exact(channels).nth(index)).flatten().copied().collect()
        }
        match self {
            Self::U8(values) => Self::U8(select(values, channels, indices)),
            Self::U16(values) => Self::U16(select(values, channels, indices)),
            Self::F32(values) => Self::F32(select(values, channels, indices)),
        }
    }
}

/// Number at barycentrics of the second and third corner, between the numbers of three corners.
pub fn interpolate([a, b, c]: [f32; 3], at: Vec2) -> f32 {
    a * (1.0 - at.x - at.y) + b * at.x + c * at.y
}

/// Named attribute of a mesh, for the texture `attribute`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "MeshAttribute")]
pub struct MeshAttribute {
    /// Whether each vertex or each triangle has a value.
    #[serde(default)]
    pub domain: AttributeDomain,
    /// Numbers per value, 1 to 4: gray; red and green; red, green and blue; red, green, blue and
    /// alpha.
    #[schemars(range(min = 1, max = 4))]
    pub channels: u32,
    /// Numbers of all values, in linear light: `channels` for each vertex or triangle, in the order
    /// of `positions` or `triangles`.
    pub data: AttributeData,
}

impl MeshAttribute {
    /// Creates an attribute of the vertices with this many numbers per value, 1 to 4.
    pub fn new(channels: u32, data: AttributeData) -> Self {
        Self { channels, data, domain: AttributeDomain::Vertex }
    }

    /// Numbers of the value of a vertex or triangle, one per channel; 0 beyond the end.
    pub fn numbers(&self, index: usize) -> impl Iterator<Item = f32> {
        let channels = self.channels as usize;
        let first = index.saturating_mul(channels);
        (0..channels).map(move |channel| self.data.number(first.saturating_add(channel)))
    }

    /// Checks the number of values and that all are finite; the error names the field.
    pub(crate) fn check(&self, name: &str, positions: usize, triangles: usize) -> Result<(), InvalidShape> {
        match self.domain {
            AttributeDomain::Vertex => self.check_values(name, positions, "positions"),
            AttributeDomain::Face => self.check_values(name, triangles, "triangles"),
        }
    }

    /// Checks the number of channels, that there are as many `values` as `owners`, such as
    /// `positions`, and that all numbers are finite.
    ///
    /// # Errors
    ///
    /// The error names the field of the attribute `name` in `attributes`.
    pub fn check_values(&self, name: &str, values: usize, owners: &str) -> Result<(), InvalidShape> {
        let field = |part: &str| format!("attributes.{name}.{part}");
        if !(1..=4).contains(&self.channels) {
            let message =
                format!("`channels` of the attribute `{name}` in `attributes` must be 1 to 4, it is {}", self.channels);
            return Err(invalid(field("channels"), message));
        }
        let (found, channels) = (self.data.len(), self.channels);
        if values.checked_mul(channels as usize) != Some(found) {
            let message = format!(
                "the attribute `{name}` in `attributes` must have {channels} numbers for each of the {values} {owners}, it has {found}"
            );
            return Err(invalid(field("data"), message));
        }
        let AttributeData::F32(numbers) = &self.data else { return Ok(()) };
        match numbers.iter().position(|number| number.is_nan() || number.abs() > check::MAX_LENGTH) {
            Some(at) => Err(invalid(
                format!("attributes.{name}.data.f32[{at}]"),
                format!(
                    "numbers of the attribute `{name}` in `attributes` must be finite, and at most {:e}",
                    check::MAX_LENGTH
                ),
            )),
            None => Ok(()),
        }
    }

    /// Attribute of a mesh whose positions are those of the original mesh at these indices; values of
    /// triangles stay. Indices beyond the end are left out.
    pub fn with_positions(&self, originals: impl Iterator<Item = usize>) -> Self {
        match self.domain {
            AttributeDomain::Vertex => {
                Self { data: self.data.selected(self.channels.max(1) as usize, originals), ..self.clone() }
            }
            AttributeDomain::Face => self.clone(),
        }
    }

    /// Value of an instance, or of a triangle, as [`MeshPoint::attribute`](crate::MeshPoint::attribute)
    /// returns it. The values of the attribute belong to faces.
    pub fn constant_value(&self, index: usize) -> [f32; 4] {
        self.value(index, [0; 3], Vec2::ZERO)
    }

    /// Value on a triangle with these corners, at barycentrics of the second and third corner: red,
    /// green, blue and alpha. One channel is gray; missing alpha is 1, missing blue 0.
    pub(crate) fn value(&self, triangle: usize, corners: [u32; 3], at: Vec2) -> [f32; 4] {
        let channels = self.channels as usize;
        let number =
            |index: usize, channel: usize| self.data.number(index.saturating_mul(channels).saturating_add(channel));
        let channel = |channel: usize| match self.domain {
            AttributeDomain::Face => number(triangle, channel),
            AttributeDomain::Vertex => interpolate(corners.map(|corner| number(corner as usize, channel)), at),
        };
        match channels {
            1 => {
                let gray = channel(0);
                [gray, gray, gray, 1.0]
            }
            2 => [channel(0), channel(1), 0.0, 1.0],
            3 => [channel(0), channel(1), channel(2), 1.0],
            _ => [channel(0), channel(1), channel(2), channel(3)],
        }
    }
}
