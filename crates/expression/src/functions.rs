//! Functions that expressions may call.

use crate::{Binary, Ternary, Unary};
use std::ops::RangeInclusive;

/// Function that expressions may call.
#[derive(Debug)]
pub struct Function {
    /// Name.
    pub name: &'static str,
    /// Call with named arguments, for documentation and messages.
    pub usage: &'static str,
    /// Number of arguments.
    pub arity: RangeInclusive<usize>,
    /// Operations that the function compiles to.
    pub(crate) code: Code,
}

/// Operations of a function.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Code {
    /// Operation on the only argument.
    Unary(Unary),
    /// Operation on both arguments.
    Binary(Binary),
    /// Operation on all three arguments.
    Ternary(Ternary),
    /// Operation on the number and the first argument, then on the result and the next argument.
    Fold(f64, Binary),
}

/// Every function, in the order of the documentation.
pub const FUNCTIONS: &[Function] = &[
    unary("sin", "sin(x)", Unary::Sin),
    unary("cos", "cos(x)", Unary::Cos),
    unary("tan", "tan(x)", Unary::Tan),
    unary("asin", "asin(x)", Unary::Asin),
    unary("acos", "acos(x)", Unary::Acos),
    unary("atan", "atan(x)", Unary::Atan),
    binary("atan2", "atan2(y, x)", Binary::Atan2),
    unary("radians", "radians(degrees)", Unary::Radians),
    unary("degrees", "degrees(radians)", Unary::Degrees),
    unary("sqrt", "sqrt(x)", Unary::Sqrt),
    binary("hypot", "hypot(x, y)", Binary::Hypot),
    binary("pow", "pow(x, y)", Binary::Power),
    unary("exp", "exp(x)", Unary::Exp),
    unary("ln", "ln(x)", Unary::Ln),
    unary("abs", "abs(x)", Unary::Abs),
    unary("sign", "sign(x)", Unary::Sign),
    unary("floor", "floor(x)", Unary::Floor),
    unary("ceil", "ceil(x)", Unary::Ceil),
    unary("round", "round(x)", Unary::Round),
    binary("mod", "mod(x, y)", Binary::Modulo),
    fold("min", "min(x, y, ...)", f64::INFINITY, Binary::Min),
    fold("max", "max(x, y, ...)", f64::NEG_INFINITY, Binary::Max),
    ternary("clamp", "clamp(x, low, high)", Ternary::Clamp),
    ternary("lerp", "lerp(a, b, t)", Ternary::Lerp),
    ternary("smoothstep", "smoothstep(a, b, x)", Ternary::Smoothstep),
    ternary("if", "if(condition, then, otherwise)", Ternary::If),
];

const fn unary(name: &'static str, usage: &'static str, op: Unary) -> Function {
    Function { name, usage, arity: 1..=1, code: Code::Unary(op) }
}

const fn binary(name: &'static str, usage: &'static str, op: Binary) -> Function {
    Function { name, usage, arity: 2..=2, code: Code::Binary(op) }
}

const fn ternary(name: &'static str, usage: &'static str, op: Ternary) -> Function {
    Function { name, usage, arity: 3..=3, code: Code::Ternary(op) }
}

const fn fold(name: &'static str, usage: &'static str, start: f64, op: Binary) -> Function {
    Function { name, usage, arity: 1..=usize::MAX, code: Code::Fold(start, op) }
}
