//! Hashes of the linear pixels of every built-in scene and of the [extra](super::extra) scenes,
//! rendered small: the same for any number of threads, and those in `hashes.txt`. The test runs
//! unoptimized and optimized, on every platform, against the same file.
//!
//! After an intended change of pictures: `JUGGLER_BLESS=1 cargo test -p juggler-golden --test
//! golden hashes::`.

use super::extra::{EXTRA_SCENES, scene};
use juggler::camera::film::Rect;
use juggler::render::Control;
use juggler::scene::{Scene, built_in_scenes};
use juggler::{Error, Picture, Settings};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::collections::BTreeMap;
use std::path::Path;

/// Width of a picture, in pixels; the scene determines the aspect ratio.
const WIDTH: u32 = 64;
/// Maximum number of samples per pixel.
const MAX_SAMPLES: u32 = 4;
/// Frames to render besides the first, in scenes that are long enough.
const FRAMES: [u32; 3] = [7, 15, 22];
/// Scenes whose pictures of at least 320 × 180 pixels have several camera rays for each sample, of
/// which a part is rendered.
const SPLIT_SCENES: [&str; 2] = ["visible-emitters", "many-lights-room"];
/// Width of these pictures, and the part.
const SPLIT_WIDTH: u32 = 320;
const SPLIT_PART: Rect = Rect { x: 128, y: 72, width: 64, height: 36 };
/// Numbers of threads whose pictures must agree.
const THREADS: [usize; 3] = [1, 2, 3];

/// Hashes by view: `scene`, `scene/camera` if there are several cameras, `scene@frame` for later
/// frames, `scene#width` for a part of a larger picture.
type Hashes = BTreeMap<String, String>;

/// Settings of a picture of this width.
fn settings(scene: &Scene, width: u32) -> Settings {
    let render = &scene.description.render;
    let [columns, rows] = render.size.map(f64::from);
    let height = (f64::from(width) * rows / columns).round().max(1.0) as u32;
    let samples = Some(render.samples.min(MAX_SAMPLES));
    Settings { size: Some([width, height]), samples, ..Settings::default() }
}

/// A small picture of a scene from one of its cameras.
fn picture(scene: &Scene, camera: Option<&str>) -> Picture {
    let camera = camera.map(str::to_owned);
    Picture::new(scene, &Settings { camera, ..settings(scene, WIDTH) }).unwrap()
}

/// Adds the hash of some pixels of a picture with several camera rays for each sample.
fn add_split(hashes: &mut Hashes, name: &str, pools: &[ThreadPool]) {
    let scene = scene(name);
    let hash = |pool: &ThreadPool| {
        let settings = Settings { crop: Some(SPLIT_PART), ..settings(&scene, SPLIT_WIDTH) };
        // Each picture chooses the number of camera rays by itself.
        let (picture, control) = (Picture::new(&scene, &settings).unwrap(), Control::default());
        let film = picture.film();
        pool.install(|| picture.render_film(&film, &control)).unwrap();
        let rays = control.rays().camera / picture.total_samples();
        (picture.develop(&film, |_| Ok::<(), Error>(())).unwrap().hash, rays)
    };
    let all: Vec<(String, u64)> = pools.iter().map(hash).collect();
    assert!(all.iter().all(|one| *one == all[0]), "{name}: {all:?} on {THREADS:?} threads");
    assert_eq!(all[0].1, 4, "camera rays of {name}");
    hashes.insert(format!("{name}#{SPLIT_WIDTH}"), all[0].0.clone());
}

fn hash(picture: &Picture, pool: &ThreadPool) -> String {
    let rows = |_: &[_]| Ok::<(), Error>(());
    pool.install(|| picture.render(Default::default(), &Control::default(), rows)).unwrap().hash
}

/// Renders the views of a scene and adds their hashes.
fn add(hashes: &mut Hashes, name: &str, pools: &[ThreadPool]) {
    let scene = scene(name);
    let length = scene.description.animation.frames;
    for frame in [0].into_iter().chain(FRAMES.into_iter().filter(|frame| *frame < length)) {
        let moved = if frame == 0 { scene.clone() } else { scene.at_frame(frame.into()).unwrap() };
        let several = moved.description.cameras.len() > 1;
        let cameras: Vec<Option<&str>> = match several {
            true => moved.description.cameras.keys().map(|camera| Some(camera.as_str())).collect(),
            false => vec![None],
        };
        for camera in cameras {
            let at = if frame == 0 { String::new() } else { format!("@{frame}") };
            let view = camera.map_or(name.to_owned(), |camera| format!("{name}/{camera}")) + &at;
            let picture = picture(&moved, camera);
            let all: Vec<String> = pools.iter().map(|pool| hash(&picture, pool)).collect();
            assert!(all.iter().all(|one| *one == all[0]), "{view}: {all:?} on {THREADS:?} threads");
            hashes.insert(view, all[0].clone());
        }
    }
}

fn to_text(hashes: &Hashes) -> String {
    hashes.iter().map(|(view, hash)| format!("{view} {hash}\n")).collect()
}

/// Differences of two texts, line by line.
pub(crate) fn changes(old: &str, new: &str) -> String {
    let missing = |from: &str, to: &str, sign: &str| {
        let lines = from.lines().filter(|line| !to.lines().any(|other| other == *line));
        lines.map(|line| format!("{sign} {line}\n")).collect::<String>()
    };
    missing(old, new, "-") + &missing(new, old, "+")
}

#[test]
fn built_in_scenes_have_their_hashes_on_any_number_of_threads() {
    let pools = THREADS.map(|threads| ThreadPoolBuilder::new().num_threads(threads).build().unwrap());
    let mut hashes = Hashes::new();
    for name in built_in_scenes().iter().map(|scene| scene.name).chain(EXTRA_SCENES) {
        add(&mut hashes, name, &pools);
    }
    SPLIT_SCENES.iter().for_each(|name| add_split(&mut hashes, name, &pools));
    assert!(hashes.len() >= built_in_scenes().len() && hashes.contains_key("juggler@22"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("hashes.txt");
    let found = to_text(&hashes);
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        std::fs::write(&path, &found).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == expected, "pictures differ from hashes.txt:\n{}", changes(&expected, &found));
}
