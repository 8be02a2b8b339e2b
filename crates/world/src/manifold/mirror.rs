//! The way that is mirrored on a ball: Alhazen's problem.

use super::{Bend, Plane, cosine};
use juggler_math::fun;

/// More than enough: Newton's steps double the digits.
const STEPS: usize = 16;

/// The place between the ends, at the angle φ from the first, where incidence equals reflection:
/// sin(2φ - Φ) - k₂ sin φ + k₁ sin(Φ - φ) = 0, whose left side rises through 0 once. `None` when one of the ends does
/// not see it.
pub(super) fn bend(plane: &Plane) -> Option<Bend> {
    let [near, far] = plane.nearness;
    let (mut low, mut high) = (0.0, plane.angle);
    let mut angle = plane.angle * ((1.0 - near) / ((1.0 - near) + (1.0 - far)));
    let (mut sin, mut cos) = fun::sin_cos(angle);
    for _ in 0..STEPS {
        let (sin_rest, cos_rest) = rest(plane, sin, cos);
        let value = sin * cos_rest - cos * sin_rest - far * sin + near * sin_rest;
        let slope = 2.0 * (cos * cos_rest + sin * sin_rest) - far * cos - near * cos_rest;
        if value > 0.0 {
            high = angle;
        } else {
            low = angle;
        }
        let next = angle - value / slope;
        let next = if next > low && next < high { next } else { 0.5 * (low + high) };
        let done = (next - angle).abs() <= 1e-6 * plane.angle;
        angle = next;
        (sin, cos) = fun::sin_cos(angle);
        if done {
            break;
        }
    }
    let (_, cos_rest) = rest(plane, sin, cos);
    if cos <= near || cos_rest <= far {
        return None;
    }
    let squared = (1.0 - near) * (1.0 - near) + 2.0 * near * sin * sin / (1.0 + cos);
    let sine = (sin / squared.sqrt()).min(1.0);
    let touch = plane.at((sin, cos));
    Some(Bend { direction: plane.direction(sine, 1.0), touches: [touch; 2], sine })
}

/// Sine and cosine of what is left of the angle between the ends.
fn rest(plane: &Plane, sin: f32, cos: f32) -> (f32, f32) {
    (plane.sin * cos - plane.cos * sin, plane.cos * cos + plane.sin * sin)
}

/// Φ'(u) of Φ = 2 asin u - asin(k₁ u) - asin(k₂ u).
#[inline]
pub(super) fn slope(sine: f32, nearness: [f32; 2], cosines: [f32; 2]) -> f32 {
    2.0 / cosine(sine).max(1e-6) - nearness[0] / cosines[0] - nearness[1] / cosines[1]
}
