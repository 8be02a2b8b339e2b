//! Meshes for the contract tests.

use super::*;
use juggler_math::portable;

impl Mesh {
    /// Examples for the contract tests: smooth spheres of several sizes, a twisted open band.
    pub fn examples() -> Vec<Self> {
        vec![
            globe(24, 12, 1.0, Vec3::ZERO),
            globe(8, 6, 3.0, Vec3::new(20.0, -7.0, 5.0)),
            globe(10, 5, 1e-4, Vec3::ZERO),
            globe(10, 5, 1e6, Vec3::new(1e6, 0.0, 0.0)),
            band(),
        ]
    }
}

/// Closed sphere with smooth normals and uvs. Its poles are degenerate on purpose: each has
/// triangles without area.
pub fn globe(around: u32, rings: u32, radius: f32, center: Vec3) -> Mesh {
    let mut data = MeshData::default();
    for ring in 0..=rings {
        for step in 0..=around {
            let (u, v) = (step as f32 / around as f32, ring as f32 / rings as f32);
            let (sin, cos) = portable::sin_cos_turns(u % 1.0);
            let (across, y) = if ring % rings == 0 { (0.0, 1.0) } else { portable::sin_cos_turns(0.5 * v) };
            let y = if ring == rings { -1.0 } else { y };
            let normal = Vec3::new(across * cos, y, -across * sin);
            data.positions.push(center + normal * radius);
            data.normals.push(normal * 3.0);
            data.uvs.push(Vec2::new(u, 1.0 - v));
        }
    }
    for (ring, step) in (0..rings).flat_map(|ring| (0..around).map(move |step| (ring, step))) {
        let a = ring * (around + 1) + step;
        let below = a + around + 1;
        data.triangles.extend([[a, below, below + 1], [a, below + 1, a + 1]]);
    }
    data.into()
}

/// A Möbius band of thin triangles: open, one-sided, not convex.
fn band() -> Mesh {
    let steps = 60;
    let mut data = MeshData::default();
    for step in 0..=steps {
        let turns = step as f32 / steps as f32;
        let ((sin, cos), (up, out)) = (portable::sin_cos_turns(turns), portable::sin_cos_turns(0.5 * turns));
        for side in [-0.4, 0.4] {
            data.positions.push(Vec3::new(cos, 0.0, sin) * (1.0 + side * out) + Vec3::Y * (side * up));
        }
    }
    data.triangles = (0..2 * steps).map(|i| [i, i + 1, i + 2]).collect();
    data.into()
}
