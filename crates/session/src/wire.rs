//! JSON of edits, and in `wire/status.rs` of statuses and probes, which web pages exchange with a
//! server or with the workers of a browser. The types of a session and their other clients do not know it.
//!
//! An edit is an object with one member, `{"fly": {"forward": 0.5, "yaw_degrees": 3}}`, or a string,
//! `"reset"`. Kinds are written as their names, cameras as in the scene format. Reading takes two
//! steps: [`EditMessage`] checks the form, whose errors are those of a program, and
//! [`EditMessage::read`] the names of kinds and the camera, whose errors are for users.

use crate::edit::{Channel, Edit, Fly, Orbit, Setting};
use juggler::by_name;
use juggler::camera::AnyCamera;
use juggler::camera::film::Rect;
use juggler::math::NamedKind;
use juggler::scene::camera_json;
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

mod status;

/// Edit as it arrives in JSON: its names of kinds and its camera are not read yet.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct EditMessage(EditForm);

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields, expecting = "an edit")]
enum EditForm {
    Scene(String),
    Reload,
    Fly(Fly),
    Orbit(Orbit),
    Zoom(f32),
    Focus([f32; 2]),
    Pivot([f32; 2]),
    Frame(Option<[f32; 2]>),
    Camera(String),
    Look(Value),
    Bookmark(String),
    Set { path: String, value: Value },
    Setting(SettingForm),
    At(f64),
    Play(bool),
    Show(Channel),
    Region(Option<Rect>),
    Reset,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum SettingForm {
    Size([u32; 2]),
    Samples(u32),
    Integrator(String),
    Sampler(String),
    MaxDepth(u32),
    Tone(String),
    Exposure(f32),
    Gain(String, [f32; 3]),
    Denoise(bool),
    Seed(u64),
    Threads(usize),
    Scheduler(String),
}

impl EditMessage {
    /// Reads names and camera. The error is worded as in [`Status::error`](crate::Status).
    pub fn read(self) -> Result<Edit, String> {
        Ok(match self.0 {
            EditForm::Scene(name) => Edit::Scene(name),
            EditForm::Reload => Edit::Reload,
            EditForm::Fly(fly) => Edit::Fly(fly),
            EditForm::Orbit(orbit) => Edit::Orbit(orbit),
            EditForm::Zoom(factor) => Edit::Zoom(factor),
            EditForm::Focus(pixel) => Edit::Focus(pixel),
            EditForm::Pivot(pixel) => Edit::Pivot(pixel),
            EditForm::Frame(pixel) => Edit::Frame(pixel),
            EditForm::Camera(name) => Edit::Camera(name),
            EditForm::Look(camera) => {
                Edit::Look(AnyCamera::deserialize(camera).map_err(|error| format!("error: camera: {error}"))?)
            }
            EditForm::Bookmark(name) => Edit::Bookmark(name),
            EditForm::Set { path, value } => Edit::Set { path, value },
            EditForm::Setting(setting) => Edit::Setting(setting.read()?),
            EditForm::At(frame) => Edit::At(frame),
            EditForm::Play(play) => Edit::Play(play),
            EditForm::Show(channel) => Edit::Show(channel),
            EditForm::Region(region) => Edit::Region(region),
            EditForm::Reset => Edit::Reset,
        })
    }

    /// Name of a kind that [`Self::read`] looks up; `None` for other edits.
    pub fn kind_name(&self) -> Option<&str> {
        use SettingForm::{Integrator, Sampler, Scheduler, Tone};
        match &self.0 {
            EditForm::Setting(Integrator(name) | Sampler(name) | Tone(name) | Scheduler(name)) => Some(name),
            _ => None,
        }
    }

    /// Camera that [`Self::read`] reads; `None` for other edits.
    pub fn camera(&self) -> Option<&Value> {
        match &self.0 {
            EditForm::Look(camera) => Some(camera),
            _ => None,
        }
    }
}

impl SettingForm {
    fn read(self) -> Result<Setting, String> {
        Ok(match self {
            Self::Size(size) => Setting::Size(size),
            Self::Samples(samples) => Setting::Samples(samples),
            Self::Integrator(name) => Setting::Integrator(kind("integrator", &name)?),
            Self::Sampler(name) => Setting::Sampler(kind("sampler", &name)?),
            Self::MaxDepth(depth) => Setting::MaxDepth(depth),
            Self::Tone(name) => Setting::Tone(kind("tone curve", &name)?),
            Self::Exposure(stops) => Setting::Exposure(stops),
            Self::Gain(group, factors) => Setting::Gain(group, factors),
            Self::Denoise(on) => Setting::Denoise(on),
            Self::Seed(seed) => Setting::Seed(seed),
            Self::Threads(threads) => Setting::Threads(threads),
            Self::Scheduler(name) => Setting::Scheduler(kind("scheduler", &name)?),
        })
    }
}

fn kind<Kind: NamedKind>(what: &str, name: &str) -> Result<Kind, String> {
    by_name(what, name).map_err(|error| format!("error: {error}"))
}

impl From<&Setting> for SettingForm {
    fn from(setting: &Setting) -> Self {
        match setting {
            Setting::Size(size) => Self::Size(*size),
            Setting::Samples(samples) => Self::Samples(*samples),
            Setting::Integrator(kind) => Self::Integrator(kind.name().to_owned()),
            Setting::Sampler(kind) => Self::Sampler(kind.name().to_owned()),
            Setting::MaxDepth(depth) => Self::MaxDepth(*depth),
            Setting::Tone(kind) => Self::Tone(kind.name().to_owned()),
            Setting::Exposure(stops) => Self::Exposure(*stops),
            Setting::Gain(group, factors) => Self::Gain(group.clone(), *factors),
            Setting::Denoise(on) => Self::Denoise(*on),
            Setting::Seed(seed) => Self::Seed(*seed),
            Setting::Threads(threads) => Self::Threads(*threads),
            Setting::Scheduler(scheduler) => Self::Scheduler(scheduler.name().to_owned()),
        }
    }
}

impl EditForm {
    /// Form of an edit; `None` for files in memory, which JSON cannot hold.
    fn from_edit(edit: &Edit) -> Option<Self> {
        Some(match edit {
            Edit::Scene(name) => Self::Scene(name.clone()),
            Edit::Files(_) => return None,
            Edit::Reload => Self::Reload,
            Edit::Fly(fly) => Self::Fly(*fly),
            Edit::Orbit(orbit) => Self::Orbit(*orbit),
            Edit::Zoom(factor) => Self::Zoom(*factor),
            Edit::Focus(pixel) => Self::Focus(*pixel),
            Edit::Pivot(pixel) => Self::Pivot(*pixel),
            Edit::Frame(pixel) => Self::Frame(*pixel),
            Edit::Camera(name) => Self::Camera(name.clone()),
            Edit::Look(camera) => Self::Look(camera_json(camera)),
            Edit::Bookmark(name) => Self::Bookmark(name.clone()),
            Edit::Set { path, value } => Self::Set { path: path.clone(), value: value.clone() },
            Edit::Setting(setting) => Self::Setting(setting.into()),
            Edit::At(frame) => Self::At(*frame),
            Edit::Play(play) => Self::Play(*play),
            Edit::Show(channel) => Self::Show(*channel),
            Edit::Region(region) => Self::Region(*region),
            Edit::Reset => Self::Reset,
        })
    }
}

/// Fails for [`Edit::Files`].
impl Serialize for Edit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let form = EditForm::from_edit(self).ok_or_else(|| S::Error::custom("no JSON stands for files in memory"))?;
        form.serialize(serializer)
    }
}

/// Bookmarked cameras as the member `cameras` of a scene file.
pub fn bookmarks<'b>(cameras: impl IntoIterator<Item = &'b (String, AnyCamera)>) -> Value {
    cameras.into_iter().map(|(name, camera)| (name.clone(), camera_json(camera))).collect()
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Fly", deny_unknown_fields)]
struct FlyForm {
    #[serde(default)]
    right: f32,
    #[serde(default)]
    up: f32,
    #[serde(default)]
    forward: f32,
    #[serde(default)]
    yaw_degrees: f32,
    #[serde(default)]
    pitch_degrees: f32,
    #[serde(default)]
    roll_degrees: f32,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Orbit", deny_unknown_fields)]
struct OrbitForm {
    #[serde(default)]
    yaw_degrees: f32,
    #[serde(default)]
    pitch_degrees: f32,
    #[serde(default = "one")]
    closer: f32,
}

fn one() -> f32 {
    1.0
}

impl Serialize for Fly {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        FlyForm::serialize(self, serializer)
    }
}

impl Serialize for Orbit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        OrbitForm::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Fly {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        FlyForm::deserialize(deserializer)
    }
}

impl<'de> Deserialize<'de> for Orbit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        OrbitForm::deserialize(deserializer)
    }
}
