//! A bumpy organic body on the ground under an open sky: medium triangles of similar size, as many
//! as the scans in ray tracing benchmarks.

use super::builder::Builder;
use super::noise::fractal;
use super::{Mesh, MeshKind, View};
use juggler_math::{Vec3, portable, vec3};

pub const KIND: MeshKind = MeshKind {
    name: "blob",
    about: "a bumpy body on the ground; size: quads along a twelfth of its skin's edge",
    size: 76,
    sizes: (1, 4096),
    make,
};

/// Bulges of the body: direction, height, sharpness.
const BULGES: [(Vec3, f32, f32); 5] = [
    (Vec3::new(0.35, 0.85, 0.4), 0.75, 14.0),
    (Vec3::new(0.1, 1.0, -0.15), 0.9, 60.0),
    (Vec3::new(0.5, 1.0, -0.2), 0.8, 60.0),
    (Vec3::new(-0.9, 0.1, -0.3), 0.35, 25.0),
    (Vec3::new(0.5, -0.45, 0.8), 0.4, 12.0),
];

fn make(size: u32) -> Mesh {
    let mut builder = Builder::default();
    builder.cube_sphere(Vec3::ZERO, size, radius);
    let (far, ground) = (12.0, -1.05);
    let corner = |x: f32, z: f32| vec3(x * far, ground, z * far);
    builder.quad([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)]);
    builder.finish(View {
        eye: vec3(1.9, 1.7, 5.4),
        look_at: vec3(0.15, 0.55, 0.0),
        up: Vec3::Y,
        fov_degrees: 38.0,
        light: vec3(-3.0, 6.0, 4.0),
    })
}

fn radius(direction: Vec3) -> f32 {
    let bulge = |(towards, height, sharpness): (Vec3, f32, f32)| {
        height * portable::exp(sharpness * (direction.dot(towards.normalize()) - 1.0))
    };
    let bulges: f32 = BULGES.into_iter().map(bulge).sum();
    1.0 + bulges + 0.12 * fractal(direction * 2.5, 3, 11) + 0.02 * fractal(direction * 18.0, 2, 12)
}
