//! Attributes, second surface coordinates and tangents of meshes, through instances.

use super::*;
use juggler_math::testing::{close, close3};
use juggler_math::{Rgb, Vec2};
use juggler_shape::attribute::{AttributeData, AttributeDomain, MeshAttribute};
use juggler_texture::AnyTexture;
use std::collections::BTreeMap;

/// One triangle over (0, 0), (1, 0), (0, 1) of x and -z, front up, whose tangents lie along z and
/// not along u.
fn triangle(sign: f32) -> Mesh {
    let color = MeshAttribute {
        channels: 3,
        data: AttributeData::U16([65535, 0, 0, 0, 65535, 0, 0, 0, 65535].into()),
        ..Default::default()
    };
    Mesh::from_triangles([Vec3::ZERO, Vec3::X, Vec3::NEG_Z], [[0, 1, 2]])
        .with_normals([Vec3::Y; 3])
        .with_uvs([Vec2::ZERO, Vec2::X, Vec2::Y])
        .with_uvs1([Vec2::splat(0.5), Vec2::new(0.75, 0.5), Vec2::new(0.5, 0.75)])
        .with_tangents([[0.0, 0.0, -5.0, sign]; 3])
        .with_attribute("color", color)
}

/// World of the mesh in an instance, with this material and the texture `t`.
fn world(mesh: Mesh, transform: Transform, texture: &str, material: &str) -> World {
    let mut mesh = AnyShape::from(mesh);
    mesh.prepare().unwrap();
    let textures: BTreeMap<String, AnyTexture> = serde_json::from_str(&format!(r#"{{"t": {texture}}}"#)).unwrap();
    let mut compiler = MaterialCompiler::new(TextureTable::new(textures), []);
    let material = compiler.compile(&serde_json::from_str(material).unwrap()).unwrap();
    let half = Transform::scale(Vec3::splat(0.5)).unwrap();
    let geometry = Geometry::new(
        vec![Object { content: Content::Shape(Arc::new(mesh)), motion: half.into(), material: None, attributes: None }],
        &BuildControl::default(),
    )
    .unwrap();
    let object = Object {
        content: Content::Geometry(Arc::new(geometry)),
        motion: transform.into(),
        material: Some(material),
        attributes: None,
    };
    World::new(
        vec![object],
        compiler.finish().unwrap(),
        NO_LIGHTS,
        AnyBackground::Solid(Solid::default()),
        &BuildControl::default(),
    )
    .unwrap()
}

/// Vertex at barycentrics (0.25, 0.5), seen along its normal.
fn vertex(world: &World, transform: &Transform) -> Vertex {
    let (at, normal) = (transform.point(Vec3::new(0.125, 0.0, -0.25)), transform.normal(Vec3::Y));
    let mut ray = Ray::new(at + normal, -normal);
    let hit = world.closest(&mut ray);
    assert!(hit.is_some());
    world.vertex(&ray, &hit)
}

#[test]
fn attributes_reach_materials_of_instances() {
    let transform = Transform::scale(Vec3::new(-3.0, 2.0, 1.0)).unwrap();
    let found = world(triangle(1.0), transform, r#"{"attribute": {}}"#, r#"{"phong": {"diffuse": "t"}}"#);
    let vertex = vertex(&found, &transform);
    let color = found.phong(&vertex).unwrap().diffuse;
    assert!(close3(Vec3::from(color.to_array()), Vec3::new(0.25, 0.25, 0.5), 1e-5), "{color:?}");
    let emission = found.shade(&vertex, Vec3::Y, 1.0, 0.5).emission;
    assert_eq!(emission, Rgb::BLACK);
    let emitter = world(triangle(1.0), transform, r#"{"attribute": {}}"#, r#"{"emissive": {"radiance": "t"}}"#);
    let emission = emitter.shade(&vertex, vertex.surface.normal, 1.0, 0.5).emission;
    assert!(close3(Vec3::from(emission.to_array()), Vec3::new(0.25, 0.25, 0.5), 1e-5), "{emission:?}");
}

/// World of a sphere in a geometry, each with attributes or not, and with a material of the texture
/// `attribute`.
fn sphere_world(inner: Option<InstanceAttributes>, outer: Option<InstanceAttributes>, material: &str) -> World {
    let materials = world(triangle(1.0), Transform::IDENTITY, r#"{"attribute": {}}"#, material).materials().clone();
    let mut sphere = AnyShape::from(Sphere { radius: 1.0 });
    sphere.prepare().unwrap();
    let motion = juggler_math::Motion::from(Transform::IDENTITY);
    let content = Content::Shape(Arc::new(sphere));
    let sphere = Object { content, motion: motion.clone(), material: None, attributes: inner };
    let content = Content::Geometry(Arc::new(Geometry::new(vec![sphere], &BuildControl::default()).unwrap()));
    let instance = Object { content, motion, material: Some(MaterialId(0)), attributes: outer };
    World::new(vec![instance], materials, NO_LIGHTS, AnyBackground::Solid(Solid::default()), &BuildControl::default())
        .unwrap()
}

/// The second of two instances, from red at v = 0 to this color at v = 1.
fn attributes([red, green, blue]: [f32; 3]) -> Option<InstanceAttributes> {
    let gray = [0.5, 0.5, 0.5, 1.0];
    let (colors, end_colors) = ([gray, [1.0, 0.0, 0.0, 1.0]].into(), [gray, [red, green, blue, 1.0]].into());
    let arrays = AttributeArrays { colors, end_colors, ..AttributeArrays::default() };
    Some(InstanceAttributes { list: Arc::new(AttributeList { arrays, outer: None }), index: 1 })
}

/// The second of two instances with an attribute of another name.
fn heat() -> Option<InstanceAttributes> {
    let heat = MeshAttribute { domain: AttributeDomain::Face, channels: 1, data: AttributeData::F32(vec![7.0; 2]) };
    let arrays = AttributeArrays { attributes: Arc::new([("heat".to_owned(), heat)].into()), ..Default::default() };
    Some(InstanceAttributes { list: Arc::new(AttributeList { arrays, outer: None }), index: 1 })
}

/// Instances give attributes to shapes without any: at a vertex, and to light samples of it. Those
/// of the innermost instance that has the name count, and are interpolated along v.
#[test]
fn instances_give_attributes_to_shapes() {
    let (green, blue) = ([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    let cases = [
        (attributes(green), None),
        (None, attributes(green)),
        (attributes(green), attributes(blue)),
        (attributes(green), heat()),
        (heat(), attributes(green)),
    ];
    for (inner, outer) in cases {
        let world = sphere_world(inner, outer, r#"{"emissive": {"radiance": "t"}}"#);
        for y in [-0.9_f32, 0.0, 0.5] {
            let normal = Vec3::new((1.0 - y * y).sqrt(), y, 0.0);
            let mut ray = Ray::new(normal * 2.0, -normal);
            let hit = world.closest(&mut ray);
            let vertex = world.vertex(&ray, &hit);
            let v = vertex.surface.uv.y;
            let expected = Vec3::new(1.0 - v, v, 0.0);
            let emission = world.shade(&vertex, normal, 1.0, 0.5).emission;
            assert!(close3(Vec3::from(emission.to_array()), expected, 1e-5), "{y}: {emission:?}, not {expected}");
        }
        let context = LightSampleContext { point: Vec3::new(2.0, 0.0, 0.0), error: 0.0, normal: Vec3::ZERO, time: 0.0 };
        let mut random = Random::new(5);
        for _ in 0..20 {
            let sample = world.sample_light(&context, Vec2::new(random.f32(), random.f32())).unwrap();
            let mut ray = Ray::new(context.point, sample.wi);
            let hit = world.closest(&mut ray);
            let seen = world.shade(&world.vertex(&ray, &hit), -sample.wi, 1.0, 0.5).emission;
            let (seen, sampled) = (Vec3::from(seen.to_array()), Vec3::from(sample.radiance.to_array()));
            assert!(close3(seen, sampled, 1e-3), "{seen} is seen, {sampled} sampled");
        }
    }
    let without = sphere_world(None, None, r#"{"emissive": {"radiance": "t"}}"#);
    assert!(!without.has_mesh_attributes);
}

#[test]
fn textures_use_the_second_set_with_its_footprint() {
    let transform = Transform::scale(Vec3::new(1.0, 1.0, 1.0)).unwrap();
    let found = world(triangle(1.0), transform, r#"{"uv": {"uv_set": 1}}"#, r#"{"phong": {"diffuse": "t"}}"#);
    let mut vertex = vertex(&found, &transform);
    let color = found.phong(&vertex).unwrap().diffuse;
    assert!(close3(Vec3::from(color.to_array()), Vec3::new(0.5625, 0.625, 0.0), 1e-5), "{color:?}");
    vertex.surface.footprint.uv = 0.2;
    let point = found.mesh_point(&vertex).unwrap();
    let at = juggler_texture::TextureLookup { uv_footprint: 0.2, mesh: Some(&point), ..Default::default() };
    assert!(close(at.second_uv().1, 0.05, 1e-6));
}

/// The pattern of a normal map sticks to the mesh: its directions are those of the tangent and of
/// w (N × T) in object space, transformed as vectors, also where the transform mirrors.
#[test]
fn normal_maps_follow_the_tangents_of_a_mesh() {
    let map = |x: f32, y: f32| {
        let material = r#"{"normal_map": {"texture": [X, Y, 0.9], "material": {"diffuse": {}}}}"#;
        material.replace('X', &(0.5 + 0.15 * x).to_string()).replace('Y', &(0.5 + 0.15 * y).to_string())
    };
    for sign in [1.0, -1.0] {
        // N × T for N = y and T = -z is -x.
        let (tangent, bitangent) = (Vec3::NEG_Z, Vec3::NEG_X * sign);
        for scale in [[1.0, 1.0, 1.0], [-1.0, 1.0, 1.0], [3.0, 0.5, -2.0], [-2.0, -1.0, -0.5]] {
            let turn = Transform::rotation(Vec3::new(1.0, 2.0, 3.0), 0.7).unwrap();
            let transform = Transform::scale(scale.into()).unwrap().then(&turn);
            for (x, y, expected) in [(1.0, 0.0, tangent), (0.0, 1.0, bitangent)] {
                let world = world(triangle(sign), transform, r#"{"constant": {}}"#, &map(x, y));
                let vertex = vertex(&world, &transform);
                let given = vertex.tangents.unwrap();
                assert!(given.given.is_some());
                let frame = world.shade(&vertex, vertex.surface.normal, 1.0, 0.5).frame;
                let expected = transform.vector(expected).normalize();
                // The mapped normal leans along the expected direction.
                let flat = frame.normal.reject_from_normalized(vertex.surface.normal).normalize();
                assert!(close3(flat, expected, 1e-4), "{sign} {scale:?} {flat} {expected}");
            }
        }
    }
}
