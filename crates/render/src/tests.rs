//! Tests of the whole engine: closed forms, furnaces, and independence of tiles.

use super::*;
use juggler_bsdf::fresnel;
use juggler_camera::aov::{self, LightGroup};
use juggler_camera::film::{Box as BoxFilter, ReconstructionFilter};
use juggler_camera::sampler::{AnyPointSet, SamplerDescription, Sobol, SobolPoints};
use juggler_camera::{AnyCamera, Perspective};
use juggler_integrator::{AnyIntegrator, Classic, Integrator, PathState, VertexOutput};
use juggler_light::AnyLight;
use juggler_light::background::{AnyBackground, Solid};
use juggler_material::{AnyMaterial, MaterialCompiler};
use juggler_math::{Motion, Ray, Rgb, Transform, UVec2, Vec3};
use juggler_shape::AnyShape;
use juggler_texture::{Image, Images, MipMap, TextureTable};
use juggler_world::{Object, Vertex};
use serde::de::DeserializeOwned;

mod blur;
mod cancelling;
mod clamping;
mod cones;
mod filters;
mod inside;
mod inspecting;
mod opacity;

pub fn read<T: DeserializeOwned>(json: &str) -> T {
    serde_json::from_str(json).unwrap_or_else(|error| panic!("{error} in {json}"))
}

/// World of objects given as shape, position and material.
pub fn world(objects: &[(&str, Vec3, &str)], lights: &[&str], background: Rgb) -> World {
    let objects: Vec<(&str, Motion, &str)> = objects
        .iter()
        .map(|(shape, place, material)| (*shape, Transform::translation(*place).into(), *material))
        .collect();
    world_in_motion(&objects, lights, background)
}

/// World of objects given as shape, motion and material.
pub fn world_in_motion(objects: &[(&str, Motion, &str)], lights: &[&str], background: Rgb) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let objects = objects
        .iter()
        .map(|(shape, motion, material)| {
            let mut shape: AnyShape = read(shape);
            shape.prepare().unwrap();
            let material: AnyMaterial = read(material);
            let material = compiler.compile(&material).unwrap();
            Object::new(shape, motion.clone(), material)
        })
        .collect();
    let lights = lights.iter().map(|light| read::<AnyLight>(light));
    World::new(
        objects,
        compiler.finish().unwrap(),
        lights,
        AnyBackground::Solid(Solid { color: background }),
        &juggler_math::BuildControl::default(),
    )
    .unwrap()
}

pub fn look(eye: Vec3, look_at: Vec3, fov: &str, size: UVec2) -> ShutterCamera {
    let camera: Perspective = read(&format!(
        r#"{{"eye": [{}, {}, {}], "look_at": [{}, {}, {}], "vertical_fov_degrees": {fov}}}"#,
        eye.x, eye.y, eye.z, look_at.x, look_at.y, look_at.z
    ));
    AnyCamera::from(camera).projection(size).unwrap().into()
}

pub fn pixels(
    world: &World,
    camera: &ShutterCamera,
    integrator: &AnyIntegrator,
    size: UVec2,
    samples: u32,
) -> Vec<Rgb> {
    let job = job(world, camera, integrator, samples);
    let pixels = Rect { x: 0, y: 0, width: size.x, height: size.y };
    job.render(&Work::first(pixels, samples), &Control::default()).unwrap().means()
}

/// Without a frame, samples have one camera ray unless the integrator demands more.
static WITHOUT_FRAME: CameraRays = CameraRays::new(UVec2::ZERO);

pub fn job<'w>(world: &'w World, camera: &'w ShutterCamera, integrator: &'w AnyIntegrator, samples: u32) -> Job<'w> {
    let (pattern, filter) = (Sobol {}.point_set(samples), BoxFilter {}.sampler(samples));
    assert_eq!(pattern, AnyPointSet::SobolPoints(SobolPoints));
    Job {
        world,
        camera,
        integrator: &**integrator,
        filter,
        pattern,
        samples,
        seed: 1,
        camera_rays: &WITHOUT_FRAME,
        aovs: &aov::NO_AOVS,
        frames: None,
    }
}

fn near(a: Rgb, b: Rgb, tolerance: f32) -> bool {
    let d = a - b;
    d.r.abs() <= tolerance && d.g.abs() <= tolerance && d.b.abs() <= tolerance
}

const PIXEL: UVec2 = UVec2::ONE;

/// World with mirrors, glossy and blurry ray bundles, glass, soft shadows, ambient occlusion, and
/// slots of more rays than a group holds.
pub fn busy() -> World {
    let glossy = r#"{"phong": {"diffuse": [0.2, 0.3, 0.4], "reflection": 0.7, "ambient": 0.3, "occlusion": 1,
        "glossy": {"half_angle_degrees": 20, "rays": 24}}}"#;
    let glass = r#"{"phong": {"diffuse": 0.1, "transparency": [0.9, 0.8, 0.9], "reflection": 0.2, "ior": 1.5,
        "blurry": {"half_angle_degrees": 10, "rays": 24}}}"#;
    let lights = [
        r#"{"point": {"position": [2, 5, 3], "intensity": 30, "extent": {"sphere": {"radius": 1}}, "samples": 3}}"#,
        r#"{"directional": {"direction": [-1, -1, 0], "intensity": 0.3}}"#,
        r#"{"ambient": {"intensity": 0.5}}"#,
    ];
    let objects = [
        (r#"{"plane": {}}"#, Vec3::new(0.0, -1.0, 0.0), glossy),
        (r#"{"sphere": {"radius": 1}}"#, Vec3::new(-1.2, 0.0, 0.0), glass),
        (r#"{"sphere": {"radius": 1}}"#, Vec3::new(1.2, 0.0, 0.0), glossy),
        (r#"{"cuboid": {}}"#, Vec3::new(0.0, 0.2, -2.0), glossy),
    ];
    world(&objects, &lights, Rgb::new(0.3, 0.4, 0.6))
}

#[test]
fn pixels_do_not_depend_on_tiles() {
    let (world, size, samples) = (busy(), UVec2::new(12, 8), 3);
    let camera = look(Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, "40", size);
    let integrator = Classic { max_depth: 3, min_weight: 1e-4, occlusion_distance: Some(2.0) }.into();
    let whole = pixels(&world, &camera, &integrator, size, samples);
    let job = job(&world, &camera, &integrator, samples);
    for (x, y) in [(0, 0), (3, 5), (5, 4), (8, 4), (11, 7), (6, 6)] {
        let pixels = Rect { x, y, width: 1, height: 1 };
        let alone = job.render(&Work::first(pixels, samples), &Control::default()).unwrap().means();
        assert_eq!(alone[0], whole[(y * size.x + x) as usize], "pixel {x}, {y}");
    }
    assert!(whole.iter().all(|pixel| pixel.is_finite() && pixel.luminance() > 0.0));
}

#[test]
fn ambient_furnace_is_white() {
    // Inside a white sphere lit by ambient light of 1 alone, every pixel is exactly 1.
    let material = r#"{"phong": {"diffuse": 1, "ambient": 1, "specular": 0}}"#;
    let objects = [(r#"{"sphere": {"radius": 10}}"#, Vec3::ZERO, material)];
    let world = world(&objects, &[r#"{"ambient": {"color": 1, "intensity": 1}}"#], Rgb::BLACK);
    let size = UVec2::new(16, 16);
    let camera = look(Vec3::ZERO, Vec3::X, "90", size);
    let all = pixels(&world, &camera, &Classic::default().into(), size, 4);
    assert!(all.iter().all(|pixel| *pixel == Rgb::WHITE), "{:?}", all[0]);
}

#[test]
fn mirror_furnace_has_the_color_of_its_reflectance() {
    // A mirror of reflectance f in a field of radiance 1 has radiance f; ten reflections would give
    // f^10.
    let material = r#"{"phong": {"diffuse": 0, "ambient": 0, "specular": 0, "reflection": [0.5, 0.25, 1]}}"#;
    let objects = [(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, material)];
    let world = world(&objects, &[], Rgb::WHITE);
    let camera = look(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, "5", PIXEL);
    let all = pixels(&world, &camera, &Classic::default().into(), PIXEL, 16);
    assert_eq!(all[0], Rgb::new(0.5, 0.25, 1.0));
}

#[test]
fn a_light_over_a_floor_obeys_the_inverse_square() {
    let material = r#"{"phong": {"diffuse": 0.5, "ambient": 0, "specular": 0}}"#;
    let objects = [(r#"{"plane": {}}"#, Vec3::ZERO, material)];
    let light = r#"{"point": {"position": [3, 4, 0], "intensity": 100}}"#;
    let world = world(&objects, &[light], Rgb::BLACK);
    let camera = look(Vec3::new(0.0, 5.0, 0.0), Vec3::ZERO, "1", PIXEL);
    let all = pixels(&world, &camera, &Classic::default().into(), PIXEL, 1);
    // Distance 5, cosine 4/5.
    assert!(near(all[0], Rgb::splat(0.5 * 100.0 / 25.0 * 0.8), 1e-5), "{:?}", all[0]);
}

#[test]
fn ambient_occlusion_beside_an_infinite_wall_is_one_half() {
    // In the corner of floor and wall, the wall covers half of the hemisphere.
    let material = r#"{"phong": {"diffuse": 1, "ambient": 1, "occlusion": 1, "specular": 0}}"#;
    let objects = [
        (r#"{"plane": {}}"#, Vec3::ZERO, material),
        (r#"{"cuboid": {"min": [-1, -1e4, -1e4], "max": [0, 1e4, 1e4]}}"#, Vec3::ZERO, material),
    ];
    let world = world(&objects, &[r#"{"ambient": {"intensity": 1}}"#], Rgb::BLACK);
    let camera = look(Vec3::new(3.0, 3.0, 0.0), Vec3::new(0.001, 0.0, 0.0), "0.001", PIXEL);
    let classic = Classic { occlusion_distance: Some(100.0), ..Classic::default() };
    let all = pixels(&world, &camera, &classic.into(), PIXEL, 4096);
    assert!(near(all[0], Rgb::splat(0.5), 0.01), "{:?}", all[0]);
}

#[test]
fn a_glass_sphere_shows_fresnel_and_bends_light() {
    // Through the center of a sphere of index 1.5 in a white field: (1 − R)² of the light is
    // transmitted and R is reflected. Internal reflections are followed, so that no energy is lost.
    let material = r#"{"phong": {"diffuse": 0, "ambient": 0, "specular": 0, "reflection": 1, "transparency": 1,
        "ior": 1.5, "fresnel": true}}"#;
    let objects = [(r#"{"sphere": {"radius": 1}}"#, Vec3::ZERO, material)];
    let world = world(&objects, &[], Rgb::WHITE);
    let size = UVec2::new(8, 8);
    let camera = look(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, "20", size);
    let integrator = Classic { max_depth: 40, min_weight: 1e-6, occlusion_distance: None }.into();
    let all = pixels(&world, &camera, &integrator, size, 4);
    assert!(all.iter().all(|pixel| near(*pixel, Rgb::WHITE, 1e-3)), "{all:?}");
    assert!((fresnel::dielectric_reflectance(1.0, 1.5) - 0.04).abs() < 1e-6);
}

#[test]
fn transparent_objects_cast_colored_shadows() {
    let floor = r#"{"phong": {"diffuse": 1, "ambient": 0, "specular": 0}}"#;
    let pane = r#"{"phong": {"diffuse": 0, "ambient": 0, "transparency": [1, 0.5, 0.25]}}"#;
    let objects = [
        (r#"{"plane": {}}"#, Vec3::ZERO, floor),
        (r#"{"rectangle": {"size": [4, 4]}}"#, Vec3::new(0.0, 2.0, 0.0), pane),
        (r#"{"rectangle": {"size": [4, 4]}}"#, Vec3::new(0.0, 3.0, 0.0), pane),
    ];
    let light = r#"{"directional": {"direction": [0, -1, 0], "intensity": 1}}"#;
    let world = world(&objects, &[light], Rgb::BLACK);
    let camera = look(Vec3::new(9.0, 1.0, 0.0), Vec3::ZERO, "0.1", PIXEL);
    let all = pixels(&world, &camera, &Classic::default().into(), PIXEL, 1);
    assert!(near(all[0], Rgb::new(1.0, 0.25, 0.0625), 1e-5), "{:?}", all[0]);
}

#[test]
fn penumbra_of_an_edge_is_linear() {
    // A square light of side 2 at height 10 and an edge at height 5 cast a penumbra of width 2 on
    // the floor, across which the irradiance is linear (the cosines differ by less than one
    // percent).
    let floor = r#"{"phong": {"diffuse": 1, "ambient": 0, "specular": 0}}"#;
    let objects = [
        (r#"{"plane": {}}"#, Vec3::ZERO, floor),
        (r#"{"cuboid": {"min": [0, 4.999, -1000], "max": [1000, 5, 1000]}}"#, Vec3::ZERO, floor),
    ];
    let light = r#"{"point": {"position": [0, 10, 0], "intensity": 100, "extent": {"square": {"side": 2}}}}"#;
    let world = world(&objects, &[light], Rgb::BLACK);
    for (x, share) in [(-0.75, 0.875), (-0.5, 0.75), (0.0, 0.5), (0.5, 0.25), (0.75, 0.125)] {
        let camera = look(Vec3::new(x, 3.0, 0.01), Vec3::new(x, 0.0, 0.0), "0.001", PIXEL);
        let all = pixels(&world, &camera, &Classic::default().into(), PIXEL, 1024);
        assert!((all[0].r - share).abs() < 0.02, "at {x}: {} for {share}", all[0].r);
    }
}

#[test]
fn a_single_sample_looks_through_the_pixels_center() {
    // A sphere that covers only the center of the middle pixel of a 3 × 3 picture.
    let material = r#"{"phong": {"emission": 1}}"#;
    let objects = [(r#"{"sphere": {"radius": 0.01}}"#, Vec3::ZERO, material)];
    let world = world(&objects, &[], Rgb::BLACK);
    let size = UVec2::new(3, 3);
    let camera = look(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO, "40", size);
    let all = pixels(&world, &camera, &Classic::default().into(), size, 1);
    let lit: Vec<usize> = (0..9).filter(|i| !all[*i].is_black()).collect();
    assert_eq!(lit, [4]);
}

/// Integrator whose radiance is NaN in every third column and negative in some others.
struct Broken;

impl Integrator for Broken {
    fn vertex(&self, _: &World, _: &Ray, _: &PathState, _: &Vertex, _: &mut VertexOutput) {}

    fn escape(&self, _: &World, ray: &Ray, _: &PathState, output: &mut VertexOutput) {
        let column = (ray.direction.x * 40.0).floor() as i32;
        output.add(Rgb::splat(if column.rem_euclid(3) == 0 { f32::NAN } else { column as f32 }), LightGroup::REST);
    }
}

#[test]
fn single_sample_picture_equals_the_tile_means() {
    let (busy, size) = (busy(), UVec2::new(40, 33));
    let camera = look(Vec3::new(0.0, 1.0, 6.0), Vec3::ZERO, "40", size);
    let pixels = Rect { x: 2, y: 1, width: 38, height: 32 };
    let classic: AnyIntegrator = Classic { max_depth: 3, ..Classic::default() }.into();
    for (integrator, lost) in [(&*classic, false), (&Broken as &dyn Integrator, true)] {
        let job = Job { integrator, ..job(&busy, &camera, &classic, 1) };
        let (one, two) = (Control::default(), Control::default());
        let single = wavefront::Engine::new(&job).render_single(pixels, &one).unwrap();
        let tile = job.render(&Work::first(pixels, 1), &two).unwrap();
        assert_eq!(single, (tile.means(), tile.clamped()));
        assert_eq!(one.rays(), two.rays());
        assert_eq!(one.rays().not_finite > 0, lost);
    }
}
