//! Transparent pictures in a window: gray squares, or the backdrop, show where nothing is.

use crate::until;
use juggler_session::{Session, SessionOptions, Stage};
use serde_json::{Value, json};

/// The pixels of a finished frame of a red sphere in the middle.
fn shown(values: &[(&str, Value)]) -> Vec<[u8; 4]> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ball.json");
    let scene = json!({"version": 1, "render": {"samples": 4, "transparent": true}, "background": [1, 1, 1],
        "camera": {"perspective": {"eye": [0, 0, 5]}},
        "objects": [{"shape": "sphere", "material": {"diffuse": {"reflectance": [1, 0, 0]}}}]});
    std::fs::write(&file, scene.to_string()).unwrap();
    let values = values.iter().map(|(pointer, value)| ((*pointer).to_owned(), value.clone())).collect();
    let options = SessionOptions { size: Some([48, 36]), threads: 1, values, ..SessionOptions::default() };
    let session = Session::open(file.to_str().unwrap(), options);
    until(&session, |status| status.stage == Stage::Finished);
    let frame = session.frame().unwrap();
    assert_eq!([frame.width, frame.height], [48, 36]);
    frame.rgba.as_chunks::<4>().0.to_vec()
}

#[test]
fn gray_squares_show_through() {
    let pixels = shown(&[]);
    let at = |x: usize, y: usize| pixels[y * 48 + x];
    assert_eq!(
        [at(0, 0), at(8, 0), at(8, 8)],
        [[0x99, 0x99, 0x99, 255], [0x66, 0x66, 0x66, 255], [0x99, 0x99, 0x99, 255]]
    );
    let [r, g, b, _] = at(24, 18);
    assert!(r > 100 && g < 10 && b < 10, "{r} {g} {b}");
}

#[test]
fn a_backdrop_shows_through() {
    let pixels = shown(&[("/tone/backdrop", json!("#3060c0")), ("/tone/curve", json!("agx"))]);
    assert_eq!([pixels[0], pixels[47]], [[0x30, 0x60, 0xc0, 255]; 2]);
}
