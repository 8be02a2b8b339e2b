//! Classic shading model of Phong and Whitted at one point, and lobes that approximate it in a path
//! tracer.

use super::{Bsdf, Conductor, Dielectric, Fresnel, Lambert, PhongHighlight, Whitted};
use juggler_math::{Rgb, Vec2, portable};

/// Angular falloff of the highlight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Highlight {
    /// `(r · v)^shininess` (Phong 1975), with `r` the mirror direction of the light and `v` the
    /// direction to the viewer.
    #[default]
    Phong,
    /// `(r · v)^shininess (n · l)`, with `n` the shading normal and `l` the direction to the light:
    /// also scaled by the cosine of the incident light, so the highlight fades towards the
    /// terminator, as in the article about the Juggler.
    PhongCosine,
}

/// Directions sampled in a cone around an axis, for glossy reflection and blurry transmission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConeSampling {
    /// Half of the opening angle, in radians; 0 for a single sharp ray.
    pub half_angle_radians: f32,
    /// Rays per sample, at least 1; they share the weight.
    pub rays: u32,
}

impl ConeSampling {
    /// One ray exactly along the direction.
    pub const SHARP: Self = Self { half_angle_radians: 0.0, rays: 1 };
}

/// Classic shading at one point (Phong 1975, Whitted 1980): ambient, diffuse and specular
/// reflection of lights, a reflected and a transmitted ray, each filtered by a color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhongParameters {
    /// Emitted radiance.
    pub emission: Rgb,
    /// Factor on the ambient light.
    pub ambient: Rgb,
    /// Fraction of the ambient light that nearby geometry occludes, 0 to 1.
    pub occlusion: f32,
    /// Weight of `n · l`, the cosine of the incident light; includes the factor 1/π, if any.
    pub diffuse: Rgb,
    /// Albedo over `diffuse`: 1, or π where `diffuse` includes a factor 1/π.
    pub albedo_scale: f32,
    /// Weight of the highlight.
    pub specular: Rgb,
    /// Exponent of the highlight.
    pub shininess: f32,
    /// Angular falloff of the highlight.
    pub highlight: Highlight,
    /// Whether lights on either side count, by `|n · l|` (paper-thin surfaces); otherwise only
    /// lights on the viewer's side do.
    pub both_sides: bool,
    /// Filter of the reflected ray; black for none.
    pub mirror: Rgb,
    /// Cone of the reflected ray.
    pub glossy: ConeSampling,
    /// Filter of the transmitted ray and of shadow rays; black for none.
    pub transparency: Rgb,
    /// Cone of the transmitted ray.
    pub blurry: ConeSampling,
    /// Index of refraction inside over outside; 1 transmits in a straight line.
    pub ior: f32,
    /// Whether Fresnel's equations divide light between reflection and transmission.
    pub fresnel: bool,
}

impl PhongParameters {
    /// Parameters of a surface that absorbs all light.
    pub const BLACK: Self = Self {
        emission: Rgb::BLACK,
        ambient: Rgb::BLACK,
        occlusion: 0.0,
        diffuse: Rgb::BLACK,
        albedo_scale: 1.0,
        specular: Rgb::BLACK,
        shininess: 1.0,
        highlight: Highlight::Phong,
        both_sides: false,
        mirror: Rgb::BLACK,
        glossy: ConeSampling::SHARP,
        transparency: Rgb::BLACK,
        blurry: ConeSampling::SHARP,
        ior: 1.0,
        fresnel: false,
    };

    /// Factor on the scene's lights in a path tracer: π, or 1 where `diffuse` includes a factor
    /// 1/π. It matches the classic model, where a light of radiance 1 makes a white surface white.
    pub fn light_scale(&self) -> f32 {
        std::f32::consts::PI / self.albedo_scale
    }

    /// Adds lobes that approximate the model in a path tracer. The z axis of the BSDF points to the
    /// viewer's side; `outside` is whether that is the side of the geometric normal. `diffuse`
    /// times `albedo_scale` is the albedo of a Lambertian lobe, `specular` the albedo at normal
    /// incidence of a highlight of the same exponent; sharp reflection and transmission become
    /// specular lobes. Glossy reflection becomes a rough conductor of about the same spread, glossy
    /// or blurry glass with `fresnel` a rough dielectric; blurry transmission without `fresnel` is
    /// approximated by sharp transmission.
    ///
    /// The classic model may reflect more light than arrives; then all lobes are scaled so that no
    /// channel's albedo exceeds 1.
    pub fn add_lobes(&self, outside: bool, bsdf: &mut Bsdf) {
        let albedo = self.diffuse * self.albedo_scale;
        let rays = self.mirror + self.transparency;
        let rays = if self.fresnel { channel_max(self.mirror, self.transparency) } else { rays };
        let weight = 1.0 / (albedo + self.specular + rays).max_channel().max(1.0);
        let spread = self.glossy.half_angle_radians.max(self.blurry.half_angle_radians);
        let mut whitted = Whitted {
            mirror: self.mirror,
            transparency: self.transparency,
            ior: if outside { self.ior } else { 1.0 / self.ior },
            fresnel: self.fresnel,
        };
        if !albedo.is_black() {
            bsdf.push_scaled(Lambert { albedo }, weight);
        }
        if !self.specular.is_black() {
            let exponent = self.shininess.clamp(0.0, 1e5);
            bsdf.push_scaled(PhongHighlight { specular: self.specular, exponent }, weight);
        }
        // A normal tilts by half the angle of a reflected ray; the mean angle of a uniform cone is
        // 2/3 of its half angle.
        let alpha = |half_angle: f32| Vec2::splat(portable::tan(half_angle.min(1.5) / 3.0));
        if spread > 0.0 && self.fresnel {
            let glass = Dielectric::new(whitted.ior, alpha(spread)).tinted(self.mirror, self.transparency);
            bsdf.push_scaled(glass, weight);
            return;
        }
        if self.glossy.half_angle_radians > 0.0 && !self.mirror.is_black() {
            let fresnel = Fresnel::Schlick { f0: self.mirror, f90: self.mirror };
            bsdf.push_scaled(Conductor::new(fresnel, alpha(self.glossy.half_angle_radians)), weight);
            whitted.mirror = Rgb::BLACK;
        }
        if !(whitted.mirror.is_black() && whitted.transparency.is_black()) {
            bsdf.push_scaled(whitted, weight);
        }
    }
}

/// Maximum of each channel.
fn channel_max(a: Rgb, b: Rgb) -> Rgb {
    Rgb::new(a.r.max(b.r), a.g.max(b.g), a.b.max(b.b))
}
