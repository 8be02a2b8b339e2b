//! Recursive ray tracing as in 1980 and 1986: local light, mirrors and glass.
//!
//! At each vertex: emission, ambient light (less what nearby geometry hides: one short ray), and for each
//! light a shadow ray (Phong 1975); then a mirrored and a refracted ray, or bundles of them (Whitted 1980).
//!
//! ```json
//! {"classic": {"max_depth": 10, "min_weight": 0.004, "occlusion_distance": 100}}
//! ```

mod physical;

use super::{Emit, Integrator, PathState, Sight};
use juggler_bsdf::{Cone, Highlight, Phong, Scatter, cone, fresnel};
use juggler_camera::layer::LightGroup;
use juggler_camera::sampler::Sampler;
use juggler_math::{Ray, Rgb, Vec2, Vec3, fun, warp};
use juggler_shape::surface::Surface;
use juggler_world::{Lamp, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Recursive ray tracing: local light, mirrors and glass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Classic {
    /// How many mirrors and windows a ray may meet on its way; 0 for none.
    #[schemars(range(min = 0, max = 1000))]
    pub max_depth: u32,
    /// Rays that count less than this in every channel are not followed.
    #[schemars(range(min = 0, max = 1))]
    pub min_weight: f32,
    /// How far ambient occlusion looks; geometry beyond it hides nothing. Without it no material is
    /// occluded.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub occlusion_distance: Option<f32>,
}

impl Default for Classic {
    fn default() -> Self {
        Self { max_depth: 10, min_weight: 1.0 / 256.0, occlusion_distance: None }
    }
}

/// A vertex as seen by the one who looks.
struct Seen<'a> {
    surface: &'a Surface,
    phong: &'a Phong,
    /// Unit, towards where the ray came from.
    wo: Vec3,
    /// Unit shading normal on the viewer's side.
    normal: Vec3,
    /// The ray arrived from outside.
    outside: bool,
    time: f32,
}

impl Integrator for Classic {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, emit: &mut Emit) {
        let Some(phong) = world.phong(vertex) else { return self.physical(world, ray, path, vertex, emit) };
        let seen = Seen::new(ray, &vertex.surface, &phong);
        let mut sampler = path.sampler;
        if emit.records() {
            let is_smooth = phong.diffuse.is_black();
            let (normal, albedo) = (seen.normal, phong.diffuse);
            let scatter = if is_smooth { Scatter::Specular } else { Scatter::Diffuse };
            emit.see(&Sight { world, ray, vertex, normal, albedo, is_smooth, scatter });
        }
        self.ambient(world, &seen, sampler, world.shape_group(vertex.object), emit);
        sampler.skip(1);
        for (number, lamp) in world.lamps().iter().enumerate() {
            light(lamp, number, &seen, &sampler, emit);
            sampler.skip(1);
        }
        if path.depth < self.max_depth {
            self.follow(path, &seen, &sampler, emit);
        }
    }

    fn escape(&self, world: &World, ray: &Ray, _path: &PathState, emit: &mut Emit) {
        emit.miss(ray);
        emit.add(world.background(ray), world.background_group());
    }
}

impl<'a> Seen<'a> {
    fn new(ray: &Ray, surface: &'a Surface, phong: &'a Phong) -> Self {
        let wo = -ray.direction;
        let outside = surface.normal.dot(wo) >= 0.0;
        let normal = if outside { surface.shading_normal } else { -surface.shading_normal };
        Self { surface, phong, wo, normal, outside, time: ray.time }
    }
}

impl Classic {
    /// Emission and ambient light. The share that occlusion may take hangs on one ray over the hemisphere,
    /// even over its solid angle.
    fn ambient(&self, world: &World, seen: &Seen, mut sampler: Sampler, group: LightGroup, emit: &mut Emit) {
        let ambient = seen.phong.ambient * world.ambient();
        let Some(distance) = self.occlusion_distance.filter(|_| seen.phong.occlusion > 0.0) else {
            emit.add(seen.phong.emission + ambient, group);
            return;
        };
        emit.add(seen.phong.emission + ambient * (1.0 - seen.phong.occlusion), group);
        let any = warp::uniform_sphere(sampler.next_2d());
        let direction = if any.dot(seen.normal) < 0.0 { -any } else { any };
        let ray = seen.surface.spawn(direction, seen.time).up_to(distance);
        emit.if_visible(ray, ambient * seen.phong.occlusion, LightGroup::REST);
    }

    /// Mirror and transparency.
    fn follow(&self, path: &PathState, seen: &Seen, sampler: &Sampler, emit: &mut Emit) {
        let phong = seen.phong;
        if phong.mirror.is_black() && phong.transparency.is_black() {
            return;
        }
        let mirrored = fresnel::reflect(seen.wo, seen.normal);
        let ratio = if seen.outside { 1.0 / phong.ior } else { phong.ior };
        let refracted = fresnel::refract(seen.wo, seen.normal, ratio);
        let share = if phong.fresnel { fresnel::dielectric(seen.wo.dot(seen.normal).abs(), 1.0 / ratio) } else { 1.0 };
        let (mut mirror, through) = if phong.fresnel {
            (phong.mirror * share, phong.transparency * (1.0 - share))
        } else {
            (phong.mirror, phong.transparency)
        };
        if refracted.is_none() && !phong.fresnel {
            // Total internal reflection: what would have gone through is mirrored too.
            mirror += through;
        }
        let bundle = Bundle { path, seen, min_weight: self.min_weight };
        bundle.emit(mirrored, phong.glossy, mirror, sampler, 0, emit);
        if let Some(refracted) = refracted {
            let mut sampler = *sampler;
            sampler.skip(1);
            bundle.emit(refracted, phong.blurry, through, &sampler, phong.glossy.rays, emit);
        }
    }
}

/// Rays that leave a vertex around one direction.
struct Bundle<'a> {
    path: &'a PathState,
    seen: &'a Seen<'a>,
    min_weight: f32,
}

impl Bundle<'_> {
    fn emit(&self, axis: Vec3, cone: Cone, filter: Rgb, sampler: &Sampler, first_child: u32, emit: &mut Emit) {
        if (self.path.weight * filter).max_channel() < self.min_weight || filter.is_black() {
            return;
        }
        let surface = self.seen.surface;
        let weight = filter / cone.rays as f32;
        for i in 0..cone.rays {
            let direction = if cone.half_angle_radians > 0.0 {
                let u = sampler.part(i, cone.rays).next_2d();
                cone::direction(axis, surface.normal, cone.half_angle_radians, u)
            } else {
                axis
            };
            emit.go_on(surface.spawn(direction, self.seen.time), weight, first_child + i);
        }
    }
}

/// What one light brings, from one or more places on it.
fn light(lamp: &Lamp, number: usize, seen: &Seen, sampler: &Sampler, emit: &mut Emit) {
    let source = lamp.at(seen.time);
    if !seen.phong.both_sides && source.is_below(seen.surface.point, seen.normal) {
        return;
    }
    let Lamp { samples, is_point, is_surface, .. } = lamp;
    // Surfaces are measured in physical units.
    let unit = if *is_surface { 1.0 / seen.phong.lamp_scale() } else { 1.0 };
    let share = unit / *samples as f32;
    for i in 0..*samples {
        let u = if *is_point { Vec2::ZERO } else { sampler.part(i, *samples).next_2d() };
        let Some(sample) = source.light.sample(seen.surface.point, u) else { continue };
        let reflected = local(seen, sample.wi);
        if reflected.is_black() {
            continue;
        }
        let ray = seen.surface.spawn_to(sample.wi, sample.distance, seen.time);
        emit.if_light_visible(number, ray, reflected * sample.radiance * share, lamp.group);
    }
}

/// Diffuse light and highlight for light from `wi`.
fn local(seen: &Seen, wi: Vec3) -> Rgb {
    let phong = seen.phong;
    let facing = seen.normal.dot(wi);
    let cosine = if phong.both_sides { facing.abs() } else { facing };
    if cosine <= 0.0 {
        return Rgb::BLACK;
    }
    let diffuse = phong.diffuse * cosine;
    if phong.specular.is_black() {
        return diffuse;
    }
    let towards = fresnel::reflect(wi, seen.normal).dot(seen.wo);
    if towards <= 0.0 {
        return diffuse;
    }
    let shine = fun::powf(towards, phong.shininess);
    let shine = if phong.highlight == Highlight::PhongCosine { shine * cosine } else { shine };
    diffuse + phong.specular * shine
}

#[cfg(any(test, feature = "testing"))]
impl Classic {
    /// For the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}
