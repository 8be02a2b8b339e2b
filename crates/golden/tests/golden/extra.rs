//! Scenes of the hashes that are not built in, for features that no built-in scene uses.

use juggler::ImageExt;
use juggler::math::{Image, Rgb, color};
use juggler::scene::{Asset, Scene};

/// Names of the scenes.
pub const EXTRA_SCENES: [&str; 3] = ["image-texture", "visible-emitters", "mitchell-filter"];

/// An image on a floor down to its smallest MIP level, on a box without interpolation, and as the
/// roughness of a metal.
const IMAGE_TEXTURE: &str = r#"{
    "version": 1,
    "render": {"size": [96, 64], "samples": 16, "integrator": {"path": {"max_depth": 4}}},
    "camera": {"perspective": {"eye": [0.3, 1.2, 4.5], "look_at": [0, 0.7, 0], "vertical_fov_degrees": 45}},
    "background": [0.5, 0.6, 0.8],
    "textures": {
        "floor": {"image": {"file": "squares.png", "scale": 0.7, "rotate_degrees": [0, 0, 20]}},
        "box": {"image": {"file": "squares.png", "filter": "nearest", "wrap": "mirror", "scale": 1.5}},
        "rough": {"image": {"file": "squares.png", "color_space": "linear", "channel": "g", "filter": "bilinear"}}
    },
    "lights": [{"point": {"position": [3, 5, 4], "intensity": 60}}],
    "objects": [
        {"shape": "plane", "material": {"diffuse": {"reflectance": "floor"}}},
        {"shape": {"cuboid": {"min": [-1.6, 0, -0.6], "max": [-0.4, 1.2, 0.6]}},
            "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 30}}], "material": {"diffuse": {"reflectance": "box"}}},
        {"shape": {"sphere": {"radius": 0.8}}, "transform": [{"translate": [0.9, 0.8, 0]}],
            "material": {"conductor": {"roughness": "rough"}}}
    ]
}"#;

/// Emitters that the camera sees, over a floor that hardly shows noise: larger pictures have several
/// camera rays for each sample.
const VISIBLE_EMITTERS: &str = r#"{
    "version": 1,
    "render": {"size": [96, 54], "samples": 16, "integrator": {"path": {"max_depth": 3}}},
    "camera": {"perspective": {"eye": [0, 1.2, 4], "look_at": [0, 0.8, 0], "vertical_fov_degrees": 40}},
    "objects": [
        {"shape": "plane", "material": {"diffuse": {"reflectance": 0.15}}},
        {"shape": {"sphere": {"radius": 0.15}}, "transform": [{"translate": [-1.2, 0.5, 0]}], "material": {"emissive": {"radiance": [4, 3, 2]}}},
        {"shape": {"sphere": {"radius": 0.15}}, "transform": [{"translate": [-0.5, 1.2, -0.5]}], "material": {"emissive": {"radiance": [2, 3, 4]}}},
        {"shape": {"sphere": {"radius": 0.15}}, "transform": [{"translate": [0.2, 0.6, 0.3]}], "material": {"emissive": {"radiance": [3, 4, 2]}}},
        {"shape": {"sphere": {"radius": 0.15}}, "transform": [{"translate": [0.9, 1.5, -0.4]}], "material": {"emissive": {"radiance": [4, 2, 3]}}},
        {"shape": {"sphere": {"radius": 0.4}}, "transform": [{"translate": [0.9, 0.4, 0.2]}], "material": {"dielectric": {"ior": 1.5}}}
    ]
}"#;

/// Edges and highlights, at which the negative lobes of Mitchell's filter count.
const MITCHELL_FILTER: &str = r#"{
    "version": 1,
    "render": {"size": [96, 64], "samples": 16, "filter": "mitchell", "integrator": {"path": {"max_depth": 4}}},
    "camera": {"perspective": {"eye": [0, 1.5, 5], "look_at": [0, 0.8, 0], "vertical_fov_degrees": 40}},
    "background": [0.2, 0.3, 0.5],
    "lights": [{"directional": {"direction": [-1, -2, -1], "intensity": 2}}],
    "objects": [
        {"shape": "plane", "material": {"checkerboard": {"size": 0.7,
            "even": {"diffuse": {"reflectance": 0.9}}, "odd": {"diffuse": {"reflectance": 0.05}}}}},
        {"shape": {"sphere": {"radius": 0.8}}, "transform": [{"translate": [0, 0.8, 0]}],
            "material": {"plastic": {"reflectance": [0.7, 0.1, 0.1], "roughness": 0.1}}}
    ]
}"#;

/// Bytes of an oblong PNG, one pixel per level of the pattern.
fn squares() -> Vec<u8> {
    let level = |level: u32| color::srgb_decode(level as f32 / 255.0);
    let pixel = |(x, y): (u32, u32)| Rgb::new(level(x * 8), level((x * 37 + y * 91) % 256), level(255 - y * 16));
    let pixels = (0..16).flat_map(|y| (0..32).map(move |x| (x, y))).map(pixel).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("squares.png");
    Image::from_pixels(32, 16, pixels).unwrap().save(&path).unwrap();
    std::fs::read(path).unwrap()
}

/// An extra scene or a built-in one.
pub fn scene(name: &str) -> Scene {
    match name {
        "image-texture" => {
            let scene = Scene::from_json(IMAGE_TEXTURE, name).unwrap();
            scene.asset("squares.png", Asset::from_bytes(squares()))
        }
        "visible-emitters" => Scene::from_json(VISIBLE_EMITTERS, name).unwrap(),
        "mitchell-filter" => Scene::from_json(MITCHELL_FILTER, name).unwrap(),
        _ => Scene::built_in(name).unwrap(),
    }
}
