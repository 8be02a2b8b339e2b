//! A world that reuses an earlier one renders the same image as one that is built anew.

use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Error, Picture, Settings};
use serde_json::{Value, json};
use std::sync::Arc;

const SCENE: &str = r#"{"version": 1, "render": {"size": [40, 30], "samples": 2, "integrator": "path", "shutter": [0, 0.5]},
    "animation": {"frames": 4}, "camera": {"perspective": {"eye": [0, 3, 9], "look_at": [0, 1, 0]}},
    "background": [0.2, 0.3, 0.5], "textures": {"spots": {"checker": {"size": 0.7, "space": "local"}}},
    "materials": {"emitter": {"emissive": {"radiance": [3, 2, 1]}}, "red": {"diffuse": {"reflectance": [0.8, 0.1, 0.1]}},
        "glass": {"dielectric": {"ior": 1.5}}, "both": {"mix": {"a": "red", "b": {"plastic": {}}, "amount": 0.5}}},
    "groups": {"pair": [{"shape": "sphere", "material": "both"}, {"shape": "cuboid", "transform": {"translate": [2, 0, 0]}}]},
    "lights": [{"point": {"position": [3, 6, 4], "intensity": 30}}, {"directional": {"direction": [1, -2, -1]}},
        {"area": {"shape": {"disk": {"radius": 0.5}}, "position": [0, 5, 0], "direction": [0, -1, 0], "power": 50}}],
    "objects": [{"shape": "plane", "material": {"diffuse": {"reflectance": "spots"}}},
        {"shape": "sphere", "transform": [{"translate": ["=frame", 1, 0]}], "material": "glass"},
        {"group": "pair", "transform": {"translate": [-3, 1, 0]}, "material": "red"},
        {"shape": {"sphere": {"radius": 0.4}}, "transform": {"translate": [2, 2, 2]}, "material": "emitter"},
        {"objects": [{"shape": "disk", "transform": {"translate": [0, 0.1, 3]}}], "material": {"velvet": {}}}]}"#;

fn hash(picture: &Picture) -> String {
    picture.render(Default::default(), &Control::default(), |_: &[_]| Ok::<(), Error>(())).unwrap().hash
}

#[test]
fn incrementally_updated_world_equals_a_rebuilt_world() {
    let scene = Scene::from_json(SCENE, "changed.json").unwrap();
    let settings = Settings::default();
    let first = Picture::new(&scene, &settings).unwrap();
    let (own, mut shared) = (hash(&first), 0);
    let changes: [(&str, Value, bool); 20] = [
        ("/camera/perspective/eye", json!([1, 3, 9]), true),
        ("/render/samples", json!(3), true),
        ("/materials/red/diffuse/reflectance", json!([0.1, 0.8, 0.1]), true),
        ("/materials/red", json!({"conductor": {"metal": "gold", "roughness": 0.2}}), true),
        ("/materials/glass/dielectric/ior", json!(1.8), true),
        ("/materials/glass/dielectric", json!({"roughness": 0.3}), true),
        ("/materials/glass", json!({"mask": {"opacity": 0.5, "material": "red"}}), true),
        ("/materials/emitter/emissive/radiance", json!([9, 1, 1]), true),
        ("/materials/both/mix/amount", json!(0.1), true),
        ("/textures/spots/checker/even", json!([0.9, 0.1, 0.9]), true),
        ("/lights/0/point/intensity", json!(90), true),
        ("/lights/1/directional/angle_degrees", json!(4), true),
        ("/lights/3", json!({"spot": {"position": [0, 8, 0], "direction": [0, -1, 0], "intensity": 200}}), true),
        ("/background", json!({"sky": {}}), true),
        // These edits need new objects: emission, materials or placements differ.
        ("/materials/red", json!({"emissive": {}}), false),
        ("/lights/1", Value::Null, false),
        ("/lights/2/area/power", json!(500), false),
        ("/objects/0/material/diffuse/reflectance", json!([0.1, 0.1, 0.9]), false),
        ("/objects/3/transform/0/translate", json!([2, 3, 2]), false),
        ("/objects/1", Value::Null, false),
    ];
    for (pointer, value, shares) in changes {
        let changed = scene.with_value(pointer, value.clone()).unwrap();
        let anew = Picture::new(&changed, &settings).unwrap();
        let after = first.rebuild(&scene, &changed, &settings).unwrap();
        let what = format!("{pointer} = {value}");
        assert_eq!(hash(&after), hash(&anew), "{what}");
        assert_ne!(hash(&after), own, "{what}");
        assert_eq!(after.fingerprint(), anew.fingerprint(), "{what}");
        assert_eq!(after.world().geometry_stats(), anew.world().geometry_stats(), "{what}");
        assert_eq!(after.world().shares_geometry_with(first.world()), shares, "{what}");
        shared += usize::from(Arc::ptr_eq(after.world(), first.world()));
    }
    assert_eq!(shared, 2, "camera and settings");
}
