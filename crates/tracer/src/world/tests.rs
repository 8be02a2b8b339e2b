//! The world's answers against asking every object in turn.

use super::*;
use crate::background::Solid;
use crate::material::{Checkerboard, MaterialCompiler, MaterialRef, Resolver};
use crate::texture::TextureTable;
use juggler_math::testing::Random;

/// Every kind of shape, each several times, turned, sheared and moved.
fn crowd(random: &mut Random) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let material = compiler.material("material", &MaterialRef::default()).unwrap();
    let mut objects = Vec::new();
    for _ in 0..6 {
        for mut shape in AnyShape::examples() {
            shape.prepare().unwrap();
            let extent = shape.bounds().extent().max_element();
            if extent.is_finite() && extent > 50.0 {
                continue;
            }
            let place = Transform::translation(random.point(20.0));
            objects.push(Object { shape, transform: random.transform().then(&place), material });
        }
    }
    World::new(objects, compiler.finish().unwrap(), Vec::new(), AnyBackground::Solid(Solid::default()))
}

fn brute_force(world: &World, ray: &Ray) -> WorldHit {
    let mut best = WorldHit::NONE;
    for (number, placed) in world.objects.iter().enumerate() {
        let Some(hit) = placed.intersect(&ray.up_to(best.hit.t.min(ray.t_max))) else { continue };
        let object = number as u32;
        if hit.t < best.hit.t || (hit.t == best.hit.t && object < best.object) {
            best = WorldHit { hit, object };
        }
    }
    best
}

#[test]
fn hierarchy_equals_brute_force_one_by_one_in_batches_and_in_packets() {
    let mut random = Random::new(17);
    let world = crowd(&mut random);
    let mut met = 0;
    for round in 0..300 {
        let origin = random.point(40.0);
        let axis = random.unit_vector();
        let spread = if round % 2 == 0 { 0.02 } else { 2.0 };
        let rays: Vec<Ray> = (0..8)
            .map(|_| Ray::new(origin, (axis + random.unit_vector() * spread).normalize_or(axis)))
            .map(|ray| if round % 3 == 0 { ray.up_to(30.0) } else { ray })
            .collect();
        let expected: Vec<WorldHit> = rays.iter().map(|ray| brute_force(&world, ray)).collect();
        met += expected.iter().filter(|hit| hit.is_some()).count();
        let mut hits = vec![WorldHit::NONE; 8];
        world.closest_packet(&mut rays.clone(), &mut hits);
        assert_eq!(hits, expected, "packet, round {round}");
        world.closest_batch(&mut rays.clone(), &mut hits);
        assert_eq!(hits, expected, "batch, round {round}");
        let alone: Vec<WorldHit> = rays.iter().map(|ray| world.closest(&mut ray.clone())).collect();
        assert_eq!(alone, expected, "single, round {round}");
        let open: Vec<Rgb> = expected.iter().map(|h| if h.is_some() { Rgb::BLACK } else { Rgb::WHITE }).collect();
        let mut through = vec![Rgb::BLACK; 8];
        world.transmittance_packet(&rays, &mut through);
        assert_eq!(through, open, "shadow packet, round {round}");
        world.transmittance_batch(&rays, &mut through);
        assert_eq!(through, open, "shadow batch, round {round}");
    }
    assert!(met > 500, "only {met} rays met anything");
}

#[test]
fn an_empty_world_is_empty() {
    let world =
        World::new(Vec::new(), MaterialTable::default(), Vec::new(), AnyBackground::Solid(Solid { color: Rgb::WHITE }));
    let mut ray = Ray::new(Vec3::ZERO, Vec3::Z);
    assert!(!world.closest(&mut ray).is_some());
    assert_eq!(world.background(&ray), Rgb::WHITE);
    assert!(world.bounds().is_empty());
}

/// A world of one object, plain or with a material that asks for surface coordinates.
pub fn world_of(shape: AnyShape, transform: Transform, textured: bool) -> World {
    let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
    let recipe = if textured { MaterialRef::from(Checkerboard::default()) } else { MaterialRef::default() };
    let material = compiler.material("material", &recipe).unwrap();
    let objects = vec![Object { shape, transform, material }];
    World::new(objects, compiler.finish().unwrap(), Vec::new(), AnyBackground::Solid(Solid::default()))
}
