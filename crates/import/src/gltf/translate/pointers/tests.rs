use super::*;

fn document() -> Document {
    let json = r#"{"asset": {"version": "2.0"}, "materials": [{"normalTexture": {"index": 0},
        "extensions": {"KHR_materials_volume": {"thicknessFactor": 1}}}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot"}]}}}"#;
    serde_json::from_str(json).unwrap()
}

#[test]
fn pointers_set_numbers_in_their_ranges() {
    let mut found = document();
    let pointers: [(&str, &[f64]); 8] = [
        ("/materials/0/pbrMetallicRoughness/baseColorFactor", &[0.5, 1.5, -1.0, 1.0]),
        ("/materials/0/normalTexture/scale", &[-2.0]),
        ("/materials/0/normalTexture/extensions/KHR_texture_transform/offset", &[0.25, 3.0]),
        ("/materials/0/extensions/KHR_materials_volume/attenuationDistance", &[7.0]),
        ("/cameras/0/perspective/yfov", &[0.5]),
        ("/cameras/0/perspective/znear", &[0.5]),
        ("/extensions/KHR_lights_punctual/lights/0/intensity", &[9.0]),
        ("/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", &[0.25]),
    ];
    for (pointer, values) in pointers {
        assert!(apply(&mut found, pointer, values), "{pointer}");
    }
    let material = &found.materials[0];
    assert_eq!(material.pbr_metallic_roughness.base_color_factor, [0.5, 1.0, 0.0, 1.0]);
    let texture = material.normal_texture.as_ref().unwrap();
    assert_eq!((texture.scale, texture.extensions.transform.as_ref().unwrap().offset), (-2.0, [0.25, 3.0]));
    let volume = material.extensions.as_ref().unwrap().volume.as_ref().unwrap();
    assert_eq!((volume.attenuation_distance, volume.thickness_factor), (Some(7.0), 1.0));
    assert_eq!(found.cameras[0].perspective.unwrap().yfov, 0.5);
    let light = &found.extensions.lights_punctual.as_ref().unwrap().lights[0];
    assert_eq!((light.intensity, light.spot.unwrap().outer_cone_angle), (9.0, 0.25));
}

#[test]
fn unknown_properties_are_warnings() {
    let document = document();
    let mut pose = Pose::default();
    for pointer in ["/materials/1/emissiveFactor", "/materials/0/name", "/images/0", "", "/cameras/0/orthographic/xmag"]
    {
        pose.properties.insert(pointer.to_owned(), vec![1.0]);
    }
    pose.properties.insert("/materials/0/emissiveFactor".to_owned(), vec![1.0]);
    let mut warnings = Warnings::default();
    assert_eq!(*animated(&document, &pose, &mut warnings), document);
    assert_eq!(warnings.list().iter().map(|warning| warning.count).sum::<u64>(), 6);
    assert!(matches!(animated(&document, &Pose::default(), &mut warnings), Cow::Borrowed(_)));
}
