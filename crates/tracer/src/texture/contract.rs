//! What every texture must keep.

use super::*;
use juggler_math::testing::Random;

#[test]
fn colours_are_finite_everywhere() {
    let mut random = Random::new(72);
    for texture in AnyTexture::examples() {
        texture.check().unwrap();
        for size in [0.0, 1e-20, 1.0, 1e6, 1e15] {
            let at = Lookup { uv: random.vec2() * size, local: random.point(size), world: random.point(size) };
            assert!(texture.eval(&at).is_finite(), "{texture:?} {at:?}");
        }
    }
}

#[test]
fn json_goes_round() {
    for texture in AnyTexture::examples() {
        let text = serde_json::to_string(&texture).unwrap();
        assert_eq!(serde_json::from_str::<AnyTexture>(&text).unwrap(), texture, "{text}");
    }
}

#[test]
fn tables_look_names_up() {
    let table = TextureTable::new(AnyTexture::examples().into_iter().enumerate().map(|(i, t)| (format!("t{i}"), t)));
    assert!(table.names().eq(["t0", "t1", "t2", "t3", "t4"]));
    let at = Lookup { uv: Vec2::new(0.5, 0.25), ..Lookup::default() };
    let slot = table.resolve("diffuse", &Input::Texture("t3".into())).unwrap();
    assert_eq!(table.color(&slot, &at), Rgb::splat(0.25));
    let slot = table.resolve::<f32>("specular", &Input::Texture("t3".into())).unwrap();
    assert!((table.number(&slot, &at) - 0.25).abs() < 1e-6);
    assert_eq!(table.resolve("x", &Input::Value(3.0)).unwrap(), Slot::Value(3.0));
    let error = table.resolve::<Rgb>("diffuse", &Input::Texture("t9".into())).unwrap_err();
    assert_eq!((error.field, error.name.as_str()), ("diffuse", "t9"));
}
