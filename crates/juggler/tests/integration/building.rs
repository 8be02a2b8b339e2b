//! Scenes built by programs equal their JSON.

use juggler::prelude::*;

/// A triangle in the plane z = 0.
fn triangle() -> Mesh {
    let corners = [vec3(-1.0, -1.0, 0.0), vec3(1.0, -1.0, 0.0), vec3(0.0, 1.0, 0.0)];
    Mesh::from_triangles(corners, [[0, 1, 2]]).with_normals([vec3(0.0, 0.0, 1.0); 3])
}

#[test]
fn built_scene_equals_the_json_scene() {
    let json = r#"{
        "version": 1,
        "render": {
            "size": [16, 9], "samples": 4, "seed": 7,
            "integrator": {"path": {"max_depth": 3}}, "sampler": {"independent": {}}, "filter": {"box": {}}
        },
        "tone": {"curve": {"agx": {}}, "exposure_stops": 1},
        "background": {"sky": {}},
        "objects": [{"shape": {"mesh": {
            "positions": [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
            "normals": [[0, 0, 1], [0, 0, 1], [0, 0, 1]]
        }}}]
    }"#;
    let read = Scene::from_json(json, "triangle.json").unwrap();
    let built = Scene::new()
        .size(16, 9)
        .samples(4)
        .seed(7)
        .integrator(integrator::Path { max_depth: 3, ..Default::default() })
        .sampler(sampler::Independent {})
        .filter(film::Box::default())
        .tone(Tone { exposure_stops: 1.0, ..Tone::new(AnyCurve::Agx(Default::default())) })
        .background(background::Sky::default())
        .add(Object::new(triangle()));
    assert_eq!(built.description, read.description);
    let render = |scene: &Scene| juggler::render(scene, &Settings::default()).unwrap();
    assert_eq!(render(&built), render(&read));
}

#[test]
fn a_color_as_background_stays_a_color() {
    let scene = Scene::new().background(Rgb::new(0.1, 0.2, 0.3));
    let json = serde_json::to_value(&scene.description).unwrap();
    assert_eq!(json["background"].as_array().map(Vec::len), Some(3), "{json}");
}
