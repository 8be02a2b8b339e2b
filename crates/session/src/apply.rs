//! Edits of a subject: what an edit changes at once, and what must be built first.

use crate::build::{BuildRequest, MAX_DENOISED_PIXELS, MAX_PIXELS, SceneChange, SceneSource, error_text, pixel_count};
use crate::choices::Choices;
use crate::edit::{Edit, Setting};
use crate::pose;
use crate::subject::Subject;
use juggler::camera::AnyCamera;
use juggler::denoise::Denoiser;
use juggler::integrator::IntegratorKind;
use juggler::math::Rgb;
use juggler::{MAX_GAIN, Settings, View};
use std::sync::Arc;

/// Effect of an edit.
pub enum EditEffect {
    /// The picture is unchanged.
    Nothing,
    /// [`Subject::picture`] is already a new one.
    View,
    /// A world must be built first.
    Build(Box<BuildRequest>),
}

fn can_be_denoised(size: [u32; 2]) -> Result<(), String> {
    if pixel_count(size) <= MAX_DENOISED_PIXELS {
        return Ok(());
    }
    let [width, height] = size;
    Err(format!(
        "error: {width} x {height} are more pixels than the limit of {MAX_DENOISED_PIXELS} for the denoised preview"
    ))
}

impl EditEffect {
    fn build(request: BuildRequest) -> Self {
        Self::Build(Box::new(request))
    }
}

impl Subject {
    /// Applies an edit, or returns the build it requires. An error leaves the subject unchanged.
    /// Edits that do not concern the picture are ignored.
    pub fn apply(&mut self, edit: &Edit) -> Result<EditEffect, String> {
        match edit {
            Edit::Scene(name) => Ok(EditEffect::build(self.open(name))),
            Edit::Files(scene) => Ok(EditEffect::build(self.open(&scene.name).with_files(scene.files.clone()))),
            Edit::Reload => Ok(EditEffect::build(self.build(SceneChange::Reload))),
            Edit::Reset => Ok(EditEffect::build(self.reset())),
            Edit::Set { path, value } => {
                let (path, value) = (path.clone(), value.clone());
                Ok(EditEffect::build(self.build(SceneChange::Value { path, value })))
            }
            Edit::At(frame) => {
                let frame = self.animation().map_or(0.0, |animation| frame.clamp(0.0, f64::from(animation.frames)));
                if frame == self.frame() || !frame.is_finite() {
                    return Ok(EditEffect::Nothing);
                }
                Ok(EditEffect::build(self.build(SceneChange::Frame(frame))))
            }
            Edit::Setting(setting) => self.set(setting),
            Edit::Pivot(pixel) => {
                self.pivot(*pixel);
                Ok(EditEffect::Nothing)
            }
            Edit::Fly(_) | Edit::Orbit(_) | Edit::Zoom(_) | Edit::Focus(_) | Edit::Frame(_) => self.navigate(edit),
            Edit::Camera(name) => self.select_camera(name),
            Edit::Look(camera) => self.set_camera(camera.clone(), true),
            Edit::Bookmark(_) | Edit::Play(_) | Edit::Show(_) | Edit::Region(_) => Ok(EditEffect::Nothing),
        }
    }

    /// Requests another scene with the same size and denoiser.
    fn open(&self, name: &str) -> BuildRequest {
        let Settings { size, denoiser, .. } = self.choices.settings;
        let mut build = BuildRequest::open(name, size).with_lenient(self.lenient);
        (build.choices.size, build.choices.settings.denoiser) = (self.choices.size, denoiser);
        build
    }

    /// Requests the scene as it was opened, with the same denoiser and bookmarks.
    fn reset(&self) -> BuildRequest {
        let (size, bookmarks) = (self.choices.size, self.choices.bookmarks.clone());
        let settings = Settings { size, denoiser: self.choices.settings.denoiser, ..Settings::default() };
        let choices = Choices { settings, size, bookmarks, ..Choices::default() };
        BuildRequest { choices, ..self.build(SceneChange::Reset) }
    }

    /// Requests this subject with a change of its scene.
    fn build(&self, change: SceneChange) -> BuildRequest {
        let keeps_models = matches!(change, SceneChange::None | SceneChange::Frame(_));
        BuildRequest {
            source: SceneSource::Edited(self.scene.clone(), change),
            name: self.name.clone(),
            lenient: self.lenient,
            given: Arc::default(),
            choices: self.choices.clone(),
            models: keeps_models.then(|| Arc::clone(&self.models)),
            interest: self.interest_is_chosen.then_some(self.interest),
            previous: Some((Arc::clone(self.scene()), Arc::clone(&self.picture))),
            max_memory: None,
        }
    }

    fn set(&mut self, setting: &Setting) -> Result<EditEffect, String> {
        let mut settings = self.choices.settings.clone();
        match setting {
            Setting::Size(size) if pixel_count(*size) > MAX_PIXELS => {
                let [width, height] = size;
                return Err(format!(
                    "error: {width} x {height} are more pixels than the limit of {MAX_PIXELS} for interactive rendering"
                ));
            }
            Setting::Size(size) if self.choices.settings.denoiser.is_some() => {
                can_be_denoised(*size)?;
                settings.size = Some(*size);
            }
            Setting::Size(size) => settings.size = Some(*size),
            Setting::Samples(samples) => settings.samples = Some(*samples),
            Setting::Integrator(kind) => settings.integrator = Some(*kind),
            Setting::Sampler(kind) => settings.sampler = Some(*kind),
            Setting::MaxDepth(depth) => settings.max_depth = Some(*depth),
            Setting::Tone(kind) => settings.curve = Some(*kind),
            Setting::Exposure(stops) => settings.exposure_stops = Some(*stops),
            Setting::Seed(seed) => settings.seed = Some(*seed),
            Setting::Gain(group, factors) => return self.set_gain(group, *factors),
            Setting::Denoise(on) => return self.denoise(*on),
            Setting::Threads(_) | Setting::Scheduler(_) => return Ok(EditEffect::Nothing),
        }
        if matches!(setting, Setting::Integrator(kind) if *kind != IntegratorKind::from(self.picture.integrator())) {
            settings.max_depth = None;
        }
        let description = &self.scene().description;
        let (mut render, mut tone) = ((*description.render).clone(), (*description.tone).clone());
        render.integrator.get_or_insert_with(|| self.scene().integrator_choice().integrator);
        settings.apply_to(&mut render, &mut tone).map_err(|error| error_text(&error))?;
        render.camera = self.picture.view().render.camera;
        self.set_view(View { camera: self.picture.view().camera, render, tone })?;
        self.choices.settings = settings;
        Ok(EditEffect::View)
    }

    /// Switches denoising. The film starts over with or without the denoiser's features.
    fn denoise(&self, on: bool) -> Result<EditEffect, String> {
        let denoiser = on.then_some(Denoiser::Own);
        if self.choices.settings.denoiser == denoiser {
            return Ok(EditEffect::Nothing);
        }
        if on {
            can_be_denoised(self.picture.size())?;
        }
        let mut build = self.build(SceneChange::None);
        build.choices.settings.denoiser = denoiser;
        Ok(EditEffect::build(build))
    }

    fn set_gain(&mut self, group: &str, factors: [f32; 3]) -> Result<EditEffect, String> {
        let known = self.picture.aovs().light_groups();
        juggler::check_name("light group", group, known.iter().map(String::as_str)).map_err(|e| error_text(&e))?;
        if !factors.iter().all(|factor| (0.0..=MAX_GAIN).contains(factor)) {
            return Err(format!("error: factors of light groups are 0 to {MAX_GAIN}"));
        }
        self.choices.gains.retain(|(other, _)| other != group);
        self.choices.gains.push((group.to_owned(), Rgb::from(factors)));
        Ok(EditEffect::View)
    }

    fn set_view(&mut self, view: View) -> Result<(), String> {
        self.picture = Arc::new(self.picture.with_view(view).map_err(|error| error_text(&error))?);
        Ok(())
    }

    /// Switches to another camera; `fresh` if it is unrelated to the previous one.
    fn set_camera(&mut self, camera: AnyCamera, fresh: bool) -> Result<EditEffect, String> {
        let upward = camera.up();
        self.set_view(View { camera: camera.clone(), ..self.picture.view() })?;
        self.choices.camera = Some(camera);
        if fresh {
            self.upward = upward;
            self.init_interest();
        } else if !self.interest_is_chosen {
            self.center_interest();
        }
        Ok(EditEffect::View)
    }

    fn select_camera(&mut self, name: &str) -> Result<EditEffect, String> {
        if let Some((_, camera)) = self.choices.bookmarks.iter().find(|(other, _)| other == name) {
            return self.set_camera(camera.clone(), true);
        }
        let settings = Settings { camera: Some(name.to_owned()), ..self.choices.settings.clone() };
        let description = &self.scene().description;
        let known = self.cameras();
        juggler::check_name("camera", name, known.iter().map(String::as_str)).map_err(|error| error_text(&error))?;
        let camera = description.cameras.get(name).or(description.camera.as_ref()).cloned();
        if let Some(camera) = camera {
            self.set_camera(camera.into_inner(), true)?;
            (self.choices.settings, self.choices.camera) = (settings, None);
        }
        Ok(EditEffect::View)
    }

    fn navigate(&mut self, edit: &Edit) -> Result<EditEffect, String> {
        let camera = self.picture.view().camera;
        let upward = self.upward;
        let moved = match edit {
            Edit::Fly(fly) => pose::fly(&camera, upward, fly),
            Edit::Orbit(orbit) => {
                self.interest_is_chosen = true;
                pose::orbit(&camera, upward, self.interest, orbit)
            }
            Edit::Zoom(factor) => pose::zoom(&camera, *factor),
            Edit::Focus(pixel) => {
                let Some((point, _)) = self.pick(*pixel) else { return Ok(EditEffect::Nothing) };
                (self.interest, self.interest_is_chosen) = (point, true);
                pose::focus(&camera, point)
            }
            Edit::Frame(pixel) => {
                let bounds = self.framing_bounds(*pixel);
                (self.interest, self.interest_is_chosen) = (bounds.center(), true);
                pose::frame(&camera, upward, &bounds, self.picture.size())
            }
            _ => None,
        };
        let Some(moved) = moved.filter(|moved| *moved != camera) else { return Ok(EditEffect::Nothing) };
        let change = self.set_camera(moved, false)?;
        if matches!(edit, Edit::Fly(_)) {
            self.drop_hidden_interest();
        }
        Ok(change)
    }
}
