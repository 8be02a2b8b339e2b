//! Expressions of scene files, such as `40 * sin(2 * pi * frame / frames)`: compiled once,
//! evaluated for any values of their names.
//!
//! ```
//! use juggler_expression::{Names, PointEvaluator, Program, Quantity};
//!
//! let mut names = Names::default();
//! names.insert("frame", Quantity::Number(3.0));
//! let program = Program::compile("2 * frame + 1", &names)?;
//! let mut evaluator = PointEvaluator::default();
//! assert_eq!(evaluator.value(&program, &names)?, Some(7.0));
//! names.insert("frame", Quantity::Number(4.0));
//! assert_eq!(evaluator.value(&program, &names)?, Some(9.0));
//! # Ok::<(), juggler_expression::ExpressionError>(())
//! ```
//!
//! Grammar, loosest binding first:
//!
//! ```text
//! comparison = sum (("<" | "<=" | ">" | ">=" | "==" | "!=") sum)?     1 if true, 0 if false
//! sum        = product (("+" | "-") product)*
//! product    = sign (("*" | "/" | "%") sign)*
//! sign       = "-" sign | power
//! power      = atom ("^" sign)?                                       -2^2 = -4, 2^3^2 = 2^9
//! atom       = number | name ("." component)? | "(" comparison ")"
//!            | name "(" comparison ("," comparison)* ")"
//! ```
//!
//! - `parser` parses the text by recursive descent and hands operations to `builder`, which folds
//!   constants and joins common subexpressions.
//! - A [`Program`] is a tape of operations ([`Op`]) in static single assignment form. It depends on
//!   the text only, so it may be kept and evaluated with other [`Names`].
//! - [`PointEvaluator`] runs a tape in `f64`. Other evaluators (intervals, affine forms, gradients)
//!   read the same tape through [`Program::ops`].
//!
//! All results are the same bits on every platform.

mod builder;
mod error;
mod functions;
mod names;
mod op;
mod parser;
mod point;
mod program;
mod token;

pub use error::ExpressionError;
pub use functions::{FUNCTIONS, Function};
pub use names::{COMPONENTS, Names, Quantity};
pub use op::{Binary, Op, Register, Ternary, Unary};
pub use point::{PointEvaluator, modulo};
pub use program::{Program, ProgramInput};

/// Maximum length of an expression, in bytes.
pub const MAX_LENGTH: usize = 4096;
/// Maximum nesting of parentheses, signs and powers.
pub const MAX_DEPTH: usize = 64;
/// Maximum number of operations of a [`Program`].
pub const MAX_OPS: usize = 4096;
