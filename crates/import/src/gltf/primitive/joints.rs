//! Joints and weights of vertices (glTF 2.0, section 3.7.3.1).

use super::Assembler;
use crate::gltf::document::Semantic;
use crate::gltf::error::Fault;
use crate::gltf::pose::InfluenceSet;

/// Largest deviation of the sum of a vertex's weights from 1 that stays as it is.
const SUM_TOLERANCE: f64 = 1e-3;

/// Up to four joints of each vertex, with weights.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointSet {
    /// Indices into the joints of a skin. They may be out of range.
    pub joints: Vec<[u16; 4]>,
    /// Weights.
    pub weights: Vec<[f32; 4]>,
}

impl JointSet {
    /// The set as input of a skin.
    pub fn influences(&self) -> InfluenceSet<'_> {
        InfluenceSet { joints: &self.joints, weights: &self.weights }
    }
}

impl Assembler<'_> {
    /// Sets of joints and weights of the primitive.
    pub(super) fn joints(&mut self) -> Result<Vec<JointSet>, Fault> {
        let mut sets = Vec::new();
        let attributes = &self.primitive.attributes;
        for (semantic, _) in attributes.iter() {
            match semantic {
                Semantic::Joints(set) => match self.attribute(&Semantic::Weights(*set))? {
                    Some(weights) => {
                        let Some(joints) = self.attribute(semantic)? else { continue };
                        let (joints, weights) = (joints.joints()?, weights.floats(|weights: [f32; 4]| weights)?);
                        sets.push(JointSet { joints, weights });
                    }
                    None => self.warn(format!("`JOINTS_{set}` has no effect without `WEIGHTS_{set}`"), 1),
                },
                Semantic::Weights(set) if attributes.find(&Semantic::Joints(*set)).is_none() => {
                    self.warn(format!("`WEIGHTS_{set}` has no effect without `JOINTS_{set}`"), 1);
                }
                _ => {}
            }
        }
        let count = normalize(&mut sets);
        self.warn("vertices have joint weights whose sum was not 1; they were normalized", count);
        Ok(sets)
    }
}

/// Divides the weights of each vertex by their sum if it is off 1. Vertices whose sum is not
/// positive stay as they are. Returns the number of changed vertices.
fn normalize(sets: &mut [JointSet]) -> u64 {
    let count = sets.iter().map(|set| set.weights.len()).min().unwrap_or(0);
    let mut changed = 0;
    for vertex in 0..count {
        let weights = sets.iter().filter_map(|set| set.weights.get(vertex)).flatten();
        let sum: f64 = weights.map(|weight| f64::from(*weight)).sum();
        if sum <= 0.0 || (sum - 1.0).abs() <= SUM_TOLERANCE {
            continue;
        }
        changed += 1;
        for weight in sets.iter_mut().filter_map(|set| set.weights.get_mut(vertex)).flatten() {
            *weight = (f64::from(*weight) / sum) as f32;
        }
    }
    changed
}
