//! The path integrator, which combines light and BSDF sampling by multiple importance sampling,
//! against two path tracers that use one strategy each and need no weights.

use crate::probe::{Scene, looking, measure, path};
use crate::skies::panorama;
use juggler_bsdf::Scatter;
use juggler_camera::ShutterCamera;
use juggler_camera::aov::LightGroup;
use juggler_integrator::{Integrator, PathHistory, PathState, VertexOutput};
use juggler_math::testing::family_wise_deviations;
use juggler_math::{Ray, Rgb, Transform, Vec3};
use juggler_world::{LightSampleContext, ShadowMode, Vertex, World};

const MAX_DEPTH: u32 = 12;

/// Sampling strategy.
#[derive(Clone, Copy, PartialEq)]
enum Strategy {
    /// BSDF sampling: emission counts where paths hit it.
    Bsdf,
    /// Next-event estimation at each vertex; emission that paths hit counts only from the camera or
    /// after specular surfaces.
    Light,
}

/// Path tracer for surfaces only, without media and nested dielectrics.
struct Plain(Strategy);

impl Integrator for Plain {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        let choice = path.sampler.skipped(0).next_2d();
        let wo = -ray.direction;
        let shading = world.shade(vertex, wo, 1.0, choice.x);
        if shading.opacity < 1.0 && choice.y >= shading.opacity {
            return output.continue_path(
                vertex.surface.spawn_ray(ray.direction, ray.time),
                Rgb::WHITE,
                path.history,
                0,
            );
        }
        if self.0 == Strategy::Bsdf || path.history.pdf == f32::INFINITY {
            output.add(shading.emission, LightGroup::REST);
        }
        if path.depth + 1 >= MAX_DEPTH {
            return;
        }
        let (surface, local) = (&vertex.surface, shading.frame.to_local(wo));
        if self.0 == Strategy::Light {
            let normal = if shading.transmissive { Vec3::ZERO } else { shading.frame.normal };
            let to = LightSampleContext { point: surface.point, error: surface.position_error, normal, time: ray.time };
            if let Some(light) = world.sample_light(&to, path.sampler.skipped(1).next_2d()) {
                let (scattered, _) = shading.bsdf.eval_pdf(local, shading.frame.to_local(light.wi));
                let shadow = surface.spawn_ray_to(light.wi, light.distance, ray.time);
                output.add_shadow_ray(shadow, light.radiance * scattered * (1.0 / light.pdf), LightGroup::REST);
            }
        }
        if let Some(sample) =
            shading.bsdf.sample(local, path.sampler.skipped(2).next_2d(), path.sampler.skipped(3).next_1d())
        {
            let pdf = if sample.scatter == Scatter::Specular { f32::INFINITY } else { sample.pdf };
            let continued = surface.spawn_ray(shading.frame.to_world(sample.wi), ray.time);
            output.continue_path(continued, sample.weight, PathHistory { pdf, ..path.history }, 1);
        }
    }

    fn escape(&self, world: &World, ray: &Ray, path: &PathState, output: &mut VertexOutput) {
        if self.0 == Strategy::Bsdf || path.history.pdf == f32::INFINITY {
            output.add(world.background_radiance(ray), LightGroup::REST);
        }
    }

    fn shadows(&self) -> ShadowMode {
        ShadowMode::Physical
    }
}

fn emitter(scene: Scene, radius: f32, at: Vec3, radiance: f32) -> Scene {
    let shape = format!(r#"{{"sphere": {{"radius": {radius}}}}}"#);
    scene.with(&shape, at, &format!(r#"{{"emissive": {{"radiance": {radiance}}}}}"#))
}

fn plate(material: &str) -> Scene {
    Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, material)
}

fn rough(roughness: f32) -> Scene {
    plate(&format!(r#"{{"conductor": {{"metal": "copper", "roughness": {roughness}}}}}"#))
}

/// View in which the mirror image of a light straight above lies a little beside the point.
fn view() -> ShutterCamera {
    looking(Vec3::new(1.0, 2.0, 0.5), Vec3::ZERO)
}

fn classic() -> Scene {
    let material = r#"{"phong": {"diffuse": [0.5, 0.3, 0.2], "specular": 0.3, "shininess": 20, "reflection": 0.2, "highlight_color": 1}}"#;
    emitter(plate(material), 0.6, Vec3::new(-1.0, 2.0, -0.5), 4.0).in_light(0.2)
}

/// A box with a light in its ceiling, a sphere of rough glass and an emissive ellipsoid.
fn room() -> Scene {
    let walls = r#"{"cuboid": {"min": [-2, 0, -2], "max": [2, 4, 2]}}"#;
    let down = Transform::rotation(Vec3::X, std::f32::consts::PI).unwrap();
    let stretched = Transform::scale(Vec3::new(0.2, 0.6, 0.3)).unwrap();
    Scene::new()
        .with(walls, Vec3::ZERO, r#"{"diffuse": {"reflectance": 0.6}}"#)
        .placed(
            r#"{"rectangle": {"size": [2, 2]}}"#,
            down.then(&Transform::translation(Vec3::Y * 3.9)),
            r#"{"emissive": {"radiance": 3, "material": {"diffuse": {"reflectance": 0.3}}}}"#,
        )
        .placed(
            r#"{"sphere": {"radius": 1}}"#,
            stretched.then(&Transform::translation(Vec3::new(-1.0, 1.5, 0.3))),
            r#"{"emissive": {"radiance": 5}}"#,
        )
        .with(
            r#"{"sphere": {"radius": 0.5}}"#,
            Vec3::new(0.8, 0.6, 0.2),
            r#"{"dielectric": {"ior": 1.5, "roughness": 0.4}}"#,
        )
        .with(
            r#"{"cuboid": {"min": [-0.5, 0.4, -1], "max": [0.3, 0.8, -0.5]}}"#,
            Vec3::ZERO,
            r#"{"mask": {"opacity": 0.5, "material": {"diffuse": {"reflectance": 0.9}}}}"#,
        )
}

fn lid(material: &str) -> Scene {
    let down = Transform::rotation(Vec3::X, 3.0).unwrap().then(&Transform::translation(Vec3::Y * 0.4));
    plate(material).placed(r#"{"rectangle": {"size": [3, 3]}}"#, down, r#"{"emissive": {"radiance": 1}}"#)
}

fn inside() -> ShutterCamera {
    looking(Vec3::new(0.0, 2.0, 1.8), Vec3::new(0.3, 0.0, -0.2))
}

/// Worlds of surfaces whose light both strategies find.
pub fn scenes() -> Vec<(&'static str, Scene, ShutterCamera)> {
    let above = Vec3::new(-1.0, 2.0, -0.5);
    vec![
        ("small emitter, glossy plate", emitter(rough(0.35), 0.3, above, 50.0), view()),
        ("large emitter, glossy plate", emitter(rough(0.35), 1.5, above, 2.0), view()),
        ("large emitter, rough plate", emitter(rough(0.9), 1.5, above, 2.0), view()),
        (
            "emitter near a plate",
            emitter(plate(r#"{"diffuse": {}}"#), 0.5, Vec3::new(0.1, 0.52, 0.0), 1.0),
            looking(Vec3::new(1.0, 0.1, 1.0), Vec3::ZERO),
        ),
        ("lid over a plate", lid(r#"{"diffuse": {}}"#), looking(Vec3::new(-2.0, 0.2, -2.0), Vec3::ZERO)),
        ("panorama, glossy plate", rough(0.5).before(panorama()), view()),
        ("classic plate", classic(), view()),
        ("room", room(), inside()),
    ]
}

#[test]
fn all_techniques_find_the_same_light() {
    for (name, scene, camera) in scenes() {
        let world = scene.world();
        let both = measure(&world, &camera, &*path(r#""max_depth": 12, "roulette_depth": null"#), 256);
        let bsdf_sampled = measure(&world, &camera, &Plain(Strategy::Bsdf), 1024);
        let light_sampled = measure(&world, &camera, &Plain(Strategy::Light), 1024);
        println!("{name}: {both:?} {bsdf_sampled:?} {light_sampled:?}");
        both.equals(bsdf_sampled, &format!("{name}, BSDF sampling"));
        both.equals(light_sampled, &format!("{name}, light sampling"));
    }
}

/// The `sampling` option changes only the noise, also for caustics of specular spheres.
#[test]
fn all_sampling_options_have_the_same_mean() {
    // Light sampling through glass is correct, but too noisy for this test.
    let caustics = crate::caustics::SCENES.into_iter().filter(|(name, _)| !name.contains("glass") && *name != "sky");
    let caustics = caustics.map(|(name, build)| (name, build(false), crate::caustics::look()));
    let all: Vec<_> = scenes().into_iter().chain(caustics).collect();
    assert!(all.len() >= 12);
    let deviations = family_wise_deviations(2 * all.len());
    for (name, scene, camera) in all {
        let world = scene.world();
        let seen = |sampling: &str, samples| {
            let options = format!(r#""max_depth": 10, "roulette_depth": null, "sampling": "{sampling}""#);
            measure(&world, &camera, &*path(&options), samples)
        };
        let [mis, light, bsdf] = [seen("mis", 256), seen("light", 1024), seen("bsdf", 1024)];
        println!("{name}: {mis:?} {light:?} {bsdf:?}");
        mis.equals_within(light, deviations, &format!("{name}, light"));
        mis.equals_within(bsdf, deviations, &format!("{name}, bsdf"));
    }
}
