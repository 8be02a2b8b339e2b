use super::*;

#[test]
fn objects_are_flat_with_the_product_of_the_matrices() {
    let mut builder = triangle();
    builder.member(r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]"#);
    builder.member(
        r#""scene": 0, "scenes": [{"nodes": [0]}], "nodes": [
            {"name": "Root", "children": [1, 2], "translation": [1, 2, 3]},
            {"name": "Body", "children": [3], "scale": [-2, 2, 2]}, {"name": "Empty"},
            {"mesh": 0, "translation": [1, 0, 0]}]"#,
    );
    let found = open(&builder).parts(&ModelChoice::default(), "a/").unwrap();
    let [object] = found.objects.as_slice() else { panic!("{found:?}") };
    assert_eq!(object.name.as_deref(), Some("a/Root/Body/node 3"));
    // The reflection stays: the inverse transpose keeps the outside outside.
    assert_eq!(rows(object), [-2.0, 0.0, 0.0, -1.0, 0.0, 2.0, 0.0, 2.0, 0.0, 0.0, 2.0, 3.0]);
    assert_eq!(mesh(object).arrays().triangles, [[0, 1, 2]]);
    assert!(mesh(object).arrays().normals.is_empty(), "flat normals");
    assert!(found.materials.keys().all(|name| name.starts_with("a/")) && found.groups.is_empty());
}

#[test]
fn meshes_of_several_uses_or_primitives_are_groups() {
    let mut builder = triangle();
    builder.member(
        r#""meshes": [{"name": "M", "primitives": [{"attributes": {"POSITION": 0}}]},
            {"name": "M", "primitives": [{"attributes": {"POSITION": 0}}, {"attributes": {"POSITION": 0}, "mode": 5}]}]"#,
    );
    builder.member(r#""nodes": [{"mesh": 0}, {"mesh": 1}, {"mesh": 0, "translation": [0, 1, 0]}]"#);
    let found = open(&builder).parts(&ModelChoice::default(), "p/").unwrap();
    assert_eq!(found.groups.keys().collect::<Vec<_>>(), ["p/mesh M", "p/mesh M#2"]);
    let groups: Vec<&str> = found.objects.iter().map(|object| object.group.as_ref().unwrap().0.as_str()).collect();
    assert_eq!(groups, ["p/mesh M", "p/mesh M#2", "p/mesh M"]);
    assert_eq!(found.groups["p/mesh M#2"].len(), 2);
    let [first, second] = ["p/mesh M", "p/mesh M#2"].map(|name| mesh(&found.groups[name][0]).arrays());
    assert!(Arc::ptr_eq(first, second), "equal primitives share their arrays");
    assert!(found.warnings.iter().any(|warning| warning.contains("no scenes")), "{:?}", found.warnings);
}

#[test]
fn hidden_and_singular_nodes_are_there_but_not_visible() {
    let mut builder = triangle();
    builder
        .member(r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "scenes": [{"nodes": [0, 2, 3]}]"#);
    builder.member(
        r#""nodes": [{"children": [1], "extensions": {"KHR_node_visibility": {"visible": false}}}, {"mesh": 0},
            {"mesh": 0, "scale": [1, 0, 1]}, {"mesh": 0}], "extensionsUsed": ["KHR_node_visibility"]"#,
    );
    let found = parts(&builder);
    let visible: Vec<bool> = found.objects.iter().map(|object| object.is_visible()).collect();
    assert_eq!(visible, [false, false, true]);
    assert!(
        found.warnings.iter().any(|warning| warning.starts_with("/nodes/2: has a scale of 0")),
        "{:?}",
        found.warnings
    );
}

#[test]
fn instances_are_placed_in_the_space_of_their_node() {
    let mut builder = triangle();
    builder.floats("VEC3", 3, &[1.0, 0.0, 0.0, 0.0, 5.0, 0.0]);
    builder.floats("VEC3", 3, &[1.0, 1.0, 1.0, 3.0, 3.0, 3.0]);
    builder.member(r#""meshes": [{"name": "Leaf", "primitives": [{"attributes": {"POSITION": 0}}]}]"#);
    builder.member(
        r#""extensionsUsed": ["EXT_mesh_gpu_instancing"], "scenes": [{"nodes": [0]}], "nodes": [{"name": "Tree",
            "mesh": 0, "translation": [10, 0, 0], "extensions": {"EXT_mesh_gpu_instancing":
            {"attributes": {"TRANSLATION": 1, "SCALE": 2}}}}]"#,
    );
    let found = parts(&builder);
    let [tree] = found.objects.as_slice() else { panic!("{found:?}") };
    assert!(tree.name.as_deref() == Some("Tree") && tree.group.is_some());
    let matrices = [
        [1.0, 0.0, 0.0, 11.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0],
        [3.0, 0.0, 0.0, 10.0, 0.0, 3.0, 0.0, 5.0, 0.0, 0.0, 3.0, 0.0],
    ];
    assert_eq!(tree.instances, Some(Box::new(Instances::from_matrices(matrices))));
    let summary = open(&builder).summary(&ModelChoice::default()).unwrap();
    assert_eq!((summary.distinct_triangles, summary.drawn_triangles, summary.nodes), (1, 2, 1));
}

/// Attributes of applications are attributes of the instances that are left.
#[test]
fn attributes_of_applications_are_attributes_of_instances() {
    let mut builder = triangle();
    builder.floats("VEC3", 3, &[1.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 7.0]);
    builder.floats("VEC3", 3, &[1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 3.0, 3.0, 3.0]);
    builder.floats("SCALAR", 1, &[20.5, 30.0, -40.0]);
    builder.floats("VEC2", 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    builder.member(r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]"#);
    builder.member(
        r#""extensionsUsed": ["EXT_mesh_gpu_instancing"], "scenes": [{"nodes": [0]}], "nodes": [{"name": "Tree",
            "mesh": 0, "extensions": {"EXT_mesh_gpu_instancing":
            {"attributes": {"TRANSLATION": 1, "SCALE": 2, "_HEAT": 3, "_WIND": 4}}}}]"#,
    );
    let found = parts(&builder);
    let instances = found.objects[0].instances.as_ref().unwrap();
    assert_eq!(instances.count(), 2, "a scale of 0 leaves out an instance");
    let numbers = |name: &str| {
        let (_, attribute) = instances.attributes.iter().find(|(known, _)| *known == name).unwrap();
        (attribute.channels, (0..2).flat_map(|i| attribute.numbers(i).collect::<Vec<f32>>()).collect::<Vec<f32>>())
    };
    assert_eq!(numbers("_HEAT"), (1, vec![20.5, -40.0]));
    assert_eq!(numbers("_WIND"), (2, vec![1.0, 2.0, 5.0, 6.0]));
}

#[test]
fn points_and_lines_are_solids_of_a_thousandth_of_the_diagonal() {
    let mut builder = Builder::default();
    builder.floats("VEC3", 3, &[0.0, 0.0, 0.0, 3.0, 4.0, 0.0, 3.0, 4.0, 0.0]);
    builder.member(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]},
            {"primitives": [{"attributes": {"POSITION": 0}, "mode": 3}]}],
            "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"mesh": 1}]"#,
    );
    let found = parts(&builder);
    let instances =
        |object: &Item<Object>| object.inner().iter().map(|inner| inner.instance_count()).collect::<Vec<u64>>();
    let counts: Vec<Vec<u64>> = found.objects.iter().map(instances).collect();
    // Three points; three ends and two lines, one of which has almost no length.
    assert_eq!(counts, [vec![3], vec![3, 2]]);
    let Some(AnyShape::Sphere(sphere)) = &found.objects[0].inner()[0].shape else { panic!("{found:?}") };
    assert!((sphere.radius - 0.005).abs() < 1e-8, "{sphere:?}");
}

#[test]
fn too_many_instances_are_a_fault() {
    let mut builder = triangle();
    builder.member(r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "scenes": [{"nodes": [0, 1]}]"#);
    let node = r#"{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}"#;
    builder.member(format!(r#""extensionsUsed": ["EXT_mesh_gpu_instancing"], "nodes": [{node}, {node}]"#));
    let limits = Some(crate::gltf::Limits { instances: 5, ..crate::gltf::Limits::default() });
    let model = GltfFormat { limits }.open("a.glb", builder.glb(), &BTreeMap::new()).unwrap();
    let error = model.parts(&ModelChoice::default(), "").unwrap_err().to_string();
    assert_eq!(error, "a.glb: /nodes/1: the scene has more than 5 instances, the limit");
}

#[test]
fn nodes_are_found_by_names_and_paths() {
    let mut builder = triangle();
    builder.member(
        r#""scenes": [{"nodes": [0]}], "nodes": [{"name": "Root", "children": [1, 2], "translation": [1, 2, 3]},
            {"name": "Arm", "children": [3], "scale": [2, 2, 2]}, {"name": "Leg", "children": [4]},
            {"name": "Tip", "translation": [1, 0, 0]}, {"name": "Tip"}, {"name": "Other", "translation": [9, 0, 0]}]"#,
    );
    let model = open(&builder);
    let origin = |node: &str| {
        let found = model.node_transform(node, &ModelChoice::default());
        found.map(|transform| transform.translation.to_array()).map_err(|error| error.to_string())
    };
    assert_eq!(origin("Arm"), Ok([1.0, 2.0, 3.0]));
    assert_eq!(origin("Root/Arm/Tip"), Ok([3.0, 2.0, 3.0]));
    assert_eq!(origin("Other"), Ok([9.0, 0.0, 0.0]), "nodes outside of the scene count");
    let several = "a.glb: /nodes: 2 nodes are called `Tip`; write the path, such as `Root/Arm/Tip`";
    assert_eq!(origin("Tip"), Err(several.into()));
    assert_eq!(origin("Leh"), Err("a.glb: /nodes: there is no node `Leh`; did you mean `Leg`?".into()));
}
