//! Specular paths refracted through a sphere.
//!
//! Of a path that passes the center, the angle at the center between the end points is Φ = π - g or
//! π + g, by the side on which it passes, with g(i) = asin(k₁ u) + asin(k₂ u) - 2 i + 2 asin(u / n)
//! and u = sin i. As a function of u, g'' changes its sign at most once, from positive to negative,
//! and not at all if g'(0) < 0: so g either decreases everywhere, or it increases to one maximum
//! and decreases from there. On each monotonic interval it takes any value at most once.

use super::{Connection, MAX_CONNECTIONS, Plane, cos_from_sin};
use arrayvec::ArrayVec;
use juggler_math::portable;
use std::f32::consts::{FRAC_PI_2, PI};

/// Maximum number of iterations of root finding; enough for bisection alone.
const STEPS: usize = 24;

/// The function g for one pair of end points.
#[derive(Clone, Copy)]
struct AngleFunction {
    inverse_distance: [f32; 2],
    ior: f32,
}

pub(super) fn connections(plane: &Plane, ior: f32) -> ArrayVec<Connection, MAX_CONNECTIONS> {
    let g = AngleFunction { inverse_distance: plane.inverse_distance, ior };
    let target = PI - plane.angle;
    let maximum = g.maximum();
    let (highest, lowest) = (g.value(maximum), g.value(FRAC_PI_2));
    let mut found = ArrayVec::new();
    let mut add = |side: f32, interval: [f32; 2]| {
        let (sine, _) = portable::sin_cos(g.solve(side * target, interval));
        found.push(connection(plane, sine, side));
    };
    if target < highest {
        add(1.0, [0.0, maximum]);
        if lowest < target {
            add(1.0, [FRAC_PI_2, maximum]);
        }
    }
    if lowest < -target {
        add(-1.0, [FRAC_PI_2, maximum]);
    }
    found
}

fn connection(plane: &Plane, sine: f32, side: f32) -> Connection {
    // Angle at the center between an end point and the point of incidence: angle of incidence minus
    // angle at the end point.
    let center_angle = |inverse_distance: f32| {
        let (sin, cos) = (inverse_distance * sine, cos_from_sin(inverse_distance * sine));
        (sine * cos - cos_from_sin(sine) * sin, cos_from_sin(sine) * cos + sine * sin)
    };
    let ((sin, cos), (sin_last, cos_last)) =
        (center_angle(plane.inverse_distance[0]), center_angle(plane.inverse_distance[1]));
    let first = plane.at((side * sin, cos));
    let end = plane.at((plane.sin, plane.cos));
    let onwards = plane.at((plane.cos, -plane.sin));
    let last = end * cos_last - onwards * (side * sin_last);
    Connection { direction: plane.direction(sine, side), vertices: [first, last], sine }
}

impl AngleFunction {
    fn value(&self, angle: f32) -> f32 {
        self.value_and_derivative(angle).0
    }

    /// g and dg/di.
    fn value_and_derivative(&self, angle: f32) -> (f32, f32) {
        let (sine, cos) = portable::sin_cos(angle);
        let sines = [self.inverse_distance[0] * sine, self.inverse_distance[1] * sine, sine / self.ior];
        let value = portable::asin(sines[0]) + portable::asin(sines[1]) + 2.0 * (portable::asin(sines[2]) - angle);
        (value, self.derivative(cos, sines))
    }

    fn derivative(&self, cos: f32, sines: [f32; 3]) -> f32 {
        let [first, second, inside] = sines.map(cos_from_sin);
        cos * (self.inverse_distance[0] / first + self.inverse_distance[1] / second + 2.0 / (self.ior * inside)) - 2.0
    }

    /// Angle that maximizes g; 0 if g only decreases.
    fn maximum(&self) -> f32 {
        let derivative = |angle: f32| {
            let (sine, cos) = portable::sin_cos(angle);
            self.derivative(cos, [self.inverse_distance[0] * sine, self.inverse_distance[1] * sine, sine / self.ior])
        };
        let (mut low, mut high) = ((0.0, derivative(0.0)), (FRAC_PI_2, -2.0));
        if low.1 <= 0.0 {
            return 0.0;
        }
        // Regula falsi with the Illinois rule: halve the function value of the end point that is
        // kept twice.
        let mut last_moved_low = None;
        for _ in 0..STEPS {
            let angle = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let here = derivative(angle);
            let moves_low = here > 0.0;
            if moves_low {
                if last_moved_low == Some(true) {
                    high.1 *= 0.5;
                }
                low = (angle, here);
            } else {
                if last_moved_low == Some(false) {
                    low.1 *= 0.5;
                }
                high = (angle, here);
            }
            last_moved_low = Some(moves_low);
            if here.abs() < 1e-5 {
                return angle;
            }
        }
        0.5 * (low.0 + high.0)
    }

    /// Angle at which g has the given value, between one where g is smaller and one where it is
    /// larger.
    fn solve(&self, value: f32, [mut less, mut more]: [f32; 2]) -> f32 {
        let mut angle = 0.5 * (less + more);
        for _ in 0..STEPS {
            let (here, derivative) = self.value_and_derivative(angle);
            if here < value {
                less = angle;
            } else {
                more = angle;
            }
            let next = angle + (value - here) / derivative;
            let inside = (next - less) * (next - more) < 0.0;
            let next = if inside { next } else { 0.5 * (less + more) };
            let done = (next - angle).abs() <= 1e-6 * angle;
            angle = next;
            if done {
                break;
            }
        }
        angle
    }
}

/// Φ'(u), up to its sign.
#[inline]
pub(super) fn angle_derivative(sine: f32, inverse_distance: [f32; 2], cosines: [f32; 2], ior: f32) -> f32 {
    let ends = inverse_distance[0] / cosines[0] + inverse_distance[1] / cosines[1];
    ends - 2.0 / cos_from_sin(sine).max(1e-6) + 2.0 / (ior * cos_from_sin(sine / ior))
}
