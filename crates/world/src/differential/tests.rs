//! Compares densities, tangents and footprints with finite differences on the surface.

use super::*;
use crate::tests::world_with;
use crate::{Object, SceneLight};
use juggler_light::background::{AnyBackground, Solid};
use juggler_material::MaterialCompiler;
use juggler_math::testing::{Random, close, close3};
use juggler_math::{Transform, Vec3};
use juggler_shape::{AnyShape, Rectangle, Sphere};
use juggler_texture::TextureTable;
use std::f32::consts::PI;

fn hit_point(world: &World, ray: Ray) -> Option<(Vertex, SurfaceDifferential)> {
    let mut found = ray;
    let hit = world.closest(&mut found);
    let vertex = hit.is_some().then(|| world.vertex(&ray, &hit))?;
    Some((vertex, world.differential(&ray, &hit, &vertex)?))
}

#[test]
fn footprints_cover_the_area_that_a_cone_cuts_out() {
    let shape = AnyShape::from(Rectangle { size: [4.0, 1.0] });
    let world = world_with(shape.clone(), Transform::scale(Vec3::splat(3.0)).unwrap(), true);
    let direction = Vec3::new(0.6, -0.8, 0.0);
    let mut ray = Ray::new(direction * -5.0, direction);
    let hit = world.closest(&mut ray);
    let mut vertex = world.vertex(&ray, &hit);
    assert_eq!(vertex.surface.footprint, Footprint::default());
    world.ray_differentials(&ray, &hit, 0.1, &mut vertex);
    let Footprint { world: wide, local, uv } = vertex.surface.footprint;
    assert!(close(wide, 0.1 / 0.8f32.sqrt(), 1e-6) && close(local, wide / 3.0, 1e-6) && close(uv, wide / 6.0, 1e-6));
    let plain = world_with(shape, Transform::IDENTITY, false);
    let mut vertex = plain.vertex(&ray, &hit);
    plain.ray_differentials(&ray, &hit, 0.1, &mut vertex);
    assert_eq!(vertex.surface.footprint, Footprint::default());
}

#[test]
fn densities_relate_uv_and_object_space_to_world_space() {
    let shape = AnyShape::from(Rectangle { size: [4.0, 1.0] });
    let world = world_with(shape, Transform::scale(Vec3::splat(3.0)).unwrap(), true);
    let (_, found) = hit_point(&world, Ray::new(Vec3::new(0.5, 7.0, 0.2), Vec3::NEG_Y)).unwrap();
    assert!(close3(found.derivatives.u, Vec3::X * 12.0, 1e-5) && close3(found.derivatives.v, Vec3::Z * -3.0, 1e-5));
    assert!(close(found.uv_density, 1.0 / 6.0, 1e-6) && close(found.local_density, 1.0 / 3.0, 1e-6), "{found:?}");
}

#[test]
fn materials_with_maps_get_tangents() {
    for (recipe, asks) in [("normal_map", true), ("bump_map", true), ("diffuse", false)] {
        let recipe = serde_json::from_str(&format!(r#"{{"{recipe}": {{}}}}"#)).unwrap();
        let mut compiler = MaterialCompiler::new(TextureTable::default(), []);
        let material = compiler.compile(&recipe).unwrap();
        let objects = vec![Object::new(Sphere { radius: 2.0 }.into(), Transform::IDENTITY, material)];
        let lights = Vec::<SceneLight>::new();
        let world = World::new(
            objects,
            compiler.finish().unwrap(),
            lights,
            AnyBackground::Solid(Solid::default()),
            &juggler_math::BuildControl::default(),
        )
        .unwrap();
        let mut ray = Ray::new(Vec3::X * 9.0, Vec3::NEG_X);
        let hit = world.closest(&mut ray);
        let tangents = world.vertex(&ray, &hit).tangents;
        assert_eq!(tangents.is_some(), asks);
        let along_u = Vec3::NEG_Z * 4.0 * PI;
        assert!(tangents.is_none_or(|t| close3(t.u, along_u, 1e-4) && close3(t.local_u, along_u, 1e-4)));
    }
}

/// Finite differences on a rotated, scaled and translated sphere, and on an ellipsoid.
#[test]
fn world_space_derivatives_equal_finite_differences() {
    let mut random = Random::new(751);
    let turned = random.rotation();
    for scale in [Vec3::splat(2.5), Vec3::new(1.0, 2.0, 0.5)] {
        let transform = Transform::scale(scale).unwrap().then(&turned);
        let world = world_with(Sphere { radius: 2.0 }.into(), transform, true);
        let mut checked = 0;
        for _ in 0..300 {
            let from = random.unit_vector() * 50.0;
            let aim = |at: Vec3| Ray::new(from, (at - from).normalize());
            let Some((start, found)) = hit_point(&world, aim(random.point(1.0))) else { continue };
            let offset = random.unit_vector().reject_from(start.surface.normal) * 2e-3;
            let Some((end, _)) = hit_point(&world, aim(start.surface.point + offset)) else { continue };
            let (step, uv) = (end.surface.point - start.surface.point, end.surface.uv - start.surface.uv);
            if uv.x.abs() > 0.5 || found.derivatives.u.length() < 2.0 || step.length() > 5e-3 {
                continue;
            }
            checked += 1;
            let predicted = found.derivatives.u * uv.x + found.derivatives.v * uv.y;
            assert!((predicted - step).length() < 0.1 * step.length() + 2e-5, "{step}, predicted {predicted}");
        }
        assert!(checked > 50, "{checked}");
    }
    // At a sphere's equator one unit of u is the circumference, and one unit of v half of it.
    let world = world_with(Sphere { radius: 2.0 }.into(), Transform::IDENTITY, true);
    let (_, found) = hit_point(&world, Ray::new(Vec3::X * 9.0, Vec3::NEG_X)).unwrap();
    assert!(close3(found.derivatives.u, Vec3::NEG_Z * 4.0 * PI, 1e-4), "{found:?}");
    assert!(close3(found.derivatives.v, Vec3::Y * 2.0 * PI, 1e-4) && close(found.local_density, 1.0, 1e-5));
}
