//! Classic recursive ray tracing: local illumination, specular reflection and refraction.
//!
//! Each vertex adds emission, ambient light (attenuated by one ambient occlusion ray) and for each
//! light a shadow ray (Phong 1975), then traces a reflected and a refracted ray (Whitted 1980), or
//! bundles of them.
//!
//! ```json
//! {"classic": {"max_depth": 10, "min_weight": 0.004, "occlusion_distance": 100}}
//! ```

mod crossing;
mod physical;

use super::{Integrator, PathState, SurfaceHit, VertexOutput};
use juggler_bsdf::{ConeSampling, Highlight, PhongParameters, Scatter, cone, fresnel};
use juggler_camera::aov::LightGroup;
use juggler_camera::sampler::Sampler;
use juggler_math::{Ray, Rgb, Vec2, Vec3, portable, warp};
use juggler_shape::surface::Surface;
use juggler_world::{SceneLight, Vertex, World};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Classic recursive ray tracing: Phong illumination from lights, mirrors and glass, without
/// indirect diffuse light. Fast, with little noise.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Classic {
    /// Maximum number of reflections and refractions along a ray, 0 to 1,000. 0 shows local
    /// illumination only; scenes with many mirrors or nested glass need more than the default of
    /// 10.
    #[schemars(range(min = 0, max = 1000))]
    pub max_depth: u32,
    /// Minimum weight of a reflected or refracted ray, in its brightest channel, 0 to 1. Rays below
    /// it are not traced. The default, 1/256, is invisible in 8-bit pictures; larger values are
    /// faster.
    #[schemars(range(min = 0, max = 1))]
    pub min_weight: f32,
    /// Maximum distance of ambient occlusion, in scene units, above 0: objects beyond it occlude
    /// nothing. Without it no material's ambient light is occluded.
    #[schemars(extend("exclusiveMinimum" = 0, "x-unit" = "scene units"))]
    pub occlusion_distance: Option<f32>,
}

impl Default for Classic {
    fn default() -> Self {
        Self { max_depth: 10, min_weight: 1.0 / 256.0, occlusion_distance: None }
    }
}

/// A shading point: a vertex with its Phong material and the direction of view.
struct ShadingPoint<'a> {
    surface: &'a Surface,
    phong: &'a PhongParameters,
    /// Unit vector towards the origin of the ray.
    wo: Vec3,
    /// Unit shading normal on the viewer's side.
    normal: Vec3,
    /// Whether the ray arrived from outside.
    outside: bool,
    /// Surface from which shadow rays leave: see [`World::lifted_surface`].
    scattering: &'a Surface,
    time: f32,
}

/// Material of a vertex.
#[derive(Clone, Copy)]
enum Material<'p> {
    /// The classic one, with its index of refraction relative to the medium outside.
    Phong(&'p PhongParameters),
    /// Any other.
    Physical {
        /// Index of refraction of the medium outside.
        outside_ior: f32,
    },
}

impl<'p> Material<'p> {
    /// Material of a vertex with these classic parameters, if it has any, and this index of
    /// refraction of the medium outside.
    #[inline]
    fn new(phong: Option<&'p PhongParameters>, outside_ior: f32) -> Self {
        phong.map_or(Self::Physical { outside_ior }, Self::Phong)
    }
}

impl Integrator for Classic {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        let phong = world.phong(vertex);
        let may_pass = match phong.as_deref() {
            Some(phong) => world.has_transparency() && !phong.transparency.is_black(),
            None => world.has_transparency() || may_touch(world, ray, vertex),
        };
        if may_pass {
            return self.cross_surfaces(world, ray, path, vertex, output);
        }
        self.interact(world, ray, path, vertex, Material::new(phong.as_deref(), 1.0), output);
    }

    fn escape(&self, world: &World, ray: &Ray, path: &PathState, output: &mut VertexOutput) {
        output.record_miss(ray);
        let backdrop = world.backdrop().filter(|_| path.history.sees_backdrop);
        let radiance = backdrop.unwrap_or_else(|| world.background_radiance(ray));
        output.add(radiance, world.background_group());
    }
}

/// Whether the vertex bounds a physical solid that others may touch, or that opacity may remove.
fn may_touch(world: &World, ray: &Ray, vertex: &Vertex) -> bool {
    world.interior(vertex).is_some() && (world.may_be_open(vertex) || !world.is_alone(ray, vertex))
}

impl<'a> ShadingPoint<'a> {
    fn new(ray: &Ray, [surface, scattering]: [&'a Surface; 2], phong: &'a PhongParameters) -> Self {
        let wo = -ray.direction;
        let outside = surface.normal.dot(wo) >= 0.0;
        let normal = if outside { surface.shading_normal } else { -surface.shading_normal };
        Self { surface, phong, wo, normal, outside, scattering, time: ray.time }
    }
}

impl Classic {
    /// Shades a vertex, by its classic material if it has one, and traces shadow rays and secondary
    /// rays. Returns `false` if opacity lets the ray pass.
    #[inline(always)]
    fn interact(
        &self,
        world: &World,
        ray: &Ray,
        path: &PathState,
        vertex: &Vertex,
        material: Material,
        output: &mut VertexOutput,
    ) -> bool {
        let phong = match material {
            Material::Phong(phong) => phong,
            Material::Physical { outside_ior } => {
                return self.physical(world, ray, path, vertex, outside_ior, output);
            }
        };
        let lifted = if phong.both_sides { None } else { world.lifted_surface(ray, vertex) };
        let surfaces = [&vertex.surface, lifted.as_ref().unwrap_or(&vertex.surface)];
        let point = ShadingPoint::new(ray, surfaces, phong);
        let mut sampler = path.sampler;
        // Record AOVs of the surface.
        if output.is_recording() {
            let is_specular = phong.diffuse.is_black();
            let (normal, albedo) = (point.normal, phong.diffuse);
            let scatter = if is_specular { Scatter::Specular } else { Scatter::Diffuse };
            output.record_hit(&SurfaceHit { world, ray, vertex, normal, albedo, is_specular, scatter });
        }
        // Add emission and ambient light.
        self.ambient(world, &point, sampler, world.shape_group(vertex.shape), output);
        sampler.skip(1);
        // Add direct illumination.
        for (number, light) in world.lights().iter().enumerate() {
            add_light(light, number, &point, &sampler, output);
            sampler.skip(1);
        }
        // Trace reflected and refracted rays.
        if path.depth < self.max_depth {
            self.trace_secondary_rays(path, &point, &sampler, output);
        }
        true
    }

    /// Adds emission and ambient light. One ray, uniform over the hemisphere, decides about the
    /// fraction that is subject to occlusion.
    #[inline(always)]
    fn ambient(
        &self,
        world: &World,
        point: &ShadingPoint,
        mut sampler: Sampler,
        group: LightGroup,
        output: &mut VertexOutput,
    ) {
        let ambient = point.phong.ambient * world.ambient();
        let Some(distance) = self.occlusion_distance.filter(|_| point.phong.occlusion > 0.0) else {
            output.add(point.phong.emission + ambient, group);
            return;
        };
        output.add(point.phong.emission + ambient * (1.0 - point.phong.occlusion), group);
        let any = warp::uniform_sphere(sampler.next_2d());
        let direction = if any.dot(point.normal) < 0.0 { -any } else { any };
        let ray = point.scattering.spawn_ray(direction, point.time).with_t_max(distance);
        output.add_shadow_ray(ray, ambient * point.phong.occlusion, LightGroup::REST);
    }

    /// Traces reflected and refracted rays.
    #[inline(always)]
    fn trace_secondary_rays(
        &self,
        path: &PathState,
        point: &ShadingPoint,
        sampler: &Sampler,
        output: &mut VertexOutput,
    ) {
        let phong = point.phong;
        if phong.mirror.is_black() && phong.transparency.is_black() {
            return;
        }
        // Split the light by Fresnel's equations.
        let reflected = fresnel::reflect(point.wo, point.normal);
        let ratio = if point.outside { 1.0 / phong.ior } else { phong.ior };
        let refracted = fresnel::refract(point.wo, point.normal, ratio);
        let reflectance = if phong.fresnel {
            fresnel::dielectric_reflectance(point.wo.dot(point.normal).abs(), 1.0 / ratio)
        } else {
            1.0
        };
        let (mut reflection, transmission) = if phong.fresnel {
            (phong.mirror * reflectance, phong.transparency * (1.0 - reflectance))
        } else {
            (phong.mirror, phong.transparency)
        };
        if refracted.is_none() && !phong.fresnel {
            // Total internal reflection: the mirror gets the transmitted part as well.
            reflection += transmission;
        }
        let bundle = Bundle { path, point, sees_backdrop: false, min_weight: self.min_weight };
        bundle.trace(reflected, phong.glossy, reflection, sampler, 0, output);
        if let Some(refracted) = refracted {
            let mut sampler = *sampler;
            sampler.skip(1);
            let bundle = Bundle { sees_backdrop: path.history.sees_backdrop, ..bundle };
            bundle.trace(refracted, phong.blurry, transmission, &sampler, phong.glossy.rays, output);
        }
    }
}

/// Rays that leave a vertex around one direction.
struct Bundle<'a> {
    path: &'a PathState,
    point: &'a ShadingPoint<'a>,
    /// Whether the paths along the rays see the backdrop: see [`PathHistory`](crate::PathHistory).
    sees_backdrop: bool,
    min_weight: f32,
}

impl Bundle<'_> {
    fn trace(
        &self,
        axis: Vec3,
        cone: ConeSampling,
        filter: Rgb,
        sampler: &Sampler,
        first_child: u32,
        output: &mut VertexOutput,
    ) {
        if (self.path.beta * filter).max_channel() < self.min_weight || filter.is_black() {
            return;
        }
        let surface = self.point.surface;
        let weight = filter / cone.rays as f32;
        for i in 0..cone.rays {
            let direction = if cone.half_angle_radians > 0.0 {
                let u = sampler.subsequence(i, cone.rays).next_2d();
                cone::direction(axis, surface.normal, cone.half_angle_radians, u)
            } else {
                axis
            };
            let ray = surface.spawn_ray(direction, self.point.time);
            output.trace_branch(ray, weight, self.sees_backdrop, first_child + i);
        }
    }
}

/// Adds a light's contribution, by one or more shadow rays.
#[inline(always)]
fn add_light(light: &SceneLight, number: usize, point: &ShadingPoint, sampler: &Sampler, output: &mut VertexOutput) {
    let state = light.at(point.time);
    if !point.phong.both_sides && state.is_below(point.scattering.point, point.normal) {
        return;
    }
    let SceneLight { samples, is_delta, is_surface, .. } = light;
    // Lights with a surface are in physical units.
    let scale = if *is_surface { 1.0 / point.phong.light_scale() } else { 1.0 };
    for i in 0..*samples {
        let u = if *is_delta { Vec2::ZERO } else { sampler.subsequence(i, *samples).next_2d() };
        let Some(sample) = state.light.sample(point.scattering.point, u) else { continue };
        let reflected = reflected_light(point, sample.wi);
        if reflected.is_black() {
            continue;
        }
        let ray = point.scattering.spawn_ray_to(sample.wi, sample.distance, point.time);
        let weight = sample_weight(scale, *samples, sample.pdf);
        output.add_light_shadow_ray(number, ray, reflected * sample.radiance * weight, light.group);
    }
}

/// Weight of one of several samples of a light, with the density of its direction per steradian;
/// `scale` converts the light's unit.
fn sample_weight(scale: f32, samples: u32, pdf: f32) -> f32 {
    scale / samples as f32 / pdf
}

/// Diffuse and specular reflection of light from `wi`.
fn reflected_light(point: &ShadingPoint, wi: Vec3) -> Rgb {
    let phong = point.phong;
    let cos_theta = point.normal.dot(wi);
    let cosine = if phong.both_sides { cos_theta.abs() } else { cos_theta };
    if cosine <= 0.0 {
        return Rgb::BLACK;
    }
    let diffuse = phong.diffuse * cosine;
    if phong.specular.is_black() {
        return diffuse;
    }
    let cos_alpha = fresnel::reflect(wi, point.normal).dot(point.wo);
    if cos_alpha <= 0.0 {
        return diffuse;
    }
    let highlight = portable::powf(cos_alpha, phong.shininess);
    let highlight = if phong.highlight == Highlight::PhongCosine { highlight * cosine } else { highlight };
    diffuse + phong.specular * highlight
}

#[cfg(any(test, feature = "testing"))]
impl Classic {
    /// Example values for the contract tests.
    pub fn examples() -> Vec<Self> {
        vec![Self::default()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All lights have a density of 1, which must not change a bit.
    #[test]
    fn light_samples_are_divided_by_their_density() {
        for (scale, samples) in [(1.0, 1), (0.37, 3), (1.0 / std::f32::consts::PI, 16)] {
            let share = scale / samples as f32;
            assert_eq!(sample_weight(scale, samples, 1.0).to_bits(), share.to_bits());
            assert_eq!(sample_weight(scale, samples, 4.0), share / 4.0);
        }
    }
}
