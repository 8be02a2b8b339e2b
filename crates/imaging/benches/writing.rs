//! Benchmark of tone mapping and of writing a 1920 × 1080 image in each format:
//! `cargo bench -p juggler-imaging`.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler_imaging::tone::Quantizer;
use juggler_imaging::{Destination, ExrCompression, Header, ImageError, ImageFormat, Options, Tone, writer};
use juggler_math::Rgb;
use juggler_math::testing::Random;
use std::io::{self, Seek, SeekFrom, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

const SIZE: (u32, u32) = (1920, 1080);

/// Sink that only counts bytes.
#[derive(Clone, Default)]
struct Counter(Arc<AtomicU64>);

impl Write for Counter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.fetch_add(bytes.len() as u64, Ordering::Relaxed);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Counter {
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        Ok(0)
    }
}

fn milliseconds(mut work: impl FnMut()) -> f64 {
    let times = (0..5).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64() * 1e3
    });
    times.fold(f64::INFINITY, f64::min)
}

fn tone(pixels: &[Rgb]) {
    for top in [255, 65_535] {
        let table = milliseconds(|| drop(Quantizer::new(&Tone::default(), top)));
        let quantizer = Quantizer::new(&Tone::default(), top);
        let mut bytes = Vec::with_capacity(pixels.len() * 6);
        let all = milliseconds(|| {
            bytes.clear();
            if top == 255 {
                quantizer.append_bytes(pixels, &mut bytes);
            } else {
                quantizer.append_words(pixels, &mut bytes);
            }
        });
        println!("tone, {top:>5} levels: table {table:.2} ms, picture {all:.1} ms");
    }
}

/// Writes the image and returns the file's length in bytes.
fn write(format: ImageFormat, header: &Header, pixels: &[Rgb]) -> Result<u64, ImageError> {
    let counter = Counter::default();
    let mut rows = writer(format, Destination::seekable("counter", counter.clone()), header)?;
    rows.write_rows(pixels.into())?;
    rows.finish()?;
    Ok(counter.0.load(Ordering::Relaxed))
}

fn main() -> Result<(), ImageError> {
    let mut random = Random::new(1);
    // A gradient with a little noise, like a path-traced sky.
    let pixels: Vec<Rgb> = (0..SIZE.0 * SIZE.1)
        .map(|i| Rgb::new(0.3, 0.5, 0.9) * (i as f32 / (SIZE.0 * SIZE.1) as f32) + random.rgb() * 0.02)
        .collect();
    tone(&pixels);
    let mut header = Header::new(SIZE.0, SIZE.1);
    for exr_compression in [ExrCompression::None, ExrCompression::Zip] {
        header.options = Options { exr_compression, ..Options::default() };
        let size = write(ImageFormat::Exr, &header, &pixels)?;
        let time = milliseconds(|| drop(write(ImageFormat::Exr, &header, &pixels)));
        println!("EXR {exr_compression:?}: {time:.1} ms, {:.2} MB", size as f64 * 1e-6);
    }
    header.options = Options::default();
    for format in ImageFormat::ALL.into_iter().chain([ImageFormat::Png]) {
        let size = write(format, &header, &pixels)?;
        let time = milliseconds(|| drop(write(format, &header, &pixels)));
        println!("{format:>12}: {time:.1} ms, {:.2} MB", size as f64 * 1e-6);
        // Measure PNG again, with 16 bits per channel.
        header.options = Options { png_16_bit: true, ..Options::default() };
    }
    Ok(())
}
