use super::{Ktx2Encoding, Ktx2Error, decode, read_head};

/// A file of the reference encoder, and what the reference decoder makes of it.
struct Known {
    file: Vec<u8>,
    width: u32,
    height: u32,
    /// Hash of the texels of level 0.
    #[cfg_attr(not(feature = "ktx2"), expect(dead_code, reason = "this build decodes no texels"))]
    texels: u64,
}

/// All files that `streams.mjs` writes.
fn known() -> Vec<Known> {
    let lines = include_str!("streams.txt").lines();
    let known = lines.map(|line| {
        let words: Vec<&str> = line.split(' ').collect();
        let byte = |at: usize| u8::from_str_radix(&words[0][2 * at..2 * at + 2], 16).unwrap();
        Known {
            file: (0..words[0].len() / 2).map(byte).collect(),
            width: words[1].parse().unwrap(),
            height: words[2].parse().unwrap(),
            texels: u64::from_str_radix(words[3], 16).unwrap(),
        }
    });
    known.collect()
}

#[test]
fn heads_of_the_reference_encoder_are_read() {
    let heads: Vec<_> = known().iter().map(|known| read_head(&known.file).unwrap()).collect();
    for (head, known) in heads.iter().zip(known()) {
        assert_eq!((head.width, head.height), (known.width, known.height));
    }
    let encodings: Vec<_> = heads.iter().map(|head| (head.encoding, head.levels)).collect();
    let (etc1s, uastc) = (Ktx2Encoding::Etc1s, Ktx2Encoding::Uastc);
    assert_eq!(encodings, [(etc1s, 1), (etc1s, 1), (etc1s, 5), (uastc, 1), (uastc, 1), (uastc, 5)]);
}

#[cfg(not(feature = "ktx2"))]
#[test]
fn a_build_without_the_decoder_refuses_files_by_name() {
    let message = decode(&known()[0].file, 1 << 20).unwrap_err().to_string();
    assert!(message.contains("KHR_texture_basisu") && message.contains("`ktx2`"), "{message}");
    assert_eq!(decode(&[], 0), Err(Ktx2Error::Disabled));
}

#[cfg(feature = "ktx2")]
#[test]
fn texels_equal_those_of_the_reference_decoder() {
    // FNV-1a hash of 64 bits.
    let step = |state: u64, byte: &u8| (state ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
    for (line, known) in known().iter().enumerate() {
        let picture = decode(&known.file, 1 << 20).unwrap();
        assert_eq!((picture.width, picture.height), (known.width, known.height));
        assert_eq!(picture.rgba.iter().fold(0xcbf2_9ce4_8422_2325, step), known.texels, "line {}", line + 1);
        let limited = decode(&known.file, u64::from(known.width * known.height) - 1);
        assert!(matches!(limited, Err(Ktx2Error::TooLarge { .. })), "{limited:?}");
    }
}

#[test]
fn cut_files_are_errors() {
    for known in known() {
        for length in 0..known.file.len() {
            assert!(decode(&known.file[..length], 1 << 20).is_err(), "at {length}");
            // The encoder writes the levels last, so each cut removes a part of a block.
            assert!(read_head(&known.file[..length]).is_err(), "at {length}");
        }
    }
}

#[test]
fn changed_files_do_not_panic() {
    for known in known() {
        let mut file = known.file.clone();
        for at in 0..file.len() {
            let original = file[at];
            for mask in [0x01, 0x08, 0x80, 0xff] {
                file[at] = original ^ mask;
                let head = read_head(&file);
                if let Ok(picture) = decode(&file, 1 << 16) {
                    assert_eq!(picture.rgba.len() as u32, 4 * picture.width * picture.height);
                    assert!(head.is_ok());
                }
            }
            file[at] = original;
        }
    }
}

/// Message about a file with these bytes changed.
fn message(known: &Known, changes: &[(usize, &[u8])]) -> String {
    let mut file = known.file.clone();
    for (at, bytes) in changes {
        file[*at..*at + bytes.len()].copy_from_slice(bytes);
    }
    read_head(&file).unwrap_err().to_string()
}

#[test]
fn errors_name_the_field() {
    let all = known();
    let (etc1s, uastc) = (&all[0], &all[3]);
    assert_eq!(read_head(b"\x89PNG"), Err(Ktx2Error::NotKtx2));
    assert_eq!(message(uastc, &[(12, &[37])]), "vkFormat is 37, expected 0");
    assert_eq!(message(uastc, &[(22, &[1])]), "pixelWidth is 65544, expected 1 to 16384");
    assert_eq!(message(uastc, &[(24, &[0])]), "pixelHeight is 0, expected 1 to 16384");
    assert_eq!(message(uastc, &[(28, &[1])]), "pixelDepth is 1, expected 0");
    assert_eq!(message(uastc, &[(32, &[2])]), "layerCount is 2, expected 0 or 1");
    assert_eq!(message(uastc, &[(36, &[6])]), "faceCount is 6, expected 1");
    assert_eq!(message(uastc, &[(40, &[16])]), "levelCount is 16, expected 1 to 15");
    assert_eq!(message(uastc, &[(44, &[3])]), "supercompressionScheme is 3, expected 0, 1 or 2");
    let wrong = "colorModel is 166, expected 163 (ETC1S) with scheme 1, or 166 (UASTC) with scheme 0 or 2";
    assert_eq!(message(uastc, &[(44, &[1])]), wrong);
    // Lengths of a level that would demand hundreds of gigabytes.
    let length = uastc.file.len();
    let start = length - 64;
    let huge = message(uastc, &[(88, &[0xff; 5])]);
    assert_eq!(huge, format!("a level has 1099511627775 bytes from byte {start}, the file has {length}"));
    let decoded = "is 1099511627775, expected 16 bytes per block of 4×4 texels, or 0 with scheme 1";
    assert_eq!(message(uastc, &[(96, &[0xff; 5])]), format!("uncompressedByteLength {decoded}"));
    let overflow = message(uastc, &[(80, &[0xff; 8])]);
    assert!(overflow.starts_with("a level has 64 bytes from byte 18446744073709551615, "), "{overflow}");
    let global = message(etc1s, &[(64, &[0xff; 8])]);
    assert!(global.starts_with("the global data has "), "{global}");
}
