//! Evaluation in `f64`. All functions have the same bits on every platform.

use crate::error::{ExpressionError, ExpressionResult};
use crate::{Binary, Names, Op, Program, Quantity, Register, Ternary, Unary};
use juggler_math::portable;

/// Evaluator of programs in `f64`. It keeps its buffers from one evaluation to the next.
#[derive(Clone, Debug, Default)]
pub struct PointEvaluator {
    inputs: Vec<f64>,
    /// Results of the operations so far.
    registers: Vec<f64>,
}

impl PointEvaluator {
    /// Result of a program for values of its [inputs](Program::inputs). It may be infinite or NaN.
    /// A missing value counts as NaN.
    pub fn evaluate(&mut self, program: &Program, inputs: &[f64]) -> f64 {
        run(program, inputs, &mut self.registers)
    }

    /// Value of a program, always finite. Returns `None` if it uses a name whose value is not
    /// known.
    ///
    /// # Errors
    /// A name is unknown or of another kind than the program uses, or the result is not finite.
    pub fn value(&mut self, program: &Program, names: &Names) -> Result<Option<f64>, ExpressionError> {
        if !self.bind(program, names)? {
            return Ok(None);
        }
        let value = run(program, &self.inputs, &mut self.registers);
        if value.is_finite() { Ok(Some(value)) } else { Err(not_finite(value, program, names)) }
    }

    /// Looks up the inputs of a program. Returns whether all of them are known.
    fn bind(&mut self, program: &Program, names: &Names) -> ExpressionResult<bool> {
        self.inputs.clear();
        let mut is_known = true;
        for input in program.inputs() {
            let number = names.number(&input.name, input.component.as_deref(), &input.at)?;
            is_known &= number.is_some();
            self.inputs.push(number.unwrap_or(f64::NAN));
        }
        Ok(is_known)
    }
}

fn run(program: &Program, inputs: &[f64], registers: &mut Vec<f64>) -> f64 {
    registers.clear();
    for op in program.ops() {
        let operand = |register: Register| registers.get(register.index()).copied().unwrap_or(f64::NAN);
        let result = match *op {
            Op::Constant(index) => program.constants().get(usize::from(index)).copied().unwrap_or(f64::NAN),
            Op::Input(index) => inputs.get(usize::from(index)).copied().unwrap_or(f64::NAN),
            Op::Unary(op, x) => op.apply(operand(x)),
            Op::Binary(op, operands) => op.apply(operands.map(operand)),
            Op::Ternary(op, operands) => op.apply(operands.map(operand)),
        };
        registers.push(result);
    }
    registers.last().copied().unwrap_or(f64::NAN)
}

fn not_finite(value: f64, program: &Program, names: &Names) -> ExpressionError {
    let message = if value.is_nan() {
        "the expression has no value (it is 0/0, the root of a negative number or the like)"
    } else {
        "the expression is infinite (a division by 0?)"
    };
    let help = match names.get("frame") {
        Some(Quantity::Number(frame)) => Some(format!("this happens at frame {frame}")),
        _ => None,
    };
    ExpressionError { help, ..ExpressionError::new(0..program.text_length(), message) }
}

impl Unary {
    /// Result for a number.
    pub fn apply(self, x: f64) -> f64 {
        match self {
            Self::Negate => -x,
            Self::Sin => portable::sin_f64(x),
            Self::Cos => portable::cos_f64(x),
            Self::Tan => portable::tan_f64(x),
            Self::Asin => portable::asin_f64(x),
            Self::Acos => portable::acos_f64(x),
            Self::Atan => portable::atan2_f64(x, 1.0),
            Self::Radians => x.to_radians(),
            Self::Degrees => x.to_degrees(),
            Self::Sqrt => x.sqrt(),
            Self::Exp => portable::exp_f64(x),
            Self::Ln => portable::ln_f64(x),
            Self::Abs => x.abs(),
            Self::Sign if x == 0.0 || x.is_nan() => x,
            Self::Sign => x.signum(),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
            Self::Round => x.round(),
        }
    }
}

impl Binary {
    /// Result for two numbers.
    pub fn apply(self, [x, y]: [f64; 2]) -> f64 {
        let truth = |holds: bool| f64::from(u8::from(holds));
        match self {
            Self::Add => x + y,
            Self::Subtract => x - y,
            Self::Multiply => x * y,
            Self::Divide => x / y,
            Self::Modulo => modulo(x, y),
            Self::Power => portable::pow_f64(x, y),
            Self::Atan2 => portable::atan2_f64(x, y),
            Self::Hypot => (x * x + y * y).sqrt(),
            Self::Min => x.min(y),
            Self::Max => x.max(y),
            Self::Less => truth(x < y),
            Self::LessOrEqual => truth(x <= y),
            Self::Greater => truth(x > y),
            Self::GreaterOrEqual => truth(x >= y),
            Self::Equal => truth(x == y),
            Self::NotEqual => truth(x != y),
        }
    }
}

impl Ternary {
    /// Result for three numbers.
    pub fn apply(self, [x, y, z]: [f64; 3]) -> f64 {
        match self {
            Self::Clamp => clamp(x, y, z),
            Self::Lerp => x + (y - x) * z,
            Self::Smoothstep => smoothstep(x, y, z),
            Self::If if x != 0.0 => y,
            Self::If => z,
        }
    }
}

/// Remainder of `x` after division by `y` with rounding down; it has the sign of `y`.
pub fn modulo(x: f64, y: f64) -> f64 {
    x - y * (x / y).floor()
}

fn clamp(x: f64, a: f64, b: f64) -> f64 {
    x.max(a.min(b)).min(a.max(b))
}

fn smoothstep(a: f64, b: f64, x: f64) -> f64 {
    let t = clamp((x - a) / (b - a), 0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
