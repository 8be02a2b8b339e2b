use super::{ComponentType, DracoAttribute, DracoError, DracoLimits, DracoMesh, decode};

const LIMITS: DracoLimits = DracoLimits { triangles: 131_072, bytes: 1 << 26 };

/// A stream of the reference encoder, and what the reference decoder makes of it.
struct Known {
    stream: Vec<u8>,
    vertices: usize,
    indices: u64,
    attributes: Vec<DracoAttribute<'static>>,
    /// Hashes of the attributes' values.
    values: Vec<u64>,
}

/// All streams that `streams.mjs` writes.
fn known() -> Vec<Known> {
    include_str!("streams.txt").lines().map(parse).collect()
}

fn parse(line: &'static str) -> Known {
    let words: Vec<&str> = line.split(' ').collect();
    let byte = |at: usize| u8::from_str_radix(&words[0][2 * at..2 * at + 2], 16).unwrap();
    let hash = |word: &str| u64::from_str_radix(word, 16).unwrap();
    let attributes = words[3..].chunks(5);
    Known {
        stream: (0..words[0].len() / 2).map(byte).collect(),
        vertices: words[1].parse().unwrap(),
        indices: hash(words[2]),
        values: attributes.clone().map(|attribute| hash(attribute[4])).collect(),
        attributes: attributes.map(attribute).collect(),
    }
}

fn attribute(words: &[&'static str]) -> DracoAttribute<'static> {
    let component = match words[2] {
        "I16" => ComponentType::I16,
        "U8" => ComponentType::U8,
        "U16" => ComponentType::U16,
        "F32" => ComponentType::F32,
        other => panic!("{other}"),
    };
    let (unique_id, components) = (words[1].parse().unwrap(), words[3].parse().unwrap());
    DracoAttribute { name: words[0], unique_id, component, components }
}

/// FNV-1a hash of 64 bits.
fn hash(bytes: &[u8]) -> u64 {
    let step = |state: u64, byte: &u8| (state ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

fn run(known: &Known, stream: &[u8]) -> Result<DracoMesh, DracoError> {
    decode(stream, &known.attributes, &LIMITS)
}

/// Streams of few vertices.
fn small() -> Vec<Known> {
    known().into_iter().filter(|known| known.vertices < 10_000).collect()
}

#[test]
fn streams_of_the_reference_encoder_decode_to_the_same_bytes() {
    let all = known();
    assert_eq!(all.len(), 10);
    for (line, known) in all.iter().enumerate() {
        let mesh = run(known, &known.stream).unwrap_or_else(|error| panic!("line {}: {error}", line + 1));
        assert_eq!(mesh.vertices, known.vertices, "line {}", line + 1);
        let indices: Vec<u8> = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        assert_eq!(hash(&indices), known.indices, "line {}", line + 1);
        for ((values, expected), attribute) in mesh.attributes.iter().zip(&known.values).zip(&known.attributes) {
            assert_eq!(hash(values), *expected, "line {}: {}", line + 1, attribute.name);
        }
    }
}

#[test]
fn cut_streams_are_errors() {
    for known in small() {
        for length in 0..known.stream.len() {
            assert!(run(&known, &known.stream[..length]).is_err(), "at {length} of {}", known.stream.len());
        }
    }
}

#[test]
fn changed_streams_do_not_panic() {
    for known in small() {
        let mut stream = known.stream.clone();
        for at in 0..stream.len() {
            let original = stream[at];
            for mask in [0x01, 0x08, 0x80, 0xff] {
                stream[at] = original ^ mask;
                if let Ok(mesh) = run(&known, &stream) {
                    assert!(mesh.indices.iter().all(|index| (*index as usize) < mesh.vertices));
                }
            }
            stream[at] = original;
        }
    }
}

#[test]
fn the_number_of_triangles_is_limited_and_not_by_the_length_of_the_stream() {
    let all = known();
    let grid = all.last().unwrap();
    assert!(grid.stream.len() < 131_072 / 20, "a flat grid needs hardly any bytes");
    assert_eq!(run(grid, &grid.stream).unwrap().indices.len(), 3 * 131_072);
    let limits = DracoLimits { triangles: 131_071, ..LIMITS };
    let error = decode(&grid.stream, &grid.attributes, &limits).unwrap_err();
    assert_eq!(error, DracoError::Triangles { limit: 131_071 });
    let limits = DracoLimits { bytes: 12 * 131_072 - 1, ..LIMITS };
    let error = decode(&grid.stream, &grid.attributes, &limits).unwrap_err();
    assert_eq!(error, DracoError::TooLarge { limit: limits.bytes }, "of triangles alone");
}

#[test]
fn the_number_of_bytes_is_limited() {
    let known = &small()[1];
    // Without the attributes, the indices alone are 32 triangles of 12 bytes.
    for bytes in [0, 100, 12 * 32, 1000] {
        let limits = DracoLimits { bytes, ..LIMITS };
        let error = decode(&known.stream, &known.attributes, &limits).unwrap_err();
        assert!(matches!(error, DracoError::TooLarge { .. } | DracoError::Decoder { .. }), "{bytes}: {error}");
    }
}

#[test]
fn requests_that_do_not_fit_the_stream_are_named() {
    let known = &small()[1];
    let message = |change: &dyn Fn(&mut DracoAttribute<'_>)| {
        let mut request = known.attributes[0].clone();
        change(&mut request);
        decode(&known.stream, &[request], &LIMITS).unwrap_err().to_string()
    };
    let absent = message(&|request| request.unique_id = 77);
    assert_eq!(absent, "POSITION is attribute 77, which the Draco stream does not have");
    let components = message(&|request| request.components = 4);
    assert_eq!(components, "POSITION has 3 components in the Draco stream, its accessor has 4");
    let kind = message(&|request| request.component = ComponentType::U16);
    assert_eq!(
        kind,
        "POSITION is stored as Float32 in the Draco stream, which does not fit its accessor (UNSIGNED_SHORT)"
    );
    // The joints have the value 200, which a signed byte does not hold.
    let joints = DracoAttribute { component: ComponentType::I8, ..known.attributes[4].clone() };
    let message = decode(&known.stream, &[joints], &LIMITS).unwrap_err().to_string();
    assert_eq!(message, "JOINTS_0 is stored as Uint8 in the Draco stream, which does not fit its accessor (BYTE)");
}

#[test]
fn other_data_is_no_mesh() {
    for stream in [&b""[..], b"DRACO", b"DRACO\x02\x02\x00\x01\x00\x00", b"DRACO\x01\x01\x01\x00\x00\x00", b"glTF....."]
    {
        assert_eq!(decode(stream, &[], &LIMITS), Err(DracoError::NotAMesh));
    }
}
