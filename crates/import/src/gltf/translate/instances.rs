//! Instances of a mesh (EXT_mesh_gpu_instancing). Accessors of applications, whose names begin with
//! `_`, are attributes of that name if they have one to four components.

use crate::gltf::data::GltfData;
use crate::gltf::document::{Attributes, Document, Semantic};
use crate::gltf::error::Fault;
use glam::{DAffine3, DQuat, DVec3};
use juggler_math::quaternion;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Maximum number of components of an attribute.
const MAX_CHANNELS: usize = 4;

/// Instances of a node.
#[derive(Debug, Default)]
pub struct NodeInstances {
    /// Transforms to the space of the node: scale, then rotation, then translation.
    pub transforms: Vec<DAffine3>,
    /// Attributes with their names.
    pub attributes: Vec<(String, Attribute)>,
}

/// Attribute of instances: `channels` numbers for each of them.
#[derive(Debug)]
pub struct Attribute {
    pub channels: usize,
    pub numbers: Vec<f32>,
}

type Decoded = Result<NodeInstances, Fault>;

/// Instances of each node that has some, decoded at their first use.
#[derive(Debug, Default)]
pub struct Instances(BTreeMap<usize, OnceLock<Decoded>>);

impl Instances {
    /// Instances of a document, none of them decoded.
    pub fn new(document: &Document) -> Self {
        let nodes = document.nodes.iter().enumerate();
        let has_some = |extensions: &crate::gltf::document::NodeExtensions| extensions.instancing.is_some();
        let some = nodes.filter(|(_, node)| node.extensions.as_deref().is_some_and(has_some));
        Self(some.map(|(index, _)| (index, OnceLock::new())).collect())
    }

    /// Whether a node has instances.
    pub fn has(&self, node: usize) -> bool {
        self.0.contains_key(&node)
    }

    /// Instances of a node; `None` if it has none.
    ///
    /// # Errors
    ///
    /// An array is not valid.
    pub fn of_node(&self, data: &GltfData, node: usize) -> Result<Option<&NodeInstances>, Fault> {
        let Some(cell) = self.0.get(&node) else { return Ok(None) };
        cell.get_or_init(|| decode(data, node)).as_ref().map(Some).map_err(Clone::clone)
    }
}

fn decode(data: &GltfData, node: usize) -> Decoded {
    let at = format!("/nodes/{node}/extensions/EXT_mesh_gpu_instancing");
    let extensions = data.gltf.document.nodes.get(node).and_then(|node| node.extensions.as_deref());
    let Some(instancing) = extensions.and_then(|extensions| extensions.instancing.as_ref()) else {
        return Ok(NodeInstances::default());
    };
    let find = |name: &str| instancing.attributes.find(&Semantic::Other(name.to_owned()));
    let translations = find("TRANSLATION").map(|accessor| data.vec3(accessor)).transpose()?;
    let rotations = find("ROTATION").map(|accessor| data.vec4(accessor)).transpose()?;
    let scales = find("SCALE").map(|accessor| data.vec3(accessor)).transpose()?;
    // The check of the structure has found all lengths equal.
    let lengths =
        [translations.as_ref().map(Vec::len), rotations.as_ref().map(Vec::len), scales.as_ref().map(Vec::len)];
    let count = lengths.into_iter().flatten().min().unwrap_or_default();
    data.reserve(&at, (count as u64).saturating_mul(size_of::<DAffine3>() as u64))?;
    let vector = |list: &Option<Vec<juggler_math::Vec3>>, i: usize, default| {
        list.as_ref().and_then(|list| list.get(i)).map_or(default, |vector| vector.as_dvec3())
    };
    let transform = |i: usize| {
        let rotation = rotations.as_ref().and_then(|list| list.get(i)).map(|rotation| rotation.map(f64::from));
        let rotation = rotation.map_or(Some(DQuat::IDENTITY), quaternion::normalized);
        let rotation =
            rotation.ok_or_else(|| Fault::at(&at, format_args!("the rotation of instance {i} is 0 0 0 0")))?;
        let (scale, translation) = (vector(&scales, i, DVec3::ONE), vector(&translations, i, DVec3::ZERO));
        Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
    };
    let transforms: Result<Vec<DAffine3>, Fault> = (0..count).map(transform).collect();
    Ok(NodeInstances { transforms: transforms?, attributes: attributes(data, &instancing.attributes)? })
}

/// Attributes of applications, as many values as there are instances.
fn attributes(data: &GltfData, all: &Attributes) -> Result<Vec<(String, Attribute)>, Fault> {
    let mut found = Vec::new();
    for (semantic, accessor) in all.iter() {
        let Semantic::Other(name) = semantic else { continue };
        let accessors = &data.gltf.document.accessors;
        let channels = accessors.get(accessor.get()).map_or(0, |accessor| accessor.element_type.components());
        if name.starts_with('_') && (1..=MAX_CHANNELS).contains(&channels) {
            found.push((name.clone(), Attribute { channels, numbers: data.numbers(accessor)? }));
        }
    }
    Ok(found)
}
