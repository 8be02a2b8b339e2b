//! Objects: a shape, a group, a list of objects, a chain, a limb or a model, with transform and
//! material.
//!
//! ```json
//! {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": [0, 1, 0]}], "material": "red"}
//! ```

#[cfg(doc)]
use super::Render;
use super::render::is_false;
use super::{Chain, Instances, Limb, Model, Objects, Rotate, ScaleFactors, TransformStep, transform};
use crate::item::Item;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_math::Vec3;
use juggler_shape::{AnyShape, Mesh};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Object of the scene. Requires exactly one of `shape`, `group`, `objects`, `chain`, `limb` and
/// `model`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(extend("oneOf" = [
    {"required": ["shape"]},
    {"required": ["group"]},
    {"required": ["objects"]},
    {"required": ["chain"]},
    {"required": ["limb"]},
    {"required": ["model"]}
]))]
pub struct Object {
    /// Name of the object. In the scene's own `objects`, it identifies the object in masks; objects
    /// of equal name share a mask. It does not affect the image.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Single shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<AnyShape>,
    /// Name of a group of the scene, all of whose objects are placed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<GroupName>,
    /// Child objects, with this object's transform applied to all of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub objects: Option<Objects>,
    /// Row of spheres between two end spheres.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chain: Option<Box<Chain>>,
    /// Spheres along two bones that meet in a joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limb: Option<Box<Limb>>,
    /// Model file of another format.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<Box<Model>>,
    /// Instances of the object: it is placed once for each of them, then by `transform`. In memory, a
    /// scene may have millions.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub instances: Option<Box<Instances>>,
    /// Transform from the object's space to that of its parent: a list of steps, applied in order,
    /// or a single step. Defaults to the identity.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "transform::steps")]
    #[schemars(with = "transform::TransformInput")]
    pub transform: Vec<TransformStep>,
    /// Material: inline, or the name of a material of the scene. Defaults to the material of the
    /// enclosing object or group, or else to a gray diffuse `phong` material.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<MaterialRef>,
    /// Light group of the emitters inside this object; each light group is written to an AOV of its
    /// own. It has an effect only in the scene's own `objects`. Without it, the object belongs to
    /// the group `rest`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_group: Option<String>,
    /// Whether the object is a shadow catcher: in a transparent picture ([`transparent`
    /// ](Render::transparent)) the camera sees only the shadows that other objects cast on it, as
    /// black whose alpha is the lost fraction of the light. Other objects see the whole object. It
    /// has an effect only in the scene's own `objects`.
    #[serde(skip_serializing_if = "is_false")]
    pub shadow_catcher: bool,
    /// Whether the scene contains the object with its children. Numbers other than 0 count as
    /// `true`, so an expression such as `"=seconds >= 1"` can show and hide the object.
    #[serde(skip_serializing_if = "Visible::is_default")]
    pub visible: Visible,
}

/// Whether the scene contains an object: a boolean, or a number, which expressions yield, where 0
/// means `false`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "VisibleInput", into = "bool")]
pub struct Visible(pub bool);

/// Boolean, or a number, which expressions yield, where 0 means `false`.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Visible")]
enum VisibleInput {
    /// `true` or `false`.
    Flag(bool),
    /// 0 hides the object, any other number shows it.
    Number(f64),
}

impl Default for Visible {
    fn default() -> Self {
        Self(true)
    }
}

impl From<VisibleInput> for Visible {
    fn from(input: VisibleInput) -> Self {
        Self(match input {
            VisibleInput::Flag(flag) => flag,
            VisibleInput::Number(number) => number != 0.0,
        })
    }
}

impl From<Visible> for bool {
    fn from(visible: Visible) -> Self {
        visible.0
    }
}

impl Visible {
    fn is_default(&self) -> bool {
        self.0
    }
}

/// Name of a group of the scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct GroupName(pub String);

impl Object {
    /// Whether the scene contains the object. Hidden objects, objects with a scale of 0, and their
    /// children are neither placed nor counted.
    pub fn is_visible(&self) -> bool {
        self.visible.0 && !self.is_flat()
    }

    /// Whether a step of the transform scales by 0. At a frame of an animation, the object is then
    /// absent; otherwise it is an error.
    pub(crate) fn is_flat(&self) -> bool {
        self.transform.iter().any(TransformStep::is_flat)
    }

    /// Mesh of the object, if its shape is one.
    pub fn mesh(&self) -> Option<&Mesh> {
        self.shape.as_ref()?.mesh()
    }

    /// Number of times that the object is placed for each placement of its list.
    pub fn instance_count(&self) -> u64 {
        self.instances.as_ref().map_or(1, |instances| instances.count() as u64)
    }

    /// Whether the object, or an object inside it, has instances of a file.
    pub(crate) fn has_instance_file(&self) -> bool {
        let own = self.instances.as_ref().is_some_and(|instances| instances.file.is_some());
        own || self.inner().iter().any(|inner| inner.has_instance_file())
    }

    /// Child objects listed in `objects`; empty for all other kinds of objects.
    pub fn inner(&self) -> &[Item<Self>] {
        self.objects.as_ref().map(|objects| objects.as_slice()).unwrap_or_default()
    }

    /// Creates an object of a single shape.
    pub fn new(shape: impl Into<AnyShape>) -> Self {
        Self { shape: Some(shape.into()), ..Self::default() }
    }

    /// Creates an object that places a group of the scene.
    pub fn group(name: impl Into<String>) -> Self {
        Self { group: Some(GroupName(name.into())), ..Self::default() }
    }

    /// Creates an object of several child objects.
    pub fn several(objects: impl IntoIterator<Item = Self>) -> Self {
        Self { objects: Some(objects.into_iter().map(Item::from).collect()), ..Self::default() }
    }

    /// Creates an object of spheres in a row.
    pub fn chain(chain: Chain) -> Self {
        Self { chain: Some(chain.into()), ..Self::default() }
    }

    /// Creates an object of spheres along two bones.
    pub fn limb(limb: Limb) -> Self {
        Self { limb: Some(limb.into()), ..Self::default() }
    }

    /// Creates an object of a model file.
    pub fn model(model: Model) -> Self {
        Self { model: Some(model.into()), ..Self::default() }
    }

    /// Sets the name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// Appends a translation to the transform.
    #[must_use]
    pub fn at(self, x: f32, y: f32, z: f32) -> Self {
        self.transformed(TransformStep::Translate(Vec3::new(x, y, z)))
    }

    /// Appends a rotation about an axis through the origin, by an angle in degrees.
    #[must_use]
    pub fn rotated(self, axis: impl Into<Vec3>, degrees: f32) -> Self {
        self.transformed(TransformStep::Rotate(Rotate::new(axis, degrees).into()))
    }

    /// Appends a uniform scaling about the origin.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        self.transformed(TransformStep::Scale(ScaleFactors::All(factor)))
    }

    /// Appends a transform step.
    #[must_use]
    pub fn transformed(mut self, step: TransformStep) -> Self {
        // Most objects have one step.
        self.transform.reserve_exact(1);
        self.transform.push(step);
        self
    }

    /// Places the object once for each instance.
    #[must_use]
    pub fn instances(mut self, instances: Instances) -> Self {
        self.instances = Some(instances.into());
        self
    }

    /// Makes the object a shadow catcher, or a surface as others.
    #[must_use]
    pub fn shadow_catcher(mut self, shadow_catcher: bool) -> Self {
        self.shadow_catcher = shadow_catcher;
        self
    }

    /// Shows or hides the object.
    #[must_use]
    pub fn visible(mut self, visible: bool) -> Self {
        self.visible = Visible(visible);
        self
    }

    /// Sets an inline material.
    #[must_use]
    pub fn material(mut self, material: impl Into<AnyMaterial>) -> Self {
        self.material = Some(MaterialRef::Inline(Box::new(material.into())));
        self
    }

    /// Sets a material of the scene by its name.
    #[must_use]
    pub fn material_named(mut self, name: impl Into<String>) -> Self {
        self.material = Some(MaterialRef::Name(name.into()));
        self
    }
}
