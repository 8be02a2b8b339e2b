//! Names, fields and types of the classes, by a small schema.

use crate::fresh::schema;
use juggler_python_types::generate;
use serde_json::{Value, json};
use std::collections::BTreeSet;

fn text(schema: &Value, name: &str) -> String {
    generate(schema).unwrap().into_iter().find(|file| file.name == name).unwrap().text
}

fn with_form(mut branches: Vec<Value>) -> Value {
    branches.push(json!({"$ref": "#/$defs/ValueForm"}));
    json!({"anyOf": branches})
}

fn object(fields: &Value, required: &[&str]) -> Value {
    with_form(vec![json!({"type": "object", "properties": fields, "required": required,
        "additionalProperties": false})])
}

/// A scene of pipes, of which there is one kind. The name of its definition is not that of the kind.
fn pipes() -> Value {
    let number = with_form(vec![json!({"type": "number", "minimum": 0}), json!({"$ref": "#/$defs/Expression"})]);
    let ends = with_form(vec![json!({"type": "array", "items": number, "minItems": 2, "maxItems": 2})]);
    let kind = |key: &str, to: &str| {
        json!({"type": "object", "properties": {key: {"$ref": format!("#/$defs/{to}")}},
            "required": [key], "additionalProperties": false})
    };
    json!({
        "type": "object",
        "properties": {"version": {"const": 1}, "pipes": {"type": "array", "items": {"$ref": "#/$defs/AnyPipe"}}},
        "$defs": {
            "ValueForm": {"oneOf": [kind("animate", "Track")]},
            "Track": object(&json!({"keys": true}), &["keys"]),
            "AnyPipe": with_form(vec![json!({"oneOf": [kind("water_pipe", "Pipe2"),
                {"type": "string", "enum": ["water_pipe"]}]})]),
            "Pipe2": object(&json!({"from": ends, "flow": number, "color": {"enum": ["red"], "type": "string"}}), &[]),
            "Expression": {"type": "string", "pattern": "^="},
        },
    })
}

#[test]
fn classes_have_the_names_of_their_kinds() {
    let module = text(&pipes(), "pipes.py");
    assert!(module.contains("class WaterPipe(Node):") && !module.contains("Pipe2"), "{module}");
    assert!(module.contains("__slots__ = (\"from_\", \"flow\", \"color\")"), "{module}");
    assert!(module.contains("_kind = \"water_pipe\"") && module.contains("_keys = {\"from_\": \"from\"}"), "{module}");
    assert!(text(&pipes(), "animate.py").contains("class Keys(Node):"));
    assert!(text(&pipes(), "scene_types.py").contains("_constants = {\"version\": 1}"));
}

#[test]
fn stubs_state_what_fields_accept_and_give() {
    let stub = text(&pipes(), "pipes.pyi");
    for line in [
        "    flow: float | Any\n",
        "        flow: t.Number | None = None,\n",
        "        from_: t.Vec2Like | None = None,\n",
        "        flow: t.Number | None = ...,\n",
    ] {
        assert!(stub.contains(line), "{line}{stub}");
    }
    assert!(stub.contains("flow (number from 0): "), "{stub}");
    assert!(text(&pipes(), "animate.pyi").contains("        self,\n        keys: Any,\n    ) -> None: ..."));
    let typing = text(&pipes(), "typing.py");
    assert!(
        typing.contains("PipeLike: TypeAlias = \"Pipe | PipeDict | Literal['water_pipe'] | ValueForm\""),
        "{typing}"
    );
}

#[test]
fn a_kind_that_is_no_object_is_an_error() {
    let mut schema = pipes();
    *schema.pointer_mut("/$defs/Pipe2").unwrap() = json!({"type": "string"});
    let error = generate(&schema).unwrap_err().to_string();
    assert_eq!(error, "the schema has no Python form: kind `water_pipe`");
}

/// A second class of one name would replace the first.
#[test]
fn names_are_unique_in_each_module() {
    for file in generate(&schema()).unwrap().iter().filter(|file| file.name.ends_with(".pyi")) {
        let classes: Vec<&str> = file.text.lines().filter(|line| line.starts_with("class ")).collect();
        let names: BTreeSet<&&str> = classes.iter().collect();
        assert!(!classes.is_empty() && names.len() == classes.len(), "{}", file.name);
    }
    let typing = text(&schema(), "typing.py");
    let types = typing.lines().filter_map(|line| line.strip_prefix("class ")?.split('(').next());
    let mut seen = BTreeSet::new();
    assert!(types.into_iter().all(|name| seen.insert(name)), "{seen:?}");
}
