//! White furnaces of every kind of material except `phong`, which is not physical, and `emissive`:
//! under uniform illumination of radiance 1, a sphere has a mean radiance of at most 1.002, and at
//! least 0.99 (glass and metal 0.998) if it absorbs nothing; also from inside if the material
//! transmits light. [`crate::white_worlds`] and the contract of `bsdf` cover solid `dielectric`s
//! and `principled`. `JUGGLER_FURNACES=all` runs whole grids: `check.sh deep furnaces`.

use crate::probe::{Estimate, Scene, is_deep};
use crate::white_worlds::{WITHIN, sphere_by};
use juggler_math::testing::family_wise_deviations;

/// Maximum mean radiance of any material.
const MOST: f64 = 1.002;

/// A material, its lower bound, and the position of the camera.
struct Case {
    material: String,
    /// Minimum mean radiance.
    least: f64,
    is_within: bool,
}

/// Textures that the materials name.
const TEXTURES: &str = r#"{
    "height": {"noise": {"scale": 4, "space": "local"}},
    "leaning": {"constant": {"color": [0.7, 0.45, 0.9]}},
    "spots": {"checker": {"size": 0.3, "even": 0.1, "odd": 0.9, "space": "local"}}
}"#;

fn cases(kind: &str, least: f64, fields: &[String]) -> Vec<Case> {
    let case = |fields: &String| Case { material: format!(r#"{{"{kind}": {{{fields}}}}}"#), least, is_within: false };
    fields.iter().map(case).collect()
}

/// All combinations of the values of some fields; a few of them in the ordinary check.
fn grid(fixed: &str, axes: &[(&str, &[f64])]) -> Vec<String> {
    let mut all = vec![fixed.to_owned()];
    for (field, values) in axes {
        all = all
            .iter()
            .flat_map(|one| values.iter().map(move |value| format!(r#"{one}, "{field}": {value}"#)))
            .collect();
    }
    let (first, step) = if is_deep() { (0, 1) } else { (2, 23) };
    all.into_iter().skip(first).step_by(step).collect()
}

const ROUGHNESS: (&str, &[f64]) = ("roughness", &[0.0, 0.1, 0.3, 0.5, 0.7, 0.85, 1.0]);
const ANISOTROPY: (&str, &[f64]) = ("anisotropy", &[0.0, 0.5, -1.0]);

fn metals() -> Vec<Case> {
    const NAMES: [&str; 13] = [
        "aluminum", "brass", "chromium", "cobalt", "copper", "gold", "iron", "nickel", "platinum", "silver",
        "titanium", "tungsten", "zinc",
    ];
    let names = if is_deep() { &NAMES[..] } else { &["gold"] };
    let mut all = cases("conductor", 0.998, &grid(r#""reflectance": 1"#, &[ROUGHNESS, ANISOTROPY]));
    let few = [("roughness", &[0.0, 0.4, 1.0][..]), ("anisotropy", &[0.0, -1.0])];
    all.extend(names.iter().flat_map(|name| cases("conductor", 0.0, &grid(&format!(r#""metal": "{name}""#), &few))));
    let tinted = r#""reflectance": [0.9, 0.5, 0.2], "edge_tint": [0.8, 1, 1]"#;
    all.extend(cases("conductor", 0.0, &grid(tinted, &[ROUGHNESS, ANISOTROPY])));
    all
}

fn coats() -> Vec<Case> {
    let body: (&str, &[f64]) = ("diffuse_roughness", &[0.0, 0.6]);
    let index: (&str, &[f64]) = ("ior", &[1.1, 1.5, 2.4]);
    let sheen: (&str, &[f64]) = ("sheen_roughness", &[0.0, 0.2, 0.5, 0.8, 1.0]);
    let mut all = cases("diffuse", 0.99, &grid(r#""reflectance": 1"#, &[ROUGHNESS]));
    for nonlinear in [false, true] {
        let fixed = format!(r#""reflectance": 1, "nonlinear": {nonlinear}"#);
        all.extend(cases("plastic", 0.99, &grid(&fixed, &[ROUGHNESS, ANISOTROPY, body, index])));
    }
    all.extend(cases("velvet", 0.99, &grid(r#""sheen_color": 1, "reflectance": 1"#, &[sheen, ROUGHNESS])));
    all.extend(cases("velvet", 0.0, &grid(r#""sheen_color": 1, "reflectance": 0"#, &[sheen, ROUGHNESS])));
    all
}

/// Sheets and solids that transmit light.
fn transmitting() -> Vec<Case> {
    let index: (&str, &[f64]) = ("ior", &[1.1, 1.5, 2.4]);
    let mut all = cases("dielectric", 0.998, &grid(r#""thin": true"#, &[index, ROUGHNESS, ANISOTROPY]));
    let sheets =
        [(0.6, 0.4), (0.0, 1.0)].map(|(back, through)| format!(r#""reflectance": {back}, "transmittance": {through}"#));
    all.extend(cases("translucent", 0.99, &sheets));
    let fogs = [(0.5, 0.0), (3.0, 0.7), (3.0, -0.5)]
        .map(|(scattering, g)| format!(r#""medium": {{"scattering": {scattering}, "anisotropy": {g}}}"#));
    all.extend(cases("boundary", 0.99, &fogs));
    let within = |case: &Case| Case { material: case.material.clone(), is_within: true, ..*case };
    let inside: Vec<Case> = all.iter().map(within).collect();
    // No light enters a sphere of a sheet that transmits nothing, so it is white from outside only.
    let opaque = cases("translucent", 0.99, &[r#""reflectance": 1, "transmittance": 0"#.to_owned()]);
    all.into_iter().chain(inside).chain(opaque).collect()
}

/// Least mean radiance of a white diffuse sphere under the maps of these tests.
const DIFFUSE_UNDER_MAP: f64 = 0.92;

/// Materials that combine others.
fn combined() -> Vec<Case> {
    let (white, glass) =
        (r#"{"diffuse": {"reflectance": 1}}"#, r#"{"dielectric": {"ior": 1.5, "thin": true, "roughness": 0.4}}"#);
    let metal = r#"{"conductor": {"reflectance": 1, "roughness": 0.4}}"#;
    let mut all = cases("mix", 0.99, &[format!(r#""amount": 0.3, "a": {white}, "b": {glass}"#)]);
    all.extend(cases("mix", 0.99, &[format!(r#""amount": "spots", "a": {metal}, "b": {white}"#)]));
    all.extend(cases("checkerboard", 0.99, &[format!(r#""size": 0.4, "even": {glass}, "odd": {metal}"#)]));
    for opacity in ["0.3", r#""spots""#] {
        all.extend(cases("mask", 0.99, &[format!(r#""opacity": {opacity}, "material": {metal}"#)]));
    }
    // Diffuse surfaces follow n·l, and lose the light that a normal sends below the surface: they
    // keep (1 + cos β) / 2 where it leans by β.
    for (material, least) in [(white, DIFFUSE_UNDER_MAP), (metal, 0.99), (glass, 0.99)] {
        for strength in [0.3, 1.0] {
            let fields = format!(r#""texture": "leaning", "strength": {strength}, "material": {material}"#);
            all.extend(cases("normal_map", least, &[fields]));
            let fields = format!(r#""height": "height", "distance": {}, "material": {material}"#, 0.1 * strength);
            all.extend(cases("bump_map", least, &[fields]));
        }
    }
    all
}

/// Mean radiance of the sphere. From outside, the picture is its whole disk, so directions are
/// weighted by their cosine.
fn furnace(material: &str, is_within: bool, edge: u32, samples: u32) -> Estimate {
    let outside = r#"{"orthographic": {"eye": [2, 1, 4], "look_at": [0, 0, 0], "height": 2}}"#;
    let camera = if is_within { WITHIN } else { outside };
    let Estimate { mean, sigma } = Estimate::of(&sphere_by(camera, Scene::textured(TEXTURES), material, edge, samples));
    // The background around the disk is exactly 1.
    let scale = if is_within { 1.0 } else { 4.0 / std::f64::consts::PI };
    Estimate { mean: 1.0 + (mean - 1.0) * scale, sigma: sigma * scale }
}

#[test]
fn every_white_material_conserves_energy() {
    let cases: Vec<Case> = metals().into_iter().chain(coats()).chain(transmitting()).chain(combined()).collect();
    let (edge, samples, most_noise) = if is_deep() { (32, 256, 0.0015) } else { (16, 64, 0.006) };
    let mut wrong = Vec::new();
    for Case { material, least, is_within } in &cases {
        let Estimate { mean, sigma } = furnace(material, *is_within, edge, samples);
        let side = if *is_within { "from within" } else { "from outside" };
        println!("{material}, {side}: {mean:.5} ± {sigma:.5}");
        let allowed = family_wise_deviations(cases.len()) * sigma;
        if mean > MOST + allowed || mean < least - allowed || (*least > 0.0 && sigma > most_noise) {
            wrong.push(format!("{material}, {side}: {mean:.5} ± {sigma:.5}"));
        }
    }
    assert!(wrong.is_empty(), "{} of {}: {wrong:#?}", wrong.len(), cases.len());
}
