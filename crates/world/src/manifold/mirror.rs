//! Specular reflection by a sphere (Alhazen's problem).

use super::{Connection, Plane, cos_from_sin};
use juggler_math::portable;

/// Maximum number of Newton iterations, which converge quadratically.
const STEPS: usize = 16;

/// Solves sin(2φ - Φ) - k₂ sin φ + k₁ sin(Φ - φ) = 0 for the angle φ between the first end point
/// and the point of reflection, where the angles of incidence and reflection are equal. The left
/// side crosses 0 once, increasing. Returns `None` if the point is invisible from one of the end
/// points.
pub(super) fn connection(plane: &Plane) -> Option<Connection> {
    let [k1, k2] = plane.inverse_distance;
    let (mut low, mut high) = (0.0, plane.angle);
    let mut angle = plane.angle * ((1.0 - k1) / ((1.0 - k1) + (1.0 - k2)));
    let (mut sin, mut cos) = portable::sin_cos(angle);
    for _ in 0..STEPS {
        let (sin_rest, cos_rest) = rest(plane, sin, cos);
        let value = sin * cos_rest - cos * sin_rest - k2 * sin + k1 * sin_rest;
        let derivative = 2.0 * (cos * cos_rest + sin * sin_rest) - k2 * cos - k1 * cos_rest;
        if value > 0.0 {
            high = angle;
        } else {
            low = angle;
        }
        let next = angle - value / derivative;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let done = (next - angle).abs() <= 1e-6 * plane.angle;
        angle = next;
        (sin, cos) = portable::sin_cos(angle);
        if done {
            break;
        }
    }
    let (_, cos_rest) = rest(plane, sin, cos);
    if cos <= k1 || cos_rest <= k2 {
        return None;
    }
    let squared = (1.0 - k1) * (1.0 - k1) + 2.0 * k1 * sin * sin / (1.0 + cos);
    let sine = (sin / squared.sqrt()).min(1.0);
    let vertex = plane.at((sin, cos));
    Some(Connection { direction: plane.direction(sine, 1.0), vertices: [vertex; 2], sine })
}

/// Sine and cosine of Φ - φ.
fn rest(plane: &Plane, sin: f32, cos: f32) -> (f32, f32) {
    (plane.sin * cos - plane.cos * sin, plane.cos * cos + plane.sin * sin)
}

/// Φ'(u) of Φ = 2 asin u - asin(k₁ u) - asin(k₂ u).
#[inline]
pub(super) fn angle_derivative(sine: f32, inverse_distance: [f32; 2], cosines: [f32; 2]) -> f32 {
    2.0 / cos_from_sin(sine).max(1e-6) - inverse_distance[0] / cosines[0] - inverse_distance[1] / cosines[1]
}
