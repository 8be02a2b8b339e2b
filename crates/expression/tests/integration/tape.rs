//! Contents of a tape: folded constants and joined common subexpressions.

use juggler_expression::{Binary, Op, PointEvaluator, Program, Ternary, Unary};

/// Tape in words: constants and inputs by value, operations by kind.
fn tape(text: &str) -> Vec<String> {
    let program = Program::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    let word = |op: &Op| match *op {
        Op::Constant(index) => program.constants()[usize::from(index)].to_string(),
        Op::Input(index) => program.inputs()[usize::from(index)].name.to_string(),
        Op::Unary(op, x) => format!("{op:?} {}", x.index()),
        Op::Binary(op, [x, y]) => format!("{op:?} {} {}", x.index(), y.index()),
        Op::Ternary(op, [x, y, z]) => format!("{op:?} {} {} {}", x.index(), y.index(), z.index()),
    };
    program.ops().iter().map(word).collect()
}

#[test]
fn constants_are_folded() {
    assert_eq!(tape("2 * 3 + sqrt(16)"), ["10"]);
    assert_eq!(tape("max(1, 2, 3) - -if(0, 1, 2)"), ["5"]);
    assert_eq!(tape("x + 2 * 3"), ["x", "6", "Add 0 1"]);
    assert_eq!(tape("0 / 0"), ["NaN"]);
    assert_eq!(tape("x"), ["x"]);
}

#[test]
fn folding_keeps_the_order_of_operations() {
    assert_eq!(tape("1 + x + 2"), ["x", "1", "Add 1 0", "2", "Add 2 3"]);
    assert_eq!(tape("min(x)"), ["x", "inf", "Min 1 0"]);
}

#[test]
fn common_subexpressions_are_joined() {
    assert_eq!(tape("sin(x) * sin(x)"), ["x", "Sin 0", "Multiply 1 1"]);
    assert_eq!(tape("(x % 2) + mod(x, 2) + 2"), ["x", "2", "Modulo 0 1", "Add 2 2", "Add 3 1"]);
    assert_eq!(tape("x - 0 * -1 - 0").len(), 5, "0 and -0 are two constants");
}

#[test]
fn a_tape_ends_with_its_result() {
    for text in ["x", "3", "x + 1 - (x + 1)", "if(x, y, x)", "y * (x + y)"] {
        let program = Program::parse(text).unwrap();
        let used = |index: usize| {
            program.ops().iter().any(|op| match *op {
                Op::Constant(_) | Op::Input(_) => false,
                Op::Unary(_, x) => x.index() == index,
                Op::Binary(_, operands) => operands.iter().any(|x| x.index() == index),
                Op::Ternary(_, operands) => operands.iter().any(|x| x.index() == index),
            })
        };
        let unused: Vec<usize> = (0..program.ops().len()).filter(|index| !used(*index)).collect();
        assert_eq!(unused, [program.ops().len() - 1], "{text}");
    }
}

#[test]
fn missing_inputs_evaluate_to_nan() {
    let program = Program::parse("x + y").unwrap();
    let mut evaluator = PointEvaluator::default();
    assert_eq!(evaluator.evaluate(&program, &[1.0, 2.0]), 3.0);
    assert!(evaluator.evaluate(&program, &[1.0]).is_nan());
}

#[test]
fn operations_have_known_results() {
    assert_eq!(Unary::Sign.apply(-0.0).to_bits(), (-0.0f64).to_bits());
    assert_eq!(Binary::Modulo.apply([-1.0, 4.0]), 3.0);
    assert_eq!(Ternary::If.apply([f64::NAN, 1.0, 2.0]), 1.0);
}
