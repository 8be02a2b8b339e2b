//! JSON of statuses and probes.

use crate::edit::Channel;
use crate::model_status::ModelStatus;
use crate::pixel_info::PixelInfo;
use crate::status::{Stage, Status};
use juggler::camera::AnyCamera;
use juggler::camera::film::Rect;
use juggler::camera::sampler::SamplerKind;
use juggler::imaging::ToneCurveKind;
use juggler::integrator::IntegratorKind;
use juggler::math::NamedKind;
use juggler::render::Scheduler;
use juggler::scene::camera_json;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

#[derive(Serialize, Deserialize)]
#[serde(remote = "Channel", rename_all = "snake_case")]
enum ChannelForm {
    Color,
    Albedo,
    Normals,
    Depth,
    Objects,
    Materials,
    Samples,
    Noise,
}

#[derive(Serialize)]
#[serde(remote = "Stage", rename_all = "snake_case")]
enum StageForm {
    Loading,
    Moving,
    Refining,
    Finished,
}

#[derive(Serialize)]
#[serde(remote = "Status")]
struct StatusForm {
    number: u64,
    revision: u64,
    stage: Stage,
    scene: String,
    error: Option<String>,
    size: [u32; 2],
    region: Option<Rect>,
    channel: Channel,
    samples: f32,
    samples_wanted: u32,
    noise: Option<f32>,
    clamped: Option<f32>,
    frames_per_second: f32,
    rays_per_second: f32,
    coarseness: u32,
    threads: usize,
    #[serde(serialize_with = "write_kind")]
    scheduler: Scheduler,
    #[serde(serialize_with = "write_kind_if_known")]
    integrator: Option<IntegratorKind>,
    max_depth: Option<u32>,
    depth_range: [u32; 2],
    denoise: bool,
    denoised: bool,
    #[serde(serialize_with = "write_kind_if_known")]
    sampler: Option<SamplerKind>,
    #[serde(serialize_with = "write_kind_if_known")]
    tone: Option<ToneCurveKind>,
    exposure: f32,
    light_groups: Vec<(String, [f32; 3])>,
    models: Vec<ModelStatus>,
    cameras: Vec<String>,
    #[serde(serialize_with = "write_camera_if_known")]
    camera: Option<AnyCamera>,
    interest: [f32; 3],
    extent: f32,
    flight_speed: f32,
    frame: f64,
    frames: u32,
    frame_rate: f64,
    playing: bool,
    hash: Option<String>,
}

#[derive(Serialize)]
#[serde(remote = "ModelStatus")]
struct ModelStatusForm {
    pointer: String,
    file: String,
    variants: Vec<String>,
    variant: Option<String>,
    clips: Vec<String>,
    clip: Option<String>,
}

#[derive(Serialize)]
#[serde(remote = "PixelInfo")]
struct PixelInfoForm {
    pixel: [u32; 2],
    color: Option<[f32; 3]>,
    samples: u32,
    noise: Option<f32>,
    depth: Option<f32>,
    position: Option<[f32; 3]>,
    normal: Option<[f32; 3]>,
    object: Option<u32>,
    shape: Option<String>,
    material: Option<String>,
}

fn write_kind<S: Serializer>(kind: &impl NamedKind, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(kind.name())
}

/// Writes the empty string if no scene is built yet.
fn write_kind_if_known<S: Serializer>(kind: &Option<impl NamedKind>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(kind.map_or("", NamedKind::name))
}

fn write_camera_if_known<S: Serializer>(camera: &Option<AnyCamera>, serializer: S) -> Result<S::Ok, S::Error> {
    camera.as_ref().map(camera_json).serialize(serializer)
}

impl Serialize for Channel {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ChannelForm::serialize(self, serializer)
    }
}

impl Serialize for Stage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StageForm::serialize(self, serializer)
    }
}

impl Serialize for Status {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        StatusForm::serialize(self, serializer)
    }
}

impl Serialize for ModelStatus {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        ModelStatusForm::serialize(self, serializer)
    }
}

impl Serialize for PixelInfo {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        PixelInfoForm::serialize(self, serializer)
    }
}

impl<'de> Deserialize<'de> for Channel {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        ChannelForm::deserialize(deserializer)
    }
}
