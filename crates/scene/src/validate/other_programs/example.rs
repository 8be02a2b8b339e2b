//! Examples of the table. A value between `<` and `>` is a sample, which gives way to the value
//! that the user wrote: `"opacity": <0.5>`. A conversion follows `=`: `"transparency": <0.2 = 1 - x>`.
//!
//! | conversion | value |
//! |---|---|
//! | `x`, the default | the user's value |
//! | `NAME` | the value of another key beside it |
//! | `not x` | the other boolean |
//! | `{"file": x}` | an object around a value that is none itself |
//! | a formula of `x` and other keys, such as `x / 683` | number, or numbers element by element |
//! | `...` | no value: the sample's form |
//!
//! Of several conversions, joined by `or`, the first one that has a value counts.

use super::json_line::{json_line, shown};
use crate::document::{FileId, Members, Node, Value, parse};
use juggler_expression::{PointEvaluator, Program};

/// Maximum length of a user's value in a message, in bytes.
pub const MAX_VALUE: usize = 80;

/// Normalizes a word: lower case, without `_`, `-` and spaces.
pub fn plain(word: &str) -> String {
    word.chars().filter(|character| !"_- ".contains(*character)).flat_map(char::to_lowercase).collect()
}

/// What the user wrote.
#[derive(Clone, Copy, Debug)]
pub struct Written<'n> {
    /// Value of the unknown word.
    pub value: &'n Node,
    /// The object that contains the word as a key, for conversions of several values.
    pub siblings: Option<&'n Members>,
}

impl<'n> Written<'n> {
    /// Value of a name in a conversion: `x`, or a key beside it.
    fn get(&self, name: &str) -> Option<&'n Node> {
        if name == "x" {
            return Some(self.value);
        }
        let mut others = self.siblings?.iter();
        others.find_map(|(key, member)| (plain(key) == plain(name)).then_some(&member.node))
    }

    /// Whether the value says nothing: an object without members.
    fn is_empty(&self) -> bool {
        matches!(&self.value.value, Value::Object(members) if members.is_empty())
    }
}

/// Example of the correct form.
#[derive(Debug)]
pub struct Example(Vec<Part>);

#[derive(Debug)]
enum Part {
    Text(&'static str),
    Value(Sample),
}

/// Value that gives way to the user's.
#[derive(Debug)]
struct Sample {
    text: &'static str,
    /// The sample as a tree. Members of an object are an object.
    node: Node,
    /// Text of the conversions.
    conversion: &'static str,
    /// Whether the sample consists of members of an object without its braces.
    is_members: bool,
    conversions: Vec<Conversion>,
}

#[derive(Debug)]
enum Conversion {
    Same(&'static str),
    Not(&'static str),
    Inside { before: &'static str, after: &'static str },
    Formula(Program),
}

impl Example {
    /// Reads a cell of the table. Returns `None` for an invalid one.
    pub fn read(cell: &'static str) -> Option<Self> {
        let mut parts = Vec::new();
        let mut rest = cell;
        while let Some((text, marked)) = rest.split_once('<') {
            let (sample, after) = split_mark(marked)?;
            parts.extend([Part::Text(text), Part::Value(Sample::read(sample)?)]);
            rest = after;
        }
        parts.push(Part::Text(rest));
        Some(Self(parts))
    }

    /// The example with its samples.
    pub fn sample(&self) -> String {
        self.text(|_| None, |sample| sample.text.to_owned())
    }

    /// Conversions that compute a value: `1 - x`.
    pub fn computations(&self) -> impl Iterator<Item = &'static str> {
        let is_computed = |conversion: &Conversion| matches!(conversion, Conversion::Not(_) | Conversion::Formula(_));
        self.0.iter().filter_map(move |part| match part {
            Part::Value(sample) if sample.conversions.iter().any(is_computed) => Some(sample.conversion),
            _ => None,
        })
    }

    /// The example without values: `"size": [...]`.
    pub fn form(&self) -> String {
        self.text(|_| None, Sample::form)
    }

    /// The example with the user's values, and the form of all values that cannot be converted;
    /// `None` if nothing can be converted, or if the result is not right.
    pub fn converted(&self, written: Written<'_>, is_right: impl Fn(&str) -> bool) -> Option<String> {
        let convert = |sample: &Sample| sample.converted(written);
        let text = self.text(convert, Sample::form);
        let checked = self.text(convert, |sample| sample.text.to_owned());
        (text != self.form() && is_right(&checked)).then_some(text)
    }

    /// The example for what the user wrote; the sample for no value.
    pub fn advice(&self, written: Option<Written<'_>>, is_right: impl Fn(&str) -> bool) -> String {
        match written.filter(|written| !written.is_empty()) {
            Some(written) => self.converted(written, is_right).unwrap_or_else(|| self.form()),
            None => self.sample(),
        }
    }

    fn text(&self, value: impl Fn(&Sample) -> Option<String>, otherwise: impl Fn(&Sample) -> String) -> String {
        let part = |part: &Part| match part {
            Part::Text(text) => (*text).to_owned(),
            Part::Value(sample) => value(sample).unwrap_or_else(|| otherwise(sample)),
        };
        self.0.iter().map(part).collect()
    }
}

/// Splits `0.2 = if(x > 1, 1, x)>, more` behind the mark, whose formulas may contain `>`.
fn split_mark(text: &'static str) -> Option<(&'static str, &'static str)> {
    let mut depth = 0;
    for (at, character) in text.char_indices() {
        match character {
            '(' => depth += 1,
            ')' => depth -= 1,
            '>' if depth == 0 => return Some((&text[..at], &text[at + 1..])),
            _ => {}
        }
    }
    None
}

impl Sample {
    fn read(marked: &'static str) -> Option<Self> {
        let (text, conversion) = marked.split_once(" = ").unwrap_or((marked, "x"));
        let read = |text: &str| parse(text, FileId::MAIN).ok().map(|(node, _)| node);
        let members = || read(&format!("{{{text}}}"));
        let (node, is_members) = read(text).map(|node| (node, false)).or_else(|| Some((members()?, true)))?;
        let conversions = match conversion {
            "..." => Vec::new(),
            list => list.split(" or ").map(Conversion::read).collect::<Option<_>>()?,
        };
        Some(Self { text, node, conversion, is_members, conversions })
    }

    /// Text of the converted value.
    fn converted(&self, written: Written<'_>) -> Option<String> {
        let text = self.conversions.iter().find_map(|conversion| conversion.apply(written, &self.node))?;
        if self.is_members { Some(text.strip_prefix('{')?.strip_suffix('}')?.to_owned()) } else { Some(text) }
    }

    fn form(&self) -> String {
        let form = form(&self.node);
        if self.is_members { form.trim_matches(['{', '}']).to_owned() } else { form }
    }
}

/// Form of a value: the keys of objects, with `...` for all other values.
fn form(node: &Node) -> String {
    match &node.value {
        Value::Array(_) => "[...]".into(),
        Value::Object(members) => {
            let members: Vec<String> =
                members.iter().map(|(key, member)| format!("\"{key}\": {}", form(&member.node))).collect();
            format!("{{{}}}", members.join(", "))
        }
        _ => "...".into(),
    }
}

impl Conversion {
    fn read(text: &'static str) -> Option<Self> {
        let is_name = |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') && !text.is_empty();
        if text.starts_with('{') {
            let (before, after) = text.rsplit_once('x')?;
            return Some(Self::Inside { before, after });
        }
        match text.strip_prefix("not ") {
            Some(name) => Some(Self::Not(name)),
            None if is_name(text) && text.parse::<f64>().is_err() => Some(Self::Same(text)),
            None => Program::parse(text).ok().map(Self::Formula),
        }
    }

    fn apply(&self, written: Written<'_>, sample: &Node) -> Option<String> {
        match self {
            Self::Same(name) => json_line(written.get(name)?, MAX_VALUE),
            Self::Not(name) => match &written.get(name)?.value {
                Value::Bool(value) => Some((!value).to_string()),
                Value::Number(number) => Some((number.as_f64()? == 0.0).to_string()),
                _ => None,
            },
            Self::Inside { before, after } => match &written.value.value {
                Value::Object(_) => None,
                _ => Some(format!("{before}{}{after}", json_line(written.value, MAX_VALUE)?)),
            },
            Self::Formula(program) => formula(program, written, sample),
        }
    }
}

/// Result of a formula, element by element if a value has several.
fn formula(program: &Program, written: Written<'_>, sample: &Node) -> Option<String> {
    let values = program.inputs().iter().map(|input| numbers(written.get(&input.name)?));
    let values: Vec<Vec<f64>> = values.collect::<Option<_>>()?;
    let count = values.iter().map(Vec::len).chain([sample.elements().len()]).max()?.max(1);
    if values.iter().any(|value| value.len() != 1 && value.len() != count) {
        return None;
    }
    let element = |i: usize| {
        let inputs = values.iter().map(|value| value.get(i).or_else(|| value.first()).copied());
        let result = PointEvaluator::default().evaluate(program, &inputs.collect::<Option<Vec<f64>>>()?);
        result.is_finite().then(|| shown(result))
    };
    let results = (0..count).map(element).collect::<Option<Vec<String>>>()?.join(", ");
    let is_list = !sample.elements().is_empty() || values.iter().any(|value| value.len() > 1);
    Some(if is_list { format!("[{results}]") } else { results })
}

/// A number, or an array of at most four, as a vector.
fn numbers(node: &Node) -> Option<Vec<f64>> {
    let number = |node: &Node| match &node.value {
        Value::Number(number) => number.as_f64(),
        _ => None,
    };
    match &node.value {
        Value::Array(elements) if (1..=4).contains(&elements.len()) => elements.iter().map(number).collect(),
        _ => Some(vec![number(node)?]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn advice(example: &'static str, object: &str, key: &str) -> String {
        let (node, _) = parse(object, FileId::MAIN).unwrap();
        let Value::Object(members) = &node.value else { panic!("an object") };
        let written = Written { value: node.get(key).unwrap(), siblings: Some(members) };
        Example::read(example).unwrap().advice(Some(written), |text| !text.contains("\"wrong\""))
    }

    #[test]
    fn values_give_way_to_the_users_converted_values() {
        for (example, object, expected) in [
            (r#""a": <0.5>"#, r#"{"x": 0.25}"#, r#""a": 0.25"#),
            (r#""a": <0.5>"#, r#"{"x": "wrong"}"#, r#""a": ..."#),
            (r#""a": <0.2 = 1 - x>"#, r#"{"x": 0.8}"#, r#""a": 0.2"#),
            (r#""a": <0.2 = 1 - x>"#, r#"{"x": [0, 0.25, 1]}"#, r#""a": [1, 0.75, 0]"#),
            (r#""a": <0.2 = 1 - x>"#, r#"{"x": "wood"}"#, r#""a": ..."#),
            (r#""a": <[1, 1, 1] = -x / 2>"#, r#"{"x": 3}"#, r#""a": [-1.5, -1.5, -1.5]"#),
            (r#""a": <[1, 1, 1] = x>"#, r#"{"x": 3}"#, r#""a": 3"#),
            (r#""a": <false = not x>"#, r#"{"x": false}"#, r#""a": true"#),
            (r#""a": <false = not x>"#, r#"{"x": 1}"#, r#""a": false"#),
            (r#""a": <{"f": "b"} = {"f": x} or x>"#, r#"{"x": "c d"}"#, r#""a": {"f": "c d"}"#),
            (r#""a": <{"f": "b"} = {"f": x} or x>"#, r#"{"x": {"f": 1}}"#, r#""a": {"f": 1}"#),
            (r#""a": <1 = x * y_z>, "b": <2 = y_z>"#, r#"{"x": 2, "yZ": 3}"#, r#""a": 6, "b": 3"#),
            (r#""a": <1 = x * y_z>, "b": 2"#, r#"{"x": 2}"#, r#""a": ..., "b": 2"#),
            (r#""a": <1 = y or 36>, "b": <1>"#, r#"{"x": 2}"#, r#""a": 36, "b": 2"#),
            (r#""a": <60 = if(x > 4, x, degrees(x))>"#, r#"{"x": 0.5}"#, r#""a": 28.6479"#),
            (r#"{"a": {"thin": true, <"ior": 1.5>}}"#, r#"{"x": {"b": 1}}"#, r#"{"a": {"thin": true, "b": 1}}"#),
            (r#"{"a": {"thin": true, <"ior": 1.5>}}"#, r#"{"x": 4}"#, r#"{"a": {"thin": true, "ior": ...}}"#),
            (r#""a": <{"b": [1, 2], "c": {"d": "e"}} = ...>"#, r#"{"x": 4}"#, r#""a": {"b": [...], "c": {"d": ...}}"#),
            (r#""a": <{"b": 1} = x>"#, r#"{"x": {}}"#, r#""a": {"b": 1}"#),
        ] {
            assert_eq!(advice(example, object, "x"), expected, "{example} of {object}");
        }
        let long = format!(r#"{{"x": [{}]}}"#, vec!["1"; 40].join(", "));
        assert_eq!(advice(r#""a": <[1]>"#, &long, "x"), r#""a": [...]"#);
    }

    #[test]
    fn invalid_examples_are_refused() {
        for cell in [r#""a": <1"#, r#""a": <1 = 2 +>"#, r#""a": <b c>"#] {
            assert!(Example::read(cell).is_none(), "{cell}");
        }
    }
}
