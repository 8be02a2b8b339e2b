//! Bombs of extreme numbers: 1e-38 to 1e38 in every transform, shape, camera and light.

use super::{Bomb, objects};

const CLASS: &str = "sizes";

const SIZES: [&str; 5] = ["1e-38", "1e-20", "1e18", "1e30", "1e38"];

/// Objects with `@` in place of a number.
const OBJECTS: [&str; 12] = [
    r#"{"shape": {"sphere": {"radius": @}}}"#,
    r#"{"shape": {"cylinder": {"radius": @}}}"#,
    r#"{"shape": {"cuboid": {"min": [0, 0, 0], "max": [@, 1, 1]}}}"#,
    r#"{"shape": {"triangle": {"vertices": [[0, 0, 0], [@, 0, 0], [0, @, 0]]}}}"#,
    r#"{"shape": {"rectangle": {"size": [@, @]}}}"#,
    r#"{"shape": "disk", "transform": [{"scale": [1, @, 1]}]}"#,
    r#"{"shape": "rectangle", "transform": [{"scale": [1, @, 1]}]}"#,
    r#"{"shape": "triangle", "transform": [{"scale": [1, @, 1]}]}"#,
    r#"{"shape": "sphere", "transform": [{"scale": @}]}"#,
    r#"{"shape": "sphere", "transform": [{"translate": [@, @, @]}]}"#,
    r#"{"shape": "plane", "transform": [{"scale": [@, 1, 1]}, {"translate": [0, @, 0]}]}"#,
    r#"{"shape": {"mesh": {"positions": [[0, 0, 0], [@, 0, 0], [0, @, 0]], "triangles": [[0, 1, 2]]}}}"#,
];

/// Scenes with `@` in place of a number.
const SCENES: [&str; 6] = [
    r#"{"version": 1, "background": @, "objects": [{"shape": "sphere"}]}"#,
    r#"{"version": 1, "camera": {"perspective": {"eye": [@, 0, 0]}}, "objects": [{"shape": "sphere"}]}"#,
    r#"{"version": 1, "lights": [{"point": {"position": [@, @, @], "intensity": @}}], "objects": [{"shape": "sphere"}]}"#,
    r#"{"version": 1, "render": {"integrator": {"path": {}}}, "objects": [{"shape": "sphere", "material": {"emissive": {"radiance": @}}}]}"#,
    r#"{"version": 1, "render": {"filter": {"mitchell": {}}}, "background": @, "objects": [{"shape": "sphere"}]}"#,
    r#"{"version": 1, "render": {"integrator": {"path": {}}}, "objects": [{"shape": "sphere", "material": {"dielectric": {"ior": @}}}]}"#,
];

pub fn bombs() -> Vec<Bomb> {
    let mut found = Vec::new();
    for (template, is_object) in OBJECTS.iter().map(|text| (text, true)).chain(SCENES.iter().map(|text| (text, false)))
    {
        for size in SIZES {
            let text = template.replace('@', size);
            let text = if is_object { objects(&text) } else { text };
            found.push(Bomb::from_scene(CLASS, text.clone(), text, "bomb.json"));
        }
    }
    found
}
