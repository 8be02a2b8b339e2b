//! Families of kinds, and the files and lines that add a kind to each.

use std::fs;
use std::path::{Path, PathBuf};

/// A new kind, copied from an existing one under other names.
pub struct Addition {
    pub family: &'static str,
    /// Folder of the family, relative to the root of the source.
    pub folder: &'static str,
    /// File to copy, and name of the copy; `None` takes the source [`TRI`].
    pub files: (Option<&'static str>, &'static str),
    /// Words to replace in the copy.
    pub words: &'static [(&'static str, &'static str)],
    /// Line that declares the module, with its file.
    module: (&'static str, &'static str),
    /// Line that lists the kind, with its file, which is in `folder` unless its path begins with
    /// `crates`.
    entry: (&'static str, &'static str),
    /// JSON of the old and of the new kind in [`SCENE`].
    pub in_json: Option<(&'static str, &'static str)>,
}

impl Addition {
    pub fn new_file(&self) -> PathBuf {
        Path::new(self.folder).join(self.files.1)
    }

    /// Lines to add to existing files, with the files.
    pub fn pages(&self) -> Vec<(PathBuf, String)> {
        let place = |file: &str| match file.starts_with("crates/") {
            true => PathBuf::from(file),
            false => Path::new(self.folder).join(file),
        };
        [self.module, self.entry].map(|(file, line)| (place(file), line.to_owned())).to_vec()
    }

    /// Source of the new kind.
    pub fn source(&self, root: &Path) -> String {
        let Some(copied) = self.files.0 else { return TRI.to_owned() };
        let mut text = fs::read_to_string(root.join(self.folder).join(copied)).unwrap();
        for (before, after) in self.words {
            text = replace_word(&text, before, after);
        }
        text
    }
}

/// Replaces a word where it is not part of a longer one.
fn replace_word(text: &str, before: &str, after: &str) -> String {
    let is_part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    let mut parts = text.split(before);
    let mut result = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let is_word = !is_part(result.chars().last()) && !is_part(part.chars().next());
        result.push_str(if is_word { after } else { before });
        result.push_str(part);
    }
    result
}

pub const FAMILIES: &[Addition] = &[
    Addition {
        family: "shape",
        folder: "crates/shape/src",
        files: (Some("disk.rs"), "slab.rs"),
        // Its solid angle is still that of a disk.
        words: &[("Disk", "Slab"), ("disk", "slab"), ("SolidAngleShape::Slab", "SolidAngleShape::Disk")],
        module: ("lib.rs", "mod slab; <- mod disk;"),
        entry: ("lib.rs", "slab::Slab, <- disk::Disk,"),
        in_json: Some(("\"disk\"", "\"slab\"")),
    },
    Addition {
        family: "lobe",
        folder: "crates/bsdf/src",
        files: (Some("lambert.rs"), "powder.rs"),
        words: &[("Lambert", "Powder")],
        module: ("lib.rs", "pub mod powder; <- pub mod lambert;"),
        entry: ("lib.rs", "powder::Powder, <- lambert::Lambert,"),
        in_json: None,
    },
    Addition {
        family: "material",
        folder: "crates/material/src",
        files: (Some("diffuse.rs"), "chalk.rs"),
        words: &[("Diffuse", "Chalk"), ("CompiledDiffuse", "CompiledChalk"), ("Lambert", "Powder")],
        module: ("lib.rs", "mod chalk; <- mod diffuse;"),
        entry: ("lib.rs", "chalk::Chalk, <- diffuse::Diffuse,"),
        in_json: Some(("\"diffuse\"", "\"chalk\"")),
    },
    Addition {
        family: "texture",
        folder: "crates/texture/src",
        files: (Some("constant.rs"), "plain.rs"),
        words: &[("Constant", "Plain"), ("CompiledConstant", "CompiledPlain")],
        module: ("lib.rs", "mod plain; <- mod constant;"),
        entry: ("lib.rs", "plain::Plain, <- constant::Constant,"),
        in_json: Some(("\"constant\"", "\"plain\"")),
    },
    Addition {
        family: "light",
        folder: "crates/light/src",
        files: (Some("directional.rs"), "sunbeam.rs"),
        words: &[("Directional", "Sunbeam")],
        module: ("lib.rs", "mod sunbeam; <- mod directional;"),
        entry: ("lib.rs", "sunbeam::Sunbeam, <- directional::Directional,"),
        in_json: Some(("\"directional\"", "\"sunbeam\"")),
    },
    Addition {
        family: "background",
        folder: "crates/light/src/background",
        files: (Some("solid.rs"), "paper.rs"),
        words: &[("Solid", "Paper")],
        module: ("mod.rs", "mod paper; <- mod solid;"),
        entry: ("mod.rs", "paper::Paper, <- solid::Solid,"),
        in_json: Some(("\"solid\"", "\"paper\"")),
    },
    Addition {
        family: "camera",
        folder: "crates/camera/src",
        files: (Some("orthographic.rs"), "parallel.rs"),
        words: &[("Orthographic", "Parallel")],
        module: ("lib.rs", "mod parallel; <- mod orthographic;"),
        entry: ("lib.rs", "parallel::Parallel, <- orthographic::Orthographic,"),
        in_json: Some(("\"orthographic\"", "\"parallel\"")),
    },
    Addition {
        family: "sampler",
        folder: "crates/camera/src/sampler",
        files: (Some("independent.rs"), "random.rs"),
        words: &[("Independent", "Random"), ("IndependentPoints", "RandomPoints")],
        module: ("mod.rs", "mod random; <- mod independent;"),
        entry: ("mod.rs", "random::Random => RandomPoints, <- independent::Independent =>"),
        in_json: Some(("\"independent\"", "\"random\"")),
    },
    Addition {
        family: "filter",
        folder: "crates/camera/src/film/filter",
        files: (Some("mitchell.rs"), "notch.rs"),
        words: &[("Mitchell", "Notch")],
        module: ("mod.rs", "mod notch; <- mod mitchell;"),
        entry: ("mod.rs", "notch::Notch, <- mitchell::Mitchell,"),
        in_json: Some(("\"mitchell\"", "\"notch\"")),
    },
    Addition {
        family: "integrator",
        folder: "crates/integrator/src",
        files: (Some("albedo.rs"), "flat.rs"),
        words: &[("Albedo", "Flat")],
        module: ("lib.rs", "mod flat; <- mod albedo;"),
        entry: ("lib.rs", "flat::Flat, <- albedo::Albedo,"),
        in_json: None,
    },
    Addition {
        family: "mesh format",
        folder: "crates/mesh/src",
        files: (None, "tri.rs"),
        words: &[],
        module: ("lib.rs", "mod tri; <- mod text;"),
        entry: ("formats.rs", "&crate::tri::Tri, <- &Ply,"),
        in_json: Some(("mesh.obj", "mesh.tri")),
    },
    Addition {
        family: "model format",
        folder: "crates/import/src",
        files: (Some("stl.rs"), "solids.rs"),
        words: &[("StlFormat", "SolidsFormat"), ("STL.extension", "\"solids\"")],
        module: ("lib.rs", "pub mod solids; <- pub mod obj;"),
        entry: ("crates/juggler/src/formats.rs", "&juggler_import::solids::SolidsFormat, <- &ObjFormat,"),
        in_json: Some(("two.stl", "two.solids")),
    },
];

/// Lines, with their files, that add the flag `--calm` to `juggler render`, which acts as
/// `--quiet`.
pub const FLAG: &[(&str, &str)] = &[
    ("crates/cli/src/flags/table.rs", "flag(\"calm\", OUTPUT), <- flag(\"quiet\", OUTPUT),"),
    ("crates/cli/src/args.rs", "#[arg(long)] <- pub quiet: bool,"),
    ("crates/cli/src/args.rs", "pub calm: bool, <- #[arg(long)]\n"),
    (
        "crates/cli/src/plan.rs",
        "let args = RenderArgs { quiet: args.quiet || args.calm, ..args }; <- pub fn new(args: RenderArgs)",
    ),
];

/// Lines, with their files, that add an edit that acts as `Edit::Reset`.
pub const EDIT: &[(&str, &str)] = &[
    ("crates/session/src/edit.rs", "Restart, <-     Reset,"),
    ("crates/session/src/wire.rs", "Restart, <-         Reset,"),
    ("crates/session/src/apply.rs", "Edit::Restart => Ok(EditEffect::build(self.reset())), <- Edit::Reset =>"),
    ("crates/serve/src/edits.rs", "Edit::Restart => Ok(()), <- Edit::Bookmark(name) => short(name),"),
];

/// A scene with one kind of each family.
pub const SCENE: &str = r#"{
    "version": 1,
    "render": {"size": [64, 48], "samples": 4, "integrator": INTEGRATOR, "sampler": "independent", "filter": "mitchell"},
    "camera": {"orthographic": {"eye": [2, 3, 4], "look_at": [0, 0, 0], "height": 4}},
    "background": {"solid": {"color": [0.2, 0.3, 0.4]}},
    "lights": [{"directional": {"direction": [-1, -2, -1]}}],
    "textures": {"red": {"constant": {"color": [0.8, 0.2, 0.1]}}},
    "materials": {"floor": {"diffuse": {"reflectance": "red"}}, "white": {"diffuse": {}}},
    "objects": [
        {"shape": {"disk": {"radius": 2}}, "material": "floor"},
        {"shape": {"mesh": {"file": "mesh.obj"}}, "transform": [{"translate": [0, 0.7, 0]}], "material": "white"},
        {"model": {"file": "two.stl"}, "transform": [{"translate": [-1, 0.2, 0]}]}
    ]
}"#;

/// A mesh format with nine numbers per triangle.
const TRI: &str = r#"//! Triangles as text: nine numbers each.

use crate::format::{MeshFormat, MeshFormatInfo};
use crate::pieces::PieceReader;
use crate::sampling::{Counts, FileSampler};
use crate::{MeshErrorKind, MeshFile, MeshLimits};
use juggler_math::Vec3;
use juggler_shape::MeshData;
use std::io;

/// Triangles as text.
pub(crate) struct Tri;

impl MeshFormat for Tri {
    fn info(&self) -> MeshFormatInfo {
        MeshFormatInfo { name: "TRI", extension: "tri", is_z_up: false }
    }

    fn is_content(&self, _bytes: &[u8]) -> bool {
        false
    }

    fn read(&self, bytes: &[u8], _limits: &MeshLimits, _pieces: PieceReader<'_>) -> Result<MeshFile, MeshErrorKind> {
        let words = String::from_utf8_lossy(bytes);
        let numbers: Vec<f32> = words.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let mut mesh = MeshData::default();
        for corners in numbers.chunks_exact(9) {
            let first = mesh.positions.len() as u32;
            mesh.positions.extend(corners.chunks_exact(3).map(Vec3::from_slice));
            mesh.triangles.push([first, first + 1, first + 2]);
        }
        Ok(MeshFile { mesh, ..MeshFile::default() })
    }

    fn counts(&self, file: &mut FileSampler) -> io::Result<Counts> {
        Ok(Counts::of_facets(file.size / 18))
    }
}
"#;
