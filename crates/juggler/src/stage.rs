//! What surrounds a model or mesh that was given in place of a scene, and the camera that sees it.
//!
//! Every choice is an edit of the scene, so that fingerprints, checkpoints, windows and files of scenes
//! know it.

use crate::Error;
use juggler_camera::{AnyCamera, Framing, Perspective};
use juggler_light::background::{AnyBackground, Environment, Sky, Studio};
use juggler_math::{DVec3, Rgb, Vec3, portable};
use juggler_scene::{Scene, SceneError};
use serde_json::{Value, json};

/// Frames per second of a turntable.
const FRAMES_PER_SECOND: u32 = 30;
/// Maximum number of frames of a turn.
pub const MAX_FRAMES: u32 = 1_000_000;
/// Number of frames of an animation whose objects the camera frames.
const FRAMED_FRAMES: u32 = 8;
/// Number of positions of a turn that the camera frames.
const FRAMED_TURNS: u32 = 24;
/// Reflectance of the floor: nearly that of the studio, so that the horizon hardly shows.
const FLOOR: f32 = 0.8;
/// Distance of a floor below what stands on it, as a part of the size. It keeps flat bases off the floor.
const FLOOR_DEPTH: f32 = 1e-4;
/// Name of the floor's object and material.
const FLOOR_NAME: &str = "floor";

/// Choices for a picture. `None` keeps what the scene has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// Light around the model or mesh.
    pub environment: Option<StageLight>,
    /// What the picture shows where nothing is.
    pub backdrop: Option<Backdrop>,
    /// What the model or mesh stands on.
    pub floor: Option<Floor>,
    /// Number of frames in which the model or mesh turns once about the vertical axis.
    pub turntable: Option<u32>,
    /// Position of the camera.
    pub eye: Option<Vec3>,
    /// Point that the camera looks at.
    pub look_at: Option<Vec3>,
    /// Direction from the objects to the camera, of any length above 0; the camera frames the objects.
    pub towards_camera: Option<Vec3>,
    /// Vertical field of view of the camera, in degrees.
    pub vertical_fov_degrees: Option<f32>,
    /// Part of the picture's width or height that the objects fill, above 0 and at most 1.
    pub fill: Option<f32>,
    /// Width and height of the picture in pixels, for cameras that frame the objects; `None` is the size
    /// of the scene.
    pub size: Option<[u32; 2]>,
    /// Whether a turntable keeps the cameras of the scene. Otherwise a camera frames all its positions.
    pub keeps_camera: bool,
}

/// Light around a model or mesh. It replaces the light that Juggler adds by itself; lights of a model's
/// file stay.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StageLight {
    /// A dome and four soft boxes ([`Studio`]).
    Studio,
    /// A clear sky with the sun ([`Sky`]).
    Sky,
    /// A picture of the light from all directions.
    File(String),
}

/// What a picture shows where nothing is. It lights nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Backdrop {
    /// Nothing: the picture has alpha.
    Transparent,
    /// A color as displays show it, whatever the tone curve.
    Color(Rgb),
}

/// What a model or mesh stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Floor {
    /// A light gray plane.
    Solid,
    /// A plane of which only the shadows show.
    Shadow,
    /// Nothing: the floor that Juggler adds to meshes goes.
    None,
}

type Edits = Vec<(String, Value)>;

impl Stage {
    /// Returns the scene with these choices.
    ///
    /// # Errors
    ///
    /// A choice is only for models and meshes that were given in place of a scene, its number is out of
    /// range, or the scene has mistakes.
    pub fn apply(&self, scene: &Scene) -> Result<Scene, Error> {
        let mut staged = scene.clone();
        for (pointer, value) in self.edits(scene)? {
            staged = staged.with_value(&pointer, value)?;
        }
        Ok(staged)
    }

    /// Edits of a scene that make these choices, for [`Scene::with_value`], in order.
    ///
    /// # Errors
    ///
    /// As [`Stage::apply`].
    pub fn edits(&self, scene: &Scene) -> Result<Edits, Error> {
        self.check(scene)?;
        let mut edits = Vec::new();
        self.add_light(scene, &mut edits);
        self.add_backdrop(scene, &mut edits);
        let needs_points = self.floor.is_some() || self.turntable.is_some() || self.has_camera();
        if needs_points && !self.places_camera_alone() {
            let points = points(scene)?;
            self.add_floor(scene, &points, &mut edits);
            self.add_turntable(scene, &points, &mut edits);
            self.add_camera(scene, &points, &mut edits);
        } else if needs_points {
            self.add_camera(scene, &[], &mut edits);
        }
        Ok(edits)
    }

    /// Whether a choice determines the camera.
    pub fn has_camera(&self) -> bool {
        self.eye.is_some()
            || self.look_at.is_some()
            || self.towards_camera.is_some()
            || self.vertical_fov_degrees.is_some()
            || self.fill.is_some()
    }

    /// Whether the choices say where the camera is and what it sees, and nothing else needs the objects.
    fn places_camera_alone(&self) -> bool {
        self.eye.is_some() && self.look_at.is_some() && self.floor.is_none() && self.turntable.is_none()
    }

    fn check(&self, scene: &Scene) -> Result<(), Error> {
        let around_files = [
            ("environment", self.environment.is_some(), "its `background` is its light"),
            ("floor", self.floor.is_some(), "a plane among its `objects` is a floor"),
            ("turntable", self.turntable.is_some(), "an expression in `rotate` turns its objects"),
        ];
        for (setting, is_chosen, instead) in around_files {
            if is_chosen && !scene.is_around_file() {
                let message = format!("`{setting}` is for models and meshes; in a scene, {instead}");
                return Err(Error::setting(setting, message));
            }
        }
        let in_range = |setting: &str, value: Option<f32>, low: f32, high: f32| match value {
            Some(value) if !(value > low && value <= high) => {
                let message = format!("`{setting}` must be above {low} and at most {high}, not {value}");
                Err(Error::setting(setting, message))
            }
            _ => Ok(()),
        };
        in_range("fill", self.fill, 0.0, 1.0)?;
        in_range("vertical_fov_degrees", self.vertical_fov_degrees, 0.0, 179.0)?;
        let vectors = [("eye", self.eye), ("look_at", self.look_at), ("towards_camera", self.towards_camera)];
        if let Some((setting, _)) = vectors.iter().find(|(_, value)| value.is_some_and(|value| !value.is_finite())) {
            return Err(Error::setting(setting, format!("the numbers of `{setting}` must be finite")));
        }
        match self.turntable {
            Some(frames) if !(1..=MAX_FRAMES).contains(&frames) => {
                let message = format!("a turn has 1 to {MAX_FRAMES} frames, not {frames}");
                Err(Error::setting("turntable", message))
            }
            _ => Ok(()),
        }
    }

    fn add_light(&self, scene: &Scene, edits: &mut Edits) {
        let background: AnyBackground = match &self.environment {
            None => return,
            Some(StageLight::Studio) => Studio::default().into(),
            Some(StageLight::Sky) => Sky::default().into(),
            Some(StageLight::File(file)) => Environment::from_file(file.clone()).into(),
        };
        // The sun of a mesh goes. Later entries of the list take the place of removed ones.
        edits.extend(scene.description.lights.iter().map(|_| ("/lights/0".to_owned(), Value::Null)));
        edits.push(("/background".into(), json!(background)));
    }

    fn add_backdrop(&self, scene: &Scene, edits: &mut Edits) {
        let Some(backdrop) = self.backdrop else { return };
        edits.push(("/render/transparent".into(), true.into()));
        match backdrop {
            Backdrop::Color(color) => edits.push(("/tone/backdrop".into(), json!(color))),
            Backdrop::Transparent if scene.description.tone.backdrop.is_some() => {
                edits.push(("/tone/backdrop".into(), Value::Null));
            }
            Backdrop::Transparent => {}
        }
    }

    fn add_floor(&self, scene: &Scene, points: &[Vec3], edits: &mut Edits) {
        let objects = &scene.description.objects;
        let own =
            objects.iter().position(|object| object.name.as_deref() == Some(FLOOR_NAME) && object.model.is_none());
        match (self.floor, own) {
            (None, _) | (Some(Floor::None), None) | (Some(Floor::Solid), Some(_)) => {}
            (Some(Floor::None), Some(own)) => edits.push((format!("/objects/{own}"), Value::Null)),
            (Some(Floor::Shadow), Some(own)) => {
                edits.push((format!("/objects/{own}/shadow_catcher"), true.into()));
            }
            (Some(floor), None) => {
                let low = points.iter().map(|point| point.y).fold(f32::INFINITY, f32::min);
                let high = points.iter().map(|point| point.y).fold(f32::NEG_INFINITY, f32::max);
                let height = (low - FLOOR_DEPTH * (high - low)).min(low.next_down());
                let plane = json!({"name": FLOOR_NAME, "shape": {"plane": {}}, "material": FLOOR_NAME,
                    "transform": {"translate": [0, height, 0]}, "shadow_catcher": floor == Floor::Shadow});
                let material = json!({"diffuse": {"reflectance": FLOOR}});
                edits.push((format!("/materials/{FLOOR_NAME}"), material));
                edits.push((format!("/objects/{}", objects.len()), plane));
            }
        }
    }

    /// Turns the object about the vertical axis through the middle of the points.
    fn add_turntable(&self, scene: &Scene, points: &[Vec3], edits: &mut Edits) {
        let Some(frames) = self.turntable else { return };
        let center = middle(points);
        let own = scene.to_value().pointer("/objects/0/transform").cloned();
        let mut steps = match own {
            Some(Value::Array(steps)) => steps,
            Some(Value::Null) | None => Vec::new(),
            Some(step) => vec![step],
        };
        let degrees = format!("=frame * 360 / {frames}");
        steps.extend([
            json!({"translate": [-center.x, 0, -center.z]}),
            json!({"rotate": {"axis": [0, 1, 0], "degrees": degrees}}),
            json!({"translate": [center.x, 0, center.z]}),
        ]);
        let animation = json!({"frames": frames, "frames_per_second": FRAMES_PER_SECOND});
        edits.push(("/animation".into(), animation));
        edits.push(("/objects/0/transform".into(), steps.into()));
    }

    fn add_camera(&self, scene: &Scene, points: &[Vec3], edits: &mut Edits) {
        if !self.has_camera() && (self.turntable.is_none() || self.keeps_camera) {
            return;
        }
        if !scene.description.cameras.is_empty() {
            edits.push(("/cameras".into(), Value::Null));
        }
        if scene.description.render.camera.is_some() {
            edits.push(("/render/camera".into(), Value::Null));
        }
        let camera = self.camera(points, self.size.unwrap_or(scene.description.render.size));
        edits.push(("/camera".into(), json!(AnyCamera::from(camera))));
    }

    fn camera(&self, points: &[Vec3], size: [u32; 2]) -> Perspective {
        let standard = Framing::default();
        let from_eye = self.eye.map(|eye| eye - self.look_at.unwrap_or_else(|| middle(points)));
        let framing = Framing {
            towards_camera: from_eye.or(self.towards_camera).unwrap_or(standard.towards_camera),
            vertical_fov_degrees: self.vertical_fov_degrees.unwrap_or(standard.vertical_fov_degrees),
            fill: self.fill.unwrap_or(standard.fill),
        };
        let turned = self.turntable.map(|_| turned(points));
        let framed = framing.camera(turned.as_deref().unwrap_or(points), size);
        let eye = self.eye.unwrap_or(framed.eye);
        let look_at = self.look_at.or_else(|| self.eye.map(|_| middle(points))).or(framed.look_at);
        Perspective { eye, look_at, ..framed }
    }
}

/// The camera that sees a scene without a camera of its own, at frame 0.
///
/// # Errors
///
/// The scene has mistakes.
pub fn default_camera(scene: &Scene) -> Result<Option<AnyCamera>, SceneError> {
    let shown = scene.expanded_description();
    if shown.camera.is_some() || !shown.cameras.is_empty() {
        return Ok(None);
    }
    let camera = Framing::default().camera(&scene.extreme_points()?, scene.description.render.size);
    Ok(Some(camera.into()))
}

/// Extreme points of a scene's objects, over its animation if models move.
fn points(scene: &Scene) -> Result<Vec<Vec3>, SceneError> {
    let frames = scene.description.animation.frames;
    if frames < 2 || !scene.depends_on_time() {
        return scene.extreme_points();
    }
    let mut points = Vec::new();
    for part in 0..FRAMED_FRAMES {
        let frame = f64::from(frames) * f64::from(part) / f64::from(FRAMED_FRAMES);
        points.extend(scene.at_frame(frame.floor())?.extreme_points()?);
    }
    Ok(points)
}

/// Middle of the bounding box of points; the origin without points.
fn middle(points: &[Vec3]) -> Vec3 {
    let low = points.iter().copied().reduce(Vec3::min).unwrap_or_default();
    let high = points.iter().copied().reduce(Vec3::max).unwrap_or_default();
    (low + high) * 0.5
}

/// The points in all positions of a turn about the vertical axis through their middle.
fn turned(points: &[Vec3]) -> Vec<Vec3> {
    let center = middle(points).as_dvec3();
    let turn = |part: u32| {
        let radians = std::f64::consts::TAU * f64::from(part) / f64::from(FRAMED_TURNS);
        let (sin, cos) = portable::sin_cos_f64(radians);
        points.iter().map(move |point| {
            let from = point.as_dvec3() - center;
            let to = DVec3::new(cos * from.x + sin * from.z, from.y, cos * from.z - sin * from.x);
            (center + to).as_vec3()
        })
    };
    (0..FRAMED_TURNS).flat_map(turn).collect()
}
