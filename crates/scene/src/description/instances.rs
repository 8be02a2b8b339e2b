//! Instances: many placements of one object.
//!
//! ```json
//! {"group": "tree", "instances": {
//!   "positions": [[0, 0, 0], [3, 0, 1], [5, 0, -2]], "scales": [1, 0.8, [1, 1.3, 1]],
//!   "attributes": {"age": {"channels": 1, "data": {"f32": [12, 7, 31]}}}}}
//! {"shape": {"sphere": {"radius": 0.01}}, "instances": {"file": "points.ply"}}
//! ```

use super::{InstanceArray, InstanceFile, NamedAttributes, PlacementError, ScaleFactors, transform};
use juggler_math::{Mat3, Transform, Vec3, quaternion};
use juggler_world::AttributeArrays;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Name of the attribute that `colors` are.
const COLOR: &str = "color";

/// Transforms of the instances of an object, each to the object's space, and their attributes, from
/// a file or from the arrays given here. `matrices` give whole transforms; without them, each
/// instance is scaled, then rotated, then translated. All arrays that are not empty have the same
/// length.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Instances {
    /// PLY file of points, relative to the scene file: each of its vertices is an instance at `x y
    /// z`. The columns `qx qy qz qw` are the rotations, `scale` or `scale_x scale_y scale_z` the
    /// scale factors, and `m00` to `m23`, row by row, the matrices in place of all of these. `red
    /// green blue` and perhaps `alpha` are the colors. Every other column of numbers is an attribute
    /// of its name; columns `attribute.NAME.0` to `attribute.NAME.3` are one attribute NAME of
    /// several numbers. The arrays below may add what the file does not have.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<String>")]
    pub file: Option<InstanceFile>,
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
    /// the attribute `color`; a material shows them by the texture
    /// [`attribute`](#texture-attribute).
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<[f32; 4]>")]
    pub colors: InstanceArray<[f32; 4]>,
    /// Colors at the surface coordinate v = 1, such as the upper end of a `cylinder`. `colors` are
    /// then those at v = 0, and the colors between are interpolated linearly. Needs `colors`.
    #[serde(skip_serializing_if = "InstanceArray::is_empty")]
    #[schemars(with = "Vec<[f32; 4]>")]
    pub end_colors: InstanceArray<[f32; 4]>,
    /// Named attributes of the instances, for the texture [`attribute`](#texture-attribute). A mesh
    /// that has an attribute of the same name shows its own. Of nested instances, the innermost
    /// that have an attribute of the name count.
    #[serde(skip_serializing_if = "NamedAttributes::is_empty")]
    pub attributes: NamedAttributes,
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

    /// Creates the instances of a PLY file or of an asset ([`Asset::from_instances`]).
    ///
    /// [`Asset::from_instances`]: crate::Asset::from_instances
    pub fn from_file(file: impl Into<String>) -> Self {
        Self { file: Some(InstanceFile::new(file)), ..Self::default() }
    }

    /// Number of instances: the length of the longest array. The number of instances of a file is
    /// known once the scene is compiled.
    pub fn count(&self) -> usize {
        let declared = self.file.as_ref().map_or(0, InstanceFile::declared_count);
        self.lengths().into_iter().map(|(_, length)| length).fold(declared, usize::max)
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

    /// Memory of the arrays in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        let arrays = [
            size_of_val(&*self.positions),
            size_of_val(&*self.rotations),
            size_of_val(&*self.scales),
            size_of_val(&*self.matrices),
            size_of_val(&*self.colors),
            size_of_val(&*self.end_colors),
        ];
        arrays.into_iter().map(|bytes| bytes as u64).sum::<u64>().saturating_add(self.attributes.bytes())
    }

    /// Attributes of the instances, `colors` among them; `None` if there are none.
    pub(crate) fn attribute_arrays(&self) -> Option<AttributeArrays> {
        if self.colors.is_empty() && self.attributes.is_empty() {
            return None;
        }
        let (attributes, colors) = (self.attributes.shared(), self.colors.shared());
        Some(AttributeArrays { attributes, colors, end_colors: self.end_colors.shared() })
    }

    /// The instances of a file with the arrays that the scene adds to them.
    ///
    /// # Errors
    ///
    /// The file and the scene have the same array.
    pub(crate) fn with_arrays(&self, added: &Self) -> Result<Self, PlacementError> {
        fn joined<T: Clone>(
            field: &'static str,
            own: &InstanceArray<T>,
            added: &InstanceArray<T>,
        ) -> Result<InstanceArray<T>, PlacementError> {
            match (own.is_empty(), added.is_empty()) {
                (false, false) => Err(PlacementError::new(field, format!("the file has `{field}`, too"))),
                (true, _) => Ok(added.clone()),
                (_, true) => Ok(own.clone()),
            }
        }
        let attributes = self.attributes.merged(&added.attributes);
        Ok(Self {
            file: None,
            positions: joined("positions", &self.positions, &added.positions)?,
            rotations: joined("rotations", &self.rotations, &added.rotations)?,
            scales: joined("scales", &self.scales, &added.scales)?,
            matrices: joined("matrices", &self.matrices, &added.matrices)?,
            colors: joined("colors", &self.colors, &added.colors)?,
            end_colors: joined("end_colors", &self.end_colors, &added.end_colors)?,
            attributes: attributes.map_err(|name| {
                PlacementError::new("attributes", format!("the file has the attribute `{name}`, too"))
            })?,
        })
    }

    /// Transforms of all instances to the object's space.
    ///
    /// # Errors
    ///
    /// Two arrays have different lengths, `matrices` are given with other transforms, `end_colors`
    /// without `colors`, attributes are invalid, or a transform is degenerate.
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
        if !self.colors.is_empty() && self.attributes.iter().any(|(name, _)| name == COLOR) {
            return Err(PlacementError::new("attributes", "`colors` are the attribute `color` already"));
        }
        self.attributes.check(count)
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
