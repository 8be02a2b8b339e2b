//! `juggler schema`: the JSON Schema of the scene format.

use crate::console;
use crate::failure::Failure;

/// Prints the schema.
pub fn run() -> Result<(), Failure> {
    console::print_result(&juggler::scene::schema_json())
}
