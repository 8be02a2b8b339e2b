//! Scene files that change during a session.
use crate::until;
use juggler::scene::Scene;
use juggler_session::{Edit, Fly, SceneFiles, Session, SessionOptions, Stage, Status};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Time within which a change must be displayed.
const AT_ONCE: Duration = Duration::from_millis(200);

fn watched(file: &Path) -> Session {
    let options = SessionOptions { size: Some([32, 24]), threads: 2, watch: true, ..SessionOptions::default() };
    Session::open(&file.to_string_lossy(), options)
}

fn scene(include: &str, samples: u32) -> String {
    format!(
        r#"{{"version": 1, {include} "render": {{"samples": {samples}}}, "camera": {{"perspective": {{"eye": [0, 0, 5]}}}},
        "objects": [{{"shape": {{"mesh": {{"file": "a.obj"}}}}}}]}}"#
    )
}

/// Replaces a file as editors do: writes another one and renames it.
fn replace(file: &Path, text: &str) {
    let beside = file.with_extension("new");
    fs::write(&beside, text).unwrap();
    fs::rename(beside, file).unwrap();
}

/// Returns the time from a change until the status meets a condition.
fn time(session: &Session, change: &dyn Fn(), what: &dyn Fn(&Status) -> bool) -> Duration {
    let begin = Instant::now();
    change();
    until(session, what);
    begin.elapsed()
}

const TRIANGLE: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn saved_edits_show_at_once_and_mistakes_leave_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let (file, mesh, lights) =
        (folder.path().join("a.json"), folder.path().join("a.obj"), folder.path().join("lights.json"));
    let include = r#""include": ["lights.json"],"#;
    fs::write(&file, scene(include, 2)).unwrap();
    fs::write(&mesh, TRIANGLE).unwrap();
    fs::write(&lights, r#"{"version": 1, "lights": [{"ambient": {}}], "objects": []}"#).unwrap();
    let session = watched(&file);
    let first = until(&session, |status| status.hash.is_some());
    session.edit(Edit::Fly(Fly { forward: 0.5, ..Fly::default() }));
    let moved = until(&session, |status| status.hash.is_some() && status.hash != first.hash);

    let mut times = Vec::new();
    let mut timed = |change: &dyn Fn(), what: &dyn Fn(&Status) -> bool| times.push(time(&session, change, what));
    timed(&|| replace(&file, &scene(include, 3)), &|status| status.samples_wanted == 3 && status.hash.is_some());
    assert_eq!(session.status().camera, moved.camera, "where one flew, one stays");
    let before = until(&session, |status| status.hash.is_some());
    timed(
        &|| replace(&lights, r#"{"version": 1, "lights": [{"ambient": {"intensity": 0.5}}], "objects": []}"#),
        &|status| status.hash.is_some() && status.hash != before.hash,
    );
    let before = until(&session, |status| status.hash.is_some());
    timed(&|| fs::write(&mesh, TRIANGLE.replace("0 1 0", "0 2 0")).unwrap(), &|status| {
        status.hash.is_some() && status.hash != before.hash
    });
    let before = until(&session, |status| status.hash.is_some());

    let broken = scene(include, 3).replace("\"eye\"", "\"eyes\"");
    timed(&|| replace(&file, &broken), &|status| status.error.is_some());
    let status = until(&session, |status| status.stage == Stage::Finished);
    let expected = Scene::load(&file).unwrap_err().to_string();
    assert_eq!(status.error.as_deref(), Some(expected.as_str()));
    assert!(expected.contains("eyes"));
    assert_eq!(status.hash, before.hash, "the last good picture stays");
    session.edit(Edit::Fly(Fly { forward: 0.1, ..Fly::default() }));
    let status = until(&session, |status| status.hash.is_some() && status.hash != before.hash);
    assert!(status.error.is_some(), "one can go on, and the mistake is still there");
    timed(&|| replace(&file, &scene(include, 4)), &|status| status.error.is_none() && status.samples_wanted == 4);
    times.sort();
    assert!(times[times.len() / 2] < AT_ONCE, "{times:?}");
}

#[test]
fn invalid_file_is_shown_once_it_is_corrected() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.json");
    let session = watched(&file);
    until(&session, |status| status.error.is_some());
    fs::write(folder.path().join("a.obj"), TRIANGLE).unwrap();
    fs::write(&file, scene("", 2)).unwrap();
    until(&session, |status| status.error.is_none() && status.hash.is_some());
}

#[test]
fn scenes_of_files_in_memory_keep_to_the_limit() {
    let options = SessionOptions { size: Some([32, 24]), threads: 1, ..SessionOptions::default() };
    let session = Session::open("one-sphere", SessionOptions { max_memory: Some(80 << 20), ..options });
    let first = until(&session, |status| status.hash.is_some());
    let open = |files: Vec<(&str, Vec<u8>)>| {
        let name = files[0].0.to_owned();
        let files = files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect();
        session.edit(Edit::Files(SceneFiles { name, files }))
    };
    let scene = r#"{"version": 1, "camera": {"perspective": {"eye": [0, 0, 5]}}, "objects": [{"shape": "sphere"}]}"#;
    let triangles = TRIANGLE.to_owned() + &"f 1 2 3\n".repeat(400_000);
    // The second file of the first pair counts although the scene does not name it.
    for (name, files) in [
        ("bytes", vec![("a.json", scene.into()), ("b.bin", vec![0; 70 << 20])]),
        ("a mesh", vec![("a.obj", triangles.into_bytes())]),
    ] {
        let revision = open(files);
        let status = until(&session, |status| status.revision >= revision && status.error.is_some());
        let error = status.error.clone().unwrap();
        assert!(error.contains("of memory, more than --max-memory 80.0 MiB"), "{name}: {error}");
        assert_eq!(status.scene, first.scene, "{name}: the scene before stays");
    }
    open(vec![("a.json", scene.into())]);
    until(&session, |status| status.error.is_none() && status.scene == "a.json" && status.hash.is_some());
}
