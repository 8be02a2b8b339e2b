//! Worlds of so few spheres that rays test them without a hierarchy.

use super::*;

/// `count` spheres that overlap, two of which are the same, and meshes that are merged.
fn objects(random: &mut Random, count: usize) -> Vec<Object> {
    let sphere = |center: Vec3, radius: f32| {
        Object::new(Sphere { radius }.into(), Transform::translation(center), MaterialId(0))
    };
    let mut objects: Vec<Object> = (1..count).map(|_| sphere(random.point(2.0), 0.2 + random.f32())).collect();
    objects.extend(objects.first().cloned());
    for _ in 0..2 {
        let corners = [(); 3].map(|()| random.point(4.0)).to_vec();
        let mut mesh = AnyShape::from(Mesh::from_triangles(corners, vec![[0, 1, 2]]));
        mesh.prepare().unwrap();
        objects.push(Object::new(mesh, Transform::IDENTITY, MaterialId(0)));
    }
    objects
}

/// Rays that start inside of the spheres and outside, with and without an end.
fn rays(random: &mut Random) -> Vec<Ray> {
    let ray = |i: usize| {
        let origin = random.point(if i.is_multiple_of(2) { 5.0 } else { 1.0 });
        let direction = (random.point(1.0) - origin).normalize_or(Vec3::X);
        let end = 6.0 * random.f32();
        Ray::new(origin, direction).with_t_max(if i.is_multiple_of(3) { end } else { f32::INFINITY })
    };
    (0..2000).map(ray).collect()
}

/// Hits, shortened rays and transmittances.
fn found(world: &World, rays: &[Ray], is_packet: bool) -> (Vec<WorldHit>, Vec<Ray>, Vec<Rgb>) {
    let (mut ended, mut hits) = (rays.to_vec(), vec![WorldHit::NONE; rays.len()]);
    let mut transmittance = vec![Rgb::BLACK; rays.len()];
    if is_packet {
        world.closest_packet(&mut ended, &mut hits);
        world.transmittance_packet(rays, ShadowMode::Physical, &mut transmittance);
    } else {
        world.closest_batch(&mut ended, &mut hits);
        world.transmittance_batch(rays, ShadowMode::Physical, &mut transmittance);
    }
    (hits, ended, transmittance)
}

/// More spheres far away bring the hierarchy back, which must find the same hits.
#[test]
fn few_spheres_are_hit_as_in_a_hierarchy() {
    let mut random = Random::new(31);
    for count in [0, 2, 3, 4] {
        let near = objects(&mut random, count);
        let far = (1..6_u8).map(|i| {
            let place = Transform::translation(Vec3::new(0.0, 1e6 * f32::from(i), 0.0));
            Object::new(Sphere { radius: 1.0 }.into(), place, MaterialId(0))
        });
        let (few, many) = (world_of(near.clone()), world_of(near.iter().cloned().chain(far).collect()));
        assert!(few.top.has_few_spheres && !many.top.has_few_spheres);
        let rays = rays(&mut random);
        for is_packet in [false, true] {
            assert_eq!(found(&few, &rays, is_packet), found(&many, &rays, is_packet), "{count} spheres");
        }
        let hits = found(&few, &rays, false).0.iter().filter(|hit| hit.is_some()).count();
        assert!((20..2000).contains(&hits), "{hits} hits of {count} spheres");
    }
}
