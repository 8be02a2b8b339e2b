//! Assets of arrays: what scenes make of them, and messages about them.

use juggler_math::Vec3;
use juggler_mesh::ply_bytes;
use juggler_scene::{Asset, Loader, Scene, SceneError, TexelArray, TexelSamples};
use juggler_shape::MeshData;
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use juggler_texture::{ColorSpace, Image};

/// A square of two triangles with an attribute.
fn square() -> MeshData {
    let ids = MeshAttribute { domain: AttributeDomain::Face, channels: 1, data: AttributeData::U8(vec![3, 200]) };
    MeshData {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        attributes: [("part".to_owned(), ids)].into(),
        ..MeshData::default()
    }
}

fn scene(mesh: &str) -> String {
    format!(r#"{{"version": 1, "objects": [{{"shape": {{"mesh": {mesh}}}}}]}}"#)
}

fn load(mesh: &str, assets: impl IntoIterator<Item = (&'static str, Asset)>) -> Result<Scene, SceneError> {
    let assets = assets.into_iter().map(|(name, asset)| (name.to_owned(), asset));
    Loader::default().from_json_with(scene(mesh), "scene.json", assets)
}

#[test]
fn assets_are_there_before_the_text_is_checked() {
    let file = r#"{"file": "part"}}, "transform": {"translate": [0, 0, 0]}}, {"shape": {"sphere": {"radios": 1}"#;
    let errors = |found: Result<Scene, SceneError>| found.unwrap_err().to_string();
    let with = errors(load(file, [("part", Asset::from_mesh(square()))]));
    assert!(with.contains("radios") && !with.contains("cannot read"), "{with}");
    let without = errors(load(file, []));
    assert!(without.contains("radios") && without.contains("cannot read `part`"), "{without}");
    let sound = load(r#"{"file": "part"}"#, [("part", Asset::from_mesh(square()))]).unwrap();
    assert!(sound.check().errors() == 0 && sound.compile().is_ok());
    let assets: Vec<(&str, &Asset)> = sound.assets().collect();
    assert_eq!(assets, [("part", &Asset::from_mesh(square()))]);
    assert_eq!(**assets[0].1.mesh().unwrap(), square());
    assert!(assets[0].1.bytes().is_none() && assets[0].1.image().is_none());
}

#[test]
fn fingerprints_of_arrays_and_of_files_have_other_hashes() {
    let file = r#"{"file": "part.ply"}"#;
    let parts = |asset: Asset| load(file, [("part.ply", asset)]).unwrap().fingerprint().parts().clone();
    let (mut memory, mut bytes) = (parts(Asset::from_mesh(square())), parts(Asset::from_bytes(ply_bytes(&square()))));
    assert_eq!(parts(Asset::from_mesh(square())), memory);
    assert_ne!(memory.remove("file part.ply").unwrap(), bytes.remove("file part.ply").unwrap());
    assert_eq!(memory, bytes);
}

#[test]
fn messages_name_an_asset_and_what_it_contains() {
    let broken = MeshData { triangles: vec![[0, 1, 4]], ..square() };
    let message = load(r#"{"file": "part"}"#, [("part", Asset::from_mesh(broken))]).unwrap().compile().err().unwrap();
    assert!(message.to_string().contains("`part` contains an invalid mesh: "), "{message}");
    let texture = r#"{"version": 1, "textures": {"a": {"image": {"file": "part"}}},
        "materials": {"m": {"diffuse": {"reflectance": "a"}}}, "objects": [{"shape": "sphere", "material": "m"}]}"#;
    let assets = [("part".to_owned(), Asset::from_mesh(square()))];
    let message = Loader::default().from_json_with(texture, "a.json", assets).unwrap().compile().err().unwrap();
    assert!(message.to_string().contains("contains a mesh, not the bytes of a file"), "{message}");
}

#[test]
fn arrays_are_morph_targets_and_count_as_memory() {
    let target = MeshData { positions: vec![Vec3::Z, Vec3::X, Vec3::ONE, Vec3::Y], ..square() };
    let mesh = r#"{"file": "part", "morphs": [{"file": "bent", "weight": 1}]}"#;
    let moved = load(mesh, [("part", Asset::from_mesh(square())), ("bent", Asset::from_mesh(target))]).unwrap();
    let bounds = |scene: &Scene| scene.compile().unwrap().world.bounds();
    assert_eq!(bounds(&moved).min, Vec3::ZERO);
    let still = load(r#"{"file": "part"}"#, [("part", Asset::from_mesh(square()))]).unwrap();
    assert_eq!(still.needs().meshes, 4 * 12 + 2 * 12 + 2 + 2 * 96);
    assert_eq!(moved.needs().meshes, 2 * still.needs().meshes);
    assert!(still.needs().files.is_empty());
}

#[test]
fn arrays_are_saved_as_ply_files_with_all_attributes() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("scene.json");
    load(r#"{"file": "parts/a"}"#, [("parts/a", Asset::from_mesh(square()))]).unwrap().save(&place).unwrap();
    let bytes = std::fs::read(folder.path().join("parts/a")).unwrap();
    assert_eq!(bytes, ply_bytes(&square()));
    let again = Scene::load(&place).unwrap();
    let problems = again.check();
    assert!(problems.list().iter().all(|problem| !problem.message.contains("parts/a")), "{problems}");
    assert!(again.compile().is_ok());
    assert_eq!(again.needs().files.len(), 1);
}

#[test]
fn meshes_of_arrays_unpack_to_assets_without_a_copy() {
    let inline = Scene::from_json(
        scene(r#"{"positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}"#),
        "scene.json",
    );
    let inline = inline.unwrap();
    let unpacked = inline.unpacked().unwrap();
    let (name, asset) = unpacked.assets().next().unwrap();
    assert_eq!(name, "meshes/mesh.ply");
    assert!(std::sync::Arc::ptr_eq(asset.mesh().unwrap(), inline.description.objects[0].mesh().unwrap().arrays()));
}

#[test]
fn samples_that_are_no_texels_are_refused_with_the_reason() {
    let refused =
        |size, channels, samples, space| TexelArray::new(size, channels, samples, space).unwrap_err().to_string();
    let bytes = |count: usize| TexelSamples::U8(vec![0; count]);
    let auto = ColorSpace::Auto;
    assert_eq!(refused([2, 3], 3, bytes(17), auto), "2 × 3 texels of 3 channels need 18 samples, there are 17");
    assert_eq!(refused([2, 3], 5, bytes(30), auto), "texels must have 1 to 4 channels, not 5");
    assert!(refused([0, 3], 1, bytes(0), auto).starts_with("0 × 3 texels: each side must be 1 to 65536"));
    assert!(refused([u32::MAX; 2], 1, bytes(0), auto).contains("at most 268435456 texels"));
    assert!(refused([1, 1], 1, TexelSamples::F32(vec![0.0]), ColorSpace::Srgb).contains("floats are linear"));
}

#[test]
fn texels_differ_by_size_type_and_color_space() {
    let asset = |size, samples, space| Asset::from_texels(TexelArray::new(size, 1, samples, space).unwrap());
    let words = || TexelSamples::U16(vec![0, 15360]);
    let assets = [
        asset([2, 1], words(), ColorSpace::Auto),
        asset([1, 2], words(), ColorSpace::Auto),
        asset([2, 1], words(), ColorSpace::Linear),
        asset([2, 1], TexelSamples::F16(vec![0, 15360]), ColorSpace::Auto),
        asset([2, 1], TexelSamples::F32(vec![0.0, 1.0]), ColorSpace::Auto),
        asset([2, 1], TexelSamples::U8(vec![0, 255]), ColorSpace::Auto),
    ];
    for (i, one) in assets.iter().enumerate() {
        assert!(assets.iter().skip(i + 1).all(|other| other != one), "{i}");
    }
    assert_eq!(assets[0], asset([2, 1], words(), ColorSpace::Srgb));
    let scene = Scene::new().texture("wall", Image::new("pixels")).asset("pixels", assets[5].clone());
    assert_eq!(scene.needs().images, 2 + 2 * 4 / 3 + 2 * 4 + 64);
    let mesh = load(r#"{"file": "part"}"#, [("part", assets[0].clone())]).unwrap().compile().err().unwrap();
    assert!(mesh.to_string().contains("contains texels, not the bytes of a file"), "{mesh}");
}
