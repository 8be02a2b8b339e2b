//! A ball of curls: long thin triangles with heavily overlapping boxes.

use super::builder::{Builder, Random};
use super::{Mesh, MeshKind, View};
use juggler_math::{Vec3, vec3};

pub const KIND: MeshKind = MeshKind {
    name: "hairball",
    about: "long thin triangles whose boxes overlap; size: strands of 90 triangles",
    size: 32_000,
    sizes: (1, 1_000_000),
    make,
};

const PIECES: usize = 15;

fn make(size: u32) -> Mesh {
    let mut builder = Builder::default();
    for strand in 0..size {
        let line = strand_points(&mut Random::new(0x5_7a4d ^ strand));
        builder.tube(&line, 3, |i| 0.002 * (1.0 - i as f32 / (PIECES as f32 * 1.2)));
    }
    builder.finish(View {
        eye: vec3(0.0, 0.8, 5.6),
        look_at: Vec3::ZERO,
        up: Vec3::Y,
        fov_degrees: 30.0,
        light: vec3(3.0, 5.0, 4.0),
    })
}

/// Random walk outward from the core, deflected by a constant pull per strand.
fn strand_points(random: &mut Random) -> [Vec3; PIECES + 1] {
    let mut point = random.cube().normalize_or(Vec3::Y) * 0.25;
    let mut step = point.normalize() * 0.07;
    let pull = random.cube() * 0.006;
    std::array::from_fn(|_| {
        let here = point;
        step += pull + random.cube() * 0.012;
        point += step;
        here
    })
}
