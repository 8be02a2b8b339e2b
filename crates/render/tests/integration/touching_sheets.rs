//! Sheets, openings and fog at the surface of solids: white furnaces, closed forms, and equal
//! pictures in every order of the objects.

use crate::probe::{camera, measure, path, read};
use crate::touching::{Item, floor, fog, glass, is_near, orders, placements, scene, seen};
use juggler_camera::ShutterCamera;
use juggler_integrator::AnyIntegrator;
use juggler_math::{Transform, Vec3};

/// Sheets that transmit light and absorb none.
const WHITE_SHEETS: [&str; 4] = [
    r#"{"dielectric": {"ior": 1.5, "thin": true}}"#,
    r#"{"dielectric": {"ior": 1.5, "thin": true, "roughness": 0.4}}"#,
    r#"{"translucent": {"reflectance": 0.4, "transmittance": 0.6}}"#,
    r#"{"principled": {"base_color": 1, "specular": 0, "diffuse_transmission": 0.5}}"#,
];

/// Sheets at either face of glass, or between two blocks.
#[test]
fn sheets_on_glass_are_invisible_in_a_white_furnace() {
    let block = |low: f64, ior: f64| Item::cuboid([-2.0, low, -2.0], [2.0, low + 1.0, 2.0], glass(ior));
    for material in WHITE_SHEETS {
        let sheet = Item::new(floor(8.0), material);
        for items in [vec![block(0.0, 1.7), sheet.clone()], vec![block(0.0, 1.5), block(-1.0, 1.7), sheet]] {
            for order in orders(&items) {
                for (_, placement) in placements() {
                    for from in [Vec3::new(0.4, 3.0, 0.7), Vec3::new(0.4, -3.0, 0.7)] {
                        let result = seen(&order, &placement, from, 1.0, &path(r#""max_depth": 500"#));
                        let tolerance = 0.002 + 5.0 * result.sigma;
                        is_near(&format!("{material} on {} solids", order.len() - 1), result, 1.0, tolerance);
                        assert!(result.sigma < 0.01, "{result:?}");
                    }
                }
            }
        }
    }
}

/// Light that a sheet transmits crosses the fog at its place once: as with a distance of 1e-3.
#[test]
fn sheets_on_fog_keep_its_medium() {
    for material in [WHITE_SHEETS[2], r#"{"translucent": {"reflectance": 0.3, "transmittance": 0.5}}"#] {
        let block = Item::cuboid([-4.0, 0.0, -4.0], [4.0, 1.0, 4.0], fog(0.5));
        let sheet = |y: f32| Item::new(floor(8.0), material).moved(Transform::translation(Vec3::new(0.0, y, 0.0)));
        for (at, apart, from) in [(0.0, -1e-3, 3.0), (1.0, 1.001, 3.0), (0.0, -1e-3, -3.0), (1.0, 1.001, -3.0)] {
            let (_, placement) = &placements()[1];
            let result = |items: &[Item]| {
                seen(items, placement, Vec3::new(0.1, from, 0.2), 1.0, &path(r#""light_samples": 16"#))
            };
            let expected = result(&[block.clone(), sheet(apart)]);
            for order in orders(&[block.clone(), sheet(at)]) {
                let result = result(&order);
                let tolerance = 0.002 + 5.0 * (result.sigma + expected.sigma);
                is_near(&format!("{material} at {at} from {from}"), result, expected.mean, tolerance);
            }
        }
    }
}

/// An opening in glass, and fog within glass, let light pass without refraction: its radiance over
/// n² stays the same.
#[test]
fn openings_and_fog_in_glass_are_invisible_in_a_white_furnace() {
    let half = r#"{"mask": {"opacity": 0.5, "material": {"dielectric": {"ior": 1.5}}}}"#;
    let none = r#"{"mask": {"opacity": 0, "material": {"dielectric": {"ior": 1.5}}}}"#;
    let block = |material: &str| Item::cuboid([-2.0, 0.0, -2.0], [2.0, 1.0, 2.0], material);
    let clear = |priority: i32| format!(r#"{{"boundary": {{"priority": {priority}}}}}"#);
    let pocket = |low: f64, priority: i32| Item::cuboid([-1.5, low, -1.5], [1.5, low + 1.0, 1.5], clear(priority));
    let mut cases = vec![vec![block(half)], vec![block(none)]];
    for low in [0.5, 0.0, 0.2, -0.5] {
        cases.extend([0, 1].map(|priority| vec![block(&glass(1.5)), pocket(low, priority)]));
    }
    for items in cases {
        for order in orders(&items) {
            for (_, placement) in placements() {
                for from in [Vec3::new(0.1, 4.0, 0.2), Vec3::new(0.3, -4.0, 0.9)] {
                    let result = seen(&order, &placement, from, 1.0, &path(r#""max_depth": 500"#));
                    is_near(&format!("{order:?}"), result, 1.0, 0.004);
                }
            }
        }
    }
}

/// Glass of any kind on a table in classic pictures: as if sunk into the table.
#[test]
fn glass_on_a_table_hides_nothing_from_classic_rays() {
    let classic: AnyIntegrator = read(r#"{"classic": {}}"#);
    let table = Item::new(floor(8.0), r#"{"emissive": {"radiance": 0.7}}"#);
    let glasses = [
        glass(1.5),
        r#"{"principled": {"transmission": 1}}"#.to_owned(),
        r#"{"phong": {"diffuse": 0, "transparency": 1, "ior": 1.5}}"#.to_owned(),
    ];
    for material in glasses {
        let block = |low: f64| Item::cuboid([-1.0, low, -1.0], [1.0, 1.0, 1.0], material.as_str());
        let (_, still) = &placements()[0];
        let from = Vec3::new(0.2, 3.0, 0.3);
        let sunk = seen(&[block(-1e-3), table.clone()], still, from, 1.0, &classic);
        for order in orders(&[block(0.0), table.clone()]) {
            for (_, placement) in placements() {
                is_near(&material, seen(&order, &placement, from, 1.0, &classic), sunk.mean, 1e-3);
            }
        }
    }
}

/// A camera that rises out of fog while the shutter is open: ½^y from within, ½ from above.
#[test]
fn the_camera_leaves_a_solid_while_the_shutter_is_open() {
    let block = Item::cuboid([-2.0, 0.0, -2.0], [2.0, 1.0, 2.0], fog(0.5));
    let [first, last] = [0.5, 1.3].map(|y| {
        let view = r#""direction": [0, -1, 0], "up": [0, 0, 1], "height": 1e-4"#;
        camera(&format!(r#"{{"orthographic": {{"eye": [0.01, {y}, 0.02], {view}}}}}"#)).projection_at(0.0)
    });
    let rising = ShutterCamera::from_keys(first, vec![last]);
    let seen = measure(&scene(&[block]).in_light(1.0).world(), &rising, &*path(""), 1024);
    let within = (0.5f64.powf(0.5) - 0.5) / (0.8 * 2f64.ln());
    is_near("rising camera", seen, within + 0.375 * 0.5, 0.003);
}

/// Integrators that show one property show that of the surface that a path meets first: the sheet on
/// glass, and the face of the block that the ray enters.
#[test]
fn properties_of_surfaces_at_one_place_are_those_of_the_first_that_a_path_meets() {
    let block = |low: f64, material: &str| Item::cuboid([-2.0, low, -2.0], [2.0, low + 1.0, 2.0], material);
    let decal = Item::new(floor(3.0), r#"{"diffuse": {"reflectance": 0.3}}"#);
    let open = Item::new(floor(3.5), r#"{"mask": {"opacity": 0, "material": {"diffuse": {}}}}"#);
    let sunk = [vec![block(-1.0, &glass(1.5)), decal], vec![block(-1.0, &glass(1.7)), block(0.0, &fog(0.5)), open]];
    for (items, from) in sunk.into_iter().zip([Vec3::new(0.2, 3.0, 0.4), Vec3::new(0.2, 0.5, 0.4)]) {
        for integrator in [read(r#"{"albedo": {}}"#), read(r#"{"normals": {}}"#)] {
            for (_, placement) in placements() {
                let mean = |order: Vec<Item>| seen(&order, &placement, from, 1.0, &integrator).mean;
                let means: Vec<f64> = orders(&items).into_iter().map(mean).collect();
                assert!(means.iter().all(|mean| *mean == means[0]), "{integrator:?}: {means:?}");
                if items.len() == 2 && format!("{integrator:?}").contains("Albedo") {
                    assert!((means[0] - 0.3).abs() < 1e-5, "{means:?}");
                }
            }
        }
    }
}
