//! JSON of edits, and in `wire/status.rs` of statuses and probes, which web pages exchange with a
//! server or with the workers of a browser. The types of a session and their other clients do not
//! know it.
//!
//! An edit is an object with one member, `{"fly": {"forward": 0.5, "yaw_degrees": 3}}`, or a
//! string, `"reset"`. Kinds are written as their names, cameras as in the scene format. Reading
//! takes two steps: [`EditMessage`] checks the form and reports errors to the program that sent the
//! message; [`EditMessage::read`] reads names of kinds and the camera and reports errors to users.

use crate::edit::{Channel, Edit, Fly, Orbit, SceneFiles, Setting};
use juggler::by_name;
use juggler::camera::AnyCamera;
use juggler::camera::film::Rect;
use juggler::camera::sampler::SamplerKind;
use juggler::imaging::ToneCurveKind;
use juggler::integrator::IntegratorKind;
use juggler::math::NamedKind;
use juggler::render::Scheduler;
use juggler::scene::camera_json;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;
use std::marker::PhantomData;

mod status;

/// Edit as it arrives in JSON: its names of kinds and its camera are not read yet.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct EditMessage(EditForm);

/// Declares the JSON form of an enum. A variant lists its parts with their types in JSON, from
/// which they are read by `TryFrom` and to which they are written by `From`.
macro_rules! json_form {
    ($Form:ident of $Typed:ident {
        $($(#[$attribute:meta])* $Variant:ident
            $(($($part:ident: $Part:ty),+))? $({ $($field:ident: $Field:ty),+ })?),+ $(,)?
    }) => {
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "snake_case", deny_unknown_fields)]
        enum $Form {
            $($(#[$attribute])* $Variant $(($($Part),+))? $({ $($field: $Field),+ })?),+
        }

        impl TryFrom<$Form> for $Typed {
            type Error = String;

            fn try_from(form: $Form) -> Result<Self, String> {
                Ok(match form {
                    $($Form::$Variant $(($($part),+))? $({ $($field),+ })? => {
                        Self::$Variant $(($(read($part)?),+))? $({ $($field: read($field)?),+ })?
                    })+
                })
            }
        }

        impl From<$Typed> for $Form {
            fn from(typed: $Typed) -> Self {
                match typed {
                    $($Typed::$Variant $(($($part),+))? $({ $($field),+ })? => {
                        Self::$Variant $(($($part.into()),+))? $({ $($field: $field.into()),+ })?
                    })+
                }
            }
        }
    };
}

json_form! {
    EditForm of Edit {
        Scene(name: String),
        #[serde(skip)]
        Files(scene: SceneFiles),
        Reload,
        Fly(fly: Fly),
        Orbit(orbit: Orbit),
        Zoom(factor: f32),
        Focus(pixel: [f32; 2]),
        Pivot(pixel: [f32; 2]),
        Frame(pixel: Option<[f32; 2]>),
        Camera(name: String),
        Look(camera: CameraForm),
        Bookmark(name: String),
        Set { path: String, value: Value },
        Setting(setting: SettingForm),
        At(frame: f64),
        Play(play: bool),
        Show(channel: Channel),
        Region(region: Option<Rect>),
        Reset,
    }
}

json_form! {
    SettingForm of Setting {
        Size(size: [u32; 2]),
        Samples(samples: u32),
        Integrator(kind: KindName<IntegratorKind>),
        Sampler(kind: KindName<SamplerKind>),
        MaxDepth(depth: u32),
        Tone(kind: KindName<ToneCurveKind>),
        Exposure(stops: f32),
        Gain(group: String, factors: [f32; 3]),
        Denoise(on: bool),
        Seed(seed: u64),
        Threads(threads: usize),
        Scheduler(kind: KindName<Scheduler>),
    }
}

fn read<Form, Typed>(form: Form) -> Result<Typed, String>
where
    Typed: TryFrom<Form>,
    Typed::Error: ToString,
{
    Typed::try_from(form).map_err(|error| error.to_string())
}

impl EditMessage {
    /// Reads names and camera. The error is worded as in [`Status::error`](crate::Status).
    pub fn read(self) -> Result<Edit, String> {
        read(self.0)
    }

    /// Name of a kind that [`Self::read`] looks up; `None` for other edits.
    pub fn kind_name(&self) -> Option<&str> {
        let EditForm::Setting(setting) = &self.0 else { return None };
        match setting {
            SettingForm::Integrator(kind) => Some(&kind.name),
            SettingForm::Sampler(kind) => Some(&kind.name),
            SettingForm::Tone(kind) => Some(&kind.name),
            SettingForm::Scheduler(kind) => Some(&kind.name),
            _ => None,
        }
    }

    /// Camera that [`Self::read`] reads; `None` for other edits.
    pub fn camera(&self) -> Option<&Value> {
        match &self.0 {
            EditForm::Look(CameraForm(camera)) => Some(camera),
            _ => None,
        }
    }
}

/// Fails for [`Edit::Files`].
impl Serialize for Edit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        EditForm::from(self.clone()).serialize(serializer)
    }
}

/// Name of a kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent, bound = "")]
struct KindName<Kind> {
    name: String,
    #[serde(skip)]
    kind: PhantomData<Kind>,
}

impl<Kind: NamedKind> KindName<Kind> {
    /// Looks the name up; `what` names the set of kinds in messages.
    fn read(&self, what: &str) -> Result<Kind, String> {
        by_name(what, &self.name).map_err(|error| format!("error: {error}"))
    }
}

impl<Kind: NamedKind> From<Kind> for KindName<Kind> {
    fn from(kind: Kind) -> Self {
        Self { name: kind.name().to_owned(), kind: PhantomData }
    }
}

impl TryFrom<KindName<Self>> for IntegratorKind {
    type Error = String;

    fn try_from(name: KindName<Self>) -> Result<Self, String> {
        name.read("integrator")
    }
}

impl TryFrom<KindName<Self>> for SamplerKind {
    type Error = String;

    fn try_from(name: KindName<Self>) -> Result<Self, String> {
        name.read("sampler")
    }
}

impl TryFrom<KindName<Self>> for ToneCurveKind {
    type Error = String;

    fn try_from(name: KindName<Self>) -> Result<Self, String> {
        name.read("tone curve")
    }
}

impl TryFrom<KindName<Self>> for Scheduler {
    type Error = String;

    fn try_from(name: KindName<Self>) -> Result<Self, String> {
        name.read("scheduler")
    }
}

/// Camera in the scene format.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
struct CameraForm(Value);

impl TryFrom<CameraForm> for AnyCamera {
    type Error = String;

    fn try_from(CameraForm(camera): CameraForm) -> Result<Self, String> {
        Self::deserialize(camera).map_err(|error| format!("error: camera: {error}"))
    }
}

impl From<AnyCamera> for CameraForm {
    fn from(camera: AnyCamera) -> Self {
        Self(camera_json(&camera))
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
