//! Value noise on a lattice (Perlin 1985; Ebert et al., Texturing and Modeling, chapter 2).

use juggler_math::{Vec3, hash};

/// Smooth noise in [-1, 1] with features of size 1.
pub fn noise(p: Vec3, seed: u32) -> f32 {
    let cell = p.floor();
    let [x, y, z] = (p - cell).to_array().map(|t| t * t * (3.0 - 2.0 * t));
    let value = |dx: f32, dy: f32, dz: f32| {
        let [i, j, k] = (cell + Vec3::new(dx, dy, dz)).to_array().map(|c| (c as i32).cast_unsigned());
        hash::unit_f32(hash::combine(hash::combine(hash::combine(seed, i), j), k)) * 2.0 - 1.0
    };
    let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
    let row = |dy: f32, dz: f32| mix(value(0.0, dy, dz), value(1.0, dy, dz), x);
    mix(mix(row(0.0, 0.0), row(1.0, 0.0), y), mix(row(0.0, 1.0), row(1.0, 1.0), y), z)
}

/// Fractal noise: a sum of `octaves`, each with half the feature size and half the amplitude of the
/// one before.
pub fn fractal(p: Vec3, octaves: u32, seed: u32) -> f32 {
    let mut scale = 1.0;
    let octave = |i: u32| {
        let sum = noise(p / scale, seed.wrapping_add(i)) * scale;
        scale *= 0.5;
        sum
    };
    (0..octaves).map(octave).sum()
}
