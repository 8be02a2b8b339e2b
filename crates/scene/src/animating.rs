//! Animation built by programs.

use crate::animate::{Along, Animate, Joint, Key, ValueForm};
use crate::description::{Animation, ScenePath};
use crate::path::Path;
use crate::{Scene, SceneError};
use serde::Serialize;
use serde_json::{Value, json};

/// Source of an animated value: an expression of time, or a value form such as [`Animate`].
#[derive(Clone, Debug, PartialEq)]
pub struct ValueSource(Value);

impl ValueSource {
    /// Creates a source that evaluates an expression such as `2*pi*frame/frames` at each frame.
    pub fn expression(expression: &str) -> Self {
        Self(format!("={expression}").into())
    }
}

impl From<ValueForm> for ValueSource {
    fn from(form: ValueForm) -> Self {
        // Value forms are plain data. A number that is not finite becomes null, which is refused.
        Self(serde_json::to_value(form).unwrap_or_default())
    }
}

impl From<Animate> for ValueSource {
    fn from(animate: Animate) -> Self {
        ValueForm::Animate(animate).into()
    }
}

impl From<Along> for ValueSource {
    fn from(along: Along) -> Self {
        ValueForm::Along(along).into()
    }
}

impl From<Joint> for ValueSource {
    fn from(joint: Joint) -> Self {
        ValueForm::Joint(joint).into()
    }
}

impl Animate {
    /// Creates keyframes from pairs of a time in seconds and a value, in increasing order of time:
    /// numbers, arrays of numbers, colors or rotations of one form.
    ///
    /// ```
    /// use juggler_scene::animate::{Animate, Interpolation};
    /// let keys = Animate::from_keys([(0.0, [0.0, 1.0, 0.0]), (1.5, [2.0, 0.0, 0.0])]);
    /// let smooth = Animate { interpolation: Interpolation::Smooth, ..keys };
    /// ```
    pub fn from_keys<V: Serialize>(keys: impl IntoIterator<Item = (f64, V)>) -> Self {
        let key = |(time, value): (f64, V)| Key(json!([time, value]));
        Self {
            keys: keys.into_iter().map(key).collect(),
            at: None,
            interpolation: Default::default(),
            ease: Default::default(),
            repeat: Default::default(),
        }
    }
}

/// Animating a scene.
impl Scene {
    /// Sets the number of frames and the frames per second.
    #[must_use]
    pub fn frames(mut self, frames: u32, frames_per_second: f64) -> Self {
        self.description.animation = Animation { frames, frames_per_second };
        self
    }

    /// Animates the value at a JSON pointer. Errors are those of [`Scene::with_value`].
    ///
    /// ```
    /// use juggler_scene::animate::Animate;
    /// use juggler_scene::{Object, Scene, ValueSource};
    /// use juggler_shape::Sphere;
    ///
    /// let fall = Animate::from_keys([(0.0, 2.0), (1.0, 0.0)]);
    /// let scene = Scene::new()
    ///     .frames(30, 30.0)
    ///     .add(Object::new(Sphere::default()).at(0.0, 2.0, 0.0))
    ///     .animate("/objects/0/transform/0/translate/1", fall)?
    ///     .animate("/objects/0/shape/sphere/radius", ValueSource::expression("1 + seconds/10"))?;
    /// let (first, last) = (scene.compile()?, scene.at_frame(30.0)?.compile()?);
    /// assert_eq!((first.bounds.max.y, last.bounds.max.y), (3.0, 1.1));
    /// # Ok::<(), juggler_scene::SceneError>(())
    /// ```
    pub fn animate(self, pointer: &str, source: impl Into<ValueSource>) -> Result<Self, SceneError> {
        self.with_value(pointer, source.into().0)
    }

    /// Adds a variable for expressions, or replaces the variable of that name. A variable may use
    /// those added before it.
    pub fn variable(self, name: &str, source: impl Into<ValueSource>) -> Result<Self, SceneError> {
        self.with_value(&Path::root().key("variables").key(name).pointer(), source.into().0)
    }

    /// Adds a curve for [`Along`], or replaces the curve of that name.
    pub fn path(self, name: &str, path: ScenePath) -> Result<Self, SceneError> {
        let value = serde_json::to_value(path).unwrap_or_default();
        self.with_value(&Path::root().key("paths").key(name).pointer(), value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::animate::{Extrapolation, Interpolation, PathName};
    use crate::{Object, TransformStep};
    use juggler_math::vec3;
    use juggler_shape::Sphere;

    fn sphere() -> Scene {
        Scene::new().frames(20, 10.0).add(Object::new(Sphere::default()).at(0.0, 0.0, 0.0))
    }

    const PLACE: &str = "/objects/0/transform/0/translate";

    /// Center of the sphere at a frame.
    fn center(scene: &Scene, frame: f64) -> juggler_math::Vec3 {
        match scene.at_frame(frame).unwrap().description.objects[0].transform[..] {
            [TransformStep::Translate(by)] => by,
            ref other => panic!("{other:?}"),
        }
    }

    #[test]
    fn every_kind_of_animation_source_moves_a_value() {
        let keys = Animate {
            repeat: Extrapolation::PingPong,
            ..Animate::from_keys([(0.0, vec3(0.0, 0.0, 0.0)), (1.0, vec3(0.0, 4.0, 0.0))])
        };
        let scene = sphere().animate(PLACE, keys).unwrap();
        assert_eq!([5.0, 10.0, 15.0].map(|frame| center(&scene, frame).y), [2.0, 4.0, 2.0]);
        let path = ScenePath { points: vec![[0.0; 3], [8.0, 0.0, 0.0]], closed: false };
        let along = Along { path: PathName("line".into()), at: 0.25 };
        let scene = sphere().path("line", path).unwrap().animate(PLACE, along).unwrap();
        assert!((center(&scene, 3.0).x - 2.0).abs() < 1e-6);
        let joint = Joint {
            from: [0.0; 3],
            to: [0.0, 4.0, 0.0],
            lengths: [3.0, 3.0],
            plane_normal: [0.0, 0.0, 1.0],
            keep_lengths: true,
        };
        let scene = sphere().animate(PLACE, joint).unwrap();
        assert!((center(&scene, 0.0) - vec3(5_f32.sqrt(), 2.0, 0.0)).length() < 1e-6, "{}", center(&scene, 0.0));
        let scene = sphere().variable("half", ValueSource::expression("frame / 2")).unwrap();
        let scene = scene.animate(&format!("{PLACE}/2"), ValueSource::expression("half + 1")).unwrap();
        assert_eq!(center(&scene, 6.0).z, 4.0);
    }

    /// A scene that a program animates is the scene that its JSON describes.
    #[test]
    fn built_motion_is_written_and_read() {
        let keys = Animate { interpolation: Interpolation::Smooth, ..Animate::from_keys([(0.0, 0.0), (1.0, 2.0)]) };
        let scene = sphere().animate(&format!("{PLACE}/0"), keys).unwrap();
        let read = Scene::from_json(scene.to_json(), "scene.json").unwrap();
        assert!(read == scene && read.at_frame(7.0).unwrap() == scene.at_frame(7.0).unwrap());
    }

    #[test]
    fn wrong_sources_are_refused() {
        let refused = |scene: Result<Scene, SceneError>, words: &str| {
            let message = scene.unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        };
        refused(sphere().animate(PLACE, Animate::from_keys([(1.0, [0.0; 3]), (0.0, [0.0; 3])])), "in order of time");
        refused(sphere().animate(PLACE, Animate::from_keys([(0.0, [f64::NAN; 3])])), "number");
        refused(sphere().animate(PLACE, ValueSource::expression("nothing")), "nothing");
        refused(sphere().animate("/objects/7/visible", ValueSource::expression("1")), "objects");
        let along = Along { path: PathName("none".into()), at: 0.0 };
        refused(sphere().animate(PLACE, along), "no path is called `none`");
    }
}
