//! Order of nested transforms, and radii that change while the shutter is open.

use juggler_math::{Ray, Vec3};
use juggler_scene::Scene;
use juggler_world::World;
use std::sync::Arc;

fn world(members: &str) -> Arc<World> {
    Scene::from_json(format!(r#"{{"version": 1, {members}}}"#), "s.json").unwrap().compile().unwrap().world
}

/// Asserts the centers of all spheres and their common radius.
fn assert_spheres(world: &World, radius: f32, centers: &[[f32; 3]]) {
    for (shape, center) in (0..).zip(centers) {
        let bounds = world.shape_bounds(shape);
        assert!(bounds.center().abs_diff_eq(Vec3::from(*center), 1e-4), "{shape}: {bounds:?} for {center:?}");
        assert!((bounds.extent() * 0.5).abs_diff_eq(Vec3::splat(radius), 1e-3), "{shape}: {bounds:?}");
    }
}

/// Turns x into y, doubles, then moves.
const OUTER: &str = r#"[{"rotate": {"axis": [0, 0, 1], "degrees": 90}}, {"scale": 2}, {"translate": [10, 0, 0]}]"#;

#[test]
fn instances_come_before_the_transform_of_their_object() {
    let instances = r#"{"positions": [[1, 0, 0], [0, 3, 0]], "scales": [0.5, 0.5]}"#;
    let centers = [[10.0, 2.0, 0.0], [4.0, 0.0, 0.0]];
    let object =
        |content: &str| format!(r#""objects": [{{{content}, "transform": {OUTER}, "instances": {instances}}}]"#);
    assert_spheres(&world(&object(r#""shape": "sphere""#)), 1.0, &centers);
    let nested = object(r#""objects": [{"shape": "sphere"}]"#);
    assert_spheres(&world(&nested), 1.0, &centers);
    let group = format!(r#""groups": {{"one": [{{"shape": "sphere"}}]}}, {}"#, object(r#""group": "one""#));
    assert_spheres(&world(&group), 1.0, &centers);
}

#[test]
fn inner_transforms_come_before_outer_ones() {
    let inner = r#"{"shape": "sphere", "transform": [{"translate": [1, 0, 0]}]}"#;
    let nested = format!(r#""objects": [{{"objects": [{inner}], "transform": {OUTER}}}]"#);
    assert_spheres(&world(&nested), 2.0, &[[10.0, 2.0, 0.0]]);
    let group = format!(r#""groups": {{"one": [{inner}]}}, "objects": [{{"group": "one", "transform": {OUTER}}}]"#);
    assert_spheres(&world(&group), 2.0, &[[10.0, 2.0, 0.0]]);
}

/// Radius 1 when the shutter opens, 2 when it closes; a chain has a radius at each end.
#[test]
fn radii_change_while_the_shutter_is_open() {
    let shapes = [
        r#""shape": {"sphere": {"radius": "=1 + frame"}}"#,
        r#""chain": {"from": {"center": [0, 0, 0], "radius": "=1 + frame"},
            "to": {"center": [9, 0, 0], "radius": 0.1}, "count": 2}"#,
    ];
    for shape in shapes {
        let world = world(&format!(
            r#""animation": {{"frames": 4}}, "render": {{"shutter": [0, 1]}}, "objects": [{{{shape}}}]"#
        ));
        assert!(world.moves(), "{shape}");
        for time in [0.0, 0.25, 0.5, 1.0] {
            let mut ray = Ray { time, ..Ray::new(Vec3::Y * 8.0, -Vec3::Y) };
            assert!(world.closest(&mut ray).is_some(), "{shape}");
            let radius = 8.0 - ray.t_max;
            assert!((radius - (1.0 + time)).abs() < 1e-3, "{radius} at {time}: {shape}");
        }
    }
}
