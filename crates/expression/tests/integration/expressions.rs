//! Values and errors of expressions as people write them.

use juggler_expression::{ExpressionError, Names, PointEvaluator, Program, Quantity};
use std::ops::Range;

fn evaluate(text: &str, names: &Names) -> Result<Option<f64>, ExpressionError> {
    PointEvaluator::default().value(&Program::compile(text, names)?, names)
}

fn value(text: &str) -> f64 {
    evaluate(text, &names(7.5)).unwrap_or_else(|e| panic!("{text}: {e}")).unwrap()
}

fn names(frame: f64) -> Names {
    let numbers = [("frame", frame), ("frames", 30.0), ("pi", 3.0)];
    let mut names: Names = numbers.map(|(name, value)| (name, Quantity::Number(value))).into_iter().collect();
    names.insert("ball", Quantity::Vector(vec![1.0, 2.0, 3.0]));
    names.insert("broken", Quantity::Unknown);
    names
}

fn error(text: &str) -> (Range<usize>, String, Option<String>) {
    let e = evaluate(text, &names(1.0)).expect_err(text);
    (e.at, e.message, e.help)
}

#[test]
fn operators_have_the_precedence_of_mathematics() {
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
fn errors_state_position_and_cause() {
    assert_eq!(error("1 + farme"), (4..9, "nothing is called `farme`".into(), Some("did you mean `frame`?".into())));
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
fn expressions_with_an_invalid_input_report_no_second_error() {
    assert_eq!(evaluate("1 / (broken.x - 1)", &names(0.0)), Ok(None));
    assert!(evaluate("broken +", &names(0.0)).is_err());
}

#[test]
fn inputs_are_listed_once_with_their_position() {
    let program = Program::parse("sin(ball.x) + 2 * frame * ball.x + ball.y").unwrap();
    let inputs: Vec<_> = program.inputs().iter().map(|input| (&*input.name, input.component.as_deref())).collect();
    assert_eq!(inputs, [("ball", Some("x")), ("frame", None), ("ball", Some("y"))]);
    assert_eq!(program.inputs()[0].at, 4..10);
    assert!(Program::parse("sin(ball.x) + 2 * frame$pi").is_err());
}

#[test]
fn names_are_checked_at_each_evaluation() {
    let text = "2 * ball.y + frame";
    let program = Program::compile(text, &names(1.0)).unwrap();
    let mut evaluator = PointEvaluator::default();
    let mut changed = names(1.0);
    assert_eq!(evaluator.value(&program, &changed), Ok(Some(5.0)));
    for quantity in [Quantity::Number(1.0), Quantity::Vector(vec![1.0]), Quantity::Unknown] {
        changed.insert("ball", quantity);
        assert_eq!(evaluator.value(&program, &changed), evaluate(text, &changed));
    }
    let numbers: Names = [("frame", Quantity::Number(1.0))].into_iter().collect();
    assert_eq!(evaluator.value(&program, &numbers), evaluate(text, &numbers));
    assert_eq!(evaluator.value(&program, &numbers).unwrap_err().message, "nothing is called `ball`");
}

#[test]
fn the_first_error_is_reported() {
    assert_eq!(error("farme + sin(1, 2) $").0, 0..5);
    assert_eq!(error("sin(1, 2) + farme $").0, 0..3);
    assert_eq!(error("1 $ + farme").0, 2..3);
    assert_eq!(error("0 / 0 + farme").0, 8..13);
}

#[test]
fn hostile_expressions_are_bounded() {
    for hostile in ["(".repeat(4000), "-".repeat(4000), "1^".repeat(2000), "sin(".repeat(1000), "1".repeat(5000)] {
        assert!(evaluate(&hostile, &Names::default()).is_err());
    }
    assert_eq!(value("1+".repeat(2000).trim_end_matches('+')), 2000.0);
}
