//! Assets that a scene holds in memory give the same images and fingerprints as files.

use juggler::material::Diffuse;
use juggler::prelude::*;
use juggler::scene::{Asset, TexelArray, TexelSamples};
use juggler::texture::{ColorSpace, half};

/// An image with a different color in each pixel, one of them brighter than white.
fn pixels() -> Image {
    let pixels = (0..12).map(|i| Rgb::new(i as f32 / 8.0, 0.5, 1.0 - i as f32 / 12.0)).collect();
    Image::from_pixels(4, 3, pixels).unwrap()
}

/// A floor with the texture `picture` under the panorama `sky`.
fn scene(picture: &str, sky: &str) -> Scene {
    Scene::new()
        .size(24, 16)
        .samples(4)
        .integrator(integrator::Path::default())
        .texture("floor", texture::Image::new(picture))
        .background(background::Environment::from_file(sky))
        .add(
            Object::new(Rectangle::default())
                .material(Diffuse { reflectance: Input::Texture("floor".into()), ..Diffuse::default() }),
        )
}

fn rendered(scene: &Scene) -> Image {
    juggler::render(scene, &Settings::default()).unwrap()
}

#[test]
fn images_in_memory_are_images_in_files() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("pixels.pfm");
    pixels().save(&file).unwrap();
    let file = file.to_str().unwrap();
    let of_file = rendered(&scene(file, file));
    let of_memory = rendered(&scene("wood", "heaven").image("wood", pixels()).image("heaven", pixels()));
    assert_eq!(of_file, of_memory);
    let bytes = std::fs::read(file).unwrap();
    let of_bytes = scene("wood.pfm", "heaven.pfm").asset("wood.pfm", Asset::from_bytes(bytes.clone()));
    assert_eq!(of_file, rendered(&of_bytes.asset("heaven.pfm", Asset::from_bytes(bytes))));
}

#[test]
fn assets_affect_only_their_own_scene() {
    let first = scene("wood", "heaven").image("wood", pixels()).image("heaven", pixels());
    let mut other = pixels();
    other.pixels_mut()[5] = Rgb::new(0.0, 9.0, 0.0);
    let second = first.clone().image("wood", other);
    let (before, after) = (rendered(&first), rendered(&second));
    assert_ne!(before, after);
    assert_eq!(before, rendered(&first), "a copy has changed its model");
    assert_ne!(first.fingerprint(), second.fingerprint());
    let picture = Picture::new(&first, &Settings::default()).unwrap();
    let updated = picture.rebuild(&first, &second, &Settings::default()).unwrap();
    assert_eq!(updated.render_image(&Control::default()).unwrap(), after, "an update is no fresh build");
}

#[test]
fn mesh_assets_are_loaded_and_missing_assets_are_errors() {
    let mesh = Scene::new().size(8, 8).samples(1).add(Object::new(Mesh::from_file("part.obj")));
    assert!(juggler::render(&mesh, &Settings::default()).is_err(), "there is no such file");
    let wavefront = Asset::from_bytes(*b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(juggler::render(&mesh.clone().asset("part.obj", wavefront), &Settings::default()).is_ok());
    let error = juggler::render(&mesh.image("part.obj", pixels()), &Settings::default()).unwrap_err();
    assert!(error.to_string().contains("pixels, not the bytes of a file"), "{error}");
}

/// A square with every array and attributes of both domains, shown by its attributes.
fn colored_square() -> MeshData {
    let attribute = |domain, channels, data| MeshAttribute { domain, channels, data };
    let heat = AttributeData::U16(vec![0, 65535, 30000, 12345]);
    let tint = AttributeData::F32(vec![0.9, 0.2, 0.1, 0.1, 0.8, 0.3]);
    MeshData {
        positions: [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.1], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.1]].map(Vec3::from).to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        normals: [[0.0, 0.1, 1.0], [0.2, 0.0, 1.0], [0.0, -0.3, 1.0], [0.1, 0.1, 1.0]].map(Vec3::from).to_vec(),
        uvs: vec![Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
        uvs1: vec![Vec2::Y, Vec2::ZERO, Vec2::X, Vec2::ONE],
        tangents: vec![[1.0, 0.0, 0.0, 1.0]; 4],
        attributes: [
            ("heat of it".to_owned(), attribute(AttributeDomain::Vertex, 1, heat)),
            ("tint".to_owned(), attribute(AttributeDomain::Face, 3, tint)),
        ]
        .into(),
    }
}

#[test]
fn meshes_in_memory_give_the_pictures_of_their_files() {
    let text = r#"{"version": 1, "render": {"size": [24, 16], "samples": 4}, "camera": {"perspective": {"eye": [0, 0, 4]}},
        "textures": {"heat": {"attribute": {"name": "heat of it"}}, "tint": {"attribute": {"name": "tint"}}},
        "materials": {"m": {"mix": {"a": {"diffuse": {"reflectance": "tint"}}, "b": "plain", "amount": "heat"}},
            "plain": {"diffuse": {"reflectance": "heat"}}},
        "lights": [{"point": {"position": [1, 2, 3], "intensity": 30}}],
        "objects": [{"shape": {"mesh": {"file": "part", "morphs": [{"file": "part", "weight": 0.25}]}}, "material": "m",
            "transform": {"translate": [1, 0, 0]}}, {"shape": {"mesh": {"file": "part"}}, "material": "m"}]}"#;
    let load = |asset| juggler::loader().from_json_with(text, "scene.json", [("part".to_owned(), asset)]).unwrap();
    let scene = load(Asset::from_mesh(colored_square()));
    let of_memory = rendered(&scene);
    assert!(of_memory.pixels().iter().any(|pixel| *pixel != Rgb::BLACK));
    let other = MeshData { attributes: Default::default(), ..colored_square() };
    assert_ne!(of_memory, rendered(&load(Asset::from_mesh(other))), "the attributes are seen");
    assert_eq!(of_memory, rendered(&load(Asset::from_bytes(juggler::mesh::ply_bytes(&colored_square())))));
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("scene.json");
    scene.save(&place).unwrap();
    assert_eq!(of_memory, rendered(&Scene::load(&place).unwrap()));
}

/// Texels of 4 by 3 in every type, with these channels.
fn texels(channels: u8) -> Vec<TexelArray> {
    let numbers = 0..12 * u32::from(channels);
    let array = |samples, space| TexelArray::new([4, 3], channels, samples, space).unwrap();
    let bytes = TexelSamples::U8(numbers.clone().map(|i| (i * 53) as u8).collect());
    let words = TexelSamples::U16(numbers.clone().map(|i| (i * 9973) as u16).collect());
    let halves = TexelSamples::F16(numbers.clone().map(|i| half::from_f32(i as f32 / 32.0)).collect());
    let floats = TexelSamples::F32(numbers.map(|i| i as f32 / 37.0).collect());
    vec![
        array(bytes.clone(), ColorSpace::Auto),
        array(bytes, ColorSpace::Linear),
        array(words.clone(), ColorSpace::Srgb),
        array(words, ColorSpace::Linear),
        array(halves, ColorSpace::Auto),
        array(floats, ColorSpace::Linear),
    ]
}

#[test]
fn texels_in_memory_give_the_pictures_of_their_files() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("scene.json");
    let mut pictures: Vec<Image> = Vec::new();
    for (channels, texels) in (1..=4).flat_map(|channels| texels(channels).into_iter().map(move |t| (channels, t))) {
        let asset = Asset::from_texels(texels);
        let scene = scene("wood", "heaven").asset("wood", asset.clone()).asset("heaven", asset);
        let picture = rendered(&scene);
        scene.save(&place).unwrap();
        assert_eq!(picture, rendered(&Scene::load(&place).unwrap()), "{channels} channels");
        assert!(!pictures.contains(&picture), "{channels} channels: type and color space are seen");
        pictures.push(picture);
        // The texture's color space decides, as for files.
        let own = |space| {
            scene.clone().texture("floor", texture::Image { color_space: space, ..texture::Image::new("wood") })
        };
        for space in [ColorSpace::Srgb, ColorSpace::Linear] {
            own(space).save(&place).unwrap();
            assert_eq!(rendered(&own(space)), rendered(&Scene::load(&place).unwrap()), "{channels} channels");
        }
    }
}
