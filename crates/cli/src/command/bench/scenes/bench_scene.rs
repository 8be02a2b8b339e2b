//! The scenes of the benchmark.

use super::content;
use super::files::write_file;
use crate::failure::Failure;
use juggler::scene::built_in_scenes;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// Width and height of the crop that is rendered, in pixels.
pub const CROP: u32 = 32;

/// Origin of a scene file.
#[derive(Debug)]
enum Origin {
    /// A built-in scene.
    BuiltIn(&'static str),
    /// A file of the source tree.
    File(&'static str),
    /// A function that returns the scene and writes the files that it names.
    Generated(fn(&Path) -> Result<Value, Failure>),
}

/// A scene of the benchmark.
#[derive(Debug)]
pub struct BenchScene {
    pub name: &'static str,
    pub about: &'static str,
    origin: Origin,
    /// Size of the whole picture, in pixels.
    size: [u32; 2],
    /// Center of the crop, in pixels.
    center: [u32; 2],
}

/// All scenes, in the order of the table.
pub static SCENES: [BenchScene; 7] = [
    BenchScene {
        name: "cornell",
        about: "two blocks in a box under an area light",
        origin: Origin::BuiltIn("cornell-box"),
        size: [360, 360],
        center: [180, 200],
    },
    BenchScene {
        name: "mesh-env",
        about: "a golden mesh under an environment map",
        origin: Origin::Generated(content::mesh_env),
        size: [640, 360],
        center: [320, 180],
    },
    BenchScene {
        name: "many-lights",
        about: "a room with many emissive objects",
        origin: Origin::BuiltIn("many-lights-room"),
        size: [640, 360],
        center: [320, 180],
    },
    BenchScene {
        name: "whitted-spheres",
        about: "classic ray tracing of plastic, mirrors and glass",
        origin: Origin::Generated(content::whitted_spheres),
        size: [640, 360],
        center: [320, 180],
    },
    BenchScene {
        name: "juggler",
        about: "classic ray tracing of few spheres",
        origin: Origin::BuiltIn("juggler"),
        size: [640, 360],
        center: [320, 180],
    },
    BenchScene {
        name: "room",
        about: "a glTF model, scenes/models/room.glb of the source tree",
        origin: Origin::File("scenes/models/room.glb"),
        size: [640, 360],
        center: [320, 180],
    },
    BenchScene {
        name: "textured",
        about: "textures of color, roughness and normals under an environment map",
        origin: Origin::Generated(content::textured),
        size: [640, 360],
        center: [320, 180],
    },
];

impl BenchScene {
    /// Whether the scene needs no file, or its file exists.
    pub fn exists(&self) -> bool {
        !matches!(self.origin, Origin::File(file) if !Path::new(file).is_file())
    }

    /// Path of the scene file. A scene that is no file of the source tree is written into a new
    /// folder in `folder`.
    ///
    /// # Errors
    ///
    /// Fails if a file cannot be written, or if the file of the source tree does not exist.
    pub fn prepare(&self, folder: &Path) -> Result<PathBuf, Failure> {
        let folder = folder.join(self.name);
        let create = || fs::create_dir(&folder).map_err(|error| Failure::file("create", folder.display(), &error));
        let path = folder.join("scene.json");
        let text = match self.origin {
            Origin::File(file) if self.exists() => return Ok(file.into()),
            Origin::File(file) => {
                return Err(Failure::System(format!(
                    "the scene `{}` is the file `{file}` of Juggler's source tree, which is not below the current folder",
                    self.name
                )));
            }
            Origin::BuiltIn(name) => {
                create()?;
                built_in_scenes().iter().find(|scene| scene.name == name).map_or("", |scene| scene.json).to_owned()
            }
            Origin::Generated(generate) => {
                create()?;
                generate(&folder)?.to_string()
            }
        };
        write_file(&path, text.as_bytes())?;
        Ok(path)
    }

    /// Flags of `juggler render` for the picture and its crop.
    pub fn flags(&self) -> [String; 4] {
        let [[width, height], [x, y]] = [self.size, self.center];
        let (left, top) = (x.saturating_sub(CROP / 2), y.saturating_sub(CROP / 2));
        ["--size".into(), format!("{width}x{height}"), "--crop".into(), format!("{left},{top},{CROP},{CROP}")]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::bench::scenes::files::TemporaryFolder;
    use juggler::math::hash::combine;

    /// Names and contents of all files in a folder, hashed.
    fn hash(folder: &Path) -> u32 {
        let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        let bytes = |file: &PathBuf| fs::read(file).unwrap();
        files.iter().flat_map(bytes).fold(0, |hash, byte| combine(hash, byte.into()))
    }

    #[test]
    fn names_are_unique_and_crops_lie_within_their_pictures() {
        for (i, scene) in SCENES.iter().enumerate() {
            assert!(SCENES[..i].iter().all(|other| other.name != scene.name), "{}", scene.name);
            let inside = |axis: usize| {
                let (low, high) = (CROP / 2, scene.size[axis] - CROP / 2);
                (low..=high).contains(&scene.center[axis])
            };
            assert!(inside(0) && inside(1), "{}", scene.name);
        }
    }

    #[test]
    fn scenes_are_written_alike_and_load_without_warnings() {
        let folder = TemporaryFolder::create().unwrap();
        for scene in SCENES.iter().filter(|scene| scene.exists()) {
            let path = scene.prepare(folder.path()).unwrap();
            let loaded = juggler::loader().named(path.to_str().unwrap()).unwrap();
            let settings = juggler::Settings { size: Some([16, 9]), ..juggler::Settings::default() };
            let picture = juggler::Picture::new(&loaded, &settings).unwrap();
            assert!(picture.compiled().warnings.list().is_empty(), "{}", scene.name);
            let written = folder.path().join(scene.name);
            let first = hash(&written);
            fs::remove_dir_all(&written).unwrap();
            scene.prepare(folder.path()).unwrap();
            assert_eq!(hash(&written), first, "{}", scene.name);
        }
        let path = folder.path().to_owned();
        drop(folder);
        assert!(!path.exists(), "the temporary folder is left");
    }
}
