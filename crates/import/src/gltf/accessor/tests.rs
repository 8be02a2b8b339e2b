use super::*;
use crate::gltf::document::{ComponentType, ElementType};
use crate::gltf::testing::{Builder, f32_bytes};
use crate::gltf::{Gltf, Limits};
use juggler_math::testing::Random;
use std::collections::BTreeMap;

const COMPONENTS: [(u32, ComponentType); 6] = [
    (5120, ComponentType::I8),
    (5121, ComponentType::U8),
    (5122, ComponentType::I16),
    (5123, ComponentType::U16),
    (5125, ComponentType::U32),
    (5126, ComponentType::F32),
];

const ELEMENTS: [ElementType; 7] = [
    ElementType::Scalar,
    ElementType::Vec2,
    ElementType::Vec3,
    ElementType::Vec4,
    ElementType::Mat2,
    ElementType::Mat3,
    ElementType::Mat4,
];

/// A number by the equations of the specification.
fn expected(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let two = || [bytes[0], bytes[1]];
    let four = || [bytes[0], bytes[1], bytes[2], bytes[3]];
    match (component, normalized) {
        (ComponentType::I8, false) => f32::from(bytes[0] as i8),
        (ComponentType::U8, false) => f32::from(bytes[0]),
        (ComponentType::I16, false) => f32::from(i16::from_le_bytes(two())),
        (ComponentType::U16, false) => f32::from(u16::from_le_bytes(two())),
        (ComponentType::I8, true) => (f32::from(bytes[0] as i8) / 127.0).max(-1.0),
        (ComponentType::U8, true) => f32::from(bytes[0]) / 255.0,
        (ComponentType::I16, true) => (f32::from(i16::from_le_bytes(two())) / 32767.0).max(-1.0),
        (ComponentType::U16, true) => f32::from(u16::from_le_bytes(two())) / 65535.0,
        (ComponentType::U32, _) => u32::from_le_bytes(four()) as f32,
        (ComponentType::F32, _) => f32::from_le_bytes(four()),
    }
}

/// Offsets of the components in an element, and its packed stride; the columns of matrices begin at
/// multiples of 4.
fn offsets(component: ComponentType, element: ElementType) -> (Vec<usize>, usize) {
    let (columns, rows) = element.shape();
    let size = component.bytes();
    let column = if columns > 1 { (rows * size).div_ceil(4) * 4 } else { rows * size };
    let all = (0..columns).flat_map(|c| (0..rows).map(move |r| c * column + r * size));
    (all.collect(), column * columns)
}

#[test]
fn all_types_and_strides_decode() {
    let mut random = Random::new(1);
    for (number, component) in COMPONENTS {
        for element in ELEMENTS {
            for normalized in [false, true] {
                for (stride, offset) in [(0, 0), (0, 4), (64, 0), (68, 8), (252, 4)] {
                    let (offsets, packed) = offsets(component, element);
                    let actual = if stride == 0 { packed } else { stride };
                    let end = offsets[offsets.len() - 1] + component.bytes();
                    let count = 1 + random.below(9);
                    // Finite floating point numbers have no exponent of ones.
                    let bytes: Vec<u8> =
                        (0..offset + actual * (count - 1) + end).map(|_| random.bits() as u8 & 0xbf).collect();
                    let mut file = Builder::default();
                    let view = file
                        .view(&bytes, &if stride == 0 { String::new() } else { format!("\"byteStride\": {stride}") });
                    let accessor = file.accessor(&format!(
                        r#""bufferView": {view}, "byteOffset": {offset}, "componentType": {number}, "count": {count},
                           "type": "{}", "normalized": {normalized}"#,
                        element.name()
                    ));
                    let found = file.load().numbers(Index::from(accessor as u32)).unwrap();
                    let positions = (0..count).flat_map(|i| offsets.iter().map(move |o| offset + i * actual + o));
                    let wanted: Vec<f32> = positions.map(|p| expected(component, normalized, &bytes[p..])).collect();
                    assert_eq!(found, wanted, "{component:?} {element:?} {normalized} stride {stride}");
                }
            }
        }
    }
}

#[test]
fn normalized_numbers_reach_their_ends() {
    let mut file = Builder::default();
    let mut numbers = |component: u32, element: &str, bytes: &[u8]| {
        let view = file.view(bytes, "");
        let accessor = file.accessor(&format!(
            r#""bufferView": {view}, "componentType": {component}, "count": 1, "type": "{element}", "normalized": true"#
        ));
        file.load().numbers(Index::from(accessor as u32)).unwrap()
    };
    assert_eq!(numbers(5121, "VEC3", &[0, 51, 255]), [0.0, 0.2, 1.0]);
    assert_eq!(numbers(5120, "VEC4", &[0, 127, 0x81, 0x80]), [0.0, 1.0, -1.0, -1.0]);
    assert_eq!(numbers(5123, "VEC2", &[0xff, 0xff, 0, 0]), [1.0, 0.0]);
    assert_eq!(numbers(5122, "VEC3", &[0xff, 0x7f, 0x01, 0x80, 0x00, 0x80]), [1.0, -1.0, -1.0]);
}

/// An accessor of three scalars with the sparse members.
fn sparse(indices: &[u8], component: u32, values: &[f32], base: bool) -> Result<Vec<f32>, String> {
    let mut file = Builder::default();
    let base = if base { file.view(&f32_bytes(&[1.0, 2.0, 3.0]), "") } else { usize::MAX };
    let base = if base == usize::MAX { String::new() } else { format!("\"bufferView\": {base},") };
    let (indices, values_view) = (file.view(indices, ""), file.view(&f32_bytes(values), ""));
    let count = values.len();
    let accessor = file.accessor(&format!(
        r#"{base} "componentType": 5126, "count": 3, "type": "SCALAR", "sparse": {{"count": {count},
           "indices": {{"bufferView": {indices}, "componentType": {component}}}, "values": {{"bufferView": {values_view}}}}}"#
    ));
    let gltf = file.open().map_err(|error| error.to_string())?;
    let data = gltf.load(&BTreeMap::new()).map_err(|error| error.to_string())?;
    data.scalars(Index::from(accessor as u32)).map_err(|fault| fault.to_string())
}

#[test]
fn sparse_elements_replace_others() {
    assert_eq!(sparse(&[0, 2], 5121, &[7.0, 9.0], true), Ok(vec![7.0, 2.0, 9.0]));
    assert_eq!(sparse(&[1, 0], 5123, &[7.0], false), Ok(vec![0.0, 7.0, 0.0]));
    assert_eq!(sparse(&[2, 0, 0, 0], 5125, &[7.0], false), Ok(vec![0.0, 0.0, 7.0]));
}

#[test]
fn sparse_indices_rise_and_exist() {
    let message =
        |indices: &[u8], component: u32, values: &[f32]| sparse(indices, component, values, true).unwrap_err();
    let out = "/accessors/0/sparse/indices: index 3 at element 1, there are 3 elements";
    assert_eq!(message(&[0, 3], 5121, &[7.0, 9.0]), out);
    let falling = "/accessors/0/sparse/indices: the index at element 1 is not greater than that before it";
    assert_eq!(message(&[1, 1], 5121, &[7.0, 9.0]), falling);
    assert_eq!(message(&[2, 1], 5121, &[7.0, 9.0]), falling);
    let signed = message(&[0, 1], 5120, &[7.0, 9.0]);
    assert!(signed.ends_with("/indices/componentType: indices are BYTE, expected unsigned integers"), "{signed}");
    let many = message(&[0, 1, 2, 3], 5121, &[1.0; 4]);
    assert_eq!(many, "a.glb: /accessors/0/sparse/count: 4 elements are replaced, there are 3");
    let short = message(&[0, 1], 5123, &[1.0; 2]);
    assert_eq!(short, "a.glb: /accessors/0/sparse/indices: needs 4 bytes from byte 0, bufferView 1 has 2");
}

#[test]
fn numbers_must_be_finite() {
    for (bad, shown) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf"), (f32::NEG_INFINITY, "-inf")] {
        let mut file = Builder::default();
        let accessor = file.floats("VEC2", 2, &[1.0, 2.0, 3.0, bad]);
        let fault = file.load().vec2(Index::from(accessor as u32)).unwrap_err();
        assert_eq!(fault.to_string(), format!("/accessors/0: component 1 of element 1 is {shown}"));
    }
}

#[test]
fn accessor_methods_check_component_and_element_types() {
    let mut file = Builder::default();
    let vectors = Index::from(file.floats("VEC3", 3, &[1.0, 2.0, 3.0]) as u32);
    let joints = Index::from(file.array(5121, "VEC4", 1, &[1, 2, 3, 4]) as u32);
    let indices = Index::from(file.array(5123, "SCALAR", 2, &[1, 2, 3, 4]) as u32);
    let identity: Vec<f32> = (0..16).map(|i| f32::from(u8::from(i % 5 == 0))).collect();
    let matrix = Index::from(file.floats("MAT4", 16, &identity) as u32);
    let data = file.load();
    assert_eq!(data.vec3(vectors), Ok(vec![Vec3::new(1.0, 2.0, 3.0)]));
    assert_eq!(data.joints(joints), Ok(vec![[1, 2, 3, 4]]));
    assert_eq!(data.vec4(joints), Ok(vec![[1.0, 2.0, 3.0, 4.0]]));
    assert_eq!(data.indices(indices), Ok(vec![0x201, 0x403]));
    assert_eq!(data.scalars(indices), Ok(vec![513.0, 1027.0]));
    assert_eq!(data.mat4(matrix).unwrap()[0].as_slice(), identity);
    assert_eq!(data.vec2(vectors).unwrap_err().to_string(), "/accessors/0: is VEC3, expected 2 components");
    assert_eq!(data.indices(vectors).unwrap_err().to_string(), "/accessors/0: indices cannot be FLOAT");
    assert_eq!(data.joints(vectors).unwrap_err().to_string(), "/accessors/0: joints cannot be FLOAT");
    assert_eq!(data.vec3(Index::from(9)).unwrap_err().to_string(), "/accessors/9: there is no such accessor");
}

#[test]
fn decoded_bytes_are_limited() {
    let json = |count: u64| {
        format!(
            r#"{{"asset": {{"version": "2.0"}}, "accessors": [{{"componentType": 5126, "count": {count}, "type": "VEC3"}}]}}"#
        )
    };
    let load = |count: u64, decoded_bytes: u64| {
        let limits = Limits { decoded_bytes, ..Limits::default() };
        Gltf::open("a.gltf", json(count).into_bytes(), &limits).map(|gltf| gltf.load(&BTreeMap::new()).unwrap())
    };
    let data = load(100, u64::MAX).unwrap();
    assert_eq!(data.vec3(Index::from(0)), Ok(vec![Vec3::ZERO; 100]));
    assert_eq!(data.decoded_bytes(), 1200);
    // Small files have a small limit of their own.
    let data = load(1 << 40, u64::MAX).unwrap();
    let fault = data.vec3(Index::from(0)).unwrap_err().to_string();
    let limit = (64 << 20) + 1000 * json(1 << 40).len();
    assert_eq!(fault, format!("/accessors/0: the arrays of the file need more than {limit} bytes, the limit"));
    let data = load(100, 2000).unwrap();
    assert!(data.vec3(Index::from(0)).is_ok() && data.vec3(Index::from(0)).is_err());
    assert!(load(1 << 62, 1 << 40).unwrap_err().to_string().contains("bytes without a buffer view"));
}
