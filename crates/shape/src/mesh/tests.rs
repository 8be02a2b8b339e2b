//! Tests specific to meshes.

use super::*;
use examples::globe;
use juggler_math::portable;

mod rare;

fn prepared(data: MeshData) -> Mesh {
    let mut mesh = Mesh::from(data);
    mesh.prepare().unwrap();
    mesh
}

fn surface_below(mesh: &Mesh, x: f32, z: f32) -> Surface {
    let ray = Ray::new(Vec3::new(x, 5.0, z), Vec3::NEG_Y);
    mesh.surface(&ray, &mesh.intersect(&ray).unwrap())
}

/// One triangle in the plane y = 0, front up.
fn floor(normals: [Vec3; 3]) -> MeshData {
    MeshData {
        positions: vec![Vec3::ZERO, Vec3::Z * 4.0, Vec3::X * 4.0],
        triangles: vec![[0, 1, 2]],
        normals: normals.to_vec(),
        ..MeshData::default()
    }
}

#[test]
fn triangles_without_area_are_counted_and_clones_share() {
    let mut mesh = globe(24, 12, 1.0, Vec3::ZERO);
    mesh.prepare().unwrap();
    assert_eq!(mesh.warnings(), ["48 degenerate triangles ignored"]);
    assert!(mesh.triangles() == 576 && std::ptr::eq(mesh.data().unwrap(), &**mesh.arrays()), "nothing is copied");
    let clone = mesh.clone();
    assert!(std::ptr::eq(mesh.data().unwrap(), clone.data().unwrap()));
    assert_eq!(clone, mesh);
    let before = mesh.heap_bytes();
    mesh.prepare().unwrap();
    assert_eq!(mesh.heap_bytes(), before);
    assert!(prepared(floor([Vec3::Y; 3])).warnings().is_empty());
}

#[test]
fn normals_are_interpolated_and_a_tessellated_sphere_shades_like_a_sphere() {
    let mesh = prepared(floor([Vec3::Y, Vec3::new(0.0, 1.0, 1.0) * 9.0, Vec3::Y]));
    let surface = surface_below(&mesh, 0.0, 2.0);
    let expected = (Vec3::Y + Vec3::new(0.0, 1.0, 1.0).normalize()).normalize();
    assert!(surface.normal == Vec3::Y && surface.shading_normal.distance(expected) < 1e-5);
    let mut globe = globe(24, 12, 1.0, Vec3::ZERO);
    globe.prepare().unwrap();
    let mut random = juggler_math::testing::Random::new(19);
    for _ in 0..500 {
        let out = random.unit_vector();
        let ray = Ray::new(out * 3.0, -out);
        let surface = globe.surface(&ray, &globe.intersect(&ray).unwrap());
        assert!(surface.shading_normal.dot(out) > 0.9995 && surface.normal.dot(out) > 0.96, "{out} {surface:?}");
    }
}

/// Normals opposite to the winding are all negated; one that is below the surface is reflected
/// above it.
#[test]
fn shading_normals_stay_on_the_front() {
    let lean = Vec3::new(0.6, 0.8, 0.0);
    let inverted = surface_below(&prepared(floor([-lean; 3])), 1.0, 1.0);
    assert!(inverted.shading_normal.distance(lean) < 1e-6, "{inverted:?}");
    let dipping = surface_below(&prepared(floor([Vec3::new(0.8, -0.6, 0.0), Vec3::Y, Vec3::Y])), 0.01, 0.01);
    assert!(dipping.shading_normal.distance(Vec3::new(0.8, 0.6, 0.0)) < 0.02, "{dipping:?}");
    let missing = surface_below(&prepared(floor([Vec3::ZERO; 3])), 1.0, 1.0);
    assert_eq!(missing.shading_normal, Vec3::Y);
}

/// Sphere that grows and moves, at this number of times.
fn wandering(moments: usize, bent: bool) -> Vec<MeshData> {
    let at = |i: usize| {
        let time = i as f32 / (moments - 1) as f32;
        let height = if bent { 4.0 * time * (1.0 - time) } else { 0.0 };
        let globe = globe(16, 8, 1.0 + time, Vec3::new(3.0 * time, height, 0.0));
        globe.arrays().as_ref().clone()
    };
    (0..moments).map(at).collect()
}

#[test]
fn moving_mesh_equals_the_interpolated_static_mesh_at_each_time() {
    let mut random = juggler_math::testing::Random::new(51);
    for (moments, bent, kept) in [(2, false, 2), (17, false, 2), (17, true, 17)] {
        let keys = wandering(moments, bent);
        let moving = Mesh::from_keyframes(keys.clone(), None).unwrap();
        for _ in 0..40 {
            let time = random.f32();
            let (key, fraction) = juggler_math::motion::key_interval(moments, time);
            let between = |(a, b): (&Vec3, &Vec3)| juggler_math::motion::lerp(*a, *b, fraction);
            let positions = keys[key].positions.iter().zip(&keys[key + 1].positions).map(between).collect();
            let still = prepared(MeshData { positions, normals: Vec::new(), ..keys[key].clone() });
            assert!(moving.bounds().union(still.bounds()).extent() == moving.bounds().extent());
            for _ in 0..20 {
                let ray = Ray { time, ..random.ray(6.0) };
                let (a, b) = (moving.intersect(&ray), still.intersect(&ray));
                assert_eq!(a.is_some(), moving.occludes(&ray));
                if let (Some(a), Some(b)) = (a, b) {
                    assert!((a.t - b.t).abs() < 2e-3 * b.t.max(1.0), "{kept} {a:?} {b:?}");
                    let (a, b) = (moving.surface(&ray, &a), still.surface(&ray, &b));
                    assert!(a.point.distance(b.point) < 1e-2 && a.normal.dot(b.normal) > 0.99);
                }
            }
        }
    }
    let (small, large) = (
        globe(8, 6, 1.0, Vec3::ZERO).arrays().as_ref().clone(),
        globe(9, 6, 1.0, Vec3::ZERO).arrays().as_ref().clone(),
    );
    assert!(Mesh::from_keyframes(vec![small, large], None).is_err());
}

#[test]
fn morph_targets_blend_positions_and_recompute_normals() {
    let base = globe(24, 12, 1.0, Vec3::ZERO);
    let wide: Vec<Vec3> = base.arrays.positions.iter().map(|p| *p * Vec3::new(3.0, 1.0, 1.0)).collect();
    let high: Vec<Vec3> = base.arrays.positions.iter().map(|p| *p + Vec3::Y).collect();
    let morph =
        |positions: &Vec<Vec3>, weight| MorphTarget { positions: positions.clone(), weight, ..MorphTarget::default() };
    let mut mesh = Mesh { morphs: vec![morph(&wide, 0.5), morph(&high, 2.0)], ..base.clone() };
    mesh.prepare().unwrap();
    let bounds = mesh.bounds();
    assert!(bounds.center().distance(Vec3::Y * 2.0) < 1e-5 && (bounds.extent().x - 4.0).abs() < 1e-5);
    let ray = Ray::new(Vec3::new(1.0, 9.0, 0.3), Vec3::NEG_Y);
    let surface = mesh.surface(&ray, &mesh.intersect(&ray).unwrap());
    let p = surface.point - Vec3::Y * 2.0;
    let exact = Vec3::new(p.x / 4.0, p.y, p.z).normalize();
    assert!(surface.shading_normal.dot(exact) > 0.995, "{surface:?} {exact}");
    let mut few = Mesh { morphs: vec![morph(&wide[1..].to_vec(), 0.5)], ..base };
    assert_eq!(few.prepare().unwrap_err().field, "morphs[0]");
}

#[test]
fn normals_and_tangents_of_morph_targets_are_blended() {
    let mut data = floor([Vec3::Y; 3]);
    data.tangents = vec![[1.0, 0.0, 0.0, -1.0]; 3];
    let plain = MorphTarget { positions: data.positions.clone(), weight: 0.5, ..MorphTarget::default() };
    let target =
        MorphTarget { normals: vec![Vec3::X * 3.0; 3], tangents: vec![[0.0, 0.0, 2.0, 1.0]; 3], ..plain.clone() };
    let prepared = |morphs: Vec<MorphTarget>| {
        let mut mesh = Mesh { morphs, ..Mesh::from(data.clone()) };
        mesh.prepare().map(|()| mesh.data().unwrap().clone())
    };
    let blended = prepared(vec![target.clone()]).unwrap();
    assert_eq!(blended.normals, [Vec3::new(1.5, 0.5, 0.0).normalize(); 3]);
    assert_eq!(blended.tangents, [[0.5, 0.0, 1.0, -1.0]; 3], "the sign is that of the mesh");
    // Normals are computed anew if a target that counts has none; its tangents stay.
    let anew = prepared(vec![target.clone(), plain.clone()]).unwrap();
    assert_eq!((anew.normals[0].abs(), anew.tangents[0]), (Vec3::Y, [1.0, 0.0, 0.0, -1.0]));
    let unused = MorphTarget { weight: 0.0, ..plain };
    assert_eq!(prepared(vec![target.clone(), unused]).unwrap().normals, blended.normals);
    let few = MorphTarget { normals: vec![Vec3::X], ..target };
    assert_eq!(prepared(vec![few]).unwrap_err().field, "morphs[0].normals");
}

#[test]
fn a_crease_angle_makes_a_flat_mesh_round_and_keeps_its_shape() {
    let mut arrays = globe(24, 12, 1.0, Vec3::ZERO);
    arrays.arrays_mut().normals.clear();
    let with = |crease_angle_degrees: Option<f32>| {
        let mut mesh = Mesh { crease_angle_degrees, ..arrays.clone() };
        mesh.prepare().unwrap();
        mesh
    };
    let (flat, round, creased) = (with(None), with(Some(60.0)), with(Some(1.0)));
    let mut random = juggler_math::testing::Random::new(52);
    let mut most = [0.0f32; 3];
    for _ in 0..500 {
        let ray = random.ray(3.0);
        let hits = [&flat, &round, &creased].map(|mesh| (mesh, mesh.intersect(&ray)));
        for (most, (mesh, hit)) in most.iter_mut().zip(hits) {
            assert_eq!(hit, hits[0].1);
            let Some(hit) = hit else { continue };
            let surface = mesh.surface(&ray, &hit);
            let outwards = surface.point.normalize();
            let off = portable::acos(surface.shading_normal.dot(outwards).abs().min(1.0)).to_degrees();
            *most = most.max(off);
        }
    }
    assert!(most[0] > 6.0 && most[1] < 4.0 && most[2] > 6.0, "{most:?}");
    let keys = wandering(5, true).into_iter().map(|key| MeshData { normals: Vec::new(), ..key }).collect::<Vec<_>>();
    let moving = Mesh::from_keyframes(keys, Some(180.0)).unwrap();
    let ray = Ray { time: 1.0, ..Ray::new(Vec3::new(3.3, 9.0, 0.4), Vec3::NEG_Y) };
    let surface = moving.surface(&ray, &moving.intersect(&ray).unwrap());
    let outwards = (surface.point - Vec3::X * 3.0).normalize();
    assert!(surface.shading_normal.dot(outwards) > 0.99, "{surface:?}");
}

#[test]
fn clones_are_prepared_once() {
    let mesh = Mesh::from(floor([Vec3::Y; 3]));
    let data = |mesh: &Mesh| {
        let mut mesh = mesh.clone();
        mesh.prepare().unwrap();
        std::ptr::from_ref(mesh.prepared.as_deref().unwrap())
    };
    let kept = data(&mesh);
    assert_eq!(data(&mesh), kept);
    // Other arrays, creases and morphs are prepared by themselves.
    let turned = mesh.clone().with_normals([Vec3::X; 3]);
    let creased = Mesh { crease_angle_degrees: Some(30.0), ..mesh.clone().with_normals(Vec::new()) };
    let morph =
        MorphTarget { positions: vec![Vec3::ONE, Vec3::Z * 5.0, Vec3::X * 5.0], weight: 1.0, ..MorphTarget::default() };
    let morphed = Mesh { morphs: vec![morph], ..mesh.clone() };
    assert!([turned, creased, morphed].iter().all(|other| data(other) != kept));
    assert_eq!(data(&mesh), kept);
}
