//! Contract of all textures.

use super::*;
use juggler_math::Rgb;
use juggler_math::testing::Random;
use std::sync::Arc;

/// Source of one image of four texels, under any name.
struct TestImages;

impl Images for TestImages {
    fn image(&self, _: &str, _: &Image) -> Result<Arc<MipMap>, String> {
        let texel = |red: f32| [red, red * 2.0, 1.0 - red, red * 0.5];
        MipMap::from_floats([2, 2], 4, [0.1, 0.2, 0.3, 0.4].map(texel).concat()).map(Arc::new).ok_or_else(String::new)
    }
}

/// Color of a texture that names no other.
pub fn color(texture: &AnyTexture, at: &TextureLookup) -> Rgb {
    texture.check().unwrap();
    let (table, errors) = TextureTable::compile([("t".to_owned(), texture.clone())], &TestImages);
    assert!(errors.is_empty(), "{errors:?}");
    table.color(&table.resolve("t", &Input::Texture("t".into())).unwrap(), at)
}

/// Texture in JSON as a function of the lookup.
pub fn reader(json: &str) -> impl Fn(&TextureLookup) -> Rgb + use<> {
    let texture: AnyTexture = serde_json::from_str(json).unwrap();
    texture.check().unwrap();
    let (table, errors) = TextureTable::compile([("t".to_owned(), texture)], &TestImages);
    assert!(errors.is_empty(), "{errors:?}");
    let slot = table.resolve("t", &Input::Texture("t".into())).unwrap();
    move |at| table.color(&slot, at)
}

/// Texture in JSON as a number at points in world space, with a footprint.
pub fn numbers(json: &str) -> impl Fn(Vec3, f32) -> f32 + use<> {
    let read = reader(json);
    move |world, footprint| read(&TextureLookup { world, footprint, ..TextureLookup::default() }).g
}

/// Checks that the mean over random points in world space equals the value under a footprint beyond
/// all detail.
pub fn keeps_its_mean(json: &str, tolerance: f64) {
    let read = numbers(json);
    let mut random = Random::new(73);
    let count = 20_000;
    let unfiltered = (0..count).map(|_| f64::from(read(random.point(200.0), 0.0))).sum::<f64>() / f64::from(count);
    let far = f64::from(read(Vec3::new(0.3, 0.7, -0.2), 1e4));
    assert!((unfiltered - far).abs() < tolerance, "{json}: {unfiltered} sharp, {far} from afar");
}

#[test]
fn colors_are_finite_everywhere() {
    let mut random = Random::new(72);
    for texture in AnyTexture::examples() {
        texture.check().unwrap();
        for size in [0.0, 1e-20, 1.0, 1e6, 1e15, 1e30, 1e38] {
            for footprint in [0.0, 1e-3, 1.0, 1e30, f32::INFINITY, f32::NAN] {
                let at = TextureLookup {
                    uv: (random.vec2() - 0.5) * size,
                    local: random.point(size),
                    world: random.point(size),
                    normal: random.unit_vector(),
                    local_normal: random.unit_vector(),
                    footprint,
                    local_footprint: footprint,
                    uv_footprint: footprint,
                    unfiltered: false,
                    mesh: None,
                };
                assert!(color(&texture, &at).is_finite(), "{texture:?} {at:?}");
            }
        }
        let nowhere = Vec3::new(f32::NAN, f32::INFINITY, 0.0);
        let at = TextureLookup { uv: Vec2::NAN, local: nowhere, world: nowhere, ..TextureLookup::default() };
        assert!(color(&texture, &at).is_finite(), "{texture:?}");
    }
}

#[test]
fn json_round_trips_and_every_kind_has_defaults() {
    for texture in AnyTexture::examples() {
        let text = serde_json::to_string(&texture).unwrap();
        assert_eq!(serde_json::from_str::<AnyTexture>(&text).unwrap(), texture, "{text}");
    }
}

/// Every color in a texture's description may be the name of another texture.
#[test]
fn colors_of_a_kind_may_be_textures() {
    let gray = || ("grey".to_owned(), serde_json::from_str::<AnyTexture>(r#"{"constant": {"color": 0.25}}"#).unwrap());
    let mut checked = 0;
    for texture in AnyTexture::examples() {
        let mut json = serde_json::to_value(&texture).unwrap();
        let members = json.as_object_mut().unwrap().values_mut().next().unwrap().as_object_mut().unwrap();
        let mut named = 0;
        let places = ["offset", "rotate_degrees", "start", "end"];
        for (_, value) in members.iter_mut().filter(|(key, _)| !places.contains(&key.as_str())) {
            let is_color = value.as_array().is_some_and(|v| v.len() == 3);
            let read = |value: &serde_json::Value| serde_json::from_value::<Input<Rgb>>(value.clone());
            if is_color && matches!(read(value), Ok(Input::Value(_))) {
                *value = "grey".into();
                named += 1;
            }
        }
        let Ok(texture) = serde_json::from_value::<AnyTexture>(json) else { continue };
        let (table, errors) = TextureTable::compile([gray(), ("t".into(), texture)], &TestImages);
        assert!(errors.is_empty(), "{errors:?}");
        checked += usize::from(named >= 2 && table.names().count() == 2);
    }
    assert!(checked >= 8, "{checked} kinds take textures");
}

#[test]
fn tables_look_names_up() {
    let examples = [r#"{"checker": {}}"#, r#"{"uv": {}}"#, r#"{"noise": {}}"#, r#"{"gradient": {}}"#];
    let examples = examples.map(|json| serde_json::from_str::<AnyTexture>(json).unwrap());
    let table = TextureTable::new(examples.into_iter().enumerate().map(|(i, t)| (format!("t{i}"), t)));
    assert!(table.names().eq(["t0", "t1", "t2", "t3"]));
    let at = TextureLookup { uv: Vec2::new(0.5, 0.25), ..TextureLookup::default() };
    let slot = table.resolve("diffuse", &Input::Texture("t3".into())).unwrap();
    assert_eq!(table.color(&slot, &at), Rgb::splat(0.25));
    let slot = table.resolve::<f32>("specular", &Input::Texture("t3".into())).unwrap();
    assert!((table.number(&slot, &at) - 0.25).abs() < 1e-6);
    assert_eq!(table.resolve("x", &Input::Value(3.0)).unwrap(), Slot::Value(3.0));
    let unknown = InputError::Unknown(UnknownTexture { field: "diffuse", name: "t9".into() });
    assert_eq!(table.resolve::<Rgb>("diffuse", &Input::Texture("t9".into())), Err(unknown.clone()));
    assert_eq!(table.resolve("diffuse", &Input::product("t9", Rgb::WHITE)), Err(unknown));
}

#[test]
fn solid_patterns_lie_in_object_space_unless_the_scene_says_otherwise() {
    let mut random = Random::new(75);
    let mut lookup = || {
        let uv = random.point(1.0).truncate();
        TextureLookup { uv, local: random.point(9.0), world: random.point(9.0), ..TextureLookup::default() }
    };
    let places: Vec<TextureLookup> = (0..50).map(|_| lookup()).collect();
    let colors = |kind: &str, settings: &str| -> Vec<Rgb> {
        let read = reader(&format!(r#"{{"{kind}": {{{settings}}}}}"#));
        places.iter().map(read).collect()
    };
    for (kind, solid) in [
        ("noise", true),
        ("fbm", true),
        ("turbulence", true),
        ("marble", true),
        ("wood", true),
        ("voronoi", true),
        ("brick", false),
        ("dots", false),
        ("wave", false),
    ] {
        let [uv, local] = ["uv", "local"].map(|space| colors(kind, &format!(r#""space": "{space}""#)));
        assert_ne!(uv, local, "{kind}");
        assert_eq!(colors(kind, ""), if solid { local } else { uv }, "{kind}");
    }
}
