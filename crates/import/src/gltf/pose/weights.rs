//! Weights of morph targets and the precedence of their sources (glTF 2.0, sections 3.7.2.2 and
//! 3.11).

/// Weights that an animation sets, all at once or one by one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnimatedWeights {
    /// Weights of all morph targets.
    pub all: Option<Vec<f64>>,
    /// Morph targets with their weights, which take precedence over `all`.
    pub single: Vec<(usize, f64)>,
}

impl AnimatedWeights {
    /// Sets the weight of one morph target, or of all.
    pub(super) fn set(&mut self, morph_target: Option<usize>, values: Vec<f64>) {
        match morph_target {
            None => self.all = Some(values),
            Some(morph_target) => self.single.extend(values.first().map(|weight| (morph_target, *weight))),
        }
    }
}

/// Sources of the weights of a mesh that a node draws, by falling precedence. An empty list is
/// absent.
#[derive(Clone, Copy, Debug, Default)]
pub struct WeightSources<'a> {
    /// Weights that the animation sets on the node.
    pub node_animation: Option<&'a AnimatedWeights>,
    /// Weights of the node.
    pub node: &'a [f64],
    /// Weights that the animation sets on the mesh.
    pub mesh_animation: Option<&'a AnimatedWeights>,
    /// Weights of the mesh.
    pub mesh: &'a [f64],
}

impl WeightSources<'_> {
    /// Weights of a mesh with a number of morph targets. Weights that no source has are 0, and
    /// weights beyond the number of targets have no effect.
    pub fn resolve(&self, targets: usize) -> Vec<f64> {
        let mut weights = vec![0.0; targets];
        let all = |animation: Option<&AnimatedWeights>| animation.and_then(|animation| animation.all.clone());
        if let Some(weight_list) = all(self.node_animation).or_else(|| present(self.node)) {
            copy(&weight_list, &mut weights);
        } else {
            copy(&all(self.mesh_animation).unwrap_or_else(|| self.mesh.to_vec()), &mut weights);
            set_single(self.mesh_animation, &mut weights);
        }
        set_single(self.node_animation, &mut weights);
        weights
    }
}

fn present(weights: &[f64]) -> Option<Vec<f64>> {
    (!weights.is_empty()).then(|| weights.to_vec())
}

fn copy(from: &[f64], to: &mut [f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to = *from);
}

fn set_single(animation: Option<&AnimatedWeights>, weights: &mut [f64]) {
    for (morph_target, weight) in animation.into_iter().flat_map(|animation| &animation.single) {
        if let Some(slot) = weights.get_mut(*morph_target) {
            *slot = *weight;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn animation_precedes_node_precedes_mesh() {
        let node_animation = AnimatedWeights { all: Some(vec![0.1, 0.2, 0.3]), single: Vec::new() };
        let mesh_animation = AnimatedWeights { all: Some(vec![0.4, 0.5, 0.6]), single: vec![(0, 0.9)] };
        let (node, mesh) = ([1.0, 2.0, 3.0], [4.0, 5.0, 6.0]);
        let sources = WeightSources {
            node_animation: Some(&node_animation),
            node: &node,
            mesh_animation: Some(&mesh_animation),
            mesh: &mesh,
        };
        assert_eq!(sources.resolve(3), [0.1, 0.2, 0.3]);
        let sources = WeightSources { node_animation: None, ..sources };
        assert_eq!(sources.resolve(3), [1.0, 2.0, 3.0]);
        let sources = WeightSources { node: &[], ..sources };
        assert_eq!(sources.resolve(3), [0.9, 0.5, 0.6]);
        let sources = WeightSources { mesh_animation: None, ..sources };
        assert_eq!(sources.resolve(3), [4.0, 5.0, 6.0]);
        assert_eq!(WeightSources::default().resolve(3), [0.0; 3]);
    }

    #[test]
    fn single_weights_replace_those_of_a_list() {
        let mut animation = AnimatedWeights::default();
        animation.set(Some(1), vec![0.5]);
        animation.set(Some(usize::MAX), vec![0.7]);
        animation.set(Some(0), Vec::new());
        let on_node = WeightSources { node_animation: Some(&animation), mesh: &[4.0, 5.0], ..WeightSources::default() };
        assert_eq!(on_node.resolve(2), [4.0, 0.5]);
        assert_eq!(WeightSources { node: &[1.0, 2.0], ..on_node }.resolve(2), [1.0, 0.5]);
        let on_mesh = WeightSources { mesh_animation: Some(&animation), mesh: &[4.0, 5.0], ..WeightSources::default() };
        assert_eq!(on_mesh.resolve(2), [4.0, 0.5]);
        assert_eq!(WeightSources { node: &[1.0, 2.0], ..on_mesh }.resolve(2), [1.0, 2.0]);
    }

    #[test]
    fn lists_of_another_length_are_cut_or_filled_with_zeros() {
        let mesh = WeightSources { mesh: &[1.0, 2.0, 3.0], ..WeightSources::default() };
        assert_eq!(mesh.resolve(2), [1.0, 2.0]);
        assert_eq!(mesh.resolve(4), [1.0, 2.0, 3.0, 0.0]);
        assert_eq!(mesh.resolve(0), [0.0; 0]);
    }
}
