//! A pyramid of four triangles: closest hit and any hit of one ray, and closest hits of many rays.
//! `cargo run -p juggler-bvh --example twenty_lines`

#![allow(clippy::print_stdout)]

use juggler_bvh::{Quality, TriangleBvh, TriangleError};
use juggler_math::{Ray, Vec3, vec3};

fn main() -> Result<(), TriangleError> {
    let top = vec3(0.0, 1.0, 0.0);
    let positions = [top, vec3(-1.0, 0.0, -1.0), vec3(1.0, 0.0, -1.0), vec3(1.0, 0.0, 1.0), vec3(-1.0, 0.0, 1.0)];
    let triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    let tree = TriangleBvh::build(&positions, &triangles, Quality::Balanced)?;

    let ray = Ray::new(vec3(0.0, 0.5, 4.0), -Vec3::Z);
    let hit = tree.closest(&ray);
    println!("{hit:?} at {:?}", hit.map(|hit| ray.at(hit.t)));
    assert_eq!(hit.map(|hit| (hit.index, hit.t)), Some((2, 3.5)));
    assert!(tree.any(&ray) && !tree.any(&ray.with_t_max(3.0)));

    // Many rays; coherent ones are faster with `closest_packet`.
    let mut rays: Vec<Ray> = (0..8u8).map(|i| Ray::new(vec3(f32::from(i) * 0.25, 2.0, 0.1), -Vec3::Y)).collect();
    let mut hits = vec![None; rays.len()];
    tree.closest_batch(&mut rays, &mut hits);
    let heights: Vec<Option<f32>> = hits.iter().map(|hit| hit.map(|hit| 2.0 - hit.t)).collect();
    println!("{heights:?}");
    assert_eq!(heights[1..], [Some(0.75), Some(0.5), Some(0.25), Some(0.0), None, None, None]);
    Ok(())
}
