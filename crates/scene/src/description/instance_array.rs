//! Arrays of instances that clones share.

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::sync::Arc;

/// Values of all instances, shared by clones. Clones compare without reading the values.
#[derive(Clone, Debug)]
pub struct InstanceArray<T>(Arc<[T]>);

impl<T> Default for InstanceArray<T> {
    fn default() -> Self {
        Self(Arc::from([]))
    }
}

impl<T: PartialEq> PartialEq for InstanceArray<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

impl<T> FromIterator<T> for InstanceArray<T> {
    fn from_iter<I: IntoIterator<Item = T>>(values: I) -> Self {
        Self(values.into_iter().collect())
    }
}

impl<T> From<Vec<T>> for InstanceArray<T> {
    fn from(values: Vec<T>) -> Self {
        Self(values.into())
    }
}

impl<T> std::ops::Deref for InstanceArray<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T> InstanceArray<T> {
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The values, shared.
    pub(crate) fn shared(&self) -> Arc<[T]> {
        Arc::clone(&self.0)
    }
}

impl<T: Serialize> Serialize for InstanceArray<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.0.iter())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for InstanceArray<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Vec::deserialize(deserializer).map(|values| Self(values.into()))
    }
}

impl<T: JsonSchema> JsonSchema for InstanceArray<T> {
    fn schema_name() -> Cow<'static, str> {
        Vec::<T>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        Vec::<T>::json_schema(generator)
    }

    fn inline_schema() -> bool {
        true
    }
}
