//! Tests of ray cones: image textures are smooth from afar and sharp from nearby, directly and in
//! mirrors.

use super::*;
use juggler_math::testing::Random;
use std::sync::Arc;

/// Random black and white texels.
struct Noise;

impl Images for Noise {
    fn image(&self, _texture: &str, _image: &Image) -> Result<Arc<MipMap>, String> {
        let mut random = Random::new(911);
        let numbers = (0..256 * 256).map(|_| random.f32().round()).collect();
        Ok(Arc::new(MipMap::from_floats([256, 256], 1, numbers).unwrap()))
    }
}

/// A floor that emits by a texture repeated every unit, and a mirror far above it.
fn floor(texture: &str) -> World {
    let named = [("noise".to_owned(), read(texture))];
    let (textures, wrong) = TextureTable::compile(named, &Noise);
    assert!(wrong.is_empty());
    let mut compiler = MaterialCompiler::new(textures, []);
    let mut plane = |place: f32, material: &str| {
        let mut plane: AnyShape = read(r#"{"plane": {}}"#);
        plane.prepare().unwrap();
        let material = compiler.compile(&read::<AnyMaterial>(material)).unwrap();
        Object::new(plane, Transform::translation(Vec3::Y * place), material)
    };
    let emissive = r#"{"phong": {"diffuse": 0, "emission": "noise"}}"#;
    let mirror = r#"{"phong": {"diffuse": 0, "reflection": 1}}"#;
    let objects = vec![plane(0.0, emissive), plane(100.0, mirror)];
    let background = AnyBackground::Solid(Solid { color: Rgb::BLACK });
    World::new(
        objects,
        compiler.finish().unwrap(),
        Vec::<AnyLight>::new(),
        background,
        &juggler_math::BuildControl::default(),
    )
    .unwrap()
}

/// Mean absolute difference of the pixels from 1/2.
fn contrast(world: &World, integrator: &AnyIntegrator, eye: Vec3, aim: Vec3) -> f32 {
    let size = UVec2::new(12, 12);
    let camera = look(eye, aim, "30", size);
    let pixels = pixels(world, &camera, integrator, size, 1);
    pixels.iter().map(|pixel| (pixel.g - 0.5).abs()).sum::<f32>() / pixels.len() as f32
}

#[test]
fn mip_mapped_textures_are_smooth_from_afar_and_sharp_nearby() {
    let world = floor(r#"{"image": {"file": "noise"}}"#);
    let sharp = floor(r#"{"image": {"file": "noise", "filter": "bilinear"}}"#);
    let (far, near) = (Vec3::new(0.3, 50.0, 0.3), Vec3::new(0.3, 0.02, 0.3));
    let aside = Vec3::new(0.0, 0.0, 0.01);
    for integrator in [AnyIntegrator::from(Classic::default()), juggler_integrator::Path::default().into()] {
        let seen = |world: &World, eye: Vec3, aim: Vec3| contrast(world, &integrator, eye, aim);
        let down = far - Vec3::Y + aside;
        assert!(seen(&world, far, down) < 0.02 && seen(&sharp, far, down) > 0.1);
        let down = near - Vec3::Y + aside;
        assert!(seen(&world, near, down) > 0.1);
        assert_eq!(seen(&world, near, down), seen(&sharp, near, down));
        // Through the mirror, up and down again.
        let up = near + Vec3::Y + aside;
        assert!(seen(&world, near, up) < 0.02 && seen(&sharp, near, up) > 0.1);
    }
}

/// The path integrator filters procedural textures; the classic integrator keeps them sharp, even
/// beside image textures.
#[test]
fn only_the_path_integrator_filters_procedural_textures() {
    let world = floor(r#"{"noise": {"space": "world", "scale": 200}}"#);
    let (far, aim) = (Vec3::new(0.3, 50.0, 0.3), Vec3::new(0.3, 0.0, 0.2));
    let path = contrast(&world, &juggler_integrator::Path::default().into(), far, aim);
    let classic = contrast(&world, &Classic::default().into(), far, aim);
    assert!(path < 0.01 && classic > 0.05, "{path} {classic}");
}
