//! Hashes of ray hits: every query of a [`TriangleBvh`] returns the same bits for every SIMD
//! instruction set, those in `hits.txt`. Rays and meshes are those of the benchmarks: camera,
//! shadow, ambient occlusion and diffuse rays.
//!
//! After an intended change of hits: `JUGGLER_BLESS=1 cargo test -p juggler-golden --test golden
//! hits::`. Lines of the watertight test affect pixels; only a bug fix may change them.

use juggler_bvh::{Quality, TriangleBvh, TriangleHit, TriangleTest, simd_levels};
use juggler_raybench::kernel;
use juggler_raybench::meshes::MeshSpec;
use juggler_raybench::rays::{self, RaySet};
use std::fmt::Write;
use std::path::Path;

/// A closed surface, an interior, and a height field.
const MESHES: [&str; 3] = ["blob:40", "hall:2", "terrain:60"];
/// Number of camera rays per mesh; each of the other sets has one ray per hit.
const RAYS: usize = 4096;
const TESTS: [TriangleTest; 2] = [TriangleTest::Watertight, TriangleTest::Fast];

/// A query for all rays of a set, folded into a hash.
type Call = fn(&TriangleBvh, &RaySet, u64) -> u64;

const CALLS: [(&str, Call); 8] = [
    ("closest", |tree, set, hash| set.rays.iter().fold(hash, |hash, ray| with_hit(hash, &tree.closest(ray)))),
    ("closest_batch", |tree, set, hash| closest(set, hash, |rays, hits| tree.closest_batch(rays, hits))),
    ("closest_in_flight", |tree, set, hash| {
        let tree = tree.clone().with_rays_in_flight(true);
        closest(set, hash, |rays, hits| tree.closest_batch(rays, hits))
    }),
    ("closest_packet", |tree, set, hash| closest(set, hash, |rays, hits| tree.closest_packet(rays, hits))),
    ("any", |tree, set, hash| set.rays.iter().fold(hash, |hash, ray| with(hash, tree.any(ray).into()))),
    ("any_batch", |tree, set, hash| any(set, hash, |occluded| tree.any_batch(&set.rays, occluded))),
    ("any_in_flight", |tree, set, hash| {
        let tree = tree.clone().with_rays_in_flight(true);
        any(set, hash, |occluded| tree.any_batch(&set.rays, occluded))
    }),
    ("any_packet", |tree, set, hash| any(set, hash, |occluded| tree.any_packet(&set.rays, occluded))),
];

/// Hash of the hits and of the rays' ends after the query.
fn closest(set: &RaySet, hash: u64, trace: impl Fn(&mut [juggler_math::Ray], &mut [Option<TriangleHit>])) -> u64 {
    let (mut rays, mut hits) = (set.rays.clone(), vec![None; set.rays.len()]);
    trace(&mut rays, &mut hits);
    let hash = hits.iter().fold(hash, with_hit);
    rays.iter().fold(hash, |hash, ray| with(hash, ray.t_max.to_bits().into()))
}

fn any(set: &RaySet, hash: u64, trace: impl Fn(&mut [bool])) -> u64 {
    let mut occluded = vec![false; set.rays.len()];
    trace(&mut occluded);
    occluded.iter().fold(hash, |hash, occluded| with(hash, (*occluded).into()))
}

/// Combines a hash with a number, by an odd factor and a rotation that spread each bit.
fn with(hash: u64, number: u64) -> u64 {
    (hash ^ number).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
}

fn with_hit(hash: u64, hit: &Option<TriangleHit>) -> u64 {
    let Some(TriangleHit { t, u, v, index }) = hit else { return with(hash, 1) };
    [t.to_bits(), u.to_bits(), v.to_bits(), *index].into_iter().fold(hash, |hash, word| with(hash, word.into()))
}

/// Adds one line for each test and query of a mesh.
fn add(lines: &mut String, name: &str) {
    let mesh = MeshSpec::parse(name).unwrap().make();
    let tree = kernel::build(&mesh, Quality::Balanced).unwrap();
    let sets = rays::make(&mesh, &tree, RAYS);
    assert!(sets.iter().all(|set| set.rays.len() > 60), "{name}: few rays hit anything");
    for test in TESTS {
        for (call, trace) in CALLS {
            let hashes = simd_levels().into_iter().map(|level| {
                let tree = tree.clone().with_test(test).with_simd_level(level);
                (level, sets.iter().fold(0, |hash, set| trace(&tree, set, hash)))
            });
            let hashes: Vec<_> = hashes.collect();
            assert!(hashes.iter().all(|hash| hash.1 == hashes[0].1), "{name} {test:?} {call}: {hashes:x?}");
            writeln!(lines, "{name} {test:?} {call} {:016x}", hashes[0].1).unwrap();
        }
    }
}

#[test]
fn hits_have_their_hashes_on_every_vector_unit() {
    let mut found = String::new();
    for name in MESHES {
        add(&mut found, name);
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("hits.txt");
    if std::env::var_os("JUGGLER_BLESS").is_some() {
        std::fs::write(&path, &found).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(found == expected, "hits differ from hits.txt:\n{}", crate::hashes::changes(&expected, &found));
}
