//! Cryptomatte decoded independently and compared with masks rendered without it: for each object,
//! an image in which it alone emits.

use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Aov, Picture, Settings};
use serde_json::{Value, json};
use std::collections::{BTreeMap, BTreeSet};

const PIXELS: usize = 24 * 18;
/// Maximum error of a coverage: both values are sums of some tens of `f32`.
const NEAR: f32 = 3e-6;

/// Overlapping spheres, out of focus.
const BLURRED: &str = r#"{"camera": {"thin_lens": {"eye": [0, 1, 6], "look_at": [0, 0.6, 0], "lens_radius": 0.4, "focus_distance": 5}},
    "objects": [{"shape": "plane", "name": "floor", "material": "a"},
        {"shape": {"sphere": {"radius": 0.8}}, "name": "near", "transform": [{"translate": [-0.6, 0.7, 3]}], "material": "b"},
        {"shape": {"sphere": {"radius": 0.8}}, "name": "in focus", "transform": [{"translate": [0.2, 0.8, 1]}], "material": "c"},
        {"shape": {"sphere": {"radius": 1}}, "transform": [{"translate": [1.2, 1, -2]}], "material": "b"},
        {"shape": {"cuboid": {"min": [-0.5, -1.5, -0.5], "max": [0.5, 1.5, 0.5]}}, "name": "\"föhn\"", "transform": [{"translate": [-1.4, 1, -4]}], "material": "a"}]}"#;

/// Glass in front of an opacity mask, a half-opaque card, and a wall.
const OPEN: &str = r#"{"camera": {"orthographic": {"eye": [0, 0, 4], "look_at": [0, 0, 0], "height": 2}},
    "textures": {"cutouts": {"checker": {"size": 0.37, "space": "world", "even": 1, "odd": 0}}},
    "objects": [{"shape": {"rectangle": {"size": [2.2, 2]}}, "name": "wall", "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0, 0, -1]}], "material": "a"},
        {"shape": {"rectangle": {"size": [1.2, 1.5]}}, "name": "card", "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [-0.5, 0.1, 0]}],
            "material": {"mask": {"opacity": 0.4, "material": {"diffuse": {}}}}},
        {"shape": {"rectangle": {"size": [0.9, 1.1]}}, "name": "veil", "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0.5, -0.2, 0.5]}],
            "material": {"mask": {"opacity": "cutouts", "material": {"diffuse": {}}}}},
        {"shape": {"sphere": {"radius": 0.4}}, "name": "glass", "transform": [{"translate": [0.2, 0.3, 1]}], "material": "g"}]}"#;

/// Moving objects with motion blur.
const MOVING: &str = r#"{"camera": {"perspective": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}},
    "animation": {"frames": 4, "frames_per_second": 24}, "shutter": [0, 1],
    "objects": [{"shape": {"sphere": {"radius": 0.5}}, "name": "fast", "transform": [{"translate": ["=frame - 1", 0.3, 0]}], "material": "a"},
        {"shape": {"cuboid": {"min": [-0.5, -0.3, -0.5], "max": [0.5, 0.3, 0.5]}}, "name": "turning", "transform": [{"rotate": {"axis": [1, 1, 0], "degrees": "=80 * frame"}}, {"translate": [0.4, -0.4, -1]}], "material": "b"}]}"#;

/// More objects than a pixel can list, some of several shapes or with the same name.
fn crowd() -> Value {
    let mut objects = Vec::new();
    for number in 0..54 {
        let (column, row) = (number % 9, number / 9);
        let (x, y) = (f64::from(column) * 0.033 - 0.13, f64::from(row) * 0.033 - 0.08);
        let material = ["a", "b", "c"][number as usize % 3];
        let mut object = json!({"group": "pair", "material": material, "transform": [{"translate": [x, y, 0]}]});
        match number {
            7 | 20 => object["name"] = json!("twins"),
            _ if number % 2 == 0 => object["name"] = json!(format!("dot {number}")),
            _ => {}
        }
        objects.push(object);
    }
    json!({"camera": {"orthographic": {"eye": [0, 0, 4], "look_at": [0, 0, 0], "height": 1.8}},
        "groups": {"pair": [{"shape": {"sphere": {"radius": 0.015}}}, {"shape": {"sphere": {"radius": 0.012}}, "transform": [{"translate": [0.01, 0.012, -0.1]}]}]},
        "objects": objects})
}

/// Returns a scene with these members.
fn scene(parts: &Value, materials: &Value) -> Scene {
    let mut scene = parts.clone();
    let shutter = scene.as_object_mut().unwrap().remove("shutter").unwrap_or(json!([0, 0]));
    scene["version"] = json!(1);
    scene["background"] = json!([0, 0, 0]);
    scene["materials"] = materials.clone();
    scene["render"] = json!({"size": [24, 18], "samples": 48, "filter": "gaussian", "shutter": shutter,
        "integrator": {"path": {"max_depth": 1}}});
    Scene::from_json(scene.to_string(), "test").unwrap()
}

/// Returns the picture, its AOV channels and its pixels.
fn render(scene: &Scene, aovs: &[Aov]) -> (Picture, Vec<Vec<f32>>, Vec<f32>) {
    let picture = Picture::new(scene, &Settings { aovs: aovs.to_vec(), ..Settings::default() }).unwrap();
    let film = picture.film();
    picture.render_film(&film, &Control::default()).unwrap();
    let tiles: Vec<_> = film.tiles().map(|(_, tile)| tile).collect();
    let channels = picture.aovs().band_values(&picture.region(), &tiles, None);
    let mut red = Vec::new();
    picture
        .develop(&film, |rows| {
            red.extend(rows.colors.iter().map(|pixel| pixel.r));
            Ok::<(), ()>(())
        })
        .unwrap();
    (picture, channels, red)
}

/// Returns the coverage of each pixel by the objects that `is_lit` selects by index and material;
/// all others are black.
fn coverage(parts: &Value, is_lit: &dyn Fn(usize, &Value) -> bool) -> Vec<f32> {
    let mut parts = parts.clone();
    for (place, object) in parts["objects"].as_array_mut().unwrap().iter_mut().enumerate() {
        let radiance = if is_lit(place, &object["material"]) { 1 } else { 0 };
        let emissive = json!({"emissive": {"radiance": radiance}});
        match object["material"].get_mut("mask") {
            Some(mask) => mask["material"] = emissive,
            None => object["material"] = emissive,
        }
    }
    render(&scene(&parts, &json!({})), &[]).2
}

/// MurmurHash3 for x86, 32 bits, seed 0, byte by byte as Appleby describes it, with exponents
/// adjusted to finite floats.
fn murmur3(text: &str) -> u32 {
    let (mut hash, bytes) = (0u32, text.as_bytes());
    for block in bytes.chunks(4) {
        let mut word = (0..block.len()).fold(0, |word, i| word | u32::from(block[i]) << (8 * i));
        word = word.wrapping_mul(0xcc9e_2d51);
        word = word.rotate_left(15).wrapping_mul(0x1b87_3593);
        hash ^= word;
        if block.len() == 4 {
            hash = hash.rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64);
        }
    }
    hash ^= bytes.len() as u32;
    for (shift, factor) in [(16, 0x85eb_ca6b), (13, 0xc2b2_ae35), (16, 1)] {
        hash = (hash ^ hash >> shift).wrapping_mul(factor);
    }
    if f32::from_bits(hash).is_normal() { hash } else { hash ^ 1 << 23 }
}

/// Returns the mattes of a picture by name of the manifest: the coverage of each pixel.
fn mattes(picture: &Picture, channels: &[Vec<f32>], name: &str) -> BTreeMap<String, Vec<f32>> {
    let key = format!("cryptomatte/{:.7}", format!("{:08x}", murmur3(name)));
    let (mut manifest, mut ranks, mut first) = (None, Vec::new(), 0);
    for layer in picture.aovs().headers() {
        let text = |what: &str| {
            layer.metadata.iter().find(|(name, _)| *name == format!("{key}/{what}")).map(|(_, text)| text.as_str())
        };
        if text("name") == Some(name) {
            assert_eq!((text("hash"), text("conversion")), (Some("MurmurHash3_32"), Some("uint32_to_float32")));
            manifest = text("manifest").map(|text| serde_json::from_str::<BTreeMap<String, String>>(text).unwrap());
            ranks.extend([(first, first + 1), (first + 2, first + 3)]);
        }
        first += layer.channels.len();
    }
    assert_eq!(ranks.len(), 6);
    let matte = |(name, hash): (String, String)| {
        assert_eq!(hash, format!("{:08x}", murmur3(&name)));
        let id = f32::from_bits(u32::from_str_radix(&hash, 16).unwrap());
        let of = |pixel: usize| {
            let listed = ranks.iter().filter(|(rank, _)| channels[*rank][pixel] == id);
            listed.map(|(_, share)| channels[*share][pixel]).sum::<f32>()
        };
        (name, (0..PIXELS).map(of).collect())
    };
    manifest.unwrap().into_iter().map(matte).collect()
}

/// Compares all mattes with the expected coverages. Returns how many pixels list fewer objects than
/// they show.
fn check(found: &BTreeMap<String, Vec<f32>>, expected: &BTreeMap<String, Vec<f32>>) -> usize {
    assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>());
    let mut lost = 0;
    for pixel in 0..PIXELS {
        let mut shares: Vec<f32> = expected.values().map(|shares| shares[pixel]).filter(|share| *share > 0.0).collect();
        shares.sort_by(|a, b| b.total_cmp(a));
        let least = shares.get(5).copied().unwrap_or(0.0);
        lost += usize::from(shares.len() > 6);
        let mut listed = 0;
        for (name, expected) in expected {
            let (found, expected) = (found[name][pixel], expected[pixel]);
            listed += usize::from(found > 0.0);
            // An omitted coverage is at most the smallest listed one.
            let is_left_out = found == 0.0 && expected <= least + NEAR && shares.len() > 6;
            assert!((found - expected).abs() < NEAR || is_left_out, "{name} {pixel}: {found} for {expected}");
        }
        assert_eq!(listed, shares.len().min(6), "{pixel}");
    }
    lost
}

/// Compares both Cryptomattes of a scene. Returns how many pixels show more objects than they list.
fn compare(parts: &Value) -> usize {
    let materials = json!({"a": {"diffuse": {}}, "b": {"diffuse": {"reflectance": 0.2}}, "c": {"conductor": {}}, "g": {"dielectric": {}}});
    let (picture, channels, _) = render(&scene(parts, &materials), &[Aov::CryptoObject, Aov::CryptoMaterial]);
    let objects = parts["objects"].as_array().unwrap();
    let name = |(place, object): (usize, &Value)| {
        object["name"].as_str().map_or_else(|| format!("objects[{place}]"), str::to_owned)
    };
    let names: Vec<String> = objects.iter().enumerate().map(name).collect();
    let of_object = |name: &String| (name.clone(), coverage(parts, &|place, _| names[place] == *name));
    let lost = check(&mattes(&picture, &channels, "CryptoObject"), &names.iter().map(of_object).collect());
    // Unnamed materials are identified by their indices.
    let found = mattes(&picture, &channels, "CryptoMaterial");
    let used: BTreeSet<&str> = objects.iter().filter_map(|object| object["material"].as_str()).collect();
    for name in used {
        let expected = coverage(parts, &|_, material| material.as_str() == Some(name));
        let apart = found[name].iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(apart < NEAR && expected.iter().any(|share| *share > 0.0), "{name}: {apart}");
    }
    lost
}

#[test]
fn cryptomatte_matches_coverage_with_depth_of_field() {
    assert_eq!(compare(&serde_json::from_str(BLURRED).unwrap()), 0);
}

#[test]
fn cryptomatte_matches_coverage_behind_opacity() {
    assert_eq!(compare(&serde_json::from_str(OPEN).unwrap()), 0);
}

#[test]
fn cryptomatte_matches_coverage_with_motion_blur() {
    assert_eq!(compare(&serde_json::from_str(MOVING).unwrap()), 0);
}

#[test]
fn cryptomatte_keeps_the_six_largest_coverages() {
    let lost = compare(&crowd());
    assert!((6..40).contains(&lost), "{lost}");
}
