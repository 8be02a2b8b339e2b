//! Hash of the arrays of instances, without a copy of them.

use crate::array_hasher::ArrayHasher;
use crate::description::Instances;

/// BLAKE3 hash of all arrays of instances.
pub fn digest(instances: &Instances) -> [u8; 32] {
    let Instances { file, positions, rotations, scales, matrices, colors, end_colors, attributes } = instances;
    // No file begins like this, so a file and instances never have the same hash.
    let mut hasher = ArrayHasher::new(b"instances in memory\0");
    hasher.bytes(file.as_ref().map_or("", |file| file.name()).as_bytes());
    hasher.array(positions, |position| position.to_array().map(f32::to_le_bytes));
    hasher.array(rotations, |rotation| rotation.map(f32::to_le_bytes));
    hasher.array(scales, |scale| scale.factors().to_array().map(f32::to_le_bytes));
    hasher.array(matrices, |rows| rows.map(f32::to_le_bytes));
    hasher.array(colors, |color| color.map(f32::to_le_bytes));
    hasher.array(end_colors, |color| color.map(f32::to_le_bytes));
    for (name, attribute) in attributes.iter() {
        hasher.attribute(name, attribute);
    }
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::{InstanceAttribute, NamedAttributes, ScaleFactors};
    use juggler_math::Vec3;
    use juggler_shape::attribute::AttributeData;
    use std::collections::BTreeSet;

    #[test]
    fn every_array_and_every_number_counts() {
        let at = |x| Instances::at([Vec3::new(x, 0.0, 0.0)]);
        let attribute = |name: &str, channels, numbers: &[f32]| {
            let attribute = InstanceAttribute::new(channels, AttributeData::F32(numbers.to_vec()));
            NamedAttributes::from_iter([(name.to_owned(), attribute)])
        };
        let with = |attributes| Instances { attributes, ..at(0.0) };
        let color = || [[0.5, 0.5, 0.5, 1.0]].into_iter().collect();
        let all = [
            Instances::default(),
            Instances::from_file("points.ply"),
            at(0.0),
            at(1.0),
            Instances { rotations: [[0.0, 0.0, 0.0, 1.0]].into_iter().collect(), ..Instances::default() },
            Instances { scales: [ScaleFactors::All(2.0)].into_iter().collect(), ..Instances::default() },
            Instances { scales: [ScaleFactors::Each(Vec3::X)].into_iter().collect(), ..Instances::default() },
            Instances::from_matrices([[1.0; 12]]),
            Instances { colors: color(), ..at(0.0) },
            Instances { colors: color(), end_colors: color(), ..at(0.0) },
            Instances { end_colors: color(), ..at(0.0) },
            with(attribute("a", 1, &[1.0, 2.0])),
            with(attribute("b", 1, &[1.0, 2.0])),
            with(attribute("a", 2, &[1.0, 2.0])),
            with(attribute("a", 2, &[1.0, 2.5])),
        ];
        let digests: BTreeSet<[u8; 32]> = all.iter().map(digest).collect();
        assert_eq!(digests.len(), all.len());
    }
}
