//! Samples as stored in files: levels, alpha, transfer functions; damaged files are errors.

use crate::common::{encode, header, picture};
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, Layer, LayerAttributes, SmallVec, WritableImage};
use juggler_imaging::{
    ImageError, ImageFormat, Limits, Options, Raster, RasterLayout, RasterSamples, TransferFunction, decode,
    decode_raster,
};
use std::io::Cursor;

const LIMITS: Limits = Limits { max_pixels: 10_000, longest_side: 1_000 };

fn read(bytes: &[u8]) -> Result<Raster, ImageError> {
    decode_raster("a file", Cursor::new(bytes), &LIMITS)
}

/// A PNG of 2 × 1 pixels with the given samples.
fn png(color: png::ColorType, depth: png::BitDepth, gamma: Option<f32>, samples: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if let Some(gamma) = gamma {
        encoder.set_source_gamma(png::ScaledFloat::new(gamma));
    }
    encoder.write_header().unwrap().write_image_data(samples).unwrap();
    bytes
}

#[test]
fn raster_samples_of_every_format_match_the_image() {
    let image = picture(19, 18, 3.0);
    for format in ImageFormat::ALL {
        let bytes = encode(format, &image, &header(&image));
        let (raster, image) = (read(&bytes).unwrap(), decode("a file", Cursor::new(&bytes), &LIMITS).unwrap());
        assert_eq!((raster.layout.width, raster.layout.height, raster.layout.format), (19, 18, format));
        let linear: Vec<f32> = match &raster.samples {
            RasterSamples::Bytes(levels) => {
                levels.iter().map(|level| raster.transfer_function.decode(f64::from(*level) / 255.0) as f32).collect()
            }
            RasterSamples::Floats(numbers) => numbers.clone(),
            RasterSamples::Words(_) => panic!("the writer requests no words"),
        };
        assert_eq!(linear, image.pixels().iter().flat_map(|p| p.to_array()).collect::<Vec<_>>(), "{format}");
        assert_eq!(raster.transfer_function == TransferFunction::Linear, !format.is_tone_mapped());
    }
}

#[test]
fn png_raster_keeps_alpha_16_bit_samples_and_transfer_function() {
    use png::{BitDepth, ColorType};
    let raster = read(&png(ColorType::Rgba, BitDepth::Eight, None, &[1, 2, 3, 4, 5, 6, 7, 8])).unwrap();
    let layout =
        RasterLayout { format: ImageFormat::Png, width: 2, height: 1, channels: 4, sample_bytes: 1, to_srgb: None };
    let samples = RasterSamples::Bytes(vec![1, 2, 3, 4, 5, 6, 7, 8]);
    assert_eq!(raster, Raster { layout, samples, transfer_function: TransferFunction::Srgb });
    let raster = read(&png(ColorType::Grayscale, BitDepth::Sixteen, Some(1.0), &[1, 2, 255, 255])).unwrap();
    assert_eq!(
        (raster.samples, raster.transfer_function),
        (RasterSamples::Words(vec![258, 65_535]), TransferFunction::Gamma(1.0))
    );
    assert_eq!((raster.layout.channels, raster.layout.sample_bytes), (1, 2));
    let raster = read(&png(ColorType::GrayscaleAlpha, BitDepth::Eight, None, &[9, 8, 7, 6])).unwrap();
    assert_eq!((raster.layout.channels, raster.samples), (2, RasterSamples::Bytes(vec![9, 8, 7, 6])));
    // One-bit samples are expanded to bytes.
    let raster = read(&png(ColorType::Grayscale, BitDepth::One, None, &[0b0100_0000])).unwrap();
    assert_eq!(raster.samples, RasterSamples::Bytes(vec![0, 255]));
}

#[test]
fn png_states_primaries_and_transfer_functions_by_cicp() {
    let png = |codes: [u8; 4], samples: &[u8]| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 2, 1);
        encoder.set_color(png::ColorType::Rgb);
        let mut writer = encoder.write_header().unwrap();
        writer.write_chunk(png::chunk::cICP, &codes).unwrap();
        writer.write_image_data(samples).unwrap();
        drop(writer);
        bytes
    };
    let pixels = [60, 128, 60, 255, 255, 255];
    let raster = read(&png([12, 13, 0, 1], &pixels)).unwrap();
    // The level's linear value times the matrix of CSS Color Module Level 4 from Display P3.
    let [low, high] = [60.0, 128.0].map(|level| raster.transfer_function.decode(level / 255.0) as f32);
    let color = raster.layout.to_srgb.unwrap().color(juggler_math::Rgb::new(low, high, low));
    let expected =
        [1.2249 * low - 0.2249 * high, 1.0421 * high - 0.0421 * low, 1.0983 * low - 0.0786 * high - 0.0197 * low];
    for (found, expected) in color.to_array().into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-4, "{color:?} {expected}");
    }
    let curve = |code: u8| {
        let bytes = png([1, code, 0, 1], &pixels);
        let (raster, image) = (read(&bytes).unwrap(), decode("a file", Cursor::new(&bytes), &LIMITS).unwrap());
        let linear = raster.transfer_function.decode(128.0 / 255.0) as f32;
        assert_eq!(linear, image.pixels()[0].g, "{code}");
        assert_eq!(raster.layout.to_srgb, None);
        raster.transfer_function
    };
    use TransferFunction::{Gamma, Hlg, Linear, Pq, Srgb};
    assert_eq!([1, 4, 5, 8, 13, 16, 18].map(curve), [Srgb, Gamma(2.2), Gamma(2.8), Linear, Srgb, Pq, Hlg]);
}

/// Little-endian Exif block with an orientation.
fn exif(code: u8) -> Vec<u8> {
    [b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".as_slice(), &[code, 0, 0, 0, 0, 0, 0, 0]].concat()
}

/// Code 6 is that of a phone held upright: the stored rows are turned clockwise.
#[test]
fn pictures_are_turned_by_their_exif_orientation() {
    use png::BitDepth::{Eight, Sixteen};
    let image = picture(19, 8, 1.0);
    let block = exif(6);
    let jpeg = encode(ImageFormat::Jpeg, &image, &header(&image));
    let app1 = [&[0xff, 0xe1, 0, (2 + 6 + block.len()) as u8][..], b"Exif\0\0", &block].concat();
    let turned_jpeg = [&jpeg[..2], &app1, &jpeg[2..]].concat();
    let png = |with_exif: bool, depth: png::BitDepth| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 3, 2);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(depth);
        let mut writer = encoder.write_header().unwrap();
        if with_exif {
            writer.write_chunk(png::chunk::eXIf, &block).unwrap();
        }
        let size = if depth == Sixteen { 36 } else { 18 };
        writer.write_image_data(&(0..size).map(|level| level * 7).collect::<Vec<u8>>()).unwrap();
        drop(writer);
        bytes
    };
    let webp = encode(ImageFormat::Webp, &image, &header(&image));
    // An extended file: a flag for Exif, the size, the pixels, and the block.
    let mut chunks = b"WEBPVP8X\x0a\0\0\0\x08\0\0\0\x12\0\0\x07\0\0".to_vec();
    chunks.extend(&webp[12..]);
    chunks.extend(b"EXIF");
    chunks.extend((block.len() as u32).to_le_bytes());
    chunks.extend(&block);
    let turned_webp = [b"RIFF".as_slice(), &(chunks.len() as u32).to_le_bytes(), &chunks].concat();
    for (plain, turned) in [
        (jpeg, turned_jpeg),
        (png(false, Eight), png(true, Eight)),
        (png(false, Sixteen), png(true, Sixteen)),
        (webp, turned_webp),
    ] {
        let image = |bytes: &[u8]| decode("a file", Cursor::new(bytes), &LIMITS).unwrap();
        let (from, to) = (image(&plain), image(&turned));
        let (width, height) = (from.width(), from.height());
        assert_eq!((to.width(), to.height()), (height, width));
        for (index, pixel) in to.pixels().iter().enumerate() {
            let (x, y) = (index as u32 % height, index as u32 / height);
            assert_eq!(*pixel, from.pixels()[((height - 1 - x) * width + y) as usize], "{x} {y}");
        }
        let raster = read(&turned).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, &turned).unwrap();
        assert_eq!(juggler_imaging::inspect_raster(&path).unwrap(), raster.layout);
        assert_eq!((raster.layout.width, raster.layout.height), (height, width));
        let info = juggler_imaging::inspect(&path).unwrap();
        assert_eq!((info.width, info.height), (height, width));
        let levels = |bytes: &[u8]| match read(bytes).unwrap().samples {
            RasterSamples::Bytes(levels) => levels.chunks(3).map(|pixel| u32::from(pixel[0])).collect::<Vec<u32>>(),
            RasterSamples::Words(levels) => levels.chunks(3).map(|pixel| u32::from(pixel[0])).collect(),
            RasterSamples::Floats(_) => panic!("levels"),
        };
        assert_eq!(levels(&turned)[1], levels(&plain)[((height - 2) * width) as usize]);
    }
}

/// A Radiance file with these header lines, resolution and pixels.
fn hdr(lines: &str, size: &str, pixels: &[u8]) -> Vec<u8> {
    let head = format!("#?RADIANCE\n{lines}FORMAT=32-bit_rle_rgbe\n\n{size}\n");
    [head.as_bytes(), pixels].concat()
}

#[test]
fn radiance_states_primaries_exposure_and_color_correction() {
    let pixels = [128, 64, 32, 129, 128, 128, 128, 129];
    let lines = "EXPOSURE=2\nEXPOSURE=0.5\nEXPOSURE=4\nCOLORCORR=2 1 0.5\n";
    let image = decode("a file", Cursor::new(hdr(lines, "-Y 1 +X 2", &pixels)), &LIMITS).unwrap();
    assert_eq!(image.pixels()[0].to_array(), [0.125, 0.125, 0.125]);
    let lines = "PRIMARIES=0.680 0.320 0.265 0.690 0.150 0.060 0.3127 0.3290\n";
    let bytes = hdr(lines, "-Y 1 +X 2", &pixels);
    let color = decode("a file", Cursor::new(&bytes), &LIMITS).unwrap().pixels()[0].to_array();
    for (found, expected) in
        color.into_iter().zip([1.2249 - 0.1125, 0.5 * 1.0421 - 0.0421, 0.25 * 1.0983 - 0.0197 - 0.0393])
    {
        assert!((found - expected).abs() < 2e-4, "{color:?}");
    }
    let raster = read(&bytes).unwrap();
    assert_eq!(raster.samples, RasterSamples::Floats(vec![1.0, 0.5, 0.25, 1.0, 1.0, 1.0]));
    assert!(raster.layout.to_srgb.is_some());
    for wrong in ["PRIMARIES=1 2 3\n", "PRIMARIES=a\n", "COLORCORR=0 1 1\n", "COLORCORR=nan 1 1\n", "EXPOSURE=inf\n"] {
        let image = decode("a file", Cursor::new(hdr(wrong, "-Y 1 +X 2", &pixels)), &LIMITS).unwrap();
        assert_eq!(image.pixels()[0].to_array(), [1.0, 0.5, 0.25], "{wrong}");
    }
}

#[test]
fn radiance_has_eight_orientations() {
    // Row by row from the top left, the pixels are 2 3 4 and 5 6 7.
    let orders = [
        ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
        ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
        ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
        ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
        ("+X 3 -Y 2", [1, 4, 2, 5, 3, 6]),
        ("-X 3 -Y 2", [3, 6, 2, 5, 1, 4]),
        ("+X 3 +Y 2", [4, 1, 5, 2, 6, 3]),
        ("-X 3 +Y 2", [6, 3, 5, 2, 4, 1]),
    ];
    for (size, levels) in orders {
        let pixels: Vec<u8> = levels.into_iter().flat_map(|level| [level + 1, level + 1, level + 1, 136]).collect();
        let image = decode("a file", Cursor::new(hdr("", size, &pixels)), &LIMITS).unwrap();
        assert_eq!((image.width(), image.height()), (3, 2), "{size}");
        let found: Vec<f32> = image.pixels().iter().map(|pixel| pixel.r).collect();
        assert_eq!(found, [2.0, 3.0, 4.0, 5.0, 6.0, 7.0], "{size}");
    }
}

#[test]
fn radiance_has_old_runs() {
    let row = |pixels: &[[u8; 4]], width: u32| {
        let bytes = hdr("", &format!("-Y 1 +X {width}"), pixels.as_flattened());
        decode("a file", Cursor::new(bytes), &LIMITS)
            .map(|image| image.pixels().iter().map(|p| p.g).collect::<Vec<_>>())
    };
    let (a, b) = ([9, 8, 7, 136], [1, 2, 3, 136]);
    assert_eq!(row(&[a, [1, 1, 1, 2], b], 4).unwrap(), [8.0, 8.0, 8.0, 2.0]);
    // 1 + 44 + 256 pixels, then another.
    let long = row(&[a, [1, 1, 1, 44], [1, 1, 1, 1], b], 302).unwrap();
    assert!(long[..301].iter().all(|value| *value == 8.0) && long[301] == 2.0);
    let error = row(&[a, [1, 1, 1, 9], b], 4).unwrap_err().to_string();
    assert!(error.contains("a run is longer than its row"), "{error}");
    assert!(row(&[a, [1, 1, 1, 0], [1, 1, 1, 0]], 4).is_err());
}

#[test]
fn half_floats_end_at_their_largest_finite_value() {
    let image =
        juggler_math::Image::from_pixels(2, 1, vec![juggler_math::Rgb::new(1e6, 65_520.0, f32::INFINITY); 2]).unwrap();
    use juggler_imaging::SampleDepth::{Float, Half};
    let options = Options { exr_depth: Half, ..Options::default() };
    let bytes = encode(ImageFormat::Exr, &image, &juggler_imaging::Header { options, ..header(&image) });
    let image = decode("a file", Cursor::new(&bytes), &LIMITS).unwrap();
    assert_eq!(image.pixels()[1].to_array(), [65_504.0; 3]);
    // Values that rounding alone moves to 65,504 are not counted.
    let counted = |pixel: [f32; 3], exr_depth| {
        let image = juggler_math::Image::from_pixels(1, 1, vec![pixel.into()]).unwrap();
        let options = Options { exr_depth, ..Options::default() };
        let header = juggler_imaging::Header { options, ..header(&image) };
        encode(ImageFormat::Exr, &image, &header);
        (header.clamped.count(), header.clamped.warning("a.exr"))
    };
    let (count, warning) = counted([1e6, -f32::INFINITY, 65_504.0], Half);
    assert!(count == 2 && warning.unwrap().contains("`a.exr`: 2 values are beyond the range of 16-bit floats"));
    assert_eq!(counted([65_503.0, f32::NAN, 0.0], Half), (0, None));
    assert_eq!(counted([1e6; 3], Float), (0, None));
}

fn exr(channels: &[(&str, [f32; 2])]) -> Vec<u8> {
    let channel = |(name, values): &(&str, [f32; 2])| AnyChannel::new(*name, FlatSamples::F32(values.to_vec()));
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels.iter().map(channel).collect();
    let layer = Layer::new(
        (2, 1),
        LayerAttributes::named("a layer"),
        exr::prelude::Encoding::FAST_LOSSLESS,
        AnyChannels::sort(list),
    );
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn an_exr_may_have_alpha_or_one_channel() {
    let (r, g, b, a) = (("R", [1.0, 2.0]), ("G", [3.0, 4.0]), ("B", [5.0, 6.0]), ("A", [0.5, 0.25]));
    let samples = |bytes: &[u8]| match read(bytes).unwrap().samples {
        RasterSamples::Floats(numbers) => numbers,
        other => panic!("{other:?}"),
    };
    assert_eq!(samples(&exr(&[r, g, b])), [1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
    assert_eq!(samples(&exr(&[r, g, b, a])), [1.0, 3.0, 5.0, 0.5, 2.0, 4.0, 6.0, 0.25]);
    assert_eq!(samples(&exr(&[("Y", [7.0, 8.0])])), [7.0, 8.0]);
    assert_eq!(samples(&exr(&[("Y", [7.0, 8.0]), a])), [7.0, 0.5, 8.0, 0.25]);
    // A single channel of any name is gray, with alpha or without; alpha alone, too.
    for name in ["depth", "V", "A", "layer.Z", "R"] {
        assert_eq!(samples(&exr(&[(name, [7.0, 8.0])])), [7.0, 8.0], "{name}");
    }
    assert_eq!(samples(&exr(&[("V", [7.0, 8.0]), a])), [7.0, 0.5, 8.0, 0.25]);
}

/// Red, green and blue of the first pixel, as an image and as samples.
fn first_pixel(bytes: &[u8]) -> [f32; 3] {
    let image = decode("a file", Cursor::new(bytes), &LIMITS).unwrap().pixels()[0].to_array();
    let RasterSamples::Floats(samples) = read(bytes).unwrap().samples else { panic!("floats") };
    assert!(samples.len() < 6 || samples[..3] == image, "{samples:?} {image:?}");
    image
}

#[test]
fn the_picture_of_an_exr_is_found_by_its_names() {
    let color =
        |names: [&'static str; 3], first: f32| [0, 1, 2].map(|i| (names[i], [first + i as f32, first])).to_vec();
    let combined = color(["ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B"], 1.0);
    let albedo = color(["ViewLayer.Albedo.R", "ViewLayer.Albedo.G", "ViewLayer.Albedo.B"], 20.0);
    let depth = vec![("ViewLayer.Depth.Z", [9.0, 9.0])];
    let found = |channels: &[Vec<(&'static str, [f32; 2])>]| first_pixel(&exr(&channels.concat()));
    assert_eq!(found(&[color(["r", "g", "b"], 5.0)]), [5.0, 6.0, 7.0]);
    assert_eq!(found(&[albedo.clone(), combined.clone(), depth.clone()]), [1.0, 2.0, 3.0]);
    assert_eq!(found(&[color(["R", "G", "B"], 30.0), combined.clone()]), [30.0, 31.0, 32.0]);
    assert_eq!(found(&[vec![("Y", [4.0, 4.0])], albedo.clone()]), [4.0; 3]);
    // The only color layer is the picture.
    assert_eq!(found(&[albedo.clone(), depth.clone()]), [20.0, 21.0, 22.0]);
    let alpha = vec![("ViewLayer.Combined.A", [0.5, 0.25])];
    let raster = read(&exr(&[combined, alpha, depth.clone()].concat())).unwrap();
    assert_eq!(raster.samples, RasterSamples::Floats(vec![1.0, 2.0, 3.0, 0.5, 1.0, 1.0, 1.0, 0.25]));
    // Two layers, of which none is named, are ambiguous.
    let emission = color(["ViewLayer.Emit.R", "ViewLayer.Emit.G", "ViewLayer.Emit.B"], 2.0);
    for channels in [[albedo, emission].concat(), [depth, vec![("ViewLayer.Mist.Z", [1.0, 1.0])]].concat()] {
        let error = read(&exr(&channels)).unwrap_err().to_string();
        assert!(error.contains("none of its layers is the picture") && error.contains("`ViewLayer."), "{error}");
    }
}

/// An EXR of 2 × 1 pixels, (1, 2, 3) and (4, 5, 6), at a place in a display window.
fn windowed(place: [i32; 2], display: [i32; 2], size: [usize; 2], channels: &[&str]) -> Vec<u8> {
    use exr::prelude::IntegerBounds;
    let values = [[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]];
    let channel = |(name, values): (&&str, [f32; 2])| AnyChannel::new(*name, FlatSamples::F32(values.to_vec()));
    let list: SmallVec<[AnyChannel<FlatSamples>; 4]> = channels.iter().zip(values).map(channel).collect();
    let attributes = LayerAttributes::named("a layer").with_position(exr::math::Vec2(place[0], place[1]));
    let layer = Layer::new((2, 1), attributes, exr::prelude::Encoding::FAST_LOSSLESS, AnyChannels::sort(list));
    let mut image = Image::from_layer(layer);
    image.attributes.display_window = IntegerBounds::new((display[0], display[1]), (size[0], size[1]));
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes).unwrap();
    bytes.into_inner()
}

#[test]
fn an_exr_shows_its_display_window() {
    let red = |bytes: &[u8]| {
        let image = decode("a file", Cursor::new(bytes), &LIMITS).unwrap();
        let raster = read(bytes).unwrap();
        assert_eq!((raster.layout.width, raster.layout.height), (image.width(), image.height()));
        let RasterSamples::Floats(samples) = raster.samples else { panic!("floats") };
        let channels = usize::from(raster.layout.channels);
        let red: Vec<f32> = image.pixels().iter().map(|pixel| pixel.r).collect();
        assert_eq!(samples.iter().step_by(channels).copied().collect::<Vec<_>>(), red);
        (image.width(), image.height(), red)
    };
    for channels in [&["R", "G", "B"][..], &["Y"], &["Combined.R", "Combined.G", "Combined.B"]] {
        // A black frame around the data.
        let found = red(&windowed([1, 1], [0, 0], [4, 3], channels));
        assert_eq!(found, (4, 3, [[0.0; 4], [0.0, 1.0, 4.0, 0.0], [0.0; 4]].concat()), "{channels:?}");
        // Overscan is cut, and windows may have negative coordinates.
        assert_eq!(red(&windowed([-5, 7], [-4, 7], [3, 1], channels)), (3, 1, vec![4.0, 0.0, 0.0]));
        assert_eq!(red(&windowed([0, 0], [0, 0], [1, 1], channels)), (1, 1, vec![1.0]));
        // Windows that have no pixel in common.
        assert_eq!(red(&windowed([10, 10], [0, 0], [2, 2], channels)), (2, 2, vec![0.0; 4]));
    }
    let limits = Limits { max_pixels: 1 << 40, ..Limits::default() };
    let huge = windowed([0, 0], [0, 0], [100_000, 100_000], &["R", "G", "B"]);
    for error in [
        decode("a file", Cursor::new(&huge), &limits).err(),
        decode_raster("a file", Cursor::new(&huge), &limits).err(),
    ] {
        assert!(matches!(error, Some(ImageError::ImplausibleSize { .. })), "{error:?}");
    }
}

/// A crop is written with its place in the frame, by compressions with and without blocks of
/// several rows, and is read back at that place.
#[test]
fn a_crop_keeps_its_place_in_the_frame() {
    use juggler_imaging::{CropFrame, ExrCompression, ExrWindows};
    let image = picture(9, 35, 1.0);
    for exr_compression in [ExrCompression::None, ExrCompression::Rle, ExrCompression::Zip] {
        let options = Options { exr_compression, ..Options::default() };
        let crop = CropFrame::new([40, 50], [11, 13], [9, 35]);
        let header = juggler_imaging::Header { options, crop, ..header(&image) };
        let bytes = encode(ImageFormat::Exr, &image, &header);
        let found = decode("a file", Cursor::new(&bytes), &LIMITS).unwrap();
        assert_eq!((found.width(), found.height()), (40, 50));
        for (index, pixel) in found.pixels().iter().enumerate() {
            let (x, y) = (index % 40, index / 40);
            let inside = (11..20).contains(&x) && (13..48).contains(&y);
            let expected = if inside { image.pixels()[(y - 13) * 9 + x - 11] } else { juggler_math::Rgb::BLACK };
            assert_eq!(*pixel, expected, "{x} {y}");
        }
        // An independent reader finds the same windows.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        std::fs::write(&path, &bytes).unwrap();
        let meta = exr::meta::MetaData::read_from_file(&path, true).unwrap();
        let own = &meta.headers[0];
        assert_eq!(own.own_attributes.layer_position, exr::math::Vec2(11, 13));
        assert_eq!(own.shared_attributes.display_window.size, exr::math::Vec2(40, 50));
        let windows = juggler_imaging::inspect(&path).unwrap().windows.unwrap();
        assert_eq!(windows, ExrWindows::new([9, 35], crop));
        assert_eq!(windows.data.to_string(), "9x35 at 11, 13");
    }
}

#[test]
fn damaged_and_huge_files_are_errors() {
    let image = picture(19, 18, 3.0);
    for format in ImageFormat::ALL {
        for options in [Options::default(), Options { png_16_bit: true, ..Options::default() }] {
            let bytes = encode(format, &image, &juggler_imaging::Header { options, ..header(&image) });
            let pixels_end = bytes.len().saturating_sub(40);
            for length in (0..bytes.len()).step_by(7) {
                let result = read(&bytes[..length]);
                assert!(length > pixels_end || result.is_err(), "{format} cut at {length} of {}", bytes.len());
            }
            let small =
                decode_raster("a file", Cursor::new(&bytes), &Limits { max_pixels: 100, ..LIMITS }).unwrap_err();
            assert!(small.to_string().contains("the limit of 100 pixels"), "{small}");
        }
    }
    let text = read(b"no picture at all").unwrap_err().to_string();
    assert!(text.contains("match no supported format"), "{text}");
}
