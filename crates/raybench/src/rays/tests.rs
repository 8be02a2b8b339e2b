use super::*;
use crate::kernel;
use crate::meshes::MeshSpec;
use juggler_bvh::Quality;
use std::collections::HashSet;

fn sets(name: &str, count: usize) -> (Mesh, TriangleBvh, [RaySet; 6]) {
    let mesh = MeshSpec::parse(name).unwrap().make();
    let bvh = kernel::build(&mesh, Quality::Balanced).unwrap();
    let sets = make(&mesh, &bvh, count);
    (mesh, bvh, sets)
}

#[test]
fn a_tile_is_eight_packets_of_four_by_two_pixels() {
    for tile in [0, 1, 239, 240, TILES - 1] {
        let pixels: Vec<[u32; 2]> = (0..64).map(|i| pixel(tile, i)).collect();
        assert_eq!(pixels.iter().collect::<HashSet<_>>().len(), 64);
        let corner = pixels[0];
        assert!(corner.map(|c| c % 8) == [0, 0] && corner[0] < WIDTH && corner[1] < HEIGHT, "{corner:?}");
        for [x, y] in &pixels {
            assert!((corner[0]..corner[0] + 8).contains(x) && (corner[1]..corner[1] + 8).contains(y));
        }
        for packet in pixels.chunks(8) {
            let [x, y] = packet[0];
            let expected: Vec<[u32; 2]> = (0..8).map(|i| [x + i % 4, y + i / 4]).collect();
            assert_eq!(packet, expected);
        }
    }
}

#[test]
fn tiles_have_the_requested_count_and_cover_the_image() {
    assert_eq!(tiles(usize::MAX), (0..TILES).collect::<Vec<_>>());
    for count in [1, 64, 640, 20_000, 100_000, 500_000, 1_500_000] {
        let chosen = tiles(count);
        assert_eq!(chosen.len(), count.div_ceil(64), "{count}");
        assert!(chosen.windows(2).all(|pair| pair[0] < pair[1]), "{count}");
        // Each field of a 4 × 3 grid gets about its share, unless there are very few tiles.
        let across = WIDTH / TILE;
        let field = |tile: &u32| (tile % across / 60) + (tile / across / 45) * 4;
        for requested in 0..12 {
            let share =
                chosen.iter().filter(|tile| field(tile) == requested).count() as f64 * 12.0 / chosen.len() as f64;
            assert!(chosen.len() < 100 || (0.7..1.3).contains(&share), "{count}: field {requested} has {share}");
        }
    }
}

#[test]
fn camera_rays_go_through_their_pixels() {
    let (mesh, _, [primary, ..]) = sets("blob:4", 1000);
    let forward = (mesh.view.look_at - mesh.view.eye).normalize();
    let right = forward.cross(Vec3::Y).normalize();
    let up = right.cross(forward);
    let half = (mesh.view.fov_degrees * 0.5).to_radians().tan();
    let chosen = tiles(1000);
    for (i, ray) in primary.rays.iter().enumerate() {
        let scale = 1.0 / ray.direction.dot(forward) / half * HEIGHT as f32 / 2.0;
        let x = ray.direction.dot(right) * scale + WIDTH as f32 / 2.0;
        let y = HEIGHT as f32 / 2.0 - ray.direction.dot(up) * scale;
        let [column, row] = pixel(chosen[i / 64], i as u32 % 64).map(|p| p as f32);
        assert!(x > column - 0.01 && x < column + 1.01 && y > row - 0.01 && y < row + 1.01, "{i}: {x} {y}");
    }
}

#[test]
fn all_ray_sets_have_their_documented_properties() {
    let (mesh, bvh, sets) = sets("blob:20", 30_000);
    assert_eq!(sets.each_ref().map(|set| set.kind), Kind::ALL);
    let [primary, shadow, ao, diffuse, diffuse2, random] = sets.map(|set| set.rays);
    let hits = primary.iter().filter(|ray| bvh.closest(ray).is_some()).count();
    assert_eq!([shadow.len(), ao.len(), diffuse.len()], [hits; 3]);
    assert_eq!(diffuse2.len(), diffuse.iter().filter(|ray| bvh.closest(ray).is_some()).count());
    for ray in [&primary, &shadow, &ao, &diffuse, &diffuse2].into_iter().flatten() {
        assert!(ray.direction.is_normalized() && ray.t_min == 0.0 && ray.origin.is_finite(), "{ray:?}");
    }
    for ray in &shadow {
        let end = ray.at(ray.t_max);
        assert!(end.distance(mesh.view.light) < 1e-3 * ray.t_max && ray.t_max < ray.origin.distance(mesh.view.light));
    }
    assert!(ao.windows(2).all(|pair| pair[0].t_max == pair[1].t_max) && ao[0].t_max < 2.0, "{}", ao[0].t_max);
    assert!(diffuse.iter().chain(&diffuse2).all(|ray| ray.t_max == f32::INFINITY));
    let sorted = |rays: &[Ray]| {
        let mut keys: Vec<[u32; 6]> = rays.iter().map(key).collect();
        keys.sort_unstable();
        keys
    };
    assert!(random != diffuse2 && sorted(&random) == sorted(&diffuse2));
    let still = random.iter().zip(&diffuse2).filter(|(a, b)| a == b).count();
    assert!(still < 20, "{still} of {} were not moved", random.len());
}

fn key(ray: &Ray) -> [u32; 6] {
    let [a, b, c] = ray.origin.to_array().map(f32::to_bits);
    let [d, e, f] = ray.direction.to_array().map(f32::to_bits);
    [a, b, c, d, e, f]
}

#[test]
fn rays_do_not_hit_the_triangle_that_they_leave() {
    for name in ["blob:20", "hall:3", "stadium:8", "terrain:64"] {
        let (mesh, bvh, [primary, _, _, diffuse, ..]) = sets(name, 30_000);
        let from: Vec<u32> = primary.rays.iter().filter_map(|ray| Some(bvh.closest(ray)?.index)).collect();
        assert_eq!(from.len(), diffuse.rays.len());
        let same =
            diffuse.rays.iter().zip(&from).filter(|(ray, from)| bvh.closest(ray).is_some_and(|h| h.index == **from));
        assert_eq!(same.count(), 0, "{name}");
        // The origin must lie near the surface.
        let near = |(ray, from): (&Ray, &u32)| {
            let [a, b, c] = mesh.triangles[*from as usize].map(|i| mesh.positions[i as usize]);
            let size = (b - a).length() + (c - a).length() + a.length();
            (ray.origin - a).dot((b - a).cross(c - a).normalize()).abs() < 1e-4 * size
        };
        assert!(diffuse.rays.iter().zip(&from).all(near), "{name}");
    }
}

/// With a cosine density the mean component along the normal is 2/3.
#[test]
fn diffuse_rays_leave_with_the_density_of_the_cosine() {
    let floor = |x: f32, z: f32| vec3(x * 1e3, 0.0, z * 1e3);
    let positions = vec![floor(-1.0, -1.0), floor(1.0, -1.0), floor(1.0, 1.0), floor(-1.0, 1.0)];
    let view =
        View { eye: vec3(0.0, 5.0, 0.0), look_at: Vec3::ZERO, up: Vec3::X, fov_degrees: 60.0, light: Vec3::Y * 9.0 };
    let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], view };
    let bvh = kernel::build(&mesh, Quality::Fast).unwrap();
    let [_, _, _, diffuse, diffuse2, _] = make(&mesh, &bvh, 100_000);
    let mean = diffuse.rays.iter().map(|ray| f64::from(ray.direction.y)).sum::<f64>() / diffuse.rays.len() as f64;
    assert!((mean - 2.0 / 3.0).abs() < 0.005, "{mean}");
    assert_eq!(diffuse2.rays.len(), 0);
}

#[test]
fn empty_mesh_has_only_primary_rays() {
    let view = View::around(&juggler_math::Aabb::EMPTY);
    let mesh = Mesh { positions: Vec::new(), triangles: Vec::new(), view };
    let bvh = kernel::build(&mesh, Quality::Fast).unwrap();
    let sets = make(&mesh, &bvh, 100);
    assert_eq!(sets.map(|set| set.rays.len()), [128, 0, 0, 0, 0, 0]);
}
