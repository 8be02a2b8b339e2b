//! Instances as points of PLY files.

use super::{InstanceArray, InstanceAttribute, Instances, ScaleFactors};
use juggler_math::Vec3;
use juggler_mesh::PointFile;

impl Instances {
    /// Instances at the points of a file.
    pub(crate) fn from_points(points: PointFile) -> Self {
        #[expect(clippy::needless_pass_by_value, reason = "each array is freed once it is converted")]
        fn array<const N: usize, T>(numbers: Vec<f32>, value: impl Fn([f32; N]) -> T) -> InstanceArray<T> {
            numbers.as_chunks::<N>().0.iter().map(|numbers| value(*numbers)).collect()
        }
        let PointFile {
            positions, rotations, uniform_scales, scales, matrices, colors, end_colors, attributes, ..
        } = points;
        let each = array(scales, |factors: [f32; 3]| ScaleFactors::Each(factors.into()));
        let attribute = |(name, attribute): (String, juggler_shape::attribute::MeshAttribute)| {
            (name, InstanceAttribute::new(attribute.channels, attribute.data))
        };
        Self {
            file: None,
            positions: array(positions, Vec3::from_array),
            rotations: array(rotations, |rotation| rotation),
            scales: if each.is_empty() {
                array(uniform_scales, |[scale]: [f32; 1]| ScaleFactors::All(scale))
            } else {
                each
            },
            matrices: array(matrices, |rows| rows),
            colors: array(colors, |color| color),
            end_colors: array(end_colors, |color| color),
            attributes: attributes.into_iter().map(attribute).collect(),
        }
    }

    /// Points of a file, which [`Instances::from_points`] reads as these instances.
    pub(crate) fn to_points(&self) -> PointFile {
        let Self { file: _, positions, rotations, scales, matrices, colors, end_colors, attributes } = self;
        let all = |scale: &ScaleFactors| match scale {
            ScaleFactors::All(factor) => Some(*factor),
            ScaleFactors::Each(_) => None,
        };
        let uniform: Option<Vec<f32>> = scales.iter().map(all).collect();
        let each = || scales.iter().flat_map(|scale| scale.factors().to_array()).collect();
        PointFile {
            count: self.count(),
            positions: positions.iter().flat_map(|position| position.to_array()).collect(),
            rotations: rotations.as_flattened().to_vec(),
            scales: if uniform.is_none() { each() } else { Vec::new() },
            uniform_scales: uniform.unwrap_or_default(),
            matrices: matrices.as_flattened().to_vec(),
            colors: colors.as_flattened().to_vec(),
            end_colors: end_colors.as_flattened().to_vec(),
            attributes: attributes.iter().map(|(name, attribute)| (name.to_owned(), attribute.clone())).collect(),
            warnings: Vec::new(),
        }
    }
}
