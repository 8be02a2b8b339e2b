//! Tokens → a value, by recursive descent with a bound on the depth.

use super::token::{self, Token};
use super::{COMPONENTS, ExpressionError, FUNCTIONS, Function, MAX_DEPTH, Names, Quantity};
use crate::suggest::{closest, did_you_mean};
use juggler_math::fun;
use std::ops::Range;

/// Most arguments of one function.
const MAX_ARGUMENTS: usize = 64;

/// Reads one expression from left to right.
pub struct Reader<'t> {
    text: &'t str,
    names: &'t Names,
    /// Where the next token is looked for.
    at: usize,
    depth: usize,
    /// Whether a name was used whose value is not known.
    unknown: bool,
}

type Read<T> = Result<T, ExpressionError>;

impl<'t> Reader<'t> {
    /// At the start of `text`.
    pub fn new(text: &'t str, names: &'t Names) -> Self {
        Self { text, names, at: 0, depth: 0, unknown: false }
    }

    /// The value of the whole text; nothing when it uses a name whose own value is not known.
    pub fn whole(mut self) -> Read<Option<f64>> {
        let value = self.comparison()?;
        match self.peek()? {
            (Token::End, _) => Ok((!self.unknown).then_some(value)),
            (Token::Sign(")"), at) => fail(at, "this `)` closes nothing"),
            (Token::Sign("="), at) => fail(at, "`==` compares; a single `=` has no meaning here"),
            (_, at) => fail(at, "an operator is missing before this"),
        }
    }

    fn peek(&self) -> Read<(Token<'t>, Range<usize>)> {
        token::next(self.text, self.at)
    }

    /// Takes the next token when it is one of `signs`.
    fn take(&mut self, signs: &[&str]) -> Read<Option<&'t str>> {
        match self.peek()? {
            (Token::Sign(sign), at) if signs.contains(&sign) => {
                self.at = at.end;
                Ok(Some(sign))
            }
            _ => Ok(None),
        }
    }

    fn comparison(&mut self) -> Read<f64> {
        let left = self.sum()?;
        let Some(sign) = self.take(&["<", "<=", ">", ">=", "==", "!="])? else { return Ok(left) };
        let right = self.sum()?;
        let holds = match sign {
            "<" => left < right,
            "<=" => left <= right,
            ">" => left > right,
            ">=" => left >= right,
            "==" => left == right,
            _ => left != right,
        };
        Ok(f64::from(u8::from(holds)))
    }

    fn sum(&mut self) -> Read<f64> {
        let mut value = self.product()?;
        while let Some(sign) = self.take(&["+", "-"])? {
            let next = self.product()?;
            value = if sign == "+" { value + next } else { value - next };
        }
        Ok(value)
    }

    fn product(&mut self) -> Read<f64> {
        let mut value = self.sign()?;
        while let Some(sign) = self.take(&["*", "/", "%"])? {
            let next = self.sign()?;
            value = match sign {
                "*" => value * next,
                "/" => value / next,
                _ => super::functions::modulo(value, next),
            };
        }
        Ok(value)
    }

    fn sign(&mut self) -> Read<f64> {
        let at = self.at;
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return fail(at..self.text.len(), format!("the expression is nested deeper than {MAX_DEPTH}"));
        }
        let value = if self.take(&["-"])?.is_some() { -self.sign()? } else { self.power()? };
        self.depth -= 1;
        Ok(value)
    }

    fn power(&mut self) -> Read<f64> {
        let base = self.atom()?;
        if self.take(&["^"])?.is_none() {
            return Ok(base);
        }
        Ok(fun::pow_f64(base, self.sign()?))
    }

    fn atom(&mut self) -> Read<f64> {
        let (token, at) = self.peek()?;
        match token {
            Token::Number(value) => {
                self.at = at.end;
                Ok(value)
            }
            Token::Name(name) => {
                self.at = at.end;
                self.named(name, at)
            }
            Token::Sign("(") => {
                self.at = at.end;
                let value = self.comparison()?;
                self.close(at)?;
                Ok(value)
            }
            Token::Sign(sign) => fail(at, format!("a number is missing before this `{sign}`")),
            Token::End => fail(at, "a number is missing here"),
        }
    }

    fn close(&mut self, open: Range<usize>) -> Read<()> {
        match self.take(&[")"])? {
            Some(_) => Ok(()),
            None => match self.peek()? {
                (Token::End, _) => fail(open, "this `(` is never closed"),
                (_, at) => fail(at, "expected an operator or `)` before this"),
            },
        }
    }

    fn named(&mut self, name: &str, at: Range<usize>) -> Read<f64> {
        let function = FUNCTIONS.iter().find(|function| function.name == name);
        let (_, open) = self.peek()?;
        if self.take(&["("])?.is_some() {
            let arguments = self.arguments(open)?;
            let Some(function) = function else {
                return unknown(name, at, "no function", FUNCTIONS.iter().map(|f| f.name));
            };
            return call(function, &arguments, at);
        }
        let (base, component) = name.split_once('.').map_or((name, None), |(base, inner)| (base, Some(inner)));
        match (self.names.get(base), function) {
            (Some(quantity), _) => self.quantity(quantity, base, component, at),
            (None, Some(function)) => fail(at, format!("`{name}` is a function: write {}", function.usage)),
            (None, None) => unknown(base, at, "nothing", self.names.keys().map(String::as_str)),
        }
    }

    fn quantity(&mut self, quantity: &Quantity, base: &str, component: Option<&str>, at: Range<usize>) -> Read<f64> {
        match (quantity, component) {
            (Quantity::Unknown, _) => {
                self.unknown = true;
                Ok(1.0)
            }
            (Quantity::Number(value), None) => Ok(*value),
            (Quantity::Number(_), Some(_)) => fail(at, format!("`{base}` is one number, without components")),
            (Quantity::Vector(numbers), component) => {
                let index = COMPONENTS.iter().position(|name| Some(*name) == component);
                let value = index.and_then(|index| numbers.get(index)).copied();
                value.map_or_else(|| fail(at, components(base, numbers.len())), Ok)
            }
        }
    }

    fn arguments(&mut self, open: Range<usize>) -> Read<Vec<f64>> {
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
}

/// How the numbers of a vector are written.
fn components(base: &str, count: usize) -> String {
    let mut written: Vec<String> = COMPONENTS.iter().take(count).map(|name| format!("{base}.{name}")).collect();
    let last = written.pop().unwrap_or_default();
    match written.as_slice() {
        [] => format!("`{base}` is an array of 1 number: write {last}"),
        others => format!("`{base}` is {count} numbers: write {} or {last}", others.join(", ")),
    }
}

fn call(function: &Function, arguments: &[f64], at: Range<usize>) -> Read<f64> {
    if function.takes.contains(&arguments.len()) {
        return Ok((function.call)(arguments));
    }
    let (least, most) = (function.takes.start(), function.takes.end());
    let wanted = match (*least, *most) {
        (1, 1) => "1 number".to_owned(),
        (least, most) if least == most => format!("{least} numbers"),
        (least, _) => format!("at least {least} numbers"),
    };
    fail(at, format!("`{}` takes {wanted}, not {}", function.name, arguments.len()))
}

fn fail<T>(at: Range<usize>, message: impl Into<String>) -> Read<T> {
    Err(ExpressionError { at, message: message.into(), help: None })
}

fn unknown<'n>(name: &str, at: Range<usize>, what: &str, known: impl Iterator<Item = &'n str>) -> Read<f64> {
    let known: Vec<&str> = known.collect();
    let help = closest(name, known.iter().copied()).map(did_you_mean);
    let help = help.or_else(|| (!known.is_empty()).then(|| format!("known names: {}", known.join(", "))));
    Err(ExpressionError { at, message: format!("{what} is called `{name}`"), help })
}
