//! Compiled expressions against a tree walk: random expressions have the same bits.

use juggler_expression::{FUNCTIONS, Names, PointEvaluator, Program, Quantity};
use juggler_math::portable;
use juggler_math::testing::Random;
use std::fmt::Write;

/// Expression as a tree.
enum Tree {
    Number(&'static str),
    Name(&'static str, f64),
    Negate(Box<Self>),
    Operator(&'static str, Box<[Self; 2]>),
    Call(&'static str, Vec<Self>),
}

const NUMBERS: [&str; 10] = ["0", "1", "2", "0.5", "3", ".1", "1e300", "1e-300", "7.25", "2.5E-1"];
const VALUES: [(&str, f64); 6] =
    [("frame", 7.5), ("zero", 0.0), ("minus", -0.0), ("v.x", -1.25), ("v.y", 1e200), ("v.z", 3.0)];
/// Operators with the precedence of the result, the least of the left operand and that of the right
/// operand.
const OPERATORS: [(&str, [u8; 3]); 12] = [
    ("<", [0, 1, 1]),
    ("<=", [0, 1, 1]),
    (">", [0, 1, 1]),
    (">=", [0, 1, 1]),
    ("==", [0, 1, 1]),
    ("!=", [0, 1, 1]),
    ("+", [1, 1, 2]),
    ("-", [1, 1, 2]),
    ("*", [2, 2, 3]),
    ("/", [2, 2, 3]),
    ("%", [2, 2, 3]),
    ("^", [4, 5, 3]),
];
const SIGN: u8 = 3;

impl Tree {
    fn random(random: &mut Random, depth: usize) -> Self {
        if depth == 0 || random.below(8) == 0 {
            let (name, value) = VALUES[random.below(VALUES.len())];
            let number = NUMBERS[random.below(NUMBERS.len())];
            return if random.below(2) == 0 { Self::Number(number) } else { Self::Name(name, value) };
        }
        match random.below(8) {
            0 => Self::Negate(Box::new(Self::random(random, depth - 1))),
            1..=4 => {
                let (operator, _) = OPERATORS[random.below(OPERATORS.len())];
                Self::Operator(operator, Box::new([(); 2].map(|()| Self::random(random, depth - 1))))
            }
            _ => {
                let function = &FUNCTIONS[random.below(FUNCTIONS.len())];
                let count = *function.arity.start() + if function.arity.contains(&4) { random.below(4) } else { 0 };
                Self::Call(function.name, (0..count).map(|_| Self::random(random, depth - 1)).collect())
            }
        }
    }

    fn precedence(&self) -> [u8; 3] {
        match self {
            Self::Operator(operator, _) => OPERATORS.iter().find(|known| known.0 == *operator).unwrap().1,
            Self::Negate(_) => [SIGN; 3],
            _ => [5; 3],
        }
    }

    /// Writes the expression with no more parentheses than it needs where one of `least` precedence
    /// may stand.
    fn write(&self, least: u8, text: &mut String) {
        let [own, left, right] = self.precedence();
        let opens = own < least;
        text.push_str(if opens { "(" } else { "" });
        match self {
            Self::Number(written) => text.push_str(written),
            Self::Name(name, _) => text.push_str(name),
            Self::Negate(inner) => {
                text.push('-');
                inner.write(left, text);
            }
            Self::Operator(operator, operands) => {
                operands[0].write(left, text);
                let _ = write!(text, " {operator} ");
                operands[1].write(right, text);
            }
            Self::Call(name, arguments) => {
                let _ = write!(text, "{name}(");
                for (i, argument) in arguments.iter().enumerate() {
                    text.push_str(if i > 0 { ", " } else { "" });
                    argument.write(0, text);
                }
                text.push(')');
            }
        }
        text.push_str(if opens { ")" } else { "" });
    }

    fn value(&self) -> f64 {
        match self {
            Self::Number(written) => written.parse().unwrap(),
            Self::Name(_, value) => *value,
            Self::Negate(inner) => -inner.value(),
            Self::Operator(operator, operands) => operator_value(operator, operands[0].value(), operands[1].value()),
            Self::Call(name, arguments) => call_value(name, &arguments.iter().map(Self::value).collect::<Vec<f64>>()),
        }
    }
}

fn operator_value(operator: &str, x: f64, y: f64) -> f64 {
    let truth = |holds: bool| if holds { 1.0 } else { 0.0 };
    match operator {
        "+" => x + y,
        "-" => x - y,
        "*" => x * y,
        "/" => x / y,
        "%" => x - y * (x / y).floor(),
        "^" => portable::pow_f64(x, y),
        "<" => truth(x < y),
        "<=" => truth(x <= y),
        ">" => truth(x > y),
        ">=" => truth(x >= y),
        "==" => truth(x == y),
        "!=" => truth(x != y),
        _ => panic!("no operator is written {operator}"),
    }
}

fn call_value(name: &str, arguments: &[f64]) -> f64 {
    let clamp = |x: f64, a: f64, b: f64| x.max(a.min(b)).min(a.max(b));
    match (name, arguments) {
        ("min", all) => all.iter().copied().fold(f64::INFINITY, f64::min),
        ("max", all) => all.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        (name, [x]) => function_value(name, *x),
        ("atan2", [y, x]) => portable::atan2_f64(*y, *x),
        ("hypot", [x, y]) => (x * x + y * y).sqrt(),
        ("pow", [x, y]) => portable::pow_f64(*x, *y),
        ("mod", [x, y]) => x - y * (x / y).floor(),
        ("clamp", [x, a, b]) => clamp(*x, *a, *b),
        ("lerp", [a, b, t]) => a + (b - a) * t,
        ("smoothstep", [a, b, x]) => {
            let t = clamp((x - a) / (b - a), 0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }
        ("if", [condition, then, otherwise]) => {
            if *condition != 0.0 {
                *then
            } else {
                *otherwise
            }
        }
        _ => panic!("no function is called {name}"),
    }
}

fn function_value(name: &str, x: f64) -> f64 {
    match name {
        "sin" => portable::sin_f64(x),
        "cos" => portable::cos_f64(x),
        "tan" => portable::tan_f64(x),
        "asin" => portable::asin_f64(x),
        "acos" => portable::acos_f64(x),
        "atan" => portable::atan2_f64(x, 1.0),
        "radians" => x.to_radians(),
        "degrees" => x.to_degrees(),
        "sqrt" => x.sqrt(),
        "exp" => portable::exp_f64(x),
        "ln" => portable::ln_f64(x),
        "abs" => x.abs(),
        "sign" if x == 0.0 || x.is_nan() => x,
        "sign" => x.signum(),
        "floor" => x.floor(),
        "ceil" => x.ceil(),
        "round" => x.round(),
        _ => panic!("no function of one number is called {name}"),
    }
}

fn names() -> Names {
    let vector = Quantity::Vector(VALUES.iter().filter(|(name, _)| name.starts_with("v.")).map(|v| v.1).collect());
    let numbers = VALUES.iter().filter(|(name, _)| !name.contains('.')).map(|(name, value)| (*name, (*value).into()));
    numbers.chain([("v", vector)]).collect()
}

#[test]
fn compiled_expressions_equal_tree_evaluation_bit_for_bit() {
    const COUNT: usize = 20_000;
    let (mut random, names, mut evaluator) = (Random::new(61), names(), PointEvaluator::default());
    let (mut finite, mut longest) = (0, 0);
    for _ in 0..COUNT {
        let depth = random.below(7);
        let tree = Tree::random(&mut random, depth);
        let mut text = String::new();
        tree.write(0, &mut text);
        if text.len() > juggler_expression::MAX_LENGTH {
            continue;
        }
        let program = Program::compile(&text, &names).unwrap_or_else(|error| panic!("{text}: {error}"));
        let expected = tree.value();
        match evaluator.value(&program, &names) {
            Ok(value) => {
                assert_eq!(value.map(f64::to_bits), Some(expected.to_bits()), "{text}: {value:?}, not {expected}");
                finite += 1;
            }
            Err(error) => {
                assert!(!expected.is_finite(), "{text}: {error}, not {expected}");
                let says_infinite = error.message.contains("infinite");
                assert_eq!((error.at, says_infinite), (0..text.len(), expected.is_infinite()), "{text}");
            }
        }
        longest = longest.max(program.ops().len());
    }
    assert!(finite > COUNT / 3 && longest > 40, "{finite} finite values, {longest} operations at most");
}
