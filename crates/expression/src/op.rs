//! Operations of a tape.

/// Position of an operation on its tape, which names the operation's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Register(u16);

impl Register {
    /// Register of the operation at `index`; `None` beyond [`MAX_OPS`](crate::MAX_OPS).
    pub(crate) fn new(index: usize) -> Option<Self> {
        u16::try_from(index).ok().filter(|_| index < crate::MAX_OPS).map(Self)
    }

    /// Index of the operation on its tape.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// Operation of a tape. Operands are results of earlier operations.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Op {
    /// Element of [`Program::constants`](crate::Program::constants).
    Constant(u16),
    /// Value of an element of [`Program::inputs`](crate::Program::inputs).
    Input(u16),
    /// Operation on one number.
    Unary(Unary, Register),
    /// Operation on two numbers.
    Binary(Binary, [Register; 2]),
    /// Operation on three numbers.
    Ternary(Ternary, [Register; 3]),
}

/// Operations on one number `x`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Unary {
    /// `-x`.
    Negate,
    /// Sine of an angle in radians.
    Sin,
    /// Cosine of an angle in radians.
    Cos,
    /// Tangent of an angle in radians.
    Tan,
    /// Arc sine in radians; arguments beyond ±1 count as ±1.
    Asin,
    /// Arc cosine in radians; arguments beyond ±1 count as ±1.
    Acos,
    /// Arc tangent in radians.
    Atan,
    /// Degrees to radians.
    Radians,
    /// Radians to degrees.
    Degrees,
    /// Square root.
    Sqrt,
    /// e to the power of `x`.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Absolute value.
    Abs,
    /// -1 for negative, 1 for positive numbers; zeros and NaN stay as they are.
    Sign,
    /// Greatest integer not above `x`.
    Floor,
    /// Least integer not below `x`.
    Ceil,
    /// Nearest integer; ties go away from zero.
    Round,
}

/// Operations on two numbers `x` and `y`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Binary {
    /// `x + y`.
    Add,
    /// `x - y`.
    Subtract,
    /// `x * y`.
    Multiply,
    /// `x / y`.
    Divide,
    /// [`modulo`](crate::modulo).
    Modulo,
    /// `x` to the power of `y`.
    Power,
    /// Angle in radians of the point with abscissa `y` and ordinate `x`.
    Atan2,
    /// Square root of x² + y².
    Hypot,
    /// The lesser number; a NaN gives the other operand.
    Min,
    /// The greater number; a NaN gives the other operand.
    Max,
    /// 1 if `x < y`, else 0.
    Less,
    /// 1 if `x <= y`, else 0.
    LessOrEqual,
    /// 1 if `x > y`, else 0.
    Greater,
    /// 1 if `x >= y`, else 0.
    GreaterOrEqual,
    /// 1 if `x == y`, else 0.
    Equal,
    /// 1 if `x != y`, else 0.
    NotEqual,
}

/// Operations on three numbers `x`, `y` and `z`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Ternary {
    /// `x` limited to the interval between `y` and `z`, in either order.
    Clamp,
    /// Linear interpolation from `x` to `y` by `z`.
    Lerp,
    /// Smooth step of `z`: 0 below `x`, 1 above `y`, 3t² − 2t³ in between.
    Smoothstep,
    /// `y` if `x` is not 0, else `z`.
    If,
}
