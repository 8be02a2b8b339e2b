//! Valid files for every reader, made by the program's own writers where they exist.

use crate::{models, obj, streams};
use juggler::film::{self, RenderDescription, ShardDescription};
use juggler::imaging::{CropFrame, Destination, ExrCompression, Header, ImageFormat, Options, SampleDepth, writer};
use juggler::math::{Image, Rgb};
use juggler::prelude::{Object, Scene, Settings, Sphere};
use juggler::render::Control;
use juggler::scene::built_in_scenes;
use juggler::{Aov, Picture, RenderOrigin};
use juggler_math::testing::Random;
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::sync::{Arc, Mutex, PoisonError};

const OBJ: &str = "# x\nmtllib a\no b\nv 0 0 0 1 0 0\nv 1e0 0 0\nv 1 1 .5\nv 0 1 0\nv .5 .5 0\nvt 0 0\nvt 1 0\nvt 1 1\n\
                   vn 0 0 1\nvn 0 1 0\nusemtl c\ns 1\nf 1 2 3\nf 1/1 2/2 3/3 4/1\nf 1//1 2//1 \\\n -1//2\nf -5/-3/-2 2/2/1 5/1/1 4/3/2\nl 1 2\n";

const STRIPS: &str = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
    element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 1 2 3\n";
const WEDGES: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n\
    0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 .5 1\n3 2 1 0 6 0 0 1 0 .5 .25\n";
const PLY: &str = "ply\nformat ascii 1.0\ncomment c\nelement face 2\nproperty list uchar int vertex_indices\nproperty uchar red\n\
                   element vertex 4\nproperty float x\nproperty double y\nproperty short z\nproperty float nx\nproperty float ny\n\
                   property float nz\nend_header\n4 0 1 2 3 9\n3 2 1 0 9\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n";
const ATTRIBUTES: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
    property float attribute.a.1\nproperty float attribute.a.0\nproperty uchar attribute.b%20c\nelement face 1\n\
    property list uchar int vertex_indices\nproperty ushort attribute.d\nend_header\n\
    0 0 0 .5 2 0\n1 0 0 1e3 -2 255\n0 1 0 7 8 9\n3 0 1 2 65535\n";

const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
                   facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1e0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

const IES: &str = "IESNA:LM-63-2002\n[TEST] a\nTILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8\n1 1000 1.5 3 2 1 2 0.1 0.2 0\n1.0 1.0 100\n\
                   0 45 90\n0 90\n100 80 5\n90 70 4\n";

const EXPRESSIONS: [&str; 5] = [
    "2*pi*frame/30 + v.x",
    "-(sin(frame) ^ 2 ^ -1) % 3",
    "clamp(v.y, 0, 1) + min(1, max(2, 3))",
    "((((1.5e-3))))",
    "(frame >= 2) * (v.z < 1)",
];

const MESSAGES: [&str; 7] = [
    r#"{"ack": 7}"#,
    r#"{"steer": true}"#,
    r#"{"probe": [3, 4]}"#,
    r#"{"edit": {"zoom": 1.5}}"#,
    r#"{"edit": {"setting": {"size": [64, 36]}}}"#,
    r#"{"edit": {"set": {"path": "/materials/red/phong/diffuse", "value": [1, 0, 0]}}}"#,
    r#"{"edit": {"look": {"perspective": {"eye": [0, 1, 5], "look_at": [0, 0, 0]}}}}"#,
];

/// A scene that uses much of the format.
const SCENE: &str = r##"{"version": 1, "title": "a", "animation": {"frames": 30, "frames_per_second": 25},
 "variables": {"phi": "2*pi*frame/frames", "s": "(1+cos(phi))/2"},
 "render": {"size": [64, 36], "samples": 2, "integrator": {"path": {"max_depth": 3}}, "filter": "tent"},
 "cameras": {"main": {"perspective": {"eye": [0, 2, "=6+s"], "look_at": [0, 1, 0], "vertical_fov_degrees": 40}}},
 "textures": {"board": {"checker": {"size": 0.5, "even": "#ffffff", "odd": [0, 0, 0]}}},
 "materials": {"red": {"phong": {"diffuse": "board"}}, "two": {"checkerboard": {"even": "red", "odd": {"phong": {}}}}},
 "lights": [{"point": {"position": [4, 6, 4], "intensity": 60}}],
 "groups": {"pair": [{"shape": "sphere"}, {"shape": {"cuboid": {}}, "material": "two"}]},
 "objects": [{"group": "pair", "transform": [{"scale": 2}, {"rotate": {"axis": [0, 1, 0], "degrees": "=30*s"}}]},
  {"shape": {"sphere": {"radius": {"animate": {"keys": [[0, 1], [2, 2, "in_out"]], "repeat": "loop"}}}}},
  {"chain": {"from": {"center": [0, 0, 0], "radius": 1}, "to": {"center": [0, 5, 0], "radius": 2}, "count": 8}}]}"##;

/// Valid files for the reader of this name; empty if there is no such reader or format.
pub fn for_target(target: &str) -> Vec<Vec<u8>> {
    let texts = |texts: &[&str]| texts.iter().map(|text| text.as_bytes().to_vec()).collect::<Vec<_>>();
    match target {
        "scene" => scenes(),
        "expression" => texts(&EXPRESSIONS),
        "obj" => texts(&[OBJ]),
        "mtl" => texts(&obj::LIBRARIES),
        "ply" => [texts(&[PLY, STRIPS, WEDGES, ATTRIBUTES]), vec![binary_ply()]].concat(),
        "stl" => [texts(&[STL]), vec![binary_stl()]].concat(),
        "ies" => texts(&[IES]),
        "message" => texts(&MESSAGES),
        "jfilm" => parts(),
        "meshopt" => streams::meshopt(),
        "draco" => streams::draco(),
        "ktx2" => streams::ktx2(),
        "gltf" => models::texts(),
        "glb" => models::binaries(),
        "tiff" | "tga" | "bmp" | "gif" => foreign_pictures(target),
        other => pictures(other),
    }
}

/// Pictures in formats that the program does not write, by Pillow and libtiff.
fn foreign_pictures(target: &str) -> Vec<Vec<u8>> {
    macro_rules! files {
        ($($name:literal),*) => { vec![$(include_bytes!(concat!("../../imaging/tests/pictures/", $name)).to_vec()),*] };
    }
    match target {
        "tiff" => files!(
            "rgb-lzw.tif",
            "rgb-deflate.tif",
            "rgb-packbits.tif",
            "rgba.tif",
            "gray-alpha.tif",
            "palette.tif",
            "bit.tif",
            "gray16.tif",
            "float.tif",
            "pages.tif",
            "turned.tif",
            "cmyk.tif"
        ),
        "tga" => files!("rgb.tga", "rgba-runs.tga", "gray-alpha-runs.tga", "gray.tga", "palette-runs.tga"),
        "bmp" => files!("rgb.bmp", "rgba.bmp", "palette.bmp", "bit.bmp"),
        _ => files!("palette.gif", "interlaced.gif", "transparent.gif", "movie.gif"),
    }
}

fn scenes() -> Vec<Vec<u8>> {
    let small = built_in_scenes().iter().filter(|scene| scene.json.len() < 3000).map(|scene| scene.json);
    small.chain([SCENE]).map(|text| text.as_bytes().to_vec()).collect()
}

fn binary_ply() -> Vec<u8> {
    let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        element face 2\nproperty list uint uint vertex_index\nend_header\n"
        .to_vec();
    let positions = [[0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    bytes.extend(positions.iter().flatten().flat_map(|value| value.to_le_bytes()));
    bytes.extend([4_u32, 0, 1, 2, 3, 3, 0, 1, 2].iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = format!("{:80}", "solid or not").into_bytes();
    bytes.extend(1_u32.to_le_bytes());
    bytes.extend([0.0_f32, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|v| v.to_le_bytes()));
    bytes.extend([0; 2]);
    bytes
}

/// Memory file that stays readable after its writer is dropped.
#[derive(Clone, Default)]
struct Shared(Arc<Mutex<Cursor<Vec<u8>>>>);

impl Shared {
    fn with<T>(&self, act: impl FnOnce(&mut Cursor<Vec<u8>>) -> T) -> T {
        act(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.with(|memory| memory.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Shared {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.with(|memory| memory.seek(to))
    }
}

fn pictures(name: &str) -> Vec<Vec<u8>> {
    let ending = if name == "jpeg" { "jpg" } else { name };
    let Some(format) = ImageFormat::ALL.into_iter().find(|format| format.extension() == ending) else {
        return Vec::new();
    };
    let mut random = Random::new(7);
    let pixels = (0..19 * 18).map(|i| if i < 100 { Rgb::splat(0.5) } else { random.rgb() * 2.0 }).collect();
    let Some(image) = Image::from_pixels(19, 18, pixels) else { return Vec::new() };
    let choices = [
        Options::default(),
        Options { png_16_bit: true, exr_compression: ExrCompression::Zip, ..Options::default() },
        Options {
            exr_compression: ExrCompression::None,
            exr_depth: SampleDepth::Half,
            jpeg_quality: 50,
            ..Options::default()
        },
    ];
    let metadata = vec![("Software".to_owned(), "Juggler".to_owned()), ("Seed".to_owned(), "é".to_owned())];
    let files = choices.into_iter().filter_map(|options| {
        // One file is a crop of a larger frame.
        let crop = CropFrame::new([40, 30], [3, 4], [19, 18]).filter(|_| options.exr_depth == SampleDepth::Half);
        let header = Header { options, metadata: metadata.clone(), crop, ..Header::new(19, 18) };
        let memory = Shared::default();
        let mut writer = writer(format, Destination::seekable("memory", memory.clone()), &header).ok()?;
        writer.write_rows(image.pixels().into()).ok()?;
        writer.finish().ok()?;
        Some(memory.with(|memory| memory.get_ref().clone()))
    });
    files.collect()
}

/// Partial renders: a picture of several tiles with AOVs, and a tiny one.
fn parts() -> Vec<Vec<u8>> {
    let layers = vec![Aov::Albedo, Aov::LightGroups, Aov::CryptoObject, Aov::Samples];
    [([40, 20], layers), ([1, 2], Vec::new())].into_iter().filter_map(|(size, aovs)| part(size, aovs)).collect()
}

fn part([width, height]: [u32; 2], aovs: Vec<Aov>) -> Option<Vec<u8>> {
    let scene = Scene::new().size(width, height).add(Object::new(Sphere::default()));
    let picture = Picture::new(&scene, &Settings { samples: Some(16), aovs, ..Settings::default() }).ok()?;
    let film = picture.film();
    picture.render_film(&film, &Control::default()).ok()?;
    let origin = RenderOrigin { scene: "a".to_owned(), frame: 0.0, command: "juggler render a".to_owned() };
    let description = picture.description(&origin, &picture.header(Options::default()), ShardDescription::whole(16));
    let folder = tempfile::tempdir().ok()?;
    let path = folder.path().join("a.jfilm");
    film::write(&path, &RenderDescription { finished: true, ..description }, film.tiles()).ok()?;
    std::fs::read(&path).ok()
}
