//! Animation built by programs.

use crate::animate::{Along, Animate, Joint, Key, KeyTime, Posed, ValueForm, ValueSource};
use crate::animated::Animated;
use crate::description::{Animation, BackgroundInput, Object, ScenePath};
use crate::item::Item;
use crate::motion::ItemContent;
use crate::path::Path;
use crate::report::{Finding, Problems};
use crate::{Scene, SceneError};
use juggler_camera::AnyCamera;
use juggler_imaging::Tone;
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::AnyMaterial;
use juggler_texture::AnyTexture;
use serde::Serialize;
use serde_json::json;

impl From<ValueForm> for ValueSource {
    fn from(form: ValueForm) -> Self {
        Self::from_form(&form)
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

impl From<Posed> for ValueSource {
    fn from(posed: Posed) -> Self {
        ValueForm::Posed(posed).into()
    }
}

impl Animate {
    /// Creates keyframes from pairs of a time, in [`Seconds`](crate::animate::Seconds) or
    /// [`Frames`](crate::animate::Frames), and a value, in increasing order of time: numbers, arrays of
    /// numbers, colors or rotations of one form.
    ///
    /// ```
    /// use juggler_scene::animate::{Animate, Frames, Interpolation, Seconds};
    /// let keys = Animate::from_keys([(Seconds(0.0), [0.0, 1.0, 0.0]), (Seconds(1.5), [2.0, 0.0, 0.0])]);
    /// let smooth = Animate { interpolation: Interpolation::Smooth, ..keys };
    /// let light = Animate::from_keys([(Frames(0.0), 0.0), (Frames(12.0), 40.0)]);
    /// ```
    pub fn from_keys<T: KeyTime, V: Serialize>(keys: impl IntoIterator<Item = (T, V)>) -> Self {
        let key = |(time, value): (T, V)| Key(json!([time.number(), value]));
        Self {
            keys: keys.into_iter().map(key).collect(),
            at: T::NOW.map(|now| ValueSource::expression(now).into()),
            interpolation: Default::default(),
            ease: Default::default(),
            repeat: Default::default(),
        }
    }
}

/// Animating a scene. Errors are those of [`Scene::with_value`]. Variables, paths, materials, textures
/// and groups that an animated item names are added before it.
impl Scene {
    /// Sets the number of frames and the frames per second. What moves is evaluated again.
    #[must_use]
    pub fn frames(mut self, frames: u32, frames_per_second: f64) -> Self {
        let animation = Animation { frames, frames_per_second };
        if !self.description.templates(|_| true).is_empty() {
            let value = serde_json::to_value(animation).unwrap_or_default();
            // Compilation reports invalid numbers.
            if let Ok(scene) = self.with_value(&Path::root().key("animation").pointer(), value) {
                return scene;
            }
        }
        self.description.animation = animation;
        self
    }

    /// Adds an object with animated fields.
    pub fn add_animated(mut self, object: Animated<Object>) -> Result<Self, SceneError> {
        let path = Path::root().key("objects").index(self.description.objects.len());
        self.description.objects.push(Item::from(object.value().clone()));
        self.animate(&path, object.sources(|object| json_with_children(object.clone())))
    }

    /// Adds a light with animated fields.
    pub fn animated_light(mut self, light: Animated<impl Into<AnyLight> + Clone>) -> Result<Self, SceneError> {
        let light = light.map(Into::into);
        let path = Path::root().key("lights").index(self.description.lights.len());
        self.description.lights.push(Item::from(light.value().clone()));
        self.animate_fields(&path, light)
    }

    /// Adds a material with animated fields under a name.
    pub fn animated_material(
        self,
        name: impl Into<String>,
        material: Animated<impl Into<AnyMaterial> + Clone>,
    ) -> Result<Self, SceneError> {
        let (name, material) = (name.into(), material.map(Into::into));
        let path = Path::root().key("materials").key(name.as_str());
        self.material(name, material.value().clone()).animate_fields(&path, material)
    }

    /// Adds a texture with animated fields under a name.
    pub fn animated_texture(
        self,
        name: impl Into<String>,
        texture: Animated<impl Into<AnyTexture> + Clone>,
    ) -> Result<Self, SceneError> {
        let (name, texture) = (name.into(), texture.map(Into::into));
        let path = Path::root().key("textures").key(name.as_str());
        self.texture(name, texture.value().clone()).animate_fields(&path, texture)
    }

    /// Adds a camera with animated fields under a name.
    pub fn animated_camera(
        self,
        name: impl Into<String>,
        camera: Animated<impl Into<AnyCamera> + Clone>,
    ) -> Result<Self, SceneError> {
        let (name, camera) = (name.into(), camera.map(Into::into));
        let path = Path::root().key("cameras").key(name.as_str());
        self.camera(name, camera.value().clone()).animate_fields(&path, camera)
    }

    /// Sets a background with animated fields.
    pub fn animated_background(
        self,
        background: Animated<impl Into<AnyBackground> + Clone>,
    ) -> Result<Self, SceneError> {
        let background = background.map(Into::into);
        let scene = self.background(background.value().clone());
        scene.animate_fields(&Path::root().key("background"), background.map(BackgroundInput::from))
    }

    /// Sets the tone mapping, with animated fields.
    pub fn animated_tone(self, tone: Animated<Tone>) -> Result<Self, SceneError> {
        let scene = self.tone(tone.value().clone());
        scene.animate_fields(&Path::root().key("tone"), tone)
    }

    /// Sets the sources of the fields of the item at `path`.
    fn animate_fields<T: ItemContent>(self, path: &Path, animated: Animated<T>) -> Result<Self, SceneError> {
        self.animate(path, animated.sources(ItemContent::json_without_arrays))
    }

    /// Sets sources at paths within the item at `path`.
    fn animate(
        mut self,
        path: &Path,
        sources: Vec<(Result<Path, &'static str>, ValueSource)>,
    ) -> Result<Self, SceneError> {
        for (inner, source) in sources {
            let inner = inner.map_err(|reason| {
                let finding = Finding::error(format!("a field with a source {reason}")).at(path);
                SceneError::Problems(Problems::new(vec![finding], self.sources().clone(), &|_| None))
            })?;
            let field = Path::from_steps(path.steps().iter().chain(inner.steps()));
            self = self.with_value(&field.pointer(), source.into())?;
        }
        Ok(self)
    }

    /// Adds a variable for expressions, or replaces the variable of that name. A variable may use
    /// those added before it.
    pub fn variable(self, name: &str, source: impl Into<ValueSource>) -> Result<Self, SceneError> {
        self.with_value(&Path::root().key("variables").key(name).pointer(), source.into().into())
    }

    /// Adds a curve for [`Along`], or replaces the curve of that name.
    pub fn path(self, name: &str, path: ScenePath) -> Result<Self, SceneError> {
        let value = serde_json::to_value(path).unwrap_or_default();
        self.with_value(&Path::root().key("paths").key(name).pointer(), value)
    }
}

/// JSON of an object and its child objects, without the arrays of their meshes.
fn json_with_children(object: Object) -> serde_json::Value {
    serde_json::to_value(without_arrays(object)).unwrap_or_default()
}

fn without_arrays(mut object: Object) -> Object {
    if let Some(mesh) = object.shape.as_mut().and_then(|shape| shape.mesh_mut()) {
        mesh.clear_arrays();
    }
    let children = object.objects.take();
    object.objects = children.map(|all| all.iter().map(|child| without_arrays((**child).clone()).into()).collect());
    object
}

#[cfg(test)]
mod tests;
