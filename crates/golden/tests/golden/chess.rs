//! The chess scene matches the program that it comes from: 380 primitives, five lights, two
//! cameras.

use juggler::scene::description::Description;
use juggler::scene::{Item, Object, Scene};
use juggler::shape::AnyShape;
use juggler::{Picture, Settings};

/// Number of meshes among objects and everything below them.
fn meshes(objects: &[Item<Object>], scene: &Description) -> usize {
    objects.iter().map(|object| meshes_of(object, scene)).sum()
}

fn meshes_of(object: &Object, scene: &Description) -> usize {
    let own = object.shape.iter().filter(|shape| matches!(shape, AnyShape::Mesh(_))).count();
    let group = object.group.iter().map(|name| meshes(&scene.groups[&name.0], scene));
    own + group.sum::<usize>() + object.objects.iter().map(|inner| meshes(inner, scene)).sum::<usize>()
}

#[test]
fn chess_has_the_primitives_lights_and_cameras_of_its_model() {
    let scene = Scene::built_in("chess").unwrap();
    let description = &scene.description;
    let geometry = Picture::new(&scene, &Settings::default()).unwrap().world().geometry_stats();
    // A mesh counts as one shape here, while the other program counted its triangles.
    let solids = geometry.shapes - meshes(&description.objects, description) as u64;
    assert_eq!((solids, geometry.triangles), (48, 332));
    assert_eq!((solids + geometry.triangles, geometry.lights), (380, 5));
    assert_eq!(description.cameras.keys().collect::<Vec<_>>(), ["camera1", "camera2"]);
}
