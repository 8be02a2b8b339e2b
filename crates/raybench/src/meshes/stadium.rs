//! A tiny, fine object in a huge, coarse bowl ("teapot in a stadium"): the hierarchy must bridge
//! both scales.

use super::builder::Builder;
use super::{Mesh, MeshKind, View};
use juggler_math::{Vec3, portable, vec3};

pub const KIND: MeshKind = MeshKind {
    name: "stadium",
    about: "a tiny, fine coil in a huge, coarse bowl; size: sides of the coil's wire",
    size: 32,
    sizes: (3, 512),
    make,
};

/// Number of rings of the wire per side of its cross section.
const RINGS: u32 = 68;
/// Tiers of seats, and sectors around the bowl.
const TIERS: u32 = 18;
const SECTORS: u32 = 96;

fn make(size: u32) -> Mesh {
    let mut builder = Builder::default();
    let rings = size * RINGS;
    let coil: Vec<Vec3> = (0..=rings).map(|i| coil(i as f32 / rings as f32)).collect();
    builder.tube(&coil, size, |_| 0.012);
    builder.patch(SECTORS, 2 * TIERS, |sector, edge| {
        let (sin, cos) = portable::sin_cos_turns((sector % SECTORS) as f32 / SECTORS as f32);
        // Edges alternate: one goes up, the next one outward.
        let (out, up) = (edge.div_ceil(2) as f32, (edge / 2) as f32);
        let radius = 65.0 + 5.5 * out;
        vec3(cos * radius * 1.15, 2.6 * up, sin * radius * 0.9)
    });
    let corner = |x: f32, z: f32| vec3(x * 200.0, -0.001, z * 200.0);
    builder.quad([corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)]);
    builder.finish(View {
        eye: vec3(0.45, 0.36, 1.0),
        look_at: vec3(0.0, 0.24, 0.0),
        up: Vec3::Y,
        fov_degrees: 42.0,
        light: vec3(12.0, 60.0, 25.0),
    })
}

/// A wire wound forty times around a ring, half a unit wide.
fn coil(along: f32) -> Vec3 {
    let (around, winding) = (portable::sin_cos_turns(along), portable::sin_cos_turns(along * 40.0));
    let radius = 0.22 + 0.07 * winding.1;
    vec3(radius * around.1, 0.2 + 0.07 * winding.0 + 0.08 * portable::sin_cos_turns(along * 3.0).0, radius * around.0)
}
