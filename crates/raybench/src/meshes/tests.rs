use super::*;
use crate::kernel;
use crate::rays;
use juggler_bvh::Quality;
use juggler_math::{Ray, hash, testing::Random};
use std::collections::HashMap;

/// Sizes small enough for tests and large enough for all parts.
const SMALL: [(&str, u32); 6] =
    [("blob", 12), ("classroom", 2), ("hall", 4), ("stadium", 6), ("hairball", 3000), ("terrain", 64)];

fn small() -> impl Iterator<Item = (&'static str, Mesh)> {
    SMALL.into_iter().map(|(name, size)| (name, MeshSpec::parse(&format!("{name}:{size}")).unwrap().make()))
}

#[test]
fn mesh_names_and_sizes_are_parsed() {
    let all: Vec<&str> = BUILT_IN.iter().map(|kind| kind.name).collect();
    assert_eq!(all, SMALL.map(|(name, _)| name));
    for kind in BUILT_IN {
        assert_eq!(MeshSpec::parse(kind.name).map(|spec| spec.size), Ok(kind.size));
        assert!((kind.sizes.0..=kind.sizes.1).contains(&kind.size));
    }
    assert_eq!(MeshSpec::parse("hairball:7").map(|spec| (spec.kind.name, spec.size)), Ok(("hairball", 7)));
    assert_eq!(MeshSpec::parse("hairbal:7").err(), Some(MeshSpecError::Unknown));
    for wrong in ["blob:", "blob:0", "blob:-1", "blob:x", "blob:4097", "blob:1:2"] {
        let message = MeshSpec::parse(wrong).unwrap_err().to_string();
        assert_eq!(message, "the size of `blob` is a whole number from 1 to 4096", "{wrong}");
    }
}

/// Triangle counts stated in the documentation; of the two large meshes small instances.
#[test]
fn meshes_have_the_sizes_that_are_documented() {
    let count = |name: &str| MeshSpec::parse(name).unwrap().make().triangles.len();
    assert_eq!((count("blob"), count("stadium")), (69_314, 146_178));
    assert_eq!((count("classroom"), count("hall")), (116_124, 760_546));
    assert_eq!((count("hairball:10"), count("terrain:10")), (900, 200));
}

#[test]
fn triangle_indices_are_valid_and_positions_finite() {
    for (name, mesh) in small() {
        let corners = mesh.positions.len() as u32;
        assert!(mesh.triangles.iter().flatten().all(|corner| *corner < corners), "{name}");
        assert!(mesh.positions.iter().all(|position| position.is_finite()), "{name}");
        let used: std::collections::HashSet<u32> = mesh.triangles.iter().flatten().copied().collect();
        assert_eq!(used.len(), mesh.positions.len(), "{name}: corners that nobody names");
        let flat = |t: &&[u32; 3]| {
            let [a, b, c] = t.map(|i| mesh.positions[i as usize]);
            (b - a).cross(c - a).length() == 0.0
        };
        assert_eq!(mesh.triangles.iter().filter(flat).count(), 0, "{name}: triangles without area");
    }
}

/// Benchmarks on different machines use the same meshes: these hashes may change only together with
/// a note in CHANGELOG.
#[test]
fn meshes_match_golden_hashes() {
    let known = [2_442_935_998, 2_175_274_366, 3_031_150_253, 3_497_501_880, 2_586_744_402, 483_235_478];
    let hashes = small().map(|(_, mesh)| {
        let bits = mesh.positions.iter().flat_map(|p| p.to_array()).map(f32::to_bits);
        bits.chain(mesh.triangles.iter().flatten().copied()).fold(0, hash::combine)
    });
    assert_eq!(hashes.collect::<Vec<_>>(), known);
}

#[test]
fn the_camera_sees_the_mesh_and_the_light_is_in_the_open() {
    for (name, mesh) in small() {
        let bvh = kernel::build(&mesh, Quality::Fast).unwrap();
        let [primary, shadow, _, diffuse, ..] = rays::make(&mesh, &bvh, 20_000);
        let share = |hits: usize, of: usize| hits as f64 / of as f64;
        assert!(share(shadow.rays.len(), primary.rays.len()) > 0.15, "{name}: {}", shadow.rays.len());
        let occluded = share(shadow.rays.iter().filter(|ray| bvh.any(ray)).count(), shadow.rays.len());
        assert!((0.01..0.9).contains(&occluded), "{name}: {occluded} in shadow");
        let again = share(diffuse.rays.iter().filter(|ray| bvh.any(ray)).count(), diffuse.rays.len());
        assert!((0.05..=1.0).contains(&again), "{name}: {again} of the diffuse rays");
    }
}

#[test]
fn nothing_escapes_from_the_hall_and_the_classroom() {
    for (name, mesh) in small().filter(|(name, _)| ["hall", "classroom"].contains(name)) {
        let bvh = kernel::build(&mesh, Quality::Fast).unwrap();
        let mut random = Random::new(5);
        for _ in 0..100_000 {
            let ray = Ray::new(mesh.view.light, random.unit_vector());
            assert!(bvh.any(&ray), "{name}: {ray:?}");
        }
        let [primary, _, _, diffuse, diffuse2, _] = rays::make(&mesh, &bvh, 20_000);
        let lens = [primary.rays.len(), diffuse.rays.len(), diffuse2.rays.len()];
        assert!(lens[0] == lens[1] && lens[1] == lens[2], "{name}: {lens:?}");
    }
}

/// Each edge of the body belongs to two triangles, if vertices at one position count as one.
#[test]
fn the_body_of_the_blob_is_closed() {
    let mesh = MeshSpec::parse("blob:9").unwrap().make();
    let mut edges: HashMap<[[u32; 3]; 2], u32> = HashMap::new();
    for triangle in &mesh.triangles[..mesh.triangles.len() - 2] {
        let at = triangle.map(|i| mesh.positions[i as usize].to_array().map(|x| (x + 0.0).to_bits()));
        for [a, b] in [[at[0], at[1]], [at[1], at[2]], [at[2], at[0]]] {
            *edges.entry(if a < b { [a, b] } else { [b, a] }).or_default() += 1;
        }
    }
    assert!(edges.values().all(|count| *count == 2), "{} edges", edges.len());
    assert_eq!(edges.len(), (mesh.triangles.len() - 2) * 3 / 2);
}

#[test]
fn a_view_around_a_box_holds_all_corners() {
    for bounds in [
        Aabb { min: vec3(-1.0, -2.0, -3.0), max: vec3(4.0, 5.0, 6.0) },
        Aabb { min: vec3(1e6, 0.0, 0.0), max: vec3(1e6 + 10.0, 1.0, 1.0) },
        Aabb::from_points([Vec3::ONE]),
        Aabb::EMPTY,
    ] {
        let view = View::around(&bounds);
        let forward = (view.look_at - view.eye).normalize();
        assert!(view.eye.is_finite() && forward.is_finite() && forward.cross(view.up).length() > 0.1, "{view:?}");
        let half = (view.fov_degrees * 0.5).to_radians();
        for corner in bounds.corners().into_iter().filter(|_| !bounds.is_empty() && bounds.area() > 0.0) {
            assert!((corner - view.eye).angle_between(forward) <= half * 1.01, "{corner} {view:?}");
        }
    }
}
