//! `--max-memory`: estimates are sufficient, renders that fit stay below the limit, and others are
//! refused with a reason.

use crate::harness::{Folder, Run};
use juggler::memory::PROGRAM;
use juggler_math::testing::skipped;
use serde_json::Value;
use std::fs;
use std::process::{Command, Stdio};

const MIB: u64 = 1 << 20;

/// Memory limit in bytes: `mib` MiB, 20 of which stand for the program itself.
fn budget(mib: u64) -> u64 {
    (mib - 20) * MIB + PROGRAM
}

/// Address space that is reserved but not used, by which `ulimit -v` must exceed `--max-memory`:
/// the program and its libraries, and a stack and a glibc arena for each rendering thread and two
/// more.
fn reserved(threads: u64) -> u64 {
    64 * MIB + (threads + 2) * (64 + 8) * MIB
}

/// A curved surface of 2 `edge`² triangles as binary PLY, and a scene of it.
fn with_mesh(edge: u32) -> Folder {
    let folder = Folder::new();
    let side = edge + 1;
    let head = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        side * side,
        edge * edge * 2
    );
    let mut bytes = head.into_bytes();
    for i in 0..side * side {
        let (x, z) = ((i % side) as f32 / edge as f32 - 0.5, (i / side) as f32 / edge as f32 - 0.5);
        [x * 8.0, x * x + z * x * 3.0, z * 8.0].iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    }
    for i in (0..side * edge).filter(|i| i % side < edge) {
        for corners in [[i, i + side, i + 1], [i + 1, i + side, i + side + 1]] {
            bytes.push(3);
            corners.iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
        }
    }
    fs::write(folder.path("bent.ply"), bytes).unwrap();
    scene_of(&folder, "bent.ply");
    folder
}

fn scene_of(folder: &Folder, mesh: &str) {
    let text = format!(r#"{{"version": 1, "objects": [{{"shape": {{"mesh": {{"file": "{mesh}"}}}}}}]}}"#);
    fs::write(folder.path("mesh.json"), text).unwrap();
}

/// Runs a command with a limited address space; `None` if the system does not support limits.
fn limited(folder: &Folder, line: &str, budget: u64, threads: u64) -> Option<Run> {
    if !cfg!(target_os = "linux") {
        skipped("limits of address space: `ulimit -v` is only on Linux");
        return None;
    }
    let kib = (budget + reserved(threads)) / 1024;
    let binary = env!("CARGO_BIN_EXE_juggler");
    let flags = format!("--max-memory {budget} --threads {threads} --quiet --stats stats.json");
    let shell = format!("ulimit -v {kib}; exec {binary} render {line} {flags}");
    let mut command = Command::new("sh");
    command.arg("-c").arg(shell).current_dir(folder.path("")).stdin(Stdio::null());
    Some(Run::of(command.output().unwrap()))
}

fn stats(folder: &Folder) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.path("stats.json")).unwrap()).unwrap()
}

/// Asserts that a render stays below the limit and gives the same picture as without one.
fn fits(folder: &Folder, line: &str, budget: u64, threads: u64) {
    let Some(run) = limited(folder, line, budget, threads) else { return };
    assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{line}");
    let stats = stats(folder);
    let (peak, expected) = peaks(&stats);
    assert!(peak <= expected && expected <= budget, "{line}: {peak} of {expected} of {budget}");
}

fn peaks(stats: &Value) -> (u64, u64) {
    let number = |key: &str| stats["memory"][key].as_u64().unwrap();
    (number("peak_rss_bytes"), number("expected_bytes"))
}

#[test]
fn a_large_picture_fits_into_little_memory() {
    let folder = Folder::new();
    fs::write(folder.path("empty.json"), r#"{"version": 1, "background": 0.5, "lights": [{"ambient": {}}]}"#).unwrap();
    for output in ["a.png", "a.exr"] {
        fits(&folder, &format!("empty.json --size 20000x400 --samples 1 -o {output}"), budget(72), 2);
    }
    // The size of the bands does not matter.
    let line = "ball.json --size 300x700 --samples 1 -o a.png --threads 2";
    let free = folder.hash(line);
    assert_eq!(folder.hash(&format!("{line} --max-memory {}", budget(24))), free);
}

#[test]
fn memory_of_a_mesh_includes_its_hierarchy() {
    let folder = with_mesh(400);
    // The mesh has 320,000 triangles.
    fits(&folder, "mesh.json --size 64x36 --samples 1 -o a.png", budget(58), 2);
    let message = folder.bad(&format!("render mesh.json --size 64x36 -o a.png --max-memory {}", budget(32)), 2);
    let said = format!("{}.0 MiB", budget(32) / MIB);
    assert!(message.contains("mesh `bent.ply`") && message.contains(&said), "{message}");
    // The render is refused before the file is read, since its last byte is missing.
    let whole = fs::read(folder.path("bent.ply")).unwrap();
    fs::write(folder.path("broken.ply"), &whole[..whole.len() - 1]).unwrap();
    scene_of(&folder, "broken.ply");
    assert!(
        folder.bad(&format!("render mesh.json -o a.png --max-memory {}", budget(32)), 2).contains("mesh `broken.ply`")
    );
    assert!(folder.bad("render mesh.json -o a.png --max-memory 1G", 2).contains("end of the file"));
}

#[test]
fn a_film_in_memory_fits_or_is_refused_with_advice() {
    let folder = Folder::new();
    let line = "ball.json --size 1000x600 --samples 17 -o a.png --checkpoint a.jfilm --checkpoint-every 1";
    fits(&folder, line, budget(84), 2);
    let message = folder.bad(&format!("render {line} --max-memory {}", budget(40)), 2);
    for said in ["for the film", "36 bytes per pixel", "--checkpoint", "--shard", "--size"] {
        assert!(message.contains(said), "{said}: {message}");
    }
    // A shard needs its share of the memory.
    fits(&folder, "ball.json --size 1000x600 --samples 17 -o a.jfilm --shard 1/4", budget(40), 2);
}

#[test]
fn fewer_threads_and_smaller_bands_are_taken_before_anything_is_refused() {
    let folder = Folder::new();
    let line = "ball.json --size 512x2048 --samples 1 -o a.png --threads 16";
    let free = folder.stats(line);
    let tight = folder.stats(&format!("{line} --max-memory {}", budget(28)));
    let threads = |stats: &Value| stats["threads"].as_u64().unwrap();
    assert!(threads(&free) == 16 && (1..8).contains(&threads(&tight)), "{tight}");
    assert_eq!(tight["film"], free["film"]);
    assert!(peaks(&tight).0 <= budget(28), "{tight}");
}

#[test]
fn estimated_memory_is_enough() {
    let folder = with_mesh(200);
    let scenes = ["ball.json", "mesh.json", "juggler", "chess", "marbles", "blossom", "scalablitz-pool"];
    for scene in scenes {
        for threads in [1, 8] {
            let stats = folder.stats(&format!("{scene} --size 64x48 --samples 2 -o a.png --threads {threads}"));
            let (peak, expected) = peaks(&stats);
            assert!(peak <= expected, "{scene}, {threads} threads: {peak} > {expected}");
        }
    }
}

#[test]
fn memory_of_meshes_of_all_formats_is_estimated() {
    let folder = Folder::new();
    // The file is so long that the estimate samples only parts of it.
    let edge = 250_u32;
    let side = edge + 1;
    let mut text = String::new();
    let place = |i: u32| [i % side, (i % 7) * (i % 11), i / side].map(|v| v.to_string()).join(" ");
    (0..side * side).for_each(|i| text += &format!("v {}\n", place(i)));
    let faces = || (0..side * edge).filter(|i| i % side < edge);
    faces().for_each(|i| text += &format!("f {} {} {} {}\n", i + 1, i + side + 1, i + side + 2, i + 2));
    fs::write(folder.path("a.obj"), text).unwrap();
    let facet = |corners: [u32; 3]| {
        let corners = corners.map(|i| format!("vertex {}", place(i))).join("\n");
        format!("facet normal 0 0 0\nouter loop\n{corners}\nendloop\nendfacet\n")
    };
    let facets: String =
        faces().map(|i| facet([i, i + side, i + 1]) + &facet([i + 1, i + side, i + side + 1])).collect();
    fs::write(folder.path("a.stl"), format!("solid a\n{facets}endsolid a\n")).unwrap();
    for file in ["a.obj", "a.stl"] {
        assert!(fs::metadata(folder.path(file)).unwrap().len() > 2 * MIB);
        scene_of(&folder, file);
        let stats = folder.stats("mesh.json --size 16x16 --samples 1 -o a.png --threads 2");
        let (peak, expected) = peaks(&stats);
        assert!(stats["geometry"]["triangles"] == 2 * edge * edge, "{stats}");
        assert!(peak <= expected && expected < peak * 2, "{file}: {peak} of {expected}");
    }
}

#[test]
fn a_text_too_large_is_refused_before_it_is_read_as_a_scene() {
    let folder = Folder::new();
    let text = format!(r#"{{"version": 1, "objects": [{}]}}"#, "0,".repeat(300_000));
    fs::write(folder.path("many.json"), text).unwrap();
    let message = folder.bad(&format!("render many.json -o a.png --max-memory {}", budget(32)), 2);
    assert!(message.contains("the scene `many.json` needs about"), "{message}");
}

/// Limits memory by a control group, if the system allows its creation.
#[test]
fn render_stays_within_a_control_group() {
    let folder = with_mesh(300);
    let most = format!("MemoryMax={}", budget(64));
    let line = format!("render mesh.json --size 2000x2000 --samples 1 -o a.png --quiet --max-memory {}", budget(64));
    let command = folder.command(&line);
    let mut scoped = Command::new("systemd-run");
    scoped.args(["--scope", "--quiet", "-p", &most, "-p", "MemorySwapMax=0"]).arg(command.get_program());
    scoped.args(command.get_args()).current_dir(folder.path("")).stdin(Stdio::null());
    let probe = Command::new("systemd-run").args(["--scope", "--quiet", "-p", &most, "true"]).output();
    if !probe.is_ok_and(|output| output.status.success()) {
        skipped("control groups: `systemd-run --scope` makes none here");
        return;
    }
    let run = Run::of(scoped.output().unwrap());
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
}

#[test]
fn memory_of_instanced_emitters_is_estimated() {
    let folder = Folder::new();
    let ten = |group: &str| vec![format!(r#"{{"group": "{group}"}}"#); 10].join(", ");
    let scene = |emitters: &str| {
        let row = r#"{"chain": {"from": {"center": [0, 0, 0], "radius": 1}, "to": {"center": [9, 0, 0], "radius": 1}, "count": 1000},
            "material": {"emissive": {}}}"#;
        let [b, c, d] = ["a", "b", "c"].map(ten);
        format!(
            r#"{{"version": 1, "render": {{"integrator": "path"}},
                "groups": {{"a": [{row}], "b": [{b}], "c": [{c}], "d": [{d}]}}, "objects": [{emitters}]}}"#
        )
    };
    let line = "row.json --size 8x8 --samples 1 -o a.png --threads 2";
    // 300,000 emitters from a file of 1,000 bytes.
    fs::write(folder.path("row.json"), scene(&[r#"{"group": "c"}"#; 3].join(", "))).unwrap();
    let stats = folder.stats(line);
    let (peak, expected) = peaks(&stats);
    assert!(peak <= expected && expected < 2 * peak, "{peak} of {expected}");
    let refused = folder.run(&format!("render {line} --max-memory 100M"));
    assert_eq!((refused.status, refused.stderr.contains("the scene")), (2, true), "{}", refused.stderr);
    // Ten million emitters exceed the limit.
    fs::write(folder.path("row.json"), scene(&ten("d"))).unwrap();
    let refused = folder.run(&format!("render {line}"));
    assert_eq!(refused.status, 2);
    assert!(refused.stderr.contains("10000000 emissive shapes, the limit is 4000000"), "{}", refused.stderr);
    assert!(refused.stderr.contains("objects[4]"), "{}", refused.stderr);
}

/// The estimate of the bytes per object is within a factor of two; objects are most of the memory
/// here.
#[test]
fn memory_of_stored_objects_is_estimated() {
    let folder = Folder::new();
    let row = |z: u32| {
        let end = |x: u32| format!(r#"{{"center": [{x}, 0, {z}], "radius": 0.4}}"#);
        format!(r#"{{"chain": {{"from": {}, "to": {}, "count": 1000}}}}"#, end(0), end(999))
    };
    let rows: Vec<String> = (0..200).map(row).collect();
    fs::write(folder.path("rows.json"), format!(r#"{{"version": 1, "objects": [{}]}}"#, rows.join(", "))).unwrap();
    let stats = folder.stats("rows.json --size 8x8 --samples 1 -o a.png --threads 2");
    let (peak, expected) = peaks(&stats);
    assert!(peak <= expected && expected < 2 * peak, "{peak} of {expected}");
}

/// Points and lines of a glTF file are counted by its head, before their arrays are read.
#[test]
fn memory_of_points_and_lines_is_estimated() {
    let folder = Folder::new();
    let count: u32 = 100_000;
    let at = |i: u32| [(i % 300) as f32, (i / 300) as f32, 0.0].map(f32::to_le_bytes);
    fs::write(folder.path("points.bin"), (0..count).flat_map(at).flatten().collect::<Vec<u8>>()).unwrap();
    for mode in [0, 3] {
        let text = format!(
            r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0}}],
                "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}, "mode": {mode}}}]}}],
                "buffers": [{{"uri": "points.bin", "byteLength": {0}}}],
                "bufferViews": [{{"buffer": 0, "byteLength": {0}}}],
                "accessors": [{{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": {count}}}]}}"#,
            12 * count,
        );
        fs::write(folder.path("points.gltf"), text).unwrap();
        let line = "points.gltf --size 64x36 --samples 1 -o a.png";
        fits(&folder, line, budget(150), 2);
        let message = folder.bad(&format!("render {line} --max-memory {}", budget(60)), 2);
        assert!(message.contains("to be read, more than --max-memory"), "{message}");
    }
    // The file is refused before its arrays are read, since they are missing.
    fs::write(folder.path("points.bin"), [0; 12]).unwrap();
    let message = folder.bad(&format!("render points.gltf -o a.png --max-memory {}", budget(60)), 2);
    assert!(message.contains("more than --max-memory"), "{message}");
}
