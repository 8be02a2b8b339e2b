//! OpenEXR files: half floats, channels of the picture, windows.

use crate::common::{encode, header, picture};
use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, Layer, LayerAttributes, SmallVec, WritableImage};
use juggler_imaging::{ImageError, ImageFormat, Limits, Options, Raster, RasterSamples, decode, decode_raster};
use std::io::Cursor;

const LIMITS: Limits = Limits { max_pixels: 10_000, longest_side: 1_000 };

fn read(bytes: &[u8]) -> Result<Raster, ImageError> {
    decode_raster("a file", Cursor::new(bytes), &LIMITS)
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
