//! AOVs: known values, and sums that must agree.

use juggler::math::Rgb;
use juggler::render::Control;
use juggler::scene::Scene;
use juggler::{Aov, Denoiser, Picture, Settings};
use std::collections::BTreeMap;

const SIZE: u32 = 32;
const SAMPLES: u32 = 256;

/// A white wall at z = 0 seen from z = 4, its left half covered by a red card at z = 1; lights to
/// the left and to the right, a mirror sphere and an emitting sphere.
const SCENE: &str = r#"{
    "version": 1,
    "render": {"size": [32, 32], "samples": 256, "integrator": {"path": {"max_depth": 4}}, "filter": "box"},
    "camera": {"orthographic": {"eye": [0, 0, 4], "look_at": [0, 0, 0], "height": 2}},
    "background": [0.1, 0.2, 0.3], "background_light_group": "sky",
    "materials": {"white": {"diffuse": {"reflectance": 0.8}}, "red": {"diffuse": {"reflectance": [0.9, 0.1, 0.1]}}},
    "lights": [
        {"point": {"position": [-3, 0, 3], "intensity": 6, "light_group": "key"}},
        {"point": {"position": [3, 0, 3], "intensity": 4, "color": [0.5, 0.5, 1]}}
    ],
    "objects": [
        {"name": "wall", "shape": {"rectangle": {"size": [1.5, 1.5]}}, "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}], "material": "white"},
        {"name": "card", "shape": {"rectangle": {"size": [0.53, 1.5]}},
            "transform": [{"rotate": {"axis": [1, 0, 0], "degrees": 90}}, {"translate": [-0.485, 0, 1]}], "material": "red"},
        {"name": "hidden", "visible": false, "shape": "sphere"},
        {"name": "emitter", "shape": {"sphere": {"radius": 0.2}}, "transform": [{"translate": [0.5, 0.4, 0.5]}],
            "material": {"emissive": {"radiance": [3, 2, 1]}}, "light_group": "key"},
        {"shape": {"sphere": {"radius": 0.2}}, "transform": [{"translate": [0.5, -0.4, 0.5]}], "material": {"conductor": {"roughness": 0}}}
    ]
}"#;

/// Returns the channels by name, and the rendered image.
fn layers(scene: &str, aovs: &[Aov]) -> (BTreeMap<String, Vec<f32>>, Vec<Rgb>) {
    let scene = Scene::from_json(scene, "test").unwrap();
    let picture = Picture::new(&scene, &Settings { aovs: aovs.to_vec(), ..Settings::default() }).unwrap();
    let film = picture.film();
    picture.render_film(&film, &Control::default()).unwrap();
    let mut rows = Vec::new();
    picture
        .develop(&film, |band| {
            rows.extend_from_slice(band.colors);
            Ok::<(), ()>(())
        })
        .unwrap();
    let set = picture.aovs();
    let tiles: Vec<_> = (0..film.tiling().tile_count()).filter_map(|number| film.copy_of_tile(number)).collect();
    let names = set.headers().into_iter().flat_map(|layer| layer.channels);
    (names.zip(set.band_values(&picture.region(), &tiles, None)).collect(), rows)
}

/// Returns the pixel at these coordinates of the scene's plane.
fn at(x: f32, y: f32) -> usize {
    let place = |v: f32| ((v + 1.0) / 2.0 * SIZE as f32) as usize;
    place(-y) * SIZE as usize + place(x)
}

#[test]
fn geometry_aovs_match_the_scene() {
    let requested = [Aov::Alpha, Aov::Albedo, Aov::Normal, Aov::Depth, Aov::Position, Aov::Samples, Aov::NotFinite];
    let (found, _) = layers(SCENE, &requested);
    let value = |channel: &str, pixel: usize| found[channel][pixel];
    let (card, wall, outside) = (at(-0.4, 0.1), at(0.1, 0.05), at(0.9, 0.9));
    for (pixel, depth, albedo) in [(card, 3.0, [0.9, 0.1, 0.1]), (wall, 4.0, [0.8; 3])] {
        assert_eq!(value("alpha.A", pixel), 1.0);
        assert!((value("depth.Z", pixel) - depth).abs() < 1e-5, "{}", value("depth.Z", pixel));
        for (channel, expected) in ["R", "G", "B"].into_iter().zip(albedo) {
            assert!((value(&format!("albedo.{channel}"), pixel) - expected).abs() < 1e-5);
        }
        assert_eq!(["X", "Y", "Z"].map(|axis| value(&format!("normal.{axis}"), pixel).round()), [0.0, 0.0, 1.0]);
        assert!((value("position.Z", pixel) - (4.0 - depth)).abs() < 1e-5);
        assert_eq!((value("samples.Y", pixel), value("not_finite.Y", pixel)), (SAMPLES as f32, 0.0));
    }
    assert_eq!((value("alpha.A", outside), value("depth.Z", outside)), (0.0, f32::INFINITY));
    assert_eq!(value("albedo.R", outside), 0.0);
    // The wall covers 24 of 32 pixels of a row.
    let row: Vec<f32> = (0..32).map(|x| found["alpha.A"][16 * 32 + x]).collect();
    assert!(row[4..28].iter().all(|alpha| *alpha == 1.0) && row[3] == 0.0 && row[28] == 0.0, "{row:?}");
}

#[test]
fn radiance_is_the_sum_of_path_kinds_and_of_light_groups() {
    let (found, picture) = layers(SCENE, &[Aov::Emission, Aov::Direct, Aov::Indirect, Aov::LightGroups]);
    let sums: [&[&str]; 2] =
        [&["emission", "direct", "indirect"], &["light_group_rest", "light_group_key", "light_group_sky"]];
    for layers in sums {
        for (number, channel) in ["R", "G", "B"].into_iter().enumerate() {
            for (pixel, expected) in picture.iter().enumerate() {
                let sum: f32 = layers.iter().map(|layer| found[&format!("{layer}.{channel}")][pixel]).sum();
                let expected = expected.to_array()[number];
                assert!((sum - expected).abs() <= 1e-5 * expected.max(1.0), "{layers:?} {pixel}: {sum} for {expected}");
            }
        }
    }
    // The background is visible, the sphere emits, the wall is lit.
    let value = |layer: &str, pixel: usize| found[&format!("{layer}.R")][pixel];
    assert!((value("emission", at(0.9, 0.9)) - 0.1).abs() < 1e-6 && value("direct", at(0.9, 0.9)) == 0.0);
    assert!((value("emission", at(0.5, 0.4)) - 3.0).abs() < 1e-5 && value("light_group_key", at(0.5, 0.4)) > 2.9);
    assert!(value("emission", at(0.1, 0.0)) == 0.0 && value("direct", at(0.1, 0.0)) > 0.1);
}

#[test]
fn masks_are_the_exact_shares_of_pixels() {
    let (found, _) = layers(SCENE, &[Aov::ObjectId, Aov::MaterialId, Aov::InstanceId, Aov::CryptoObject]);
    let ids = |pixel: usize| found["object_id.Y"][pixel];
    assert_eq!([ids(at(0.1, 0.0)), ids(at(-0.4, 0.0)), ids(at(0.5, 0.4)), ids(at(0.5, -0.4))], [1.0, 2.0, 4.0, 5.0]);
    assert_eq!((ids(at(0.9, 0.9)), found["instance_id.Y"][at(0.5, 0.4)]), (0.0, 3.0));
    // The card ends at x = -0.22: it covers 0.48 of the pixel from -0.25 to -0.1875.
    let pixel = at(-0.22, 0.0);
    let ranks = [("R", "G"), ("B", "A")].map(|(id, share)| {
        (found[&format!("CryptoObject00.{id}")][pixel].to_bits(), found[&format!("CryptoObject00.{share}")][pixel])
    });
    assert!((ranks[0].1 + ranks[1].1 - 1.0).abs() < 1e-6 && ranks[0].1 >= ranks[1].1, "{ranks:?}");
    assert!((ranks[0].1 - 0.52).abs() < 0.01 && (ranks[1].1 - 0.48).abs() < 0.01, "{ranks:?}");
    // MurmurHash3 of "wall" and "card".
    assert_eq!((ranks[0].0, ranks[1].0), (0x7405_f6ae, 0xf160_40d1));
    assert_eq!(found["CryptoObject00.R"][at(0.1, 0.0)].to_bits(), 0x7405_f6ae);
}

#[test]
fn clamped_samples_are_counted() {
    let limits = |limits: &str| {
        let scene = SCENE.replace(r#""max_depth": 4"#, &format!(r#""max_depth": 4 {limits}"#));
        layers(&scene, &[Aov::Clamped, Aov::NotFinite]).0["clamped.Y"].clone()
    };
    let cut = limits(r#", "clamp_direct": 1.5"#);
    // The sphere emits 3, everything else is darker. An infinite limit clamps nothing, one near
    // zero all lit pixels.
    assert_eq!((cut[at(0.5, 0.4)], cut[at(0.9, 0.9)], cut[at(0.1, 0.05)]), (SAMPLES as f32, 0.0, 0.0));
    let edge: Vec<f32> = cut.iter().copied().filter(|count| *count > 0.0 && *count < SAMPLES as f32).collect();
    assert!(edge.len() > 8 && edge.iter().all(|count| count.fract() == 0.0), "{edge:?}");
    assert!(limits("").iter().all(|count| *count == 0.0));
    let all = limits(r#", "clamp_direct": 1e-5, "clamp_indirect": 1e-5"#);
    assert!(all.iter().all(|count| *count > 0.0), "{all:?}");
}

#[test]
fn depth_is_measured_from_the_camera_through_transparent_surfaces() {
    let card = r#""translate": [-0.485, 0, 1]}], "material": "red"}"#;
    let invisible = r#""translate": [-0.485, 0, 1]}], "material": {"mask": {"opacity": 0, "material": "red"}}}"#;
    let scene = SCENE.replace(card, invisible);
    assert!(scene != SCENE);
    let (found, _) = layers(&scene, &[Aov::Depth, Aov::ObjectId]);
    let pixel = at(-0.4, 0.1);
    assert_eq!(found["object_id.Y"][pixel], 1.0);
    assert!((found["depth.Z"][pixel] - 4.0).abs() < 1e-5, "{}", found["depth.Z"][pixel]);
}

#[test]
fn fingerprint_includes_separate_halves() {
    let scene = Scene::from_json(SCENE, "test").unwrap();
    let [plain, own, oidn] = [None, Some(Denoiser::Own), Some(Denoiser::Oidn)].map(|denoiser| {
        let picture = Picture::new(&scene, &Settings { denoiser, ..Settings::default() }).unwrap();
        picture.fingerprint().hash()
    });
    assert_ne!(plain, own, "their samples differ");
    assert_eq!(plain, oidn, "their samples are the same");
}

/// Every integrator fills every AOV: AOVs of the first hit equal those of the path tracer, and AOVs
/// of light paths and light groups sum to the rendered image.
#[test]
fn every_integrator_fills_all_aovs() {
    let moving = SCENE
        .replace(r#""version": 1,"#, r#""version": 1, "animation": {"frames": 9, "frames_per_second": 24},"#)
        .replace(r#""translate": [0.5, 0.4, 0.5]"#, r#""translate": ["=0.5 + frame / 64", 0.4, 0.5]"#);
    let path = r#"{"path": {"max_depth": 4}}"#;
    let light = [Aov::Albedo, Aov::Emission, Aov::Direct, Aov::Indirect, Aov::LightGroups, Aov::Variance];
    let none = [Aov::NotFinite, Aov::Clamped];
    let is_feature = |aov: &Aov| !light.contains(aov) && !none.contains(aov);
    let features: Vec<Aov> = Aov::ALL.into_iter().filter(is_feature).collect();
    let (known, _) = layers(&moving, &features);
    for (channel, values) in &known {
        // Nothing moves upwards, and few pixels show more than two materials.
        let may_be_empty = channel.starts_with("motion") || channel.contains("01.") || channel.contains("02.");
        assert!(may_be_empty || values.iter().any(|value| *value != 0.0), "{channel}");
    }
    assert!(known["motion.X"][at(0.5, 0.4)] > 0.2 && known["motion_back.X"][at(0.5, 0.4)] < -0.2);
    for integrator in ["classic", "path", "direct", "ambient_occlusion", "albedo", "normals", "depth"] {
        let scene = moving.replace(path, &format!("{integrator:?}"));
        let (found, picture) = layers(&scene, &Aov::ALL);
        for (channel, values) in &known {
            assert_eq!(&found[channel], values, "{integrator}, {channel}");
        }
        assert!((found["albedo.R"][at(-0.4, 0.1)] - 0.9).abs() < 1e-5, "{integrator}");
        for (pixel, expected) in picture.iter().enumerate() {
            let paths = ["emission.G", "direct.G", "indirect.G"];
            let groups = ["light_group_rest.G", "light_group_key.G", "light_group_sky.G"];
            for parts in [paths, groups] {
                let sum: f32 = parts.iter().map(|channel| found[*channel][pixel]).sum();
                let near = (sum - expected.g).abs() <= 1e-5 * expected.g.abs();
                assert!(near, "{integrator}, pixel {pixel}, {parts:?}: {sum}, {expected:?}");
            }
        }
        assert!(found["variance.G"].iter().any(|variance| *variance > 0.0), "{integrator}");
        assert!(["not_finite.Y", "clamped.Y"].iter().all(|channel| found[*channel].iter().all(|count| *count == 0.0)));
    }
}

/// The integrator `normals` shows the AOV `normal`: with normal maps, and on the back of a surface.
#[test]
fn normals_integrator_shows_the_normals_of_the_aov() {
    let (white, tilted) = (r#"{"diffuse": {"reflectance": 0.8}}"#, [0.6_f32, 0.0, 0.8]);
    let mapped = format!(r#"{{"normal_map": {{"texture": [0.8, 0.5, 0.9], "material": {white}}}}}"#);
    let card = r#""degrees": 90}}, {"translate": [-0.485, 0, 1]}"#;
    let scene = SCENE.replace(&format!(r#""white": {white}"#), &format!(r#""white": {mapped}"#));
    let scene = scene.replace(card, &card.replace("90", "-90"));
    assert!(scene.contains("normal_map") && scene.contains("-90"));
    let (found, _) = layers(&scene, &[Aov::Normal, Aov::Alpha]);
    let shown = layers(&scene.replace(r#"{"path": {"max_depth": 4}}"#, r#""normals""#), &[]).1;
    for (pixel, color) in shown.iter().enumerate() {
        for (axis, shown) in ["X", "Y", "Z"].into_iter().zip(color.to_array()) {
            let expected = 0.5 * (found[&format!("normal.{axis}")][pixel] + found["alpha.A"][pixel]);
            assert!((shown - expected).abs() < 1e-5, "{axis} of pixel {pixel}: {shown} for {expected}");
        }
    }
    for (pixel, normal) in [(at(0.1, 0.05), tilted), (at(-0.4, 0.1), [0.0, 0.0, 1.0])] {
        for (shown, normal) in shown[pixel].to_array().into_iter().zip(normal) {
            assert!((shown - 0.5 * (normal + 1.0)).abs() < 1e-5, "{:?} for {normal:?}", shown);
        }
    }
}

/// A wall perpendicular to the view, 4 units from the camera, with each kind of camera: the distance
/// along the view direction is 4, and that along the ray is larger by 1 / cosine.
#[test]
fn planar_depth_is_measured_along_the_view_direction() {
    let wall = r#"{"shape": {"rectangle": {"size": [40, 40]}}, "material": {"diffuse": {}}}"#;
    let scene = |camera: &str| {
        let render = r#""render": {"size": [32, 32], "samples": 16, "filter": "box", "integrator": "albedo"}"#;
        format!(r#"{{"version": 1, {render}, "camera": {{{camera}}}, "objects": [{wall}]}}"#)
    };
    let pose = r#""eye": [0, 4, 0], "direction": [0, -1, 0], "up": [0, 0, -1]"#;
    let cameras = [
        format!(r#""perspective": {{{pose}, "vertical_fov_degrees": 90}}"#),
        format!(r#""thin_lens": {{{pose}, "vertical_fov_degrees": 90, "lens_radius": 0.5, "focus_distance": 2}}"#),
        format!(r#""orthographic": {{{pose}, "height": 2}}"#),
    ];
    for camera in cameras {
        let (found, _) = layers(&scene(&camera), &[Aov::Depth, Aov::PlanarDepth]);
        let (depth, planar) = (&found["depth.Z"], &found["planar_depth.Z"]);
        assert!(planar.iter().all(|depth| (depth - 4.0).abs() < 1e-4), "{camera}: {planar:?}");
        // The ray through the corner pixel of a pinhole is √(1 + 2 (31/32)²) times as long.
        let ratio = depth[0] / planar[0];
        let expected: std::ops::Range<f32> = match camera.as_str() {
            camera if camera.contains("perspective") => 1.685..1.705,
            camera if camera.contains("thin_lens") => 1.5..1.9,
            _ => 0.9999..1.0001,
        };
        assert!(expected.contains(&ratio), "{camera}: {ratio}");
    }
    // Beside the wall there is no depth.
    let (found, _) =
        layers(&scene(r#""perspective": {"eye": [0, 4, 0], "direction": [0, 1, 0.1]}"#), &[Aov::PlanarDepth]);
    assert!(found["planar_depth.Z"].iter().all(|depth| *depth == f32::INFINITY));
}
