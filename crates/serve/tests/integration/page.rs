//! Messages that a page receives, and requests that it may make.
use crate::common::{PATIENCE, Received, serve, serve_with, wait_until};
use juggler_serve::ServerOptions;
use serde_json::json;
use std::time::{Duration, Instant};

#[test]
fn frames_arrive_at_once_and_the_final_frame_is_lossless() {
    let serving = serve();
    let mut page = serving.page();
    let (first, image) = page.next_frame(|_| true);
    assert_eq!(first.size, [64, 48]);
    assert!(first.serial == 1 && image.starts_with(&[0xff, 0xd8]), "a JPEG");
    let (last, image) = page.next_frame(|head| head.kind == 2);
    assert!(image.starts_with(b"\x89PNG"));
    let frame = serving.session.frame().unwrap();
    assert_eq!((last.number, last.revision, last.samples), (frame.number, frame.revision, frame.samples));
    let mut reader = png::Decoder::new(std::io::Cursor::new(image)).read_info().unwrap();
    let mut pixels = vec![0; 64 * 48 * 4];
    reader.next_frame(&mut pixels).unwrap();
    assert!(pixels == frame.rgba, "the last picture is the session's");
    // Afterwards nothing is sent, neither frames nor texts.
    assert!(page.receive_for(Duration::from_millis(500)));
    assert_eq!(serving.session.frame().unwrap().number, frame.number);
}

#[test]
fn edits_change_the_frame() {
    let serving = serve();
    let mut page = serving.page();
    let before = page.next_text("status", |status| status["stage"] == "finished");
    page.send(r#"{"edit": {"fly": {"yaw_degrees": 5}}}"#);
    let revision = before["revision"].as_u64().unwrap();
    let (head, _) = page.next_frame(|head| head.revision > revision);
    assert!(head.revision > revision);
    let after = page.next_text("status", |status| status["stage"] == "finished" && status["revision"] != revision);
    assert_ne!(after["camera"], before["camera"]);
    page.send(r#"{"edit": {"scene": "red-cube"}}"#);
    page.next_text("status", |status| status["scene"] == "red-cube" && status["stage"] == "finished");
    page.send(r#"{"edit": {"show": "normals"}}"#);
    page.next_text("status", |status| status["channel"] == "normals");
}

#[test]
fn forbidden_edits_of_pages_are_rejected() {
    let serving = serve();
    let mut page = serving.page();
    let scene = page.next_text("status", |status| status["scene"] != "")["scene"].clone();
    for edit in [
        json!({"scene": "/etc/passwd"}),
        json!({"scene": "Cargo.toml"}),
        json!({"setting": {"size": [60_000, 60_000]}}),
        json!({"set": {"path": "/include", "value": ["/etc/passwd"]}}),
        json!({"set": {"path": "/objects/0/shape", "value": {"mesh": {"file": "/etc/passwd"}}}}),
    ] {
        page.send(&json!({ "edit": edit }).to_string());
        let why = page.next_text("refused", |_| true);
        assert!(!why.as_str().unwrap().contains("root:"), "{why}");
    }
    let status = serving.session.status();
    assert_eq!((json!(status.scene), &status.error, status.size), (scene, &None, [64, 48]));
    serving.wait_for_line("pages may choose built-in scenes");
}

#[test]
fn one_page_steers_and_the_others_watch() {
    let serving = serve();
    let (mut first, mut second) = (serving.page(), serving.page());
    first.next_text("wheel", |wheel| wheel["steering"] == true && wheel["watching"] == 2);
    second.next_text("wheel", |wheel| wheel["steering"] == false && wheel["free"] == false);
    let revision = serving.session.status().revision;
    second.send(r#"{"edit": {"fly": {"yaw_degrees": 5}}}"#);
    assert_eq!(second.next_text("refused", |_| true), "another page controls the session");
    assert_eq!(serving.session.status().revision, revision);
    second.next_frame(|_| true);
    second.send(r#"{"steer": true}"#);
    second.next_text("wheel", |wheel| wheel["steering"] == true);
    first.next_text("wheel", |wheel| wheel["steering"] == false);
    // When the steering page disconnects, the wheel is free; the next page that edits takes it.
    let mut third = serving.page();
    // Wait until the third page is connected, lest the first be alone for a moment.
    third.next_text("wheel", |wheel| wheel["watching"] == 3);
    drop(second);
    first.next_text("wheel", |wheel| wheel["free"] == true && wheel["watching"] == 2);
    first.send(r#"{"edit": {"fly": {"yaw_degrees": 5}}}"#);
    first.next_text("wheel", |wheel| wheel["steering"] == true);
    first.next_text("status", |status| status["revision"].as_u64() > Some(revision));
    third.next_text("wheel", |wheel| wheel["steering"] == false && wheel["free"] == false);
    // A single page steers without a request.
    drop(first);
    third.next_text("wheel", |wheel| wheel["steering"] == true && wheel["watching"] == 1);
}

#[test]
fn slow_pages_skip_frames_and_use_no_more_memory() {
    let serving = serve();
    let mut page = serving.page();
    page.next_text("status", |status| status["stage"] == "finished");
    let mut slow = serving.page();
    // Without acknowledgments at most two frames are sent.
    for _ in 0..30 {
        page.send(r#"{"edit": {"fly": {"yaw_degrees": 1}}}"#);
        page.next_frame(|_| true);
    }
    let newest = page.next_frame(|head| head.kind == 2).0;
    slow.socket.get_ref().set_read_timeout(Some(Duration::from_millis(300))).unwrap();
    let mut serials = Vec::new();
    while let Some(received) = slow.receive() {
        if let Received::Frame(head, _) = received {
            serials.push(head.serial);
        }
    }
    assert_eq!(serials, [1, 2]);
    slow.socket.get_ref().set_read_timeout(Some(PATIENCE)).unwrap();
    // Afterwards the newest frame is sent, none of those between.
    slow.send(r#"{"ack": 2}"#);
    assert_eq!(slow.next_frame(|_| true).0.number, newest.number);
}

#[test]
fn rendering_continues_after_a_page_disconnects() {
    let serving = serve();
    let mut page = serving.page();
    page.next_frame(|_| true);
    page.send(r#"{"edit": {"fly": {"yaw_degrees": 5}}}"#);
    page.send(r#"{"edit": {"setting": {"samples": 64}}}"#);
    page.next_text("status", |status| status["samples_wanted"] == 64);
    drop(page);
    wait_until("the picture is finished with nobody there", || {
        serving.session.status().stage == juggler_session::Stage::Finished
    });
    // Compare as text, since parsing rounds the last digit.
    let known = serde_json::to_string(&*serving.session.status()).unwrap();
    let known: serde_json::Value = serde_json::from_str(&known).unwrap();
    let status = serving.page().next_text("status", |_| true);
    assert_eq!((&status["camera"], &status["samples_wanted"]), (&known["camera"], &json!(64)));
}

#[test]
fn pixels_are_probed() {
    let serving = serve();
    let mut page = serving.page();
    page.next_text("status", |status| status["stage"] == "finished");
    page.send(r#"{"probe": [32, 24]}"#);
    let facts = page.next_text("probe", |_| true);
    assert_eq!(facts["pixel"], json!([32, 24]));
    assert!(facts["depth"].as_f64().unwrap() > 0.0 && facts["color"].is_array(), "{facts}");
    page.send(r#"{"probe": [4000000000, 4000000000]}"#);
    page.next_text("probe", |_| true);
}

#[test]
fn pictures_are_saved_by_download() {
    let serving = serve();
    serving.page().next_text("status", |status| status["stage"] == "finished");
    let png = serving.get("/save/picture.png");
    assert!(png.status == 200 && png.body.starts_with(b"\x89PNG"));
    assert_eq!(png.header("content-disposition"), Some("attachment; filename=\"one-sphere.png\""));
    assert!(serving.get("/save/picture.exr").body.starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    assert_eq!(serving.get("/save/picture.tga").status, 404);
}

#[test]
fn scenes_are_listed_with_small_pictures() {
    let serving = serve_with(ServerOptions { scene: Some("mine.json".into()), ..ServerOptions::default() });
    let listing: serde_json::Value = serde_json::from_slice(&serving.get("/catalogue.json").body).unwrap();
    assert_eq!(listing["file"]["name"], "mine.json");
    let picture = serving.get("/thumbnail/red-cube.jpg");
    assert!(picture.status == 200 && picture.body.starts_with(&[0xff, 0xd8]));
    assert_eq!(serving.get("/thumbnail/no-such-scene.jpg").status, 404);
}

#[test]
fn every_file_that_the_page_names_is_there() {
    let serving = serve();
    let mut waiting = vec!["/".to_owned()];
    let mut seen = Vec::new();
    while let Some(path) = waiting.pop() {
        let answer = serving.get(&path);
        assert_eq!(answer.status, 200, "{path}");
        let text = answer.text();
        assert!(!text.contains("https://"), "{path} names another site");
        let quoted = text.split(['"', '\'']).filter(|part| part.ends_with(".js") || part.ends_with(".css"));
        let named: Vec<_> = quoted.map(|part| format!("/{}", part.trim_start_matches(['.', '/']))).collect();
        seen.push(path);
        waiting.extend(named.into_iter().filter(|name| !seen.contains(name)));
        waiting.sort();
        waiting.dedup();
    }
    assert!(seen.len() >= 10, "{seen:?}");
}

#[test]
fn an_idle_server_does_nothing() {
    let serving = serve();
    let mut page = serving.page();
    page.next_text("status", |status| status["stage"] == "finished");
    page.receive_for(Duration::from_millis(600));
    let status = serving.session.status().number;
    let start = Instant::now();
    assert!(page.receive_for(Duration::from_millis(400)) && start.elapsed() < PATIENCE);
    assert_eq!(serving.session.status().number, status);
}
