//! Parts of the classes that the schema does not determine.

/// Additions to a generated class.
#[derive(Debug)]
pub struct Extension {
    /// Module and name of the class.
    pub class: (&'static str, &'static str),
    /// Module and name of the base class: `Node`, or a class written by hand that derives from it.
    pub base: (&'static str, &'static str),
    /// Fields that may also be positional arguments. Without an entry, required fields may, if
    /// there are at most two.
    pub positional: &'static [&'static str],
    /// Fields that the schema requires and the class does not, because an extra field replaces them.
    pub optional: &'static [&'static str],
    /// Fields of the base class: name, annotation in the stub, and description. The base class
    /// lists them in its `__slots__`.
    pub extra: &'static [(&'static str, &'static str, &'static str)],
}

/// All additions.
const EXTENSIONS: &[Extension] = &[
    Extension { base: ("_scene_methods", "SceneMethods"), ..positional("scene_types", "Scene", &[]) },
    Extension { base: ("_placement", "Placement"), ..positional("scene_types", "Object", &["shape"]) },
    positional("shapes", "Mesh", &["file"]),
    positional("backgrounds", "Solid", &["color"]),
    positional("textures", "Constant", &["color"]),
    positional("textures", "Attribute", &["name"]),
];

const fn positional(module: &'static str, class: &'static str, positional: &'static [&'static str]) -> Extension {
    Extension { class: (module, class), base: ("_node", "Node"), positional, optional: &[], extra: &[] }
}

/// Additions to a class.
pub fn extension(module: &str, class: &str) -> Option<&'static Extension> {
    EXTENSIONS.iter().find(|extension| extension.class == (module, class))
}
