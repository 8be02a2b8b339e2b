//! Relighting: light groups are scaled without tracing again.

use juggler::scene::Scene;
use juggler_session::{Edit, Session, SessionOptions, Setting, Stage, Status};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// A white wall and two point lights, one of them in a light group.
const SCENE: &str = r#"{"version": 1,
    "render": {"size": [40, 30], "samples": 16, "integrator": "path"}, "tone": {"curve": "linear", "dither": false},
    "camera": {"perspective": {"eye": [0, 0, 4]}}, "background": 0,
    "lights": [{"point": {"position": [-2, 0, 3], "intensity": 2, "light_group": "key"}}, {"point": {"position": [2, 0, 3], "color": [0, 0, 1], "intensity": 2}}],
    "objects": [{"shape": {"rectangle": {"size": [8, 8]}}, "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}], "material": {"diffuse": {"reflectance": 0.8}}}]}"#;

fn opened(text: &str) -> Session {
    let options = SessionOptions { threads: 2, ..SessionOptions::default() };
    Session::from_scene(Scene::from_json(text, "scene").unwrap(), "scene", options)
}

fn settled(session: &Session, revision: u64) -> Arc<Status> {
    let end = Instant::now() + Duration::from_secs(60);
    loop {
        let status = session.status();
        if status.stage == Stage::Finished && status.revision >= revision && status.error.is_none() {
            return status;
        }
        assert!(Instant::now() < end, "{status:?}");
        session.wait(u64::MAX, status.number, Duration::from_millis(50));
    }
}

fn gain(session: &Session, group: &str, factors: [f32; 3]) -> Arc<Status> {
    settled(session, session.edit(Edit::Setting(Setting::Gain(group.into(), factors))))
}

/// Returns the mean of the displayed pixels, in RGB.
fn mean_pixel(session: &Session) -> [f64; 3] {
    let frame = session.frame().unwrap();
    let count = (frame.rgba.len() / 4) as f64;
    [0, 1, 2].map(|at| frame.rgba.chunks_exact(4).map(|pixel| f64::from(pixel[at])).sum::<f64>() / count)
}

#[test]
fn light_group_gains_apply_to_existing_samples() {
    let session = opened(SCENE);
    let before = settled(&session, 0);
    assert_eq!(before.light_groups, [("rest".into(), [1.0; 3]), ("key".into(), [1.0; 3])]);
    let white = mean_pixel(&session);
    assert!(white[2] > 1.5 * white[0] && (white[0] - white[1]).abs() < 1e-9, "{white:?}");

    let lit = gain(&session, "key", [0.5, 0.25, 0.0]);
    assert_eq!(lit.light_groups[1], ("key".into(), [0.5, 0.25, 0.0]));
    assert_eq!((lit.samples, &lit.hash), (before.samples, &before.hash), "nothing is traced again");
    let warm = mean_pixel(&session);
    let rest = white[2] - white[0];
    for (found, expected) in warm.into_iter().zip([0.5 * white[0], 0.25 * white[1], rest]) {
        // 8-bit levels are rounded.
        assert!((found - expected).abs() < 1.0, "{found} instead of {expected}");
    }

    let off = gain(&session, "rest", [0.0; 3]);
    assert_eq!(off.hash, before.hash);
    assert!(mean_pixel(&session)[2] < 0.01);
    let file = tempfile::tempdir().unwrap();
    let file = file.path().join("dark.pfm");
    session.save(&file).unwrap();
    let saved = juggler::imaging::read(&file).unwrap();
    assert!(saved.pixels().iter().all(|pixel| pixel.b < 1e-6), "what is saved is what is shown");

    let again = settled(&session, session.edit(Edit::Reset));
    assert_eq!(again.light_groups, before.light_groups);
    assert_eq!(mean_pixel(&session), white);
}

#[test]
fn moving_camera_shows_light_group_gains() {
    let session = opened(SCENE);
    settled(&session, 0);
    gain(&session, "rest", [0.0; 3]);
    let zoom = session.edit(Edit::Zoom(1.1));
    let end = Instant::now() + Duration::from_secs(60);
    loop {
        let (status, frame) = (session.status(), session.frame().unwrap());
        if frame.revision >= zoom {
            let blue: u32 = frame.rgba.chunks_exact(4).map(|pixel| u32::from(pixel[2])).max().unwrap();
            let red: u32 = frame.rgba.chunks_exact(4).map(|pixel| u32::from(pixel[0])).max().unwrap();
            assert!(red > 0 && blue <= red, "the first frame is mixed too");
            break;
        }
        assert!(Instant::now() < end, "{status:?}");
        session.wait(frame.number, status.number, Duration::from_millis(50));
    }
}

#[test]
fn wrong_gains_are_refused() {
    let session = opened(SCENE);
    settled(&session, 0);
    for (group, factors, message) in [
        ("kay", [1.0; 3], "did you mean `key`"),
        ("key", [-1.0, 0.0, 0.0], "0 to"),
        ("key", [f32::NAN, 0.0, 0.0], "0 to"),
        ("key", [1e9, 0.0, 0.0], "0 to"),
    ] {
        let revision = session.edit(Edit::Setting(Setting::Gain(group.into(), factors)));
        while session.status().revision < revision {
            session.wait(u64::MAX, session.status().number, Duration::from_millis(50));
        }
        let status = session.status();
        assert!(status.error.as_ref().is_some_and(|error| error.contains(message)), "{:?}", status.error);
        assert_eq!(status.light_groups[1].1, [1.0; 3]);
    }
    let plain = opened(&SCENE.replace(r#", "light_group": "key""#, ""));
    assert!(settled(&plain, 0).light_groups.is_empty());
}
