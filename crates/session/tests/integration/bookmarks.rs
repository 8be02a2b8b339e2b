//! Bookmarked cameras, which go into the scene's file, into a scene beside a model, or into memory.

use crate::edits::{after, in_folder, opened};
use juggler::camera::AnyCamera;
use juggler_session::{Edit, Fly, wire};
use std::fs;

#[test]
fn bookmarks_go_into_the_file_or_into_memory() {
    let (_folder, name) = in_folder();
    let session = opened(&name);
    after(&session, Edit::Fly(Fly { up: 1.0, ..Fly::default() }));
    let moved = session.status().camera.clone();
    let kept = after(&session, Edit::Bookmark("above".into()));
    assert_eq!((kept.cameras.as_slice(), &kept.camera), (["camera".to_owned(), "above".to_owned()].as_slice(), &moved));
    let text = fs::read_to_string(&name).unwrap();
    assert!(text.contains("// Stays.") && text.contains("\"above\""), "{text}");
    assert_eq!(after(&session, Edit::Camera("above".into())).camera, moved);
    let built_in = opened("juggler");
    after(&built_in, Edit::Zoom(2.0));
    after(&built_in, Edit::Bookmark("near".into()));
    let bookmarks = built_in.bookmarks();
    assert!(matches!(&bookmarks[..], [(name, AnyCamera::Perspective(_))] if name == "near"), "{bookmarks:?}");
    assert!(wire::bookmarks(&bookmarks)["near"]["perspective"].is_object());
    assert_eq!(after(&built_in, Edit::Camera("camera".into())).error, None);
}

/// Bookmarks of a mesh go into a scene beside it, which shows the mesh as the window did.
#[test]
fn bookmarks_of_a_mesh_go_into_a_scene_beside_it() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = folder.path().join("tri.obj");
    fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let session = opened(mesh.to_str().unwrap());
    for name in ["first", "second"] {
        after(&session, Edit::Zoom(1.5));
        let kept = after(&session, Edit::Bookmark(name.into()));
        assert!(kept.error.is_none() && kept.cameras.iter().any(|camera| camera == name), "{:?}", kept.error);
    }
    let text = fs::read_to_string(folder.path().join("tri.json")).unwrap();
    let scene: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(scene["objects"][0]["shape"]["mesh"]["file"], "tri.obj");
    let cameras: Vec<&String> = scene["cameras"].as_object().unwrap().keys().collect();
    assert_eq!(cameras, ["first", "second"]);
    let beside = opened(folder.path().join("tri.json").to_str().unwrap());
    assert_eq!(after(&beside, Edit::Camera("second".into())).camera, session.status().camera);
}
