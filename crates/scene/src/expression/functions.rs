//! The functions of expressions. All are the same bits on every platform.

use juggler_math::fun;
use std::ops::RangeInclusive;

/// One function.
pub struct Function {
    /// Its name.
    pub name: &'static str,
    /// How it is written.
    pub usage: &'static str,
    /// How many numbers it takes.
    pub takes: RangeInclusive<usize>,
    /// What it makes of them; called with as many as it takes.
    pub(super) call: fn(&[f64]) -> f64,
}

/// Every function, in the order of the documentation.
pub const FUNCTIONS: &[Function] = &[
    one("sin", "sin(x)", |a| fun::sin_f64(first(a))),
    one("cos", "cos(x)", |a| fun::cos_f64(first(a))),
    one("tan", "tan(x)", |a| fun::tan_f64(first(a))),
    one("asin", "asin(x)", |a| fun::asin_f64(first(a))),
    one("acos", "acos(x)", |a| fun::acos_f64(first(a))),
    one("atan", "atan(x)", |a| fun::atan2_f64(first(a), 1.0)),
    two("atan2", "atan2(y, x)", |a| fun::atan2_f64(first(a), second(a))),
    one("radians", "radians(degrees)", |a| first(a).to_radians()),
    one("degrees", "degrees(radians)", |a| first(a).to_degrees()),
    one("sqrt", "sqrt(x)", |a| first(a).sqrt()),
    two("hypot", "hypot(x, y)", |a| (first(a) * first(a) + second(a) * second(a)).sqrt()),
    two("pow", "pow(x, y)", |a| fun::pow_f64(first(a), second(a))),
    one("exp", "exp(x)", |a| fun::exp_f64(first(a))),
    one("ln", "ln(x)", |a| fun::ln_f64(first(a))),
    one("abs", "abs(x)", |a| first(a).abs()),
    one("sign", "sign(x)", |a| sign(first(a))),
    one("floor", "floor(x)", |a| first(a).floor()),
    one("ceil", "ceil(x)", |a| first(a).ceil()),
    one("round", "round(x)", |a| first(a).round()),
    two("mod", "mod(x, y)", |a| modulo(first(a), second(a))),
    many("min", "min(x, y, ...)", |a| a.iter().copied().fold(f64::INFINITY, f64::min)),
    many("max", "max(x, y, ...)", |a| a.iter().copied().fold(f64::NEG_INFINITY, f64::max)),
    three("clamp", "clamp(x, low, high)", |a| clamp(first(a), second(a), third(a))),
    three("lerp", "lerp(a, b, t)", |a| first(a) + (second(a) - first(a)) * third(a)),
    three("smoothstep", "smoothstep(a, b, x)", |a| smoothstep(first(a), second(a), third(a))),
    three("if", "if(condition, then, otherwise)", |a| if first(a) != 0.0 { second(a) } else { third(a) }),
];

type Call = fn(&[f64]) -> f64;

const fn one(name: &'static str, usage: &'static str, call: Call) -> Function {
    Function { name, usage, takes: 1..=1, call }
}

const fn two(name: &'static str, usage: &'static str, call: Call) -> Function {
    Function { name, usage, takes: 2..=2, call }
}

const fn three(name: &'static str, usage: &'static str, call: Call) -> Function {
    Function { name, usage, takes: 3..=3, call }
}

const fn many(name: &'static str, usage: &'static str, call: Call) -> Function {
    Function { name, usage, takes: 1..=usize::MAX, call }
}

fn first(arguments: &[f64]) -> f64 {
    arguments.first().copied().unwrap_or(f64::NAN)
}

fn second(arguments: &[f64]) -> f64 {
    arguments.get(1).copied().unwrap_or(f64::NAN)
}

fn third(arguments: &[f64]) -> f64 {
    arguments.get(2).copied().unwrap_or(f64::NAN)
}

/// What is left of `x` after whole multiples of `y`; has the sign of `y`.
pub(crate) fn modulo(x: f64, y: f64) -> f64 {
    x - y * (x / y).floor()
}

fn sign(x: f64) -> f64 {
    if x == 0.0 || x.is_nan() { x } else { x.signum() }
}

fn clamp(x: f64, a: f64, b: f64) -> f64 {
    x.max(a.min(b)).min(a.max(b))
}

/// 0 below `a`, 1 above `b`, 3t² − 2t³ in between.
fn smoothstep(a: f64, b: f64, x: f64) -> f64 {
    let t = clamp((x - a) / (b - a), 0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
