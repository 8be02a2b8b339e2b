//! Decoding of accessors to arrays of numbers (glTF 2.0, section 3.6.2).
//!
//! | component | normalized | number |
//! |---|---|---|
//! | FLOAT | | as it is; infinite numbers and NaN are faults |
//! | UNSIGNED_BYTE, UNSIGNED_SHORT | yes | c / 255, c / 65535 |
//! | BYTE, SHORT | yes | max(c / 127, -1), max(c / 32767, -1) |
//! | all integers | no | c |
//!
//! Divisions are in single precision, so they give the same bits on every machine. Columns of
//! matrices begin at multiples of 4 bytes. Without a buffer view, elements are zero. Sparse elements
//! replace others. All decoded bytes count towards a limit before memory is reserved.

mod elements;
#[cfg(test)]
mod tests;

pub(super) use elements::Elements;

use super::data::GltfData;
use super::document::Index;
use super::error::Fault;
use juggler_math::{Vec2, Vec3};

impl GltfData {
    /// Numbers of an accessor of scalars.
    ///
    /// # Errors
    ///
    /// The accessor has another type, its data is not valid, or the limit of decoded bytes is
    /// exceeded. The same holds for the other methods that decode an accessor.
    pub fn scalars(&self, accessor: Index) -> Result<Vec<f32>, Fault> {
        Elements::new(self, accessor)?.floats(|[x]: [f32; 1]| x)
    }

    /// Vectors of an accessor of two components.
    pub fn vec2(&self, accessor: Index) -> Result<Vec<Vec2>, Fault> {
        Elements::new(self, accessor)?.floats(Vec2::from_array)
    }

    /// Vectors of an accessor of three components.
    pub fn vec3(&self, accessor: Index) -> Result<Vec<Vec3>, Fault> {
        Elements::new(self, accessor)?.floats(Vec3::from_array)
    }

    /// Vectors of an accessor of four components.
    pub fn vec4(&self, accessor: Index) -> Result<Vec<[f32; 4]>, Fault> {
        Elements::new(self, accessor)?.floats(|vector: [f32; 4]| vector)
    }

    /// 4×4 matrices of an accessor, by columns.
    pub fn mat4(&self, accessor: Index) -> Result<Vec<[f32; 16]>, Fault> {
        Elements::new(self, accessor)?.floats(|matrix: [f32; 16]| matrix)
    }

    /// All components of an accessor of any type, one element after another, without padding.
    pub fn numbers(&self, accessor: Index) -> Result<Vec<f32>, Fault> {
        let elements = Elements::new(self, accessor)?;
        match elements.components() {
            1 => elements.floats(|[x]: [f32; 1]| x),
            2 => elements.floats(|vector: [f32; 2]| vector).map(Vec::into_flattened),
            3 => elements.floats(|vector: [f32; 3]| vector).map(Vec::into_flattened),
            4 => elements.floats(|vector: [f32; 4]| vector).map(Vec::into_flattened),
            9 => elements.floats(|matrix: [f32; 9]| matrix).map(Vec::into_flattened),
            _ => elements.floats(|matrix: [f32; 16]| matrix).map(Vec::into_flattened),
        }
    }

    /// Indices of an accessor of unsigned scalars.
    pub fn indices(&self, accessor: Index) -> Result<Vec<u32>, Fault> {
        Elements::new(self, accessor)?.indices()
    }

    /// Joints of an accessor of four components of UNSIGNED_BYTE or UNSIGNED_SHORT.
    pub fn joints(&self, accessor: Index) -> Result<Vec<[u16; 4]>, Fault> {
        Elements::new(self, accessor)?.joints()
    }
}
