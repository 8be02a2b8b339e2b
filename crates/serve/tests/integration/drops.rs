//! Files that are dropped on a page: they open from memory, and nothing else is read.
use crate::common::{PATIENCE, Page, Serving, answer, serve, serve_with, wait_until};
use juggler_serve::{Limits, ServerOptions};
use serde_json::json;
use std::io::Write;
use std::time::{Duration, Instant};

const TRIANGLE: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";

/// Body of an upload; the first file is the scene.
fn body(files: &[(&str, &[u8])]) -> Vec<u8> {
    let sizes: Vec<_> = files.iter().map(|(name, bytes)| (name, bytes.len())).collect();
    let head = json!({"name": files[0].0, "files": sizes}).to_string();
    let contents: Vec<u8> = files.iter().flat_map(|(_, bytes)| bytes.iter().copied()).collect();
    [&(head.len() as u32).to_le_bytes(), head.as_bytes(), &contents].concat()
}

/// Uploads files and opens them.
fn drop_files(serving: &Serving, page: &mut Page, files: &[(&str, &[u8])]) {
    let answer = serving.upload(&body(files));
    assert_eq!(answer.status, 200, "{}", answer.text());
    page.send(&format!(r#"{{"dropped": {}}}"#, answer.text()));
}

#[test]
fn dropped_models_open_with_the_files_that_they_name() {
    let serving = serve();
    let mut page = serving.page();
    drop_files(&serving, &mut page, &[("a.obj", TRIANGLE.as_bytes()), ("a.mtl", b"newmtl red\nKd 1 0 0\n")]);
    wait_until("the model is open", || serving.session.status().scene == "a.obj");
    assert_eq!(serving.session.status().error, None);
    // Edits and reloads keep the files.
    page.send(r#"{"edit": {"setting": {"samples": 3}}}"#);
    page.send(r#"{"edit": "reload"}"#);
    wait_until("the model is loaded again", || serving.session.status().revision >= 3);
    assert_eq!((serving.session.status().scene.as_str(), serving.session.status().error.clone()), ("a.obj", None));
    page.send(r#"{"edit": {"scene": "one-sphere"}}"#);
    wait_until("the built-in scene is open", || serving.session.status().scene == "one-sphere");
}

#[test]
fn dropped_scenes_read_no_file_of_the_server() {
    let serving = serve();
    let mut page = serving.page();
    let folder = tempfile::tempdir().unwrap();
    let secret = folder.path().join("secret.obj");
    std::fs::write(&secret, TRIANGLE).unwrap();
    let scene = json!({"version": 1, "objects": [{"shape": {"mesh": {"file": secret}}}]}).to_string();
    drop_files(&serving, &mut page, &[("scene.json", scene.as_bytes())]);
    wait_until("the scene is refused", || serving.session.status().error.is_some());
    let error = serving.session.status().error.clone().unwrap();
    assert!(error.contains("secret.obj"), "{error}");
    // A bookmark of a scene in memory changes no file of the same name.
    let named = folder.path().join("named.json");
    std::fs::write(&named, "untouched").unwrap();
    let empty =
        br#"{"version": 1, "camera": {"perspective": {"eye": [0, 0, 5], "look_at": [0, 0, 0]}}, "objects": []}"#;
    drop_files(&serving, &mut page, &[(named.to_str().unwrap(), empty)]);
    wait_until("the scene is open", || serving.session.status().scene == named.to_str().unwrap());
    page.send(r#"{"edit": {"bookmark": "here"}}"#);
    wait_until("the bookmark is set", || serving.session.status().cameras.iter().any(|name| name == "here"));
    assert_eq!(std::fs::read_to_string(&named).unwrap(), "untouched");
}

#[test]
fn faulty_uploads_are_refused_with_a_reason() {
    let limits = Limits { dropped_bytes: 1000, ..Limits::default() };
    let serving = serve_with(ServerOptions { limits, ..ServerOptions::default() });
    let answer = serving.upload(&body(&[("a.obj", &[b' '; 2000])]));
    assert_eq!(answer.status, 413, "{}", answer.text());
    let answer = serving.upload(b"no upload");
    assert_eq!((answer.status, answer.text().contains("upload") || answer.text().contains("list")), (400, true));
    let (host, cookie) = (format!("Host: {}", serving.host()), format!("Cookie: {}", serving.cookie.clone().unwrap()));
    let origin = format!("Origin: http://{}", serving.host());
    assert_eq!(serving.request("POST", "/drop", &[&host, &cookie]).status, 403, "no Origin header");
    assert_eq!(serving.request("POST", "/drop", &[&host, &origin]).status, 403, "no token");
    assert_eq!(serving.request("GET", "/drop", &[&host, &cookie]).status, 405);
}

#[test]
fn only_the_page_that_steers_opens_the_newest_files() {
    let serving = serve();
    let (mut first, mut second) = (serving.page(), serving.page());
    let old = serving.upload(&body(&[("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")])).text();
    let [new, newer] =
        ["b.obj", "c.obj"].map(|name| serving.upload(&body(&[(name, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")])).text());
    second.send(&format!(r#"{{"dropped": {new}}}"#));
    assert_eq!(second.next_text("refused", |_| true), "another page controls the session");
    first.send(&format!(r#"{{"dropped": {old}}}"#));
    assert_eq!(first.next_text("refused", |_| true), "other files were dropped in the meantime");
    first.send(&format!(r#"{{"dropped": {new}}}"#));
    wait_until("the second newest files are open", || serving.session.status().scene == "b.obj");
    first.send(&format!(r#"{{"dropped": {newer}}}"#));
    wait_until("the newest files are open", || serving.session.status().scene == "c.obj");
}

/// Server whose uploads have at most 1,000 bytes each and 2 units of 4 KiB together, and end after a
/// silence.
fn serve_small(upload_silence: Duration) -> Serving {
    let limits = Limits { dropped_bytes: 1000, dropped_total_bytes: 8192, upload_silence, ..Limits::default() };
    serve_with(ServerOptions { limits, ..ServerOptions::default() })
}

#[test]
fn the_stated_length_is_judged_before_any_byte_of_the_body() {
    let serving = serve_small(PATIENCE);
    for length in ["1001", "3000000000", "18446744073709551613"] {
        let start = Instant::now();
        let answer = answer(&mut serving.begin_upload(&format!("Content-Length: {length}")));
        assert_eq!(answer.status, 413, "{length}: {}", answer.text());
        assert!(answer.text().contains("0.0 MiB, the limit") && start.elapsed() < PATIENCE, "{length}");
        assert_eq!(answer.header("connection"), Some("close"));
    }
    // Without a stated length, the excess is refused when it arrives.
    let mut stream = serving.begin_upload("Transfer-Encoding: chunked");
    let body = body(&[("a.obj", &[b' '; 2000])]);
    let _ = write!(stream, "{:x}\r\n", body.len());
    let _ = stream.write_all(&body);
    assert_eq!(answer(&mut stream).status, 413);
    assert!(serving.is_alive());
}

#[test]
fn an_upload_without_a_byte_frees_its_place() {
    let serving = serve_small(Duration::from_secs(4));
    let all = body(&[("a.obj", TRIANGLE.as_bytes())]);
    let (half, rest) = all.split_at(all.len() / 2);
    let length = format!("Content-Length: {}", all.len());
    let mut silent = [serving.begin_upload(&length), serving.begin_upload(&length)];
    silent[1].write_all(half).unwrap();
    wait_until("both places are taken", || serving.upload(&all).status == 503);
    for stream in &mut silent {
        assert_eq!(answer(stream).status, 408);
    }
    serving.wait_for_line("no byte arrived");
    // An upload that takes longer than the silence, byte by byte, is complete.
    let mut slow = serving.begin_upload(&length);
    slow.write_all(half).unwrap();
    for byte in rest.chunks(rest.len().div_ceil(8)) {
        std::thread::sleep(Duration::from_millis(600));
        slow.write_all(byte).unwrap();
    }
    let answer = answer(&mut slow);
    assert_eq!(answer.status, 200, "{}", answer.text());
}

#[test]
fn two_pages_upload_at_the_same_time() {
    let serving = serve();
    let mut page = serving.page();
    let bodies = ["a.obj", "b.obj"].map(|name| body(&[(name, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")]));
    let mut streams = bodies.each_ref().map(|body| serving.begin_upload(&format!("Content-Length: {}", body.len())));
    // Both uploads begin before one of them ends.
    for part in 0..2 {
        for (stream, body) in streams.iter_mut().zip(&bodies) {
            let (first, second) = body.split_at(body.len() / 2);
            stream.write_all(if part == 0 { first } else { second }).unwrap();
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let numbers = streams.each_mut().map(|stream| {
        let answer = answer(stream);
        assert_eq!(answer.status, 200, "{}", answer.text());
        answer.text()
    });
    for (number, name) in numbers.iter().zip(["a.obj", "b.obj"]) {
        page.send(&format!(r#"{{"dropped": {number}}}"#));
        wait_until("the files are open", || serving.session.status().scene == name);
    }
}
