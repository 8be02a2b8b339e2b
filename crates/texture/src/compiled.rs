//! Textures as shading asks them: names are numbers, and nothing is left to be worked out twice.

use super::{Lookup, Slot, TextureTable};
use super::{
    brick, checker, dots, fbm, gradient, image, marble, mix, noise, ramp, triplanar, turbulence, uv, voronoi, wave,
    wood,
};
use juggler_math::Rgb;

/// What a description becomes.
#[derive(Clone, Debug)]
#[allow(missing_docs, reason = "the kind's own documentation says it")]
pub enum Compiled {
    Image(image::CompiledImage),
    Constant(Slot<Rgb>),
    Checker(checker::CompiledChecker),
    Gradient(gradient::CompiledGradient),
    Ramp(ramp::CompiledRamp),
    Mix(mix::CompiledMix),
    Noise(noise::CompiledNoise),
    Fbm(fbm::CompiledFbm),
    Turbulence(turbulence::CompiledTurbulence),
    Marble(marble::CompiledMarble),
    Wood(wood::CompiledWood),
    Voronoi(voronoi::CompiledVoronoi),
    Brick(brick::CompiledBrick),
    Dots(dots::CompiledDots),
    Wave(wave::CompiledWave),
    Triplanar(triplanar::CompiledTriplanar),
    Uv(uv::CompiledUv),
}

impl Compiled {
    /// What stands for a texture that is wrong.
    pub const BLACK: Self = Self::Constant(Slot::Value(Rgb::BLACK));

    /// The colour at a point, linear light; finite. `textures` is the table that it belongs to.
    pub fn eval(&self, textures: &TextureTable, at: &Lookup) -> Rgb {
        match self {
            Self::Image(kind) => kind.eval(at),
            Self::Constant(color) => textures.color(color, at),
            Self::Checker(kind) => kind.eval(textures, at),
            Self::Gradient(kind) => kind.eval(textures, at),
            Self::Ramp(kind) => kind.eval(textures, at),
            Self::Mix(kind) => kind.eval(textures, at),
            Self::Noise(kind) => kind.eval(textures, at),
            Self::Fbm(kind) => kind.eval(textures, at),
            Self::Turbulence(kind) => kind.eval(textures, at),
            Self::Marble(kind) => kind.eval(textures, at),
            Self::Wood(kind) => kind.eval(textures, at),
            Self::Voronoi(kind) => kind.eval(textures, at),
            Self::Brick(kind) => kind.eval(textures, at),
            Self::Dots(kind) => kind.eval(textures, at),
            Self::Wave(kind) => kind.eval(textures, at),
            Self::Triplanar(kind) => kind.eval(textures, at),
            Self::Uv(kind) => kind.eval(at),
        }
    }
}

/// Two colours, looked up only as far as they are needed.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// At 0.
    pub low: Slot<Rgb>,
    /// At 1.
    pub high: Slot<Rgb>,
}

impl Pair {
    /// The colour at a share from 0 to 1.
    pub fn at(&self, share: f32, textures: &TextureTable, at: &Lookup) -> Rgb {
        if share <= 0.0 {
            textures.color(&self.low, at)
        } else if share >= 1.0 {
            textures.color(&self.high, at)
        } else {
            textures.color(&self.low, at).lerp(textures.color(&self.high, at), share)
        }
    }
}
