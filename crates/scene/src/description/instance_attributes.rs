//! Named attributes of instances.

use super::PlacementError;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Named attribute of instances, for the texture `attribute`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InstanceAttribute {
    /// Numbers per instance, 1 to 4: gray; red and green; red, green and blue; red, green, blue and
    /// alpha.
    #[schemars(range(min = 1, max = 4))]
    pub channels: u32,
    /// Numbers of all instances, in linear light: `channels` for each of them.
    pub data: AttributeData,
}

impl InstanceAttribute {
    /// Creates an attribute with this many numbers per instance, 1 to 4.
    pub fn new(channels: u32, data: AttributeData) -> Self {
        Self { channels, data }
    }
}

/// Attributes of instances by name, shared by clones. Clones compare without reading the values.
#[derive(Clone, Debug, Default)]
pub struct NamedAttributes(Arc<BTreeMap<String, MeshAttribute>>);

impl NamedAttributes {
    /// Whether there are no attributes.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Attributes with their names, in the order of the names. Each is stored as values of faces, since
    /// an instance has one value.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &MeshAttribute)> {
        self.0.iter().map(|(name, attribute)| (name.as_str(), attribute))
    }

    /// The attributes, shared.
    pub(crate) fn shared(&self) -> Arc<BTreeMap<String, MeshAttribute>> {
        Arc::clone(&self.0)
    }

    /// Memory of the values in bytes.
    pub(crate) fn bytes(&self) -> u64 {
        self.0.values().map(|attribute| attribute.data.bytes() as u64).sum()
    }

    /// These attributes and others; returns a name that both have as an error.
    pub(super) fn merged(&self, others: &Self) -> Result<Self, String> {
        if others.is_empty() || self.is_empty() {
            return Ok(if self.is_empty() { others.clone() } else { self.clone() });
        }
        match self.0.keys().find(|name| others.0.contains_key(*name)) {
            Some(name) => Err(name.clone()),
            None => Ok(Self(Arc::new(self.0.iter().chain(&*others.0).map(|(n, a)| (n.clone(), a.clone())).collect()))),
        }
    }

    /// Checks the number of values, for `count` instances, and that all are finite.
    pub(super) fn check(&self, count: usize) -> Result<(), PlacementError> {
        self.0.iter().try_for_each(|(name, attribute)| {
            let wrong = |message| PlacementError::new("attributes", message);
            attribute.check_values(name, count, "instances").map_err(|invalid| wrong(invalid.message))
        })
    }
}

impl PartialEq for NamedAttributes {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl FromIterator<(String, InstanceAttribute)> for NamedAttributes {
    fn from_iter<I: IntoIterator<Item = (String, InstanceAttribute)>>(attributes: I) -> Self {
        let stored =
            |InstanceAttribute { channels, data }| MeshAttribute { domain: AttributeDomain::Face, channels, data };
        Self(Arc::new(attributes.into_iter().map(|(name, attribute)| (name, stored(attribute))).collect()))
    }
}

impl Serialize for NamedAttributes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        /// An attribute without its domain.
        #[derive(Serialize)]
        struct Written<'a> {
            channels: u32,
            data: &'a AttributeData,
        }
        serializer.collect_map(
            self.0
                .iter()
                .map(|(name, MeshAttribute { channels, data, .. })| (name, Written { channels: *channels, data })),
        )
    }
}

impl<'de> Deserialize<'de> for NamedAttributes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        BTreeMap::<String, InstanceAttribute>::deserialize(deserializer).map(Self::from_iter)
    }
}

impl JsonSchema for NamedAttributes {
    fn schema_name() -> Cow<'static, str> {
        BTreeMap::<String, InstanceAttribute>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        BTreeMap::<String, InstanceAttribute>::json_schema(generator)
    }

    fn inline_schema() -> bool {
        true
    }
}
