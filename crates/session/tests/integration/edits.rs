//! Effect and error messages of every kind of edit.
use crate::{PATIENCE, until};
use juggler::camera::film::Rect;
use juggler::camera::sampler::SamplerKind;
use juggler::camera::{AnyCamera, Orthographic, Perspective};
use juggler::imaging::ToneCurveKind;
use juggler::integrator::IntegratorKind;
use juggler::math::vec3;
use juggler::render::Scheduler;
use juggler::scene::{Scene, built_in_scenes};
use juggler_session::{Channel, Edit, Fly, Orbit, Session, SessionOptions, Setting, Stage, Status};
use serde_json::json;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::time::{Duration, Instant};

const SIZE: [u32; 2] = [48, 36];

fn options() -> SessionOptions {
    SessionOptions { size: Some(SIZE), threads: 2, ..SessionOptions::default() }
}

fn settled(session: &Session, revision: u64) -> Arc<Status> {
    until(session, |status| status.revision >= revision && status.stage == Stage::Finished)
}

pub fn after(session: &Session, edit: Edit) -> Arc<Status> {
    let revision = session.edit(edit);
    settled(session, revision)
}

pub fn opened(name: &str) -> Session {
    let session = Session::open(name, options());
    settled(&session, 0);
    session
}

const SMALL: &str = r#"{
    "version": 1,
    // Stays.
    "animation": {"frames": 10},
    "render": {"samples": 2},
    "materials": {"red": {"phong": {"diffuse": [1, 0, 0]}}},
    "camera": {"perspective": {"eye": [0, 0, 5]}},
    "lights": [{"directional": {"direction": [0, 0, -1]}}],
    "objects": [{"shape": {"sphere": {"radius": "=1 + frame/10"}}, "material": "red"}]
}"#;

pub fn in_folder() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("small.json");
    fs::write(&file, SMALL).unwrap();
    let name = file.to_string_lossy().into_owned();
    (folder, name)
}

#[test]
fn settings_change_the_picture_or_say_what_is_wrong() {
    let session = opened("first-render");
    let settings = [
        (Setting::Samples(3), "samples_wanted"),
        (Setting::Integrator(IntegratorKind::Normals), "integrator"),
        (Setting::Integrator(IntegratorKind::Classic), "integrator"),
        (Setting::MaxDepth(3), "max_depth"),
        (Setting::Sampler(SamplerKind::Independent), "sampler"),
        (Setting::Tone(ToneCurveKind::Linear), "tone"),
        (Setting::Exposure(1.5), "exposure"),
        (Setting::Size([30, 20]), "size"),
        (Setting::Threads(1), "threads"),
        (Setting::Scheduler(Scheduler::RowQueue), "scheduler"),
    ];
    for (setting, member) in settings {
        let edit = Edit::Setting(setting);
        let json = serde_json::to_value(&edit).unwrap();
        let value = json["setting"].as_object().unwrap().values().next().unwrap().clone();
        let status = serde_json::to_value(&*after(&session, edit)).unwrap();
        assert_eq!((&status[member], &status["error"]), (&value, &json!(null)));
    }
    let hash = session.status().hash.clone();
    assert!(hash.is_some());
    let wrong = [Setting::Samples(0), Setting::Size([0, 5]), Setting::Size([60_000, 60_000]), Setting::Exposure(1e30)];
    for setting in wrong {
        let status = after(&session, Edit::Setting(setting.clone()));
        assert!(status.error.is_some(), "{setting:?}");
        assert_eq!(status.hash, hash, "{setting:?} leaves the picture as it is");
    }
    let status = settled(&session, session.report_unread("error: no".into()));
    assert_eq!((status.error.as_deref(), &status.hash), (Some("error: no"), &hash));
    let status = after(&session, Edit::Setting(Setting::Seed(5)));
    assert!(status.error.is_none() && status.hash != hash);
}

#[test]
fn only_edits_that_affect_samples_restart_the_render() {
    let session = opened("juggler");
    let (hash, rgba) = (session.status().hash.clone(), session.frame().unwrap().rgba.clone());
    for edit in [Edit::Setting(Setting::Exposure(2.0)), Edit::Show(Channel::Noise), Edit::Show(Channel::Samples)] {
        let status = after(&session, edit);
        assert_eq!(status.hash, hash);
        assert_ne!(session.frame().unwrap().rgba, rgba);
    }
    after(&session, Edit::Show(Channel::Color));
    after(&session, Edit::Setting(Setting::Exposure(0.0)));
    assert_eq!(session.frame().unwrap().rgba, rgba);
}

#[test]
fn radiance_removed_by_clamping_is_reported() {
    let session = opened("juggler");
    assert_eq!(session.status().clamped, None);
    let by = |limit: f32| {
        let value = json!({"path": {"max_depth": 3, "clamp_direct": limit}});
        after(&session, Edit::Set { path: "/render/integrator".into(), value }).clamped
    };
    assert_eq!(by(1e6), Some(0.0));
    let [little, much] = [0.9, 0.3].map(|limit| by(limit).unwrap());
    assert!(0.0 < little && little < much && much < 0.9, "{little} {much}");
}

#[test]
fn every_channel_shows_a_different_image() {
    let session = opened("juggler");
    // The noise estimate needs 64 samples.
    after(&session, Edit::Setting(Setting::Samples(64)));
    let mut images = Vec::new();
    for channel in Channel::ALL {
        let status = after(&session, Edit::Show(channel));
        assert_eq!((status.channel, status.samples), (channel, status.samples_wanted as f32));
        let frame = session.frame().unwrap();
        assert_eq!([frame.width, frame.height], SIZE, "{channel:?}");
        assert!(!images.contains(&frame.rgba), "{channel:?}");
        images.push(frame.rgba.clone());
    }
}

#[test]
fn scene_values_are_set_and_removed_and_invalid_values_rejected() {
    let (_folder, name) = in_folder();
    let session = opened(&name);
    let before = session.status().hash.clone();
    let set = |path: &str, value: serde_json::Value| after(&session, Edit::Set { path: path.into(), value });
    let blue = set("/materials/red/phong/diffuse", json!([0, 0, 1]));
    assert!(blue.error.is_none() && blue.hash != before);
    for (path, value, text) in [
        ("/materials/red/phong/diffuse", json!("blau"), "materials.red.phong.diffuse"),
        ("/objects/0/shape/sphere/radius", json!(-1), "radius"),
        ("/objects/0/shape/sphere/radius", json!(1e300), "radius"),
        ("/objects/9/shape", json!({}), "no element `9`"),
        ("/objects/0/material", json!("gold"), "gold"),
        ("nowhere", json!(1), "begin with `/`"),
        ("/render/samples", json!(0), "samples"),
    ] {
        let status = set(path, value);
        assert!(status.error.as_ref().is_some_and(|error| error.contains(text)), "{path}: {:?}", status.error);
        assert_eq!(status.hash, blue.hash, "{path}");
    }
    let larger = set("/objects/0/shape/sphere/radius", json!("=2 + frame"));
    assert!(larger.error.is_none() && larger.hash != blue.hash);
    let samples = set("/render/samples", json!(5));
    assert_eq!((samples.samples_wanted, samples.error.as_ref()), (5, None));
    let gone = set("/lights", json!(null));
    assert!(gone.error.is_none() && gone.hash != larger.hash);
    assert_eq!(after(&session, Edit::Reset).hash, before);
}

#[test]
fn each_edit_changes_the_scene_of_the_edits_before() {
    let (_folder, name) = in_folder();
    let session = opened(&name);
    let set = |path: &str, value: serde_json::Value| after(&session, Edit::Set { path: path.into(), value });
    set("/materials/blue", json!({"phong": {"diffuse": [0, 0, 1]}}));
    let blue = set("/objects/0/material", json!("blue"));
    let green = set("/materials/blue", json!({"phong": {"diffuse": [0, 1, 0]}}));
    assert!(green.error.is_none() && green.hash != blue.hash, "the object keeps its material: {:?}", green.error);
    // Two removals at one place remove two lights.
    let dark = set("/lights", json!([]));
    set("/lights", json!([{"directional": {"direction": [0, 0, -1]}}, {"ambient": {}}]));
    set("/lights/0", json!(null));
    let removed = set("/lights/0", json!(null));
    assert_eq!((removed.error.as_ref(), &removed.hash), (None, &dark.hash));
}

#[test]
fn edits_of_time_select_animation_frames() {
    let (_folder, name) = in_folder();
    let session = opened(&name);
    let first = session.status().hash.clone();
    let fifth = after(&session, Edit::At(5.0));
    assert_eq!((fifth.frame, fifth.frames), (5.0, 10));
    let still = Scene::load(&name).unwrap().at_frame(5.0).unwrap();
    let program = Session::from_scene(still, "still", options());
    assert_eq!(settled(&program, 0).hash, fifth.hash);
    assert_eq!(after(&session, Edit::At(0.0)).hash, first);
    session.edit(Edit::Play(true));
    until(&session, |status| status.playing && status.frame >= 3.0);
    let stopped = after(&session, Edit::Play(false));
    assert!(!stopped.playing && stopped.hash.is_some());
}

#[test]
fn a_region_is_refined_alone_and_the_rest_later() {
    let session = opened("first-render");
    let whole = session.status().hash.clone();
    session.edit(Edit::Region(Some(Rect { x: 0, y: 0, width: 16, height: 16 })));
    let part = after(&session, Edit::Setting(Setting::Seed(7)));
    assert!(part.hash.is_none() && part.samples < part.samples_wanted as f32 && part.samples > 0.0);
    assert_eq!(session.probe([3, 3]).unwrap().samples, part.samples_wanted);
    assert_eq!(session.probe([40, 30]).unwrap().samples, 0);
    session.edit(Edit::Setting(Setting::Seed(0)));
    let all = after(&session, Edit::Region(None));
    assert_eq!(all.hash, whole);
}

#[test]
fn probes_report_shape_material_and_depth() {
    let (_folder, name) = in_folder();
    let session = opened(&name);
    let probe = session.probe([24, 18]).unwrap();
    assert_eq!((probe.shape.as_deref(), probe.material.as_deref()), (Some("sphere objects[0]"), Some("red")));
    assert!((probe.depth.unwrap() - 4.0).abs() < 0.01 && probe.normal.unwrap()[2] > 0.99, "{probe:?}");
    assert!(probe.color.unwrap()[0] > 0.1 && probe.color.unwrap()[1] == 0.0, "{probe:?}");
    let sky = session.probe([0, 0]).unwrap();
    assert_eq!((sky.depth, sky.object, sky.color), (None, None, Some([0.0; 3])));
    assert_eq!(session.probe([1000, 0]).unwrap().color, None);
}

#[test]
fn cameras_move_focus_and_are_chosen() {
    let session = opened("chess");
    let cameras = session.status().cameras.clone();
    assert!(cameras.len() > 1);
    let first = session.status().camera.clone();
    let other = after(&session, Edit::Camera(cameras[1].clone()));
    assert!(other.camera != first && other.error.is_none());
    assert!(after(&session, Edit::Camera("none".into())).error.as_ref().unwrap().contains("no camera `none`"));
    let moved = after(&session, Edit::Orbit(Orbit { yaw_degrees: 10.0, ..Orbit::default() }));
    assert!(moved.camera != other.camera && moved.error.is_none());
    assert!(moved.interest.iter().zip(other.interest).all(|(a, b)| (a - b).abs() < 1e-3), "it stays");
    let framed = after(&session, Edit::Frame(None));
    assert!(framed.camera != moved.camera);
    let back = after(&session, Edit::Camera(cameras[0].clone()));
    assert_eq!(back.camera, first);
    let look =
        AnyCamera::from(Orthographic { eye: vec3(0.0, 0.0, 900.0), height: Some(300.0), ..Orthographic::default() });
    assert_eq!(after(&session, Edit::Look(look.clone())).camera, Some(look));
    let wide = Perspective { vertical_fov_degrees: Some(400.0), ..Perspective::default() };
    assert!(after(&session, Edit::Look(wide.into())).error.is_some());
}

#[test]
fn scenes_are_switched_and_unknown_names_keep_the_current_scene() {
    let session = opened("juggler");
    let status = after(&session, Edit::Scene("one-sphere".into()));
    assert_eq!((status.scene.as_str(), status.error.as_ref()), ("one-sphere", None));
    let frame = session.frame().unwrap().number;
    let status = after(&session, Edit::Scene("jugler".into()));
    assert_eq!(
        status.error.as_deref(),
        Some("error: unknown scene `jugler`: neither a file nor a built-in scene; did you mean `juggler`?")
    );
    assert_eq!(status.scene, "one-sphere");
    assert!(status.hash.is_some() && session.frame().unwrap().number >= frame);
    // Of many requests the last one wins.
    for scene in built_in_scenes() {
        session.edit(Edit::Scene(scene.name.into()));
    }
    let status = after(&session, Edit::Scene("red-cube".into()));
    assert_eq!((status.scene.as_str(), status.error.as_ref()), ("red-cube", None));
}

#[test]
fn a_session_without_a_scene_waits_for_one() {
    let session = Session::open("no such scene", options());
    let status = settled(&session, 0);
    assert!(status.error.is_some() && session.frame().is_none());
    assert!(session.probe([0, 0]).is_none() && session.encode("png").is_err());
    session.edit(Edit::Fly(Fly { forward: 1.0, ..Fly::default() }));
    assert_eq!(after(&session, Edit::Scene("red-cube".into())).error, None);
}

#[test]
fn pictures_are_saved_as_an_offline_render_writes_them() {
    let session = opened("juggler");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.png");
    session.save(&file).unwrap();
    assert_eq!(fs::read(&file).unwrap(), session.encode("png").unwrap());
    assert!(session.encode("exr").is_ok() && session.encode("txt").is_err());
    let settings = juggler::Settings { size: Some(SIZE), ..Default::default() };
    let other = folder.path().join("b.png");
    juggler::render_to_file(&Scene::built_in("juggler").unwrap(), &settings, &other).unwrap();
    assert!(fs::read(&file).unwrap() == fs::read(other).unwrap());
    assert!(session.save(Path::new("/nowhere/a.png")).is_err());
}

#[test]
fn random_edits_never_panic() {
    let session = Session::open("juggler", SessionOptions { size: Some([24, 18]), ..options() });
    let mut bits = 7_u64;
    let mut random = move |n: u64| {
        bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (bits >> 33) % n
    };
    for i in 0..1000 {
        let wild = [0.0, 1.0, -3.0, 90.0, 1e-20, -1e20, f32::MAX, f32::INFINITY, f32::NAN][random(9) as usize];
        let pixel = [random(30) as f32 - 3.0, wild];
        let edit = match random(16) {
            0 => Edit::Scene(built_in_scenes()[random(30) as usize].name.into()),
            1 => Edit::Reload,
            2 => Edit::Fly(Fly { right: wild, yaw_degrees: random(100) as f32, ..Fly::default() }),
            3 => Edit::Fly(Fly { forward: 1.0, pitch_degrees: wild, roll_degrees: wild, ..Fly::default() }),
            4 => Edit::Orbit(Orbit { yaw_degrees: wild, pitch_degrees: random(200) as f32, closer: 1.1 }),
            5 => Edit::Orbit(Orbit { closer: wild, ..Orbit::default() }),
            6 => Edit::Zoom(wild),
            7 => Edit::Focus(pixel),
            8 => Edit::Frame(Some(pixel)),
            9 => Edit::Camera("camera".into()),
            10 => Edit::Set { path: "/objects/0".into(), value: json!(random(3)) },
            11 => Edit::Setting(Setting::Samples(random(5) as u32)),
            12 => Edit::At(f64::from(wild)),
            13 => Edit::Play(random(2) == 0),
            14 => Edit::Show(Channel::ALL[random(8) as usize]),
            _ => Edit::Region(Some(Rect { x: random(30) as u32, y: 0, width: u32::MAX, height: random(9) as u32 })),
        };
        session.edit(edit);
        if i % 50 == 0 {
            session.probe([random(24) as u32, 3]);
            session.wait(u64::MAX, u64::MAX, Duration::from_millis(random(20)));
        }
    }
    session.edit(Edit::Play(false));
    session.edit(Edit::Setting(Setting::Samples(2)));
    let status = after(&session, Edit::Scene("juggler".into()));
    assert_eq!((status.revision, status.error.as_ref()), (1003, None));
}

#[test]
fn changes_are_reported_and_the_threads_end_with_the_last_handle() {
    let session = opened("juggler");
    let calls = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&calls);
    session.on_update(move || {
        count.fetch_add(1, Relaxed);
    });
    let number = session.frame().unwrap().number;
    session.edit(Edit::Zoom(1.5));
    assert!(session.wait(number, u64::MAX, PATIENCE), "a frame comes");
    let end = Instant::now() + PATIENCE;
    while calls.load(Relaxed) == 0 && Instant::now() < end {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert!(calls.load(Relaxed) > 0);
    let other = session.clone();
    drop(session);
    after(&other, Edit::Zoom(1.5));
    drop(other);
    // The session's thread releases the callback when it ends.
    let end = Instant::now() + PATIENCE;
    while Arc::strong_count(&calls) > 1 && Instant::now() < end {
        std::thread::sleep(Duration::from_millis(5));
    }
    assert_eq!(Arc::strong_count(&calls), 1);
}
