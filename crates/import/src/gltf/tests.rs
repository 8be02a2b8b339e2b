//! Tests of whole files.

use super::document::Index;
use super::testing::{Builder, f32_bytes, glb};
use super::{Assembly, FileError, Files, Gltf, GltfData, Limits};
use std::collections::BTreeMap;

/// A file with attributes, indices, sparse elements, a skin and an animation.
fn rich() -> Builder {
    let mut file = Builder::default();
    file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    file.array(5123, "SCALAR", 3, &[0, 0, 1, 0, 2, 0]);
    file.array(5121, "VEC4", 3, &[0; 12]);
    file.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0].repeat(3));
    file.floats("SCALAR", 1, &[0.0, 1.0]);
    file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
    let (indices, values) = (file.view(&[1, 0, 2, 0], ""), file.view(&f32_bytes(&[0.5; 6]), ""));
    file.accessor(&format!(
        r#""bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "sparse": {{"count": 2,
           "indices": {{"bufferView": {indices}, "componentType": 5123}}, "values": {{"bufferView": {values}}}}}"#
    ));
    file.member(
        r#""meshes": [{"primitives": [{"attributes": {"POSITION": 0, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 1,
                       "targets": [{"POSITION": 6}]}]}]"#,
    );
    file.member(r#""nodes": [{"mesh": 0, "skin": 0, "children": [1]}, {"translation": [0, 1, 0]}]"#);
    file.member(r#""skins": [{"joints": [1]}], "scenes": [{"nodes": [0]}], "scene": 0"#);
    file.member(
        r#""animations": [{"samplers": [{"input": 4, "output": 5}],
                           "channels": [{"sampler": 0, "target": {"node": 1, "path": "translation"}}]}]"#,
    );
    file
}

/// Decodes all accessors and primitives; whether all are valid.
fn decode(data: &GltfData) -> bool {
    let document = &data.gltf.document;
    let accessors = 0..document.accessors.len() as u32;
    let numbers = accessors.map(|accessor| data.numbers(Index::from(accessor)).is_ok());
    let meshes = document.meshes.iter().enumerate();
    let primitives = meshes.flat_map(|(mesh, found)| (0..found.primitives.len()).map(move |part| (mesh, part)));
    let assembled = primitives.map(|(mesh, part)| data.assemble(mesh, part).is_ok());
    numbers.chain(assembled).fold(true, |all, is_valid| all & is_valid)
}

/// Opens and decodes a file; whether all is valid.
fn reads(bytes: Vec<u8>) -> bool {
    let gltf = Gltf::open("a.glb", bytes, &Limits { decoded_bytes: 1 << 24, ..Limits::default() });
    gltf.and_then(|gltf| gltf.load(&BTreeMap::new())).is_ok_and(|data| decode(&data))
}

#[test]
fn every_truncation_is_refused() {
    let bytes = rich().glb();
    assert!(reads(bytes.clone()));
    for length in 0..bytes.len() {
        assert!(!reads(bytes[..length].to_vec()), "{length}");
    }
    // The JSON text alone, cut likewise.
    let text = rich().json();
    for length in 0..text.len() {
        assert!(!reads(text.as_bytes()[..length].to_vec()), "{length}");
    }
}

#[test]
fn no_changed_byte_is_a_panic() {
    let bytes = rich().glb();
    let mut accepted = 0;
    for position in 0..bytes.len() {
        for change in [1, 0x10, 0x80, 0xff] {
            let mut changed = bytes.clone();
            changed[position] ^= change;
            accepted += usize::from(reads(changed));
        }
    }
    assert!(accepted > bytes.len() / 4 && accepted < 2 * bytes.len(), "{accepted} of {}", 4 * bytes.len());
}

#[test]
fn every_number_may_be_extreme() {
    let (json, binary) = (rich().json(), rich().load().buffer(Index::from(0)).unwrap().to_vec());
    let is_number = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
    let starts = (1..json.len()).filter(|at| {
        let before = &json.as_bytes()[..*at];
        is_number(&json.as_bytes()[*at]) && (before.ends_with(b" ") || before.ends_with(b"["))
    });
    let starts: Vec<usize> = starts.collect();
    assert!(starts.len() > 60, "{} numbers", starts.len());
    for start in starts {
        let end = start + json.as_bytes()[start..].iter().take_while(|byte| is_number(byte)).count();
        for number in
            ["-1", "0", "1", "255", "4294967295", "18446744073709551615", "1e39", "1e-46", "1e308", "0.5", "null"]
        {
            let changed = format!("{}{number}{}", &json[..start], &json[end..]);
            // Whether the file is valid depends on the number.
            let _ = reads(glb(&changed, &binary));
        }
    }
}

#[test]
fn every_index_that_is_off_by_one_is_refused() {
    let json = rich().json();
    for (valid, invalid) in [
        (r#""POSITION": 0"#, r#""POSITION": 7"#),
        (r#""indices": 1"#, r#""indices": 7"#),
        (r#""mesh": 0"#, r#""mesh": 1"#),
        (r#""skin": 0"#, r#""skin": 1"#),
        (r#""children": [1]"#, r#""children": [2]"#),
        (r#""joints": [1]"#, r#""joints": [2]"#),
        (r#""scenes": [{"nodes": [0]}]"#, r#""scenes": [{"nodes": [2]}]"#),
        (r#""scene": 0"#, r#""scene": 1"#),
        (r#""input": 4"#, r#""input": 7"#),
        (r#""output": 5"#, r#""output": 7"#),
        (r#""sampler": 0"#, r#""sampler": 1"#),
        (r#""node": 1"#, r#""node": 2"#),
        (r#""bufferView": 0"#, r#""bufferView": 8"#),
        (r#""count": 3"#, r#""count": 4"#),
    ] {
        assert!(json.contains(valid), "{valid}");
        let changed = glb(&json.replacen(valid, invalid, 1), &[0; 1000]);
        let error = Gltf::open("a.glb", changed, &Limits::default()).map(|_| ()).unwrap_err().to_string();
        assert!(error.starts_with("a.glb: /"), "{invalid}: {error}");
    }
}

/// A document with a buffer of three floating point numbers at a URI.
fn with_uri(uri: &str) -> Gltf {
    let text = format!(
        r#"{{"asset": {{"version": "2.0"}}, "buffers": [{{"byteLength": 12, "uri": "{uri}"}}],
             "bufferViews": [{{"buffer": 0, "byteLength": 12}}], "images": [{{"uri": "a%20b.png"}}, {{"bufferView": 0}}],
             "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "SCALAR"}}]}}"#
    );
    Gltf::open("a.gltf", text.into_bytes(), &Limits::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn files<const N: usize>(files: [(&str, usize); N]) -> BTreeMap<String, Vec<u8>> {
    files.into_iter().map(|(name, length)| (name.to_owned(), vec![0; length])).collect()
}

#[test]
fn buffers_are_read_from_files() {
    let zeros = Ok(vec![0.0; 3]);
    let scalars = |uri: &str, files: &BTreeMap<String, Vec<u8>>| {
        with_uri(uri)
            .load(files)
            .map_err(|error| error.to_string())?
            .scalars(Index::from(0))
            .map_err(|fault| fault.to_string())
    };
    assert_eq!(scalars("a.bin", &files([("a.bin", 12)])), zeros);
    assert_eq!(scalars("a.bin", &files([("a.bin", 1000)])), zeros, "longer is fine");
    assert_eq!(scalars("d/a%20b.bin", &files([("d/a b.bin", 12)])), zeros);
    assert_eq!(scalars("d/a%20b.bin", &files([("d/a%20b.bin", 12)])), zeros, "the name as written");
    let text = "a.gltf: /buffers/0: needs 12 bytes, its data has 11";
    assert_eq!(scalars("a.bin", &files([("a.bin", 11)])), Err(text.to_owned()));
    let text = "a.gltf: d/a b.bin (/buffers/0/uri): no such file";
    assert_eq!(scalars("d/a%20b.bin", &files([])), Err(text.to_owned()));
    let text = "a.gltf: /buffers/0/uri: `https://a.b/c`: URIs with the scheme `https` are not read; copy the file beside the document";
    assert_eq!(scalars("https://a.b/c", &files([])), Err(text.to_owned()));
    assert_eq!(scalars("data:;base64,AACAPwAAAEAAAEBA", &files([])), Ok(vec![1.0, 2.0, 3.0]));
}

#[test]
fn sizes_of_files_are_limited() {
    let mut gltf = with_uri("a.bin");
    gltf.limits.buffer_bytes = 99;
    let error = gltf.load(&files([("a.bin", 100)])).unwrap_err().to_string();
    assert_eq!(error, "a.gltf: a.bin (/buffers/0/uri): the file has 100 bytes, the limit is 99");
}

#[test]
fn images_are_files_or_buffer_views() {
    let files = files([("a.bin", 12), ("a b.png", 5)]);
    let data = with_uri("a.bin").load(&files).unwrap();
    assert_eq!(data.image(Index::from(0), &files).unwrap().len(), 5);
    assert_eq!(data.image(Index::from(1), &files).unwrap().len(), 12);
    let fault = data.image(Index::from(0), &BTreeMap::new()).unwrap_err().to_string();
    assert_eq!(fault, "a b.png (/images/0/uri): no such file");
    assert!(data.image(Index::from(2), &files).is_err());
}

/// Files that cannot be read.
struct Broken;

impl Files for Broken {
    fn read(&self, _: &str, _: u64) -> Result<Vec<u8>, FileError> {
        Err(FileError::Read("permission denied".to_owned()))
    }
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let error = with_uri("a%20b.bin").load(&Broken).unwrap_err().to_string();
    assert_eq!(error, "a.gltf: a b.bin (/buffers/0/uri): cannot be read: permission denied");
}

/// Files of a lenient reader, of which none exists.
struct Lenient;

impl Files for Lenient {
    fn read(&self, _: &str, _: u64) -> Result<Vec<u8>, FileError> {
        Err(FileError::Missing)
    }

    fn is_lenient(&self) -> bool {
        true
    }
}

/// Broken embedded pictures are named by their pointers and names, the first few of them.
#[test]
fn lost_pictures_are_named() {
    let warnings = |count: usize| {
        let image = |i: usize| format!(r#"{{"name": "wood {i}", "uri": "data:image/png;base64,AAAA"}}"#);
        let texture = |i: usize| format!(r#"{{"source": {i}}}"#);
        let list = |item: &dyn Fn(usize) -> String| (0..count).map(item).collect::<Vec<_>>().join(", ");
        let (images, textures) = (list(&image), list(&texture));
        let text = format!(r#"{{"asset": {{"version": "2.0"}}, "images": [{images}], "textures": [{textures}]}}"#);
        let gltf = Gltf::open("a.gltf", text.into_bytes(), &Limits::default()).unwrap();
        let mut data = gltf.load(&Lenient).unwrap();
        data.load_media(&Lenient, &juggler_math::BuildControl::default()).unwrap();
        data.gltf.warnings.texts().join("\n")
    };
    let first = "/images/0 (wood 0): cannot read `wood 0`: its first bytes match no supported format";
    for (count, rest) in [
        (1, ""),
        (2, ", as is /images/1 (wood 1)"),
        (3, ", as are /images/1 (wood 1), /images/2 (wood 2)"),
        (6, ", as are /images/1 (wood 1), /images/2 (wood 2), /images/3 (wood 3) and 2 more"),
    ] {
        let text = warnings(count);
        assert!(text.starts_with(first), "{text}");
        assert!(text.ends_with(&format!("the picture is shown gray{rest}")), "{text}");
    }
}

/// File whose only buffer view is compressed, with a stream of a test of the decoder.
fn compressed(extension: &str) -> (Builder, String, usize) {
    let line = include_str!("meshopt/streams.txt")
        .lines()
        .find(|line| line.starts_with("ATTRIBUTES NONE ") && !line.starts_with("ATTRIBUTES NONE 0 "));
    let words: Vec<&str> = line.expect("there is no such stream").split(' ').collect();
    let (count, stride): (usize, usize) = (words[2].parse().unwrap(), words[3].parse().unwrap());
    let hex = words[5].as_bytes().chunks(2);
    let stream: Vec<u8> = hex.map(|pair| u8::from_str_radix(std::str::from_utf8(pair).unwrap(), 16).unwrap()).collect();
    let mut file = Builder::default();
    file.view(&stream, "");
    let (length, decoded) = (stream.len(), count * stride);
    let members = format!(
        r#""buffer": 0, "byteLength": {length}, "byteStride": {stride}, "count": {count}, "mode": "ATTRIBUTES""#
    );
    // The range is that of a buffer for readers without the decoder.
    let json = file.json().replace(
        r#""bufferViews": ["#,
        &format!(
            r#""bufferViews": [{{"buffer": 1, "byteLength": {decoded}, "extensions": {{"{extension}": {{{members}}}}}}}, "#
        ),
    );
    let fallback = format!(
        r#"}}, {{"byteLength": {decoded}, "extensions": {{"{extension}": {{"fallback": true}}}}}}], "bufferViews""#
    );
    (file, json.replacen(r#"}], "bufferViews""#, &fallback, 1), decoded)
}

#[test]
fn compressed_views_are_decoded() {
    for extension in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let (file, json, decoded) = compressed(extension);
        let binary = file.load().buffer(Index::from(0)).unwrap().to_vec();
        let open = |binary: &[u8]| {
            let gltf =
                Gltf::open("a.glb", glb(&json, binary), &Limits::default()).unwrap_or_else(|error| panic!("{error}"));
            gltf.load(&BTreeMap::new()).unwrap()
        };
        let data = open(&binary);
        assert_eq!(data.view(Index::from(0)).unwrap().len(), decoded);
        assert_eq!(data.decoded_bytes(), decoded as u64);
        assert!(data.view(Index::from(0)).is_ok() && data.decoded_bytes() == decoded as u64, "decoded once");
        let fault = data.buffer(Index::from(1)).unwrap_err().to_string();
        assert_eq!(fault, "/buffers/1: has no data; buffer views that are not compressed cannot use it");
        let fault = open(&vec![0; binary.len()]).view(Index::from(0)).unwrap_err().to_string();
        assert!(fault.starts_with(&format!("/bufferViews/0/extensions/{extension}: ")), "{fault}");
    }
}

#[test]
fn rich_files_have_their_arrays() {
    let data = rich().load();
    let Ok(Assembly::Arrays(arrays)) = data.assemble(0, 0) else { panic!("no arrays") };
    assert_eq!((arrays.vertices.positions.len(), arrays.faces.len(), arrays.joints.len()), (3, 1, 1));
    assert_eq!(arrays.targets[0].positions[2].to_array(), [0.5; 3]);
    assert!(data.gltf.warnings.list().is_empty() && arrays.warnings.list().is_empty());
}
