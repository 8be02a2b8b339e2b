//! Compiles a scene description to a world: resolves names, places groups, prepares shapes and adds
//! defaults.

use crate::description::{Description, Render};
use crate::integrator::IntegratorChoice;
use crate::motion::Tracks;
use crate::report::{Finding, Problems};
use bounds::{bounds, farthest_object};
use juggler_camera::{AnyCamera, InvalidCamera, Perspective, ShutterCamera};
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::{MaterialId, MaterialTable};
use juggler_math::{Aabb, BuildControl, BuildStage, Cancelled, UVec2, Vec3};
use juggler_world::{Labels, Object, SceneLight, World};
use std::sync::Arc;

mod ambiguities;
pub(crate) mod area_lights;
mod bounds;
mod cameras;
mod count;
mod darkness;
mod defaults;
mod emitter_count;
mod facing;
mod file_cache;
mod illuminance;
mod images;
mod instance_files;
mod labels;
mod lighting;
mod loaded_instances;
mod locate;
mod materials;
mod meshes;
mod needs;
mod picture_estimate;
mod picture_needs;
mod placer;
mod placing;
mod prepared_instances;
mod settings;
mod shadow_catchers;
mod shutter_motion;
mod sight;
mod subjects;
mod surface_coordinates;
mod times;
mod transform_motion;

pub use count::{MAX_EMITTERS, MAX_NESTING, MAX_OBJECTS, MAX_STORED};
pub(crate) use file_cache::file_stamp;
pub use illuminance::Illuminance;
pub(crate) use images::image_files;
pub use images::{MAX_SIDE, MAX_TEXELS};
pub use labels::{Names, REST};
pub use lighting::Purpose;
pub(crate) use lighting::files as light_files;
pub use locate::ShapePlace;
pub use meshes::{AssetCache, Files};
pub(crate) use meshes::{NEVER_CANCELLED, read_error_message};
pub use needs::Needs;
pub use picture_estimate::{DECODED_AT_ONCE, Estimate, PictureNeeds};
pub(crate) use settings::check as check_settings;
pub use settings::{MAX_EDGE, MAX_PIXELS, MAX_SAMPLES, MAX_SHUTTER};
pub use subjects::Subjects;

/// Scene that is ready to render.
#[derive(Clone)]
pub struct Compiled {
    /// World: geometry, materials, lights and background.
    pub world: Arc<World>,
    /// Cameras with their names, the selected one first. At least one.
    pub cameras: Vec<(String, AnyCamera)>,
    /// Selected camera at even times from the opening to the closing of the shutter; empty if the
    /// camera is static.
    pub camera_keys: Vec<AnyCamera>,
    /// Render settings of the scene.
    pub settings: Render,
    /// Integrator, and the reason for its choice.
    pub integrator: IntegratorChoice,
    /// World-space bounding box of all bounded objects except area lights.
    pub bounds: Aabb,
    /// What the cameras frame and focus on.
    pub subjects: Subjects,
    /// Warnings about the scene.
    pub warnings: Problems,
    /// Names of objects, materials and light groups, for masks and AOVs.
    pub names: Arc<Names>,
    /// Light of the highest illuminance at the center of the scene.
    pub illuminance: Option<Illuminance>,
    /// Materials of the objects, in the order of placement.
    pub(crate) object_materials: Arc<Vec<MaterialId>>,
}

/// Parts of a [`World`] before its bounding volume hierarchies are built.
pub struct Assembly {
    /// Placed objects.
    pub objects: Vec<Object>,
    /// Compiled materials.
    pub materials: MaterialTable,
    /// Lights.
    pub lights: Vec<SceneLight>,
    /// Background.
    pub background: AnyBackground,
    /// Cameras by name, the selected one first.
    pub cameras: Vec<(String, AnyCamera)>,
    /// As [`Compiled::camera_keys`].
    pub camera_keys: Vec<AnyCamera>,
    /// Scene entries of shapes, and light groups.
    pub labels: Labels,
    /// As [`Compiled::names`].
    pub names: Names,
    /// As [`Compiled::illuminance`].
    pub illuminance: Option<Illuminance>,
    /// As [`Compiled::integrator`].
    pub integrator: IntegratorChoice,
    /// As [`Compiled::bounds`].
    pub bounds: Aabb,
    /// As [`Compiled::subjects`].
    pub subjects: Subjects,
    pub(crate) object_materials: Arc<Vec<MaterialId>>,
    /// Number of objects before those of area lights.
    own_objects: usize,
    /// Whether each of the scene's objects is a shadow catcher.
    shadow_catchers: Vec<bool>,
}

impl Compiled {
    /// Hides the background from the camera, or shows it.
    #[must_use]
    pub fn with_hidden_background(mut self, hides_background: bool) -> Self {
        self.settings.transparent = hides_background;
        if self.world.hides_background() != hides_background {
            self.world = Arc::new((*self.world).clone().with_hidden_background(hides_background));
        }
        self
    }

    /// Selected camera for images of `size` pixels, over the shutter interval.
    pub fn shutter_camera(&self, size: UVec2) -> Result<ShutterCamera, InvalidCamera> {
        let keys: Result<Vec<_>, _> = self.camera_keys.iter().map(|camera| camera.projection(size)).collect();
        let mut keys = keys?.into_iter();
        match (keys.next(), self.cameras.first()) {
            (Some(first), _) => Ok(ShutterCamera::from_keys(first, keys.collect())),
            (None, Some((_, camera))) => Ok(camera.projection(size)?.into()),
            // `cameras` has at least one element.
            (None, None) => Ok(AnyCamera::from(Perspective::default()).projection(size)?.into()),
        }
    }
}

impl Assembly {
    /// Assembles a scene. Reports invalid parts and leaves them out. `tracks` holds the items that
    /// move while the shutter is open. The assembly is incomplete if the control of `files` is
    /// cancelled.
    pub fn from_scene(scene: &Description, tracks: &Tracks, files: Files<'_>) -> (Self, Vec<Finding>) {
        files.control.begin(BuildStage::Preparing);
        let mut findings = Vec::new();
        let SceneInputs { integrator, sources, background, mut materials, mut names } =
            SceneInputs::from_scene(scene, files, &mut findings);
        let mut placed = placed(scene, tracks, files, &mut materials, &mut findings);
        let (bounds, farthest_object) = (bounds(&placed.0), farthest_object(&placed.0, &placed.1));
        let subjects = Subjects::new(scene, &placed.0, &placed.1, &bounds, files.control);
        let (has_emission, own_objects) = (materials.has_emission(), placed.0.len());
        area_lights::add(scene, tracks, &mut materials, &mut names, &mut placed, &mut findings);
        let (objects, entries) = placed;
        let (cameras, camera_keys) = subjects.cameras(scene, tracks, &farthest_object, &mut findings);
        let inputs =
            LightingInputs { scene, integrator: &integrator, bounds: &bounds, sources: &sources, tracks, files };
        let (lights, illuminance, background) = inputs.compile_lights(has_emission, background, &names, &mut findings);
        let labels = names.labels(scene, entries);
        let (materials, object_materials) = materials.finish(&mut names, &mut findings);
        facing::SceneObjects { scene, objects: &objects, entries: &labels.entries, materials: &materials }
            .check(&mut findings);
        let assembly = Self {
            objects,
            materials,
            lights,
            background,
            cameras,
            camera_keys,
            labels,
            names,
            illuminance,
            integrator,
            bounds,
            subjects,
            object_materials,
            own_objects,
            shadow_catchers: scene.objects.iter().map(|object| object.shadow_catcher).collect(),
        };
        findings.extend(darkness::warning(scene, &assembly));
        Self::check_shadow_catchers(scene, &mut findings);
        assembly.check_sight(scene, &mut findings);
        (assembly, findings)
    }

    /// Extreme points of the objects without area lights; the corners of [`Compiled::bounds`] if nothing
    /// is bounded.
    pub fn extreme_points(&self) -> Vec<Vec3> {
        let own = self.objects.get(..self.own_objects).unwrap_or_default();
        self.subjects
            .framed_points
            .as_deref()
            .map_or_else(|| subjects::points_of(own, &self.bounds, &NEVER_CANCELLED), <[Vec3]>::to_vec)
    }

    /// Builds the world with its bounding volume hierarchies.
    ///
    /// # Errors
    ///
    /// [`Cancelled`] if `control` is cancelled.
    pub fn compile(self, settings: Render, warnings: Problems, control: &BuildControl) -> Result<Compiled, Cancelled> {
        control.begin(BuildStage::Building);
        let shading = || (self.materials.clone(), self.lights.clone(), self.background.clone());
        let unoccluded = self.shadow_catching_objects().map(|objects| (objects, shading()));
        let world = World::new(self.objects, self.materials, self.lights, self.background, control)?;
        let mut world = world.with_labels(self.labels).with_hidden_background(settings.transparent);
        if let Some((objects, (materials, lights, background))) = unoccluded {
            let unoccluded = World::new(objects, materials, lights, background, control)?;
            world = world.with_shadow_catchers(self.shadow_catchers, unoccluded);
        }
        let Self { cameras, camera_keys, names, integrator, bounds, subjects, .. } = self;
        let Self { illuminance, object_materials, .. } = self;
        let (world, names) = (Arc::new(world), Arc::new(names));
        Ok(Compiled {
            world,
            cameras,
            camera_keys,
            settings,
            integrator,
            bounds,
            subjects,
            warnings,
            names,
            illuminance,
            object_materials,
        })
    }
}

/// Parts of a scene that are compiled before its objects are placed.
struct SceneInputs {
    integrator: IntegratorChoice,
    sources: Vec<AnyLight>,
    background: Option<AnyBackground>,
    materials: materials::Materials,
    names: Names,
}

impl SceneInputs {
    fn from_scene(scene: &Description, files: Files<'_>, findings: &mut Vec<Finding>) -> Self {
        let integrator = IntegratorChoice::for_scene(scene);
        settings::check(&scene.render, findings);
        let sources = lighting::lights(&scene.lights, files, findings);
        settings::check_lights(scene, &sources, findings);
        settings::check_fit(scene, &integrator, findings);
        let background = lighting::background(scene, files, findings);
        let materials = materials::Materials::new(scene, files, findings);
        let names = Names::from_scene(scene);
        names.check_groups(scene, findings);
        Self { integrator, sources, background, materials, names }
    }
}

/// Inputs that determine the lights of a world.
struct LightingInputs<'s> {
    scene: &'s Description,
    integrator: &'s IntegratorChoice,
    bounds: &'s Aabb,
    sources: &'s [AnyLight],
    tracks: &'s Tracks,
    files: Files<'s>,
}

impl LightingInputs<'_> {
    /// Lights, the brightest of them, and the background; `has_emission` tells whether materials
    /// emit light.
    fn compile_lights(
        &self,
        has_emission: bool,
        background: Option<AnyBackground>,
        names: &Names,
        findings: &mut Vec<Finding>,
    ) -> (Vec<SceneLight>, Option<Illuminance>, AnyBackground) {
        let Self { scene, integrator, bounds, sources, tracks, files } = *self;
        let has_emission =
            has_emission || background.as_ref().is_some_and(|b| darkness::is_light_source(integrator, b));
        let has_lights = has_emission || !scene.lights.is_empty();
        let default = || defaults::lights(bounds, scene, integrator).into_iter().map(SceneLight::from).collect();
        let lights = if has_lights { compile_sources(sources, tracks, files, names) } else { default() };
        let illuminance = illuminance::at_center(&lights, has_lights, bounds);
        findings.extend((has_lights && !has_emission).then(|| illuminance::warning(scene, &lights, bounds)).flatten());
        (lights, illuminance, background.unwrap_or_else(|| defaults::background(has_lights)))
    }
}

/// Compiles materials, lights and background for the objects of an earlier compilation, without
/// placing or preparing them or building hierarchies. Returns `None` if that does not suffice:
/// objects would get other materials, or other objects emit light; and if the control of `files` is
/// cancelled.
pub fn with_shading(
    scene: &Description,
    tracks: &Tracks,
    files: Files<'_>,
    earlier: &Compiled,
) -> Option<(Compiled, Vec<Finding>)> {
    let mut findings = Vec::new();
    let SceneInputs { integrator, sources, background, mut materials, mut names } =
        SceneInputs::from_scene(scene, files, &mut findings);
    materials.request_all(scene, &mut findings);
    let has_emission = materials.has_emission();
    area_lights::request_materials(scene, &mut materials, &mut names, &mut findings);
    let bounds = earlier.bounds;
    let (cameras, camera_keys) = earlier.subjects.cameras_again(scene, tracks, &mut findings)?;
    let inputs = LightingInputs { scene, integrator: &integrator, bounds: &bounds, sources: &sources, tracks, files };
    let (lights, illuminance, background) = inputs.compile_lights(has_emission, background, &names, &mut findings);
    let labels = names.labels(scene, earlier.world.labels().entries.clone());
    let (materials, object_materials) = materials.finish(&mut names, &mut findings);
    let emits = |table: &MaterialTable, id: &MaterialId| table.emission(*id).is_some();
    let fits = object_materials == earlier.object_materials
        && object_materials.iter().all(|id| emits(&materials, id) == emits(earlier.world.materials(), id));
    if !fits {
        return None;
    }
    let world = earlier.world.with_shading(materials, lights, background, files.control).ok()?;
    let world = world.with_labels(labels).with_hidden_background(scene.render.transparent);
    let (world, settings, names) = (Arc::new(world), (*scene.render).clone(), Arc::new(names));
    let base = Compiled { world, cameras, camera_keys, settings, integrator, ..earlier.clone() };
    Some((Compiled { names, illuminance, object_materials, ..base }, findings))
}

/// Places all objects. Returns them with the index of the first shape of each scene entry. If there
/// are too many objects, reports that and places none.
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
fn compile_sources(sources: &[AnyLight], tracks: &Tracks, files: Files<'_>, names: &Names) -> Vec<SceneLight> {
    let mut lights = shutter_motion::lights(sources, tracks, files);
    names.assign_groups(&mut lights, sources);
    lights
}
