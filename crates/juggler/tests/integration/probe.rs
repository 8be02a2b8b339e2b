//! Probed pixels equal those of the image, and their light sums up.

use juggler::integrator::IntegratorKind;
use juggler::probe::{Branch, Detail, Probe, Prober, Share};
use juggler::render::Control;
use juggler::{Picture, Settings};
use juggler_scene::Scene;

const SCENE: &str = r#"{"version": 1,
    "render": {"size": [24, 18], "samples": 33, "integrator": "path", "filter": FILTER},
    "camera": {"perspective": {"eye": [0, 1.2, 5], "look_at": [0, 0.9, 0], "vertical_fov_degrees": 40}},
    "background": [0.2, 0.3, 0.5],
    "background_light_group": "sky",
    "materials": {"gold": {"conductor": {"roughness": 0.3}}},
    "lights": [{"ambient": {"intensity": 0}}, {"point": {"position": [2, 4, 3], "intensity": 30, "light_group": "key"}}],
    "objects": [
        {"name": "floor", "shape": "plane", "material": {"diffuse": {"reflectance": [0.6, 0.5, 0.4]}}},
        {"name": "glass", "shape": {"sphere": {"radius": 0.7}}, "transform": [{"translate": [-1, 0.7, 0]}],
         "material": {"dielectric": {"ior": 1.5}}},
        {"shape": {"sphere": {"radius": 0.6}}, "transform": [{"translate": [1, 0.6, 0.4]}], "material": "gold"},
        {"name": "bulb", "shape": {"sphere": {"radius": 0.2}}, "transform": [{"translate": [0, 2, -1]}],
         "material": {"emissive": {"radiance": [1, 0.8, 0.5], "scale": 20}}}
    ]}"#;

fn scene(filter: &str) -> Scene {
    Scene::from_json(SCENE.replace("FILTER", filter), "probe.json").unwrap()
}

fn probed(scene: &Scene, settings: &Settings, pixel: [u32; 2]) -> Probe {
    let prober = Prober::new(scene, Picture::new(scene, settings).unwrap());
    prober.probe_pixel(pixel, &Detail { depth: 64, branches: 1000, brightest: 3 }, &Control::default()).unwrap()
}

fn total(shares: &[Share]) -> [f64; 3] {
    std::array::from_fn(|i| shares.iter().map(|share| share.light[i]).sum())
}

fn leaves(branch: &Branch) -> [f64; 3] {
    if branch.branches.is_empty() {
        return branch.light;
    }
    branch.branches.iter().map(leaves).fold([0.0; 3], |sum, leaf| std::array::from_fn(|i| sum[i] + leaf[i]))
}

#[test]
fn probe_mean_equals_the_pixel_and_its_contributions_sum_to_it() {
    for filter in [r#""box""#, r#"{"gaussian": {"radius": 1.5}}"#, r#""mitchell""#] {
        let scene = scene(filter);
        use IntegratorKind::{AmbientOcclusion, Classic, Direct, Normals};
        for integrator in [None, Some(Direct), Some(Classic), Some(Normals), Some(AmbientOcclusion)] {
            let settings = Settings { integrator, ..Settings::default() };
            let image = Picture::new(&scene, &settings).unwrap().render_image(&Control::default()).unwrap();
            for pixel in [[0, 0], [6, 9], [17, 11], [12, 16], [12, 3]] {
                let probe = probed(&scene, &settings, pixel);
                let expected = image.pixels()[(pixel[1] * 24 + pixel[0]) as usize].to_array();
                assert_eq!(probe.mean, expected, "{filter} {integrator:?} {pixel:?}");
                let Some(light) = probe.light else {
                    assert!(integrator.is_some());
                    continue;
                };
                let shares = &light.shares;
                let lists = [&shares.kinds, &shares.groups, &shares.lights, &shares.segments].map(|list| total(list));
                for sum in lists.into_iter().chain([light.paths.light, leaves(&light.paths)]) {
                    for (sum, expected) in sum.into_iter().zip(expected) {
                        let expected = f64::from(expected);
                        assert!(
                            (sum - expected).abs() < 1e-4 * (0.01 + expected.abs()),
                            "{sum} {expected} {integrator:?}"
                        );
                    }
                }
                assert_eq!(light.paths.samples, 33);
                let shares: Vec<Option<f64>> = light.brightest.iter().map(|sample| sample.share).collect();
                // Filters with negative lobes may give negative pixels, which reverse the signs.
                let is_lit = expected.iter().all(|channel| *channel > 0.0);
                assert!(shares.len() == 3 && (!is_lit || shares[0] >= shares[1]), "{filter} {pixel:?} {shares:?}");
            }
        }
    }
}

#[test]
fn objects_are_reported_by_their_names() {
    let scene = scene(r#""box""#);
    let settings = Settings::default();
    let glass = probed(&scene, &settings, [6, 10]);
    let hit = glass.first_hit.unwrap();
    assert_eq!((hit.object.as_str(), hit.material.as_str(), hit.instance), ("glass", "objects[1].material", 2));
    assert!(hit.shape.unwrap() == "sphere" && (hit.distance - 4.5).abs() < 0.6 && hit.part.is_none());
    let first = &glass.light.as_ref().unwrap().paths.branches[0];
    assert_eq!(first.scattering.as_ref().unwrap().object, "glass");
    let gold = probed(&scene, &settings, [17, 11]);
    let hit = gold.first_hit.unwrap();
    assert_eq!((hit.object.as_str(), hit.material.as_str()), ("objects[2]", "gold"));
    let floor = probed(&scene, &settings, [12, 16]).light.unwrap();
    let names = |shares: &[Share]| shares.iter().map(|share| share.name.clone()).collect::<Vec<_>>();
    let lights = names(&floor.shares.lights);
    for name in ["lights[1] (point)", "bulb", "background"] {
        assert!(lights.contains(&name.to_owned()), "{lights:?}");
    }
    let mut groups = names(&floor.shares.groups);
    groups.sort();
    assert_eq!(groups, ["key", "rest", "sky"]);
    assert!(
        floor.brightest.iter().all(|sample| sample.path.starts_with("floor diffuse > ")),
        "{:?}",
        floor.brightest[0]
    );
    let sky = probed(&scene, &settings, [0, 0]);
    assert!(
        sky.first_hit.is_none() && sky.light.unwrap().paths.branches[0].light_from.as_deref() == Some("background")
    );
}

#[test]
fn probe_rejects_outside_pixels_and_accepts_one_pixel_pictures() {
    let scene = scene(r#""box""#);
    let small = Settings { size: Some([1, 1]), samples: Some(1), ..Settings::default() };
    let probe = probed(&scene, &small, [0, 0]);
    assert!(probe.standard_error.is_none() && probe.samples == 1);
    let prober = Prober::new(&scene, Picture::new(&scene, &small).unwrap());
    let error = prober.probe_pixel([0, 1], &Detail::default(), &Control::default()).unwrap_err().to_string();
    assert!(error.contains("0,1") && error.contains("0 to 0"), "{error}");
    assert_eq!(prober.find_fireflies(3, &Control::default()).unwrap().pixels, []);
    let empty = Scene::from_json(r#"{"version": 1, "objects": []}"#, "empty.json").unwrap();
    let settings = Settings { size: Some([4, 4]), integrator: Some(IntegratorKind::Path), ..Settings::default() };
    assert!(probed(&empty, &settings, [1, 2]).first_hit.is_none());
}

#[test]
fn truncated_path_tree_keeps_the_total() {
    let scene = scene(r#""box""#);
    let prober = Prober::new(&scene, Picture::new(&scene, &Settings::default()).unwrap());
    for (depth, branches) in [(0, 5), (1, 1), (2, 2), (5, 0)] {
        let detail = Detail { depth, branches, brightest: 0 };
        let light = prober.probe_pixel([6, 10], &detail, &Control::default()).unwrap().light.unwrap();
        let root = &light.paths;
        assert!(light.brightest.is_empty() && root.branches.len() <= branches);
        let listed: f64 = root.branches.iter().map(|branch| branch.share).sum();
        let rest = root.others.as_ref().map_or(0.0, |others| others.share);
        assert!((listed + rest - 1.0).abs() < 1e-6, "{depth} {branches}: {listed} {rest}");
    }
}

#[test]
fn fireflies_are_found_with_the_paths_that_made_them() {
    // A small emitter behind glass, which light sampling cannot reach: only few paths hit it by
    // BSDF sampling.
    let text = r#"{"version": 1,
        "render": {"size": [40, 30], "samples": 64, "integrator": "path"},
        "camera": {"perspective": {"eye": [0, 2, 5], "look_at": [0, 0.5, 0], "vertical_fov_degrees": 50}},
        "background": [0.1, 0.1, 0.1],
        "objects": [
            {"name": "floor", "shape": "plane", "material": {"diffuse": {"reflectance": 0.7}}},
            {"name": "cover", "shape": {"cuboid": {"min": [-0.3, -0.3, -0.3], "max": [0.3, 0.3, 0.3]}}, "transform": [{"translate": [0, 1, 0]}],
             "material": {"dielectric": {"ior": 1.5}}},
            {"name": "bulb", "shape": {"sphere": {"radius": 0.04}}, "transform": [{"translate": [0, 1, 0]}],
             "material": {"emissive": {"radiance": 1, "scale": 2000}}}
        ]}"#;
    let scene = Scene::from_json(text, "covered.json").unwrap();
    let prober = Prober::new(&scene, Picture::new(&scene, &Settings::default()).unwrap());
    let found = prober.find_fireflies(5, &Control::default()).unwrap();
    assert!(found.pixels.len() == 5 && found.count >= 5 && found.excess > 0.0, "{found:?}");
    for firefly in &found.pixels {
        let path = firefly.path.as_ref().unwrap();
        assert!(path.contains("cover specular transmission") && path.ends_with("> bulb"), "{path}");
        assert!(firefly.share.unwrap() > 0.1 && firefly.luminance > 3.0 * firefly.median, "{firefly:?}");
    }
    let chance = |kind: &juggler::probe::PathGroup| kind.path.contains("diffuse > specular transmission");
    assert!(found.kinds.iter().any(chance), "{:?}", found.kinds);
    let share: f64 = found.kinds.iter().map(|kind| kind.share).sum();
    assert!(share > 0.5 && share < 1.0 + 1e-9, "{share}");
    let picture = Picture::new(&scene, &Settings::default()).unwrap().render_image(&Control::default()).unwrap();
    let [x, y] = found.pixels[0].pixel;
    assert_eq!(picture.pixels()[(y * 40 + x) as usize].to_array(), found.pixels[0].value);
}
