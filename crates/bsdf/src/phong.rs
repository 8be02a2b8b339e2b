//! The classic model at one point, and what comes closest to it of what a path tracer can follow.

use super::{Bsdf, Conductor, Dielectric, Fresnel, Lambert, PhongHighlight, Whitted};
use juggler_math::{Rgb, Vec2, fun};

/// How a highlight is weighted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Highlight {
    /// `(r · v)^n`, as Phong wrote it (1975).
    #[default]
    Phong,
    /// `(r · v)^n (n · l)`: fades towards the terminator, as the Juggler's article does.
    PhongCosine,
}

/// A bundle of rays around a direction, for glossy mirrors and blurry glass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Half of the opening angle; 0 for a single sharp ray.
    pub half_angle_radians: f32,
    /// Rays per sample, at least 1; they share the weight.
    pub rays: u32,
}

impl Cone {
    /// One ray, exactly along the direction.
    pub const SHARP: Self = Self { half_angle_radians: 0.0, rays: 1 };
}

/// The classic model at one point (Phong 1975, Whitted 1980): ambient, diffuse and specular light, a
/// mirror and a transparent share, each filtered by a colour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phong {
    /// Light given off.
    pub emission: Rgb,
    /// Share of the ambient light.
    pub ambient: Rgb,
    /// Share of `ambient` that nearby geometry takes away, 0..=1.
    pub occlusion: f32,
    /// Weight of `n · l`; a factor 1/π, where wanted, is already in it.
    pub diffuse: Rgb,
    /// The albedo over `diffuse`: 1, or π where `diffuse` carries a factor 1/π.
    pub albedo_scale: f32,
    /// Weight of the highlight.
    pub specular: Rgb,
    /// Exponent of the highlight.
    pub shininess: f32,
    /// How the highlight is weighted.
    pub highlight: Highlight,
    /// Lit by `|n · l|` from either side, whoever looks (paper-thin surfaces); otherwise only from the
    /// side that is looked at.
    pub both_sides: bool,
    /// Filter of the mirrored ray; black for none.
    pub mirror: Rgb,
    /// Spread of the mirrored ray.
    pub glossy: Cone,
    /// Filter of the ray that goes through; black for none. Also what a shadow ray keeps.
    pub transparency: Rgb,
    /// Spread of the ray that goes through.
    pub blurry: Cone,
    /// Index of refraction inside over outside; 1 goes straight on.
    pub ior: f32,
    /// Shares light between mirror and transparency by Fresnel's equations.
    pub fresnel: bool,
}

impl Phong {
    /// Takes all light and gives none back.
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
        glossy: Cone::SHARP,
        transparency: Rgb::BLACK,
        blurry: Cone::SHARP,
        ior: 1.0,
        fresnel: false,
    };

    /// Factor on what the scene's lights bring along paths: as much as they bring in classic pictures, where one of
    /// radiance 1 makes a white surface white; 1 where `diffuse` has a factor 1/π.
    pub fn lamp_scale(&self) -> f32 {
        std::f32::consts::PI / self.albedo_scale
    }

    /// Adds the lobes of the same surface for light that is followed path by path: `diffuse` (times `albedo_scale`) is Lambert's albedo,
    /// the highlight a lobe of the same exponent that gives back `specular` head on, mirror and transparency are deltas.
    /// A glossy mirror is a rough one of about the same spread, glossy or blurry glass with `fresnel` rough glass; blurry
    /// windows without are sharp. z is the side of the viewer, who is
    /// `outside` where that is the side of the true normal.
    ///
    /// The classic model may give back more light than there was; then the whole is dimmed so that no channel's albedo
    /// is above 1.
    pub fn add_lobes(&self, outside: bool, bsdf: &mut Bsdf) {
        let albedo = self.diffuse * self.albedo_scale;
        let rays = self.mirror + self.transparency;
        let rays = if self.fresnel { larger(self.mirror, self.transparency) } else { rays };
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
        // Normals turn by half of what mirrored rays do; the mean turn of an even cone is 2/3 of its half angle.
        let alpha = |half_angle: f32| Vec2::splat(fun::tan(half_angle.min(1.5) / 3.0));
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

/// The larger of each channel.
fn larger(a: Rgb, b: Rgb) -> Rgb {
    Rgb::new(a.r.max(b.r), a.g.max(b.g), a.b.max(b.b))
}
