//! One function per reader, which accepts arbitrary bytes and returns. Every panic is a bug of the
//! reader.

use crate::streams::{FILTERS, MESHOPT_HEAD, MODES};
use crate::{models, obj};
use juggler::film::{Merge, MergeGoal, PartialRender};
use juggler::imaging::{self, Limits, decode, decode_raster, inspect_raster};
use juggler::light::IesProfile;
use juggler::memory::Memory;
use juggler::mesh::{MeshLimits, parse};
use juggler::scene::Scene;
use juggler::scene::model::{ModelChoice, ModelFormat};
use juggler::{AovSet, Settings};
use juggler_expression::{Names, PointEvaluator, Program, Quantity};
use juggler_import::gltf::document::ComponentType;
use juggler_import::gltf::draco::{self, DracoAttribute, DracoLimits};
use juggler_import::gltf::ktx2::{self, Ktx2Error};
use juggler_import::gltf::meshopt;
use juggler_import::stl::StlFormat;
use juggler_math::Rgb;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

/// Maximum number of pixels that an image may claim.
const MAX_PIXELS: u64 = 1 << 22;
/// Memory budget of a scene, in bytes.
const SCENE_BYTES: u64 = 512 << 20;

/// A reader under test.
pub struct Target {
    /// Name of the reader.
    pub name: &'static str,
    /// Passes bytes to the reader; returns whether it accepts them.
    pub read: fn(&[u8]) -> bool,
}

/// All readers.
pub const TARGETS: [Target; 24] = [
    Target { name: "scene", read: scene },
    Target { name: "expression", read: expression },
    Target { name: "obj", read: |bytes| mesh("a.obj", bytes) & obj::read_model(bytes) },
    Target { name: "mtl", read: obj::read_library },
    Target { name: "ply", read: |bytes| mesh("a.ply", bytes) },
    Target { name: "stl", read: |bytes| mesh("a.stl", bytes) & stl_model(bytes) },
    Target { name: "png", read: picture },
    Target { name: "jpeg", read: picture },
    Target { name: "exr", read: picture },
    Target { name: "hdr", read: picture },
    Target { name: "pfm", read: picture },
    Target { name: "webp", read: picture },
    Target { name: "tiff", read: picture },
    Target { name: "tga", read: |bytes| picture_named("fuzz.tga", bytes) },
    Target { name: "bmp", read: picture },
    Target { name: "gif", read: picture },
    Target { name: "ies", read: ies },
    Target { name: "jfilm", read: part },
    Target { name: "message", read: message },
    Target { name: "meshopt", read: meshopt_stream },
    Target { name: "draco", read: draco_stream },
    Target { name: "ktx2", read: ktx2_file },
    Target { name: "gltf", read: |bytes| models::read("a.gltf", bytes) },
    Target { name: "glb", read: |bytes| models::read("a.glb", bytes) },
];

/// Reader of this name.
pub fn by_name(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}

/// Whether the estimated memory of a scene is within the budget, so that it may be compiled.
pub fn is_affordable(scene: &Scene, settings: &Settings) -> bool {
    Memory::estimate(scene, settings).is_ok_and(|memory| memory.fit(SCENE_BYTES, 1).is_ok())
}

fn scene(bytes: &[u8]) -> bool {
    let Ok(scene) = Scene::from_json(String::from_utf8_lossy(bytes), "fuzz.json") else { return false };
    let settings = Settings { size: Some([8, 8]), samples: Some(1), ..Settings::default() };
    is_affordable(&scene, &settings) && scene.at_frame(1.5).is_ok() && scene.compile().is_ok()
}

fn expression(bytes: &[u8]) -> bool {
    let numbers = [("frame", 7.25), ("pi", std::f64::consts::PI)].map(|(name, value)| (name, value.into()));
    let vector = ("v", Quantity::Vector(vec![1.0, -2.0, 0.5]));
    let names: Names = numbers.into_iter().chain([vector]).collect();
    let program = Program::compile(&String::from_utf8_lossy(bytes), &names);
    let value = program.and_then(|program| PointEvaluator::default().value(&program, &names));
    value.as_ref().is_ok_and(|value| {
        assert!(value.is_none_or(f64::is_finite), "an expression has the value {value:?}");
        true
    })
}

fn mesh(name: &str, bytes: &[u8]) -> bool {
    let Ok(found) = parse(Path::new(name), bytes, &MeshLimits::default()) else { return false };
    let count = found.mesh.positions.len();
    assert!(found.mesh.triangles.iter().flatten().all(|index| (*index as usize) < count), "an index is out of range");
    assert!(found.mesh.positions.iter().all(|position| position.is_finite()), "a position is not finite");
    true
}

/// Reads an STL as a model, which must accept what the reader of meshes accepts.
fn stl_model(bytes: &[u8]) -> bool {
    let plain = parse(Path::new("a.stl"), bytes, &MeshLimits::default());
    let opened = StlFormat.open("a.stl", bytes.to_vec(), &BTreeMap::new());
    assert_eq!(plain.is_ok(), opened.is_ok(), "the readers disagree about the file");
    let (Ok(plain), Ok(model)) = (plain, opened) else { return false };
    let summary = model.summary(&ModelChoice::default()).ok();
    let triangles = summary.map(|summary| summary.drawn_triangles);
    assert_eq!(triangles, Some(plain.mesh.triangles.len() as u64), "solids lose triangles");
    true
}

fn picture(bytes: &[u8]) -> bool {
    picture_named("fuzz", bytes)
}

/// Reads a picture by its name, which selects the format TGA.
fn picture_named(name: &str, bytes: &[u8]) -> bool {
    let limits = Limits { max_pixels: MAX_PIXELS, ..Limits::default() };
    let image = decode(name, Cursor::new(bytes), &limits);
    let raster = decode_raster(name, Cursor::new(bytes), &limits);
    in_file_named(name, bytes, |path| (imaging::inspect(path).is_ok(), inspect_raster(path).is_ok()));
    for error in [image.as_ref().err(), raster.as_ref().err()].into_iter().flatten() {
        let message_text = error.to_string();
        assert!(
            message_text.starts_with(&format!("cannot read `{name}`: ")) && !message_text.contains(['{', '\u{1b}']),
            "no plain words: {message_text}"
        );
    }
    image.is_ok() || raster.is_ok()
}

fn ies(bytes: &[u8]) -> bool {
    IesProfile::parse(&String::from_utf8_lossy(bytes)).is_ok()
}

fn part(bytes: &[u8]) -> bool {
    in_file(bytes, |path| {
        let Ok(part) = PartialRender::open(path) else { return false };
        let is_whole = part.verify().is_ok();
        let _ = AovSet::from_description(&part.description().aovs);
        let _ = Merge::open(&[path], MergeGoal::PartialRender);
        let Ok(merge) = Merge::open(&[path], MergeGoal::Whole) else { return is_whole };
        merge.rows(|_: &[Rgb]| Ok::<(), juggler::film::PartialRenderError>(())).is_ok()
    })
}

fn message(bytes: &[u8]) -> bool {
    juggler_serve::is_allowed(&String::from_utf8_lossy(bytes))
}

fn meshopt_stream(bytes: &[u8]) -> bool {
    let Some((head, stream)) = bytes.split_first_chunk::<MESHOPT_HEAD>() else { return false };
    let [mode, filter, stride @ .., a, b, c, d] = *head;
    let (mode, filter) = (MODES.get(usize::from(mode)), FILTERS.get(usize::from(filter)));
    let (Some(mode), Some(filter)) = (mode, filter) else { return false };
    let (stride, count) = (usize::from(u16::from_le_bytes(stride)), u32::from_le_bytes([a, b, c, d]) as usize);
    let decoded = meshopt::decode(*mode, *filter, count, stride, stream);
    decoded.is_ok_and(|bytes| {
        assert_eq!(bytes.len(), count * stride, "the result has another size");
        true
    })
}

fn draco_stream(bytes: &[u8]) -> bool {
    let (name, component) = ("POSITION", ComponentType::F32);
    let positions = DracoAttribute { name, unique_id: 0, component, components: 3 };
    let limits = DracoLimits { triangles: 1 << 20, bytes: SCENE_BYTES };
    draco::decode(bytes, &[positions], &limits).is_ok_and(|mesh| {
        assert!(mesh.indices.iter().all(|index| (*index as usize) < mesh.vertices), "an index is out of range");
        assert!(mesh.attributes.iter().all(|values| values.len() == 12 * mesh.vertices), "a vertex has no position");
        true
    })
}

fn ktx2_file(bytes: &[u8]) -> bool {
    let head = ktx2::read_head(bytes);
    match ktx2::decode(bytes, MAX_PIXELS) {
        Ok(picture) => {
            assert!(head.is_ok_and(|head| head.width == picture.width), "the head was not checked");
            true
        }
        Err(Ktx2Error::Disabled) => head.is_ok(),
        Err(_) => false,
    }
}

/// Writes the bytes to a temporary file and returns the result of `read`.
fn in_file<T: Default>(bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
    in_file_named("fuzz", bytes, read)
}

fn in_file_named<T: Default>(name: &str, bytes: &[u8], read: impl FnOnce(&Path) -> T) -> T {
    let Ok(folder) = tempfile::tempdir() else { return T::default() };
    let path = folder.path().join(name);
    if std::fs::write(&path, bytes).is_err() {
        return T::default();
    }
    read(&path)
}
