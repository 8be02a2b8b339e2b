//! Test images, encoded to memory.
use juggler_imaging::{Destination, Header, ImageFormat, Limits, decode, writer};
use juggler_math::testing::Random;
use juggler_math::{Image, Rgb};
use std::io::{self, Cursor, Seek, SeekFrom, Write};
use std::sync::{Arc, Mutex};

/// Buffer that stays readable after the writer is dropped.
#[derive(Clone, Default)]
pub struct Shared(Arc<Mutex<Cursor<Vec<u8>>>>);

impl Shared {
    pub fn bytes(&self) -> Vec<u8> {
        self.0.lock().unwrap().get_ref().clone()
    }
}

impl Write for Shared {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }
    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for Shared {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.0.lock().unwrap().seek(to)
    }
}

/// A smooth gradient with noise, some black and some very bright pixels.
pub fn picture(width: u32, height: u32, brightest: f32) -> Image {
    let mut random = Random::new(u64::from(width * 1000 + height));
    let pixels = (0..width * height).map(|i| {
        let smooth = (i % width) as f32 / width as f32;
        match random.below(10) {
            0 => Rgb::BLACK,
            1 => random.rgb() * brightest,
            _ => Rgb::new(smooth, smooth * smooth, 1.0 - smooth) * 0.8 + random.rgb() * 0.05,
        }
    });
    Image::from_pixels(width, height, pixels.collect()).unwrap()
}

pub fn header(image: &Image) -> Header {
    Header::new(image.width(), image.height())
}

/// Encodes the image, `rows` rows per call, to seekable memory or to a pipe.
pub fn encode_by(format: ImageFormat, image: &Image, header: &Header, rows: usize, seekable: bool) -> Vec<u8> {
    let memory = Shared::default();
    let destination = match seekable {
        true => Destination::seekable("memory", memory.clone()),
        false => Destination::stream("pipe", memory.clone()),
    };
    let mut writer = writer(format, destination, header).unwrap();
    for rows in image.pixels().chunks(image.width() as usize * rows) {
        writer.write_rows(rows.into()).unwrap();
    }
    writer.finish().unwrap();
    memory.bytes()
}

#[allow(dead_code, reason = "each test file is a crate of its own and uses some of these")]
pub fn encode(format: ImageFormat, image: &Image, header: &Header) -> Vec<u8> {
    encode_by(format, image, header, image.height() as usize, true)
}

#[allow(dead_code, reason = "each test file is a crate of its own and uses some of these")]
pub fn read(bytes: &[u8]) -> Image {
    decode("memory", Cursor::new(bytes), &Limits::default()).unwrap()
}
