//! Points and lines as instances.

use super::*;
use crate::gltf::Limits;
use juggler_scene::model::ModelNeeds;

/// A file of a strip of lines through `count` colored vertices, and of as many points.
fn strip_and_points(count: usize) -> Builder {
    let mut builder = Builder::default();
    let numbers: Vec<f32> = (0..count).flat_map(|i| [i as f32, (i * i % 7) as f32, 1.0]).collect();
    builder.floats("VEC3", 3, &numbers);
    builder.floats("VEC4", 4, &[0.25, 0.5, 0.75, 1.0].repeat(count));
    let attributes = r#""attributes": {"POSITION": 0, "COLOR_0": 1}"#;
    builder
        .member(format!(r#""meshes": [{{"primitives": [{{{attributes}, "mode": 3}}, {{{attributes}, "mode": 0}}]}}]"#));
    builder.member(r#""nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]"#);
    builder
}

/// Bytes of the arrays of instances.
fn bytes(instances: &Instances) -> usize {
    let Instances { positions, rotations, scales, matrices, colors, end_colors, .. } = instances;
    let colors = size_of_val(&**colors) + size_of_val(&**end_colors);
    size_of_val(&**positions) + size_of_val(&**rotations) + size_of_val(&**scales) + size_of_val(&**matrices) + colors
}

/// Objects with instances below these.
fn thin<'o>(objects: &mut dyn Iterator<Item = &'o Object>) -> Vec<&'o Instances> {
    let mut found = Vec::new();
    for object in objects {
        found.extend(object.instances.as_deref());
        found.extend(thin(&mut object.inner().iter().map(|inner| &**inner)));
    }
    found
}

#[test]
fn points_and_lines_need_at_most_100_bytes_each() {
    let parts = parts(&strip_and_points(1000));
    let all = thin(&mut parts.groups.values().flatten().chain(parts.objects.iter().map(|object| &**object)));
    let found: Vec<(usize, usize)> = all.iter().map(|all| (all.count(), bytes(all) / all.count())).collect();
    // Ends and segments of the strip, and points; each with its colors.
    assert_eq!(found, [(1000, 12 + 16), (999, 48 + 32), (1000, 12 + 16)]);
    assert!(parts.depends_on_size);
    let materials: Vec<_> = parts.materials.keys().collect();
    assert_eq!(materials, ["default material with colors without light"]);
}

#[test]
fn the_limit_of_points_and_lines_counts_the_whole_file() {
    let count = |limit: u64| {
        let limits = Limits { points_and_lines: limit, ..Limits::default() };
        let format = GltfFormat { limits: Some(limits) };
        let glb = strip_and_points(1000).glb();
        let model = format.open("a.glb", glb.clone(), &BTreeMap::new()).unwrap();
        let parts = model.parts(&ModelChoice::default(), "").unwrap();
        let all = thin(&mut parts.groups.values().flatten().chain(parts.objects.iter().map(|object| &**object)));
        let warnings = parts.warnings.into_iter().filter(|warning| warning.contains("left out")).collect::<Vec<_>>();
        (all.iter().map(|all| all.count()).sum::<usize>(), format.needs(glb, &BTreeMap::new()).solids, warnings)
    };
    assert_eq!(count(1999), (2999, 2999, Vec::new()));
    let text = "/meshes/0/primitives/1: is left out: the file has more than 1998 points and lines, the limit";
    assert_eq!(count(1998), (1999, 1999, vec![text.to_owned()]));
    assert_eq!(count(1).0, 0);
    assert_eq!(GltfFormat::default().needs(b"no file".to_vec(), &BTreeMap::new()), ModelNeeds::default());
}

#[test]
fn points_and_lines_are_wider_in_small_pictures() {
    let radius = |picture_size| {
        let choice = ModelChoice { picture_size, ..ModelChoice::default() };
        let parts = open(&strip_and_points(3)).parts(&choice, "").unwrap();
        let objects = parts.groups.values().flatten().chain(parts.objects.iter().map(|object| &**object));
        let inner = objects.flat_map(Object::inner).find_map(|object| match &object.shape {
            Some(AnyShape::Sphere(sphere)) => Some(f64::from(sphere.radius)),
            _ => None,
        });
        inner.unwrap_or_else(|| panic!("{parts:?}"))
    };
    // The positions are (0, 0, 1), (1, 1, 1) and (2, 4, 1).
    let diagonal = 20_f64.sqrt();
    // A pixel at the center of the framing view: the camera at 1.05 / sin(20°) radii sees 2 tan(20°)
    // of its distance in the picture's height.
    let pixel = |height: f64| 1.05 * diagonal / 20_f64.to_radians().cos() / height;
    for (size, height) in [([320, 240], 240.0), ([240, 320], 240.0), ([960, 720], 720.0)] {
        let found = radius(Some(size)) / pixel(height);
        assert!((found - 1.0).abs() < 1e-3, "{size:?}: half the width is {found} pixels");
    }
    assert!((radius(Some([4096, 4096])) / diagonal - 0.001).abs() < 1e-6);
    assert_eq!(radius(None), radius(Some([4096, 4096])));
}
