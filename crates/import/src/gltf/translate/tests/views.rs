use super::*;
use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_math::{Rgb, Vec3};
use juggler_scene::model::NameOrIndex;

#[test]
fn cameras_look_along_minus_z_and_ignore_scale() {
    let mut builder = Builder::default();
    builder.member(
        r#""cameras": [{"type": "perspective", "perspective": {"yfov": 1.5707963267948966, "aspectRatio": 1.5, "znear": 1}},
            {"type": "orthographic", "name": "Plan", "orthographic": {"xmag": 2, "ymag": 4, "znear": 0, "zfar": 9}}],
            "scenes": [{"nodes": [0, 1, 2]}], "nodes": [
            {"camera": 0, "translation": [1, 2, 3], "scale": [3, 3, 3], "rotation": [0, 1, 0, 0]}, {"camera": 1},
            {"camera": 1, "scale": [0, 0, 0]}]"#,
    );
    let model = open(&builder);
    let found = parts_at(&model, 0.0);
    assert_eq!(found.cameras.keys().collect::<Vec<_>>(), ["node 0", "Plan", "Plan#2"]);
    let AnyCamera::Perspective(camera) = &found.cameras["node 0"] else { panic!("{found:?}") };
    assert_eq!((camera.eye, camera.vertical_fov_degrees), (Vec3::new(1.0, 2.0, 3.0), Some(90.0)));
    assert_eq!((camera.direction, camera.up), (Some(Vec3::Z), Vec3::Y));
    let AnyCamera::Orthographic(camera) = &found.cameras["Plan"] else { panic!("{found:?}") };
    assert_eq!((camera.height, camera.direction), (Some(8.0), Some(Vec3::NEG_Z)));
    let aspects = model.summary(&ModelChoice::default()).unwrap().cameras;
    assert_eq!(aspects.iter().map(|(_, aspect)| *aspect).collect::<Vec<_>>(), [Some(1.5), Some(0.5), Some(0.5)]);
}

#[test]
fn lights_keep_their_numbers_unless_they_are_photometric() {
    let mut builder = Builder::default();
    builder.member(
        r#""extensionsUsed": ["KHR_lights_punctual", "KHR_node_visibility"], "scenes": [{"nodes": [0, 1, 2, 3]}], "nodes": [
            {"name": "sun", "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476],
             "extensions": {"KHR_lights_punctual": {"light": 0}}},
            {"translation": [0, 5, 0], "scale": [2, 2, 2], "extensions": {"KHR_lights_punctual": {"light": 1}}},
            {"extensions": {"KHR_lights_punctual": {"light": 2}}},
            {"extensions": {"KHR_lights_punctual": {"light": 1}, "KHR_node_visibility": {"visible": false}}}],
            "extensions": {"KHR_lights_punctual": {"lights": [
            {"type": "directional", "intensity": 683}, {"type": "point", "color": [1, 0.5, 0], "intensity": 1366},
            {"type": "spot", "spot": {"innerConeAngle": 0.5235987755982988, "outerConeAngle": 1.0471975511965976}}]}}"#,
    );
    let model = open(&builder);
    let found = model.parts(&ModelChoice { photometric: true, ..ModelChoice::default() }, "l/").unwrap();
    let names: Vec<&str> = found.lights.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["l/sun", "l/node 1", "l/node 2", "l/node 3"]);
    let AnyLight::Directional(sun) = &found.lights[0].1 else { panic!("{found:?}") };
    assert!(sun.intensity == 1.0 && (sun.direction - Vec3::NEG_Y).length() < 1e-6, "{sun:?}");
    let AnyLight::Point(point) = &found.lights[1].1 else { panic!("{found:?}") };
    assert_eq!((point.intensity, point.color, point.position), (Some(2.0), Rgb::new(1.0, 0.5, 0.0), 5.0 * Vec3::Y));
    let AnyLight::Spot(spot) = &found.lights[2].1 else { panic!("{found:?}") };
    assert!((spot.beam_degrees - 30.0).abs() < 1e-5 && (spot.cutoff_degrees - 60.0).abs() < 1e-5, "{spot:?}");
    let AnyLight::Point(hidden) = &found.lights[3].1 else { panic!("{found:?}") };
    assert_eq!(hidden.intensity, Some(0.0));
    let plain = parts_at(&model, 0.0);
    assert!(matches!(&plain.lights[1].1, AnyLight::Point(point) if point.intensity == Some(1366.0)));
}

#[test]
fn variants_choose_the_materials_of_primitives() {
    let mut builder = triangle();
    builder.member(
        r#""extensionsUsed": ["KHR_materials_variants"], "materials": [{}, {}],
            "extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "blue"}]}},
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0, "extensions":
            {"KHR_materials_variants": {"mappings": [{"variants": [1], "material": 1}]}}}]}],
            "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]"#,
    );
    let model = open(&builder);
    let material = |variant: Option<&str>| {
        let variant = variant.map(|name| NameOrIndex::Name(name.to_owned()));
        let found = model.parts(&ModelChoice { variant, ..ModelChoice::default() }, "").unwrap();
        assert_eq!(found.materials.len(), 1);
        found.materials.keys().next().cloned()
    };
    assert_eq!(material(None), material(Some("red")));
    assert_ne!(material(None), material(Some("blue")));
}

#[test]
fn light_profiles_are_assets() {
    let mut builder = Builder::default();
    builder.member(
        r#""extensionsUsed": ["EXT_lights_ies"], "scenes": [{"nodes": [0]}],
            "nodes": [{"extensions": {"EXT_lights_ies": {"light": 0, "multiplier": 2}}}],
            "extensions": {"EXT_lights_ies": {"lights": [{"uri": "data:;base64,SUVT"}]}}"#,
    );
    let found = parts(&builder);
    let AnyLight::Point(point) = &found.lights[0].1 else { panic!("{found:?}") };
    let ies = point.ies.as_ref().unwrap();
    assert_eq!((point.intensity, ies.direction, ies.absolute), (Some(2.0), Some(Vec3::NEG_Z), true));
    assert_eq!(found.assets[&ies.file].bytes(), Some(&b"IES"[..]));
}

#[test]
fn all_missing_files_are_reported_and_all_read_files_are_named() {
    let json = r#"{"asset": {"version": "2.0"}, "textures": [{"source": 0}, {"source": 1}],
        "images": [{"uri": "a.png"}, {"uri": "b%20c.png"}, {"uri": "unused.png"}]}"#;
    let open = |files: &BTreeMap<String, Vec<u8>>| GltfFormat::default().open("a.gltf", json.into(), files);
    let mut files = BTreeMap::new();
    let faults = open(&files).unwrap_err().faults;
    assert_eq!(
        faults,
        ["a.gltf: a.png (/images/0/uri): no such file", "a.gltf: b c.png (/images/1/uri): no such file"]
    );
    files.insert("a.png".to_owned(), vec![1]);
    files.insert("b c.png".to_owned(), vec![2]);
    let model = open(&files).unwrap();
    let names: Vec<&str> = model.files().iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["a.png", "b c.png"]);
    files.insert("b c.png".to_owned(), vec![3]);
    let other = open(&files).unwrap();
    let same = model.files().iter().zip(other.files()).map(|(file, other)| file == other);
    assert_eq!(same.collect::<Vec<_>>(), [true, false]);
    assert_eq!(model.digest(), other.digest(), "that of the file without the others");
    assert_eq!(model.summary(&ModelChoice::default()).unwrap().textures.len(), 3);
}
