//! Values of which sources give some fields at each frame.

use crate::animate::ValueSource;
use crate::description::{Object, Rotate, ScaleFactors, TransformStep};
use crate::field_value::FieldValue;
use crate::path::{Path, Step};
use juggler_math::Vec3;
use serde_json::{Map, Value};

/// Value of which sources give some fields at each frame: an object, light, material, texture,
/// camera, background, tone or render settings, or a part of one.
///
/// ```
/// use juggler_scene::animate::{Animate, Seconds};
/// use juggler_scene::{Animated, Object, Scene, ValueSource};
/// use juggler_shape::Sphere;
///
/// // A sphere that grows, and falls while it does.
/// let sphere = Animated::new(Sphere::default())
///     .field(|sphere| &mut sphere.radius, ValueSource::expression("1 + seconds/10"));
/// let fall = Animate::from_keys([(Seconds(0.0), [0.0, 2.0, 0.0]), (Seconds(1.0), [0.0; 3])]);
/// let scene = Scene::new().frames(30, 30.0).add_animated(sphere.map(Object::new).moved(fall))?;
/// let (first, last) = (scene.compile()?, scene.at_frame(30.0)?.compile()?);
/// assert_eq!((first.bounds.max.y, last.bounds.max.y), (3.0, 1.1));
/// # Ok::<(), juggler_scene::SceneError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Animated<T> {
    value: T,
    fields: Vec<AnimatedField<T>>,
}

/// Field of a value with its source.
#[derive(Clone, Debug)]
struct AnimatedField<T> {
    /// The value with another content of the field alone. The place of the field in the scene format
    /// is where the JSON of both values differs.
    changed: T,
    source: ValueSource,
}

impl<T: Clone> Animated<T> {
    /// Creates a value of which all fields are constant.
    pub fn new(value: T) -> Self {
        Self { value, fields: Vec::new() }
    }

    /// Sets the source of the field that `field` selects, whose own content is not used then. It must
    /// be valid if other fields have sources, too. Of two sources of a field, the last counts.
    #[must_use]
    pub fn field<V: FieldValue>(mut self, field: impl Fn(&mut T) -> &mut V, source: impl Into<ValueSource>) -> Self {
        let mut changed = self.value.clone();
        let content = field(&mut changed);
        *content = content.other();
        self.fields.push(AnimatedField { changed, source: source.into() });
        self
    }

    /// Converts the value and keeps the sources of its fields: `map(Object::new)` makes an animated
    /// object of an animated shape.
    #[must_use]
    pub fn map<U>(self, convert: impl Fn(T) -> U) -> Animated<U> {
        let field = |field: AnimatedField<T>| AnimatedField { changed: convert(field.changed), source: field.source };
        Animated { fields: self.fields.into_iter().map(field).collect(), value: convert(self.value) }
    }

    /// The value, with the contents that animated fields had.
    pub(crate) fn value(&self) -> &T {
        &self.value
    }

    /// Sources of the fields with their paths in the JSON that `json` makes of a value. For a field
    /// without one place in the JSON, the path is the reason.
    pub(crate) fn sources(self, json: impl Fn(&T) -> Value) -> Vec<(Result<Path, &'static str>, ValueSource)> {
        let value = json(&self.value);
        let place = |field: AnimatedField<T>| (difference(&value, &json(&field.changed)), field.source);
        self.fields.into_iter().map(place).collect()
    }
}

/// Animated transforms. Each step is appended to the object's transform.
///
/// Keys and other value forms read the object again at each time of an open shutter. A large mesh of
/// arrays is best placed by a group of the scene ([`Object::group`]), which is read once.
impl Animated<Object> {
    /// Appends a translation whose vector, three numbers, comes from a source.
    #[must_use]
    pub fn moved(self, source: impl Into<ValueSource>) -> Self {
        self.step([Vec3::ZERO, Vec3::ONE].map(TransformStep::Translate), source)
    }

    /// Appends a rotation about an axis through the origin, by an angle in degrees from a source.
    #[must_use]
    pub fn rotated(self, axis: impl Into<Vec3>, source: impl Into<ValueSource>) -> Self {
        let axis = axis.into();
        self.step([0.0, 1.0].map(|degrees| TransformStep::Rotate(Rotate { axis, degrees }.into())), source)
    }

    /// Appends a rotation about the origin by a quaternion `[x, y, z, w]` from a source, such as keys
    /// with the interpolation [`Slerp`](crate::animate::Interpolation::Slerp).
    #[must_use]
    pub fn oriented(self, source: impl Into<ValueSource>) -> Self {
        self.step([[0.0; 4], [1.0; 4]].map(TransformStep::Orient), source)
    }

    /// Appends a scaling about the origin. The source gives one factor, or a factor for each axis.
    #[must_use]
    pub fn scaled(self, source: impl Into<ValueSource>) -> Self {
        self.step([1.0, 2.0].map(|factor| TransformStep::Scale(ScaleFactors::All(factor))), source)
    }

    /// Appends a step. Both steps differ in the value that the source gives.
    fn step(self, steps: [TransformStep; 2], source: impl Into<ValueSource>) -> Self {
        let [step, other] = steps;
        let changed = self.value.clone().transformed(other);
        let mut moved = self.map(|object| object.transformed(step.clone()));
        moved.fields.push(AnimatedField { changed, source: source.into() });
        moved
    }
}

/// Path of the innermost value that contains all differences: a number, a text, or an array of
/// these. Fails if there is no difference, or if it is in several values.
fn difference(a: &Value, b: &Value) -> Result<Path, &'static str> {
    let steps: Vec<(Step, &Value, &Value)> = match (a, b) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            keys.map(|key| (Step::Key(key.clone()), member(a, key), member(b, key))).collect()
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().map(|(i, (a, b))| (Step::Index(i), a, b)).collect()
        }
        _ if a == b => return Err("is not part of the scene format"),
        _ => return Ok(Path::root()),
    };
    let different: Vec<_> = steps.into_iter().filter(|(_, a, b)| a != b).collect();
    let is_plain = |value: &Value| !value.is_object() && !value.is_array();
    match different.as_slice() {
        [] => Err("is not part of the scene format"),
        [(step, a, b)] => {
            let inner = difference(a, b)?;
            Ok(Path::from_steps(std::iter::once(step).chain(inner.steps())))
        }
        several if a.is_array() && several.iter().all(|(_, a, b)| is_plain(a) && is_plain(b)) => Ok(Path::root()),
        _ => Err("determines several values of the scene format"),
    }
}

/// Value of a member; null if there is none.
fn member<'v>(of: &'v Map<String, Value>, key: &str) -> &'v Value {
    of.get(key).unwrap_or(&Value::Null)
}
