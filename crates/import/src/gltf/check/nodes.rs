//! Checks of scenes and nodes.

use super::checker::{Checker, FINITE, NOT_NEGATIVE, UNIT};
use crate::gltf::document::ComponentType::{F32, I8, I16};
use crate::gltf::document::ElementType::{Vec3, Vec4};
use crate::gltf::document::{Attributes, Index, Node, NodeExtensions, Semantic};
use crate::gltf::location::Location;

impl Checker<'_> {
    /// Checks the indices and numbers of nodes.
    pub(super) fn nodes(&mut self) {
        let document = self.document;
        let list = Location::root("nodes");
        for (position, node) in document.nodes.iter().enumerate() {
            let at = list.index(position);
            self.index(&at.key("camera"), node.camera, document.cameras.len(), "camera");
            self.index(&at.key("mesh"), node.mesh, document.meshes.len(), "mesh");
            self.index(&at.key("skin"), node.skin, document.skins.len(), "skin");
            if node.skin.is_some() && node.mesh.is_none() {
                self.warn(&at, "a node has a skin, but no mesh");
            }
            self.transform(&at, node);
            self.numbers(&at.key("weights"), &node.weights, &FINITE);
            let (weights, targets) = (node.weights.len(), self.target_count(node.mesh));
            if weights > 0 && weights != targets {
                let text = format_args!("{weights} weights, the mesh has {targets} morph targets");
                self.fault(&at.key("weights"), text);
            }
            if let Some(extensions) = &node.extensions {
                self.node_extensions(&at.key("extensions"), extensions);
            }
        }
    }

    /// Checks the transform of a node.
    fn transform(&mut self, at: &Location<'_>, node: &Node) {
        if let Some(matrix) = &node.matrix {
            let at = at.key("matrix");
            self.numbers(&at, &matrix[..], &FINITE);
            let [_, _, _, a, _, _, _, b, _, _, _, c, _, _, _, d] = **matrix;
            if [a, b, c, d] != [0.0, 0.0, 0.0, 1.0] {
                self.fault(&at, format_args!("the last row is {a} {b} {c} {d}, expected 0 0 0 1"));
            }
            if node.translation.is_some() || node.rotation.is_some() || node.scale.is_some() {
                self.fault(&at, format_args!("a node has either a matrix or translation, rotation and scale"));
            }
        }
        self.numbers(&at.key("translation"), node.translation.as_ref().map_or(&[], |values| &values[..]), &FINITE);
        self.numbers(&at.key("scale"), node.scale.as_ref().map_or(&[], |values| &values[..]), &FINITE);
        if let Some(rotation) = node.rotation {
            self.quaternion(&at.key("rotation"), rotation);
        }
    }

    /// Checks a rotation. Its length needs not be 1.
    pub(super) fn quaternion(&mut self, at: &Location<'_>, rotation: [f64; 4]) {
        self.numbers(at, &rotation, &FINITE);
        if rotation == [0.0; 4] {
            self.fault(at, format_args!("0 0 0 0 is no rotation"));
        }
    }

    fn node_extensions(&mut self, at: &Location<'_>, extensions: &NodeExtensions) {
        let lights = &self.document.extensions;
        if let Some(light) = extensions.light_punctual {
            let count = lights.lights_punctual.as_ref().map_or(0, |lights| lights.lights.len());
            let extension = at.key("KHR_lights_punctual");
            self.index(&extension.key("light"), light.light, count, "light");
        }
        if let Some(light) = extensions.light_ies {
            let count = lights.lights_ies.as_ref().map_or(0, |lights| lights.lights.len());
            let extension = at.key("EXT_lights_ies");
            self.index(&extension.key("light"), light.light, count, "light profile");
            self.number(&extension.key("multiplier"), light.multiplier, &NOT_NEGATIVE);
            self.numbers(&extension.key("color"), &light.color, &UNIT);
        }
        if let Some(instancing) = &extensions.instancing {
            let extension = at.key("EXT_mesh_gpu_instancing");
            self.instancing(&extension.key("attributes"), &instancing.attributes);
        }
    }

    /// Checks the attributes of instances.
    fn instancing(&mut self, at: &Location<'_>, attributes: &Attributes) {
        let mut first: Option<(String, u64)> = None;
        for (semantic, index) in attributes.iter() {
            let Semantic::Other(name) = semantic else { continue };
            let at = at.key(name);
            let accessor = match name.as_str() {
                "TRANSLATION" | "SCALE" => self.typed(&at, index, &[Vec3], &[F32, I8, I16]),
                "ROTATION" => self.typed(&at, index, &[Vec4], &[F32, I8, I16]),
                _ => {
                    self.index(&at, index, self.document.accessors.len(), "accessor");
                    self.document.accessors.get(index.get())
                }
            };
            let Some(count) = accessor.map(|accessor| accessor.count.get()) else { continue };
            if name == "ROTATION" {
                self.normalized(&at, index);
            }
            self.count(&at, count, self.limits.instances, "instances");
            match &first {
                Some((other, expected)) if count != *expected => {
                    self.fault(&at, format_args!("{count} elements, `{other}` has {expected}"));
                }
                Some(_) => {}
                None => first = Some((name.clone(), count)),
            }
        }
    }

    /// Checks the root nodes of scenes.
    pub(super) fn scenes(&mut self) {
        let document = self.document;
        self.index(&Location::root("scene"), document.scene, document.scenes.len(), "scene");
        let lights = document.extensions.lights_image_based.as_ref().map_or(0, |lights| lights.lights.len());
        let list = Location::root("scenes");
        for (position, scene) in document.scenes.iter().enumerate() {
            let at = list.index(position);
            let nodes = at.key("nodes");
            for (position, node) in scene.nodes.iter().enumerate() {
                self.index(&nodes.index(position), *node, document.nodes.len(), "node");
            }
            self.unique(&nodes, &scene.nodes);
            let light: Option<Index> = scene.extensions.light_image_based.map(|light| light.light);
            let extensions = at.key("extensions");
            let extension = extensions.key("EXT_lights_image_based");
            self.index(&extension.key("light"), light, lights, "light");
        }
    }
}
