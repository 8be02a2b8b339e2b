use super::{FREE_BYTES, Filter, MAX_EXPANSION, MeshoptError, Mode, decode};

/// A stream of the reference encoder.
struct Known {
    mode: Mode,
    filter: Filter,
    count: usize,
    stride: usize,
    /// Hash of the result of the reference decoder.
    hash: u64,
    stream: Vec<u8>,
}

/// All streams that `streams.mjs` writes.
fn known() -> Vec<Known> {
    let lines = include_str!("streams.txt").lines();
    let known = lines.map(|line| {
        let words: Vec<&str> = line.split(' ').collect();
        let digit = |at: usize| u8::from_str_radix(&words[5][at..at + 2], 16).unwrap();
        Known {
            mode: Mode::from_name(words[0]).unwrap(),
            filter: Filter::from_name(words[1]).unwrap(),
            count: words[2].parse().unwrap(),
            stride: words[3].parse().unwrap(),
            hash: u64::from_str_radix(words[4], 16).unwrap(),
            stream: (0..words[5].len() / 2).map(|byte| digit(2 * byte)).collect(),
        }
    });
    known.collect()
}

/// FNV-1a hash of 64 bits.
fn hash(bytes: &[u8]) -> u64 {
    let step = |state: u64, byte: &u8| (state ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, step)
}

fn run(known: &Known, stream: &[u8]) -> Result<Vec<u8>, MeshoptError> {
    decode(known.mode, known.filter, known.count, known.stride, stream)
}

#[test]
fn streams_of_the_reference_encoder_decode_to_the_same_bytes() {
    let all = known();
    assert!(all.len() > 150, "{} streams", all.len());
    for (line, known) in all.iter().enumerate() {
        let bytes = run(known, &known.stream).unwrap_or_else(|error| panic!("line {}: {error}", line + 1));
        assert_eq!(bytes.len(), known.count * known.stride, "line {}", line + 1);
        assert_eq!(hash(&bytes), known.hash, "line {}", line + 1);
    }
}

/// Each mode and filter has a stream, and so have both versions of attributes.
#[test]
fn all_codecs_and_filters_are_tested() {
    let all = known();
    let has = |test: &dyn Fn(&Known) -> bool| all.iter().any(test);
    for mode in [Mode::Attributes, Mode::Triangles, Mode::Indices] {
        assert!(has(&|known| known.mode == mode), "{mode:?}");
    }
    for filter in [Filter::None, Filter::Octahedral, Filter::Quaternion, Filter::Exponential, Filter::Color] {
        assert!(has(&|known| known.filter == filter), "{filter:?}");
    }
    for header in [0xa0, 0xa1, 0xd1, 0xe1] {
        assert!(has(&|known| known.stream.first() == Some(&header)), "{header:#x}");
    }
    // Modes of channels are the last byte of a stream of version 1.
    for mode in 0..3 {
        let is_used = |known: &Known| known.stream.first() == Some(&0xa1) && known.stream.last().unwrap() & 15 == mode;
        assert!(has(&is_used), "channel mode {mode}");
    }
}

/// The example of the extension's README: four bits per byte and two sentinels.
#[test]
fn example_of_the_specification_is_decoded() {
    let group = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
    let differences = [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0];
    // Header, plane 0 with mode 2, planes 1 to 3 with mode 0, and a tail of zeros.
    let stream = [&[0xa0, 2][..], &group, &[0, 0, 0], &[0; 32]].concat();
    let bytes = decode(Mode::Attributes, Filter::None, 16, 4, &stream).unwrap();
    let mut sum = 0_u8;
    for (element, difference) in bytes.chunks(4).zip(differences) {
        sum = sum.wrapping_add_signed(difference);
        assert_eq!(element, [sum, 0, 0, 0]);
    }
}

/// A stream that is truncated at any length is rejected, because its tail moves.
#[test]
fn cut_streams_are_errors() {
    for known in known() {
        for length in 0..known.stream.len() {
            let result = run(&known, &known.stream[..length]);
            assert!(known.count == 0 || result.is_err(), "{:?} {} at {length}", known.mode, known.count);
        }
    }
}

/// Flipped bits give an error or a result of the same size.
#[test]
fn changed_streams_do_not_panic() {
    for known in known().iter().filter(|known| known.stream.len() < 500) {
        let mut stream = known.stream.clone();
        for at in 0..stream.len() {
            let original = stream[at];
            for mask in [0x01, 0x02, 0x0f, 0x10, 0x40, 0x80, 0xf0, 0xff] {
                stream[at] = original ^ mask;
                if let Ok(bytes) = run(known, &stream) {
                    assert_eq!(bytes.len(), known.count * known.stride);
                }
            }
            stream[at] = original;
        }
    }
}

/// A stream with other parameters than its own.
#[test]
fn wrong_parameters_do_not_panic() {
    for known in known().iter().step_by(7) {
        for mode in [Mode::Attributes, Mode::Triangles, Mode::Indices] {
            for stride in [0, 1, 2, 3, 4, 8, 16, 60, 256, 260, usize::MAX] {
                for count in [0, 1, 3, known.count + 1, 3 * known.count, 100_000, usize::MAX] {
                    if let Ok(bytes) = decode(mode, Filter::None, count, stride, &known.stream) {
                        assert_eq!(bytes.len(), count * stride);
                    }
                }
            }
        }
    }
}

fn error(mode: Mode, filter: Filter, count: usize, stride: usize, stream: &[u8]) -> String {
    decode(mode, filter, count, stride, stream).unwrap_err().to_string()
}

#[test]
fn errors_name_the_parameter() {
    let attributes = |filter, stride| error(Mode::Attributes, filter, 1, stride, &[]);
    assert_eq!(attributes(Filter::None, 6), "byteStride is 6, ATTRIBUTES needs a multiple of 4 up to 256");
    assert_eq!(attributes(Filter::None, 260), "byteStride is 260, ATTRIBUTES needs a multiple of 4 up to 256");
    assert_eq!(attributes(Filter::Octahedral, 12), "byteStride is 12, OCTAHEDRAL needs 4 or 8");
    assert_eq!(attributes(Filter::Quaternion, 4), "byteStride is 4, QUATERNION needs 8");
    assert_eq!(error(Mode::Indices, Filter::None, 1, 8, &[]), "byteStride is 8, INDICES needs 2 or 4");
    assert_eq!(error(Mode::Triangles, Filter::None, 4, 2, &[]), "count is 4, TRIANGLES needs a multiple of 3");
    let message = error(Mode::Indices, Filter::Color, 1, 2, &[]);
    assert_eq!(message, "mode INDICES takes no filter, COLOR is given");
}

#[test]
fn errors_name_the_place_in_the_stream() {
    let indices = |count, stream: &[u8]| error(Mode::Indices, Filter::None, count, 4, stream);
    assert_eq!(indices(1, &[]), "the stream begins with nothing, expected 0xd1");
    assert_eq!(indices(1, &[0xe1, 0, 0]), "the stream begins with 0xe1, expected 0xd1");
    assert_eq!(indices(2, &[0xd1, 8, 0, 0, 0, 0]), "byte 2: the stream ends too early");
    assert_eq!(indices(1, &[0xd1, 8, 8, 0, 0, 0, 0]), "byte 2: 1 bytes are left after the last element");
    let long = [0xd1, 0x80, 0x80, 0x80, 0x80, 0x80, 0, 0, 0, 0, 0];
    assert_eq!(indices(1, &long), "byte 1: an integer has more than 5 bytes");
    let stream = |code, table: u8| [&[0xe1, code], &[table; 1][..], &[0; 15]].concat();
    let triangle = |stream: &[u8]| error(Mode::Triangles, Filter::None, 3, 4, stream);
    assert_eq!(triangle(&stream(0x00, 0)), "triangle 0 refers to an edge that does not exist");
    assert_eq!(triangle(&stream(0xf0, 1)), "triangle 0 refers to a vertex that does not exist");
    let message = "byte 0 of the table at the end: no half of a byte may be 15, and the last two bytes are 0";
    assert_eq!(triangle(&stream(0xf0, 0x1f)), message);
    let channel = [&[0xa1][..], &[0; 23], &[3]].concat();
    let message = error(Mode::Attributes, Filter::None, 0, 4, &channel);
    assert_eq!(message, "channel 0 has mode 0x03, expected 0x00, 0x01 or 0x_2");
}

/// The limit is checked before memory is reserved.
#[test]
fn results_are_limited_by_the_length_of_the_stream() {
    let stream = [&[0xa1, 2][..], &[0; 24]].concat();
    let limit = MAX_EXPANSION * stream.len() as u64 + FREE_BYTES;
    let result = decode(Mode::Attributes, Filter::None, limit as usize / 4 + 1, 4, &stream);
    assert!(matches!(result, Err(MeshoptError::TooLarge { limit: found, .. }) if found == limit), "{result:?}");
    let result = decode(Mode::Attributes, Filter::None, limit as usize / 4, 4, &stream);
    assert!(matches!(result, Err(MeshoptError::Truncated { .. })), "{result:?}");
    let result = decode(Mode::Attributes, Filter::None, usize::MAX, 256, &stream);
    assert!(matches!(result, Err(MeshoptError::TooLarge { .. })), "{result:?}");
}
