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
    let layout = RasterLayout { format: ImageFormat::Png, width: 2, height: 1, channels: 4, sample_bytes: 1 };
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
    let error = read(&exr(&[("depth", [1.0, 2.0])])).unwrap_err().to_string();
    assert!(error.contains("no layer with channels R, G and B, or Y"), "{error}");
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
