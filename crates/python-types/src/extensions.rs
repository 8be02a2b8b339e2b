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
    /// Fields that accept more than the schema has: name, and annotation in the stub.
    pub accepts: &'static [(&'static str, &'static str)],
}

/// Array of an image.
const TEXELS: (&str, &str, &str) = (
    "array",
    "t.ArrayLike",
    "Texels instead of `file`: an array of shape (height, width) or (height, width, channels), rows from \
     the top, with 1 to 4 channels: gray; gray and alpha; red, green and blue; these and alpha. Numbers of \
     the types uint8 and uint16 are encoded as in a PNG file, float16 and float32 are linear; float64 is \
     rounded to float32.",
);

/// All additions.
const EXTENSIONS: &[Extension] = &[
    Extension { base: ("_scene_methods", "SceneMethods"), ..positional("scene_types", "Scene", &[]) },
    Extension { base: ("_placement", "Placement"), ..positional("scene_types", "Object", &["shape"]) },
    Extension {
        base: ("_array_nodes", "ArrayMesh"),
        accepts: &[(
            "attributes",
            "Mapping[str, t.MeshAttributeLike | t.ArrayLike | Sequence[Any] | PerFace] | t.ValueForm",
        )],
        ..positional("shapes", "Mesh", &["file"])
    },
    Extension {
        base: ("_array_nodes", "ArrayInstances"),
        accepts: &[
            ("matrices", "Sequence[t.VectorLike | Sequence[t.VectorLike]] | t.ArrayLike | str | t.ValueForm"),
            ("attributes", "Mapping[str, t.InstanceAttributeLike | t.ArrayLike | Sequence[Any]] | t.ValueForm"),
        ],
        ..positional("scene_types", "Instances", &[])
    },
    image("textures", "Image"),
    image("backgrounds", "Environment"),
    positional("backgrounds", "Solid", &["color"]),
    positional("textures", "Constant", &["color"]),
    positional("textures", "Attribute", &["name"]),
];

const fn positional(module: &'static str, class: &'static str, positional: &'static [&'static str]) -> Extension {
    Extension { class: (module, class), base: ("_node", "Node"), positional, optional: &[], extra: &[], accepts: &[] }
}

/// A class whose file may be an array.
const fn image(module: &'static str, class: &'static str) -> Extension {
    let (base, optional): (_, &[&str]) = (("_array_nodes", "ArrayImage"), &["file"]);
    Extension { base, optional, extra: &[TEXELS], ..positional(module, class, &["file"]) }
}

/// Additions to a class.
pub fn extension(module: &str, class: &str) -> Option<&'static Extension> {
    EXTENSIONS.iter().find(|extension| extension.class == (module, class))
}
