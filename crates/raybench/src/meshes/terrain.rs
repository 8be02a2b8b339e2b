//! Ridged mountains up to the horizon: a hierarchy far larger than any cache.

use super::builder::Builder;
use super::noise::noise;
use super::{Mesh, MeshKind, View};
use juggler_math::{Vec3, vec3};

pub const KIND: MeshKind = MeshKind {
    name: "terrain",
    about: "mountains, a tree far beyond the cache; size: cells along an edge, two triangles each",
    size: 2236,
    sizes: (1, 8192),
    make,
};

const HALF: f32 = 100.0;

fn make(size: u32) -> Mesh {
    let mut builder = Builder::default();
    let at = |i: u32| (i as f32 / size as f32 * 2.0 - 1.0) * HALF;
    builder.patch(size, size, |column, row| vec3(at(column), height(at(column), at(row)), at(row)));
    builder.finish(View {
        eye: vec3(-12.0, 62.0, 88.0),
        look_at: vec3(4.0, 10.0, 10.0),
        up: Vec3::Y,
        fov_degrees: 45.0,
        light: vec3(-130.0, 75.0, 20.0),
    })
}

/// Ridged multifractal height: ridges at the zeros of the noise, each octave weighted by the one
/// before (Musgrave, in Ebert et al., Texturing and Modeling, section 16.2).
fn height(x: f32, z: f32) -> f32 {
    let (mut sum, mut weight, mut scale) = (0.0, 1.0, 48.0);
    for octave in 0..9 {
        let ridge = 1.0 - noise(vec3(x / scale, 0.5, z / scale), 40 + octave).abs();
        let signal = ridge * ridge * weight;
        sum += signal * scale * 0.45;
        weight = (signal * 1.6).clamp(0.0, 1.0);
        scale *= 0.48;
    }
    sum
}
