//! Help for words of other programs: the name here, with the user's value converted, or no value.

use juggler_scene::{Bundle, Loader, Scene, SceneError};

/// Help of all problems of a scene, on a line each.
fn help(scene: &str) -> String {
    let problems = match Scene::from_json(scene, "scene.json") {
        Err(SceneError::Problems(problems)) => problems,
        Err(error) => return error.to_string(),
        Ok(scene) => scene.check(),
    };
    let lines = problems.list().iter().map(|problem| problem.help.clone().unwrap_or_default());
    lines.collect::<Vec<String>>().join("\n")
}

fn object(members: &str) -> String {
    format!(r#"{{"version": 1, "objects": [{{{members}}}]}}"#)
}

fn material(material: &str) -> String {
    object(&format!(r#""shape": "sphere", "material": {{{material}}}"#))
}

fn medium(members: &str) -> String {
    material(&format!(r#""boundary": {{"medium": {{{members}}}}}"#))
}

fn light(light: &str) -> String {
    format!(r#"{{"version": 1, "objects": [], "lights": [{{{light}}}]}}"#)
}

fn camera(members: &str) -> String {
    format!(r#"{{"version": 1, "objects": [], "camera": {{"perspective": {{{members}}}}}}}"#)
}

/// Checks that the help for each scene is the expected line, or ends with it.
fn check(rows: &[(String, &str)]) {
    let wrong = rows.iter().filter_map(|(scene, expected)| {
        let help = help(scene);
        (!help.lines().any(|line| line.ends_with(expected))).then(|| format!("{scene}\n  {expected}\n  {help}"))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn models_of_other_programs_lead_to_gltf() {
    check(&[
        (
            object(r#""shape": {"model": "car.glb"}"#),
            r#"write "model": {"file": "car.glb"} (a model file is no shape; Blender and others export `.glb`)"#,
        ),
        (
            object(r#""shape": {"model": {"file": "car.glb"}}"#),
            r#"write "model": {"file": "car.glb"} (a model file is no shape; Blender and others export `.glb`)"#,
        ),
        (object(r#""gltf": "x.glb""#), r#"write "model": {"file": "x.glb"} (Blender and others export `.glb`)"#),
        (object(r#""gltf": 3"#), r#"write "model": {"file": ...} (Blender and others export `.glb`)"#),
    ]);
}

#[test]
fn values_of_materials_are_converted() {
    check(&[
        (material(r#""phong": {"opacity": 0.8}"#), r#"called `transparency` here: write "transparency": 0.2"#),
        (material(r#""phong": {"transmit": 0.8}"#), r#"write "transparency": 0.8"#),
        (material(r#""phong": {"glossiness": 0.8}"#), r#"write "shininess": ..."#),
        (material(r#""principled": {"glossiness": 0.7}"#), r#"write "roughness": 0.3"#),
        (material(r#""principled": {"alpha": 0.2}"#), r#"write "opacity": 0.2"#),
        (
            material(r#""conductor": {"alpha": 0.25}"#),
            r#"write "roughness": 0.5 (the alpha of GGX is the square of `roughness`)"#,
        ),
        (material(r#""mask": {"transparency": "wood"}"#), r#"write "opacity": ..."#),
        (material(r#""principled": {"index_of_refraction": 1.4}"#), r#"write "ior": 1.4"#),
        (material(r##""MeshBasicMaterial": {"color": "#f00"}"##), r##"write {"unlit": {"color": "#f00"}}"##),
        (material(r#""MeshBasicMaterial": {"map": "wood"}"#), r#"write {"unlit": {"color": [...]}}"#),
        (material(r#""glass": {"ior": 1.7}"#), r#"write {"dielectric": {"ior": 1.7}}"#),
        (material(r#""thin_dielectric": {"ior": 1.7}"#), r#"write {"dielectric": {"thin": true, "ior": 1.7}}"#),
        (object(r#""shape": "sphere", "material": "glass""#), r#"write {"dielectric": {"ior": 1.5}}"#),
    ]);
}

#[test]
fn extinction_and_albedo_become_absorption_and_scattering() {
    let note = "(the extinction is the sum of absorption and scattering, the albedo the share of scattering)";
    let both = r#""sigma_t": 2, "albedo": [0.5, 0.75, 1]"#;
    let written = format!(r#"here: write "absorption": [1, 0.5, 0], "scattering": [1, 1.5, 2] {note}"#);
    let unknown = format!(r#"write "absorption": [...], "scattering": [...] {note}"#);
    check(&[
        (medium(both), &format!("`sigma_t` is `absorption` and `scattering` {written}")),
        (medium(both), &format!("`albedo` is `absorption` and `scattering` {written}")),
        (medium(r#""sigma_t": 2"#), &unknown),
        (medium(r#""sigma_a": [1, 2, 3]"#), r#"write "absorption": [1, 2, 3]"#),
        (medium(r#""density": 2"#), r#"write "absorption": [...]"#),
    ]);
}

#[test]
fn units_of_lights_are_converted() {
    let lumens = "(watts: lumens divided by 683 lm/W, or by the luminous efficacy of the light source in lm/W)";
    check(&[
        (light(r#""point": {"lumens": 1366}"#), &format!(r#"write "power": 2 {lumens}"#)),
        (light(r#""area": {"lumens": 683}"#), &format!(r#"write "power": 1 {lumens}"#)),
        (light(r#""point": {"energy": 40}"#), r#"called `power` here: write "power": 40 (watts)"#),
        (light(r#""spot": {"energy": 40}"#), r#"write "power": 40 (watts)"#),
        (light(r#""directional": {"energy": 4}"#), r#"write "intensity": 4"#),
        (light(r#""directional": {"lumens": 800}"#), r#"write "intensity": ..."#),
        (light(r#""area": {"intensity": 4}"#), r#"called `radiance` here: write "radiance": 4"#),
        (
            light(r#""spot": {"spot_size": 1.5707963}"#),
            "write \"cutoff_degrees\": 45 (degrees from the axis instead of radians from side to side)",
        ),
        (light(r#""spot": {"position": [0, 4, 0], "target": [1, 2, 3]}"#), r#"write "direction": [1, -2, 3]"#),
        (light(r#""spot": {"target": [1, 2, 3]}"#), r#"write "direction": [...]"#),
        (
            light(r#""sun": {"direction": [1, -1, 0]}"#),
            r#"write {"directional": {"direction": [1, -1, 0]}} (`direction` is where the light travels: straight down is [0, -1, 0])"#,
        ),
    ]);
}

#[test]
fn values_of_cameras_are_converted() {
    let note = "(the sensor's size and the focal length in the same unit)";
    check(&[
        (camera(r#""lens": 85"#), r#"write "focal_length": 85 (millimeters)"#),
        (
            camera(r#""lens": 50, "sensor_width": 23.5, "sensor_height": 15"#),
            &format!(r#"write "view_plane": {{"width": 23.5, "height": 15, "distance": 50}} {note}"#),
        ),
        (camera(r#""f_stop": 2.8"#), r#"write "f_stop": 2.8"#),
        (camera(r#""fov": 60"#), r#"write "vertical_fov_degrees": 60"#),
        (camera(r#""fov": "wide""#), r#"write "vertical_fov_degrees": ..."#),
        (camera(r#""yfov": 0.5"#), r#"write "vertical_fov_degrees": 28.6479 (degrees)"#),
        (camera(r#""location": [1, 2, 3]"#), r#"write "eye": [1, 2, 3]"#),
        (camera(r#""aperture": 0.1"#), r#"write "lens_radius": ... (scene units)"#),
    ]);
}

#[test]
fn values_of_objects_are_converted() {
    let sphere = |more: &str| object(&format!(r#""shape": "sphere", {more}"#));
    let mesh = |more: &str| object(&format!(r#""shape": {{"mesh": {{{more}}}}}"#));
    check(&[
        (sphere(r#""hidden": false"#), r#"called `visible` here: write "visible": true"#),
        (sphere(r#""hidden": true"#), r#"write "visible": false"#),
        (sphere(r#""show": false"#), r#"write "visible": false"#),
        (sphere(r#""position": [1, 2, 3]"#), r#"write "transform": {"translate": [1, 2, 3]}"#),
        (sphere(r#""rotate_y": 90"#), r#"write "transform": {"rotate": {"axis": [0, 1, 0], "degrees": 90}} (degrees)"#),
        (
            sphere(r#""transform": [{"rotate_x": 45}]"#),
            r#"write {"rotate": {"axis": [1, 0, 0], "degrees": 45}} (degrees)"#,
        ),
        (
            sphere(r#""rotation": [0, 1.5707963, 0]"#),
            r#"write "transform": {"rotate": [0, 90, 0]} (degrees about the x axis, then y, then z)"#,
        ),
        (
            sphere(r#""rotation": [0, 45, 90]"#),
            r#"write "transform": {"rotate": [0, 45, 90]} (degrees about the x axis, then y, then z)"#,
        ),
        (
            sphere(r#""rotate": [0, 30, 0]"#),
            r#"write "transform": {"rotate": [0, 30, 0]} (degrees about the x axis, then y, then z)"#,
        ),
        (sphere(r##""color": "#f80""##), r##"write "material": {"diffuse": {"reflectance": "#f80"}}"##),
        (
            mesh(r#""position": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]"#),
            r#"called `positions` here: write "positions": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]"#,
        ),
        (mesh(r#""position": [0, 1, 0]"#), r#"write "transform": {"translate": [0, 1, 0]}"#),
        (mesh(r#""position": [0, 0, 0, 1, 0, 0]"#), r#"called `positions` here: write "positions": [...]"#),
        (object(r#""shape": {"box": {"size": 2}}"#), r#"write {"cuboid": {"min": [...], "max": [...]}}"#),
        (
            object(r#""shape": {"cuboid": {"size": 3}}"#),
            r#"`size` is `min` and `max` here: write "min": [-1.5, -1.5, -1.5], "max": [1.5, 1.5, 1.5]"#,
        ),
        (object(r#""shape": {"sphere": {"diameter": 3}}"#), r#"write "radius": 1.5"#),
    ]);
}

/// Values in a wrong form lead to the right form of the same value.
#[test]
fn values_in_a_wrong_form_are_rewritten() {
    let opacity = "opacity is no part of a color: `principled` and `mask` have";
    check(&[
        (material(r#""principled": {"roughness": "0.5"}"#), "write 0.5 without quotes"),
        (material(r#""principled": {"metallic": true}"#), r#"write "metallic": 1"#),
        (material(r#""diffuse": {"reflectance": "0.8 0.2 0"}"#), r#"write "reflectance": [0.8, 0.2, 0]"#),
        (
            material(r#""diffuse": {"reflectance": "wood.png"}"#),
            r#"write "reflectance": {"image": {"file": "wood.png"}}"#,
        ),
        (
            material(r#""diffuse": {"reflectance": [1, 0.5, 0, 0.25]}"#),
            &format!("write [1, 0.5, 0]; {opacity} \"opacity\": 0.25"),
        ),
        (
            material(r##""diffuse": {"reflectance": "#ff800080"}"##),
            &format!("write \"#ff8000\"; {opacity} \"opacity\": 0.502"),
        ),
        (material(r#""principled": {"thin": "true"}"#), "write true without quotes"),
    ]);
}

#[test]
fn scenes_in_a_wrong_form_are_rewritten() {
    let scene = |more: &str| format!(r#"{{"version": 1, {more}}}"#);
    let with = |more: &str| scene(&format!(r#""objects": [], {more}"#));
    let long: Vec<String> = (0..9).map(|i| format!(r#""ball{i}": {{"shape": "sphere"}}"#)).collect();
    check(&[
        (with(r#""render": {"samples": "64"}"#), "write 64 without quotes"),
        (with(r#""render": {"samples": "2*32"}"#), r#"an expression begins with `=`: "=2*32""#),
        (with(r#""render": {"size": "1920x1080"}"#), r#"write "size": [1920, 1080]"#),
        (with(r#""render": {"denoise": true}"#), "the command line here: `juggler render --denoise`"),
        (with(r#""background": "x.hdr""#), r#"write "background": {"environment": {"file": "x.hdr"}}"#),
        (with(r#""background": {"environment": "x.hdr"}"#), r#"write "environment": {"file": "x.hdr"}"#),
        (scene(r#""objects": {}"#), r#"write "objects": []"#),
        (scene(r#""objects": {"shape": "sphere"}"#), r#"write "objects": [{"shape": "sphere"}]"#),
        (scene(r#""objects": {"ball": {"shape": "sphere"}}"#), r#"write "objects": [{"shape": "sphere"}]"#),
        (camera(r#""look_at": [0, 0, 0], "eye": "0 2 6""#), r#"write "eye": [0, 2, 6]"#),
        (camera(r#""look_at": [0, 0, 0], "eye": {"x": 0, "y": 2, "z": 6}"#), r#"write "eye": [0, 2, 6]"#),
        (
            with(r#""camera": {"equirectangular": {"eye": [0, 1, 0]}}"#),
            "panoramic cameras are not in this version; kinds: `perspective`, `thin_lens` and `orthographic`",
        ),
        (scene(&format!(r#""objects": {{{}}}"#, long.join(", "))), r#"write a list in [ ]: "objects": [...]"#),
        (object(r#""shape": {"mesh": "x.stl"}"#), r#"write "mesh": {"file": "x.stl"}"#),
        (object(r#""shape": "x.stl""#), r#"write "shape": {"mesh": {"file": "x.stl"}}"#),
        (object(r#""shape": {"sphere": {"radius": "1"}}"#), "write 1 without quotes"),
        (object(r#""shape": {"sphere": {"radius": "r"}}"#), r#"an expression begins with `=`: "=r""#),
        (object(r#""radius": 2"#), r#"write "shape": {"sphere": {"radius": 2}}"#),
    ]);
}

/// Geometries of three.js name shapes, with and without a type.
#[test]
fn geometries_of_three_js_lead_to_shapes() {
    let geometry = |value: &str| object(&format!(r#""geometry": {value}"#));
    check(&[
        (geometry(r#""BoxGeometry""#), r#"write "shape": {"cuboid": {"min": [...], "max": [...]}}"#),
        (
            geometry(r#"{"type": "BoxGeometry", "width": 2}"#),
            r#"write "shape": {"cuboid": {"min": [...], "max": [...]}}"#,
        ),
        (
            geometry(r#""CylinderGeometry""#),
            r#"write "shape": {"cylinder": {"radius": ..., "y_min": ..., "y_max": ...}}"#,
        ),
        (geometry(r#"{"SphereGeometry": {"radius": 3}}"#), r#"write "shape": {"sphere": {"radius": 3}}"#),
        (geometry(r#"{"PlaneGeometry": {}}"#), r#"write "shape": {"rectangle": {"size": [2, 2]}}"#),
        (geometry(r#""BufferGeometry""#), r#"write "shape": {"mesh": {"file": ...}}"#),
        (object(r#""BoxGeometry": {"width": 2}"#), r#"write "shape": {"cuboid": {...}}"#),
    ]);
}

/// The steps of all keys are one transform, since each key stands once.
#[test]
fn keys_of_one_transform_are_combined() {
    let all = r#"write "transform": [{"scale": 2}, {"rotate": [0, 90, 0]}, {"translate": [1, 2, 3]}]"#;
    let sphere = |more: &str| object(&format!(r#""shape": "sphere", {more}"#));
    check(&[
        (sphere(r#""position": [1, 2, 3], "rotate": [0, 90, 0], "scale": 2"#), all),
        (
            sphere(r#""location": [1, 2, 3], "rotate_y": 90"#),
            r#"write "transform": [{"rotate": {"axis": [0, 1, 0], "degrees": 90}}, {"translate": [1, 2, 3]}]"#,
        ),
        (
            object(r#""shape": {"sphere": {"center": [1, 2, 3], "scale": 2}}"#),
            r#"write "transform": [{"scale": 2}, {"translate": [1, 2, 3]}]"#,
        ),
        (sphere(r#""position": [1, 2, 3]"#), r#"write "transform": {"translate": [1, 2, 3]}"#),
    ]);
}

#[test]
fn a_focus_on_objects_leads_to_the_animation_of_its_distance() {
    let keys = r#"{"animate": {"keys": [[0, "a"], [1, "b"]]}}"#;
    let lens =
        format!(r#"{{"thin_lens": {{"eye": [0, 0, 5], "look_at": [0, 0, 0], "f_stop": 2, "focus_on": {keys}}}}}"#);
    let error = Scene::from_json(format!(r#"{{"version": 1, "objects": [], "camera": {lens}}}"#), "scene.json");
    let report = error.unwrap_err().to_string();
    let expected = r#"write "interpolation": "step", or animate `focus_distance` for a smooth focus pull"#;
    assert!(report.contains(expected), "{report}");
}

#[test]
fn values_of_settings_are_converted() {
    let scene = |more: &str| format!(r#"{{"version": 1, "objects": [], {more}}}"#);
    check(&[
        (scene(r#""render": {"width": 800, "height": 600}"#), r#"write "size": [800, 600]"#),
        (scene(r#""render": {"width": 800}"#), r#"write "size": [800, ...]"#),
        (scene(r#""render": {"spp": 128}"#), r#"write "samples": 128"#),
        (scene(r#""background_color": [0, 0, 1]"#), r#"write "background": [0, 0, 1]"#),
        (scene(r#""hdri": "sky.hdr""#), r#"write "background": {"environment": {"file": "sky.hdr"}}"#),
        (
            scene(r#""models": "car.glb""#),
            "write \"objects\": [{\"model\": {\"file\": \"car.glb\"}}] (Blender and others export `.glb`)",
        ),
    ]);
}

/// Other programs' words for the color of a material are read as its name here, with a warning.
#[test]
fn words_for_the_color_of_a_material_are_accepted() {
    for (kind, key) in [
        ("diffuse", "reflectance"),
        ("plastic", "reflectance"),
        ("conductor", "reflectance"),
        ("phong", "diffuse"),
        ("principled", "base_color"),
    ] {
        let with = |word: &str, value: &str| material(&format!(r#""{kind}": {{"{word}": {value}}}"#));
        for value in [r##""#ff0000""##, "[0, 0.5, 1]", "0.25", r#"{"noise": {"scale": 4}}"#] {
            let expected = Scene::from_json(with(key, value), "scene.json").unwrap();
            for word in ["color", "albedo", "diffuseColor", "diffuse_color"] {
                let scene = Scene::from_json(with(word, value), "scene.json").unwrap();
                // Inline textures are named by their places.
                let written = scene.to_json().replace(&format!("/{kind}/{word}"), &format!("/{kind}/{key}"));
                assert_eq!(written, expected.to_json(), "{kind} {word} {value}");
                let warnings = scene.check();
                let message = format!("`{word}` is read as `{key}`, its name here");
                assert_eq!((warnings.errors(), warnings.warnings()), (0, 1), "{warnings}");
                assert!(warnings.list()[0].message == message && warnings.list()[0].column.is_some(), "{warnings}");
            }
        }
        let both = with("color", &format!(r#"0.5, "{key}": 0.5"#));
        assert!(help(&both).contains(&format!("called `{key}`")), "{}", help(&both));
        let twice = with("color", r#"0.5, "albedo": 0.5"#);
        assert!(help(&twice).contains(&format!("called `{key}`")), "{}", help(&twice));
    }
    // A material of two colors does not have the word.
    let velvet = material(r#""velvet": {"color": [1, 0, 0]}"#);
    assert!(help(&velvet).contains("called `reflectance`"), "{}", help(&velvet));
}

#[test]
fn missing_files_lead_to_files_of_the_same_folder() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["wood.png", "cow.ply", "materials.json"] {
        std::fs::write(folder.path().join(name), "{}").unwrap();
    }
    let image = r#"{"shape": "sphere", "material": {"diffuse": {"reflectance": {"image": {"file": "wood2.png"}}}}}"#;
    let mesh = r#"{"shape": {"mesh": {"file": "cow2.ply"}}}"#;
    let far = r#"{"shape": {"mesh": {"file": "teapot.obj"}}}"#;
    for (scene, expected) in [
        (format!(r#"{{"version": 1, "objects": [{image}]}}"#), "wood2.png`: file not found; did you mean `wood.png`?"),
        (format!(r#"{{"version": 1, "objects": [{mesh}]}}"#), "cow2.ply`: file not found; did you mean `cow.ply`?"),
        (format!(r#"{{"version": 1, "objects": [{far}]}}"#), "teapot.obj`: file not found\n"),
        (
            r#"{"version": 1, "include": ["material.json"], "objects": []}"#.to_owned(),
            "material.json`: file not found; did you mean `materials.json`?",
        ),
    ] {
        let file = folder.path().join("scene.json");
        std::fs::write(&file, scene).unwrap();
        let report = match Scene::load(&file) {
            Ok(scene) => scene.check().to_string(),
            Err(error) => error.to_string(),
        };
        assert!(report.contains(expected), "{expected}: {report}");
    }
    // Files in memory are those of their bundle.
    let scene = format!(r#"{{"version": 1, "objects": [{mesh}]}}"#);
    let files = [("scene.json", scene.as_bytes()), ("cow.ply", b"ply")];
    let bundle: Bundle = files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect();
    let report = Loader::default().from_bundle(bundle, "scene.json").unwrap().check().to_string();
    assert!(report.contains("did you mean `cow.ply`?"), "{report}");
}

#[test]
fn backslashes_in_file_names_lead_to_slashes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("models")).unwrap();
    std::fs::write(folder.path().join("models/cow.ply"), "ply").unwrap();
    for (name, expected) in [
        (r"models\\cow.ply", "file not found; did you mean `models/cow.ply`?"),
        (r"models\\dog.ply", r"file not found; write `/` in place of `\`: `models/dog.ply`"),
    ] {
        let file = folder.path().join("scene.json");
        let mesh = format!(r#"{{"shape": {{"mesh": {{"file": "{name}"}}}}}}"#);
        std::fs::write(&file, format!(r#"{{"version": 1, "objects": [{mesh}]}}"#)).unwrap();
        let report = Scene::load(&file).unwrap().check().to_string();
        assert!(report.contains(expected), "{report}");
    }
}

#[test]
fn backslashes_in_file_names_are_explained() {
    let scene = object(r#""model": {"file": "C:\models\x.obj"}"#);
    assert!(help(&scene).contains(r#"write `/` in file names, as in "C:/models/x.obj""#), "{}", help(&scene));
}
