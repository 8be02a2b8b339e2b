//! Hashes of the linear pixels of every built-in scene and of the [extra](super::extra) scenes,
//! rendered small: the same for any number of threads, and those in `hashes.txt`. The test runs
//! unoptimized and optimized, on every platform, against the same file.
//!
//! After an intended change of pictures: `JUGGLER_BLESS=1 cargo test -p juggler-golden --test
//! golden hashes::`.

use super::extra::{EXTRA_SCENES, scene};
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
/// Numbers of threads whose pictures must agree.
const THREADS: [usize; 3] = [1, 2, 3];

/// Hashes by view: `scene`, `scene/camera` if there are several cameras, `scene@frame` for later
/// frames.
type Hashes = BTreeMap<String, String>;

/// A small picture of a scene from one of its cameras.
fn picture(scene: &Scene, camera: Option<&str>) -> Picture {
    let render = &scene.description.render;
    let [width, height] = render.size.map(f64::from);
    let height = (f64::from(WIDTH) * height / width).round().max(1.0) as u32;
    let settings = Settings {
        size: Some([WIDTH, height]),
        samples: Some(render.samples.min(MAX_SAMPLES)),
        camera: camera.map(str::to_owned),
        ..Settings::default()
    };
    Picture::new(scene, &settings).unwrap()
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
    assert!(hashes.len() >= built_in_scenes().len() && hashes.contains_key("juggler@22"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("hashes.txt");
    let found = to_text(&hashes);
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        std::fs::write(&path, &found).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == expected, "pictures differ from hashes.txt:\n{}", changes(&expected, &found));
}
