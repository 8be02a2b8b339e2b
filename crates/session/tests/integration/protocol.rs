//! The JSON of edits, statuses and probes, which pages and their users' programs rely on.
use crate::until;
use juggler::camera::film::Rect;
use juggler::render::Scheduler;
use juggler::scene::Scene;
use juggler_session::wire::EditMessage;
use juggler_session::{
    BuildRequest, Channel, Edit, EditEffect, ModelStatus, PixelInfo, Session, SessionOptions, Stage, Status, Subject,
};

/// Edits, each followed by the JSON that is written for it, or by the error that it causes. Version
/// 0.1 wrote these lines: a change of a line breaks pages and programs.
const EDITS: &str = include_str!("protocol.txt");

const SCENE: &str = r#"{"version": 1, "animation": {"frames": 10},
    "render": {"size": [8, 6], "samples": 2, "integrator": {"path": {"max_depth": 7}}, "sampler": "stratified"},
    "tone": {"curve": {"agx": {}}, "exposure_stops": 0.1},
    "materials": {"red": {"phong": {"diffuse": [1, 0, 0]}}},
    "cameras": {"front": {"perspective": {"eye": [0, 0.1, 5], "vertical_fov_degrees": 33.3}}, "side": {"thin_lens": {}}},
    "lights": [{"point": {"position": [0, 9, 9], "light_group": "key"}}, {"ambient": {}}],
    "objects": [{"shape": {"sphere": {"radius": "=1 + frame/10"}}, "material": "red"}]}"#;

fn subject() -> Subject {
    BuildRequest::from_scene(Scene::from_json(SCENE, "scene.json").unwrap(), "scene.json", None).run().unwrap()
}

fn read(json: &str) -> Result<Edit, String> {
    let message: EditMessage = serde_json::from_str(json).map_err(|error| format!("malformed: {error}"))?;
    message.read()
}

/// Applies an edit to a small scene.
fn apply(edit: &Edit) -> Result<(), String> {
    match subject().apply(edit)? {
        EditEffect::Build(build) => build.run().map(drop).map_err(|error| error.text),
        EditEffect::View | EditEffect::Nothing => Ok(()),
    }
}

/// Returns the JSON of an edit that can be applied, otherwise the error, on one line.
fn answer(json: &str) -> String {
    let answer = read(json).and_then(|edit| apply(&edit).map(|()| serde_json::to_string(&edit).unwrap()));
    answer.unwrap_or_else(|error| format!("{error:?}"))
}

#[test]
fn edits_and_their_errors_keep_their_json() {
    let lines: Vec<&str> = EDITS.lines().filter(|line| !line.starts_with('#')).collect();
    assert!(lines.len() > 100 && lines.len().is_multiple_of(2));
    let wrong: Vec<String> = lines
        .chunks(2)
        .filter(|pair| answer(pair[0]) != pair[1])
        .map(|pair| format!("{}\n{}\nnot\n{}", pair[0], answer(pair[0]), pair[1]))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_written_edit_is_read_again() {
    let written = EDITS.lines().filter(|line| !line.starts_with('#')).skip(1).step_by(2);
    let edits: Vec<Edit> = written
        .filter(|line| line.starts_with('{') || *line == "\"reset\"")
        .filter_map(|line| read(line).ok())
        .collect();
    assert!(edits.len() > 30, "{}", edits.len());
    for edit in edits {
        let json = serde_json::to_string(&edit).unwrap();
        assert_eq!(read(&json).unwrap(), edit, "{json}");
    }
}

#[test]
fn a_full_status_keeps_its_json() {
    let mut status = Status {
        number: 3,
        revision: 2,
        stage: Stage::Refining,
        error: Some("error: \"no\"\n".into()),
        region: Some(Rect { x: 1, y: 2, width: 3, height: 4 }),
        channel: Channel::Noise,
        samples: 1.5,
        noise: Some(0.1),
        clamped: Some(0.0),
        frames_per_second: 59.9,
        rays_per_second: 1e7,
        coarseness: 4,
        threads: 2,
        scheduler: Scheduler::RowQueue,
        denoised: true,
        playing: true,
        hash: Some("00ff".into()),
        ..Status::default()
    };
    subject().write_status(&mut status);
    let expected = concat!(
        r#"{"number":3,"revision":2,"stage":"refining","scene":"scene.json","#,
        r#""error":"error: \"no\"\n","size":[8,6],"region":{"x":1,"y":2,"width":3,"height":4},"#,
        r#""channel":"noise","samples":1.5,"samples_wanted":2,"noise":0.1,"clamped":0.0,"#,
        r#""frames_per_second":59.9,"rays_per_second":10000000.0,"coarseness":4,"threads":2,"#,
        r#""scheduler":"row-queue","integrator":"path","max_depth":7,"depth_range":[1,10000],"#,
        r#""denoise":false,"denoised":true,"sampler":"stratified","tone":"agx","exposure":0.1,"#,
        r#""light_groups":[["rest",[1.0,1.0,1.0]],["key",[1.0,1.0,1.0]]],"models":[],"#,
        r#""cameras":["front","side"],"camera":{"perspective":{"eye":[0,0.1,5],"#,
        r#""vertical_fov_degrees":33.3}},"interest":[0.0,0.019995937,0.9998001],"extent":3.4641016,"#,
        r#""flight_speed":0.8660254,"frame":0.0,"frames":10,"frame_rate":30.0,"playing":true,"#,
        r#""hash":"00ff"}"#,
    );
    assert_eq!(serde_json::to_string(&status).unwrap(), expected);
}

/// The forms in `wire/status.rs` list the fields once more, so a new field could be forgotten.
#[test]
fn every_field_of_a_status_and_a_probe_is_in_its_json() {
    let status = Status { models: vec![ModelStatus::default()], ..Status::default() };
    check_fields(&status);
    check_fields(&status.models[0]);
    check_fields(&PixelInfo::default());
}

/// Compares the names of a value's fields, which its debug format lists, with the members of its
/// JSON.
fn check_fields(value: &(impl std::fmt::Debug + serde::Serialize)) {
    let text = format!("{value:#?}");
    let fields = text
        .lines()
        .filter_map(|line| line.strip_prefix("    ").filter(|line| !line.starts_with([' ', '}', ']', ')'])));
    let fields: Vec<&str> = fields.filter_map(|line| line.split(':').next()).collect();
    let json = serde_json::to_value(value).unwrap();
    assert_eq!(json.as_object().unwrap().keys().collect::<Vec<_>>(), fields);
}

#[test]
fn the_status_without_a_scene_keeps_its_json() {
    let session = Session::open("none.json", SessionOptions { threads: 1, ..SessionOptions::default() });
    let status = Status { number: 0, ..Status::clone(&until(&session, |status| status.stage == Stage::Finished)) };
    let expected = concat!(
        r#"{"number":0,"revision":0,"stage":"finished","scene":"none.json","#,
        r#""error":"error: file not found: `none.json`","size":[0,0],"region":null,"#,
        r#""channel":"color","samples":0.0,"samples_wanted":0,"noise":null,"clamped":null,"#,
        r#""frames_per_second":0.0,"rays_per_second":0.0,"coarseness":0,"threads":1,"#,
        r#""scheduler":"work-stealing","integrator":"","max_depth":null,"depth_range":[0,0],"#,
        r#""denoise":false,"denoised":false,"sampler":"","tone":"","exposure":0.0,"#,
        r#""light_groups":[],"models":[],"cameras":[],"camera":null,"interest":[0.0,0.0,0.0],"#,
        r#""extent":0.0,"flight_speed":0.0,"frame":0.0,"frames":0,"frame_rate":0.0,"playing":false,"#,
        r#""hash":null}"#,
    );
    assert_eq!(serde_json::to_string(&status).unwrap(), expected);
}

#[test]
fn models_in_a_status_keep_their_json() {
    let robot = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/models/robot.glb");
    let (mut status, subject) = (Status::default(), BuildRequest::open(robot, Some([8, 6])).run().unwrap());
    subject.write_status(&mut status);
    status.models[0].file = "robot.glb".into();
    let expected = concat!(
        r#"[{"pointer":"/objects/0/model","file":"robot.glb","variants":["Tangerine","Lagoon"],"#,
        r#""variant":null,"clips":["Wave","Idle"],"clip":"Wave"}]"#,
    );
    assert_eq!(serde_json::to_value(&status).unwrap()["models"].to_string(), expected);
}

#[test]
fn probes_keep_their_json() {
    let json = |pixel| serde_json::to_string(&PixelInfo::at_pixel(&subject(), None, pixel)).unwrap();
    let expected = concat!(
        r#"{"pixel":[4,3],"color":null,"samples":0,"noise":null,"depth":4.052489,"#,
        r#""position":[0.20149188,-0.18228456,0.96237904],"normal":[0.20149188,-0.18228456,"#,
        r#"0.96237904],"object":0,"shape":"sphere objects[0]","material":"red"}"#,
    );
    assert_eq!(json([4, 3]), expected);
    let expected = concat!(
        r#"{"pixel":[9,9],"color":null,"samples":0,"noise":null,"depth":null,"position":null,"#,
        r#""normal":null,"object":null,"shape":null,"material":null}"#,
    );
    assert_eq!(json([9, 9]), expected);
}
