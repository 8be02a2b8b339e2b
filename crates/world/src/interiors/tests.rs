//! Points inside and outside of solids.

use super::*;
use crate::Object;
use juggler_light::AnyLight;
use juggler_light::background::{AnyBackground, Solid};
use juggler_material::MaterialCompiler;
use juggler_math::Transform;
use juggler_math::testing::Random;
use juggler_texture::TextureTable;

const SPHERE: &str = r#"{"sphere": {"radius": 2}}"#;
const ROOM: &str = r#"{"cuboid": {"min": [-5, -5, -5], "max": [5, 5, 5]}}"#;
const FOG: &str = r#"{"boundary": {"medium": {"scattering": 0.1}}}"#;
const GLASS: &str = r#"{"dielectric": {"ior": 1.5}}"#;

fn world(objects: &[(&str, Transform, &str)]) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let object = |(shape, place, material): &(&str, Transform, &str)| {
        let mut shape: juggler_shape::AnyShape = serde_json::from_str(shape).unwrap();
        shape.prepare().unwrap();
        let material = compiler.compile(&serde_json::from_str(material).unwrap()).unwrap();
        Object::new(shape, *place, material)
    };
    let objects = objects.iter().map(object).collect();
    let background = AnyBackground::Solid(Solid::default());
    World::new(
        objects,
        compiler.finish().unwrap(),
        Vec::<AnyLight>::new(),
        background,
        &juggler_math::BuildControl::default(),
    )
    .unwrap()
}

fn at(place: Vec3) -> Transform {
    Transform::translation(place)
}

fn ids(world: &World, place: Vec3) -> Interiors {
    world.interiors_at(place, 0.5)
}

#[test]
fn interiors_of_a_point_are_the_solids_around_it() {
    let metal = r#"{"phong": {}}"#;
    let objects = [
        (ROOM, at(Vec3::ZERO), FOG),
        (SPHERE, at(Vec3::ZERO), GLASS),
        (SPHERE, at(Vec3::Z * 30.0), metal),
        (r#"{"plane": {}}"#, at(Vec3::Y * -20.0), GLASS),
    ];
    let world = world(&objects);
    let [room, sphere, _, sea] = [0, 1, 2, 2].map(|place| InteriorId::new(place).unwrap());
    let mut random = Random::new(817);
    for _ in 0..300 {
        let place = random.point(24.0);
        let in_room = place.abs().max_element() < 4.99;
        let mut expected = Interiors::NONE;
        if place.y < -20.01 {
            expected = expected.entered(sea);
        } else if place.y < -19.99 {
            continue;
        }
        if in_room {
            expected = expected.entered(room);
        } else if place.abs().max_element() < 5.01 {
            continue;
        }
        if place.length() < 1.99 {
            expected = expected.entered(sphere);
        } else if place.length() < 2.01 {
            continue;
        }
        assert_eq!(ids(&world, place), expected, "{place}");
    }
    assert!(ids(&world, Vec3::ZERO) == Interiors::NONE.entered(room).entered(sphere));
    assert!(ids(&world, Vec3::Z * 30.0).is_empty());
}

#[test]
fn interiors_are_found_within_open_surfaces() {
    let open = r#"{"cylinder": {"radius": 3, "y_min": -2, "y_max": 2, "capped": false}}"#;
    let world = world(&[(open, at(Vec3::ZERO), FOG), (SPHERE, at(Vec3::X * 40.0), GLASS)]);
    let fog = Interiors::NONE.entered(InteriorId::new(0).unwrap());
    for (place, expected) in [(Vec3::ZERO, fog), (Vec3::Y, fog), (Vec3::Y * 9.0, Interiors::NONE)] {
        assert_eq!(ids(&world, place), expected, "{place}");
    }
}

#[test]
fn points_below_a_rotated_plane_are_inside_it() {
    let mut random = Random::new(823);
    for _ in 0..50 {
        let turn = random.rotation();
        let normal = turn.vector(Vec3::Y);
        let world = world(&[(r#"{"plane": {}}"#, turn, GLASS)]);
        assert!(!ids(&world, normal * -3.0).is_empty() && ids(&world, normal * 3.0).is_empty(), "{normal}");
    }
}
