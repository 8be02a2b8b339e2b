//! Description → world: names looked up, groups placed, shapes prepared, gaps filled with defaults.

use crate::description::{Description, Render};
use crate::path::Path;
use crate::report::{Finding, Problems};
use juggler_math::{Aabb, Transform, UVec2, Vec3};
use juggler_tracer::background::AnyBackground;
use juggler_tracer::camera::AnyCamera;
use juggler_tracer::light::AnyLight;
use juggler_tracer::material::MaterialTable;
use juggler_tracer::world::{Object, World};
use std::sync::Arc;

mod count;
mod defaults;
mod locate;
mod materials;
mod meshes;
mod needs;
mod placing;
mod settings;

pub use count::{MAX_NESTING, MAX_OBJECTS, MAX_STORED};
pub use locate::Part;
pub use meshes::{Files, Library};
pub use needs::Needs;
pub use settings::{MAX_EDGE, MAX_PIXELS, MAX_SAMPLES};

/// A scene ready to be rendered.
#[derive(Clone)]
pub struct Compiled {
    /// What can be seen.
    pub world: Arc<World>,
    /// The cameras with their names, the one to render with first. There is always one.
    pub cameras: Vec<(String, AnyCamera)>,
    /// Size, samples, integrator and the like.
    pub settings: Render,
    /// What people should know about the scene.
    pub warnings: Problems,
}

/// Everything of a [`World`] but its hierarchy, which takes time to build.
pub struct Assembly {
    /// Every object in its place.
    pub objects: Vec<Object>,
    /// What they are made of.
    pub materials: MaterialTable,
    /// The lights.
    pub lights: Vec<AnyLight>,
    /// What lies behind everything.
    pub background: AnyBackground,
    /// Cameras by name, the chosen one first.
    pub cameras: Vec<(String, AnyCamera)>,
}

impl Assembly {
    /// Puts everything together; what cannot be is left out and reported.
    pub fn of(scene: &Description, files: Files<'_>) -> (Self, Vec<Finding>) {
        let mut findings = Vec::new();
        settings::check(&scene.render, &mut findings);
        settings::check_light(scene, &mut findings);
        let mut materials = materials::Materials::new(scene, &mut findings);
        let objects = match count::count(scene) {
            Ok(counts) => placing::place(scene, &counts, files, &mut materials, &mut findings),
            Err(problems) => {
                findings.extend(problems);
                Vec::new()
            }
        };
        let lit = !scene.lights.is_empty() || materials.glows();
        let bounds = bounds(&objects);
        let cameras = cameras(scene, &bounds, &mut findings);
        let lights = if lit { scene.lights.clone() } else { defaults::lights(&bounds) };
        let background = scene.background.clone().map(AnyBackground::from);
        let background = background.unwrap_or_else(|| defaults::background(lit));
        let materials = materials.finish(&mut findings);
        (Self { objects, materials, lights, background, cameras }, findings)
    }

    /// Builds the world.
    pub fn compile(self, settings: Render, warnings: Problems) -> Compiled {
        let world = World::new(self.objects, self.materials, self.lights, self.background);
        Compiled { world: Arc::new(world), cameras: self.cameras, settings, warnings }
    }
}

/// How a scene looks at its world, which is there already: its cameras by name, the chosen one first.
pub fn look_at(scene: &Description, world: &World) -> (Vec<(String, AnyCamera)>, Vec<Finding>) {
    let mut findings = Vec::new();
    settings::check(&scene.render, &mut findings);
    let cameras = cameras(scene, &or_some(world.bounds()), &mut findings);
    (cameras, findings)
}

/// A box around all objects that have an end.
fn bounds(objects: &[Object]) -> Aabb {
    or_some(objects.iter().map(Object::bounds).fold(Aabb::EMPTY, Aabb::union))
}

/// Some box where there is none.
fn or_some(bounds: Aabb) -> Aabb {
    if bounds.is_empty() { Transform::IDENTITY.aabb(&Aabb { min: -Vec3::ONE, max: Vec3::ONE }) } else { bounds }
}

/// The scene's cameras or the default one, each tried once; the chosen one first.
fn cameras(scene: &Description, bounds: &Aabb, findings: &mut Vec<Finding>) -> Vec<(String, AnyCamera)> {
    let [width, height] = scene.render.size;
    let size = UVec2::new(width.max(1), height.max(1));
    let mut cameras: Vec<(String, AnyCamera)> = Vec::new();
    if let Some(camera) = &scene.camera {
        try_camera(camera, size, &Path::root().key("camera"), findings);
        cameras.push(("camera".into(), camera.clone()));
        if !scene.cameras.is_empty() {
            let problem = Finding::error("a scene has either `camera` or `cameras`, not both");
            findings.push(problem.at(Path::root().key("camera")).help("move it into `cameras` under a name"));
        }
    }
    for (name, camera) in &scene.cameras {
        try_camera(camera, size, &Path::root().key("cameras").key(name.as_str()), findings);
        cameras.push((name.clone(), camera.clone()));
    }
    if cameras.is_empty() {
        cameras.push(("default".into(), defaults::camera(bounds, size)));
    }
    if let Some(chosen) = &scene.render.camera
        && let Some(at) = cameras.iter().position(|(name, _)| *name == chosen.0)
    {
        cameras[..=at].rotate_right(1);
    }
    cameras
}

fn try_camera(camera: &AnyCamera, size: UVec2, path: &Path, findings: &mut Vec<Finding>) {
    if let Err(invalid) = camera.project(size) {
        let path = path.key(crate::kind::name_of(camera)).join(invalid.field);
        findings.push(Finding::error(invalid.message).at(&path));
    }
}
