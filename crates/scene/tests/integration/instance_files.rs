//! Instances of files and assets: what scenes make of them, and messages about them.

use juggler_math::{Ray, Vec3};
use juggler_scene::compile::Compiled;
use juggler_scene::{
    Asset, Bundle, InstanceAttribute, Instances, Loader, NamedAttributes, Object, ScaleFactors, Scene, SceneError,
};
use juggler_shape::attribute::AttributeData;
use juggler_shape::{Mesh, Sphere};
use serde_json::json;

/// Three instances with an attribute of 0.25, 0.5 and 0.75.
fn three() -> Instances {
    Instances { attributes: attribute("heat", &[0.25, 0.5, 0.75]), ..Instances::at([0.0, 3.0, 6.0].map(at)) }
}

fn at(x: f32) -> Vec3 {
    Vec3::new(x, 0.0, 0.0)
}

fn attribute(name: &str, numbers: &[f32]) -> NamedAttributes {
    [(name.to_owned(), InstanceAttribute::new(1, AttributeData::F32(numbers.to_vec())))].into_iter().collect()
}

const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
    property float heat\nend_header\n0 0 0 0.5\n3 0 0 1\n";

/// A scene of spheres with these instances, which show the attribute `heat`.
fn text(instances: &str) -> String {
    format!(
        r#"{{"version": 1, "render": {{"size": [8, 8]}}, "materials": {{"m": {{"unlit": {{"color": "t"}}}}}},
            "textures": {{"t": {{"attribute": {{"name": "heat"}}}}}},
            "objects": [{{"shape": "sphere", "material": "m", "instances": {instances}}}]}}"#
    )
}

fn load(instances: &str, assets: impl IntoIterator<Item = (&'static str, Asset)>) -> Result<Scene, SceneError> {
    let assets = assets.into_iter().map(|(name, asset)| (name.to_owned(), asset));
    Loader::default().from_json_with(text(instances), "scene.json", assets)
}

fn with_asset(instances: Instances) -> Scene {
    load(r#"{"file": "points"}"#, [("points", Asset::from_instances(instances))]).unwrap()
}

fn message(scene: &Scene) -> String {
    scene.compile().err().unwrap().to_string()
}

/// What a ray along -z at (x, 0) sees: the emission of an unlit material; `None` if it hits nothing.
fn seen(compiled: &Compiled, x: f32) -> Option<[f32; 3]> {
    let world = &compiled.world;
    let mut ray = Ray::new(Vec3::new(x, 0.0, 20.0), Vec3::NEG_Z);
    let hit = world.closest(&mut ray);
    let vertex = hit.is_some().then(|| world.vertex(&ray, &hit))?;
    Some(world.shade(&vertex, Vec3::Z, 1.0, 0.5).emission.to_array())
}

fn gray(number: f32) -> Option<[f32; 3]> {
    Some([number; 3])
}

#[test]
fn an_asset_stands_for_a_file_of_points() {
    let compiled = with_asset(three()).compile().unwrap();
    assert_eq!(compiled.world.geometry_stats().shapes, 3);
    assert_eq!([0.0, 1.5, 3.0, 6.0].map(|x| seen(&compiled, x)), [gray(0.25), None, gray(0.5), gray(0.75)]);
    let inline = load(&serde_json::to_string(&three()).unwrap(), []).unwrap().compile().unwrap();
    assert_eq!([0.0, 3.0, 6.0].map(|x| seen(&inline, x)), [gray(0.25), gray(0.5), gray(0.75)]);
    let none = with_asset(Instances::default()).compile().unwrap();
    assert_eq!(none.world.geometry_stats().shapes, 0);
    let one = with_asset(Instances::at([Vec3::ZERO])).compile().unwrap();
    assert_eq!((one.world.geometry_stats().shapes, seen(&one, 0.0)), (1, gray(1.0)), "no attribute is white");
}

#[test]
fn a_file_of_points_is_read_once_for_all_objects_and_frames() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("points.ply"), PLY).unwrap();
    let object = |x: f32| {
        let instances = r#"{"file": "points.ply"}"#;
        format!(r#"{{"shape": "sphere", "instances": {instances}, "transform": {{"translate": [{x}, "=frame", 0]}}}}"#)
    };
    let text = format!(
        r#"{{"version": 1, "animation": {{"frames": 5}}, "render": {{"shutter": [0, 0.5]}}, "objects": [{}, {}]}}"#,
        object(0.0),
        object(40.0)
    );
    let place = folder.path().join("scene.json");
    std::fs::write(&place, text).unwrap();
    let scene = Scene::load(&place).unwrap();
    assert!(scene.paths().contains(&folder.path().join("points.ply")));
    let found = |scene: &Scene| {
        let compiled = scene.compile().unwrap();
        (compiled.world.geometry_stats().shapes, compiled.world.moves())
    };
    assert_eq!(found(&scene), (4, true));
    let prints = scene.fingerprint();
    // A file that changes between frames is read again with the scene only.
    std::fs::write(
        folder.path().join("points.ply"),
        PLY.replace("0 0 0 0.5\n3 0 0 1\n", "0 0 0 0.5\n").replace('2', "1"),
    )
    .unwrap();
    let later = scene.at_frame(3.0).unwrap();
    assert_eq!(found(&later), (4, true));
    assert_eq!(scene.fingerprint(), prints);
    let again = scene.reload(&place).unwrap();
    assert_eq!(found(&again), (2, true));
    assert_ne!(again.fingerprint(), prints);
}

#[test]
fn instances_change_with_the_asset_of_their_name() {
    let scene = with_asset(three());
    let before = scene.compile().unwrap();
    let more = scene.clone().asset("points", Asset::from_instances(Instances::at([0.0, 3.0, 6.0, 9.0].map(at))));
    assert_ne!(scene.fingerprint(), more.fingerprint());
    assert_eq!(more.compile().unwrap().world.geometry_stats().shapes, 4);
    assert_eq!(more.compile_after(&scene, &before).unwrap().world.geometry_stats().shapes, 4);
    assert_eq!(scene.compile().unwrap().world.geometry_stats().shapes, 3, "the scene before is unchanged");
}

#[test]
fn a_new_material_keeps_the_instances_of_a_file() {
    let scene = with_asset(three());
    let before = scene.compile().unwrap();
    let edited = scene.with_value("/materials/m/unlit/color", json!([0.5, 0.5, 0.5])).unwrap();
    let after = edited.compile_after(&scene, &before).unwrap();
    assert_eq!(seen(&after, 0.0), gray(0.5));
    assert!(after.world.shares_geometry_with(&before.world), "the hierarchy is kept");
}

#[test]
fn arrays_of_the_scene_add_to_those_of_a_file() {
    let points = || Asset::from_instances(Instances::at([0.0, 3.0].map(at)));
    let heat = r#"{"heat": {"channels": 1, "data": {"f32": [0.5, 1]}}}"#;
    let instances = format!(r#"{{"file": "points", "scales": [1, 0.5], "attributes": {heat}}}"#);
    let compiled = load(&instances, [("points", points())]).unwrap().compile().unwrap();
    assert_eq!([0.0, 3.4, 3.6].map(|x| seen(&compiled, x)), [gray(0.5), gray(1.0), None]);
    let twice = load(r#"{"file": "points", "positions": [[0, 0, 0], [1, 0, 0]]}"#, [("points", points())]).unwrap();
    let error = message(&twice);
    assert!(error.contains("the file has `positions`, too") && error.contains("objects[0].instances"), "{error}");
    let heats = format!(r#"{{"file": "points", "attributes": {heat}}}"#);
    let twice = load(&heats, [("points", Asset::from_instances(three()))]).unwrap();
    assert!(message(&twice).contains("the file has the attribute `heat`, too"), "{}", message(&twice));
    let short = load(r#"{"file": "points", "scales": [1]}"#, [("points", points())]).unwrap();
    assert!(message(&short).contains("`scales` has 1 elements, another array 2"), "{}", message(&short));
}

#[test]
fn assets_of_another_kind_are_refused_with_their_content() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = Asset::from_mesh(Mesh::from_triangles(corners.map(Into::into), [[0, 1, 2]]).arrays().clone());
    let error = message(&load(r#"{"file": "points"}"#, [("points", mesh)]).unwrap());
    assert!(error.contains("the asset of this name contains a mesh, not the bytes of a file"), "{error}");
    let mesh = r#"{"version": 1, "objects": [{"shape": {"mesh": {"file": "points"}}}]}"#;
    let assets = [("points".to_owned(), Asset::from_instances(three()))];
    let error = message(&Loader::default().from_json_with(mesh, "a.json", assets).unwrap());
    assert!(error.contains("contains instances, not the bytes of a file"), "{error}");
    let nested = load(r#"{"file": "points"}"#, [("points", Asset::from_instances(Instances::from_file("other")))]);
    assert!(message(&nested.unwrap()).contains("the instances of the asset `points` must not name a `file`"));
    let missing = message(&load(r#"{"file": "points.ply"}"#, []).unwrap());
    assert!(missing.contains("cannot read `points.ply`: ") && missing.contains("instances.file"), "{missing}");
    let broken = message(&load(r#"{"file": "a"}"#, [("a", Asset::from_bytes(*b"ply\nformat ascii 1.0\n"))]).unwrap());
    assert!(broken.contains("cannot read `a`: line 3"), "{broken}");
}

#[test]
fn faulty_attributes_are_errors() {
    let wrong = |attributes: NamedAttributes| message(&with_asset(Instances { attributes, ..three() }));
    let error = wrong(attribute("heat", &[1.0, 2.0]));
    assert!(error.contains("must have 1 numbers for each of the 3 instances, it has 2"), "{error}");
    let error = wrong(attribute("heat", &[1.0, f32::NAN, 2.0]));
    assert!(error.contains("numbers of the attribute `heat` in `attributes` must be finite"), "{error}");
    let channels = InstanceAttribute::new(5, AttributeData::F32(vec![0.0; 15]));
    let error = wrong([("heat".to_owned(), channels)].into_iter().collect());
    assert!(error.contains("`channels` of the attribute `heat` in `attributes` must be 1 to 4, it is 5"), "{error}");
    let colors = Instances {
        colors: [[1.0; 4]; 3].into_iter().collect(),
        attributes: attribute("color", &[1.0, 1.0, 1.0]),
        ..three()
    };
    assert!(message(&with_asset(colors)).contains("`colors` are the attribute `color` already"));
}

/// The innermost instances that have an attribute of the name count, in lists, groups and shared groups.
#[test]
fn nested_instances_show_the_innermost_attribute_of_a_name() {
    let values =
        |name: &str, numbers: &[f32]| format!(r#""{name}": {{"channels": 1, "data": {{"f32": {numbers:?}}}}}"#);
    let scene = |many: usize, inner: &str| {
        // More than 2^17 spheres of a group that is placed several times: it is built once.
        let far: Vec<String> = (0..many).map(|i| format!("[{}, 500, 0]", i * 3)).collect();
        let crowd =
            format!(r#"{{"shape": "sphere", "material": "m", "instances": {{"positions": [{}]}}}}"#, far.join(", "));
        let inner = format!(
            r#"{{"shape": "sphere", "material": "m", "instances": {{"positions": [[0, 0, 0], [3, 0, 0]], "attributes": {{{inner}}}}}}}"#
        );
        let outer = values("heat", &[0.25, 0.5]);
        let place = format!(r#""instances": {{"positions": [[0, 0, 0], [9, 0, 0]], "attributes": {{{outer}}}}}"#);
        let objects = text("{}").split_once(r#""objects""#).unwrap().0.to_owned();
        let text =
            format!(r#"{objects} "groups": {{"g": [{inner}, {crowd}]}}, "objects": [{{"group": "g", {place}}}]}}"#);
        Scene::from_json(text, "nested.json").unwrap().compile().unwrap()
    };
    for many in [1, 70_000] {
        let at = [0.0, 3.0, 9.0, 12.0];
        let compiled = scene(many, &values("heat", &[0.75, 1.0]));
        assert_eq!(compiled.world.geometry_stats().instances, if many > 1 { 2 } else { 0 });
        assert_eq!(at.map(|x| seen(&compiled, x)), [gray(0.75), gray(1.0), gray(0.75), gray(1.0)]);
        let compiled = scene(many, &values("cold", &[0.75, 1.0]));
        assert_eq!(at.map(|x| seen(&compiled, x)), [gray(0.25), gray(0.25), gray(0.5), gray(0.5)]);
    }
}

/// A mesh shows its own attribute first, mirrored too.
#[test]
fn the_attribute_of_a_mesh_comes_first() {
    let mesh = |name: &str| {
        format!(
            r#"{{"mesh": {{"positions": [[-1, -1, 0], [1, -1, 0], [0, 1, 0]], "triangles": [[0, 1, 2]],
                "attributes": {{"{name}": {{"domain": "face", "channels": 1, "data": {{"f32": [0.125]}}}}}}}}}}"#
        )
    };
    let see = |name: &str| {
        let instances = r#"{"positions": [[0, 0, 0], [3, 0, 0]], "scales": [1, [-1, 1, 1]],
            "attributes": {"heat": {"channels": 1, "data": {"f32": [0.5, 1]}}}}"#;
        let text = text(instances).replace(r#""shape": "sphere""#, &format!(r#""shape": {}"#, mesh(name)));
        let compiled = Scene::from_json(text, "mesh.json").unwrap().compile().unwrap();
        [0.0, 3.0].map(|x| seen(&compiled, x))
    };
    assert_eq!(see("heat"), [gray(0.125), gray(0.125)]);
    assert_eq!(see("cold"), [gray(0.5), gray(1.0)]);
}

#[test]
fn memory_is_known_before_a_file_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let count = 1000;
    let head = PLY.split_once("0 0 0 0.5").unwrap().0.replace("vertex 2", &format!("vertex {count}"));
    let file = folder.path().join("points.ply");
    std::fs::write(&file, format!("{head}{}", "bad bytes ".repeat(count))).unwrap();
    let place = folder.path().join("scene.json");
    std::fs::write(&place, text(r#"{"file": "points.ply"}"#)).unwrap();
    let scene = Scene::load(&place).unwrap();
    let needs = scene.needs();
    assert_eq!((needs.instances, needs.objects, needs.instance_arrays), (count as u64, 0, 0));
    let files: Vec<_> = needs.instance_files.into_iter().collect();
    assert_eq!(files, [file.canonicalize().unwrap()]);
    assert!(message(&scene).contains("line 9"), "only now the file is read: {}", message(&scene));
    let asset = with_asset(three()).needs();
    assert_eq!((asset.instances, asset.instance_arrays, asset.instance_files.len()), (3, 3 * 16, 0));
    let bundle: Bundle = [
        ("scene.json".to_owned(), text(r#"{"file": "points.ply"}"#).into_bytes()),
        ("points.ply".to_owned(), PLY.as_bytes().to_vec()),
    ]
    .into_iter()
    .collect();
    let scene = Scene::from_bundle(bundle, "scene.json").unwrap();
    assert_eq!(scene.needs().instances, 2);
    assert_eq!(scene.compile().unwrap().world.geometry_stats().shapes, 2);
}

#[test]
fn assets_of_instances_are_saved_with_everything() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("scene.json");
    let scales = [ScaleFactors::All(1.0), ScaleFactors::Each(Vec3::new(-1.0, 2.0, 0.5)), ScaleFactors::All(-0.5)];
    let all = Instances {
        rotations: [[0.0, 0.0, 0.0, 1.0], [0.5, 0.5, 0.5, 0.5], [0.0, 2.0, 0.0, 1.0]].into_iter().collect(),
        scales: scales.into_iter().collect(),
        colors: [[0.1, 0.2, 0.3, 1.0], [0.4, 0.5, 0.6, 0.5], [0.7, 0.8, 0.9, 0.0]].into_iter().collect(),
        end_colors: [[0.9; 4], [0.8; 4], [0.7; 4]].into_iter().collect(),
        ..three()
    };
    let rows = |x: f32| [1.0, 0.0, 0.0, x, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.5];
    let matrices =
        Instances { attributes: attribute("heat", &[1.0, 0.5]), ..Instances::from_matrices([0.0, 3.0].map(rows)) };
    for instances in [all, matrices, Instances::default()] {
        let scene = with_asset(instances);
        scene.save(&place).unwrap();
        let again = Scene::load(&place).unwrap();
        let (before, after) = (scene.compile().unwrap(), again.compile().unwrap());
        assert_eq!(before.world.geometry_stats(), after.world.geometry_stats());
        let views = |compiled: &Compiled| [-1.0, 0.0, 2.9, 3.0, 5.8, 6.0].map(|x| seen(compiled, x));
        assert_eq!(views(&before), views(&after));
        let shown = |scene: &Scene| scene.expanded_description().objects[0].instances.clone().unwrap();
        let transforms = |scene: &Scene| shown(scene).transforms().unwrap();
        assert_eq!(transforms(&scene), transforms(&again));
        assert_eq!(shown(&scene).attributes, shown(&again).attributes);
        assert_eq!((shown(&scene).colors, shown(&scene).end_colors), (shown(&again).colors, shown(&again).end_colors));
        // The fingerprint names the file by the hash of its bytes in place of that of the arrays.
        let parts = |scene: &Scene| {
            let mut parts = scene.fingerprint().parts().clone();
            assert!(parts.remove("file points").is_some());
            parts
        };
        assert_eq!(parts(&scene), parts(&again));
    }
}

/// The arrays of a program are checked when they are placed; the check of the schema skips them, since
/// their JSON would take many times their memory.
#[test]
fn arrays_of_programs_are_checked_without_json() {
    let object = |instances| Object::new(Sphere::default()).instances(instances);
    let flat = Instances { scales: [ScaleFactors::All(0.0)].into_iter().collect(), ..Instances::default() };
    let wrong = [
        (Instances::at([at(f32::NAN)]), "objects[0].instances.positions"),
        (flat, "objects[0].instances.scales"),
        (Instances { attributes: attribute("a", &[1.0]), ..three() }, "objects[0].instances.attributes"),
    ];
    for (instances, path) in wrong {
        let error = message(&Scene::new().add(object(instances)));
        assert!(error.contains(path), "{error}");
    }
    let scene = Scene::new().add(object(three()).at(f32::NAN, 0.0, 0.0));
    assert!(scene.check().errors() > 0, "all else is checked");
}

#[test]
fn programs_name_files_and_assets() {
    let object = Object::new(Sphere::default()).instances(Instances::from_file("points"));
    let scene = Scene::new().add(object).asset("points", Asset::from_instances(three()));
    assert_eq!(scene.compile().unwrap().world.geometry_stats().shapes, 3);
    let json = scene.to_value();
    assert_eq!(json["objects"][0]["instances"], json!({"file": "points"}));
    let unpacked = scene.unpacked().unwrap();
    assert_eq!(unpacked.compile().unwrap().world.geometry_stats().shapes, 3);
}
