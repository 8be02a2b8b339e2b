//! Eight children side by side, and what each may give at a point.
//!
//! Everything is written as loops over eight numbers without branches, so that the compiler makes them instructions of
//! the vector unit for which the caller is made (hence `inline(always)`); sums, products, quotients and square roots give the same bits on all machines.

use super::summary::Summary;
use juggler_math::Vec3;

/// Children a node.
pub(super) const WIDTH: usize = 8;

type Lanes = [f32; WIDTH];

/// Added to a squared sine that was found from a cosine: where the sine vanishes rounding takes its digits, and a
/// sine that is too large makes an angle's bound wider, never narrower.
const SINE_SLACK: f32 = 1e-6;

/// What lies below the plane by no more than this counts as on it (a cosine).
const PLANE_SLACK: f32 = 1e-5;

/// The least cosines that count where light may arrive.
const LEAST_EMISSION: f32 = 1e-3;
const LEAST_ARRIVAL: f32 = 1e-4;

/// The share of their light that several lights are taken to send in a direction at least, times the sine under which their
/// ball is seen: from close by they are seen from different sides.
const LEAST_FACING: f32 = 0.2;

/// How much more lights give in the mean in the middle of their ball than at its border, about.
const WITHIN: f32 = 3.0;

/// A child's number with this bit is a light, else a node.
const LIGHT: u32 = 1 << 31;

/// Eight children, the numbers of each kind together.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Node {
    /// Centre of the ball around the child.
    center: [Lanes; 3],
    /// Radius of the ball, a little more than necessary, and no less than what keeps squares away from 0.
    radius: Lanes,
    /// Axis of the cone of normals.
    axis: [Lanes; 3],
    /// Cosine and sine of its half angle.
    cos_spread: Lanes,
    sin_spread: Lanes,
    /// Cosine of the greatest angle to a normal under which it shines, a little less.
    cos_emission: Lanes,
    /// 0 for a child that shines to both sides; else a number that takes the other side's cosine out of the running.
    back: Lanes,
    /// How much of it leaves in a direction, about: constant, linear, quadratic.
    constant: Lanes,
    linear: [Lanes; 3],
    quadratic: [Lanes; 5],
    /// Power in units of the strongest light's; 0 where there is no child.
    power: Lanes,
    child: [u32; WIDTH],
}

/// What stands in a slot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Child {
    Node(usize),
    Light(u32),
}

/// A point that asks, in the tree's coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    point: Vec3,
    normal: Vec3,
    /// The least cosine at the point: 1 where it does not count.
    least_arrival: f32,
}

impl Place {
    #[inline(always)]
    pub fn new(point: Vec3, normal: Vec3) -> Self {
        Self { point, normal, least_arrival: if normal == Vec3::ZERO { 1.0 } else { LEAST_ARRIVAL } }
    }
}

impl Node {
    /// A node without children.
    pub fn empty() -> Self {
        Self {
            center: [[0.0; WIDTH]; 3],
            radius: [1.0; WIDTH],
            axis: [[0.0; WIDTH]; 3],
            cos_spread: [1.0; WIDTH],
            sin_spread: [0.0; WIDTH],
            cos_emission: [0.0; WIDTH],
            back: [0.0; WIDTH],
            constant: [0.0; WIDTH],
            linear: [[0.0; WIDTH]; 3],
            quadratic: [[0.0; WIDTH]; 5],
            power: [0.0; WIDTH],
            child: [LIGHT; WIDTH],
        }
    }

    /// Puts a child into a slot.
    pub fn set(&mut self, slot: usize, summary: &Summary, child: Child) {
        for axis in 0..3 {
            self.center[axis][slot] = summary.center[axis];
            self.axis[axis][slot] = summary.axis[axis];
            self.linear[axis][slot] = summary.facing.linear[axis];
        }
        for (lanes, number) in self.quadratic.iter_mut().zip(summary.facing.quadratic) {
            lanes[slot] = number;
        }
        self.constant[slot] = summary.facing.constant;
        self.radius[slot] = summary.radius;
        self.cos_spread[slot] = summary.cos_spread;
        self.sin_spread[slot] = (1.0 - f64::from(summary.cos_spread) * f64::from(summary.cos_spread)).sqrt() as f32;
        self.cos_emission[slot] = summary.cos_emission;
        self.back[slot] = if summary.two_sided { 0.0 } else { -4.0 };
        self.power[slot] = summary.power;
        self.child[slot] = match child {
            Child::Node(index) => index as u32,
            Child::Light(index) => index | LIGHT,
        };
    }

    #[inline(always)]
    pub fn child(&self, slot: usize) -> Child {
        let child = self.child[slot & (WIDTH - 1)];
        if child & LIGHT == 0 { Child::Node(child as usize) } else { Child::Light(child & !LIGHT) }
    }

    /// What each child gives at a place, about, or 0 where it certainly gives nothing. That is decided by
    /// cos θ' and cos θ'ᵢ: θ' is the angle to the cone of normals and θ'ᵢ that to the normal of the place, both less the half
    /// angle under which the child's ball is seen.
    /// How much it is: power · what leaves in that direction · what arrives at the plane / d², each in the mean over the
    /// ball's lights. Bounds in their place make far more noise (docs/benchmarks.md).
    #[inline(always)]
    #[expect(clippy::needless_range_loop, reason = "a plain loop is made a vector loop")]
    pub fn weights(&self, place: &Place) -> Weights {
        let (p, n) = (place.point, place.normal);
        let mut weights = [0.0; WIDTH];
        for i in 0..WIDTH {
            let to = [self.center[0][i] - p.x, self.center[1][i] - p.y, self.center[2][i] - p.z];
            let squared = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
            let ball = self.radius[i] * self.radius[i];
            let outside = squared > ball;
            let inverse = 1.0 / select(outside, squared, ball).sqrt();

            // Half angle of the ball: all directions from within. Then of the cone and the ball together.
            let sin_ball = self.radius[i] * inverse;
            let cos_ball = select(outside, above(1.0 - sin_ball * sin_ball, 0.0).sqrt(), -1.0);
            let (cos_cone, sin_cone) = (self.cos_spread[i], self.sin_spread[i]);
            let cos_both = cos_cone * cos_ball - sin_cone * sin_ball;
            let sin_both = sin_cone * cos_ball + cos_cone * sin_ball;
            let narrow = outside & (sin_both > 0.0);

            let along = to[0] * self.axis[0][i] + to[1] * self.axis[1][i] + to[2] * self.axis[2][i];
            let front = -along * inverse;
            let cos_axis = above(front, self.back[i] - front);
            let cos_leaving = select(narrow, less(cos_axis, cos_both, sin_both), 1.0);

            let cos_plane = (to[0] * n.x + to[1] * n.y + to[2] * n.z) * inverse;
            let lights = (cos_leaving > self.cos_emission[i]) & (cos_plane > -PLANE_SLACK - sin_ball);
            let about = above(self.facing(i, to.map(|along| -along * inverse)), LEAST_FACING * sin_ball);
            let leaving = above(select(about < cos_leaving, about, cos_leaving), LEAST_EMISSION);
            let arriving = above(mean_above_plane(cos_plane, sin_ball), place.least_arrival);
            let nearness = (inverse * inverse) * (1.0 + WITHIN * (1.0 - squared * (inverse * inverse)));
            weights[i] = select(lights, self.power[i] * leaving * arriving * nearness, 0.0);
        }
        Weights::new(weights)
    }

    /// [`Facing`](super::summary::Facing) of a child in a direction `w`; one that is shorter than 1 counts as the mean of those
    /// around it.
    #[inline(always)]
    fn facing(&self, child: usize, w: [f32; 3]) -> f32 {
        let (l, q) = (&self.linear, &self.quadratic);
        let linear = l[0][child] * w[0] + l[1][child] * w[1] + l[2][child] * w[2];
        let zz = w[2] * w[2];
        let squares = q[0][child] * (w[0] * w[0] - zz) + q[1][child] * (w[1] * w[1] - zz);
        let products = q[2][child] * w[0] * w[1] + q[3][child] * w[0] * w[2] + q[4][child] * w[1] * w[2];
        self.constant[child] + linear + squares + products
    }
}

/// Weights of the children of a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weights {
    lanes: Lanes,
    /// Their sums up to each.
    sums: Lanes,
}

impl Weights {
    #[inline(always)]
    fn new(lanes: Lanes) -> Self {
        // Both halves at once. Each sum is made of the one before, so that none is less.
        let mut sums = lanes;
        for i in 1..WIDTH / 2 {
            sums[i] += sums[i - 1];
            sums[WIDTH / 2 + i] += sums[WIDTH / 2 + i - 1];
        }
        let half = sums[WIDTH / 2 - 1];
        sums[WIDTH / 2..].iter_mut().for_each(|sum| *sum += half);
        Self { lanes, sums }
    }

    /// These, or by power where none can light the place: the bound of all together was wider than those of each.
    #[inline(always)]
    pub fn or_powers(self, node: &Node) -> Self {
        if self.sums[WIDTH - 1] > 0.0 { self } else { Self::new(node.power) }
    }

    /// A slot, its chance, and `u` stretched to [0, 1) again; `None` when all weights are 0.
    #[inline(always)]
    pub fn pick(&self, u: f32) -> Option<(usize, f32, f32)> {
        let total = self.sums[WIDTH - 1];
        let target = u * total;
        // Below the total, since u is below 1: the slot's own weight is above 0.
        let slot = self.sums.iter().map(|sum| usize::from(*sum <= target)).sum::<usize>();
        if slot >= WIDTH {
            return None;
        }
        let below = if slot == 0 { 0.0 } else { self.sums[slot - 1] };
        let rest = (target - below) / self.lanes[slot];
        Some((slot, self.lanes[slot] / total, rest.clamp(0.0, 1f32.next_down())))
    }

    /// The chance of a slot.
    #[inline(always)]
    pub fn chance(&self, slot: usize) -> f32 {
        let total = self.sums[WIDTH - 1];
        if total > 0.0 { self.lanes[slot] / total } else { 0.0 }
    }
}

/// The cosine of an angle less another, 0 at least. The angles are given by a cosine, and by cosine and sine.
#[inline(always)]
fn less(cos: f32, cos_other: f32, sin_other: f32) -> f32 {
    let sin = (above(1.0 - cos * cos, 0.0) + SINE_SLACK).sqrt();
    select(cos >= cos_other, 1.0, cos * cos_other + sin * sin_other)
}

/// The mean of a cosine, 0 below the plane, over a ball seen under an angle with that sine, about: a parabola where the plane
/// cuts the ball.
#[inline(always)]
fn mean_above_plane(cos_center: f32, sin_ball: f32) -> f32 {
    let rise = above(cos_center + sin_ball, 0.0);
    select(cos_center > sin_ball, cos_center, rise * rise / (4.0 * sin_ball))
}

/// The greater number; a plain comparison, which is one instruction.
#[inline(always)]
fn above(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[inline(always)]
fn select(which: bool, yes: f32, no: f32) -> f32 {
    if which { yes } else { no }
}
