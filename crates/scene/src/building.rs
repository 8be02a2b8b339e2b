//! Building of scenes by programs.

use crate::Scene;
use crate::asset::Asset;
use crate::description::{BackgroundInput, Object};
use crate::item::Item;
use juggler_camera::AnyCamera;
use juggler_camera::film::AnyFilter;
use juggler_camera::sampler::AnySampler;
use juggler_imaging::Tone;
use juggler_integrator::AnyIntegrator;
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::AnyMaterial;
use juggler_texture::AnyTexture;
use std::sync::Arc;

/// Building a scene.
impl Scene {
    /// Adds an object.
    #[must_use]
    #[expect(clippy::should_implement_trait, reason = "a scene is built by adding to it")]
    pub fn add(mut self, object: Object) -> Self {
        self.description.objects.push(object.into());
        self
    }

    /// Adds a light.
    #[must_use]
    pub fn light(mut self, light: impl Into<AnyLight>) -> Self {
        self.description.lights.push(light.into().into());
        self
    }

    /// Adds a material under a name.
    #[must_use]
    pub fn material(mut self, name: impl Into<String>, material: impl Into<AnyMaterial>) -> Self {
        self.description.materials.insert(name.into(), material.into().into());
        self
    }

    /// Adds a texture under a name.
    #[must_use]
    pub fn texture(mut self, name: impl Into<String>, texture: impl Into<AnyTexture>) -> Self {
        self.description.textures.insert(name.into(), texture.into().into());
        self
    }

    /// Adds an image in memory under a name, in linear light. Textures and environments refer to it
    /// by that name in place of a file's, such as
    /// [`Image::new`](juggler_texture::Image::new)`("wood")`.
    #[must_use]
    pub fn image(self, name: impl Into<String>, image: impl Into<Arc<juggler_math::Image>>) -> Self {
        self.asset(name, Asset::from_image(image))
    }

    /// Adds an asset under a name. Meshes, textures, environments and light profiles whose `file`
    /// has that name use the asset instead of a file. A program that reads the scene's JSON again
    /// gives the same assets to [`Loader::from_json_with`](crate::Loader::from_json_with).
    #[must_use]
    pub fn asset(mut self, name: impl Into<String>, asset: Asset) -> Self {
        self.asset_cache.insert_asset(name.into(), asset);
        self
    }

    /// The scene's assets with their names.
    pub fn assets(&self) -> impl Iterator<Item = (&str, &Asset)> {
        self.asset_cache.store().assets.iter()
    }

    /// Adds a group of objects under a name, for placement by [`Object::group`].
    #[must_use]
    pub fn group(mut self, name: impl Into<String>, objects: impl IntoIterator<Item = Object>) -> Self {
        self.description.groups.insert(name.into(), objects.into_iter().map(Item::from).collect());
        self
    }

    /// Adds a camera under a name; the first is used unless another is chosen.
    #[must_use]
    pub fn camera(mut self, name: impl Into<String>, camera: impl Into<AnyCamera>) -> Self {
        self.description.cameras.insert(name.into(), camera.into().into());
        self
    }

    /// Sets the background: a color, or any kind of background such as
    /// [`Sky`](juggler_light::background::Sky).
    #[must_use]
    pub fn background(mut self, background: impl Into<AnyBackground>) -> Self {
        self.description.background = Some(BackgroundInput::from(background.into()).into());
        self
    }

    /// Sets the integrator.
    #[must_use]
    pub fn integrator(mut self, integrator: impl Into<AnyIntegrator>) -> Self {
        self.description.render.integrator = Some(integrator.into());
        self
    }

    /// Sets the sampler of pixel samples.
    #[must_use]
    pub fn sampler(mut self, sampler: impl Into<AnySampler>) -> Self {
        self.description.render.sampler = sampler.into();
        self
    }

    /// Sets the reconstruction filter of the film.
    #[must_use]
    pub fn filter(mut self, filter: impl Into<AnyFilter>) -> Self {
        self.description.render.filter = filter.into();
        self
    }

    /// Sets the seed of the random numbers. Another seed gives other noise.
    #[must_use]
    pub fn seed(mut self, seed: u64) -> Self {
        self.description.render.seed = seed;
        self
    }

    /// Sets the tone mapping from linear light to the levels of an image file: curve, exposure and
    /// so on.
    #[must_use]
    pub fn tone(mut self, tone: Tone) -> Self {
        *self.description.tone = tone;
        self
    }

    /// Sets the picture's size in pixels.
    #[must_use]
    pub fn size(mut self, width: u32, height: u32) -> Self {
        self.description.render.size = [width, height];
        self
    }

    /// Sets the samples per pixel.
    #[must_use]
    pub fn samples(mut self, samples: u32) -> Self {
        self.description.render.samples = samples;
        self
    }
}
