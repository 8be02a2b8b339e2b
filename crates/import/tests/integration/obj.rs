//! OBJ models with MTL materials as scenes, and models of other people.

use crate::assets::{Folder, assets, find};
use juggler_import::obj::ObjFormat;
use juggler_material::AnyMaterial;
use juggler_scene::model::{ModelChoice, ModelFormat, ModelParts};

use juggler_scene::{Bundle, Loader, Scene};
use juggler_texture::AnyTexture;
use serde_json::{Value, json};
use std::collections::BTreeMap;

const LOADER: Loader = Loader::new(&[&ObjFormat]);

const CUBE: &str = "mtllib my lib.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n\
    o front\nusemtl red\nf 1/1 2/2 3/3\nusemtl none\nf 1 3 4\no back\ng inside\nusemtl red\nf 3 2 1\n";

/// A picture that looks like a normal map (PFM, one pixel of (0.5, 0.5, 1)).
const NORMALS: &[u8] = b"PF\n1 1\n-1.0\n\0\0\0\x3f\0\0\0\x3f\0\0\x80\x3f";

/// Parts of an OBJ with the library `a.mtl` and the pictures `tex/a.png` and `n.pfm`.
fn parts(obj: &str, mtl: &str) -> Result<ModelParts, String> {
    let files = [
        ("a.mtl", mtl.as_bytes()),
        ("my lib.mtl", mtl.as_bytes()),
        ("tex/a.png", b"not decoded here"),
        ("n.pfm", NORMALS),
    ];
    let files: BTreeMap<String, Vec<u8>> =
        files.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect();
    let file = ObjFormat.open("a.obj", obj.as_bytes().to_vec(), &files).map_err(|error| error.to_string())?;
    file.parts(&ModelChoice::default(), "m/").map_err(|error| error.to_string())
}

/// The material `x` of a library.
fn material(mtl: &str) -> (Value, ModelParts) {
    let obj = "mtllib a.mtl\nv 0 0 0\nv 3 0 0\nv 3 4 0\nusemtl x\nf 1 2 3\n";
    let parts = parts(obj, &format!("newmtl x\n{mtl}")).unwrap();
    (serde_json::to_value(&parts.materials["m/x"]).unwrap(), parts)
}

/// Property of a number that is nearly a decimal.
fn near(value: &Value, expected: f64) -> bool {
    (value.as_f64().unwrap() - expected).abs() < 1e-6
}

#[test]
fn objects_and_materials_have_the_names_of_the_file() {
    let parts = parts(CUBE, "newmtl red\nKd 1 0 0\nnewmtl unused\nmap_Kd missing.png\n").unwrap();
    let objects: Vec<_> = parts.objects.iter().map(|object| object.name.clone().unwrap()).collect();
    assert_eq!(objects, ["m/front", "m/front", "m/back/inside"]);
    assert_eq!(parts.materials.keys().collect::<Vec<_>>(), ["m/red", "m/default material"]);
    assert_eq!(parts.warnings.len(), 2, "{:?}", parts.warnings);
    assert_eq!(parts.warnings[1], "a.obj: usemtl none: faces of a material that no library defines are shown gray");
    let AnyMaterial::Principled(gray) = &parts.materials["m/default material"] else { panic!() };
    assert_eq!((gray.roughness.constant(), gray.base_color.constant().map(|color| color.r)), (Some(0.5), Some(0.8)));
}

#[test]
fn a_missing_library_is_gray_and_said_once() {
    let parts = parts(&CUBE.replace("my lib", "no lib"), "").unwrap();
    let expected = "a.obj: the library of materials `no lib.mtl` is missing; its materials are shown gray";
    assert!(parts.warnings.iter().any(|warning| warning == expected), "{:?}", parts.warnings);
    assert_eq!(parts.materials.len(), 1);
}

#[test]
fn classic_words_become_roughness_and_specular() {
    let (found, parts) = material("Kd 0.2 0.4 0.6\nKs 0.3 0.6 0.9\nNs 250\nd 0.25\nKe 3 2 1\n");
    let principled = &found["principled"];
    assert!(near(&principled["base_color"][2], 0.6), "{found}");
    assert!(near(&principled["roughness"], 0.5) && near(&principled["specular"], 0.6));
    assert!(near(&principled["opacity"], 0.25) && near(&principled["emissive"][0], 3.0));
    assert!(parts.warnings.is_empty(), "{:?}", parts.warnings);
}

#[test]
fn physical_words_win() {
    let (found, _) = material("Ks 0 0 0\nNs 1000\nPr 0.3\nPm 0.4\nPs 0.5\nPc 0.6\nPcr 0.7\naniso 0.8\nanisor 0.25\n");
    let principled = &found["principled"];
    let expected = [
        ("roughness", 0.3),
        ("metallic", 0.4),
        ("clearcoat", 0.6),
        ("clearcoat_roughness", 0.7),
        ("anisotropy", 0.8),
        ("anisotropy_rotation", 0.25),
        ("specular", 1.0),
    ];
    for (key, value) in expected {
        assert!(near(&principled[key], value), "{key}: {found}");
    }
    assert!(near(&principled["sheen_color"][0], 0.5));
}

#[test]
fn models_of_illumination_make_glass_and_metal() {
    let glass = |illum: u32| material(&format!("Kd 0 0 0\nTf 1 0.5 0.5\nNi 1.33\nd 0.1\nillum {illum}\n"));
    for illum in [4, 6, 7, 9] {
        let (found, parts) = glass(illum);
        let principled = &found["principled"];
        assert!(near(&principled["transmission"], 1.0) && near(&principled["ior"], 1.33), "{found}");
        assert!(near(&principled["base_color"][1], 0.5) && near(&principled["opacity"], 1.0));
        assert_eq!(parts.warnings, ["a.mtl:1: glass ignores `d` and `Tr`"]);
    }
    assert!(near(&glass(2).0["principled"]["transmission"], 0.0));
    assert!(near(&material("Ni 1\nillum 4\n").0["principled"]["transmission"], 0.0));
    assert!(near(&material("Ka 0.5 0.5 0.8\nillum 3\n").0["principled"]["metallic"], 0.6));
}

#[test]
fn opacity_and_transparency_are_understood() {
    let opacity = |mtl: &str| {
        let (found, parts) = material(mtl);
        (found["principled"]["opacity"].as_f64().unwrap(), parts.warnings.len())
    };
    assert_eq!(opacity("Tr 0.25\n"), (0.75, 0));
    assert_eq!(opacity("d 0.5\nTr 0.5\n"), (0.5, 0));
    assert_eq!(opacity("d 0.5\nTr 0.25\n"), (0.5, 1));
    assert_eq!(opacity("Tr 1\n"), (1.0, 1));
}

#[test]
fn textures_keep_options_and_encodings() {
    let (found, parts) = material(
        "Kd 0 0 0\nmap_Kd -s 2 3 -o 0.5 0.25 -clamp on tex/a.png\nmap_Pr -imfchan g tex\\a.png\nPr 0\n\
        map_d tex/a.png\nd 0.5\nmap_Ke -mm 0.5 2 C:\\art\\N.PFM\n",
    );
    let principled = &found["principled"];
    assert_eq!(principled["base_color"], "m/tex/a.png");
    assert_eq!(principled["roughness"], "m/tex/a.png.g");
    assert_eq!(principled["opacity"], json!({"texture": "m/tex/a.png.luminance", "factor": 0.5}));
    assert_eq!(principled["emissive"], "m/n.pfm raised");
    let texture = |name: &str| serde_json::to_value(&parts.textures[name]).unwrap();
    let color = &texture("m/tex/a.png")["image"];
    assert_eq!((&color["color_space"], &color["wrap"]), (&json!("auto"), &json!("clamp")));
    assert_eq!(color["matrix"], json!([2.0, 0.0, 0.5, 0.0, 3.0, 0.25]));
    let roughness = &texture("m/tex/a.png.g")["image"];
    assert_eq!((&roughness["color_space"], &roughness["channel"]), (&json!("linear"), &json!("g")));
    assert_eq!(color["file"], roughness["file"]);
    assert!(near(&texture("m/n.pfm")["image"]["factor"], 2.0));
    assert_eq!(parts.assets.len(), 2);
    assert_eq!(parts.warnings, ["a.mtl:8: names of files differ in path or case from the files found"]);
}

#[test]
fn bump_and_normal_maps_wrap_the_material() {
    let (bump, _) = material("map_Bump -bm 2 tex/a.png\n");
    let map = &bump["bump_map"];
    // The diagonal of the bounding box is 5.
    assert!(near(&map["distance"], 0.1) && map["material"]["principled"].is_object(), "{bump}");
    let (read, parts) = material("bump n.pfm\n");
    assert_eq!(read["normal_map"]["texture"], "m/n.pfm");
    assert_eq!(parts.warnings, ["a.mtl:1: `bump` names a normal map and is read as one"]);
    let (normal, parts) = material("norm tex/a.png\nbump tex/a.png\n");
    assert_eq!(normal["normal_map"]["texture"], "m/tex/a.png");
    assert_eq!(parts.warnings, ["a.mtl:1: has `norm` and `bump`; `norm` is used"]);
}

#[test]
fn missing_pictures_are_errors_that_name_them() {
    let obj = "mtllib a.mtl\nv 0 0 0\nv 3 0 0\nv 3 4 0\nusemtl x\nf 1 2 3\n";
    let error = parts(obj, "newmtl x\nmap_Kd wood.png\nmap_d leaf.png\n").unwrap_err();
    assert_eq!(error, "a.obj: a.mtl:3: leaf.png: no such file\na.obj: a.mtl:2: wood.png: no such file");
}

fn load(files: &[(&str, &str)]) -> Scene {
    let bundle: Bundle = files.iter().map(|(name, text)| ((*name).to_owned(), text.as_bytes().to_vec())).collect();
    LOADER.from_bundle(bundle, "a.obj").unwrap()
}

#[test]
fn an_obj_with_a_library_is_a_model_and_else_a_mesh() {
    let triangle = "v 0 0 0\nv 3 0 0\nv 3 4 0\nusemtl x\nf 1 2 3\n";
    let plain = load(&[("a.obj", triangle)]);
    assert!(!plain.is_around_model());
    assert_eq!(plain.description.objects.len(), 2);
    assert!(plain.description.textures.is_empty());
    let colored = load(&[("a.obj", "v 0 0 0 1 0 0\nv 3 0 0 0 1 0\nv 3 4 0 0 0 1\nf 1 2 3\n")]);
    assert!(!colored.is_around_model() && colored.description.textures.contains_key("color"));
    let with = format!("mtllib a.mtl\n{triangle}");
    let scene = load(&[("a.obj", &with), ("a.mtl", "newmtl x\nKd 1 0 0\n")]);
    assert!(scene.is_around_model());
    let expanded = scene.expanded_description();
    assert!(expanded.materials.keys().any(|name| name.ends_with("/x")));
    scene.compile().unwrap();
}

#[test]
fn vertex_colors_multiply_the_color() {
    let obj = "mtllib a.mtl\nv 0 0 0 1 0 0\nv 3 0 0 1 1 1\nv 3 4 0 0 0 1\nusemtl x\nf 1 2 3\n";
    let parts = parts(obj, "newmtl x\nKd 0.5 0.5 0.5\n").unwrap();
    let found = serde_json::to_value(&parts.materials["m/x"]).unwrap();
    let expected = json!({"factor": [0.5, 0.5, 0.5], "attribute": "color"});
    assert_eq!(found["principled"]["base_color"], expected);
}

/// Models of other people load, or are refused because they name missing pictures.
#[test]
fn every_obj_loads() {
    let Some(folder) = assets() else { return };
    let mut paths = Vec::new();
    find(&folder.join("obj"), &["obj"], &mut paths);
    assert!(!paths.is_empty());
    for path in paths {
        let beside = Folder(path.parent().unwrap().to_owned());
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let opened = ObjFormat.open(&name, std::fs::read(&path).unwrap(), &beside);
        match opened.map(|file| file.parts(&ModelChoice::default(), "").unwrap()) {
            Ok(parts) => {
                assert!(!parts.objects.is_empty() && !parts.materials.is_empty());
                let pictures = parts.textures.values().all(|texture| match texture {
                    AnyTexture::Image(image) => parts.assets.contains_key(&image.file),
                    _ => true,
                });
                assert!(pictures, "{name}");
                eprintln!("{name}: {} objects, {:?}", parts.objects.len(), parts.warnings);
            }
            Err(error) => {
                assert!(error.faults.iter().all(|fault| fault.ends_with("no such file")), "{error}");
                eprintln!("{error}");
            }
        }
    }
}
