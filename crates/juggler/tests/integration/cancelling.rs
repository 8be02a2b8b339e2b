//! Cancelled builds: an error in place of a world, nothing that later builds see, and little CPU
//! time after the cancellation.

use juggler::mesh::ply_bytes;
use juggler::prelude::*;
use juggler::render::Control;
use juggler::scene::{Asset, SceneError};
use juggler::shape::MeshData;
use juggler::{BuildControl, BuildStage};
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::time::{Duration, Instant};

/// CPU time that a build may take after its cancellation.
const MOST: Duration = Duration::from_millis(500);

/// Maximum number of the instances.
const MOST_INSTANCES: usize = 1_000_000;

/// Environment variable with the number of triangles of the large meshes, for the deep check.
const TRIANGLES: &str = "JUGGLER_TRIANGLES";
/// Name of the threads that build.
const THREADS: &str = "cancelling";

/// CPU time of the threads that build, in which no other test runs; `None` if the system does not
/// report it.
fn cpu_time() -> Option<Duration> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?.filter_map(Result::ok).map(|task| task.path());
    let builds = |task: &std::path::PathBuf| {
        std::fs::read_to_string(task.join("comm")).is_ok_and(|name| name.starts_with(THREADS))
    };
    let nanoseconds = |task: std::path::PathBuf| {
        std::fs::read_to_string(task.join("schedstat")).ok()?.split_whitespace().next()?.parse::<u64>().ok()
    };
    tasks.filter(builds).map(nanoseconds).sum::<Option<u64>>().map(Duration::from_nanos)
}

/// A bumpy square of 2 · (side − 1)² triangles.
fn bumps(side: u32) -> MeshData {
    let place = |i: u32| 2.0 * i as f32 / (side - 1) as f32 - 1.0;
    let points = (0..side).flat_map(|row| (0..side).map(move |column| (place(column), place(row))));
    let positions = points.map(|(x, z)| vec3(x, 0.05 * (40.0 * x).sin() * (40.0 * z).sin(), z)).collect();
    let cells = (1..side).flat_map(|row| (1..side).map(move |column| (row, column)));
    let triangles = cells.flat_map(|(row, column)| {
        let corner = |row: u32, column: u32| row * side + column;
        let [a, b] = [corner(row - 1, column - 1), corner(row - 1, column)];
        let [c, d] = [corner(row, column - 1), corner(row, column)];
        [[a, c, d], [a, d, b]]
    });
    MeshData { positions, triangles: triangles.collect(), ..MeshData::default() }
}

/// Scenes that take long to build: a mesh in memory, as an asset, in a file, with smoothed creases, and
/// many instances.
fn scenes(side: u32) -> Vec<(&'static str, Scene)> {
    let arrays = std::sync::Arc::new(bumps(side));
    let mesh = || Mesh::from(std::sync::Arc::clone(&arrays));
    let plain = || Scene::new().size(32, 18).samples(1);
    let mut smooth = mesh();
    smooth.crease_angle_degrees = Some(30.0);
    let places = arrays.positions.iter().take(MOST_INSTANCES);
    let matrices = places.map(|at| [1.0, 0.0, 0.0, at.x, 0.0, 1.0, 0.0, at.y, 0.0, 0.0, 1.0, at.z]);
    let spheres = Object::new(Sphere { radius: 1e-4 }).instances(Instances::from_matrices(matrices));
    vec![
        ("mesh", plain().add(Object::new(mesh()))),
        ("asset", plain().asset("m.ply", Asset::from_mesh(arrays.clone())).add(Object::new(Mesh::from_file("m.ply")))),
        (
            "file",
            plain().asset("m.ply", Asset::from_bytes(ply_bytes(&arrays))).add(Object::new(Mesh::from_file("m.ply"))),
        ),
        ("creases", plain().add(Object::new(smooth))),
        ("instances", plain().add(spheres)),
    ]
}

/// Builds a scene on threads of a pool and cancels the build after a time. Returns the result and the
/// CPU time that passed after the cancellation.
fn cancelled_after(pool: &ThreadPool, scene: &Scene, delay: Duration) -> (Result<Picture, Error>, Duration) {
    let control = Control::default();
    std::thread::scope(|scope| {
        let cancel = scope.spawn(|| {
            std::thread::sleep(delay);
            control.cancel();
            cpu_time()
        });
        let result = pool.install(|| Picture::new_with_control(scene, &Settings::default(), control.build()));
        let (end, start) = (cpu_time(), cancel.join().unwrap());
        (result, end.zip(start).map_or(Duration::ZERO, |(end, start)| end.saturating_sub(start)))
    })
}

/// Cancels builds of a scene at times spread over the whole build, then builds it, which gives the
/// picture that it has without these attempts.
fn check_cancellation(name: &str, scene: &Scene, fresh: &Scene, attempts: u32) {
    let pool = ThreadPoolBuilder::new().num_threads(2).thread_name(|_| THREADS.into()).build().unwrap();
    let start = Instant::now();
    let expected = pool.install(|| Picture::new(fresh, &Settings::default())).unwrap();
    let (whole, hash) = (start.elapsed(), hash(&expected));
    drop(expected);
    let (mut cancelled, mut longest) = (0, Duration::ZERO);
    for attempt in 0..attempts {
        // A mesh in memory keeps its hierarchy once it is complete.
        let (result, after) = cancelled_after(&pool, scene, whole.mul_f64(f64::from(attempt) / f64::from(attempts)));
        match result {
            Err(Error::Cancelled(_)) => (cancelled, longest) = (cancelled + 1, longest.max(after)),
            Err(error) => panic!("{name}: {error}"),
            Ok(_) => break,
        }
    }
    println!("{name}: {cancelled} of {attempts} builds of {whole:.1?} cancelled, at most {longest:.2?} CPU after it");
    assert!(cancelled > 0 && longest <= MOST, "{name}: {cancelled} cancelled, at most {longest:?}");
    assert_eq!(self::hash(&Picture::new(scene, &Settings::default()).unwrap()), hash, "{name}");
}

fn hash(picture: &Picture) -> String {
    picture.render(Default::default(), &Control::default(), |_| Ok::<(), Error>(())).unwrap().hash
}

/// In the check 80,000 triangles; in the deep check `JUGGLER_TRIANGLES`.
#[test]
fn cancelled_builds_end_soon_and_leave_nothing_behind() {
    let triangles = std::env::var(TRIANGLES).ok().and_then(|count| count.replace('_', "").parse::<f64>().ok());
    let side = triangles.map_or(201, |count| (count / 2.0).sqrt().ceil() as u32 + 1);
    for number in 0..scenes(2).len() {
        let ((name, scene), (_, fresh)) = (scenes(side).swap_remove(number), scenes(side).swap_remove(number));
        check_cancellation(name, &scene, &fresh, if triangles.is_some() { 24 } else { 8 });
    }
}

#[test]
fn a_control_that_is_cancelled_ends_all_work_at_once() {
    let control = BuildControl::default();
    control.cancel();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a.obj");
    std::fs::write(&file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    let loader = juggler::loader();
    let text = r#"{"version": 1, "objects": [{"shape": "spere"}]}"#;
    let results = [
        loader.load_with_control(&file, &control),
        loader.load_with_control("../../scenes/models/robot.glb", &control),
        loader.named_with_control(file.to_str().unwrap(), &control),
        // A wrong scene is not reported, since not all of it was checked.
        loader.from_json_with_control(text, "a.json", [], &control),
    ];
    for result in results {
        assert!(matches!(result, Err(SceneError::Cancelled(_))), "{result:?}");
    }
    let scene = Scene::new().size(8, 8).add(Object::new(Sphere::default()));
    let settings = Settings::default();
    let built = Picture::new(&scene, &settings).unwrap();
    let again = built.rebuild_with_control(&scene, &scene, &settings, &control);
    assert!(matches!(again, Err(Error::Cancelled(_))));
    assert!(matches!(Picture::new_with_control(&scene, &settings, &control), Err(Error::Cancelled(_))));
}

#[test]
fn builds_report_their_stage_and_share() {
    let control = BuildControl::default();
    let (_, scene) = scenes(100).remove(0);
    Picture::new_with_control(&scene, &Settings::default(), &control).unwrap();
    assert_eq!(control.stage(), BuildStage::Building);
    // A mesh of its own is no part of the hierarchy of the world.
    let spheres = (0..100u8).map(|i| Object::new(Sphere::default()).at(f32::from(i) * 3.0, 0.0, 0.0));
    let scene = spheres.fold(Scene::new().size(8, 8), Scene::add);
    Picture::new_with_control(&scene, &Settings::default(), &control).unwrap();
    assert_eq!((control.stage(), control.share()), (BuildStage::Building, 1.0));
}
