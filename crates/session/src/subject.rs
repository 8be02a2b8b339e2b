//! Edited scene with the picture to render. It needs neither threads nor clocks.

use crate::choices::Choices;
use crate::edited_scene::EditedScene;
use crate::model_status::ModelStatus;
use crate::status::Status;
use juggler::camera::AnyCamera;
use juggler::camera::film::Tile;
use juggler::camera::sampler::SamplerKind;
use juggler::imaging::ToneCurveKind;
use juggler::integrator::IntegratorKind;
use juggler::math::{Rgb, Vec3};
use juggler::scene::description::Animation;
use juggler::scene::document::read_text;
use juggler::scene::{Scene, with_camera};
use juggler::{Picture, View};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Scene with its edits, camera and picture.
#[derive(Clone)]
pub struct Subject {
    /// Name under which the scene was opened.
    pub name: String,
    /// Whether missing and broken pictures of models are shown gray.
    pub(crate) lenient: bool,
    pub(crate) scene: EditedScene,
    pub(crate) models: Arc<[ModelStatus]>,
    pub(crate) choices: Choices,
    pub(crate) upward: Vec3,
    pub(crate) interest: Vec3,
    /// Whether the point of interest was chosen, and so does not follow the image center.
    pub(crate) interest_is_chosen: bool,
    pub(crate) picture: Arc<Picture>,
}

impl Subject {
    /// Returns the picture to render.
    pub fn picture(&self) -> &Arc<Picture> {
        &self.picture
    }

    /// Returns the scene with the edited values, at the current frame.
    pub fn scene(&self) -> &Arc<Scene> {
        self.scene.displayed()
    }

    /// Returns the point of interest, in world space.
    pub fn interest(&self) -> Vec3 {
        self.interest
    }

    /// Returns the current frame.
    pub fn frame(&self) -> f64 {
        self.scene.frame()
    }

    /// Returns length and frame rate of the animation, if the scene has one.
    pub fn animation(&self) -> Option<Animation> {
        let animation = self.scene().description.animation;
        (animation.frames > 1).then_some(animation)
    }

    /// Returns the diagonal of the box around all bounded objects, in scene units; 1 if there are
    /// none.
    pub fn extent(&self) -> f32 {
        let bounds = self.picture.world().bounds();
        if bounds.is_empty() { 1.0 } else { bounds.extent().length().max(f32::MIN_POSITIVE) }
    }

    /// Returns the names of all cameras, including bookmarks.
    pub fn cameras(&self) -> Vec<String> {
        let description = &self.scene().description;
        let single = description.camera.iter().map(|_| "camera".to_owned());
        let names = single.chain(description.cameras.keys().cloned());
        names.chain(self.choices.bookmarks.iter().map(|(name, _)| name.clone())).collect()
    }

    /// Returns the cameras bookmarked in memory, by name.
    pub fn bookmarks(&self) -> &[(String, AnyCamera)] {
        &self.choices.bookmarks
    }

    /// Bookmarks the current camera under a name, in memory.
    pub fn add_bookmark(&mut self, name: &str) {
        self.choices.bookmarks.retain(|(other, _)| other != name);
        self.choices.bookmarks.push((name.to_owned(), self.picture.view().camera));
    }

    /// Returns the scene file that holds bookmarks, and its text with the current camera added under a
    /// name; `None` if no file holds the scene. Bookmarks of a model or mesh are in a scene beside it,
    /// `car.json` for `car.glb`, which shows the model as it is shown now if there is no such scene yet.
    pub fn with_bookmark(&self, name: &str) -> Option<Result<(PathBuf, String), String>> {
        let path = PathBuf::from(&self.name);
        let file = self.scene.file();
        if file.is_in_memory() {
            return None;
        }
        let path = if file.is_around_file() { path.with_extension("json") } else { path };
        let text = if file.is_around_file() && !path.exists() {
            let folder = path.parent().unwrap_or(Path::new(""));
            // The model is in the folder of the scene, so that both may move.
            self.scene().to_json_in(folder).replace(&format!("\"{}/", folder.display()), "\"")
        } else {
            read_text(&path).ok()?
        };
        let edited = with_camera(&text, name, &self.picture.view().camera);
        let wrong = |error: String| format!("error: cannot save the camera in `{}`: {error}", path.display());
        Some(edited.map_err(wrong).map(|text| (path.clone(), text)))
    }

    /// Returns the files of the scene, including its meshes; none if they are in memory.
    pub fn files(&self) -> Vec<PathBuf> {
        let file = self.scene.file();
        if file.is_in_memory() { Vec::new() } else { file.paths() }
    }

    fn gain(&self, group: &str) -> Rgb {
        self.choices.gains.iter().find(|(name, _)| name == group).map_or(Rgb::WHITE, |(_, gain)| *gain)
    }

    /// Returns the gains of the picture's light groups, by index; empty if all are 1.
    pub fn gains(&self) -> Vec<Rgb> {
        let groups = self.picture.aovs().light_groups();
        let gains: Vec<Rgb> = groups.iter().map(|group| self.gain(group)).collect();
        if gains.iter().all(|gain| *gain == Rgb::WHITE) { Vec::new() } else { gains }
    }

    /// Returns the mean radiance of a tile's pixels with the light groups scaled by `gains`, see
    /// [`Self::gains`].
    pub fn light(&self, tile: &Tile, gains: &[Rgb]) -> Vec<Rgb> {
        if gains.is_empty() { tile.means() } else { self.picture.aovs().relight(tile, gains) }
    }

    /// Returns whether denoising is on and possible: relit light groups cannot be denoised.
    #[cfg(feature = "native")]
    pub(crate) fn is_denoised(&self) -> bool {
        self.picture.aovs().denoiser().is_some() && self.gains().is_empty()
    }

    /// Writes the subject's part of the status.
    pub fn write_status(&self, status: &mut Status) {
        let View { camera, render, tone } = self.picture.view();
        self.name.clone_into(&mut status.scene);
        status.size = render.size;
        status.samples_wanted = render.samples;
        status.integrator = Some(IntegratorKind::from(self.picture.integrator()));
        let max_depth = self.picture.max_depth();
        status.depth_range = max_depth.as_ref().map_or([0; 2], |(_, range)| [*range.start(), *range.end()]);
        status.max_depth = max_depth.map(|(depth, _)| depth);
        status.denoise = self.choices.settings.denoiser.is_some();
        status.sampler = Some(SamplerKind::from(&render.sampler));
        status.tone = Some(ToneCurveKind::from(&tone.curve));
        status.exposure = tone.exposure_stops;
        let groups = self.picture.aovs().light_groups();
        status.light_groups = groups.iter().map(|name| (name.clone(), self.gain(name).to_array())).collect();
        status.models = self.models.to_vec();
        status.cameras = self.cameras();
        status.camera = Some(camera);
        status.interest = self.interest.to_array();
        status.extent = self.extent();
        status.flight_speed = self.flight_speed();
        status.frame = self.frame();
        let animation = self.animation();
        status.frames = animation.map_or(0, |animation| animation.frames);
        status.frame_rate = animation.map_or(0.0, |animation| animation.frames_per_second);
    }
}
