//! Cameras of a scene, and the default camera, which sees all objects.

use super::shutter_motion;
use super::subjects::{Subjects, points_of};
use crate::description::Description;
use crate::motion::Tracks;
use crate::path::Path;
use crate::report::Finding;
use crate::suggest::did_you_mean_or_list;
use juggler_camera::{AnyCamera, Framing};
use juggler_math::{Aabb, BuildControl, UVec2, Vec3};
use juggler_world::Object;
use std::sync::Arc;

/// Cameras by name, the selected one first, and the selected camera over the shutter interval.
type Cameras = (Vec<(String, AnyCamera)>, Vec<AnyCamera>);

impl Subjects {
    /// Cameras of a scene whose world is compiled already, and has these subjects; `None` if the cameras need
    /// others.
    pub fn cameras_again(&self, scene: &Description, tracks: &Tracks, findings: &mut Vec<Finding>) -> Option<Cameras> {
        let objects = || Path::root().key("objects");
        self.suffice(scene).then(|| self.cameras(scene, tracks, &objects(), findings))
    }

    /// Cameras of the scene or the default camera, each of them focused and checked, the selected one first.
    /// Reports an invalid default camera at `farthest_object`, the object that makes it invalid.
    pub fn cameras(
        &self,
        scene: &Description,
        tracks: &Tracks,
        farthest_object: &Path,
        findings: &mut Vec<Finding>,
    ) -> Cameras {
        let [width, height] = scene.render.size;
        let size = UVec2::new(width.max(1), height.max(1));
        let mut cameras: Vec<(String, AnyCamera)> = Vec::new();
        let focused = |camera: &AnyCamera, path: &Path, findings: &mut Vec<Finding>| {
            let mut camera = camera.clone();
            self.focus(scene, &mut camera, path, findings);
            check_camera(&camera, size, path, findings);
            camera
        };
        if let Some(camera) = &scene.camera {
            cameras.push(("camera".into(), focused(camera, &Path::root().key("camera"), findings)));
            if !scene.cameras.is_empty() {
                let problem = Finding::error("a scene has either `camera` or `cameras`, not both");
                findings.push(problem.at(Path::root().key("camera")).help("move it into `cameras` under a name"));
            }
        }
        for (name, camera) in &scene.cameras {
            let path = Path::root().key("cameras").key(name.as_str());
            cameras.push((name.clone(), focused(camera, &path, findings)));
        }
        if cameras.is_empty() {
            let points = self.framed_points.as_deref().unwrap_or_default();
            cameras.push(("default".into(), checked_camera(points, size, farthest_object, findings)));
        }
        if let Some(chosen) = &scene.render.camera
            && let Some(at) = cameras.iter().position(|(name, _)| *name == chosen.0)
        {
            cameras[..=at].rotate_right(1);
        }
        let keys = cameras.first().map(|(name, _)| shutter_motion::camera(tracks, name, scene));
        let mut camera_keys = keys.unwrap_or_default();
        for camera in &mut camera_keys {
            // The camera at the frame has the same object, which is reported once.
            self.focus(scene, camera, &Path::root(), &mut Vec::new());
            // The same error at the frame itself is reported already.
            if let (Err(invalid), true) = (camera.projection(size), !findings.iter().any(Finding::is_error)) {
                let path = Path::root().key(if scene.camera.is_some() { "camera" } else { "cameras" });
                let message = format!("while the shutter is open, {}", invalid.message);
                findings.push(Finding::error(message).at(path.join(invalid.field)));
            }
        }
        (cameras, camera_keys)
    }

    /// Subjects among `objects`, whose bounding box is `bounds`; `entries` holds the index of the first
    /// shape of each scene entry.
    pub fn new(
        scene: &Description,
        objects: &[Object],
        entries: &[u32],
        bounds: &Aabb,
        control: &BuildControl,
    ) -> Self {
        let framed_points = (!has_cameras(scene)).then(|| points_of(objects, bounds, control).into());
        let names = cameras_in(scene).filter_map(|camera| camera.focused_object());
        let middles = names.map(|name| (name.to_owned(), middle(scene, objects, entries, name))).collect();
        Self { framed_points, middles: Arc::new(middles) }
    }

    /// Whether the subjects suffice for the cameras of another state of the scene.
    fn suffice(&self, scene: &Description) -> bool {
        let knows = |camera: &AnyCamera| camera.focused_object().is_none_or(|name| self.middles.contains_key(name));
        (has_cameras(scene) || self.framed_points.is_some()) && cameras_in(scene).all(knows)
    }

    /// Focuses a camera on its object, if it focuses on one. Reports at the path of the camera an object
    /// that is missing, unbounded or not in front of the camera.
    fn focus(&self, scene: &Description, camera: &mut AnyCamera, path: &Path, findings: &mut Vec<Finding>) {
        let Some(name) = camera.focused_object().map(str::to_owned) else { return };
        let at = path.key(camera.name()).key("focus_on");
        let distance = match (self.middles.get(&name).copied().flatten(), camera.axes()) {
            (Some(middle), Ok(axes)) => (middle - axes.eye).dot(axes.forward),
            // Wrong axes are reported.
            (Some(_), Err(_)) => return,
            (None, _) => {
                let names = || scene.objects.iter().filter_map(|object| object.name.as_deref());
                let known = names().any(|own| own == name);
                let message = if known { "has no bounds to focus on" } else { "does not exist" };
                let help = if known { None } else { did_you_mean_or_list(&name, names()) };
                findings.push(Finding::error(format!("the object `{name}` {message}")).at(at).maybe_help(help));
                return;
            }
        };
        if distance > 0.0 {
            return camera.focus(distance);
        }
        findings.push(Finding::error(format!("the object `{name}` is not in front of the camera")).at(at));
    }
}

/// Middle of the bounding box of all objects of the scene's list that have a name.
fn middle(scene: &Description, objects: &[Object], entries: &[u32], name: &str) -> Option<Vec3> {
    let is_named = |entry: usize| scene.objects.get(entry).is_some_and(|object| object.name.as_deref() == Some(name));
    let (mut shape, mut bounds) = (0_u64, Aabb::EMPTY);
    for object in objects {
        let entry = entries.partition_point(|first| u64::from(*first) <= shape).checked_sub(1);
        if entry.is_some_and(is_named) {
            bounds = bounds.union(object.bounds());
        }
        shape = shape.saturating_add(object.shapes());
    }
    (!bounds.is_empty()).then(|| bounds.center())
}

fn cameras_in(scene: &Description) -> impl Iterator<Item = &AnyCamera> {
    scene.camera.iter().chain(scene.cameras.values()).map(|camera| &**camera)
}

fn has_cameras(scene: &Description) -> bool {
    scene.camera.is_some() || !scene.cameras.is_empty()
}

/// Camera that frames `points`, the extreme points of all objects. Reports the camera at
/// `farthest_object` if it is invalid.
fn checked_camera(points: &[Vec3], size: UVec2, farthest_object: &Path, findings: &mut Vec<Finding>) -> AnyCamera {
    let camera = AnyCamera::from(Framing::default().camera(points, size.to_array()));
    if camera.projection(size).is_err() {
        let problem =
            Finding::error("this object is too large or too far away for the default camera to see the whole scene");
        findings.push(problem.at(farthest_object).help("make it smaller, move it closer, or add a `camera`"));
    }
    camera
}

/// Reports a camera that is invalid for pictures of `size`.
fn check_camera(camera: &AnyCamera, size: UVec2, path: &Path, findings: &mut Vec<Finding>) {
    if let Err(invalid) = camera.projection(size) {
        let path = path.key(camera.name()).join(invalid.field);
        findings.push(Finding::error(invalid.message).at(&path));
    }
}
