//! Names that expressions refer to, with their values.

use crate::FUNCTIONS;
use crate::error::{ExpressionError, ExpressionResult, fail};
use indexmap::IndexMap;
use juggler_math::suggest::{closest, did_you_mean};
use std::ops::Range;

/// Names of the components of a vector: `ball.x`.
pub const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

/// Value of a name.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A number.
    Number(f64),
    /// One to four numbers, of which expressions use single components.
    Vector(Vec<f64>),
    /// A value that is not known because of an error that has been reported. Expressions that use
    /// it have no known value either.
    Unknown,
}

impl From<f64> for Quantity {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// Names that expressions may use, with their values, in order of insertion.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Names {
    quantities: IndexMap<String, Quantity>,
    /// Whether errors about unknown names suggest no others.
    omits_suggestions: bool,
}

impl Names {
    /// Sets the value of a name.
    pub fn insert(&mut self, name: impl Into<String>, quantity: Quantity) {
        self.quantities.insert(name.into(), quantity);
    }

    /// Omits suggestions of names from now on, since each takes the time to look at all names.
    pub fn omit_suggestions(&mut self) {
        self.omits_suggestions = true;
    }

    /// Value of a name; `None` for an unknown name.
    pub fn get(&self, name: &str) -> Option<&Quantity> {
        self.quantities.get(name)
    }

    /// Whether the name has been inserted.
    pub fn contains(&self, name: &str) -> bool {
        self.quantities.contains_key(name)
    }

    /// Number that `name` or `name.component` stands for, written at `at`. Returns `None` if the
    /// name's value is [`Quantity::Unknown`].
    pub(crate) fn number(
        &self,
        name: &str,
        component: Option<&str>,
        at: &Range<usize>,
    ) -> ExpressionResult<Option<f64>> {
        match (self.get(name), component) {
            (Some(Quantity::Unknown), _) => Ok(None),
            (Some(Quantity::Number(value)), None) => Ok(Some(*value)),
            (Some(Quantity::Number(_)), Some(_)) => {
                fail(at.clone(), format!("`{name}` is one number, without components"))
            }
            (Some(Quantity::Vector(numbers)), component) => {
                let index = COMPONENTS.iter().position(|known| Some(*known) == component);
                match index.and_then(|index| numbers.get(index)) {
                    Some(value) => Ok(Some(*value)),
                    None => fail(at.clone(), components(name, numbers.len())),
                }
            }
            (None, None) if let Some(function) = FUNCTIONS.iter().find(|function| function.name == name) => {
                fail(at.clone(), format!("`{name}` is a function: write {}", function.usage))
            }
            (None, _) => {
                let known = self.quantities.keys().map(String::as_str).filter(|_| !self.omits_suggestions);
                Err(unknown_name(name, at.clone(), "nothing", known))
            }
        }
    }
}

impl<S: Into<String>> FromIterator<(S, Quantity)> for Names {
    fn from_iter<I: IntoIterator<Item = (S, Quantity)>>(quantities: I) -> Self {
        let quantities = quantities.into_iter().map(|(name, quantity)| (name.into(), quantity)).collect();
        Self { quantities, omits_suggestions: false }
    }
}

/// Message that lists the components of a vector.
fn components(name: &str, count: usize) -> String {
    let mut written: Vec<String> =
        COMPONENTS.iter().take(count).map(|component| format!("{name}.{component}")).collect();
    let last = written.pop().unwrap_or_default();
    match written.as_slice() {
        [] => format!("`{name}` is an array of 1 number: write {last}"),
        others => format!("`{name}` is {count} numbers: write {} or {last}", others.join(", ")),
    }
}

/// Error about an unknown name, with the nearest known name or all of them.
pub(crate) fn unknown_name<'n>(
    name: &str,
    at: Range<usize>,
    what: &str,
    known: impl Iterator<Item = &'n str>,
) -> ExpressionError {
    let known: Vec<&str> = known.collect();
    let help = closest(name, known.iter().copied()).map(did_you_mean);
    let help = help.or_else(|| (!known.is_empty()).then(|| format!("known names: {}", known.join(", "))));
    ExpressionError { at, message: format!("{what} is called `{name}`"), help }
}
