//! Tests of models: settings of faces, and colors.

use super::*;
use crate::limits::MeshLimits;
use crate::obj::parse_obj;
use juggler_math::color::srgb_decode;
use std::path::Path;

fn read(text: &str) -> ObjModel {
    parse_obj(Path::new("a.obj"), text.as_bytes(), &MeshLimits::default()).unwrap()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn sections_follow_the_statements() {
    let model = read(&format!(
        "mtllib my lib.mtl\n{SQUARE}o a\nusemtl red\ns 1\nf 1 2 3 4\ng b c\nusemtl x\nusemtl  sky blue \ns off\nf 1 2 3\no d\nf 1 3 4\n"
    ));
    let section = |first, object: &str, group: Option<&str>, material: &str, smoothing| ObjSection {
        first,
        object: Some(object.into()),
        group: group.map(Into::into),
        material: Some(material.into()),
        smoothing,
    };
    assert_eq!(model.libraries, ["my lib.mtl"]);
    assert_eq!(
        model.sections,
        [
            section(0, "a", None, "red", 1),
            section(2, "a", Some("b c"), "sky blue", 0),
            section(3, "d", None, "sky blue", 0)
        ]
    );
    assert_eq!(model.mesh.triangles.len(), 4);
    assert_eq!(model.positions, [0, 1, 2, 3]);
    assert!(model.warnings.is_empty());
}

#[test]
fn libraries_and_smoothing_without_normals_need_a_model() {
    let cases = [
        ("", true),
        ("o a\nusemtl b\nf 1 2 3", true),
        ("v 0 0 0\r \tmtllib a.mtl", false),
        ("\u{feff}mtllib a.mtl", false),
        ("mtllib\n#mtllib a\n# \\\nusemtl mtllib", true),
        ("s 1\nf 1 2 3", false),
        ("s 1\nvn 0 0 1\n", true),
        ("s off\ns 0\ns\ns \n", true),
        ("f 1 2 \\\ns 3\n", true),
    ];
    for (text, expected) in cases {
        assert_eq!(is_plain_obj(text.as_bytes()), expected, "{text:?}");
    }
}

#[test]
fn colors_of_positions_are_decoded() {
    let model = read("v 0 0 0 1 0 0.5\nv 1 0 0\nv 0 1 0 0 2 -1\nf 1 2 3\n");
    let color = model.mesh.attributes.get("color").unwrap();
    let half = srgb_decode(0.5);
    let expected = vec![1.0, 0.0, half, 1.0, 1.0, 1.0, 0.0, 1.0, 0.0];
    assert_eq!((color.channels, &color.data), (3, &juggler_shape::attribute::AttributeData::F32(expected)));
    // Levels from 0 to 255; the position without color stays white.
    let levels = read("v 0 0 0 255 0 51\nv 1 0 0\nv 0 1 0 0 1 255\nf 1 2 3\n");
    let expected = [1.0, 0.0, 0.2, 1.0, 1.0, 1.0, 0.0, 1.0 / 255.0, 1.0].map(srgb_decode).to_vec();
    let color = levels.mesh.attributes.get("color").unwrap();
    assert_eq!(color.data, juggler_shape::attribute::AttributeData::F32(expected));
    assert_eq!(levels.warnings, ["colors of vertices exceed 1: taken as levels from 0 to 255"]);
    let plain = read("v 0 0 0 1\nv 1 0 0 nan 1 1\nv 0 1 0\nf 1 2 3\n");
    assert!(plain.mesh.attributes.is_empty());
    assert_eq!(plain.warnings, ["2 vertices have numbers after x y z that are no colors: ignored"]);
}
