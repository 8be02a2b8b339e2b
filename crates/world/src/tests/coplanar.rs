//! Receivers in the plane of an emitter: light sampling excludes the emitter there, and so does its
//! density, whatever the rounding errors.

use super::*;
use juggler_material::AnyMaterial;

/// A tilted emissive rectangle that emits from both sides.
fn emissive(transform: Transform) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let material: AnyMaterial = serde_json::from_str(r#"{"emissive": {"sides": "both"}}"#).unwrap();
    let material = compiler.compile(&material).unwrap();
    let mut rectangle: AnyShape = serde_json::from_str(r#"{"rectangle": {"size": [2, 2]}}"#).unwrap();
    rectangle.prepare().unwrap();
    let objects = vec![Object::new(rectangle, transform, material)];
    World::new(
        objects,
        compiler.finish().unwrap(),
        NO_LIGHTS,
        AnyBackground::Solid(Solid::default()),
        &BuildControl::default(),
    )
    .unwrap()
}

#[test]
fn emitters_have_no_density_in_their_own_plane() {
    let mut random = Random::new(431);
    for _ in 0..200 {
        let transform = random.transform().then(&Transform::translation(random.point(5.0)));
        let world = emissive(transform);
        let [center, aside] = [[0.2, 0.3], [3.0, -1.0]].map(|[x, z]| transform.point(Vec3::new(x, 0.0, z)));
        let normal = transform.normal(Vec3::Y);
        // Hit the emitter from the front.
        let mut ray = Ray::new(center + normal, -normal);
        let hit = world.closest(&mut ray);
        let vertex = world.vertex(&ray, &hit);
        let error = 1e-5 * (aside.abs().max_element() + center.abs().max_element());
        // The rounding errors of the receiver put it on either side of the plane.
        for (height, is_lit) in [(0.0, false), (0.9 * error, false), (-0.9 * error, false), (0.5, true), (-0.5, true)] {
            let context = LightSampleContext { point: aside + normal * height, error, normal: Vec3::ZERO, time: 0.0 };
            let density = world.light_pdf(&context, &vertex);
            assert_eq!(density > 0.0, is_lit, "{density} at {height}");
            let samples = (0..20).filter_map(|_| world.sample_light(&context, random.vec2()));
            assert_eq!(samples.count() > 0, is_lit, "samples at {height}");
        }
    }
}
