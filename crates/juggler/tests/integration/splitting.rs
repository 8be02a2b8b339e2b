//! Several camera rays for each sample, by default: the number depends on the scene and the frame
//! alone, and pixels stay the same on any threads, in crops, shards and extensions.

use juggler::film::shard::Work;
use juggler::render::Control;
use juggler::{Picture, Settings};
use juggler_camera::film::{Film, Rect};
use juggler_scene::Scene;

const CROP: Rect = Rect { x: 130, y: 60, width: 40, height: 36 };
const SAMPLES: u32 = 18;
/// Number of camera rays that the scene of emitters gets.
const CHOSEN: u32 = 8;

/// A wall with rows of small bright emitters before it.
fn emitters(integrator: &str) -> Scene {
    let emitter = |i: i32| {
        let (x, y) = (f64::from(i % 6) * 0.5 - 1.25, f64::from(i / 6) * 0.5 + 0.3);
        format!(
            r#"{{"shape": {{"sphere": {{"radius": 0.1}}}}, "transform": [{{"translate": [{x}, {y}, 0]}}],
              "material": {{"emissive": {{"radiance": [4, 3, 2]}}}}}},"#
        )
    };
    let text = format!(
        r#"{{"version": 1, "render": {{"size": [320, 180], "integrator": {integrator}}},
        "camera": {{"perspective": {{"eye": [0, 1, 4], "look_at": [0, 0.8, 0], "vertical_fov_degrees": 32}}}},
        "objects": [{}
            {{"shape": "plane", "transform": [{{"rotate": {{"axis": [1, 0, 0], "degrees": 90}}}}, {{"translate": [0, 0, -6]}}],
              "material": {{"diffuse": {{"reflectance": 0.4}}}}}}]}}"#,
        (0..18).map(emitter).collect::<String>()
    );
    Scene::from_json(text, "emitters.json").unwrap()
}

fn picture(scene: &Scene, settings: Settings) -> Picture {
    let crop = settings.crop.or(Some(CROP));
    Picture::new(scene, &Settings { samples: settings.samples.or(Some(SAMPLES)), crop, ..settings }).unwrap()
}

fn count(picture: &Picture) -> u32 {
    let job = picture.job();
    job.camera_rays.count(&job, &Control::default()).unwrap()
}

/// Hash of a picture, rendered into `film` on a number of threads; also counts camera rays.
fn hash(picture: &Picture, film: &Film, threads: usize) -> (String, u64) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let control = Control::default();
    pool.install(|| picture.render_film(film, &control)).unwrap();
    (picture.develop(film, |_| Ok::<(), ()>(())).unwrap().hash, control.rays().camera)
}

#[test]
fn visible_emitters_get_several_camera_rays() {
    let scene = emitters(r#"{"path": {"max_depth": 2}}"#);
    let chosen = count(&picture(&scene, Settings::default()));
    assert_eq!(chosen, CHOSEN);
    // The number does not depend on crops, samples, seeds and AOVs.
    let crop = Some(Rect { x: 0, y: 0, width: 1, height: 1 });
    for settings in [
        Settings { samples: Some(2), ..Settings::default() },
        Settings { seed: Some(9), ..Settings::default() },
        Settings { crop, ..Settings::default() },
        Settings { aovs: vec![juggler::Aov::Albedo], ..Settings::default() },
    ] {
        assert_eq!(count(&picture(&scene, settings)), chosen);
    }
    // Small, transparent and single-sample pictures have one, unless the scene demands more.
    let size = |size| Settings {
        size: Some(size),
        crop: Some(Rect { x: 0, y: 0, width: 9, height: 9 }),
        ..Settings::default()
    };
    let transparent = Settings { transparent: Some(true), ..Settings::default() };
    let single = Settings { samples: Some(1), ..Settings::default() };
    for settings in [size([319, 180]), size([64, 36]), transparent.clone(), single.clone()] {
        assert_eq!(count(&picture(&scene, settings)), 1);
    }
    let demanding = emitters(r#"{"path": {"camera_rays": 3}}"#);
    for settings in [size([64, 36]), transparent, Settings::default()] {
        assert_eq!(count(&picture(&demanding, settings)), 3);
    }
    assert_eq!(count(&picture(&demanding, single)), 1);
    // Without emitters in sight, additional rays would cost time alone.
    assert_eq!(count(&picture(&emitters(r#""classic""#), Settings::default())), 1);
}

#[test]
fn pixels_do_not_depend_on_threads_crops_and_extensions() {
    let scene = emitters(r#"{"path": {"max_depth": 2}}"#);
    let whole = picture(&scene, Settings::default());
    let (expected, rays) = hash(&whole, &whole.film(), 3);
    assert_eq!(rays, u64::from(CHOSEN) * whole.total_samples());
    // Another picture of the same scene, on one thread.
    let again = picture(&scene, Settings::default());
    assert_eq!(hash(&again, &again.film(), 1).0, expected);
    // A part of the crop.
    let inner = Rect { x: 140, y: 66, width: 20, height: 9 };
    let part = picture(&scene, Settings { crop: Some(inner), ..Settings::default() });
    let (all, part) =
        (whole.render_image(&Control::default()).unwrap(), part.render_image(&Control::default()).unwrap());
    for (x, y) in (0..inner.height).flat_map(|y| (0..inner.width).map(move |x| (x, y))) {
        let of_all = all.pixel(x + inner.x - CROP.x, y + inner.y - CROP.y);
        assert!(part.pixel(x, y).is_some() && part.pixel(x, y) == of_all, "{x}, {y}");
    }
    // Five samples, continued to all.
    let film = whole.film();
    let few = picture(&scene, Settings { samples: Some(5), ..Settings::default() });
    let prefix = few.film();
    few.render_film(&prefix, &Control::default()).unwrap();
    prefix.tiles().for_each(|(number, tile)| assert_eq!(film.add(number, tile), Ok(true)));
    assert_eq!(hash(&whole, &film, 2).0, expected);
}

#[test]
fn shards_together_are_the_picture() {
    let scene = emitters(r#"{"path": {"max_depth": 2}}"#);
    let whole = picture(&scene, Settings::default());
    let expected = hash(&whole, &whole.film(), 2).0;
    let work = Work { tiling: whole.tiling(), crop: None, samples: 0..whole.samples(), stop: whole.stop() };
    // Few shards have whole tiles, many have some samples of tiles.
    for count in [3, 20] {
        let merged = whole.film();
        for index in 0..count {
            // Each shard chooses the number of camera rays by itself.
            let shard = picture(&scene, Settings::default());
            let units = work.shard(index, count).into_iter().map(|unit| (unit.tile, unit.samples));
            let film = Film::from_tiles(whole.tiling(), units);
            shard.render_film(&film, &Control::default()).unwrap();
            film.tiles().for_each(|(number, tile)| assert_eq!(merged.add(number, tile), Ok(true)));
        }
        assert_eq!(hash(&whole, &merged, 1), (expected.clone(), 0), "{count} shards");
    }
}
