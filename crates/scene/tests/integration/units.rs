//! Units of the schema: the keyword `x-unit`.

use juggler_scene::schema::{Schema, UNIT_KEYWORD, UNITS, Unit, published};
use serde_json::{Map, Value};
use std::collections::BTreeSet;

/// Endings of field names that stand for a unit.
const ENDINGS: [(&str, &str); 7] = [
    ("degrees", "degrees"),
    ("_seconds", "seconds"),
    ("_per_second", "frames/second"),
    ("_stops", "stops"),
    ("kelvin", "K"),
    ("eye", "scene units"),
    ("look_at", "scene units"),
];

/// Calls `visit` for all objects inside a JSON value.
fn each_object<'v>(value: &'v Value, visit: &mut impl FnMut(&'v Map<String, Value>)) {
    match value {
        Value::Object(members) => {
            visit(members);
            members.values().for_each(|inner| each_object(inner, visit));
        }
        Value::Array(elements) => elements.iter().for_each(|inner| each_object(inner, visit)),
        _ => {}
    }
}

/// Names and schemas of all fields.
fn fields(schema: &Value) -> Vec<(&String, &Value)> {
    let mut fields = Vec::new();
    each_object(schema, &mut |object| {
        fields.extend(object.get("properties").and_then(Value::as_object).into_iter().flatten());
    });
    fields
}

/// Names of all units that a schema states, with repetitions.
fn stated(schema: &Value) -> Vec<&Value> {
    let mut units = Vec::new();
    each_object(schema, &mut |object| units.extend(object.get(UNIT_KEYWORD)));
    units
}

/// Whether a schema allows a number, an array of numbers or a color.
fn is_numeric(schema: &Value) -> bool {
    let target = Schema::get().follow(schema).1;
    let is = |name: &str| match &target["type"] {
        Value::Array(several) => several.iter().any(|one| one == name),
        one => one == name,
    };
    let mut branches = target["anyOf"].as_array().into_iter().flatten();
    is("number") || is("integer") || is("array") && is_numeric(&target["items"]) || branches.any(is_numeric)
}

/// Units that the name or the description of a field states.
fn said(name: &str, field: &Value) -> BTreeSet<&'static str> {
    let description = field["description"].as_str().unwrap_or_default().replace('\n', " ");
    let by_name = ENDINGS.iter().filter(|(ending, _)| name.ends_with(ending)).map(|(_, unit)| *unit);
    let by_description = UNITS.iter().filter(|unit| unit.is_stated_in(&description)).map(|unit| unit.name);
    by_name.chain(by_description).collect()
}

#[test]
fn schema_units_equal_the_list_of_units() {
    let listed: BTreeSet<&str> = UNITS.iter().map(|unit| unit.name).collect();
    assert_eq!(listed.len(), UNITS.len(), "a unit is listed twice");
    let used: BTreeSet<&str> = stated(Schema::get().root()).into_iter().filter_map(Value::as_str).collect();
    assert_eq!(used, listed, "the schema and `UNITS` differ");
}

/// A number whose name or description states a unit has it in `x-unit`, too.
#[test]
fn fields_that_speak_of_a_unit_state_it() {
    let (mut count, mut wrong) = (0, Vec::new());
    for (name, field) in fields(Schema::get().root()).into_iter().filter(|(_, field)| is_numeric(field)) {
        let said = said(name, field);
        count += said.len();
        let unit = Unit::of(field).map(|unit| unit.name);
        if !said.is_empty() && unit.is_none_or(|unit| !said.contains(unit)) {
            wrong.push(format!("`{name}` needs `x-unit` {said:?}, has {unit:?}: {}", field["description"]));
        }
    }
    assert!(count > 100, "only {count} fields speak of a unit");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Only numbers have units, and the published schema states them beside the descriptions.
#[test]
fn the_published_schema_states_the_same_units() {
    let schema = Schema::get().root();
    for (name, field) in fields(schema) {
        assert!(field.get(UNIT_KEYWORD).is_none() || is_numeric(field), "`{name}` is no number, but has a unit");
    }
    let published = published();
    let beside = |schema| fields(schema).into_iter().filter(|(_, field)| field.get(UNIT_KEYWORD).is_some()).count();
    assert_eq!(beside(&published), beside(schema));
    assert_eq!(stated(&published).len(), stated(schema).len());
}
