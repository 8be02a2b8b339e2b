//! The classic model at one point: numbers, no names and no textures.

use juggler_math::Rgb;

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
}
