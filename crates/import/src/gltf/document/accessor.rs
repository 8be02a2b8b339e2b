//! Accessors: typed arrays in buffer views (glTF 2.0, section 3.6.2).

use super::number::{Index, Size};
use serde::Deserialize;

/// A typed array. Without a buffer view, all elements are zero.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Accessor {
    /// Index of the buffer view.
    pub buffer_view: Option<Index>,
    /// Position of the first element in the buffer view, in bytes.
    #[serde(default)]
    pub byte_offset: Size,
    /// Type of the components.
    pub component_type: ComponentType,
    /// Whether integers stand for numbers from 0 to 1, or from -1 to 1.
    #[serde(default)]
    pub normalized: bool,
    /// Number of elements.
    pub count: Size,
    /// Type of the elements.
    #[serde(rename = "type")]
    pub element_type: ElementType,
    /// Largest value of each component. It is not trusted.
    #[serde(default)]
    pub max: Vec<f64>,
    /// Smallest value of each component. It is not trusted.
    #[serde(default)]
    pub min: Vec<f64>,
    /// Elements that differ from those in the buffer view.
    pub sparse: Option<Box<Sparse>>,
    /// Name for people.
    pub name: Option<String>,
}

/// Type of the components of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "Index")]
pub enum ComponentType {
    /// Signed 8-bit integer.
    I8,
    /// Unsigned 8-bit integer.
    U8,
    /// Signed 16-bit integer.
    I16,
    /// Unsigned 16-bit integer.
    U16,
    /// Unsigned 32-bit integer.
    U32,
    /// 32-bit floating point number.
    F32,
}

impl TryFrom<Index> for ComponentType {
    type Error = String;

    fn try_from(number: Index) -> Result<Self, String> {
        match number.get() {
            5120 => Ok(Self::I8),
            5121 => Ok(Self::U8),
            5122 => Ok(Self::I16),
            5123 => Ok(Self::U16),
            5125 => Ok(Self::U32),
            5126 => Ok(Self::F32),
            _ => Err(format!("there is no component type {number}, expected one of 5120 to 5123, 5125, 5126")),
        }
    }
}

impl ComponentType {
    /// Number of bytes.
    pub fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Name in the specification.
    pub fn name(self) -> &'static str {
        match self {
            Self::I8 => "BYTE",
            Self::U8 => "UNSIGNED_BYTE",
            Self::I16 => "SHORT",
            Self::U16 => "UNSIGNED_SHORT",
            Self::U32 => "UNSIGNED_INT",
            Self::F32 => "FLOAT",
        }
    }
}

/// Type of the elements of an accessor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub enum ElementType {
    /// One component.
    #[serde(rename = "SCALAR")]
    Scalar,
    /// Two components.
    #[serde(rename = "VEC2")]
    Vec2,
    /// Three components.
    #[serde(rename = "VEC3")]
    Vec3,
    /// Four components.
    #[serde(rename = "VEC4")]
    Vec4,
    /// 2×2 matrix, by columns.
    #[serde(rename = "MAT2")]
    Mat2,
    /// 3×3 matrix, by columns.
    #[serde(rename = "MAT3")]
    Mat3,
    /// 4×4 matrix, by columns.
    #[serde(rename = "MAT4")]
    Mat4,
}

impl ElementType {
    /// Number of columns and rows; a vector is one column.
    pub fn shape(self) -> (usize, usize) {
        match self {
            Self::Scalar => (1, 1),
            Self::Vec2 => (1, 2),
            Self::Vec3 => (1, 3),
            Self::Vec4 => (1, 4),
            Self::Mat2 => (2, 2),
            Self::Mat3 => (3, 3),
            Self::Mat4 => (4, 4),
        }
    }

    /// Number of components.
    pub fn components(self) -> usize {
        let (columns, rows) = self.shape();
        columns * rows
    }

    /// Name in the specification.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scalar => "SCALAR",
            Self::Vec2 => "VEC2",
            Self::Vec3 => "VEC3",
            Self::Vec4 => "VEC4",
            Self::Mat2 => "MAT2",
            Self::Mat3 => "MAT3",
            Self::Mat4 => "MAT4",
        }
    }
}

impl Accessor {
    /// Distance between the columns of a matrix, in bytes: each column begins at a multiple of 4.
    pub fn column_stride(&self) -> usize {
        let (columns, rows) = self.element_type.shape();
        let column = rows * self.component_type.bytes();
        if columns == 1 { column } else { column.next_multiple_of(4) }
    }

    /// Distance between packed elements, in bytes.
    pub fn packed_stride(&self) -> usize {
        self.column_stride() * self.element_type.shape().0
    }

    /// Bytes of an element, from its first component to the end of its last.
    pub fn element_bytes(&self) -> usize {
        let (columns, rows) = self.element_type.shape();
        self.column_stride() * (columns - 1) + rows * self.component_type.bytes()
    }
}

/// Elements that replace those of an accessor.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Sparse {
    /// Number of replaced elements.
    pub count: Size,
    /// Indices of the replaced elements, rising.
    pub indices: SparseIndices,
    /// The new elements.
    pub values: SparseValues,
}

/// Indices of replaced elements.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct SparseIndices {
    /// Index of the buffer view.
    pub buffer_view: Index,
    /// Position of the first index in the buffer view, in bytes.
    #[serde(default)]
    pub byte_offset: Size,
    /// Type of the indices: an unsigned integer.
    pub component_type: ComponentType,
}

/// Elements in the type of the accessor, packed.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct SparseValues {
    /// Index of the buffer view.
    pub buffer_view: Index,
    /// Position of the first element in the buffer view, in bytes.
    #[serde(default)]
    pub byte_offset: Size,
}
