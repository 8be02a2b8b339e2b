//! Files of stored samples, which [`decode_raster`](crate::decode_raster) reads to the same samples:
//! PNG for levels of 8 and 16 bits, OpenEXR for floats.

use crate::raster::{Raster, RasterLayout, RasterSamples, TransferFunction};
use crate::{ImageError, ImageFormat};
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, WritableImage, f16};
use png::{BitDepth, ColorType};
use std::io::{Cursor, Write};

/// Code points of linear sRGB in cICP (ITU-T H.273): primaries of BT.709, the linear transfer
/// function, RGB, all levels.
const LINEAR: [u8; 4] = [1, 8, 0, 1];

/// The bytes of a file with the samples of a raster of 1 to 4 channels in sRGB primaries: a PNG for
/// levels, whose transfer function is sRGB's or linear, or an EXR for linear floats, with half floats
/// if these hold all values. `file` names it in messages.
pub fn raster_bytes(file: &str, raster: &Raster) -> Result<Vec<u8>, ImageError> {
    let format = match raster.samples {
        RasterSamples::Bytes(_) | RasterSamples::Words(_) => ImageFormat::Png,
        RasterSamples::Floats(_) => ImageFormat::Exr,
    };
    let failed = |message: String| ImageError::Encode { file: file.to_owned(), format, message };
    let RasterLayout { width, height, channels, .. } = raster.layout;
    format.check_dimensions(width, height)?;
    let samples = u64::from(width) * u64::from(height) * u64::from(channels);
    if !(1..=4).contains(&channels) || samples != raster.samples.len() as u64 {
        return Err(failed("the number of samples does not fit the size".to_owned()));
    }
    let is_linear = raster.transfer_function == TransferFunction::Linear;
    match &raster.samples {
        RasterSamples::Bytes(levels) => png_bytes(&raster.layout, levels, is_linear).map_err(|e| failed(e.to_string())),
        RasterSamples::Words(levels) => {
            let bytes: Vec<u8> = levels.iter().flat_map(|level| level.to_be_bytes()).collect();
            png_bytes(&raster.layout, &bytes, is_linear).map_err(|e| failed(e.to_string()))
        }
        RasterSamples::Floats(numbers) => exr_bytes(&raster.layout, numbers).map_err(|e| failed(e.to_string())),
    }
}

fn png_bytes(layout: &RasterLayout, samples: &[u8], is_linear: bool) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, layout.width, layout.height);
    encoder.set_color(match layout.channels {
        1 => ColorType::Grayscale,
        2 => ColorType::GrayscaleAlpha,
        3 => ColorType::Rgb,
        _ => ColorType::Rgba,
    });
    encoder.set_depth(if layout.sample_bytes == 2 { BitDepth::Sixteen } else { BitDepth::Eight });
    encoder.set_compression(png::Compression::Fast);
    if !is_linear {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    let mut writer = encoder.write_header()?;
    if is_linear {
        writer.write_chunk(png::chunk::cICP, &LINEAR)?;
    }
    let mut stream = writer.stream_writer()?;
    stream.write_all(samples)?;
    stream.finish()?;
    writer.finish()?;
    Ok(bytes)
}

fn exr_bytes(layout: &RasterLayout, numbers: &[f32]) -> Result<Vec<u8>, exr::error::Error> {
    let names: &[&str] = match layout.channels {
        1 => &["Y"],
        2 => &["Y", "A"],
        3 => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    };
    let is_half = numbers.iter().all(|number| f16::from_f32(*number).to_f32().to_bits() == number.to_bits());
    let channels = names.iter().enumerate().map(|(channel, name)| {
        let values = numbers.iter().skip(channel).step_by(names.len());
        let samples = match is_half {
            true => FlatSamples::F16(values.map(|number| f16::from_f32(*number)).collect()),
            false => FlatSamples::F32(values.copied().collect()),
        };
        AnyChannel::new(*name, samples)
    });
    let size = (layout.width as usize, layout.height as usize);
    let channels = AnyChannels::sort(channels.collect());
    let layer = Layer::new(size, LayerAttributes::default(), Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().non_parallel().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Limits, decode_raster};

    fn assert_kept(samples: RasterSamples, channels: u8, transfer_function: TransferFunction) {
        let (format, sample_bytes) = match samples {
            RasterSamples::Bytes(_) => (ImageFormat::Png, 1),
            RasterSamples::Words(_) => (ImageFormat::Png, 2),
            RasterSamples::Floats(_) => (ImageFormat::Exr, 4),
        };
        let layout = RasterLayout { format, width: 5, height: 3, channels, sample_bytes, to_srgb: None };
        let raster = Raster { layout, samples, transfer_function, is_first_of_several: false };
        let bytes = raster_bytes("a", &raster).unwrap();
        assert_eq!(decode_raster("a", Cursor::new(bytes), &Limits::default()).unwrap(), raster);
    }

    #[test]
    fn samples_of_every_type_are_read_as_they_were_written() {
        for channels in 1..=4_u8 {
            let numbers = 0..15 * u32::from(channels);
            for transfer_function in [TransferFunction::Srgb, TransferFunction::Linear] {
                let levels = RasterSamples::Bytes(numbers.clone().map(|i| (i * 37) as u8).collect());
                assert_kept(levels, channels, transfer_function);
                let levels = RasterSamples::Words(numbers.clone().map(|i| (i * 8191) as u16).collect());
                assert_kept(levels, channels, transfer_function);
            }
            let halves = numbers.clone().map(|i| i as f32 / 8.0 - 1.0);
            assert_kept(RasterSamples::Floats(halves.collect()), channels, TransferFunction::Linear);
            let floats = numbers.map(|i| if i == 3 { f32::INFINITY } else { i as f32 / 7.0 - 1e5 });
            assert_kept(RasterSamples::Floats(floats.collect()), channels, TransferFunction::Linear);
        }
    }

    #[test]
    fn samples_that_do_not_fit_the_size_are_refused() {
        let layout =
            RasterLayout { format: ImageFormat::Png, width: 2, height: 1, channels: 1, sample_bytes: 1, to_srgb: None };
        let raster = |channels, count| Raster {
            layout: RasterLayout { channels, ..layout },
            samples: RasterSamples::Bytes(vec![0; count]),
            transfer_function: TransferFunction::Srgb,
            is_first_of_several: false,
        };
        for (channels, count) in [(1, 3), (2, 2), (0, 0), (5, 10)] {
            assert!(raster_bytes("a", &raster(channels, count)).is_err(), "{channels} {count}");
        }
    }
}
