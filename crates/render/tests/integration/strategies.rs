//! The path tracer, which weighs two ways to find light against each other, against two that know one of them only, and
//! have no weights to get wrong.

use crate::probe::{Scene, looking, measure, path};
use crate::skies::panorama;
use juggler_bsdf::Scatter;
use juggler_camera::Shot;
use juggler_camera::layer::LightGroup;
use juggler_integrator::{Emit, Integrator, PathState, Trail};
use juggler_math::testing::family_wise_deviations;
use juggler_math::{Ray, Rgb, Transform, Vec3};
use juggler_world::{Receiver, Shadows, Vertex, World};

const MAX_DEPTH: u32 = 12;

/// How light is found.
#[derive(Clone, Copy, PartialEq)]
enum Finds {
    /// Where the path happens to meet it.
    Lights,
    /// By asking a light at each vertex; met by chance only in mirrors, through clear glass, and directly.
    Asks,
}

/// Surfaces only: no media, no solids within each other.
struct Plain(Finds);

impl Integrator for Plain {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        let choice = path.sampler.at(0).next_2d();
        let wo = -ray.direction;
        let shade = world.shade(vertex, wo, 1.0, choice.x);
        if shade.opacity < 1.0 && choice.y >= shade.opacity {
            return emit.follow(vertex.surface.spawn(ray.direction, ray.time), Rgb::WHITE, path.trail, 0);
        }
        if self.0 == Finds::Lights || path.trail.pdf == f32::INFINITY {
            emit.add(shade.emission, LightGroup::REST);
        }
        if path.depth + 1 >= MAX_DEPTH {
            return;
        }
        let (surface, local) = (&vertex.surface, shade.frame.to_local(wo));
        if self.0 == Finds::Asks {
            let normal = if shade.transmissive { Vec3::ZERO } else { shade.frame.normal };
            let to = Receiver { point: surface.point, error: surface.error, normal, time: ray.time };
            if let Some(light) = world.sample_light(&to, path.sampler.at(1).next_2d()) {
                let (scattered, _) = shade.bsdf.eval_pdf(local, shade.frame.to_local(light.wi));
                let shadow = surface.spawn_to(light.wi, light.distance, ray.time);
                emit.if_visible(shadow, light.radiance * scattered * (1.0 / light.pdf), LightGroup::REST);
            }
        }
        if let Some(sample) = shade.bsdf.sample(local, path.sampler.at(2).next_2d(), path.sampler.at(3).next_1d()) {
            let pdf = if sample.scatter == Scatter::Specular { f32::INFINITY } else { sample.pdf };
            let way = surface.spawn(shade.frame.to_world(sample.wi), ray.time);
            emit.follow(way, sample.weight, Trail { pdf, ..path.trail }, 1);
        }
    }

    fn escape(&self, world: &World, ray: &Ray, path: &PathState, emit: &mut Emit) {
        if self.0 == Finds::Lights || path.trail.pdf == f32::INFINITY {
            emit.add(world.background(ray), LightGroup::REST);
        }
    }

    fn shadows(&self) -> Shadows {
        Shadows::Physical
    }
}

fn lamp(scene: Scene, radius: f32, at: Vec3, radiance: f32) -> Scene {
    let shape = format!(r#"{{"sphere": {{"radius": {radius}}}}}"#);
    scene.with(&shape, at, &format!(r#"{{"emissive": {{"radiance": {radiance}}}}}"#))
}

fn plate(material: &str) -> Scene {
    Scene::new().with(r#"{"plane": {}}"#, Vec3::ZERO, material)
}

fn rough(roughness: f32) -> Scene {
    plate(&format!(r#"{{"conductor": {{"metal": "copper", "roughness": {roughness}}}}}"#))
}

/// From where the mirror image of a lamp straight above is a little beside the point.
fn view() -> Shot {
    looking(Vec3::new(1.0, 2.0, 0.5), Vec3::ZERO)
}

fn classic() -> Scene {
    let material = r#"{"phong": {"diffuse": [0.5, 0.3, 0.2], "specular": 0.3, "shininess": 20, "reflection": 0.2, "highlight_color": 1}}"#;
    lamp(plate(material), 0.6, Vec3::new(-1.0, 2.0, -0.5), 4.0).in_light(0.2)
}

/// A box with a lamp in its ceiling, a block of rough glass and a stretched ball that glows.
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

fn inside() -> Shot {
    looking(Vec3::new(0.0, 2.0, 1.8), Vec3::new(0.3, 0.0, -0.2))
}

/// Worlds of surfaces with light that both ways find.
pub fn scenes() -> Vec<(&'static str, Scene, Shot)> {
    let above = Vec3::new(-1.0, 2.0, -0.5);
    vec![
        ("small lamp, glossy plate", lamp(rough(0.35), 0.3, above, 50.0), view()),
        ("large lamp, glossy plate", lamp(rough(0.35), 1.5, above, 2.0), view()),
        ("large lamp, rough plate", lamp(rough(0.9), 1.5, above, 2.0), view()),
        (
            "lamp near a plate",
            lamp(plate(r#"{"diffuse": {}}"#), 0.5, Vec3::new(0.1, 0.52, 0.0), 1.0),
            looking(Vec3::new(1.0, 0.1, 1.0), Vec3::ZERO),
        ),
        ("lid over a plate", lid(r#"{"diffuse": {}}"#), looking(Vec3::new(-2.0, 0.2, -2.0), Vec3::ZERO)),
        ("panorama, glossy plate", rough(0.5).before(panorama()), view()),
        ("classic plate", classic(), view()),
        ("room", room(), inside()),
    ]
}

#[test]
fn all_ways_find_the_same_light() {
    for (name, scene, shot) in scenes() {
        let world = scene.world();
        let both = measure(&world, &shot, &*path(r#""max_depth": 12, "roulette_depth": null"#), 256);
        let met = measure(&world, &shot, &Plain(Finds::Lights), 1024);
        let asked = measure(&world, &shot, &Plain(Finds::Asks), 1024);
        println!("{name}: {both:?} {met:?} {asked:?}");
        both.equals(met, &format!("{name}, met"));
        both.equals(asked, &format!("{name}, asked"));
    }
}

/// `sampling` changes the noise alone, also of light by way of polished balls.
#[test]
fn all_settings_of_sampling_have_one_mean() {
    // Light samples by way of glass are right, but too noisy to tell.
    let balls = crate::balls::SCENES.into_iter().filter(|(name, _)| !name.contains("glass") && *name != "sky");
    let balls = balls.map(|(name, build)| (name, build(false), crate::balls::look()));
    let all: Vec<_> = scenes().into_iter().chain(balls).collect();
    assert!(all.len() >= 12);
    let deviations = family_wise_deviations(2 * all.len());
    for (name, scene, shot) in all {
        let world = scene.world();
        let seen = |sampling: &str, samples| {
            let options = format!(r#""max_depth": 10, "roulette_depth": null, "sampling": "{sampling}""#);
            measure(&world, &shot, &*path(&options), samples)
        };
        let [mis, light, bsdf] = [seen("mis", 256), seen("light", 1024), seen("bsdf", 1024)];
        println!("{name}: {mis:?} {light:?} {bsdf:?}");
        mis.equals_within(light, deviations, &format!("{name}, light"));
        mis.equals_within(bsdf, deviations, &format!("{name}, bsdf"));
    }
}
