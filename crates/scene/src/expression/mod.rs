//! Expressions: numbers that follow from other numbers, such as `40 * sin(2 * pi * frame / frames)`.
//!
//! ```json
//! {"translate": ["=40*sin(2*pi*frame/frames)", 0, 0]}
//! ```
//!
//! Grammar, loosest binding first; evaluated while it is read, in one pass:
//!
//! ```text
//! comparison = sum (("<" | "<=" | ">" | ">=" | "==" | "!=") sum)?        1 when true, 0 when not
//! sum        = product (("+" | "-") product)*
//! product    = sign (("*" | "/" | "%") sign)*
//! sign       = "-" sign | power
//! power      = atom ("^" sign)?                                          -2^2 = -4, 2^3^2 = 2^9
//! atom       = number | name ("." component)? | name "(" comparison ("," comparison)* ")" | "(" comparison ")"
//! ```

use indexmap::IndexMap;
use std::ops::Range;

mod functions;
mod reader;
mod token;

pub(crate) use functions::modulo;
pub use functions::{FUNCTIONS, Function};
use token::Token;

/// Longest expression, in bytes.
pub const MAX_LENGTH: usize = 4096;
/// Deepest nesting of parentheses, signs and powers.
pub const MAX_DEPTH: usize = 64;

/// The names that an expression may use, with their values.
pub type Names = IndexMap<String, Quantity>;

/// What the components of a vector are called: `ball.x`.
pub const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

/// What a name stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// A number.
    Number(f64),
    /// One to four numbers, which expressions use one by one.
    Vector(Vec<f64>),
    /// It should have a value, but a mistake has been reported: what uses it has none either.
    Unknown,
}

impl From<f64> for Quantity {
    fn from(number: f64) -> Self {
        Self::Number(number)
    }
}

/// What is wrong with an expression, and where.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub struct ExpressionError {
    /// Bytes of the expression at fault.
    pub at: Range<usize>,
    /// What is wrong.
    pub message: String,
    /// What was probably meant.
    pub help: Option<String>,
}

/// The value of an expression; always finite. Nothing when it uses a name whose own value is not known.
pub fn evaluate(text: &str, names: &Names) -> Result<Option<f64>, ExpressionError> {
    let whole = |message: String| ExpressionError { at: 0..text.len(), message, help: None };
    if text.len() > MAX_LENGTH {
        return Err(whole(format!("an expression has at most {MAX_LENGTH} characters, this one has {}", text.len())));
    }
    let Some(value) = reader::Reader::new(text, names).whole()? else { return Ok(None) };
    if value.is_finite() {
        return Ok(Some(value));
    }
    let message = if value.is_nan() {
        "the expression has no value (it is 0/0, the root of a negative number or the like)"
    } else {
        "the expression is infinite (a division by 0?)"
    };
    let help = match names.get("frame") {
        Some(Quantity::Number(frame)) => Some(format!("this happens at frame {frame}")),
        _ => None,
    };
    Err(ExpressionError { help, ..whole(message.into()) })
}

/// The names that an expression mentions, functions included and components left aside, as far as it can be read.
pub fn names_in(text: &str) -> impl Iterator<Item = &str> {
    let mut at = 0;
    std::iter::from_fn(move || {
        loop {
            match token::next(text, at).ok()? {
                (Token::End, _) => return None,
                (Token::Name(name), range) => {
                    at = range.end;
                    return Some(name.split('.').next().unwrap_or(name));
                }
                (_, range) => at = range.end,
            }
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        evaluate(text, &names(7.5)).unwrap_or_else(|e| panic!("{text}: {e}")).unwrap()
    }

    fn names(frame: f64) -> Names {
        let numbers = [("frame", frame), ("frames", 30.0), ("pi", 3.0)];
        let mut names: Names = numbers.map(|(name, value)| (name.to_owned(), Quantity::Number(value))).into();
        names.insert("ball".into(), Quantity::Vector(vec![1.0, 2.0, 3.0]));
        names.insert("broken".into(), Quantity::Unknown);
        names
    }

    fn error(text: &str) -> (Range<usize>, String, Option<String>) {
        let e = evaluate(text, &names(1.0)).expect_err(text);
        (e.at, e.message, e.help)
    }

    #[test]
    fn binds_as_in_school() {
        for (text, expected) in [
            ("1 + 2 * 3", 7.0),
            ("(1 + 2) * 3", 9.0),
            ("8 / 4 / 2", 1.0),
            ("10 - 4 - 3", 3.0),
            ("-2 ^ 2", -4.0),
            ("2 ^ 3 ^ 2", 512.0),
            ("2 ^ -1", 0.5),
            ("--3", 3.0),
            ("7 % 4 * 2", 6.0),
            ("-1 % 4", 3.0),
            ("1 + 1 == 2", 1.0),
            ("2 < 1", 0.0),
            ("if(frame >= 5, 10, 20) + 1", 11.0),
            ("2 * pi * frame / frames", 1.5),
            (".5 + 1e2 + 2.5E-1", 100.75),
        ] {
            assert_eq!(value(text), expected, "{text}");
        }
    }

    #[test]
    fn functions_have_their_known_values() {
        for (text, expected) in [
            ("sin(0) + cos(0)", 1.0),
            ("atan2(0, 1)", 0.0),
            ("hypot(3, 4)", 5.0),
            ("clamp(7, 0, 5)", 5.0),
            ("clamp(7, 5, 0)", 5.0),
            ("lerp(10, 20, 0.25)", 12.5),
            ("smoothstep(0, 2, 1)", 0.5),
            ("min(3, 1, 2) + max(3, 1, 2)", 4.0),
            ("mod(-1, 4)", 3.0),
            ("sign(-3) + sign(0) + sign(9)", 0.0),
            ("floor(-1.5) + ceil(-1.5)", -3.0),
            ("round(2.5)", 3.0),
            ("degrees(radians(90))", 90.0),
            ("sqrt(abs(-16))", 4.0),
            ("ln(exp(0))", 0.0),
            ("pow(2, 10)", 1024.0),
        ] {
            assert_eq!(value(text), expected, "{text}");
        }
    }

    #[test]
    fn says_where_and_what() {
        assert_eq!(
            error("1 + farme"),
            (4..9, "nothing is called `farme`".into(), Some("did you mean `frame`?".into()))
        );
        assert_eq!(error("sni(1)").2, Some("did you mean `sin`?".into()));
        assert_eq!(error("1 +"), (3..3, "a number is missing here".into(), None));
        assert_eq!(error("(1 + 2"), (0..1, "this `(` is never closed".into(), None));
        assert_eq!(error("1 2").0, 2..3);
        assert_eq!(error("sin(1, 2)").1, "`sin` takes 1 number, not 2");
        assert_eq!(error("sin").1, "`sin` is a function: write sin(x)");
        assert_eq!(error("1 $ 2").0, 2..3);
        assert!(error("1 / 0").1.contains("infinite"));
        assert!(error("sqrt(-1)").1.contains("no value"));
        assert!(error("").1.contains("missing"));
    }

    #[test]
    fn vectors_are_used_by_component() {
        assert_eq!(value("ball.x + 10 * ball.y + 100*ball.z"), 321.0);
        assert_eq!(error("2 * ball").1, "`ball` is 3 numbers: write ball.x, ball.y or ball.z");
        assert_eq!(error("ball.w"), (0..6, "`ball` is 3 numbers: write ball.x, ball.y or ball.z".into(), None));
        assert_eq!(error("1 + frame.x").1, "`frame` is one number, without components");
        assert_eq!(error("bll.x").2, Some("did you mean `ball`?".into()));
        assert!(error("ball.").1.contains("not a number") && error("ball.x.y").0 == (6..7));
    }

    #[test]
    fn what_uses_a_mistake_is_no_other_mistake() {
        assert_eq!(evaluate("1 / (broken.x - 1)", &names(0.0)), Ok(None));
        assert!(evaluate("broken +", &names(0.0)).is_err());
    }

    #[test]
    fn mentions_its_names() {
        assert_eq!(names_in("sin(ball.x) + 2 * frame$pi").collect::<Vec<_>>(), ["sin", "ball", "frame"]);
    }

    #[test]
    fn is_bounded() {
        for hostile in ["(".repeat(4000), "-".repeat(4000), "1^".repeat(2000), "sin(".repeat(1000), "1".repeat(5000)] {
            assert!(evaluate(&hostile, &Names::new()).is_err());
        }
        assert_eq!(value("1+".repeat(2000).trim_end_matches('+')), 2000.0);
    }
}
