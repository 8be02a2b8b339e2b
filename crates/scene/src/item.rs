//! Items of a scene: objects, lights, materials, textures, cameras and settings, each with its
//! animation template, its source location and its validation state.

use crate::animate::Programs;
use crate::document::{Node, SourceSpan};
use crate::motion::TransformSetters;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// One item of a scene: a value at the scene's frame, shared by the scene's copies until it is
/// changed.
///
/// An item reads and writes as its value: `scene.description.objects[0].visible`. Two items are
/// equal when their values are.
pub struct Item<T>(Arc<Inner<T>>);

#[derive(Clone)]
struct Inner<T> {
    value: T,
    /// Animation template; `None` for a static item.
    template: Option<Arc<Template>>,
    /// Source location.
    place: Option<SourceSpan>,
    state: ValidationState,
    passed: Passed,
}

/// [`Description::names_hash`](crate::Description::names_hash) of the scene in which a changed value
/// passed validation; 0 for none.
#[derive(Debug, Default)]
struct Passed(AtomicU64);

impl Clone for Passed {
    /// The clone of an item is about to be changed.
    fn clone(&self) -> Self {
        Self::default()
    }
}

/// Validation state of an item.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum ValidationState {
    /// The value was validated and equals the template's value at the scene's frame.
    Checked,
    /// A program created or changed the value.
    Changed,
}

/// Animation template of an item: its JSON with unevaluated expressions and value forms.
#[derive(Debug)]
pub(crate) struct Template {
    /// The JSON.
    pub node: Node,
    /// Whether the value changes with time; otherwise it depends on variables and paths only.
    pub depends_on_time: bool,
    /// Setters that replace reading the JSON at another time, where the template allows that.
    pub setters: Option<TransformSetters>,
}

impl Template {
    /// Creates the template of an item with this JSON.
    pub fn new(node: Node, depends_on_time: bool, programs: &Programs) -> Self {
        let setters = depends_on_time.then(|| TransformSetters::from_object_json(&node, programs)).flatten();
        Self { node, depends_on_time, setters }
    }
}

impl<T> Item<T> {
    /// Returns the item marked as validated, with its source location and template.
    pub(crate) fn with_source(mut self, place: Option<SourceSpan>, template: Option<Arc<Template>>) -> Self
    where
        T: Clone,
    {
        self.set_source(place, template);
        self
    }

    /// Marks the value as validated and sets its source location and template.
    pub(crate) fn set_source(&mut self, place: Option<SourceSpan>, template: Option<Arc<Template>>)
    where
        T: Clone,
    {
        let inner = Arc::make_mut(&mut self.0);
        (inner.place, inner.template, inner.state) = (place, template, ValidationState::Checked);
    }

    /// Sets the animation template.
    pub(crate) fn set_template(&mut self, template: Option<Arc<Template>>)
    where
        T: Clone,
    {
        Arc::make_mut(&mut self.0).template = template;
    }

    /// Whether both share the same memory.
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }

    /// Animation template. After an edit by a program, this is the template before the edit.
    pub(crate) fn template(&self) -> Option<&Arc<Template>> {
        self.0.template.as_ref()
    }

    /// Source location.
    pub(crate) fn place(&self) -> Option<SourceSpan> {
        self.0.place
    }

    /// Whether a program has created or changed the value since the scene was read.
    pub(crate) fn is_changed(&self) -> bool {
        self.0.state == ValidationState::Changed
    }

    /// Whether the value has passed validation in a scene whose names have this hash.
    pub(crate) fn has_passed(&self, names: u64) -> bool {
        self.0.passed.0.load(Relaxed) == names
    }

    /// Remembers that the value has passed validation in a scene whose names have this hash.
    pub(crate) fn set_passed(&self, names: u64) {
        self.0.passed.0.store(names, Relaxed);
    }

    /// Mutable access that keeps the validation state.
    pub(crate) fn value_mut_unmarked(&mut self) -> &mut T
    where
        T: Clone,
    {
        let inner = Arc::make_mut(&mut self.0);
        inner.passed = Passed::default();
        &mut inner.value
    }

    /// Unwraps the value.
    pub fn into_inner(self) -> T
    where
        T: Clone,
    {
        Arc::try_unwrap(self.0).map_or_else(|shared| shared.value.clone(), |inner| inner.value)
    }
}

impl<T> Clone for Item<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> From<T> for Item<T> {
    fn from(value: T) -> Self {
        let state = ValidationState::Changed;
        Self(Arc::new(Inner { value, template: None, place: None, state, passed: Passed::default() }))
    }
}

impl<T: Default> Default for Item<T> {
    fn default() -> Self {
        Self::from(T::default())
    }
}

impl<T> Deref for Item<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0.value
    }
}

impl<T: Clone> DerefMut for Item<T> {
    fn deref_mut(&mut self) -> &mut T {
        let inner = Arc::make_mut(&mut self.0);
        (inner.state, inner.passed) = (ValidationState::Changed, Passed::default());
        &mut inner.value
    }
}

impl<T: PartialEq> PartialEq for Item<T> {
    fn eq(&self, other: &Self) -> bool {
        self.is_same(other) || self.0.value == other.0.value
    }
}

impl<T: PartialEq> PartialEq<T> for Item<T> {
    fn eq(&self, other: &T) -> bool {
        self.0.value == *other
    }
}

impl<T: fmt::Debug> fmt::Debug for Item<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.value.fmt(f)
    }
}

impl<T: Serialize> Serialize for Item<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.value.serialize(serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Item<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        T::deserialize(deserializer).map(Self::from)
    }
}

impl<T: JsonSchema> JsonSchema for Item<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }

    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }

    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
