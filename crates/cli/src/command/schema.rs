//! `juggler schema`: the JSON Schema of the scene format.

use crate::console;
use crate::failure::Failure;

/// Prints it.
pub fn run() -> Result<(), Failure> {
    console::print(&juggler::scene::schema_json())
}
