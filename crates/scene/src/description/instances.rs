//! Instances: many placements of one object.
//!
//! ```json
//! {"group": "tree", "instances": {
//!   "positions": [[0, 0, 0], [3, 0, 1], [5, 0, -2]], "scales": [1, 0.8, [1, 1.3, 1]],
//!   "colors": [[1, 0, 0, 1], [0, 1, 0, 1], [0, 0, 1, 1]]}}
//! ```

use super::{PlacementError, ScaleFactors, transform};
use juggler_math::{Mat3, Transform, Vec3, quaternion};
use juggler_shape::MeshData;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::sync::Arc;

/// Transforms of the instances of an object, each to the object's space. `matrices` give whole
/// transforms; without them, each instance is scaled, then rotated, then translated. All arrays that
/// are not empty have the same length.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Instances {
    /// Positions of the instances' origins.
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<[f32; 3]>")]
    pub positions: InstanceArray<Vec3>,
    /// Rotations as quaternions `[x, y, z, w]` as in glTF. They are normalized and must not be zero.
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<[f32; 4]>")]
    pub rotations: InstanceArray<[f32; 4]>,
    /// Scale factors, other than 0: one, or one for each axis.
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<ScaleFactors>")]
    pub scales: InstanceArray<ScaleFactors>,
    /// Affine maps in place of positions, rotations and scales: the 12 numbers of 3 rows of a matrix that
    /// multiplies column vectors. The matrices must be invertible.
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<[f32; 12]>")]
    pub matrices: InstanceArray<[f32; 12]>,
    /// Colors: red, green, blue and alpha of each instance, from 0 to 1 in linear light. They are
    /// the attribute `color` of surfaces without attributes of their own; a material shows them by
    /// the texture [`attribute`](#texture-attribute).
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<[f32; 4]>")]
    pub colors: InstanceArray<[f32; 4]>,
    /// Colors at the surface coordinate v = 1, such as the upper end of a `cylinder`. `colors` are
    /// then those at v = 0, and the colors between are interpolated linearly. Needs `colors`.
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<[f32; 4]>")]
    pub end_colors: InstanceArray<[f32; 4]>,
}

impl Instances {
    /// Creates instances at these positions.
    pub fn at(positions: impl IntoIterator<Item = Vec3>) -> Self {
        Self { positions: positions.into_iter().collect(), ..Self::default() }
    }

    /// Creates instances with these affine maps: 12 numbers, the 3 rows of a matrix that multiplies
    /// column vectors.
    pub fn from_matrices(matrices: impl IntoIterator<Item = [f32; 12]>) -> Self {
        Self { matrices: matrices.into_iter().collect(), ..Self::default() }
    }

    /// Number of instances: the length of the longest array.
    pub fn count(&self) -> usize {
        self.lengths().into_iter().map(|(_, length)| length).fold(0, usize::max)
    }

    fn lengths(&self) -> [(&'static str, usize); 6] {
        [
            ("positions", self.positions.len()),
            ("rotations", self.rotations.len()),
            ("scales", self.scales.len()),
            ("matrices", self.matrices.len()),
            ("colors", self.colors.len()),
            ("end_colors", self.end_colors.len()),
        ]
    }

    /// Colors as arrays with a triangle for each instance, whose first and third corner have the
    /// colors at v = 0 and v = 1. `None` without colors.
    pub(crate) fn color_arrays(&self) -> Option<MeshData> {
        let count = u32::try_from(self.colors.len()).ok().filter(|count| *count > 0)?;
        let end = if self.end_colors.is_empty() { 0 } else { count };
        let numbers = self.colors.iter().chain(self.end_colors.iter()).flatten().copied();
        let data = AttributeData::F32(numbers.collect());
        let attribute = MeshAttribute { domain: AttributeDomain::Vertex, channels: 4, data };
        let triangles = (0..count).map(|index| [index, index, index.saturating_add(end)]);
        Some(MeshData {
            triangles: triangles.collect(),
            attributes: [("color".to_owned(), attribute)].into(),
            ..MeshData::default()
        })
    }

    /// Transforms of all instances to the object's space.
    ///
    /// # Errors
    ///
    /// Two arrays have different lengths, `matrices` are given with other transforms, `end_colors`
    /// without `colors`, or a transform is degenerate.
    pub fn transforms(&self) -> Result<Vec<Transform>, PlacementError> {
        self.check_lengths()?;
        (0..self.count()).map(|index| self.transform(index)).collect()
    }

    /// Checks all that [`Instances::transforms`] checks, without keeping the transforms.
    pub(crate) fn check(&self) -> Result<(), PlacementError> {
        self.check_lengths()?;
        (0..self.count()).try_for_each(|index| self.transform(index).map(drop))
    }

    fn check_lengths(&self) -> Result<(), PlacementError> {
        let count = self.count();
        for (field, length) in self.lengths() {
            if length != 0 && length != count {
                let message = format!("`{field}` has {length} elements, another array {count}");
                return Err(PlacementError::new(field, message));
            }
        }
        let has_steps = !(self.positions.is_empty() && self.rotations.is_empty() && self.scales.is_empty());
        if !self.matrices.is_empty() && has_steps {
            return Err(PlacementError::new(
                "matrices",
                "`matrices` stand in place of `positions`, `rotations` and `scales`",
            ));
        }
        if self.colors.is_empty() && !self.end_colors.is_empty() {
            return Err(PlacementError::new("end_colors", "`end_colors` need `colors`"));
        }
        Ok(())
    }

    /// Transform of an instance to the object's space.
    pub(crate) fn transform(&self, index: usize) -> Result<Transform, PlacementError> {
        if let Some(rows) = self.matrices.get(index) {
            let at = |message| PlacementError::new("matrices", format!("instance {index}: {message}"));
            return transform::matrix(rows).map_err(at);
        }
        let scale = self.scales.get(index).map_or(Vec3::ONE, ScaleFactors::factors);
        let rotation = match self.rotations.get(index) {
            None => Mat3::IDENTITY,
            Some(rotation) => {
                quaternion::matrix(rotation.map(f64::from)).map(|turn| turn.as_mat3()).ok_or_else(|| {
                    PlacementError::new("rotations", format!("the rotation of instance {index} must not be zero"))
                })?
            }
        };
        let matrix = Mat3::from_cols(rotation.x_axis * scale.x, rotation.y_axis * scale.y, rotation.z_axis * scale.z);
        let position = self.positions.get(index).copied().unwrap_or_default();
        Transform::new(matrix, position).ok_or_else(|| {
            let message = format!("the scale of instance {index} flattens the object, or its position is out of range");
            PlacementError::new(if self.scales.is_empty() { "positions" } else { "scales" }, message)
        })
    }
}

/// Values of all instances, shared by clones. Clones compare without reading the values.
#[derive(Clone, Debug)]
pub struct InstanceArray<T>(Arc<[T]>);

impl<T> Default for InstanceArray<T> {
    fn default() -> Self {
        Self(Arc::from([]))
    }
}

impl<T: PartialEq> PartialEq for InstanceArray<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl<T> FromIterator<T> for InstanceArray<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl<T> std::ops::Deref for InstanceArray<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> InstanceArray<T> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl<T: Serialize> Serialize for InstanceArray<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for InstanceArray<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(|values| Self(values.into()))
    }
}

impl<T: JsonSchema> JsonSchema for InstanceArray<T> {
    fn schema_name() -> Cow<'static, str> {
        Vec::<T>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Vec::<T>::json_schema(generator)
    }

    fn inline_schema() -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn instances(json: &str) -> Instances {
        serde_json::from_str(json).unwrap_or_else(|error| panic!("{json}: {error}"))
    }

    fn error(json: &str) -> (String, String) {
        let wrong = instances(json).transforms().expect_err("the instances are wrong");
        (wrong.field.to_string(), wrong.message)
    }

    #[test]
    fn instances_are_scaled_then_rotated_then_translated() {
        let half = std::f32::consts::FRAC_1_SQRT_2;
        let json = format!(
            r#"{{"positions": [[1, 2, 3], [0, 0, 0]], "rotations": [[0, {half}, 0, {half}], [0, 0, 0, 2]],
                "scales": [[2, 1, 1], 3]}}"#
        );
        let transforms = instances(&json).transforms().expect("valid instances");
        // A quarter turn about y takes x to -z.
        let point = transforms[0].point(Vec3::new(1.0, 1.0, 0.0));
        assert!(point.abs_diff_eq(Vec3::new(1.0, 3.0, 1.0), 1e-5), "{point}");
        assert_eq!(transforms[1].point(Vec3::ONE), Vec3::splat(3.0));
    }

    #[test]
    fn matrices_are_whole_transforms() {
        let transforms = instances(r#"{"matrices": [[0, -1, 0, 5, 1, 0, 0, 6, 0, 0, 1, 7]]}"#).transforms();
        assert_eq!(transforms.map(|all| all[0].point(Vec3::X)), Ok(Vec3::new(5.0, 7.0, 7.0)));
    }

    #[test]
    fn wrong_arrays_are_reported_with_the_instance() {
        let (field, message) = error(r#"{"positions": [[0, 0, 0], [1, 0, 0]], "scales": [1]}"#);
        assert_eq!((field.as_str(), message.as_str()), ("scales", "`scales` has 1 elements, another array 2"));
        assert_eq!(
            error(r#"{"rotations": [[0, 0, 0, 1], [0, 0, 0, 0]]}"#).1,
            "the rotation of instance 1 must not be zero"
        );
        assert_eq!(error(r#"{"scales": [1, [1, 0, 1]]}"#).0, "scales");
        let rows = "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]";
        assert_eq!(error(&format!(r#"{{"positions": [[0, 0, 0]], "matrices": [{rows}]}}"#)).0, "matrices");
        assert!(error(r#"{"matrices": [[1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0]]}"#).1.starts_with("instance 0: "));
        assert_eq!(error(r#"{"positions": [[0, 0, 0]], "end_colors": [[1, 1, 1, 1]]}"#).0, "end_colors");
        assert_eq!(error(r#"{"positions": [[0, 0, 0]], "colors": [[1, 1, 1, 1], [0, 0, 0, 1]]}"#).0, "positions");
    }

    #[test]
    fn clones_are_equal_and_so_are_equal_values() {
        let one = instances(r#"{"positions": [[1, 2, 3]]}"#);
        assert_eq!(one, one.clone());
        assert_eq!(one, Instances::at([Vec3::new(1.0, 2.0, 3.0)]));
        assert_ne!(one, Instances::at([Vec3::ZERO]));
        assert_eq!(serde_json::to_string(&one).unwrap_or_default(), r#"{"positions":[[1.0,2.0,3.0]]}"#);
    }
}
