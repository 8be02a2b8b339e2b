//! Contract of all materials, and values of the classic material.

use super::*;
use juggler_bsdf::{ConeSampling, Highlight, PhongParameters};
use juggler_math::{Frame, Rgb, Vec2, Vec3};
use juggler_shape::surface::Tangents;
use juggler_texture::AnyTexture;
use std::collections::BTreeMap;
use std::f32::consts::FRAC_1_PI;

mod coat;
mod constructors;
mod examples;
mod maps;
mod one_sided;
mod unlit;

fn textures() -> TextureTable {
    let json = r#"{"tiles": {"checker": {"size": 1, "even": [0.2, 0.4, 0.6], "odd": [0, 0, 0]}},
        "wild": {"checker": {"size": 1, "even": [-3, 2, 5], "odd": [7, -1e30, 0.5]}},
        "waves": {"wave": {}}, "u and v": {"uv": {}}, "x, y and z": {"uv": {"space": "local"}},
        "straight up": {"constant": {"color": [0.5, 0.5, 1]}}}"#;
    let named: BTreeMap<String, AnyTexture> = serde_json::from_str(json).unwrap();
    TextureTable::new(named)
}

fn at(x: f32) -> Surface {
    Surface { local: Vec3::ZERO, ..Surface::new(Vec3::ZERO, 0.0, Vec3::Y, Vec2::new(x, 0.0)) }
}

fn compile(json: &str) -> Result<(MaterialTable, MaterialId), MaterialError> {
    let mut compiler = MaterialCompiler::new(textures(), []);
    let id = compiler.compile(&serde_json::from_str(json).unwrap())?;
    Ok((compiler.finish().unwrap(), id))
}

fn lobe(json: &str, x: f32) -> PhongParameters {
    let (table, id) = compile(json).unwrap();
    *table.phong(id, &at(x)).unwrap()
}

#[test]
fn weights_and_colors_multiply() {
    let lobe = lobe(
        r#"{"phong": {"ambient": [0.5, 1, 2], "diffuse": [0.2, 0.4, 0.6], "diffuse_weight": 2, "specular": 3,
            "highlight_color": [0.1, 0.2, 0.3], "shininess": 53, "highlight": "phong_cosine", "reflection": 0.25,
            "glossy": {"half_angle_degrees": 30, "rays": 64}, "transparency": [0, 0.5, 1], "ior": 1.5,
            "fresnel": true, "both_sides": true, "emission": [3, 2, 1], "occlusion": 0.5,
            "blurry": {"half_angle_degrees": 45}}}"#,
        0.0,
    );
    let near = |a: Rgb, b: [f32; 3]| (Vec3::from(a.to_array()) - Vec3::from(b)).abs().max_element() < 1e-6;
    assert!(near(lobe.ambient, [0.1, 0.4, 1.2]) && near(lobe.diffuse, [0.4, 0.8, 1.2]));
    assert!(
        near(lobe.specular, [0.3, 0.6, 0.9]) && near(lobe.mirror, [0.25; 3]) && near(lobe.emission, [3.0, 2.0, 1.0])
    );
    assert!(near(lobe.transparency, [0.0, 0.5, 1.0]));
    assert_eq!((lobe.shininess, lobe.highlight, lobe.occlusion), (53.0, Highlight::PhongCosine, 0.5));
    assert_eq!((lobe.ior, lobe.fresnel, lobe.both_sides), (1.5, true, true));
    assert_eq!(lobe.glossy, ConeSampling { half_angle_radians: std::f32::consts::FRAC_PI_6, rays: 64 });
    assert_eq!(lobe.blurry, ConeSampling { half_angle_radians: std::f32::consts::FRAC_PI_4, rays: 1 });
}

#[test]
fn the_early_steps_of_the_article_divide_diffuse_light_by_pi() {
    let plain = lobe(r#"{"phong": {"diffuse": [1, 0, 0], "diffuse_weight": 2}}"#, 0.0);
    let early = r#"{"phong": {"diffuse": [1, 0, 0], "diffuse_weight": 2, "diffuse_normalization": "inverse_pi"}}"#;
    let early = lobe(early, 0.0);
    assert_eq!((plain.diffuse.r, early.diffuse.r), (2.0, 2.0 * FRAC_1_PI));
    assert_eq!(plain.ambient, early.ambient);
}

#[test]
fn textures_are_evaluated_at_each_point() {
    let json = r#"{"phong": {"diffuse": "tiles", "ambient": 0.5, "specular": "tiles", "transparency": "tiles"}}"#;
    let (table, id) = compile(json).unwrap();
    let (even, odd) = (*table.phong(id, &at(0.5)).unwrap(), *table.phong(id, &at(1.5)).unwrap());
    let tile = Rgb::new(0.2, 0.4, 0.6);
    assert_eq!((even.diffuse, even.ambient), (tile, tile * 0.5));
    assert_eq!(even.specular, Rgb::splat(tile.luminance()));
    assert!(odd.diffuse.is_black() && odd.ambient.is_black() && odd.specular.is_black());
    assert_eq!(
        (table.shadow_transmittance(id, &at(0.5), Vec3::Y), table.shadow_transmittance(id, &at(1.5), Vec3::Y)),
        (tile, Rgb::BLACK)
    );
    assert!(table.is_transparent(id));
}

#[test]
fn transparency_is_found_through_checkerboards() {
    let board = |odd: &str| {
        let json = format!(r#"{{"checkerboard": {{"even": {{"checkerboard": {{"odd": {{"phong": {odd}}}}}}}}}}}"#);
        compile(&json).unwrap()
    };
    let (table, id) = board("{}");
    assert!(!table.is_transparent(id));
    let (table, id) = board(r#"{"transparency": [0, 0, 0.1]}"#);
    assert!(table.is_transparent(id));
    // This point lies in an even cell of both checkerboards, which is opaque.
    assert_eq!(table.shadow_transmittance(id, &at(0.0), Vec3::Y), Rgb::BLACK);
}

#[test]
fn unknown_material_ids_are_black() {
    let (table, id) = compile(r#"{"phong": {}}"#).unwrap();
    let missing = MaterialId(id.0 + 1);
    assert_eq!(*table.phong(missing, &at(0.0)).unwrap(), PhongParameters::BLACK);
    assert!(table.shadow_transmittance(missing, &at(0.0), Vec3::Y).is_black() && !table.is_transparent(missing));
    assert_eq!(*MaterialTable::default().phong(id, &at(0.0)).unwrap(), PhongParameters::BLACK);
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    for (fields, path) in [
        (r#""shininess": -1"#, "phong.shininess"),
        (r#""occlusion": 1.5"#, "phong.occlusion"),
        (r#""ior": 0"#, "phong.ior"),
        (r#""diffuse": [0, -0.1, 0]"#, "phong.diffuse"),
        (r#""emission": [1e39, 0, 0]"#, "phong.emission"),
        (r#""specular": -3"#, "phong.specular"),
        (r#""glossy": {"half_angle_degrees": 91}"#, "phong.glossy.half_angle_degrees"),
        (r#""blurry": {"rays": 0}"#, "phong.blurry.rays"),
        (r#""transparency": "fog""#, "phong.transparency"),
    ] {
        assert_eq!(compile(&format!(r#"{{"phong": {{{fields}}}}}"#)).unwrap_err().path(), path);
    }
    assert_eq!(compile(r#"{"checkerboard": {"size": 0}}"#).unwrap_err().path(), "checkerboard.size");
}

#[test]
fn json_round_trips() {
    for material in AnyMaterial::examples() {
        let text = serde_json::to_string(&material).unwrap();
        assert_eq!(serde_json::from_str::<AnyMaterial>(&text).unwrap(), material, "{text}");
    }
}

#[test]
fn inputs_are_numbers_colors_or_names() {
    let phong = |json: &str| serde_json::from_str::<Phong>(json).unwrap();
    use juggler_texture::Input;
    assert_eq!(phong(r#"{"reflection": 0.5}"#).reflection, Input::Value(Rgb::splat(0.5)));
    assert_eq!(phong(r##"{"diffuse": "#ffffff"}"##).diffuse, Input::Value(Rgb::WHITE));
    assert_eq!(phong(r#"{"diffuse": "wood"}"#).diffuse, Input::Texture("wood".into()));
    assert_eq!(phong(r#"{"specular": "wood"}"#).specular, Input::Texture("wood".into()));
    assert_eq!(phong(r#"{"specular": {"texture": "wood", "factor": 2}}"#).specular, Input::product("wood", 2.0));
    let error = serde_json::from_str::<Phong>(r#"{"diffuse": {"wood": {}}}"#).unwrap_err().to_string();
    assert!(error.contains("a number, a color, the name of a texture or a product"), "{error}");
    let error = serde_json::from_str::<AnyMaterial>(r#"{"checkerboard": {"even": {"phong": {"ior": "x"}}}}"#);
    assert!(error.unwrap_err().to_string().contains("f32"));
}
