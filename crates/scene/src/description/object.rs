//! Objects: a shape, a group or a row of spheres, in its place.
//!
//! ```json
//! {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": [0, 1, 0]}], "material": "red"}
//! ```

use super::{Axes, Chain, Limb, Objects, Rotate, TransformStep, transform};
use crate::item::Item;
use juggler_material::{AnyMaterial, MaterialRef};
use juggler_math::Vec3;
use juggler_shape::AnyShape;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Something to be seen: exactly one of `shape`, `group`, `objects`, `chain` and `limb`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(extend("oneOf" = [
    {"required": ["shape"]},
    {"required": ["group"]},
    {"required": ["objects"]},
    {"required": ["chain"]},
    {"required": ["limb"]}
]))]
pub struct Object {
    /// A name for people.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// One shape.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shape: Option<AnyShape>,
    /// All objects of one of the scene's groups.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<GroupName>,
    /// Several objects as one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub objects: Option<Objects>,
    /// Spheres in a row from one to another.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub chain: Option<Chain>,
    /// Spheres along two bones that meet in a joint.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub limb: Option<Limb>,
    /// How it is moved, turned and scaled into place: steps in order, or a single step.
    #[serde(skip_serializing_if = "Vec::is_empty", deserialize_with = "transform::steps")]
    #[schemars(with = "transform::Steps")]
    pub transform: Vec<TransformStep>,
    /// What it is made of: a material, or the name of one of the scene's. Without one it takes that of the group
    /// that holds it, or else a plain grey.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub material: Option<MaterialRef>,
    /// The group of lights that the light of what shines in it is kept apart with in layers. It counts where it stands in the
    /// scene's own `objects`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub light_group: Option<String>,
    /// Whether it is there, with all that it holds: yes, unless this is `false` or 0.
    #[serde(skip_serializing_if = "Visible::is_default")]
    pub visible: Visible,
}

/// Whether something is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(from = "Said", into = "bool")]
pub struct Visible(pub bool);

/// How it is written: true, or any number but 0, as expressions give them.
#[derive(Deserialize, JsonSchema)]
#[serde(untagged)]
#[schemars(rename = "Visible")]
enum Said {
    /// Yes or no.
    Flag(bool),
    /// Not when it is 0.
    Number(f64),
}

impl Default for Visible {
    fn default() -> Self {
        Self(true)
    }
}

impl From<Said> for Visible {
    fn from(said: Said) -> Self {
        Self(match said {
            Said::Flag(flag) => flag,
            Said::Number(number) => number != 0.0,
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

/// Name of one of the scene's groups.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct GroupName(pub String);

impl Object {
    /// Whether it is there at all, with what it holds: else it is neither placed nor counted.
    pub fn is_visible(&self) -> bool {
        self.visible.0
    }

    /// The objects that it holds itself.
    pub fn inner(&self) -> &[Item<Self>] {
        self.objects.as_ref().map(|objects| objects.as_slice()).unwrap_or_default()
    }

    /// One shape around the origin.
    pub fn new(shape: impl Into<AnyShape>) -> Self {
        Self { shape: Some(shape.into()), ..Self::default() }
    }

    /// All objects of one of the scene's groups.
    pub fn group(name: impl Into<String>) -> Self {
        Self { group: Some(GroupName(name.into())), ..Self::default() }
    }

    /// Several objects as one.
    pub fn several(objects: impl IntoIterator<Item = Self>) -> Self {
        Self { objects: Some(objects.into_iter().map(Item::from).collect()), ..Self::default() }
    }

    /// Spheres in a row.
    pub fn chain(chain: Chain) -> Self {
        Self { chain: Some(chain), ..Self::default() }
    }

    /// Spheres along two bones.
    pub fn limb(limb: Limb) -> Self {
        Self { limb: Some(limb), ..Self::default() }
    }

    /// Gives it a name.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// Moves it, after what was done before.
    #[must_use]
    pub fn at(self, x: f32, y: f32, z: f32) -> Self {
        self.transformed(TransformStep::Translate(Vec3::new(x, y, z)))
    }

    /// Turns it about an axis through the origin, after what was done before.
    #[must_use]
    pub fn rotated(self, axis: impl Into<Vec3>, degrees: f32) -> Self {
        self.transformed(TransformStep::Rotate(Rotate { axis: axis.into(), degrees }))
    }

    /// Scales it about the origin, after what was done before.
    #[must_use]
    pub fn scaled(self, factor: f32) -> Self {
        self.transformed(TransformStep::Scale(Axes::All(factor)))
    }

    /// Adds any step, after what was done before.
    #[must_use]
    pub fn transformed(mut self, step: TransformStep) -> Self {
        self.transform.push(step);
        self
    }

    /// Shows it or leaves it out.
    #[must_use]
    pub fn visible(mut self, visible: bool) -> Self {
        self.visible = Visible(visible);
        self
    }

    /// Makes it of a material.
    #[must_use]
    pub fn material(mut self, material: impl Into<AnyMaterial>) -> Self {
        self.material = Some(MaterialRef::Inline(Box::new(material.into())));
        self
    }

    /// Makes it of one of the scene's materials.
    #[must_use]
    pub fn material_named(mut self, name: impl Into<String>) -> Self {
        self.material = Some(MaterialRef::Name(name.into()));
        self
    }
}
