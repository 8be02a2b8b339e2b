//! Path tracing: unbiased global illumination (Kajiya, The Rendering Equation, 1986).
//!
//! Each vertex samples one light (next-event estimation) and one direction of the BSDF. Light
//! samples and BSDF samples are combined by multiple importance sampling with the power heuristic
//! (Veach 1997, section 9.2.2).
//!
//! ```json
//! {"path": {"max_depth": 16, "roulette_depth": 4}}
//! ```

use super::{Clamp, Integrator, PathHistory, PathState, VertexOutput};
use caustic::HitEmitter;
use crossing::Interface;
pub use crossing::passed;
use juggler_material::Shading;
use juggler_material::medium::{InteriorId, Wavelength};
use juggler_math::{Ray, Rgb};
use juggler_world::{LightSampleContext, ShadowMode, Vertex, VisibleCasters, World};
pub use sampling::Sampling;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use surface::ShadingPoint;

mod caustic;
mod crossing;
mod sampling;
mod surface;
mod volume;

/// Sampler dimensions of a path vertex. Each value belongs to one decision: two variants of an enum
/// cannot share a value.
#[derive(Clone, Copy, Debug)]
enum Dimension {
    /// Choice among several materials, and whether the surface is transparent at this point.
    Choice = 0,
    /// Choice of a light and of a point on it.
    Light = 1,
    /// Direction of the next path segment.
    Scatter = 2,
    /// Russian roulette.
    Roulette = 3,
    /// Distance to the next scattering event in a medium.
    Flight = 4,
    /// Whether a microfacet of rough glass reflects or refracts.
    Facet = 5,
    /// Choice of a specular sphere for light sampling.
    CausticCaster = 6,
    /// Choice of a light, and of a point on it, as seen from the specular sphere.
    CausticLight = 7,
    /// Wavelength of the path at its first dispersive surface.
    Wavelength = 8,
    /// Direction in which light leaves a solid that holds it by total reflection.
    Exit = 9,
}

/// Default number of light samples at the first vertex, if the world has several emitters.
const DEFAULT_LIGHT_SAMPLES: u32 = 2;

/// Path tracing: unbiased global illumination with soft shadows, interreflections, caustics and
/// media.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
#[schemars(rename = "PathIntegrator")]
pub struct Path {
    /// Maximum number of path segments between camera and light, 1 to 10,000. 1 shows only
    /// emitters, 2 adds direct lighting, larger values add indirect bounces. Scenes with much glass
    /// need many; the default is 64.
    #[schemars(range(min = 1, max = 10_000))]
    pub max_depth: u32,
    /// Maximum number of diffuse scattering events on a path, 0 to 10,000. Unlimited by default; 1
    /// removes diffuse interreflection.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_diffuse: Option<u32>,
    /// Maximum number of glossy scattering events on a path, by rough metal or rough glass, 0 to
    /// 10,000. Unlimited by default; a low limit removes noise from repeated glossy reflection.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_glossy: Option<u32>,
    /// Maximum number of specular reflections and refractions on a path, 0 to 10,000. Unlimited by
    /// default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_specular: Option<u32>,
    /// Maximum number of scattering events in media, 0 to 10,000. Unlimited by default; dense,
    /// bright media need many.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(max = 10_000))]
    pub max_volume: Option<u32>,
    /// Segment from which Russian roulette may terminate paths of low throughput, 1 to 10,000. The
    /// result stays unbiased: smaller values save time and add noise. The default is 4; `null`
    /// disables it.
    #[schemars(range(min = 1, max = 10_000))]
    pub roulette_depth: Option<u32>,
    /// Number of light samples at the first vertex that is not specular, where most of the noise
    /// arises; 1 to 64. By default 2 if the scene has several emitters, else 1. More samples reduce
    /// the noise of direct lighting.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 64), extend("x-unit" = "samples"))]
    pub light_samples: Option<u32>,
    /// Number of camera rays of each sample, 1 to 8. All of them add the light that they see
    /// directly, from emitters and the background, and the first continues as the path of the
    /// sample. More of them smooth the edges of visible emitters for little time. By default 1, 2, 4
    /// or 8, by the noise of a small picture, and 1 if the picture is transparent or smaller than
    /// 320 × 180 pixels.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 8))]
    pub camera_rays: Option<u32>,
    /// Strategy for emitters that a ray can hit. `mis` combines light samples and BSDF samples and
    /// has the least noise; `light` and `bsdf` use one of them alone, for comparisons.
    #[serde(skip_serializing_if = "Sampling::is_default")]
    pub sampling: Sampling,
    /// Maximum contribution of emission and direct lighting, paths of one or two segments, to a
    /// sample: the limit of the brightest color channel, in units of radiance. Hue is preserved.
    /// Unlimited by default. Clamping darkens the picture; the render reports by how much.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 1e30), extend("x-unit" = "W/(scene unit² sr)"))]
    pub clamp_direct: Option<f32>,
    /// Maximum contribution of indirect lighting, paths of three or more segments, as for
    /// `clamp_direct`. Use it against fireflies that more samples do not remove. Unlimited by
    /// default.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1e-6, max = 1e30), extend("x-unit" = "W/(scene unit² sr)"))]
    pub clamp_indirect: Option<f32>,
}

impl Path {
    /// Direct lighting only: emission and one bounce from lights.
    pub(super) const DIRECT: Self = Self {
        max_depth: 2,
        max_diffuse: None,
        max_glossy: None,
        max_specular: None,
        max_volume: None,
        roulette_depth: None,
        light_samples: None,
        camera_rays: Some(1),
        sampling: Sampling::Mis,
        clamp_direct: None,
        clamp_indirect: None,
    };

    /// Number of light samples at a vertex.
    fn light_sample_count(&self, world: &World, path: &PathState) -> u16 {
        let first = || self.light_samples.unwrap_or(if world.has_many_emitters() { DEFAULT_LIGHT_SAMPLES } else { 1 });
        if path.history.events.is_only_specular() { first().clamp(1, 64) as u16 } else { 1 }
    }

    /// State of the path with a wavelength, if the path has none and hits the interface of a
    /// dispersive solid. The color of the wavelength scales all that the path finds from here on.
    #[inline(never)]
    fn disperse(
        &self,
        world: &World,
        path: &PathState,
        interior: Option<InteriorId>,
        output: &mut VertexOutput,
    ) -> Option<PathState> {
        if path.history.wavelength.is_some() {
            return None;
        }
        interior.and_then(|id| world.interior_at(id)).filter(|interior| interior.dispersion > 0.0)?;
        let u = path.sampler.skipped(Dimension::Wavelength as u32).next_1d();
        let (wavelength, weight) = Wavelength::sample(u);
        output.scale(weight);
        Some(PathState { history: PathHistory { wavelength: Some(wavelength), ..path.history }, ..*path })
    }

    /// Applies Russian roulette: the survival probability of a path of this throughput, `None` if
    /// the path ends.
    fn roulette_survival(&self, path: &PathState, throughput: Rgb) -> Option<f32> {
        if self.roulette_depth.is_none_or(|depth| path.depth + 1 < depth) {
            return Some(1.0);
        }
        // Throughput may be negative, because filter weights may be.
        let probability = throughput.map(f32::abs).max_channel().min(1.0);
        (path.sampler.skipped(Dimension::Roulette as u32).next_1d() < probability).then_some(probability)
    }
}

impl Default for Path {
    fn default() -> Self {
        Self { max_depth: 64, roulette_depth: Some(4), camera_rays: None, ..Self::DIRECT }
    }
}

impl Path {
    /// Shades a vertex, adds emission and direct illumination and continues the path. Returns the
    /// history of the path if the surface is absent for it, so that the path passes straight through.
    #[inline(always)]
    fn interact(
        &self,
        world: &World,
        ray: &Ray,
        path: &PathState,
        vertex: &Vertex,
        interface: &Interface,
        output: &mut VertexOutput,
    ) -> Option<PathHistory> {
        // Choose a wavelength at the first dispersive surface.
        let dispersed =
            if world.has_dispersion() { self.disperse(world, path, interface.interior, output) } else { None };
        let path = dispersed.as_ref().unwrap_or(path);
        // Evaluate the material.
        let mut shading = Shading::black();
        let u_opacity = surface::shade_into(world, ray, path, vertex, interface, &mut shading);
        // Pass through by opacity. Unlit surfaces exist only for camera rays and their specular
        // continuations.
        let is_absent = shading.opacity < 1.0 && u_opacity >= shading.opacity;
        if !interface.is_present && is_absent || shading.is_unlit && !path.history.events.is_only_specular() {
            return Some(path.history);
        }
        // Record AOVs of the surface.
        output.record_shading(world, ray, vertex, &shading);
        if shading.is_unlit {
            output.add(shading.emission, world.shape_group(vertex.shape));
            return None;
        }
        // Add emission, weighted against light sampling.
        if !shading.emission.is_black() {
            self.add_emission(world, ray, path, vertex, &shading, output);
        }
        if path.history.is_split || path.depth + 1 >= self.max_depth {
            return None;
        }
        // Remove lobes whose limit is reached.
        self.limit_lobes(&mut shading.bsdf, path);
        let mut visible_casters = VisibleCasters::empty();
        let is_specular = shading.bsdf.is_specular();
        let is_lifted = !shading.transmissive && !is_specular;
        let lifted = if is_lifted { world.lifted_surface(ray, vertex) } else { None };
        let surfaces = [&vertex.surface, lifted.as_ref().unwrap_or(&vertex.surface)];
        let wo = shading.frame.to_local(-ray.direction);
        let lobe_numbers = shading.bsdf.lobe_numbers(wo);
        let bsdf = shading.bsdf.view(wo, lobe_numbers.as_ref());
        let mut point = ShadingPoint::new(ray, surfaces, &shading, bsdf, interface);
        // Sample direct illumination, also through specular spheres.
        if !is_specular {
            point.find_visible_casters(world, &mut visible_casters);
            point.sample_lights(self.light_sample_count(world, path), self.sampling, world, path, output);
            self.sample_caustics(&point, world, path, output);
        }
        // Sample the BSDF and continue the path.
        self.continue_path(&point, world, vertex.shape, path, output);
        None
    }

    /// Adds the emission of a surface, weighted against light sampling.
    #[inline(always)]
    fn add_emission(
        &self,
        world: &World,
        ray: &Ray,
        path: &PathState,
        vertex: &Vertex,
        shading: &Shading,
        output: &mut VertexOutput,
    ) {
        let light = || world.light_pdf(&path.history.light_sample_context(ray.time), vertex);
        let bent = |context: &LightSampleContext, center_ray: &Ray| {
            world.light_pdf(context, vertex) * caustic::emitter_cosine_ratio(center_ray, ray, vertex)
        };
        let end = HitEmitter::Surface(vertex.surface.point);
        let weight = self.emission_weight(world, path, ray, light, end, bent);
        output.add(shading.emission * weight, world.shape_group(vertex.shape));
    }
}

impl Integrator for Path {
    fn vertex(&self, world: &World, ray: &Ray, path: &PathState, vertex: &Vertex, output: &mut VertexOutput) {
        // Sample a collision in the medium before the surface.
        if self.sample_medium(world, ray, ray.t_max - ray.t_min, path, output) {
            return;
        }
        // Follow the path through all surfaces at this place, if there may be several.
        let is_opaque = !world.may_pass_along(ray, vertex) && !world.is_sheet(vertex);
        let interface = if is_opaque && path.history.interiors.is_empty() {
            Interface::OPAQUE
        } else if let Some(interface) = Interface::alone(world, ray, path, vertex) {
            interface
        } else {
            return self.cross_surfaces(world, ray, path, vertex, output);
        };
        self.interact(world, ray, path, vertex, &interface, output);
    }

    fn escape(&self, world: &World, ray: &Ray, path: &PathState, output: &mut VertexOutput) {
        if !self.sample_medium(world, ray, f32::INFINITY, path, output) {
            output.record_miss(ray);
            // Light sampling neither generates camera rays nor samples the backdrop: the weight is 1.
            let backdrop = world.backdrop().filter(|_| path.history.sees_backdrop);
            if backdrop.is_some() || path.history.events.is_none() {
                let radiance = backdrop.unwrap_or_else(|| world.background_radiance(ray));
                return output.add(radiance, world.background_group());
            }
            let light = || world.background_pdf(ray.direction);
            let weight = self.emission_weight(world, path, ray, light, HitEmitter::Background, |_, _| light());
            output.add(world.background_radiance(ray) * weight, world.background_group());
        }
    }

    fn camera_rays(&self) -> Option<u32> {
        self.camera_rays
    }

    fn filters_textures(&self) -> bool {
        true
    }

    fn shadows(&self) -> ShadowMode {
        ShadowMode::Physical
    }

    fn clamp(&self) -> Option<Clamp> {
        let [direct, indirect] = [self.clamp_direct, self.clamp_indirect].map(|limit| limit.unwrap_or(f32::INFINITY));
        (direct < f32::INFINITY || indirect < f32::INFINITY).then_some(Clamp { direct, indirect })
    }
}

#[cfg(any(test, feature = "testing"))]
impl Path {
    /// Example values for the contract tests.
    pub fn examples() -> Vec<Self> {
        let clamped = Self { clamp_direct: Some(4.0), clamp_indirect: Some(0.5), ..Self::default() };
        vec![Self::default(), Self { max_depth: 3, max_diffuse: Some(1), ..Self::DIRECT }, clamped]
    }
}
