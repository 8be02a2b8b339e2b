//! Bombs of false headers: small files of every format whose headers claim gigabytes.

use super::{Bomb, Content, objects};
use crate::mutate::{repair_film, repair_png};
use crate::seeds;

const CLASS: &str = "claims";

/// Overwrites the bytes from offset `at` on.
fn put(mut bytes: Vec<u8>, at: usize, new: &[u8]) -> Vec<u8> {
    bytes.iter_mut().skip(at).zip(new).for_each(|(byte, new)| *byte = *new);
    bytes
}

fn seed(name: &str) -> Vec<u8> {
    seeds::for_target(name).into_iter().next().unwrap_or_default()
}

/// Offset of the end of a pattern.
fn after(bytes: &[u8], pattern: &[u8]) -> usize {
    bytes.windows(pattern.len()).position(|window| window == pattern).map_or(0, |at| at + pattern.len())
}

fn png(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = put(put(seed("png"), 16, &width.to_be_bytes()), 20, &height.to_be_bytes());
    repair_png(&mut bytes);
    bytes
}

fn jpeg(width: u16, height: u16) -> Vec<u8> {
    let bytes = seed("jpeg");
    let at = after(&bytes, b"\xff\xc0") + 3;
    put(put(bytes, at, &height.to_be_bytes()), at + 2, &width.to_be_bytes())
}

fn exr(width: u32, height: u32) -> Vec<u8> {
    let bytes = seed("exr");
    let at = after(&bytes, b"dataWindow\0box2i\0") + 12;
    put(put(bytes, at, &(width - 1).to_le_bytes()), at + 4, &(height - 1).to_le_bytes())
}

fn webp(width: u32, height: u32) -> Vec<u8> {
    put(seed("webp"), 21, &((width - 1) | (height - 1) << 14).to_le_bytes())
}

/// Image files by name, whose headers claim huge sizes.
fn pictures() -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    let mut add = |name: &str, bytes: Vec<u8>| found.push((name.to_owned(), bytes));
    for (number, (width, height)) in
        [(20_000, 20_000), (65_535, 65_535), (2_000_000_000, 1), (1, 2_000_000_000)].into_iter().enumerate()
    {
        add(&format!("{number}.png"), png(width, height));
        add(&format!("{number}.hdr"), format!("#?RADIANCE\n\n-Y {height} +X {width}\n\x02\x02").into_bytes());
        add(&format!("{number}.pfm"), format!("PF\n{width} {height}\n-1.0\nabc").into_bytes());
    }
    add("a.exr", exr(16_777_240, 12));
    add("b.exr", exr(1_000_000_000, 1_000_000_000));
    add("c.exr", exr(12, 16_777_240));
    add("a.jpg", jpeg(65_535, 65_535));
    add("a.webp", webp(16_383, 16_383));
    let sides = [255; 4];
    add("a.gif", put(seed("gif"), 6, &sides));
    add("a.tga", put(seed("tga"), 12, &sides));
    add("a.bmp", put(seed("bmp"), 18, &[0xff, 0xff, 0, 0, 0xff, 0xff, 0, 0]));
    // The seed states its width and height first, each as a number of 32 bits.
    let tiff = seed("tiff");
    let width = after(&tiff, &[0, 1, 4, 0, 1, 0, 0, 0]);
    add("a.tif", put(put(tiff, width, &[255; 4]), width + 12, &[255; 4]));
    found
}

/// Partial renders (`.jfilm`) with hostile headers and correct hashes.
fn parts() -> Vec<(String, Vec<u8>)> {
    let good = seeds::for_target("jfilm").pop().unwrap_or_default();
    let head = |change: &dyn Fn(&mut serde_json::Value)| {
        let length = good.get(12..16).and_then(|four| four.try_into().ok()).map_or(0, u32::from_le_bytes) as usize;
        let (prelude, rest) = good.split_at(good.len().min(32));
        let (head, rest) = rest.split_at(length.min(rest.len()));
        let mut value: serde_json::Value = serde_json::from_slice(head).unwrap_or_default();
        change(&mut value);
        let head = value.to_string().into_bytes();
        let prelude = put(prelude.to_vec(), 12, &(head.len() as u32).to_le_bytes());
        let mut bytes = [prelude, head, rest.to_vec()].concat();
        repair_film(&mut bytes);
        bytes
    };
    let layers = serde_json::json!({"wanted": ["crypto_object"], "planes": 0, "masks": true, "entries": u32::MAX});
    let groups: Vec<String> = (0..200_000).map(|number| format!("g{number}")).collect();
    let groups =
        serde_json::json!({"wanted": ["light_groups"], "planes": 200_000, "masks": false, "light_groups": groups});
    let region = |width: u32, height: u32| serde_json::json!({"x": 0, "y": 0, "width": width, "height": height});
    vec![
        ("entries.jfilm".to_owned(), head(&|head| head["part"]["layers"] = layers.clone())),
        ("groups.jfilm".to_owned(), head(&|head| head["part"]["layers"] = groups.clone())),
        (
            "large.jfilm".to_owned(),
            head(&|head| {
                head["part"]["size"] = serde_json::json!([65_536, 65_536]);
                head["part"]["region"] = region(65_536, 65_536);
            }),
        ),
        (
            "half.jfilm".to_owned(),
            head(&|head| {
                head["part"]["size"] = serde_json::json!([65_536, 32_768]);
                head["part"]["region"] = region(65_536, 32_768);
            }),
        ),
        ("shares.jfilm".to_owned(), head(&|head| head["part"]["share"]["count"] = serde_json::json!(u32::MAX))),
        ("samples.jfilm".to_owned(), head(&|head| head["part"]["samples"] = serde_json::json!(u32::MAX))),
        ("count.jfilm".to_owned(), put(good.clone(), 24, &u64::MAX.to_le_bytes())),
        ("head.jfilm".to_owned(), put(good.clone(), 12, &u32::MAX.to_le_bytes())),
    ]
}

/// Mesh files by name, whose headers claim huge counts.
fn meshes() -> Vec<(String, Vec<u8>)> {
    let stl = [[b' '; 80].as_slice(), &u32::MAX.to_le_bytes(), &[0; 100]].concat();
    let ply = |vertices: &str, faces: &str| {
        format!(
            "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {faces}\nproperty list uint uint vertex_index\nend_header\nabc"
        )
        .into_bytes()
    };
    vec![
        ("a.stl".to_owned(), stl),
        ("a.ply".to_owned(), ply("4294967295", "4294967295")),
        ("b.ply".to_owned(), ply("18446744073709551615", "1")),
        ("a.obj".to_owned(), b"v 0 0 0\nf 1 1 4294967295\n".to_vec()),
        ("b.obj".to_owned(), b"v 0 0 0\nf -9223372036854775808 1 1\n".to_vec()),
    ]
}

/// A file with the header of an MP4, which no reader supports; it must be refused by name.
fn movie() -> Bomb {
    let mut bomb = Bomb::from_command_line(CLASS, "info a.mp4", "a.mp4");
    bomb.files.push(("a.mp4".to_owned(), Content::Bytes(b"\xff\xff\xff\xffftypisom\0\0\x02\0isomav01".to_vec())));
    bomb
}

pub fn bombs() -> Vec<Bomb> {
    let mut found = vec![movie()];
    let line = |name: &str, bytes: &[u8], line: &str| {
        let mut bomb = Bomb::from_command_line(CLASS, line.replace('@', name), name);
        bomb.files.push((name.to_owned(), Content::Bytes(bytes.to_vec())));
        bomb
    };
    for (name, bytes) in pictures() {
        let texture = format!(
            r#"{{"version": 1, "textures": {{"a": {{"image": {{"file": "{name}"}}}}}}, "objects": [{{"shape": "sphere"}}]}}"#
        );
        let around = format!(
            r#"{{"version": 1, "background": {{"environment": {{"file": "{name}"}}}}, "objects": [{{"shape": "sphere"}}]}}"#
        );
        let file = Content::Bytes(bytes.clone());
        found.push(
            Bomb::from_scene(CLASS, format!("{name} as a texture"), texture, &name).with_file(&name, file.clone()),
        );
        found.push(Bomb::from_scene(CLASS, format!("{name} as an environment"), around, &name).with_file(&name, file));
        found.push(line(&name, &bytes, "compare @ @"));
        found.push(line(&name, &bytes, "info @"));
    }
    for (name, bytes) in parts() {
        for command in ["info @", "compare @ @", "merge @ -o a.png", "merge @ -o a.jfilm"] {
            found.push(line(&name, &bytes, command));
        }
    }
    for (name, bytes) in meshes() {
        let scene = objects(&format!(r#"{{"shape": {{"mesh": {{"file": "{name}"}}}}}}"#));
        found.push(
            Bomb::from_scene(CLASS, format!("{name} in a scene"), scene, &name).with_file(&name, Content::Bytes(bytes)),
        );
    }
    found
}
