//! Description → world: names looked up, groups placed, shapes prepared, gaps filled with defaults.

use crate::description::{Description, Render};
use crate::integrator::IntegratorChoice;
use crate::motion::Tracks;
use crate::path::Path;
use crate::report::{Finding, Problems};
use juggler_camera::{AnyCamera, InvalidCamera, Perspective, Shot};
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::{MaterialId, MaterialTable};
use juggler_math::{Aabb, Transform, UVec2, Vec3};
use juggler_world::{Labels, Lamp, Object, World};
use std::sync::Arc;

pub(crate) mod areas;
mod count;
mod course;
mod defaults;
mod emitting;
mod facing;
mod illuminance;
mod images;
mod labels;
mod lighting;
mod locate;
mod materials;
mod meshes;
mod needs;
mod placing;
mod settings;
mod shelf;

pub use count::{MAX_EMITTERS, MAX_NESTING, MAX_OBJECTS, MAX_STORED};
pub use illuminance::Illuminance;
pub(crate) use images::pictures;
pub use images::{Estimate, MAX_SIDE, MAX_TEXELS, estimate as estimate_picture};
pub use labels::{Names, REST};
pub(crate) use lighting::files as light_files;
pub use lighting::{Purpose, estimate as estimate_panorama};
pub use locate::Part;
pub use meshes::{Files, Library};
pub use needs::Needs;
pub use settings::{MAX_EDGE, MAX_PIXELS, MAX_SAMPLES, MAX_SHUTTER};

/// A scene ready to be rendered.
#[derive(Clone)]
pub struct Compiled {
    /// What can be seen.
    pub world: Arc<World>,
    /// The cameras with their names, the one to render with first. There is always one.
    pub cameras: Vec<(String, AnyCamera)>,
    /// The first camera at even times from opening to closing of the shutter; nothing when it stays as it is.
    pub course: Vec<AnyCamera>,
    /// Size, samples and the like, as the scene says.
    pub settings: Render,
    /// What the scene is rendered with.
    pub integrator: IntegratorChoice,
    /// A box around all objects that have an end, area lights left out.
    pub bounds: Aabb,
    /// What people should know about the scene.
    pub warnings: Problems,
    /// Names of what masks and layers tell apart.
    pub names: Arc<Names>,
    /// The light that brings the most to the middle of the scene.
    pub illuminance: Option<Illuminance>,
    /// The materials of the objects, in the order in which objects are placed.
    pub(crate) given: Arc<Vec<MaterialId>>,
}

/// Everything of a [`World`] but its hierarchy, which takes time to build.
pub struct Assembly {
    /// Every object in its place.
    pub objects: Vec<Object>,
    /// What they are made of.
    pub materials: MaterialTable,
    /// The lights.
    pub lights: Vec<Lamp>,
    /// What lies behind everything.
    pub background: AnyBackground,
    /// Cameras by name, the chosen one first.
    pub cameras: Vec<(String, AnyCamera)>,
    /// As [`Compiled::course`].
    pub course: Vec<AnyCamera>,
    /// What belongs together.
    pub labels: Labels,
    /// As [`Compiled::names`].
    pub names: Names,
    /// As [`Compiled::illuminance`].
    pub illuminance: Option<Illuminance>,
    /// As [`Compiled::integrator`].
    pub integrator: IntegratorChoice,
    /// As [`Compiled::bounds`].
    pub bounds: Aabb,
    pub(crate) given: Arc<Vec<MaterialId>>,
}

impl Compiled {
    /// The first camera for pictures of `size` pixels, while the shutter is open.
    pub fn shot(&self, size: UVec2) -> Result<Shot, InvalidCamera> {
        let keys: Result<Vec<_>, _> = self.course.iter().map(|camera| camera.project(size)).collect();
        let mut keys = keys?.into_iter();
        match (keys.next(), self.cameras.first()) {
            (Some(first), _) => Ok(Shot::moving(first, keys.collect())),
            (None, Some((_, camera))) => Ok(camera.project(size)?.into()),
            // There is always one.
            (None, None) => Ok(AnyCamera::from(Perspective::default()).project(size)?.into()),
        }
    }
}

impl Assembly {
    /// Puts everything together; what cannot be is left out and reported. `tracks` are what moves
    /// while the shutter is open.
    pub fn of(scene: &Description, tracks: &Tracks, files: Files<'_>) -> (Self, Vec<Finding>) {
        let mut findings = Vec::new();
        let SceneInputs { integrator, sources, background, mut materials, mut names } =
            SceneInputs::of(scene, files, &mut findings);
        let mut placed = placed(scene, tracks, files, &mut materials, &mut findings);
        let (bounds, farthest) = (bounds(&placed.0), farthest(&placed.0, &placed.1));
        let glows = materials.glows();
        areas::add(scene, tracks, &mut materials, &mut names, &mut placed, &mut findings);
        let (objects, entries) = placed;
        let (cameras, course) = cameras(scene, tracks, &bounds, &farthest, &mut findings);
        let light =
            LightingInputs { scene, integrator: &integrator, bounds: &bounds, sources: &sources, tracks, files };
        let (lights, illuminance, background) = light.lit(glows, background, &names, &mut findings);
        let labels = names.labels(scene, entries);
        let (materials, given) = materials.finish(&mut names, &mut findings);
        facing::Scenery { scene, objects: &objects, entries: &labels.entries, materials: &materials }
            .check(&mut findings);
        let assembly = Self {
            objects,
            materials,
            lights,
            background,
            cameras,
            course,
            labels,
            names,
            illuminance,
            integrator,
            bounds,
            given,
        };
        (assembly, findings)
    }

    /// Builds the world.
    pub fn compile(self, settings: Render, warnings: Problems) -> Compiled {
        let world = World::new(self.objects, self.materials, self.lights, self.background).with_labels(self.labels);
        let Self { cameras, course, names, integrator, bounds, illuminance, given, .. } = self;
        let (world, names) = (Arc::new(world), Arc::new(names));
        Compiled { world, cameras, course, settings, integrator, bounds, warnings, names, illuminance, given }
    }
}

/// What is known of a scene before its objects are placed.
struct SceneInputs {
    integrator: IntegratorChoice,
    sources: Vec<AnyLight>,
    background: Option<AnyBackground>,
    materials: materials::Materials,
    names: Names,
}

impl SceneInputs {
    fn of(scene: &Description, files: Files<'_>, findings: &mut Vec<Finding>) -> Self {
        let integrator = IntegratorChoice::of(scene);
        settings::check(&scene.render, findings);
        let sources = lighting::lights(&scene.lights, files, findings);
        settings::check_lights(scene, &sources, findings);
        settings::check_fit(scene, &integrator, findings);
        let background = lighting::background(scene, files, findings);
        let materials = materials::Materials::new(scene, files, findings);
        Self { integrator, sources, background, materials, names: Names::of(scene) }
    }
}

/// What the lights of a world follow from.
struct LightingInputs<'s> {
    scene: &'s Description,
    integrator: &'s IntegratorChoice,
    bounds: &'s Aabb,
    sources: &'s [AnyLight],
    tracks: &'s Tracks,
    files: Files<'s>,
}

impl LightingInputs<'_> {
    /// The lights, the brightest of them and the background, of a scene that `glows` or not.
    fn lit(
        &self,
        glows: bool,
        background: Option<AnyBackground>,
        names: &Names,
        findings: &mut Vec<Finding>,
    ) -> (Vec<Lamp>, Option<Illuminance>, AnyBackground) {
        let Self { scene, integrator, bounds, sources, tracks, files } = *self;
        let glows = glows || background.as_ref().is_some_and(|b| lights(integrator, b));
        let lit = glows || !scene.lights.is_empty();
        let default = || defaults::lights(bounds, scene, integrator).into_iter().map(Lamp::from).collect();
        let lights = if lit { lamps(sources, tracks, files, names) } else { default() };
        let illuminance = illuminance::at_the_middle(&lights, lit, bounds);
        findings.extend((lit && !glows).then(|| illuminance::warning(scene, &lights, bounds)).flatten());
        (lights, illuminance, background.unwrap_or_else(|| defaults::background(lit)))
    }
}

/// A scene whose objects are those of an earlier compilation, with materials, lights and a background of its own: nothing is
/// placed, prepared or sorted again. Nothing where that is not enough: objects would get other materials than they have, or
/// other objects shine.
pub fn with_shading(
    scene: &Description,
    tracks: &Tracks,
    files: Files<'_>,
    earlier: &Compiled,
) -> Option<(Compiled, Vec<Finding>)> {
    let mut findings = Vec::new();
    let SceneInputs { integrator, sources, background, mut materials, mut names } =
        SceneInputs::of(scene, files, &mut findings);
    materials.get_all(scene, &mut findings);
    let glows = materials.glows();
    areas::ask(scene, &mut materials, &mut names, &mut findings);
    let bounds = earlier.bounds;
    let (cameras, course) = cameras(scene, tracks, &bounds, &Path::root().key("objects"), &mut findings);
    let light = LightingInputs { scene, integrator: &integrator, bounds: &bounds, sources: &sources, tracks, files };
    let (lights, illuminance, background) = light.lit(glows, background, &names, &mut findings);
    let labels = names.labels(scene, earlier.world.labels().entries.clone());
    let (materials, given) = materials.finish(&mut names, &mut findings);
    let shines = |table: &MaterialTable, id: &MaterialId| table.glow(*id).is_some();
    let fits = given == earlier.given
        && given.iter().all(|id| shines(&materials, id) == shines(earlier.world.materials(), id));
    fits.then(|| {
        let world = Arc::new(earlier.world.with_shading(materials, lights, background).with_labels(labels));
        let (settings, names) = ((*scene.render).clone(), Arc::new(names));
        let changed =
            Compiled { world, cameras, course, settings, integrator, names, illuminance, given, ..earlier.clone() };
        (changed, findings)
    })
}

/// Every object in its place, and the number of the first shape of each of the scene's objects. Too many objects are
/// reported, and none of them is placed.
fn placed(
    scene: &Description,
    tracks: &Tracks,
    files: Files<'_>,
    materials: &mut materials::Materials,
    findings: &mut Vec<Finding>,
) -> (Vec<Object>, Vec<u32>) {
    match count::count(scene) {
        Ok(counts) => placing::place(scene, tracks, &counts, files, materials, findings),
        Err(problems) => {
            findings.extend(problems);
            (Vec::new(), Vec::new())
        }
    }
}

/// The scene's lights, which may change while the shutter is open.
fn lamps(sources: &[AnyLight], tracks: &Tracks, files: Files<'_>, names: &Names) -> Vec<Lamp> {
    let mut lamps = course::lamps(sources, tracks, files);
    names.mark(&mut lamps, sources);
    lamps
}

/// Cameras by name, the chosen one first, and what that one does while the shutter is open.
type Cameras = (Vec<(String, AnyCamera)>, Vec<AnyCamera>);

/// How a scene looks at its world, which is there already; `bounds` are those of its objects.
pub fn look_at(
    scene: &Description,
    tracks: &Tracks,
    bounds: &Aabb,
) -> (Vec<(String, AnyCamera)>, Vec<AnyCamera>, Vec<Finding>) {
    let mut findings = Vec::new();
    settings::check(&scene.render, &mut findings);
    let (cameras, course) = cameras(scene, tracks, bounds, &Path::root().key("objects"), &mut findings);
    (cameras, course, findings)
}

/// Whether a background lights the scene: panoramas and skies are made for it, and paths find every one.
fn lights(integrator: &IntegratorChoice, background: &AnyBackground) -> bool {
    let is_light = matches!(background, AnyBackground::Environment(_) | AnyBackground::Sky(_));
    is_light || integrator.follows_paths() && !background.mean().is_black()
}

/// A box around all objects that have an end.
fn bounds(objects: &[Object]) -> Aabb {
    or_some(objects.iter().map(Object::bounds).fold(Aabb::EMPTY, Aabb::union))
}

/// Some box where there is none.
fn or_some(bounds: Aabb) -> Aabb {
    if bounds.is_empty() { Transform::IDENTITY.aabb(&Aabb { min: -Vec3::ONE, max: Vec3::ONE }) } else { bounds }
}

/// Where the object is described that reaches farthest from the origin; `entries` are the numbers of the first shapes of
/// the scene's objects.
fn farthest(objects: &[Object], entries: &[u32]) -> Path {
    let reach = |bounds: Aabb| match bounds.is_empty() {
        true => 0.0,
        false => bounds.min.abs().max(bounds.max.abs()).max_element(),
    };
    let (mut first, mut most, mut number) = (0u64, 0.0, 0);
    for object in objects {
        let size = reach(object.bounds());
        if size > most {
            (most, number) = (size, first);
        }
        first = first.saturating_add(object.shapes());
    }
    let entry = entries.partition_point(|entry| u64::from(*entry) <= number).saturating_sub(1);
    Path::root().key("objects").index(entry)
}

/// The scene's cameras or the default one, each tried once; the chosen one first. That the default one cannot be is the
/// fault of the object that reaches `farthest`.
fn cameras(
    scene: &Description,
    tracks: &Tracks,
    bounds: &Aabb,
    farthest: &Path,
    findings: &mut Vec<Finding>,
) -> Cameras {
    let [width, height] = scene.render.size;
    let size = UVec2::new(width.max(1), height.max(1));
    let mut cameras: Vec<(String, AnyCamera)> = Vec::new();
    if let Some(camera) = &scene.camera {
        try_camera(camera, size, &Path::root().key("camera"), findings);
        cameras.push(("camera".into(), (**camera).clone()));
        if !scene.cameras.is_empty() {
            let problem = Finding::error("a scene has either `camera` or `cameras`, not both");
            findings.push(problem.at(Path::root().key("camera")).help("move it into `cameras` under a name"));
        }
    }
    for (name, camera) in &scene.cameras {
        try_camera(camera, size, &Path::root().key("cameras").key(name.as_str()), findings);
        cameras.push((name.clone(), (**camera).clone()));
    }
    if cameras.is_empty() {
        cameras.push(("default".into(), default_camera(bounds, size, farthest, findings)));
    }
    if let Some(chosen) = &scene.render.camera
        && let Some(at) = cameras.iter().position(|(name, _)| *name == chosen.0)
    {
        cameras[..=at].rotate_right(1);
    }
    let course = cameras.first().map(|(name, _)| course::camera(tracks, name, scene)).unwrap_or_default();
    for camera in &course {
        // The same mistake at the frame itself has been reported.
        if let (Err(invalid), true) = (camera.project(size), !findings.iter().any(Finding::is_error)) {
            let path = Path::root().key(if scene.camera.is_some() { "camera" } else { "cameras" });
            let message = format!("while the shutter is open, {}", invalid.message);
            findings.push(Finding::error(message).at(path.join(invalid.field)));
        }
    }
    (cameras, course)
}

fn default_camera(bounds: &Aabb, size: UVec2, farthest: &Path, findings: &mut Vec<Finding>) -> AnyCamera {
    let camera = defaults::camera(bounds, size);
    if camera.project(size).is_err() {
        let problem = Finding::error("this object reaches too far for the default camera to see all of the scene");
        findings.push(problem.at(farthest).help("make it smaller, or write a `camera`"));
    }
    camera
}

fn try_camera(camera: &AnyCamera, size: UVec2, path: &Path, findings: &mut Vec<Finding>) {
    if let Err(invalid) = camera.project(size) {
        let path = path.key(crate::kind::name_of(camera)).join(invalid.field);
        findings.push(Finding::error(invalid.message).at(&path));
    }
}
