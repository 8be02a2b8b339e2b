//! Transparent pictures and shadow catchers: known answers by opaque pictures.

use juggler::camera::film::Rect;
use juggler::film::{Merge, MergeGoal, PartialRender};
use juggler::math::{Image, Rgb};
use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Aov, Denoiser, Picture, RenderOrigin, RenderedImage, Settings};

const SIZE: [u32; 2] = [48, 32];

/// A diffuse ball out of focus, a rough glass ball, a half transparent card that moves, and a mirror.
fn scene(background: &str, render: &str) -> Scene {
    let text = format!(
        r#"{{
        "version": 1, "animation": {{"frames": 2}},
        "render": {{"size": [48, 32], "samples": 32, "shutter": [0, 0.5], "integrator": {{"path": {{"max_depth": 16}}}} {render}}},
        "camera": {{"thin_lens": {{"eye": [0, 1, 6], "look_at": [0, 0.6, 0], "lens_radius": 0.1, "focus_distance": 6}}}},
        "background": {background},
        "objects": [
            {{"shape": {{"sphere": {{"radius": 0.6}}}}, "transform": {{"translate": [-1.6, 0.6, 1]}}, "material": {{"diffuse": {{"reflectance": [0.8, 0.3, 0.2]}}}}}},
            {{"shape": {{"sphere": {{"radius": 0.6}}}}, "transform": {{"translate": [0, 0.6, 0]}}, "material": {{"dielectric": {{"roughness": 0.2}}}}}},
            {{"shape": {{"rectangle": {{"size": [1, 1]}}}}, "transform": [{{"rotate": {{"axis": [1, 0, 0], "degrees": 90}}}}, {{"translate": ["=1.4 + 0.3 * frame", 0.6, 0]}}],
              "material": {{"mask": {{"opacity": 0.5, "material": {{"diffuse": {{}}}}}}}}}},
            {{"shape": {{"sphere": {{"radius": 0.3}}}}, "transform": {{"translate": [0.7, 0.3, 2]}}, "material": {{"conductor": {{"metal": "silver"}}}}}}
        ]
    }}"#
    );
    Scene::from_json(&text, "test").unwrap()
}

fn rendered(scene: &Scene, settings: &Settings) -> RenderedImage {
    Picture::new(scene, settings).unwrap().render_in_memory(None, &Control::default()).unwrap()
}

fn transparent() -> Settings {
    Settings { transparent: Some(true), ..Settings::default() }
}

/// The picture over a background of one color.
fn over(image: &RenderedImage, color: Rgb) -> Vec<Rgb> {
    let alpha = image.alpha().unwrap();
    image.pixels().iter().zip(alpha).map(|(pixel, alpha)| *pixel + color * (1.0 - alpha)).collect()
}

fn largest_difference(a: &[Rgb], b: &[Rgb]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (*a - *b).map(f32::abs).max_channel()).fold(0.0, f32::max)
}

/// Glass, masks, motion and blur: over any gray, a transparent picture is the picture in front of it.
#[test]
fn a_transparent_picture_over_a_color_is_the_picture_in_front_of_it() {
    for integrator in ["path", "direct", "classic"] {
        let kind = Settings { integrator: Some(juggler::by_name("integrator", integrator).unwrap()), ..transparent() };
        let image = rendered(&scene(r#"{"studio": {"scale": 0.7}}"#, ""), &kind);
        for level in [0.0, 0.3, 2.0] {
            let visible = scene(&format!(r#"{{"studio": {{"scale": 0.7, "visible_as": {level}}}}}"#), "");
            let expected = rendered(&visible, &Settings { transparent: None, ..kind.clone() });
            assert!(expected.alpha().is_none());
            let difference = largest_difference(&over(&image, Rgb::splat(level)), expected.pixels());
            assert!(difference < 2e-5 * (1.0 + level), "{integrator}, {level}: {difference}");
        }
    }
}

#[test]
fn alpha_is_exact_where_all_samples_agree() {
    for filter in ["box", "mitchell", "gaussian"] {
        let image =
            rendered(&scene("0.5", &format!(r#", "transparent": true, "filter": "{filter}""#)), &Settings::default());
        let alpha = image.alpha().unwrap();
        let pixel = |x: u32, y: u32| alpha[(y * SIZE[0] + x) as usize];
        assert_eq!((pixel(0, 0), pixel(47, 31)), (0.0, 0.0), "{filter}");
        assert_eq!(image.pixels()[0], Rgb::BLACK);
        assert_eq!(pixel(11, 17), 1.0, "{filter}: the diffuse ball");
        let glass = pixel(24, 16);
        assert!(glass > 0.02 && glass < 0.5, "{filter}: {glass}");
        assert!(alpha.iter().any(|alpha| (0.3..0.7).contains(alpha)), "{filter}");
    }
}

#[test]
fn the_hash_and_alpha_do_not_depend_on_shards() {
    let scene = scene(r#"{"studio": {}}"#, "");
    let picture = Picture::new(&scene, &Settings { denoiser: Some(Denoiser::Own), ..transparent() }).unwrap();
    let whole = picture.render_in_memory(None, &Control::default()).unwrap();
    let shards = (0..3).map(|index| {
        let bytes = picture.render_shard([index, 3], &RenderOrigin::default(), &Control::default()).unwrap();
        PartialRender::from_bytes(&format!("shard {index}"), bytes).unwrap()
    });
    let merge = Merge::new(shards.collect(), MergeGoal::Whole).unwrap();
    let merged = RenderedImage::from_partial_renders(&merge, None, &Control::default()).unwrap();
    assert_eq!(merged.stats().film.hash, whole.stats().film.hash);
    assert_eq!((merged.alpha(), merged.pixels()), (whole.alpha(), whole.pixels()));
    assert!(merged.header.transparent);
    // The denoiser leaves the empty corner black.
    assert_eq!((whole.pixels()[0], whole.alpha().unwrap()[0]), (Rgb::BLACK, 0.0));
    let opaque = Picture::new(&scene, &Settings::default()).unwrap();
    assert_ne!(opaque.fingerprint(), picture.fingerprint());
}

#[test]
fn a_crop_has_the_alpha_of_the_whole() {
    let scene = scene(r#"{"studio": {}}"#, "");
    let whole = rendered(&scene, &transparent());
    let crop = Rect { x: 7, y: 5, width: 20, height: 13 };
    let part = rendered(&scene, &Settings { crop: Some(crop), ..transparent() });
    for y in 0..crop.height {
        for x in 0..crop.width {
            let (own, other) = (y * crop.width + x, (y + crop.y) * SIZE[0] + x + crop.x);
            assert_eq!(part.alpha().unwrap()[own as usize], whole.alpha().unwrap()[other as usize], "{x} {y}");
        }
    }
}

/// A ball on a floor with two lights, one of them an emitting sphere, under a studio.
fn floor([catcher, balls]: [bool; 2]) -> Scene {
    let text = format!(
        r#"{{
        "version": 1,
        "render": {{"size": [48, 32], "samples": 64, "integrator": {{"path": {{}}}}, "filter": "box"}},
        "camera": {{"perspective": {{"eye": [0, 2, 6], "look_at": [0, 0.3, 0]}}}},
        "background": {{"studio": {{"scale": 0.5}}}},
        "lights": [{{"point": {{"position": [2, 4, 2], "intensity": 20}}}}],
        "objects": [
            {{"shape": {{"rectangle": {{"size": [30, 30]}}}}, "material": {{"diffuse": {{"reflectance": 0.6}}}} {}}},
            {{"shape": {{"sphere": {{"radius": 0.3}}}}, "transform": {{"translate": [-2, 1.5, 0]}}, "material": {{"emissive": {{"radiance": 8}}}}}}
            {}
        ]
    }}"#,
        if catcher { r#", "shadow_catcher": true"# } else { "" },
        if balls {
            r#", {"shape": "sphere", "transform": {"translate": [0, 1, 0]}, "material": {"diffuse": {"reflectance": [0.2, 0.3, 0.8]}}},
               {"shape": {"sphere": {"radius": 0.5}}, "transform": {"translate": [2, 0.5, 1]}, "material": {"conductor": {"metal": "gold"}}}"#
        } else {
            ""
        }
    );
    Scene::from_json(&text, "test").unwrap()
}

/// Both radiances of a shadow catcher are those of pictures with and without the other objects.
#[test]
fn a_shadow_catcher_shows_the_light_that_it_loses() {
    let caught = rendered(&floor([true, true]), &Settings { aovs: vec![Aov::Alpha], ..transparent() });
    let covered = caught.layers().next().unwrap().1[0].clone();
    let [with, without] = [true, false].map(|ball| rendered(&floor([false, ball]), &Settings::default()).into_image());
    let (alpha, mut compared, mut dark) = (caught.alpha().unwrap(), 0, 0);
    let luminance = |image: &Image, at: usize| image.pixels()[at].luminance();
    // Above, opaque pictures show the background, too.
    for at in 10 * SIZE[0] as usize..alpha.len() {
        if covered[at] != 0.0 {
            continue;
        }
        assert_eq!(caught.pixels()[at], Rgb::BLACK);
        let expected = (1.0 - luminance(&with, at) / luminance(&without, at)).clamp(0.0, 1.0);
        assert!((alpha[at] - expected).abs() < 1e-4, "pixel {at}: {} instead of {expected}", alpha[at]);
        compared += 1;
        dark += usize::from(expected > 0.2);
    }
    assert!(compared > 500 && dark > 50, "{compared} {dark}");
}

#[test]
fn the_denoiser_smooths_shadows_and_keeps_outlines() {
    let scene = floor([true, true]);
    let alpha = |samples: u32, denoiser: Option<Denoiser>| {
        let settings = Settings { samples: Some(samples), denoiser, ..transparent() };
        rendered(&scene, &settings).alpha().unwrap().to_vec()
    };
    let (reference, noisy, denoised) = (alpha(2048, None), alpha(8, None), alpha(8, Some(Denoiser::Own)));
    let is_shadow = |i: usize| reference[i] > 0.02 && reference[i] < 0.9;
    let shadow: Vec<usize> = (0..reference.len()).filter(|i| is_shadow(*i)).collect();
    let error = |alpha: &[f32]| shadow.iter().map(|i| (alpha[*i] - reference[*i]).powi(2)).sum::<f32>();
    let (before, after) = (error(&noisy), error(&denoised));
    assert!(shadow.len() > 50 && after < 0.65 * before, "{} pixels: {before} {after}", shadow.len());
    // Pixels above the floor, also at the outlines of objects, and one of a ball.
    let settings = Settings { samples: Some(8), denoiser: Some(Denoiser::Own), ..transparent() };
    let (picture, control) = (Picture::new(&scene, &settings).unwrap(), Control::default());
    let film = picture.film();
    picture.render_to_limit(&film, &control).unwrap();
    let (noisy, above) = (picture.alpha(&film).unwrap(), 6 * SIZE[0] as usize);
    let denoised = picture.develop_in_memory(&film, Default::default(), None, &control).unwrap();
    let denoised = denoised.alpha().unwrap();
    assert_eq!(denoised[..above], noisy[..above]);
    assert_eq!(denoised[11 * SIZE[0] as usize + 24], 1.0);
    assert!(noisy[..above].iter().any(|alpha| *alpha > 0.0 && *alpha < 1.0));
}

#[test]
fn a_shadow_catcher_alone_is_invisible() {
    let image = rendered(&floor([true, false]), &transparent());
    let visible = image.alpha().unwrap().iter().filter(|alpha| **alpha > 0.0).count();
    let emitting = image.pixels().iter().filter(|pixel| **pixel != Rgb::BLACK).count();
    assert!(visible > 0 && visible == emitting, "{visible} {emitting}: the emitting ball alone");
    // In an opaque picture, the floor is a surface as others.
    let opaque = Picture::new(&floor([true, true]), &Settings::default()).unwrap();
    let warnings = opaque.compiled().warnings.to_string();
    assert!(warnings.contains("`shadow_catcher` has no effect: the picture is opaque"), "{warnings}");
    let opaque = opaque.render_in_memory(None, &Control::default()).unwrap();
    let plain = rendered(&floor([false, true]), &Settings::default());
    assert_eq!(opaque.pixels(), plain.pixels());
}

#[test]
fn shadow_catchers_follow_edits() {
    let scene = floor([true, true]);
    let picture = Picture::new(&scene, &transparent()).unwrap();
    let red = serde_json::json!({"diffuse": {"reflectance": [0.9, 0.1, 0.1]}});
    for (path, value) in [
        ("/objects/0/material", red),
        ("/render/transparent", serde_json::json!(false)),
        ("/objects/2/transform", serde_json::json!({"translate": [0, 2, 0]})),
        ("/background", serde_json::json!({"studio": {"scale": 2}})),
    ] {
        let edited = scene.with_value(path, value).unwrap();
        let settings = Settings::default();
        for settings in [settings, transparent()] {
            let rebuilt = picture.rebuild(&scene, &edited, &settings).unwrap();
            let fresh = Picture::new(&edited, &settings).unwrap();
            let [a, b] = [rebuilt, fresh].map(|picture| picture.render_in_memory(None, &Control::default()).unwrap());
            assert_eq!(a.stats().film.hash, b.stats().film.hash, "{path}");
        }
    }
}
