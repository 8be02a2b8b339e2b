//! Names, fields and documentation of the classes.

use crate::fresh::schema;
use juggler_python_types::generate;
use serde_json::{Value, json};

fn text(schema: &Value, name: &str) -> String {
    generate(schema).unwrap().into_iter().find(|file| file.name == name).unwrap().text
}
