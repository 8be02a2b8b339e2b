//! Names of the cameras of models: `car/Front`, or `Front` alone if a single camera has this name.

use crate::Scene;

/// Finds the camera that a name selects: the camera of the whole name, otherwise the only camera of a
/// model whose name without the prefix of its model it is.
pub fn find_camera<'n>(mut names: impl Iterator<Item = &'n str> + Clone, wanted: &str) -> Option<&'n str> {
    let is_bare = |name: &&str| name.split_once('/').is_some_and(|(_, bare)| bare == wanted);
    let mut bare = names.clone().filter(is_bare);
    names.find(|name| *name == wanted).or_else(|| bare.next().filter(|_| bare.next().is_none()))
}

impl Scene {
    /// Names of the scene's cameras, those of its models included.
    pub fn camera_names(&self) -> Vec<String> {
        let scene = self.expanded_description();
        let single = scene.camera.iter().map(|_| "camera".to_owned());
        single.chain(scene.cameras.keys().cloned()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bare_names_select_the_only_camera_of_that_name() {
        let find = |wanted: &str| find_camera(["Far", "a/Front", "a/Far", "b/Side", "c/Side"].into_iter(), wanted);
        assert_eq!(["Front", "a/Front", "Far", "a/Far"].map(find), ["a/Front", "a/Front", "Far", "a/Far"].map(Some));
        assert_eq!(["Side", "b", "ront", ""].map(find), [None; 4]);
    }
}
