//! Rendered images in memory equal those that are rendered to files and merged.

use juggler::film::shard::Work;
use juggler::film::{Chunk, Merge, MergeGoal, PartialRender, PartialRenderWriter, ShardDescription};
use juggler::imaging::Options;
use juggler::prelude::*;
use juggler::{RenderOrigin, RenderedImage};
use juggler_camera::film::Film;
use std::fs;

fn scene() -> Scene {
    Scene::new()
        .size(40, 24)
        .samples(32)
        .background([0.3, 0.4, 0.5])
        .camera("main", Perspective::new([0.0, 1.0, 5.0], [0.0, 1.0, 0.0]))
        .add(Object::new(Plane::default()).named("floor"))
        .add(Object::new(Sphere::new(1.0)).named("ball").at(0.0, 1.0, 0.0).material(Conductor::new(0.9)))
}

fn picture(settings: &Settings) -> Picture {
    Picture::new(&scene(), settings).unwrap()
}

fn rendered(settings: &Settings) -> RenderedImage {
    picture(settings).render_in_memory(None, &Control::default()).unwrap()
}

fn with_aovs() -> Settings {
    Settings { aovs: vec![Aov::Albedo, Aov::Depth, Aov::ObjectId], ..Settings::default() }
}

/// The bytes of two files of this extension: saved from memory, and written by `render_to_file`.
fn files(settings: &Settings, extension: &str) -> [Vec<u8>; 2] {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["a", "b"].map(|name| folder.path().join(format!("{name}.{extension}")));
    rendered(settings).save(&a).unwrap();
    juggler::render_to_file(&scene(), settings, &b).unwrap();
    [a, b].map(|path| fs::read(path).unwrap())
}

#[test]
fn an_image_in_memory_is_that_of_the_file() {
    let image = rendered(&Settings::default());
    let plain = juggler::render(&scene(), &Settings::default()).unwrap();
    assert_eq!((image.size(), image.pixels()), ([40, 24], plain.pixels()));
    for extension in ["png", "exr", "jpg", "hdr", "pfm"] {
        let [memory, file] = files(&Settings::default(), extension);
        assert!(memory == file, "{extension}");
    }
}

#[test]
fn layers_are_the_aovs_with_their_channels() {
    let settings = with_aovs();
    let image = rendered(&settings);
    let layers: Vec<_> = image.layers().map(|(layer, channels)| (layer.name, channels.len())).collect();
    assert_eq!(layers, [("albedo".into(), 3), ("depth".into(), 1), ("object_id".into(), 1)]);
    assert!(image.layers().all(|(_, channels)| channels.iter().all(|channel| channel.len() == 40 * 24)));
    // The ball is the second object, 4 units in front of the camera at the middle of the picture.
    let middle = 12 * 40 + 20;
    let [depth, id] = [1, 2].map(|layer| image.layers().nth(layer).unwrap().1[0][middle]);
    assert!((depth - 4.0).abs() < 0.05 && id == 2.0, "{depth} {id}");
    assert_eq!(image.pixels(), rendered(&Settings::default()).pixels());
    let [memory, file] = files(&settings, "exr");
    assert!(memory == file && memory.len() > files(&Settings::default(), "exr")[0].len());
}

#[test]
fn limits_state_their_samples() {
    let noise = Settings { limit: Limit::Noise(0.2), samples: Some(256), ..Settings::default() };
    let image = rendered(&noise);
    let text = |key: &str| image.header.metadata.iter().find(|(known, _)| known == key).map(|(_, text)| text.clone());
    assert_eq!(text("Samples"), Some(image.stats().samples.to_string()));
    // The first render ends at its samples, the second after its time, perhaps before any sample.
    for (seconds, samples) in [(1e9, 4), (0.01, 1 << 20)] {
        let time = Settings { limit: Limit::Time { seconds }, samples: Some(samples), ..Settings::default() };
        let image = rendered(&time);
        assert!(image.stats().samples.max <= samples && (samples > 4 || image.stats().samples.min == samples));
        assert!(image.header.metadata.iter().any(|(key, _)| key == juggler::SAMPLES_PER_TILE));
    }
}

/// The shards of a picture, in memory.
fn shards(picture: &Picture, count: u32) -> Vec<PartialRender> {
    let shard = |index: u32| {
        let work = Work { tiling: picture.tiling(), crop: None, samples: 0..picture.samples(), stop: picture.stop() };
        let units = work.shard(index, count).into_iter().map(|unit| (unit.tile, unit.samples));
        let film = Film::from_tiles(picture.tiling(), units);
        picture.render_film(&film, &Control::default()).unwrap();
        let shard = ShardDescription { index, count, ..ShardDescription::whole(picture.samples()) };
        let header = picture.header(Options::default());
        let mut description = picture.description(&RenderOrigin::default(), &header, shard);
        description.finished = true;
        let mut writer = PartialRenderWriter::in_memory("shard", &description).unwrap();
        for (number, tile) in film.tiles() {
            writer.add(number, &Chunk::encode(&tile, description.clamped)).unwrap();
        }
        PartialRender::from_bytes("shard", writer.into_bytes().unwrap()).unwrap()
    };
    (0..count).map(shard).collect()
}

#[test]
fn merged_shards_are_the_image() {
    let denoised = Settings { denoiser: Some(Denoiser::Own), ..with_aovs() };
    for settings in [Settings::default(), with_aovs(), denoised] {
        let (picture, whole) = (picture(&settings), rendered(&settings));
        let merge = Merge::new(shards(&picture, 3), MergeGoal::Whole).unwrap();
        let merged = RenderedImage::from_partial_renders(&merge, None, &Control::default()).unwrap();
        assert_eq!(merged.stats().film.hash, whole.stats().film.hash);
        assert_eq!(merged.pixels(), whole.pixels());
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a.exr", "b.exr"].map(|name| folder.path().join(name));
        merged.save(&a).unwrap();
        whole.save(&b).unwrap();
        assert!(fs::read(a).unwrap() == fs::read(b).unwrap());
    }
}

#[test]
fn a_cancelled_render_gives_no_image() {
    for settings in [Settings::default(), with_aovs(), Settings { denoiser: Some(Denoiser::Own), ..with_aovs() }] {
        let control = Control::default();
        control.cancel();
        let result = picture(&settings).render_in_memory(None, &control);
        assert!(matches!(result, Err(Error::Cancelled(_))));
    }
}

/// A call that renders at once heeds limits and denoiser, and refuses what cannot end.
#[test]
fn one_call_heeds_all_settings() {
    let noise = Settings { limit: Limit::Noise(0.05), samples: Some(256), ..Settings::default() };
    for settings in [noise, Settings { denoiser: Some(Denoiser::Own), ..Settings::default() }] {
        let image = juggler::render(&scene(), &settings).unwrap();
        assert_eq!(image.pixels(), rendered(&settings).pixels());
        assert_ne!(image.pixels(), rendered(&Settings::default()).pixels());
    }
    let limits = [-1.0, f64::NAN, f64::INFINITY].map(|seconds| Limit::Time { seconds });
    for limit in limits.into_iter().chain([0.0, -1.0, f32::NAN].map(Limit::Noise)) {
        let result = juggler::render(&scene(), &Settings { limit, ..Settings::default() });
        assert!(matches!(result, Err(Error::Settings { .. })), "{limit:?}");
    }
    let nowhere = juggler::render_to_file(&scene(), &with_aovs(), "no such folder/a.exr");
    assert!(matches!(nowhere, Err(Error::Image(_))));
}
