//! TIFF, TGA, BMP and GIF: pictures that Pillow and libtiff have written, judged by the formula of
//! their pixels, and files by hand for what they do not write.

use juggler_imaging::{
    ImageError, ImageFormat, Limits, Raster, RasterSamples, TransferFunction, decode, decode_raster, inspect,
    inspect_raster,
};
use std::fs;
use std::io::Cursor;
use std::path::PathBuf;

const WIDTH: usize = 5;
const HEIGHT: usize = 3;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/pictures")
}

fn file(name: &str) -> Vec<u8> {
    fs::read(folder().join(name)).unwrap()
}

/// All pictures by name.
fn files() -> Vec<(String, Vec<u8>)> {
    let names = fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    assert!(names.len() > 30);
    names.into_iter().map(|name| (name.clone(), file(&name))).collect()
}

fn read(name: &str, bytes: &[u8]) -> Result<Raster, ImageError> {
    decode_raster(name, Cursor::new(bytes), &Limits::default())
}

/// Red, green, blue and alpha of the pixel in column `x` of row `y`.
fn color(x: usize, y: usize) -> [u8; 4] {
    [50 * x, 80 * y, 20 * x + 30 * y + 7, 255 - 30 * x - 10 * y].map(|level| level as u8)
}

/// Levels of all pixels, with these channels of the color.
fn levels(channels: &[usize]) -> RasterSamples {
    let places = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    RasterSamples::Bytes(places.flat_map(|(x, y)| channels.iter().map(move |k| color(x, y)[*k])).collect())
}

/// Name of a file without its extension.
fn stem(name: &str) -> &str {
    name.split('.').next().unwrap_or_default()
}

/// Samples of a picture.
fn expected(name: &str) -> RasterSamples {
    match stem(name).trim_end_matches("-runs") {
        "gray" if name == "gray.bmp" => levels(&[2, 2, 2]),
        "gray" => levels(&[2]),
        "gray-alpha" => levels(&[2, 3]),
        "rgba" if !name.ends_with("bmp") => levels(&[0, 1, 2, 3]),
        "gray16" => {
            let RasterSamples::Bytes(levels) = levels(&[2]) else { panic!("bytes") };
            RasterSamples::Words(levels.into_iter().map(|level| 257 * u16::from(level)).collect())
        }
        "float" => {
            let RasterSamples::Bytes(levels) = levels(&[2]) else { panic!("bytes") };
            RasterSamples::Floats(levels.into_iter().map(|level| f32::from(level) / 64.0).collect())
        }
        "bit" => {
            let channels = if name.ends_with("bmp") { 3 } else { 1 };
            let level = |k: usize| if (k % WIDTH + k / WIDTH) % 2 == 1 { 255 } else { 0 };
            RasterSamples::Bytes((0..WIDTH * HEIGHT).flat_map(|k| vec![level(k); channels]).collect())
        }
        "transparent" => {
            let RasterSamples::Bytes(levels) = levels(&[0, 1, 2]) else { panic!("bytes") };
            let pixels = levels.chunks(3).enumerate();
            RasterSamples::Bytes(
                pixels.flat_map(|(k, rgb)| [rgb[0], rgb[1], rgb[2], if k == 7 { 0 } else { 255 }]).collect(),
            )
        }
        // Windows ignores the fourth byte of a pixel unless the header has a mask for alpha.
        _ => levels(&[0, 1, 2]),
    }
}

#[test]
fn pictures_of_other_writers_have_their_pixels() {
    for (name, bytes) in files() {
        let raster = read(&name, &bytes).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!((raster.layout.width, raster.layout.height), (WIDTH as u32, HEIGHT as u32), "{name}");
        let several = ["pages.tif", "movie.gif"].contains(&name.as_str());
        assert_eq!(raster.is_first_of_several, several, "{name}");
        let (stem, expected) = (stem(&name), expected(&name));
        assert_eq!(raster.samples, expected, "{name}");
        let is_float = stem == "float";
        let curve = if is_float { TransferFunction::Linear } else { TransferFunction::Srgb };
        assert_eq!(raster.transfer_function, curve, "{name}");
        let path = folder().join(&name);
        assert_eq!(inspect_raster(&path).unwrap(), raster.layout, "{name}");
        let info = inspect(&path).unwrap();
        let facts = (info.format, info.width, info.height, info.is_tone_mapped);
        assert_eq!(facts, (raster.layout.format, WIDTH as u32, HEIGHT as u32, !is_float), "{name}");
    }
}

#[test]
fn images_are_linear_and_ignore_alpha() {
    let image = |name: &str| decode(name, Cursor::new(file(name)), &Limits::default()).unwrap();
    let linear = |level: u8| TransferFunction::Srgb.decode(f64::from(level) / 255.0) as f32;
    let [r, g, b, _] = color(3, 2).map(linear);
    for name in ["rgba.tif", "rgb-lzw.tif", "palette.tga", "rgb.bmp", "transparent.gif"] {
        assert_eq!(image(name).pixels()[13].to_array(), [r, g, b], "{name}");
    }
    assert_eq!(image("gray-alpha.tga").pixels()[13].to_array(), [b; 3]);
    assert_eq!(image("gray16.tif").pixels()[13].to_array(), [b; 3]);
    assert_eq!(image("float.tif").pixels()[13].to_array(), [f32::from(color(3, 2)[2]) / 64.0; 3]);
}

/// A TGA of 3 × 2 gray pixels in the four orders of rows and columns.
#[test]
fn tga_has_four_orders() {
    let orders =
        [(0x20, [1, 2, 3, 4, 5, 6]), (0x30, [3, 2, 1, 6, 5, 4]), (0, [4, 5, 6, 1, 2, 3]), (0x10, [6, 5, 4, 3, 2, 1])];
    for (order, stored) in orders {
        let mut bytes = vec![0, 0, 3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 2, 0, 8, order];
        bytes.extend(stored);
        assert_eq!(read("a.tga", &bytes).unwrap().samples, RasterSamples::Bytes(vec![1, 2, 3, 4, 5, 6]), "{order}");
        // The same as runs of one pixel.
        bytes[2] = 11;
        bytes.truncate(18);
        bytes.extend(stored.into_iter().flat_map(|level| [0x80, level]));
        assert_eq!(read("a.tga", &bytes).unwrap().samples, RasterSamples::Bytes(vec![1, 2, 3, 4, 5, 6]), "{order}");
        assert!(matches!(read("a.png", &bytes), Err(ImageError::UnknownContent { .. })));
    }
}

/// Entry of a directory: tag, type and values.
type Entry = (u16, u16, Vec<u32>);

const SHORT: u16 = 3;
const LONG: u16 = 4;

/// A TIFF of one strip with these pixels, in either byte order.
fn tiff(is_little_endian: bool, entries: &[Entry], pixels: &[u8]) -> Vec<u8> {
    let two =
        |number: u32| if is_little_endian { (number as u16).to_le_bytes() } else { (number as u16).to_be_bytes() };
    let four = |number: u32| if is_little_endian { number.to_le_bytes() } else { number.to_be_bytes() };
    let strip = [(273, LONG, vec![8]), (279, LONG, vec![pixels.len() as u32])];
    let mut entries: Vec<Entry> = entries.iter().cloned().chain(strip).collect();
    entries.sort();
    let mut file = [if is_little_endian { b"II*\0" } else { b"MM\0*" }.as_slice(), &[0; 4], pixels].concat();
    let mut table = two(entries.len() as u32).to_vec();
    for (tag, kind, values) in entries {
        let size = if kind == SHORT { 2 } else { 4 };
        let data: Vec<u8> = values
            .iter()
            .flat_map(|value| if kind == SHORT { two(*value).to_vec() } else { four(*value).to_vec() })
            .collect();
        let count = if kind == 5 { values.len() / 2 } else { values.len() };
        table.extend([two(tag.into()), two(kind.into())].concat());
        table.extend(four(count as u32));
        if values.len() * size <= 4 {
            table.extend(data.iter().copied().chain([0; 4]).take(4));
        } else {
            table.extend(four(file.len() as u32));
            file.extend(data);
        }
    }
    let start = four(file.len() as u32);
    file[4..8].copy_from_slice(&start);
    [file, table, vec![0; 4]].concat()
}

/// Entries of an RGB image of 2 × 1 pixels with `samples` samples of `bits` bits.
fn two_pixels(samples: u32, bits: u32) -> Vec<Entry> {
    let entry = |tag, value| (tag, SHORT, vec![value]);
    let entries = [entry(256, 2), entry(257, 1), entry(262, 2), entry(277, samples), entry(278, 1)];
    entries.into_iter().chain([(258, SHORT, vec![bits; samples as usize])]).collect()
}

#[test]
fn tiff_keeps_16_bits_and_floats_in_both_byte_orders() {
    for is_little_endian in [true, false] {
        let words: [u16; 6] = [1, 256, 65_535, 4660, 0, 43_981];
        let bytes = words.map(|word| if is_little_endian { word.to_le_bytes() } else { word.to_be_bytes() }).concat();
        let raster = read("a", &tiff(is_little_endian, &two_pixels(3, 16), &bytes)).unwrap();
        assert_eq!(raster.samples, RasterSamples::Words(words.to_vec()));
        let floats: [f32; 6] = [0.1, -2.0, 1e9, 0.0, 3.5, 1e-9];
        let bytes =
            floats.map(|value| if is_little_endian { value.to_le_bytes() } else { value.to_be_bytes() }).concat();
        let entries = [two_pixels(3, 32), vec![(339, SHORT, vec![3; 3])]].concat();
        let raster = read("a", &tiff(is_little_endian, &entries, &bytes)).unwrap();
        assert_eq!(raster.samples, RasterSamples::Floats(floats.to_vec()));
        assert_eq!(raster.transfer_function, TransferFunction::Linear);
    }
}

#[test]
fn a_fourth_sample_is_alpha() {
    let read_with = |extra: Option<u32>, pixels: &[u8]| {
        let extra = extra.map(|kind| (338, SHORT, vec![kind]));
        let entries: Vec<Entry> = two_pixels(4, 8).into_iter().chain(extra).collect();
        read("a", &tiff(true, &entries, pixels)).unwrap().samples
    };
    let pixels = [10, 20, 30, 100, 40, 50, 60, 0];
    for extra in [None, Some(0), Some(2)] {
        assert_eq!(read_with(extra, &pixels), RasterSamples::Bytes(pixels.to_vec()), "{extra:?}");
    }
    // Associated alpha has multiplied the colors: 10 · 255 / 100 = 25.5.
    assert_eq!(read_with(Some(1), &pixels), RasterSamples::Bytes(vec![26, 51, 77, 100, 40, 50, 60, 0]));
}

#[test]
fn planes_of_a_tiff_are_interleaved() {
    let entries = [two_pixels(3, 8), vec![(284, SHORT, vec![2])]].concat();
    let entries: Vec<Entry> =
        entries.into_iter().filter(|(tag, ..)| *tag != 262).chain([(262, SHORT, vec![2])]).collect();
    let mut bytes = tiff(true, &entries, &[1, 2, 3, 4, 5, 6]);
    // Three strips of two bytes: the offsets replace the single ones.
    let lists = bytes.len() as u32;
    bytes.extend([8_u32, 10, 12, 2, 2, 2].iter().flat_map(|number| number.to_le_bytes()));
    for (tag, list) in [(273_u16, lists), (279, lists + 12)] {
        let entry = [tag.to_le_bytes(), LONG.to_le_bytes()].concat();
        let at = bytes.windows(4).position(|four| four == entry).unwrap();
        bytes[at + 4..at + 8].copy_from_slice(&3_u32.to_le_bytes());
        bytes[at + 8..at + 12].copy_from_slice(&list.to_le_bytes());
    }
    assert_eq!(read("a", &bytes).unwrap().samples, RasterSamples::Bytes(vec![1, 3, 5, 2, 4, 6]));
}

#[test]
fn tiff_states_primaries() {
    let hundred = |numbers: &[u32]| numbers.iter().flat_map(|number| [*number, 10_000]).collect::<Vec<u32>>();
    let primaries = [(318, 5, hundred(&[3127, 3290])), (319, 5, hundred(&[6800, 3200, 2650, 6900, 1500, 600]))];
    let entries = [two_pixels(3, 8), primaries.to_vec()].concat();
    let bytes = tiff(true, &entries, &[0, 255, 0, 255, 255, 255]);
    // The matrix of CSS Color Module Level 4 from Display P3.
    let image = decode("a", Cursor::new(&bytes), &Limits::default()).unwrap();
    for (found, expected) in image.pixels()[0].to_array().into_iter().zip([-0.2249, 1.0421, -0.0786]) {
        assert!((found - expected).abs() < 2e-4, "{found} {expected}");
    }
    assert!(read("a", &bytes).unwrap().layout.to_srgb.is_some());
}

#[test]
fn unsupported_tiffs_say_what_to_do() {
    let message = |changes: &[Entry]| {
        let kept = two_pixels(3, 8).into_iter().filter(|(tag, ..)| changes.iter().all(|(changed, ..)| changed != tag));
        let entries: Vec<Entry> = kept.chain(changes.iter().cloned()).collect();
        read("a.tif", &tiff(true, &entries, &[0; 6])).unwrap_err().to_string()
    };
    let one = |tag, value| (tag, SHORT, vec![value]);
    for (changes, words) in [
        (vec![one(259, 7)], "JPEG compression is not supported; save it uncompressed, or with LZW or Deflate"),
        (vec![one(262, 6)], "its colors are YCbCr, which is not supported; save it as RGB"),
        (vec![one(256, 0)], "its size is 0 × 1"),
        (vec![one(277, 7)], "it has 7 samples per pixel; 3 to 4 are supported"),
        (vec![one(339, 2)], "samples of 8 bits with a sign are not supported"),
        (vec![one(278, 0)], "its list of strips or tiles does not fit its size"),
        (
            vec![(256, LONG, vec![u32::MAX]), (257, LONG, vec![u32::MAX])],
            "4294967295 × 4294967295 pixels are more than",
        ),
    ] {
        let message = message(&changes);
        assert!(message.starts_with(&format!("cannot read `a.tif`: {words}")), "{message}");
    }
    let big = read("a.tif", b"II+\0\x08\0\0\0\x10\0\0\0\0\0\0\0").unwrap_err().to_string();
    assert!(big.contains("BigTIFF"), "{big}");
}

#[test]
fn frames_of_a_gif_lie_on_their_canvas() {
    let bytes = file("palette.gif");
    let at = bytes.iter().rposition(|byte| *byte == b',').unwrap();
    // A canvas of 6 × 4 pixels, the frame at 2, 1: its last two columns are outside.
    let mut moved = bytes.clone();
    moved[6] = 6;
    moved[8] = 4;
    let start = moved.windows(10).position(|ten| ten == [b',', 0, 0, 0, 0, 5, 0, 3, 0, 0]).unwrap_or(at);
    moved[start + 1] = 2;
    moved[start + 3] = 1;
    let raster = read("a", &moved).unwrap();
    let RasterSamples::Bytes(canvas) = raster.samples else { panic!("bytes") };
    for (k, pixel) in canvas.chunks(4).enumerate() {
        let (x, y) = (k % 6, k / 6);
        let expected = if x >= 2 && y >= 1 {
            let [r, g, b, _] = color(x - 2, y - 1);
            [r, g, b, 255]
        } else {
            [0; 4]
        };
        assert_eq!(pixel, expected, "{x} {y}");
    }
    // A canvas without a size has that of the frame.
    let empty = [&bytes[..6], &[0; 4], &bytes[10..]].concat();
    assert_eq!(read("a", &empty).unwrap().samples, levels(&[0, 1, 2]));
    let message = read("a", &[&bytes[..start], b";"].concat()).unwrap_err().to_string();
    assert!(message.starts_with("cannot read `a`: "), "{message}");
}

#[test]
fn cut_and_changed_files_are_errors_or_pictures() {
    let limits = Limits { max_pixels: 10_000, longest_side: 1_000 };
    for (name, bytes) in files() {
        for length in 0..bytes.len() {
            if let Err(error) = decode_raster(&name, Cursor::new(&bytes[..length]), &limits) {
                assert!(error.to_string().starts_with(&format!("cannot read `{name}`: ")), "{error}");
            }
            for byte in [0, 1, 127, 128, 255] {
                let mut changed = bytes.clone();
                changed[length] = byte;
                if let Ok(raster) = decode_raster(&name, Cursor::new(&changed), &limits) {
                    assert!(u64::from(raster.layout.width) * u64::from(raster.layout.height) <= 10_000);
                }
                let _ = decode(&name, Cursor::new(&changed), &limits);
            }
        }
        let small = Limits { max_pixels: 14, ..limits };
        let error = decode_raster(&name, Cursor::new(&bytes), &small).unwrap_err();
        assert!(matches!(error, ImageError::TooLarge { .. }), "{error}");
        let half = decode(&name, Cursor::new(&bytes[..8]), &limits).unwrap_err().to_string();
        assert!(half.starts_with(&format!("cannot read `{name}`: ")), "{half}");
    }
}

#[test]
fn huge_claims_are_refused_from_the_header() {
    let put = |name: &str, at: usize, sides: &[u8]| {
        let mut bytes = file(name);
        bytes[at..at + sides.len()].copy_from_slice(sides);
        bytes
    };
    let sides = [0xff, 0xff, 0xff, 0xff];
    for (name, bytes) in [
        ("a.tga", put("rgb.tga", 12, &sides)),
        ("a.tga", put("rgb-runs.tga", 12, &sides)),
        ("a.gif", put("palette.gif", 6, &sides)),
        ("a.bmp", put("rgb.bmp", 18, &[0xff, 0xff, 0, 0, 0xff, 0xff, 0, 0])),
        ("a.tif", tiff(true, &[two_pixels(3, 8), vec![(256, LONG, vec![1 << 31])]].concat(), &[0; 6])),
    ] {
        let error = read(name, &bytes).unwrap_err();
        assert!(matches!(error, ImageError::ImplausibleSize { .. }), "{error}");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        fs::write(&path, &bytes).unwrap();
        assert!(inspect(&path).is_err() && inspect_raster(&path).is_err());
    }
}

#[test]
fn these_formats_are_not_written() {
    for format in ImageFormat::READ_ONLY {
        let destination = juggler_imaging::Destination::stream("a.x", std::io::sink());
        let writer = juggler_imaging::writer(format, destination, &juggler_imaging::Header::new(2, 2));
        let error = writer.map(drop).unwrap_err();
        assert!(matches!(error, ImageError::ReadOnly { .. }), "{error}");
    }
}
