//! Attributes of instances, which textures find at surfaces whose mesh has none of the name.

use super::Object;
use juggler_math::Vec2;
use juggler_shape::InstanceValues;
use juggler_shape::attribute::{MeshAttribute, interpolate};
use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

/// Name of the attribute that colors of instances are.
const COLOR: &str = "color";

/// Attributes of instances: one value per instance of each. The scene shares the arrays.
#[derive(Clone, Debug, Default)]
pub struct AttributeArrays {
    /// Attributes by name, as values of faces: each instance is a face.
    pub attributes: Arc<BTreeMap<String, MeshAttribute>>,
    /// Attribute `color`: red, green, blue and alpha at the surface coordinate v = 0.
    pub colors: Arc<[[f32; 4]]>,
    /// Attribute `color` at v = 1; empty if each instance has one color.
    pub end_colors: Arc<[[f32; 4]]>,
}

impl AttributeArrays {
    /// Value of an attribute, as [`InstanceValues::value`] returns it.
    fn value(&self, index: u32, name: &str, at: Vec2) -> Option<[f32; 4]> {
        let index = index as usize;
        if let Some(attribute) = self.attributes.get(name) {
            return Some(attribute.constant_value(index));
        }
        let start = *self.colors.get(index).filter(|_| name == COLOR)?;
        let end = self.end_colors.get(index).copied().unwrap_or(start);
        let mut color = start;
        for (number, end) in color.iter_mut().zip(end) {
            *number = interpolate([*number, *number, end], at);
        }
        Some(color)
    }
}

/// Attributes of one instance, and those of the instances around it.
#[derive(Clone, Debug)]
pub struct InstanceAttributes {
    /// Attributes of all instances of the same list.
    pub list: Arc<AttributeList>,
    /// Index of the instance.
    pub index: u32,
}

/// Attributes of a list of instances, and those of the instance that the list is inside of.
#[derive(Clone, Debug, Default)]
pub struct AttributeList {
    /// Attributes of the instances.
    pub arrays: AttributeArrays,
    /// Attributes of the enclosing instance, which hold where the list has none of a name.
    pub outer: Option<InstanceAttributes>,
}

impl InstanceAttributes {
    /// The attributes inside of an instance with `outer` attributes.
    pub(super) fn within(&self, outer: &Self) -> Self {
        let own_outer = self.list.outer.as_ref().map_or_else(|| outer.clone(), |own| own.within(outer));
        let list = AttributeList { arrays: self.list.arrays.clone(), outer: Some(own_outer) };
        Self { list: Arc::new(list), index: self.index }
    }
}

impl InstanceValues for InstanceAttributes {
    fn value(&self, _shape_index: u32, name: &str, at: Vec2) -> Option<[f32; 4]> {
        let levels = std::iter::successors(Some(self), |inner| inner.list.outer.as_ref());
        levels.into_iter().find_map(|level| level.list.arrays.value(level.index, name, at))
    }
}

/// Attributes of the objects of a geometry: runs of successive objects that are successive instances
/// of the same list.
#[derive(Clone, Debug, Default)]
pub(super) struct ObjectAttributes(Vec<AttributeRun>);

#[derive(Clone, Debug)]
struct AttributeRun {
    /// Indices of the objects.
    objects: Range<u32>,
    /// Attributes of the first object.
    first: InstanceAttributes,
}

impl AttributeRun {
    /// Index of an object's instance.
    fn instance(&self, object_index: u32) -> u32 {
        self.first.index.wrapping_add(object_index - self.objects.start)
    }
}

impl ObjectAttributes {
    pub fn new(objects: &[Object]) -> Self {
        let mut runs: Vec<AttributeRun> = Vec::new();
        for (object_index, object) in (0..).zip(objects) {
            let Some(attributes) = &object.attributes else { continue };
            let continues = |run: &&mut AttributeRun| {
                run.objects.end == object_index
                    && run.instance(object_index) == attributes.index
                    && Arc::ptr_eq(&run.first.list, &attributes.list)
            };
            match runs.last_mut().filter(continues) {
                Some(run) => run.objects.end = object_index.saturating_add(1),
                None => runs.push(AttributeRun {
                    objects: object_index..object_index.saturating_add(1),
                    first: attributes.clone(),
                }),
            }
        }
        Self(runs)
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Memory in bytes, without the arrays.
    pub fn bytes(&self) -> usize {
        size_of_val(self.0.as_slice())
    }

    fn run(&self, object_index: u32) -> Option<&AttributeRun> {
        let after = self.0.partition_point(|run| run.objects.start <= object_index);
        self.0.get(after.checked_sub(1)?).filter(|run| run.objects.contains(&object_index))
    }

    /// Attributes of an object.
    pub fn of_object(&self, object_index: u32) -> Option<InstanceAttributes> {
        let run = self.run(object_index)?;
        Some(InstanceAttributes { index: run.instance(object_index), ..run.first.clone() })
    }

    /// Value of an attribute of an object, as [`InstanceValues::value`] returns it.
    pub fn value(&self, object_index: u32, name: &str, at: Vec2) -> Option<[f32; 4]> {
        let run = self.run(object_index)?;
        let AttributeList { arrays, outer } = &*run.first.list;
        let own = arrays.value(run.instance(object_index), name, at);
        own.or_else(|| outer.as_ref()?.value(object_index, name, at))
    }
}
