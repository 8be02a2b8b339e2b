//! Layers beside the picture, from the command line to the file.

use crate::harness::Folder;
use std::fs;

const BALL: &str = "ball.json --size 48x36 --samples 20 --integrator path";

#[test]
fn shards_with_all_layers_are_the_bytes_of_the_whole() {
    let folder = Folder::new();
    folder.good(&format!("render {BALL} --aov all -o whole.exr -q"));
    let parts: Vec<String> = (0..5).map(|index| format!("part{index}.jfilm")).collect();
    for (index, part) in parts.iter().enumerate() {
        folder.good(&format!("render {BALL} --aov all --shard {index}/5 -o {part} -q --threads {}", index % 3 + 1));
    }
    folder.good(&format!("merge {} -o merged.exr -q", parts.join(" ")));
    let bytes = |name: &str| fs::read(folder.path(name)).unwrap();
    assert!(bytes("whole.exr") == bytes("merged.exr"), "the merged file differs");
    // Parts that are joined keep their layers, and so does a checkpoint that is gone on with.
    folder.good(&format!("merge {} -o some.jfilm -q", parts[..3].join(" ")));
    folder.good(&format!("merge some.jfilm {} -o again.exr -q", parts[3..].join(" ")));
    assert!(bytes("whole.exr") == bytes("again.exr"), "the file of joined parts differs");
    let fewer = BALL.replace("--samples 20", "--samples 7");
    folder.good(&format!("render {fewer} --aov all --checkpoint kept.jfilm -o few.exr -q"));
    folder.good(&format!("render {BALL} --aov all --checkpoint kept.jfilm -o more.exr -q"));
    assert!(bytes("whole.exr") == bytes("more.exr"), "the file that was gone on with differs");
}

#[test]
fn the_picture_is_the_same_with_layers_and_without() {
    let folder = Folder::new();
    let plain = folder.hash(&format!("{BALL} -o a.png"));
    assert_eq!(folder.hash(&format!("{BALL} --aov depth,crypto_material -o b.png")), plain);
    assert_eq!(folder.hash(&format!("{BALL} --aov all -o c.exr")), plain);
    let files = folder.files();
    assert!(files.contains(&"b.layers.exr".to_owned()) && !files.contains(&"c.layers.exr".to_owned()), "{files:?}");
    folder.good(&format!("render {BALL} --aov depth,normal --aov-output l_{{}}.npy -o d.png -q"));
    assert!(folder.path("l_depth.npy").exists() && folder.path("l_normal.npy").exists());
    let said = folder.good("info c.exr").stdout;
    assert!(said.contains("--aov alpha,albedo"), "{said}");
}

#[test]
fn what_cannot_be_is_said() {
    let folder = Folder::new();
    for (line, said) in [
        ("render ball.json --aov dept", "did you mean `depth`"),
        ("render ball.json --aov depth -o -", "--aov-output"),
        ("render ball.json --aov depth -o a.gif", "film"),
        ("render ball.json --aov-output a.exr", "--aov"),
        ("render ball.json --aov depth --aov-output a.npy", "{}"),
        ("render ball.json --aov depth -o a.jfilm --aov-output a.exr", "merge"),
    ] {
        let message = folder.bad(line, 2);
        assert!(message.contains(said), "{line}: {message}");
    }
    folder.good("render ball.json --aov depth -o a.jfilm -q");
    let other = folder.bad("render ball.json --aov depth,albedo --checkpoint a.jfilm -o b.png", 2);
    assert!(other.contains("layers: depth instead of albedo,depth"), "{other}");
    folder.good("render ball.json -o plain.jfilm -q");
    assert!(folder.bad("merge plain.jfilm -o a.png --aov-output b.exr", 2).contains("no layers"));
}
