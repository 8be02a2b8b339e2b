//! Parses expressions by recursive descent, with a limit on the depth.

use crate::builder::{Builder, Operand, Tape, TapeFull, split_component};
use crate::error::{ExpressionResult, fail};
use crate::names::unknown_name;
use crate::token::{self, Token};
use crate::{Binary, FUNCTIONS, Function, MAX_DEPTH, MAX_OPS, Names, Unary};
use std::ops::Range;

/// Maximum number of arguments of a function.
const MAX_ARGUMENTS: usize = 64;

/// Parser of one expression, from left to right.
pub struct Parser<'t> {
    text: &'t str,
    /// Names to check the expression's names against.
    names: Option<&'t Names>,
    /// Byte after the last token that was taken.
    at: usize,
    /// Next token, once it was looked at.
    next: Option<(Token<'t>, Range<usize>)>,
    depth: usize,
    builder: Builder<'t>,
}

impl<'t> Parser<'t> {
    /// Parser at the start of `text`.
    pub fn new(text: &'t str, names: Option<&'t Names>) -> Self {
        Self { text, names, at: 0, next: None, depth: 0, builder: Builder::default() }
    }

    /// Tape of the whole text.
    pub fn parse(mut self) -> ExpressionResult<Tape> {
        let result = self.comparison()?;
        match self.peek()? {
            (Token::End, _) => {}
            (Token::Sign(")"), at) => return fail(at, "this `)` closes nothing"),
            (Token::Sign("="), at) => return fail(at, "`==` compares; a single `=` has no meaning here"),
            (_, at) => return fail(at, "an operator is missing before this"),
        }
        let length = self.text.len();
        self.builder.finish(result).or_else(|full| too_long(full, length))
    }

    fn peek(&mut self) -> ExpressionResult<(Token<'t>, Range<usize>)> {
        if let Some(next) = &self.next {
            return Ok(next.clone());
        }
        let next = token::next(self.text, self.at)?;
        Ok(self.next.insert(next).clone())
    }

    /// Moves behind the token that ends at `end`.
    fn advance(&mut self, end: usize) {
        self.at = end;
        self.next = None;
    }

    /// Takes the next token if it is one of `signs`.
    fn take(&mut self, signs: &[&str]) -> ExpressionResult<Option<&'t str>> {
        match self.peek()? {
            (Token::Sign(sign), at) if signs.contains(&sign) => {
                self.advance(at.end);
                Ok(Some(sign))
            }
            _ => Ok(None),
        }
    }

    fn unary(&mut self, op: Unary, x: Operand) -> ExpressionResult<Operand> {
        let length = self.text.len();
        self.builder.unary(op, x).or_else(|full| too_long(full, length))
    }

    fn binary(&mut self, op: Binary, x: Operand, y: Operand) -> ExpressionResult<Operand> {
        let length = self.text.len();
        self.builder.binary(op, x, y).or_else(|full| too_long(full, length))
    }

    fn comparison(&mut self) -> ExpressionResult<Operand> {
        let left = self.sum()?;
        let Some(sign) = self.take(&["<", "<=", ">", ">=", "==", "!="])? else { return Ok(left) };
        let right = self.sum()?;
        let op = match sign {
            "<" => Binary::Less,
            "<=" => Binary::LessOrEqual,
            ">" => Binary::Greater,
            ">=" => Binary::GreaterOrEqual,
            "==" => Binary::Equal,
            _ => Binary::NotEqual,
        };
        self.binary(op, left, right)
    }

    fn sum(&mut self) -> ExpressionResult<Operand> {
        let mut value = self.product()?;
        while let Some(sign) = self.take(&["+", "-"])? {
            let next = self.product()?;
            let op = if sign == "+" { Binary::Add } else { Binary::Subtract };
            value = self.binary(op, value, next)?;
        }
        Ok(value)
    }

    fn product(&mut self) -> ExpressionResult<Operand> {
        let mut value = self.sign()?;
        while let Some(sign) = self.take(&["*", "/", "%"])? {
            let next = self.sign()?;
            let op = match sign {
                "*" => Binary::Multiply,
                "/" => Binary::Divide,
                _ => Binary::Modulo,
            };
            value = self.binary(op, value, next)?;
        }
        Ok(value)
    }

    fn sign(&mut self) -> ExpressionResult<Operand> {
        let at = self.at;
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return fail(at..self.text.len(), format!("the expression is nested deeper than {MAX_DEPTH}"));
        }
        let value = if self.take(&["-"])?.is_some() {
            let value = self.sign()?;
            self.unary(Unary::Negate, value)?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(value)
    }

    fn power(&mut self) -> ExpressionResult<Operand> {
        let base = self.atom()?;
        if self.take(&["^"])?.is_none() {
            return Ok(base);
        }
        let exponent = self.sign()?;
        self.binary(Binary::Power, base, exponent)
    }

    fn atom(&mut self) -> ExpressionResult<Operand> {
        let (token, at) = self.peek()?;
        match token {
            Token::Number(value) => {
                self.advance(at.end);
                Ok(Operand::Constant(value))
            }
            Token::Name(name) => {
                self.advance(at.end);
                self.call_or_input(name, at)
            }
            Token::Sign("(") => {
                self.advance(at.end);
                let value = self.comparison()?;
                self.close(at)?;
                Ok(value)
            }
            Token::Sign(sign) => fail(at, format!("a number is missing before this `{sign}`")),
            Token::End => fail(at, "a number is missing here"),
        }
    }

    fn close(&mut self, open: Range<usize>) -> ExpressionResult<()> {
        match self.take(&[")"])? {
            Some(_) => Ok(()),
            None => match self.peek()? {
                (Token::End, _) => fail(open, "this `(` is never closed"),
                (_, at) => fail(at, "expected an operator or `)` before this"),
            },
        }
    }

    /// Call of a function, or an input.
    fn call_or_input(&mut self, name: &'t str, at: Range<usize>) -> ExpressionResult<Operand> {
        let (_, open) = self.peek()?;
        if self.take(&["("])?.is_some() {
            let arguments = self.arguments(open)?;
            let Some(function) = FUNCTIONS.iter().find(|function| function.name == name) else {
                return Err(unknown_name(name, at, "no function", FUNCTIONS.iter().map(|function| function.name)));
            };
            return self.call(function, &arguments, at);
        }
        if let Some(names) = self.names {
            let (name, component) = split_component(name);
            names.number(name, component, &at)?;
        }
        let length = self.text.len();
        self.builder.input(name, at).or_else(|full| too_long(full, length))
    }

    fn arguments(&mut self, open: Range<usize>) -> ExpressionResult<Vec<Operand>> {
        let mut arguments = Vec::new();
        if self.take(&[")"])?.is_some() {
            return Ok(arguments);
        }
        loop {
            arguments.push(self.comparison()?);
            if arguments.len() > MAX_ARGUMENTS {
                return fail(open, format!("a function takes at most {MAX_ARGUMENTS} numbers"));
            }
            if self.take(&[","])?.is_none() {
                self.close(open)?;
                return Ok(arguments);
            }
        }
    }

    fn call(&mut self, function: &Function, arguments: &[Operand], at: Range<usize>) -> ExpressionResult<Operand> {
        let length = self.text.len();
        let result = self.builder.call(function.code, arguments).or_else(|full| too_long(full, length))?;
        if let Some(result) = result {
            return Ok(result);
        }
        let expected = match (*function.arity.start(), *function.arity.end()) {
            (1, 1) => "1 number".to_owned(),
            (least, most) if least == most => format!("{least} numbers"),
            (least, _) => format!("at least {least} numbers"),
        };
        fail(at, format!("`{}` takes {expected}, not {}", function.name, arguments.len()))
    }
}

/// Fails for an expression of `length` bytes.
fn too_long<T>(TapeFull: TapeFull, length: usize) -> ExpressionResult<T> {
    fail(0..length, format!("the expression takes more than {MAX_OPS} operations"))
}
