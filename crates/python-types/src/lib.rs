//! Generator of the typed Python classes of the package `juggler`, from the published schema of the
//! scene format.
//!
//! The schema's families become one module each (`shapes`, `materials`, ...) with one class per
//! kind; the value forms become `animate`, and all other objects `scene_types`. Each module has a
//! stub (`.pyi`), and `typing` has the same types as dictionaries, for type checkers. The classes
//! hold only their fields and documentation: `Node`, which is written by hand, has the behavior.
//! Defaults appear in the documentation alone, so that a scene follows the schema's defaults.

use serde_json::Value;

mod annotations;
mod docstring;
mod extensions;
mod model;
mod names;
mod python;
mod stub;
mod typed_dicts;
mod words;

pub use model::UnknownSchema;

/// A generated file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Name in the folder of the package.
    pub name: String,
    /// Whole content.
    pub text: String,
}

/// Comment in the first line of each file.
const NOTICE: &str = "# Generated from schema/scene.schema.json by crates/python-types. Do not edit.\n";

/// Generates all files from a published schema.
///
/// # Errors
///
/// Returns an error if the schema has a part that the generator does not understand, or if two
/// classes of a module have the same name.
pub fn generate(schema: &Value) -> Result<Vec<File>, UnknownSchema> {
    let model = model::Model::new(schema)?;
    let mut files = vec![
        File { name: "_exports.py".into(), text: python::exports(&model) },
        File { name: "typing.py".into(), text: typed_dicts::module(&model) },
    ];
    for module in &model.modules {
        files.push(File { name: format!("{}.py", module.name), text: python::module(&model, module) });
        files.push(File { name: format!("{}.pyi", module.name), text: stub::module(&model, module) });
    }
    Ok(files)
}
