//! Assets that a scene holds in memory give the same images and fingerprints as files.

use juggler::material::Diffuse;
use juggler::prelude::*;
use juggler::scene::Asset;

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
