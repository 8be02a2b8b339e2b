//! Builds the tape of a program: folds constants and joins common subexpressions.

use crate::functions::Code;
use crate::program::ProgramInput;
use crate::{Binary, Op, Register, Ternary, Unary};
use std::collections::BTreeMap;
use std::ops::Range;

/// Operand of an operation that is not on the tape yet.
#[derive(Clone, Copy, Debug)]
pub enum Operand {
    /// Number known when the text is compiled. It is put on the tape when an operation needs it
    /// there.
    Constant(f64),
    /// Result of an operation on the tape.
    Register(Register),
}

/// Error: the tape has reached [`MAX_OPS`](crate::MAX_OPS).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TapeFull;

/// Parts of a program.
#[derive(Debug, Default)]
pub struct Tape {
    pub inputs: Vec<ProgramInput>,
    pub constants: Vec<f64>,
    pub ops: Vec<Op>,
}

/// Builder of a tape.
#[derive(Debug, Default)]
pub struct Builder<'t> {
    tape: Tape,
    /// Registers of the operations on the tape.
    known: BTreeMap<Key<'t>, Register>,
}

/// Identity of an operation: equal keys have equal results.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Key<'t> {
    /// Constant with these bits.
    Constant(u64),
    /// Name, with its component.
    Input(&'t str),
    /// Operation on registers.
    Op(Op),
}

impl<'t> Builder<'t> {
    /// The tape whose last operation gives `result`.
    pub fn finish(mut self, result: Operand) -> Result<Tape, TapeFull> {
        self.register(result)?;
        Ok(self.tape)
    }

    /// Input `name`, or `name.component`, written at `at`.
    pub fn input(&mut self, written: &'t str, at: Range<usize>) -> Result<Operand, TapeFull> {
        let key = Key::Input(written);
        if let Some(register) = self.known.get(&key) {
            return Ok(Operand::Register(*register));
        }
        let index = u16::try_from(self.tape.inputs.len()).map_err(|_| TapeFull)?;
        let (name, component) = split_component(written);
        self.tape.inputs.push(ProgramInput { name: name.into(), component: component.map(Into::into), at });
        self.emit(key, Op::Input(index)).map(Operand::Register)
    }

    /// Operation on one operand.
    pub fn unary(&mut self, op: Unary, x: Operand) -> Result<Operand, TapeFull> {
        match x {
            Operand::Constant(x) => Ok(Operand::Constant(op.apply(x))),
            Operand::Register(x) => self.op(Op::Unary(op, x)),
        }
    }

    /// Operation on two operands.
    pub fn binary(&mut self, op: Binary, x: Operand, y: Operand) -> Result<Operand, TapeFull> {
        if let (Operand::Constant(x), Operand::Constant(y)) = (x, y) {
            return Ok(Operand::Constant(op.apply([x, y])));
        }
        let operands = [self.register(x)?, self.register(y)?];
        self.op(Op::Binary(op, operands))
    }

    /// Operation on three operands.
    pub fn ternary(&mut self, op: Ternary, [x, y, z]: [Operand; 3]) -> Result<Operand, TapeFull> {
        if let (Operand::Constant(x), Operand::Constant(y), Operand::Constant(z)) = (x, y, z) {
            return Ok(Operand::Constant(op.apply([x, y, z])));
        }
        let operands = [self.register(x)?, self.register(y)?, self.register(z)?];
        self.op(Op::Ternary(op, operands))
    }

    /// Call of a function. Returns `None` for a number of arguments that the function does not
    /// take.
    pub fn call(&mut self, code: Code, arguments: &[Operand]) -> Result<Option<Operand>, TapeFull> {
        let result = match (code, arguments) {
            (Code::Unary(op), [x]) => self.unary(op, *x)?,
            (Code::Binary(op), [x, y]) => self.binary(op, *x, *y)?,
            (Code::Ternary(op), [x, y, z]) => self.ternary(op, [*x, *y, *z])?,
            (Code::Fold(start, op), [_, ..]) => {
                let start = Operand::Constant(start);
                arguments.iter().try_fold(start, |folded, argument| self.binary(op, folded, *argument))?
            }
            _ => return Ok(None),
        };
        Ok(Some(result))
    }

    fn register(&mut self, operand: Operand) -> Result<Register, TapeFull> {
        let value = match operand {
            Operand::Register(register) => return Ok(register),
            Operand::Constant(value) => value,
        };
        let key = Key::Constant(value.to_bits());
        if let Some(register) = self.known.get(&key) {
            return Ok(*register);
        }
        let index = u16::try_from(self.tape.constants.len()).map_err(|_| TapeFull)?;
        self.tape.constants.push(value);
        self.emit(key, Op::Constant(index))
    }

    fn op(&mut self, op: Op) -> Result<Operand, TapeFull> {
        let key = Key::Op(op);
        let register = match self.known.get(&key) {
            Some(register) => *register,
            None => self.emit(key, op)?,
        };
        Ok(Operand::Register(register))
    }

    fn emit(&mut self, key: Key<'t>, op: Op) -> Result<Register, TapeFull> {
        let register = Register::new(self.tape.ops.len()).ok_or(TapeFull)?;
        self.tape.ops.push(op);
        self.known.insert(key, register);
        Ok(register)
    }
}

/// Name and component of a written name.
pub fn split_component(written: &str) -> (&str, Option<&str>) {
    written.split_once('.').map_or((written, None), |(name, component)| (name, Some(component)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MAX_OPS;

    #[test]
    fn a_tape_holds_a_limited_number_of_operations() {
        let mut builder = Builder::default();
        let mut last = builder.input("x", 0..1).unwrap();
        for _ in 1..MAX_OPS {
            last = builder.unary(Unary::Sin, last).unwrap();
        }
        assert_eq!(builder.unary(Unary::Sin, last).err(), Some(TapeFull));
        assert_eq!(builder.unary(Unary::Cos, last).err(), Some(TapeFull));
        assert_eq!(builder.finish(last).unwrap().ops.len(), MAX_OPS);
    }
}
