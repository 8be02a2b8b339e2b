//! Instanced groups: the same pictures as without instancing, in a fraction of the memory.

use juggler::camera::Perspective;
use juggler::integrator::IntegratorKind;
use juggler::material::Phong;
use juggler::math::{Vec2, Vec3};
use juggler::render::Control;
use juggler::scene::{Object, Scene};
use juggler::shape::{Mesh, MeshData, Sphere};
use juggler::{Error, Picture, Settings};

fn picture(scene: &Scene, integrator: IntegratorKind) -> Picture {
    let settings = Settings { integrator: Some(integrator), ..Settings::default() };
    Picture::new(scene, &settings).unwrap()
}

/// Hash of the linear pixels, and their mean.
fn hash(picture: &Picture) -> (String, [f64; 3]) {
    let rows = |_: &[_]| Ok::<(), Error>(());
    let summary = picture.render(Default::default(), &Control::default(), rows).unwrap();
    (summary.hash, summary.mean)
}

fn phong(red: f32, transparency: f32) -> Phong {
    let diffuse = juggler::math::Rgb::new(red, 0.5, 0.3).into();
    Phong { diffuse, transparency: juggler::math::Rgb::splat(transparency).into(), ..Phong::default() }
}

/// A floor of 64 × 48 copies of the groups in turn, 64 spheres each, translated by exactly
/// representable distances.
fn sphere_floor(groups: &[&str], transparency: f32) -> Scene {
    let sphere = |i: u16| {
        let sphere = Object::new(Sphere { radius: 0.25 }).at(f32::from(i % 8) * 0.5, 0.0, f32::from(i / 8) * 0.5);
        if i.is_multiple_of(3) { sphere.material(phong(0.9, transparency)) } else { sphere }
    };
    let camera = Perspective {
        eye: Vec3::new(128.0, 64.0, 64.0),
        look_at: Vec3::new(128.0, 0.0, -64.0).into(),
        ..Perspective::default()
    };
    let mut scene = Scene::new().size(64, 36).samples(1).camera("main", camera);
    for group in groups {
        scene = scene.group(*group, (0..64).map(sphere));
    }
    for i in 0..3072_u16 {
        let group = Object::group(groups[usize::from(i) % groups.len()]);
        let placed = group.at(f32::from(i % 64) * 4.0, 0.0, f32::from(i / 64) * -4.0);
        scene = scene.add(placed.material(phong(f32::from(i % 7) / 7.0, 0.0)));
    }
    scene
}

/// A group with many copies is instanced, while two groups with half as many copies each are not.
/// From this camera all differences are exact, so that instancing rounds nothing; shadow rays start
/// anywhere, so theirs are rounded.
#[test]
fn shared_and_expanded_groups_make_the_same_picture() {
    use IntegratorKind::{Albedo, Classic, Depth};
    for (integrator, transparency) in [(Albedo, 0.0), (Depth, 0.0), (Classic, 0.0), (Classic, 0.5)] {
        let scenes = [sphere_floor(&["a"], transparency), sphere_floor(&["a", "b"], transparency)];
        let pictures = scenes.map(|scene| picture(&scene, integrator));
        let geometry = pictures.each_ref().map(|picture| picture.world().geometry_stats());
        assert_eq!(geometry.map(|geometry| geometry.shapes), [3072 * 64; 2]);
        assert_eq!(geometry.map(|geometry| geometry.instances), [3072, 0]);
        assert!(geometry[0].geometry_bytes * 10 < geometry[1].geometry_bytes, "{geometry:?}");
        let [(shared, mean), (expanded, other)] = pictures.each_ref().map(hash);
        assert!(shared == expanded || integrator == Classic, "{integrator:?}: {mean:?} {other:?}");
        let near = |(a, b): (&f64, &f64)| *a > 0.01 && (a - b).abs() < 1e-5 * a;
        assert!(mean.iter().zip(&other).all(near), "{integrator:?}: {mean:?} {other:?}");
    }
}

/// A hill of 1,152 triangles.
fn hill() -> Mesh {
    const SIDE: u32 = 24;
    let corner = |i: u32| Vec2::new((i % (SIDE + 1)) as f32, (i / (SIDE + 1)) as f32) / SIDE as f32;
    let height = |at: Vec2| 4.0 * at.x * (1.0 - at.x) * at.y * (1.0 - at.y);
    let positions = (0..(SIDE + 1).pow(2)).map(corner).map(|at| Vec3::new(at.x, height(at), at.y)).collect();
    let square = |i: u32| {
        let first = i % SIDE + i / SIDE * (SIDE + 1);
        let [a, b, c, d] = [first, first + 1, first + SIDE + 1, first + SIDE + 2];
        [[a, c, b], [b, c, d]]
    };
    MeshData { positions, triangles: (0..SIDE * SIDE).flat_map(square).collect(), ..MeshData::default() }.into()
}

/// A hundred objects made by `object`, ten by ten, at a distance of `step`.
fn hundred(step: f32, object: impl Fn() -> Object) -> Vec<Object> {
    (0..100_u16).map(|i| object().at(f32::from(i % 10) * step, 0.0, f32::from(i / 10) * -step)).collect()
}

#[test]
fn more_than_a_billion_triangles_need_little_memory() {
    let scene = Scene::new().size(64, 36).samples(1);
    let scene = scene.group("hills", hundred(1.0, || Object::new(hill()).rotated(Vec3::Y, 90.0)));
    let scene = scene.group("country", hundred(10.0, || Object::group("hills").scaled(-1.0).scaled(-1.0)));
    let scene = hundred(100.0, || Object::group("country")).into_iter().fold(scene, Scene::add);
    let picture = picture(&scene, IntegratorKind::Classic);
    let geometry = picture.world().geometry_stats();
    assert_eq!((geometry.shapes, geometry.instances), (1_000_000, 100 + 10_000));
    assert_eq!((geometry.triangles, geometry.unique_triangles), (1_152_000_000, 115_200));
    assert!(geometry.geometry_bytes + geometry.bvh_bytes < 64 << 20, "{geometry:?}");
    let (hash, mean) = hash(&picture);
    assert!(mean.iter().all(|mean| *mean > 0.1), "{mean:?} {hash}");
}

/// Eighteen nested groups, all worth instancing: the innermost levels are instanced and the others
/// expanded, because the nesting depth is limited.
#[test]
fn nesting_depth_of_instances_is_limited() {
    let spheres = || (0..15_u16).map(|i| Object::new(Sphere { radius: 0.3 }).at(f32::from(i), 0.0, 0.0));
    let mut scene = Scene::new().size(16, 9).samples(1).group("g0", spheres().chain(spheres()));
    for i in 1..18 {
        let inner = Object::group(format!("g{}", i - 1)).at(0.0, 0.0, -1.0);
        scene = scene.group(format!("g{i}"), spheres().chain([inner]));
    }
    scene = scene.group("many", hundred(40.0, || Object::group("g17")));
    let scene = hundred(400.0, || Object::group("many")).into_iter().fold(scene, Scene::add);
    let picture = picture(&scene, IntegratorKind::Classic);
    let geometry = picture.world().geometry_stats();
    assert_eq!(geometry.shapes, 10_000 * (30 + 17 * 15));
    assert!(geometry.instances > 10_000 && geometry.instances < 10_000 * 16, "{geometry:?}");
    assert!(hash(&picture).1.iter().all(|mean| *mean > 0.05));
}
