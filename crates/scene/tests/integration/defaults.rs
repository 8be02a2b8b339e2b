//! Defaults of incomplete scenes: integrator, lights, and warnings about lights without effect.

use juggler_math::Vec3;
use juggler_scene::compile::ShapePlace;
use juggler_scene::{IntegratorReason, Scene, SceneError};

/// A scene with these members.
fn scene(members: &str) -> Scene {
    let separator = if members.is_empty() { "" } else { "," };
    Scene::from_json(format!(r#"{{"version": 1{separator} {members}}}"#), "s.json").unwrap()
}

fn sphere(material: &str) -> String {
    format!(r#""objects": [{{"shape": "sphere", "material": {material}}}]"#)
}

/// Paths and messages of a scene's warnings; the scene must have no errors.
fn warnings(scene: &Scene) -> Vec<(String, String)> {
    let problems = scene.check();
    assert_eq!(problems.errors(), 0, "{problems}");
    problems.list().iter().map(|problem| (problem.path.clone(), problem.message.clone())).collect()
}

#[test]
fn phong_scenes_default_to_the_classic_integrator() {
    for members in [
        r#""objects": [{"shape": "sphere"}]"#,
        r#""lights": [{"point": {}}, {"spot": {}}, {"directional": {}}, {"ambient": {}}], "objects": []"#,
        r#""background": {"gradient": {}}, "objects": []"#,
        r#""background": [0.2, 0.3, 0.4], "objects": []"#,
        &sphere(r#"{"phong": {"emission": [1, 1, 1], "reflection": 0.5, "transparency": 0.5}}"#),
        &sphere(
            r#"{"mix": {"a": {"phong": {}}, "b": {"checkerboard": {"even": {"phong": {}}, "odd": {"phong": {}}}}}}"#,
        ),
        &sphere(r#"{"mask": {"material": {"phong": {}}, "opacity": 0.5}}"#),
    ] {
        let choice = scene(members).integrator_choice();
        assert_eq!((choice.integrator.name(), &choice.reason), ("classic", &IntegratorReason::Classic), "{members}");
        assert_eq!(
            choice.reason.to_string(),
            "chosen because `classic` supports all lights and materials of the scene"
        );
    }
}

#[test]
fn features_beyond_classic_select_the_path_integrator() {
    for (members, says) in [
        (sphere(r#"{"emissive": {}}"#), "`emissive` at `objects[0].material`"),
        (
            r#""materials": {"emitter": {"emissive": {}}}, "objects": [{"shape": "sphere", "material": "emitter"}]"#
                .into(),
            "`emissive` at `materials.emitter`",
        ),
        (sphere(r#"{"mix": {"a": {"phong": {}}, "b": {"dielectric": {}}}}"#), "`dielectric` at `objects[0].material`"),
        (sphere(r#"{"principled": {}}"#), "`principled` at `objects[0].material`"),
        (sphere(r#"{"boundary": {"medium": {"scattering": 0.1}}}"#), "`boundary` at `objects[0].material`"),
        (r#""background": {"sky": {}}, "objects": []"#.into(), "`sky` at `background`"),
        (
            r#""groups": {"pair": [{"objects": [{"shape": "cuboid", "material": {"diffuse": {}}}]}]}, "objects": []"#
                .into(),
            "`diffuse` at `groups.pair[0].objects[0].material`",
        ),
        (
            r#""lights": [{"point": {}}, {"area": {}}], "materials": {"a": {"diffuse": {}}}, "objects": []"#.into(),
            "`area` at `lights[1]`",
        ),
    ] {
        let choice = scene(&members).integrator_choice();
        let reason = choice.reason.to_string();
        assert_eq!(choice.integrator.name(), "path", "{members}");
        assert!(reason.starts_with("chosen because `classic` does not support ") && reason.contains(says), "{reason}");
        let named = scene(&format!(r#""render": {{"integrator": "classic"}}, {members}"#)).integrator_choice();
        assert_eq!((named.integrator.name(), named.reason), ("classic", IntegratorReason::Scene));
    }
}

#[test]
fn default_integrator_has_the_fingerprint_of_the_named_integrator() {
    for (material, name) in [(r#"{"phong": {}}"#, "classic"), (r#"{"diffuse": {}}"#, "path")] {
        let open = scene(&sphere(material));
        let named = scene(&format!(r#""render": {{"integrator": "{name}"}}, {}"#, sphere(material)));
        assert_eq!(open.fingerprint(), named.fingerprint());
        assert!(!open.to_json().contains("integrator") && open.compile().unwrap().integrator.integrator.name() == name);
        assert!(open.has_world_of(&named));
    }
    let open = scene(r#""objects": [{"shape": "sphere"}]"#);
    let path = scene(r#""render": {"integrator": "path"}, "objects": [{"shape": "sphere"}]"#);
    assert!(!open.has_world_of(&path), "the default lights differ");
    let lit =
        |more: &str| scene(&format!(r#"{more} "lights": [{{"point": {{}}}}], "objects": [{{"shape": "sphere"}}]"#));
    assert!(lit("").has_world_of(&lit(r#""render": {"integrator": "path"},"#)));
}

#[test]
fn scenes_without_lights_get_a_default_light_for_their_integrator() {
    let key = |members: &str| {
        let world = scene(members).compile().unwrap().world;
        let light = world.lights()[0].at(0.0).light.sample(Vec3::ZERO, juggler_math::Vec2::ZERO).unwrap();
        assert_eq!(world.lights().len(), 1);
        (light.radiance.g, world.ambient().g)
    };
    let (classic, ambient) = key(r#""objects": [{"shape": "sphere"}]"#);
    assert!((classic - 0.6).abs() < 0.01 && ambient == 0.15, "{classic} {ambient}");
    // A white diffuse surface reflects L / π of a light without a surface, a white classic one L.
    let (path, ambient) = key(&sphere(r#"{"diffuse": {}}"#));
    assert!((path / std::f32::consts::PI - classic).abs() < 0.01 && ambient == 0.0, "{path} {ambient}");
    let (phong, ambient) = key(r#""render": {"integrator": "path"}, "objects": [{"shape": "sphere"}]"#);
    assert_eq!((phong, ambient), (classic, 0.0));
    let both = r#""objects": [{"shape": "sphere"}, {"shape": "cuboid", "material": {"diffuse": {}}}]"#;
    assert!(key(both).0 > phong && key(both).0 < path);
}

#[test]
fn lights_that_light_nothing_are_warned_of() {
    let lights = r#""lights": [{"ambient": {}}, {"point": {"extent": {"sphere": {"radius": 1}}, "samples": 4}}]"#;
    let path = scene(&format!(r#""render": {{"integrator": "path"}}, {lights}, "objects": [{{"shape": "plane"}}]"#));
    assert_eq!(
        warnings(&path),
        [
            ("lights[0]".to_owned(), "an `ambient` light has no effect with the integrator `path`".to_owned()),
            ("lights[1].point.samples".into(), "`samples` of a light has no effect with the integrator `path`".into()),
        ]
    );
    assert_eq!(warnings(&scene(&format!(r#"{lights}, "objects": [{{"shape": "plane"}}]"#))), []);
    let classic = |more: &str| scene(&format!(r#""render": {{"integrator": "classic"}}, {more}"#));
    let light = sphere(r#"{"emissive": {}}"#);
    let warning = |message: &str, path: &str| vec![(path.to_owned(), message.to_owned())];
    let emits = warning("`emissive` does not light the scene with the integrator `classic`", "objects[0].material");
    assert_eq!(warnings(&classic(&light)), emits);
    assert_eq!(warnings(&scene(&light)), []);
    let sky = r#""background": {"sky": {}}, "objects": [{"shape": "plane"}]"#;
    assert_eq!(
        warnings(&classic(sky)),
        warning("`sky` does not light the scene with the integrator `classic`", "background")
    );
    assert_eq!(warnings(&classic(&format!(r#"{sky}, "lights": [{{"point": {{}}}}]"#))), []);
}

const AREA: &str =
    r#"{"area": {"shape": {"disk": {"radius": 0.5}}, "position": [0, 3, 0], "power": 50, "light_group": "top"}}"#;

#[test]
fn an_area_light_is_a_shape_behind_all_objects() {
    let scene = scene(&format!(r#""lights": [{{"point": {{}}}}, {AREA}], "objects": [{{"shape": "sphere"}}]"#));
    let compiled = scene.compile().unwrap();
    let (world, names) = (&compiled.world, &compiled.names);
    assert_eq!((world.geometry_stats().shapes, world.entry_of(1)), (2, 1));
    assert_eq!((names.entries, names.object(0), names.object(1)), (2, "objects[0]".into(), "lights[1]".into()));
    assert_eq!(names.light_groups[usize::from(world.shape_group(1).0)], "top");
    assert_eq!(names.light_groups[usize::from(world.shape_group(0).0)], "rest");
    assert_eq!(ShapePlace::find(&scene.description, 1).unwrap().path, "lights[1]");
    assert!(world.shape_bounds(1).center().abs_diff_eq(Vec3::new(0.0, 3.0, 0.0), 1e-5));
    // The default camera frames the objects, also when the world is reused.
    let again = scene.compile_after(&scene, &compiled).unwrap();
    assert!(compiled.bounds.max.y <= 1.0 && again.cameras == compiled.cameras);
    assert_eq!(scene.needs().objects, 2);
}

/// Each light and each object of this scene has a light group of its own; the group `rest` comes on
/// top.
fn grouped(lights: usize, objects: usize) -> Scene {
    let light = |i| format!(r#"{{"point": {{"light_group": "light {i}"}}}}"#);
    let object = |i| format!(r#"{{"shape": "sphere", "light_group": "object {i}"}}"#);
    let [lights, objects] =
        [(0..lights).map(light).collect::<Vec<_>>(), (0..objects).map(object).collect()].map(|list| list.join(","));
    scene(&format!(r#""lights": [{lights}], "objects": [{objects}]"#))
}

#[test]
fn number_of_light_groups_is_limited() {
    let most = grouped(9, (1 << 16) - 10);
    assert_eq!(most.check().errors(), 0, "{}", most.check());
    let more = grouped(9, (1 << 16) - 9);
    let problems = more.check();
    assert_eq!(problems.errors(), 1, "{problems}");
    let SceneError::Problems(at_render) = more.compile().map(drop).unwrap_err() else { panic!("no problems") };
    assert_eq!(at_render.list(), problems.list());
    let (problem, limit) = (&problems.list()[0], "65537 light groups, at most 65536 are allowed");
    assert_eq!(problem.path, "objects[65526].light_group");
    assert_eq!(problem.message, format!("light group `object 65526` exceeds the limit: {limit}"));
}

/// Settings that another setting replaces are named, also inside other materials.
#[test]
fn settings_of_a_metal_without_effect_are_warned_of() {
    let conductor = r#"{"conductor": {"metal": "gold", "eta": [0.2, 0.2, 0.2], "roughness": 0.1}}"#;
    let warned = |path: &str| (path.to_owned(), "`eta` has no effect, because `metal` replaces it".to_owned());
    assert_eq!(warnings(&scene(&sphere(conductor))), [warned("objects[0].material.conductor.eta")]);
    let mask = format!(r#"{{"mask": {{"material": {conductor}, "opacity": 0.5}}}}"#);
    assert_eq!(warnings(&scene(&sphere(&mask))), [warned("objects[0].material.mask.material.conductor.eta")]);
    let named = scene(&format!(r#""materials": {{"gold": {conductor}}}, {}"#, sphere(r#""gold""#)));
    assert_eq!(warnings(&named), [warned("materials.gold.conductor.eta")]);
    assert!(named.check().to_string().contains("remove `eta` or `metal`"));
    let wrong = conductor.replace("[0.2,", "[5000,");
    assert_eq!(scene(&sphere(&wrong)).check().errors(), 1);
    assert_eq!(warnings(&scene(&sphere(r#"{"conductor": {"metal": "gold", "roughness": 0.1}}"#))), []);
}

#[test]
fn an_area_light_moves_while_the_shutter_is_open() {
    let light = r#"{"area": {"position": ["=frame", 3, 0]}}"#;
    let scene = scene(&format!(
        r#""render": {{"shutter": [0, 1]}}, "animation": {{"frames": 5}}, "lights": [{light}], "objects": [{{"shape": "sphere"}}]"#
    ));
    let world = scene.compile().unwrap().world;
    let bounds = world.shape_bounds(1);
    assert!(world.moves() && (bounds.min.x + 0.5).abs() < 1e-3 && (bounds.max.x - 1.5).abs() < 1e-3, "{bounds:?}");
}

/// A room with a floor and a ceiling at height 3, with the given object and lights.
fn room(object: &str, lights: &str) -> Scene {
    let camera = r#"{"perspective": {"eye": [0, 1.5, 6], "look_at": [0, 1.5, 0]}}"#;
    let ceiling = r#"{"shape": {"rectangle": {"size": [8, 8]}}, "transform": [{"translate": [0, 3, 0]}]}"#;
    scene(&format!(
        r#""camera": {camera}, "lights": [{lights}],
            "objects": [{{"shape": {{"rectangle": {{"size": [8, 8]}}}}}}, {ceiling} {object}]"#
    ))
}

fn light(height: f32, turn: &str, sides: &str) -> String {
    format!(
        r#", {{"shape": "rectangle", "material": {{"emissive": {{"sides": "{sides}"}}}},
            "transform": [{turn} {{"translate": [0, {height}, 0]}}]}}"#
    )
}

const TURN: &str = r#"{"rotate": {"axis": [1, 0, 0], "degrees": 180}},"#;

#[test]
fn emitters_whose_light_goes_nowhere_are_warned_of() {
    let touching = "the front of this rectangle, which emits light along [0, 1, 0], lies on `objects[1]`";
    // The ceiling light emits upwards, into the ceiling or above it.
    for height in [3.0, 2.995] {
        assert_eq!(warnings(&room(&light(height, "", "front"), "")), [("objects[2]".into(), touching.to_owned())]);
    }
    let away = "this rectangle emits light along [0, 1, 0], away from everything in the scene";
    assert_eq!(warnings(&room(&light(3.5, "", "front"), "")), [("objects[2]".into(), away.to_owned())]);
    let area = |more: &str| room("", &format!(r#"{{"area": {{"position": [0, 3.5, 0], {more}}}}}"#));
    let up = area(r#""direction": [0, 2, 0]"#);
    assert_eq!(warnings(&up), [("lights[0]".into(), away.to_owned())]);
    assert!(up.check().to_string().contains("turn it with `direction` or `look_at`"));
    // Rotated, two-sided and distant lights cause no warnings.
    for (height, turn, sides) in [(2.99, TURN, "front"), (2.0, "", "front"), (3.5, "", "both"), (3.5, TURN, "front")] {
        assert_eq!(warnings(&room(&light(height, turn, sides), "")), [], "{height} {turn} {sides}");
    }
    assert_eq!(warnings(&area(r#""radiance": 1"#)), []);
    // An infinite floor behind the front is not lit, one ahead is, and so is one at another angle.
    let floor = |height: f32, turn: &str| {
        let plane = format!(r#"{{"shape": "plane", "transform": [{turn} {{"translate": [0, {height}, 0]}}]}}"#);
        warnings(&room(&format!("{}, {plane}", light(3.5, "", "front")), ""))
    };
    assert_eq!(floor(-1.0, ""), [("objects[2]".into(), away.to_owned())]);
    assert_eq!((floor(5.0, ""), floor(-1.0, r#"{"rotate": {"axis": [1, 0, 0], "degrees": 10}},"#)), (vec![], vec![]));
    // A screen that only the camera sees.
    let screen = r#", {"shape": "rectangle", "material": {"emissive": {}},
        "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [0, 1, 4.5]}]}"#;
    assert_eq!(warnings(&room(screen, "")), []);
}
