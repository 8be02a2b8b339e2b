//! The ways through a ball.
//!
//! On the way past a ball's centre, the angle at the centre between the ends is Φ = π - g or π + g, by the side on which it
//! passes, with g(i) = asin(k₁ u) + asin(k₂ u) - 2 i + 2 asin(u / n), u = sin i. Over u, g'' changes its sign once at most,
//! from above 0 to below, and does not where g'(0) is below 0: so either g falls all the way, or it rises to one top and
//! falls from there. On each such stretch it has any value once.

use super::{Bend, MAX_BENDS, Plane, cosine};
use arrayvec::ArrayVec;
use juggler_math::fun;
use std::f32::consts::{FRAC_PI_2, PI};

/// Steps of looking for an angle: enough for bisection alone.
const STEPS: usize = 24;

/// g of one pair of ends.
#[derive(Clone, Copy)]
struct Swept {
    nearness: [f32; 2],
    ior: f32,
}

pub(super) fn bends(plane: &Plane, ior: f32) -> ArrayVec<Bend, MAX_BENDS> {
    let swept = Swept { nearness: plane.nearness, ior };
    let missing = PI - plane.angle;
    let top = swept.top();
    let (highest, lowest) = (swept.value(top), swept.value(FRAC_PI_2));
    let mut found = ArrayVec::new();
    let mut add = |side: f32, stretch: [f32; 2]| {
        let (sine, _) = fun::sin_cos(swept.find(side * missing, stretch));
        found.push(bend(plane, sine, side));
    };
    if missing < highest {
        add(1.0, [0.0, top]);
        if lowest < missing {
            add(1.0, [FRAC_PI_2, top]);
        }
    }
    if lowest < -missing {
        add(-1.0, [FRAC_PI_2, top]);
    }
    found
}

fn bend(plane: &Plane, sine: f32, side: f32) -> Bend {
    // Angles at the centre between an end and where the way touches the ball: that of incidence less that at the end.
    let touch = |nearness: f32| {
        let (sin, cos) = (nearness * sine, cosine(nearness * sine));
        (sine * cos - cosine(sine) * sin, cosine(sine) * cos + sine * sin)
    };
    let ((sin, cos), (sin_last, cos_last)) = (touch(plane.nearness[0]), touch(plane.nearness[1]));
    let first = plane.at((side * sin, cos));
    let end = plane.at((plane.sin, plane.cos));
    let onwards = plane.at((plane.cos, -plane.sin));
    let last = end * cos_last - onwards * (side * sin_last);
    Bend { direction: plane.direction(sine, side), touches: [first, last], sine }
}

impl Swept {
    fn value(&self, angle: f32) -> f32 {
        self.value_and_slope(angle).0
    }

    /// g and dg/di.
    fn value_and_slope(&self, angle: f32) -> (f32, f32) {
        let (sine, cos) = fun::sin_cos(angle);
        let sines = [self.nearness[0] * sine, self.nearness[1] * sine, sine / self.ior];
        let value = fun::asin(sines[0]) + fun::asin(sines[1]) + 2.0 * (fun::asin(sines[2]) - angle);
        (value, self.slope(cos, sines))
    }

    fn slope(&self, cos: f32, sines: [f32; 3]) -> f32 {
        let [first, second, inside] = sines.map(cosine);
        cos * (self.nearness[0] / first + self.nearness[1] / second + 2.0 / (self.ior * inside)) - 2.0
    }

    /// The angle of the greatest value; 0 where it only falls.
    fn top(&self) -> f32 {
        let slope = |angle: f32| {
            let (sine, cos) = fun::sin_cos(angle);
            self.slope(cos, [self.nearness[0] * sine, self.nearness[1] * sine, sine / self.ior])
        };
        let (mut low, mut high) = ((0.0, slope(0.0)), (FRAC_PI_2, -2.0));
        if low.1 <= 0.0 {
            return 0.0;
        }
        // False position, whose end that stays counts half the next time (the Illinois algorithm).
        let mut last_moved_low = None;
        for _ in 0..STEPS {
            let angle = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
            let here = slope(angle);
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

    /// Where g has a value, between an angle where it is less and one where it is more.
    fn find(&self, value: f32, [mut less, mut more]: [f32; 2]) -> f32 {
        let mut angle = 0.5 * (less + more);
        for _ in 0..STEPS {
            let (here, slope) = self.value_and_slope(angle);
            if here < value {
                less = angle;
            } else {
                more = angle;
            }
            let next = angle + (value - here) / slope;
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

/// Φ'(u), but for its sign.
#[inline]
pub(super) fn slope(sine: f32, nearness: [f32; 2], cosines: [f32; 2], ior: f32) -> f32 {
    let ends = nearness[0] / cosines[0] + nearness[1] / cosines[1];
    ends - 2.0 / cosine(sine).max(1e-6) + 2.0 / (ior * cosine(sine / ior))
}
