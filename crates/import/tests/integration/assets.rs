//! Models of other people.
//!
//! They are in the folder `JUGGLER_ASSETS` (by default `../shared/assets` beside the workspace);
//! without it, the tests report that and pass.

use juggler_import::gltf::document::Index;
use juggler_import::gltf::{Assembly, FileError, Files, GeometryKey, Gltf, GltfData, Limits};
use juggler_math::testing::skipped;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Folder of the assets, if they are available.
pub fn assets() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets");
    let folder = std::env::var_os("JUGGLER_ASSETS").map_or_else(beside, PathBuf::from);
    if !folder.is_dir() {
        skipped(&format!("test assets: none in {}, set JUGGLER_ASSETS to their folder", folder.display()));
        return None;
    }
    Some(folder)
}

/// Files of a folder.
pub struct Folder(pub PathBuf);

impl Files for Folder {
    fn read(&self, name: &str, limit: u64) -> Result<Vec<u8>, FileError> {
        let path = self.0.join(name);
        let found = std::fs::metadata(&path).map_err(|_| FileError::Missing)?.len();
        if found > limit {
            return Err(FileError::TooLarge { found, limit });
        }
        std::fs::read(path).map_err(|error| FileError::Read(error.to_string()))
    }
}

/// All files with one of the endings, in order.
pub fn find(folder: &Path, endings: &[&str], found: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            find(&path, endings, found);
        } else if path.extension().is_some_and(|ending| endings.iter().any(|known| ending == *known)) {
            found.push(path);
        }
    }
}

fn load(path: &Path) -> GltfData {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let gltf = Gltf::open(name, std::fs::read(path).unwrap(), &Limits::default());
    let data = gltf.and_then(|gltf| gltf.load(&Folder(path.parent().unwrap().to_owned())));
    data.unwrap_or_else(|error| panic!("{error}"))
}

/// Names of the models, and numbers of their accessors, primitives, and faces of all primitives.
const MODELS: [(&str, usize, usize, usize); 26] = [
    ("AlphaBlendModeTest.glb", 45, 9, 61),
    ("AnimatedMorphCube.glb", 12, 1, 12),
    ("Avocado.gltf", 5, 1, 682),
    ("Box.glb", 3, 1, 12),
    ("Box.gltf", 3, 1, 12),
    ("BoxAnimated.glb", 10, 2, 254),
    ("BoxInterleaved.glb", 3, 1, 12),
    ("BoxVertexColors.glb", 4, 1, 12),
    ("Cameras.gltf", 2, 1, 2),
    ("ClearCoatCarPaint.glb", 4, 1, 3072),
    ("EmissiveStrengthTest.glb", 15, 6, 90),
    ("Fox.glb", 71, 1, 576),
    ("GlassVaseFlowers.glb", 8, 3, 10218),
    ("LightsPunctualLamp.gltf", 15, 3, 6000),
    ("MetalRoughSpheresNoTextures.glb", 78, 123, 1_040_409),
    ("NormalTangentTest.glb", 4, 1, 7774),
    ("OrientationTest.glb", 39, 13, 524),
    ("SimpleSkin.gltf", 7, 1, 8),
    ("SimpleSparseAccessor.gltf", 2, 1, 12),
    ("TextureCoordinateTest.glb", 19, 5, 10),
    ("TextureSettingsTest.glb", 39, 10, 72),
    ("TextureTransformTest.gltf", 4, 9, 18),
    ("TransmissionRoughnessTest.glb", 16, 9, 77792),
    ("Triangle.gltf", 2, 1, 1),
    ("UnlitTest.glb", 3, 2, 88),
    ("shaderball.glb", 8, 2, 88264),
];

#[test]
fn every_model_decodes() {
    let Some(folder) = assets() else { return };
    let mut paths = Vec::new();
    find(&folder.join("gltf"), &["gltf", "glb"], &mut paths);
    let found: Vec<(String, usize, usize, usize)> = paths
        .iter()
        .map(|path| {
            let data = load(path);
            let document = &data.gltf.document;
            let accessors = document.accessors.len();
            (0..accessors).for_each(|accessor| drop(data.numbers(Index::from(accessor as u32)).unwrap()));
            let images = document.images.len();
            let folder = Folder(path.parent().unwrap().to_owned());
            (0..images).for_each(|image| assert!(!data.image(Index::from(image as u32), &folder).unwrap().is_empty()));
            let (primitives, faces) = faces(&data);
            eprintln!("{}: {:?}", data.gltf.name, data.gltf.warnings.list());
            (data.gltf.name.clone(), accessors, primitives, faces)
        })
        .collect();
    let expected = MODELS.map(|(name, accessors, primitives, faces)| (name.to_owned(), accessors, primitives, faces));
    assert_eq!(found, expected);
}

/// Numbers of primitives and of their faces, dropped ones included. Equal primitives are assembled
/// once.
fn faces(data: &GltfData) -> (usize, usize) {
    let mut known = BTreeMap::new();
    let mut counts = Vec::new();
    for (mesh, found) in data.gltf.document.meshes.iter().enumerate() {
        for (part, primitive) in found.primitives.iter().enumerate() {
            let count = known.entry(GeometryKey::new(primitive)).or_insert_with(|| match data.assemble(mesh, part) {
                Ok(Assembly::Arrays(arrays)) => {
                    let warnings = arrays.warnings.list();
                    let dropped = warnings.iter().filter(|warning| warning.fault.message.starts_with("faces with two"));
                    arrays.faces.len() + dropped.map(|warning| warning.count as usize).sum::<usize>()
                }
                other => panic!("{}: {other:?}", data.gltf.name),
            });
            counts.push(*count);
        }
    }
    (counts.len(), counts.iter().sum())
}

#[test]
fn encodings_of_a_box_are_equal() {
    let Some(folder) = assets() else { return };
    let [binary, embedded] = ["Box/glTF-Binary/Box.glb", "Box/glTF-Embedded/Box.gltf"].map(|name| {
        let data = load(&folder.join("gltf").join(name));
        match data.assemble(0, 0) {
            Ok(Assembly::Arrays(arrays)) => arrays,
            other => panic!("{other:?}"),
        }
    });
    assert_eq!(binary, embedded);
}

#[test]
fn malformed_files_are_refused_with_their_place() {
    let Some(folder) = assets() else { return };
    let mut paths = Vec::new();
    find(&folder.join("malformed"), &["gltf", "glb"], &mut paths);
    assert!(!paths.is_empty());
    for path in paths {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let error = Gltf::open(&name, std::fs::read(&path).unwrap(), &Limits::default()).map(|_| ()).unwrap_err();
        assert!(error.to_string().starts_with(&format!("{name}: /")), "{error}");
        if name == "invalid-buffer-index.gltf" {
            let text = "invalid-buffer-index.gltf: /bufferViews/1/buffer: buffer 1 does not exist, there are 1";
            assert_eq!(error.to_string(), text);
        }
    }
}

/// Cuts of real files are refused and never a panic.
#[test]
fn cut_models_are_refused() {
    let Some(folder) = assets() else { return };
    let path = folder.join("gltf/Fox/glTF-Binary/Fox.glb");
    let bytes = std::fs::read(&path).unwrap();
    for part in 0..64 {
        let length = bytes.len() * part / 64;
        let error = Gltf::open("Fox.glb", bytes[..length].to_vec(), &Limits::default()).map(|_| ());
        assert!(error.is_err(), "{length} bytes");
    }
}
