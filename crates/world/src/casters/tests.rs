//! Which specular spheres take part in light sampling.

use super::MAX_CASTERS;
use crate::{Object, World};
use juggler_light::AnyLight;
use juggler_light::background::{AnyBackground, Solid};
use juggler_material::{AnyMaterial, MaterialCompiler};
use juggler_math::{Transform, Vec3};
use juggler_shape::{AnyShape, Sphere};
use juggler_texture::TextureTable;

/// A row of polished metal spheres with the given radii.
fn spheres(radii: &[f32]) -> World {
    let metal: AnyMaterial = serde_json::from_str(r#"{"conductor": {"reflectance": 0.9}}"#).unwrap();
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let metal = compiler.compile(&metal).unwrap();
    let place = |(i, &radius): (usize, &f32)| {
        let mut sphere: AnyShape = Sphere { radius }.into();
        sphere.prepare().unwrap();
        Object::new(sphere, Transform::translation(Vec3::X * (2.0 * i as f32)), metal)
    };
    let objects = radii.iter().enumerate().map(place).collect();
    let none: [AnyLight; 0] = [];
    World::new(
        objects,
        compiler.finish().unwrap(),
        none,
        AnyBackground::Solid(Solid::default()),
        &juggler_math::BuildControl::default(),
    )
    .unwrap()
}

#[test]
fn largest_spheres_are_kept_as_caustic_casters() {
    // All radii differ, and their order in the scene is neither rising nor falling.
    let mut radii: Vec<f32> = (0..40).map(|i| 0.1 + 0.01 * ((i * 17) % 40) as f32).collect();
    let world = spheres(&radii);
    radii.sort_by(|a, b| b.total_cmp(a));
    radii.truncate(MAX_CASTERS);
    let sampled: Vec<f32> = world.casters.iter().map(|caster| caster.sphere.radius).collect();
    assert_eq!(sampled.len(), radii.len());
    for (sampled, expected) in sampled.iter().zip(&radii) {
        assert!((sampled - expected).abs() < 1e-5, "{sampled}, not {expected}");
    }
}
