//! Previews before an image is finished: passes of increasing resolution, denoised previews, and
//! the center of orbits.
use crate::until;
use juggler::camera::film::{Film, Tiling};
use juggler::denoise::{Denoiser, DenoiserInput};
use juggler::math::{Rgb, vec3};
use juggler::render::{self, Control, StopCriterion};
use juggler::scene::Scene;
use juggler::{Picture, Settings};
use juggler_session::{Channel, Edit, Fly, Orbit, Session, SessionOptions, Setting, Stage, Status};
use std::sync::{Arc, Mutex};
use std::time::Duration;

const SIZE: [u32; 2] = [64, 48];

fn options() -> SessionOptions {
    SessionOptions { size: Some(SIZE), threads: 2, ..SessionOptions::default() }
}

fn after(session: &Session, edit: Edit) -> Arc<Status> {
    let revision = session.edit(edit);
    until(session, |status| status.revision >= revision && status.stage == Stage::Finished)
}

fn of(text: &str) -> Session {
    let session = Session::from_scene(Scene::from_json(text, "preview.json").unwrap(), "preview", options());
    until(&session, |status| status.stage == Stage::Finished);
    session
}

/// A unit sphere at the origin in front of a wall at z = -5; the camera is at (3, 0, 10).
fn ball(camera: &str) -> String {
    format!(
        r#"{{"version": 1, "render": {{"samples": 2}}, "camera": {{"perspective": {{"eye": [3, 0, 10], {camera}}}}},
        "objects": [{{"shape": "sphere"}},
            {{"shape": {{"rectangle": {{}}}}, "transform": [{{"rotate": {{"axis": [1, 0, 0], "degrees": 90}}}}, {{"scale": 20}}, {{"translate": [0, 0, -5]}}]}}]}}"#
    )
}

fn near(a: [f32; 3], b: [f32; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.02)
}

#[test]
fn passes_over_the_whole_picture_come_before_samples() {
    let options = SessionOptions {
        size: Some([320, 240]),
        threads: 1,
        budget: Duration::from_micros(1),
        ..SessionOptions::default()
    };
    let session = Session::open("juggler", options);
    let frames: Arc<Mutex<Vec<(u64, u32, f32)>>> = Arc::default();
    let (recorded, handle) = (Arc::clone(&frames), session.clone());
    session.on_update(move || {
        if let Some(frame) = handle.frame() {
            let mut frames = recorded.lock().unwrap();
            if frames.last().is_none_or(|(number, ..)| *number != frame.number) {
                frames.push((frame.number, frame.width, frame.samples));
            }
        }
    });
    until(&session, |status| status.samples >= 1.0);
    let frames = frames.lock().unwrap();
    let widths: Vec<u32> = frames.iter().map(|(_, width, _)| *width).collect();
    let passes: Vec<u32> = widths.iter().copied().filter(|width| *width >= 40).take(4).collect();
    assert_eq!(passes, [40, 80, 160, 320], "{widths:?}");
    let whole = widths.iter().position(|width| *width == 320).unwrap();
    assert!(widths[whole..].iter().all(|width| *width == 320), "{widths:?}");
    assert!(widths.is_sorted(), "every pass is finer than the last: {widths:?}");
    assert_eq!(frames[whole].2, 1.0, "the first with all pixels shows one ray through each");
}

#[test]
fn orbits_pivot_about_the_look_at_point() {
    let session = of(&ball(r#""look_at": [1, 0, 1]"#));
    assert!(near(session.status().interest, [1.0, 0.0, 1.0]), "{:?}", session.status().interest);
    // The pivot has no effect while a point is chosen.
    after(&session, Edit::Pivot([2.0, 2.0]));
    let turned = after(&session, Edit::Orbit(Orbit { yaw_degrees: 40.0, ..Orbit::default() }));
    assert!(near(turned.interest, [1.0, 0.0, 1.0]), "{:?}", turned.interest);
    let eye = turned.camera.as_ref().unwrap().axes().unwrap().eye;
    let distance = eye.distance(vec3(1.0, 0.0, 1.0));
    assert!((distance - (4.0_f32 + 81.0).sqrt()).abs() < 1e-3, "{distance}");
    // A clicked point takes precedence, and another frame or an edited value keeps it.
    let clicked = after(&session, Edit::Focus([32.0, 24.0])).interest;
    assert!(!near(clicked, [1.0, 0.0, 1.0]));
    let set = after(&session, Edit::Set { path: "/objects/0/shape".into(), value: serde_json::json!("cylinder") });
    assert_eq!((set.error.clone(), set.interest), (None, clicked));
}

#[test]
fn orbits_without_look_at_pivot_about_the_point_under_the_pointer() {
    let session = of(&ball(r#""direction": [0, 0, -1]"#));
    assert!(near(session.status().interest, [3.0, 0.0, -5.0]), "the middle: {:?}", session.status().interest);
    // The sphere is 3 units to the left at distance 10, where half the film (40 degrees) spans 3.64
    // vertically and 4.85 horizontally.
    let half = (20.0_f32).to_radians().tan();
    let pixel = [32.0 - 3.0 / 10.0 / half * 24.0, 24.0];
    let at = after(&session, Edit::Pivot(pixel));
    assert!(at.interest[0].abs() < 0.5 && at.interest[2] > 0.8, "{:?}", at.interest);
    let again = after(&session, Edit::Pivot([32.0, 24.0]));
    assert_eq!(again.interest, at.interest, "a second drag turns about the same point");
    // Once the point leaves the image, the start of the next drag counts.
    after(&session, Edit::Fly(Fly { right: 20.0, ..Fly::default() }));
    let other = after(&session, Edit::Pivot([32.0, 24.0]));
    assert!(!near(other.interest, at.interest), "{:?}", other.interest);
    // A `look_at` far beyond the scene only gives a direction.
    let far = of(&ball(r#""look_at": [3, 0, -5000]"#));
    assert!(near(far.status().interest, [3.0, 0.0, -5.0]), "{:?}", far.status().interest);
}

/// A dimly lit scene with a noisy image.
const DIM: &str = r#"{"version": 1, "render": {"samples": 16, "integrator": "path"},
    "camera": {"perspective": {"eye": [0, 1, 6], "look_at": [0, 1, 0]}}, "background": [0.05, 0.06, 0.08],
    "materials": {"emitter": {"emissive": {"radiance": 8}}},
    "objects": [{"shape": "plane"}, {"shape": "sphere", "transform": [{"translate": [0, 1, 0]}]},
        {"shape": {"sphere": {"radius": 0.3}}, "material": "emitter", "transform": [{"translate": [1.5, 2.5, 1]}]}]}"#;

/// Returns the denoised image and the film's hash of an offline render.
fn offline(denoiser: Option<Denoiser>) -> (Vec<Rgb>, String) {
    let settings = Settings { size: Some(SIZE), denoiser, ..Settings::default() };
    let picture = Picture::new(&Scene::from_json(DIM, "preview.json").unwrap(), &settings).unwrap();
    let film = Film::new(Tiling::new(picture.region()), 0..picture.samples());
    render::render_progressive(&picture.job(), &film, StopCriterion::Samples, &Control::default()).unwrap();
    let mut input = DenoiserInput::new(picture.region());
    film.tiles().for_each(|(_, tile)| input.add(picture.aovs(), &tile));
    let pixels = input.denoise(Denoiser::Own, None, &Control::default()).unwrap().unwrap().pixels;
    (pixels, picture.develop(&film, |_| Ok::<(), std::convert::Infallible>(())).unwrap().hash)
}

fn saved(session: &Session) -> Vec<Rgb> {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("shown.pfm");
    session.save(&file).unwrap();
    juggler::imaging::read(&file).unwrap().pixels().to_vec()
}

#[test]
fn denoised_preview_equals_the_offline_render_and_can_be_disabled() {
    let session = of(DIM);
    let (plain, noisy) = (session.status(), session.frame().unwrap().rgba.clone());
    assert!(!plain.denoise && !plain.denoised);
    let denoised = after(&session, Edit::Setting(Setting::Denoise(true)));
    assert!(denoised.denoise && denoised.denoised && denoised.error.is_none(), "{denoised:?}");
    assert_ne!(session.frame().unwrap().rgba, noisy);
    let (pixels, hash) = offline(Some(Denoiser::Own));
    assert_eq!(denoised.hash.as_deref(), Some(hash.as_str()));
    assert!(saved(&session) == pixels, "what is saved is what is shown");
    // Another exposure keeps the denoised pixels; another channel is not denoised.
    let brighter = after(&session, Edit::Setting(Setting::Exposure(1.0)));
    assert!(brighter.denoised && brighter.hash == denoised.hash);
    assert!(!after(&session, Edit::Show(Channel::Normals)).denoised);
    assert!(after(&session, Edit::Show(Channel::Color)).denoised);
    after(&session, Edit::Setting(Setting::Exposure(0.0)));
    let back = after(&session, Edit::Setting(Setting::Denoise(false)));
    assert!(!back.denoise && !back.denoised && back.hash == plain.hash);
    assert_eq!(session.frame().unwrap().rgba, noisy);
}

#[test]
fn denoising_stays_on_for_other_views_and_scenes_but_not_while_something_moves() {
    let session = of(DIM);
    after(&session, Edit::Setting(Setting::Denoise(true)));
    let history: Arc<Mutex<Vec<Arc<Status>>>> = Arc::default();
    let (statuses, handle) = (Arc::clone(&history), session.clone());
    session.on_update(move || statuses.lock().unwrap().push(handle.status()));
    let moved = after(&session, Edit::Fly(Fly { yaw_degrees: 2.0, ..Fly::default() }));
    assert!(moved.denoised);
    let first = history.lock().unwrap().iter().find(|status| status.revision == moved.revision).cloned().unwrap();
    assert!(first.stage == Stage::Moving && !first.denoised, "{first:?}");
    assert!(after(&session, Edit::Scene("cornell-cube".into())).denoised);
    let reset = after(&session, Edit::Reset);
    assert!(reset.denoise && reset.denoised, "it is a way of looking, not a change of the scene");
}

#[test]
fn a_long_picture_is_denoised_before_it_is_finished() {
    let session = of(DIM);
    session.edit(Edit::Setting(Setting::Denoise(true)));
    session.edit(Edit::Setting(Setting::Samples(1_000_000)));
    let status = until(&session, |status| status.denoised);
    assert!(status.stage == Stage::Refining && status.samples < 1e6, "{status:?}");
    // Sampling continues.
    until(&session, |later| later.denoised && later.samples > 2.0 * status.samples);
}

#[test]
fn pictures_too_large_to_denoise_are_reported() {
    let session = of(DIM);
    session.edit(Edit::Setting(Setting::Size([2048, 1100])));
    let revision = session.edit(Edit::Setting(Setting::Denoise(true)));
    let status = until(&session, |status| status.revision >= revision);
    assert!(status.error.as_ref().is_some_and(|error| error.contains("2097152")), "{:?}", status.error);
    assert!(!status.denoise);
    session.edit(Edit::Setting(Setting::Size(SIZE)));
    after(&session, Edit::Setting(Setting::Denoise(true)));
    let large = after(&session, Edit::Setting(Setting::Size([2048, 1100])));
    assert!(large.error.as_ref().is_some_and(|error| error.contains("2097152")), "{:?}", large.error);
    assert_eq!((large.size, large.denoised), (SIZE, true));
}
