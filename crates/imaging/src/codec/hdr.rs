//! Radiance HDR (Ward, Real Pixels, Graphics Gems II, 1991): three 8-bit mantissas with a shared
//! exponent, rows with run-length encoding. Mantissas are rounded to nearest when written and read
//! without a half-step offset, as most programs do; the error is at most 1/256 of the largest
//! channel.

use super::{Header, Inspected, ReadSeek, RowWriter, Source, quoted};
use crate::ImageError;
use crate::output::Destination;
use crate::raster::RasterLayout;
use crate::tone::{Chromaticities, Matrix};
use juggler_math::{Image, PixelRows, Rgb};
use std::io::{self, BufRead, Read, Write};

/// Image widths for which rows can be run-length encoded.
const RLE_WIDTHS: std::ops::Range<usize> = 8..32_768;
/// Maximum number of pixels per byte: 2,048 equal pixels of a row take three old runs of 4 bytes.
const MAX_PIXELS_PER_BYTE: u64 = 256;

/// Streams rows into a Radiance HDR file.
pub(super) struct Writer {
    bytes: Box<dyn Write + Send>,
    file: String,
    width: usize,
    row: Vec<u8>,
}

impl Writer {
    pub fn new(destination: Destination, header: &Header) -> Result<Self, ImageError> {
        let file = destination.name().to_owned();
        let mut text = String::from("#?RADIANCE\n");
        for (key, value) in &header.metadata {
            let one_line = |s: &str| s.replace(['\n', '\r'], " ");
            text += &format!("{}={}\n", one_line(key).replace('=', " "), one_line(value));
        }
        text += &format!("FORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", header.height, header.width);
        let mut bytes = destination.into_stream();
        if let Err(source) = bytes.write_all(text.as_bytes()) {
            return Err(ImageError::Write { file, source });
        }
        Ok(Self { bytes, file, width: header.width as usize, row: Vec::new() })
    }
}

impl RowWriter for Writer {
    fn write_rows(&mut self, rows: PixelRows) -> Result<(), ImageError> {
        for row in rows.colors.chunks_exact(self.width) {
            self.row.clear();
            pack_row(row, &mut self.row);
            let written = self.bytes.write_all(&self.row);
            written.map_err(|source| ImageError::Write { file: self.file.clone(), source })?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), ImageError> {
        self.bytes.flush().map_err(|source| ImageError::Write { file: self.file, source })
    }
}

fn pack_row(row: &[Rgb], bytes: &mut Vec<u8>) {
    if !RLE_WIDTHS.contains(&row.len()) {
        bytes.extend(row.iter().flat_map(|&p| to_rgbe(p)));
        return;
    }
    bytes.extend([2, 2, (row.len() >> 8) as u8, row.len() as u8]);
    let pixels: Vec<[u8; 4]> = row.iter().map(|&p| to_rgbe(p)).collect();
    for channel in 0..4 {
        let plane: Vec<u8> = pixels.iter().map(|p| p[channel]).collect();
        pack_plane(&plane, bytes);
    }
}

/// Encodes runs of at least 4 equal bytes as (128 + length, byte), other bytes as (length, bytes).
fn pack_plane(plane: &[u8], bytes: &mut Vec<u8>) {
    let mut rest = plane;
    while !rest.is_empty() {
        let start = rest.windows(4).position(|w| w.iter().all(|&b| b == w[0])).unwrap_or(rest.len());
        let (literal, run) = rest.split_at(start);
        for part in literal.chunks(128) {
            bytes.push(part.len() as u8);
            bytes.extend(part);
        }
        let length = run.iter().take(127).take_while(|&&b| b == run[0]).count();
        if length > 0 {
            bytes.extend([128 + length as u8, run[0]]);
        }
        rest = &run[length..];
    }
}

/// Encodes a color as RGBE. Negative and NaN channels become 0; values are clamped below 2^127.
fn to_rgbe(color: Rgb) -> [u8; 4] {
    let color = color.map(|v| if v > 0.0 { v.min(1.7e38) } else { 0.0 });
    let largest = color.max_channel();
    if largest < 1e-32 {
        return [0; 4];
    }
    // largest = mantissa · 2^exponent, mantissa in [1/2, 1).
    let mut exponent = (largest.to_bits() >> 23) as i32 - 126;
    if (largest * power_of_two(8 - exponent)).round() > 255.0 {
        exponent += 1;
    }
    let scale = power_of_two(8 - exponent);
    let [r, g, b] = color.map(|v| (v * scale).round()).to_array();
    [r as u8, g as u8, b as u8, (exponent + 128) as u8]
}

fn from_rgbe([r, g, b, e]: [u8; 4]) -> Rgb {
    if e == 0 {
        return Rgb::BLACK;
    }
    let (high, low) =
        (power_of_two((i32::from(e) - 136).max(-126)), power_of_two((i32::from(e) - 136).min(-126) + 126));
    Rgb::new(f32::from(r), f32::from(g), f32::from(b)) * high * low
}

/// 2^n for -126 <= n <= 127.
fn power_of_two(n: i32) -> f32 {
    f32::from_bits(((n + 127) as u32) << 23)
}

/// Reads an image, with or without run-length encoding, and converts it to sRGB primaries.
pub(super) fn read(source: Source, bytes: &mut dyn ReadSeek) -> Result<Image, ImageError> {
    let (mut image, to_srgb) = pixels(source, bytes)?;
    super::convert_primaries(image.pixels_mut(), to_srgb);
    Ok(image)
}

/// Layout of the image's raster, from the header.
pub(super) fn layout(source: Source, bytes: &mut dyn ReadSeek) -> Result<RasterLayout, ImageError> {
    let lines = read_header(source, bytes)?;
    Ok(RasterLayout { to_srgb: to_srgb(&lines), ..source.layout(size(source, &lines)?, 3, 4) })
}

/// Matrix from the primaries of the last `PRIMARIES=` line to sRGB's: x and y of red, green, blue
/// and white.
fn to_srgb(lines: &[String]) -> Option<Matrix> {
    let numbers = numbers_of::<8>(lines.iter().rev().find_map(|line| line.strip_prefix("PRIMARIES="))?)?;
    let [rx, ry, gx, gy, bx, by, wx, wy] = numbers;
    Chromaticities { red: [rx, ry], green: [gx, gy], blue: [bx, by], white: [wx, wy] }.to_srgb()
}

/// Numbers separated by blanks; `None` if their count differs or one of them is not finite.
fn numbers_of<const COUNT: usize>(text: &str) -> Option<[f64; COUNT]> {
    let numbers: Option<Vec<f64>> = text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
    let numbers: [f64; COUNT] = numbers?.try_into().ok()?;
    numbers.iter().all(|number| number.is_finite()).then_some(numbers)
}

/// Factors that the file's `EXPOSURE=` and `COLORCORR=` lines have multiplied the original colors
/// with. Lines of one kind accumulate.
fn applied_factors(lines: &[String]) -> Rgb {
    let exposures = lines.iter().filter_map(|line| line.strip_prefix("EXPOSURE=")).filter_map(numbers_of::<1>);
    let corrections = lines.iter().filter_map(|line| line.strip_prefix("COLORCORR=")).filter_map(numbers_of::<3>);
    let positive = |factors: &[f64; 3]| factors.iter().all(|factor| (*factor as f32) > 0.0);
    let all = exposures.map(|[exposure]| [exposure; 3]).chain(corrections).filter(positive);
    all.fold(Rgb::WHITE, |product, factors| product * Rgb::from(factors.map(|factor| factor as f32)))
}

/// Reads an image in the file's primaries, with the matrix to sRGB's.
pub(super) fn pixels(source: Source, bytes: &mut dyn ReadSeek) -> Result<(Image, Option<Matrix>), ImageError> {
    let lines = read_header(source, bytes)?;
    let resolution = resolution(source, &lines)?;
    if let Some(format) = lines.iter().find_map(|l| l.strip_prefix("FORMAT=")).filter(|f| *f != "32-bit_rle_rgbe") {
        return Err(source.malformed(format!("its pixels are {}, only 32-bit_rle_rgbe is supported", quoted(format))));
    }
    let factors = applied_factors(&lines).to_array();
    let mut pixels = Vec::new();
    let mut planes = Vec::new();
    let (scanlines, length) = resolution.scanlines();
    for _ in 0..scanlines {
        read_row(source, bytes, length as usize, &mut planes)?;
        pixels.extend(planes.chunks_exact(4).map(|p| {
            let [r, g, b] = from_rgbe([p[0], p[1], p[2], p[3]]).to_array();
            Rgb::new(r / factors[0], g / factors[1], b / factors[2])
        }));
    }
    let pixels = resolution.upright(pixels);
    Ok((source.image(resolution.width, resolution.height, pixels)?, to_srgb(&lines)))
}

/// Image size, from the resolution line.
fn size(source: Source, lines: &[String]) -> Result<(u32, u32), ImageError> {
    let Resolution { width, height, .. } = resolution(source, lines)?;
    Ok((width, height))
}

/// Size and order of the pixels. Scanlines advance along the first axis of the resolution line,
/// pixels of a scanline along the second.
struct Resolution {
    width: u32,
    height: u32,
    /// Whether scanlines are columns.
    has_columns: bool,
    /// Whether x falls, and whether y rises to the top, in the order of the file.
    is_flipped: [bool; 2],
}

/// Parses the resolution line, in one of its eight forms such as `-Y height +X width`.
fn resolution(source: Source, lines: &[String]) -> Result<Resolution, ImageError> {
    let last = lines.last().map(String::as_str).unwrap_or_default();
    let words: Vec<&str> = last.split_ascii_whitespace().collect();
    let (x, columns, y, rows, has_columns) = match words.as_slice() {
        [y @ ("-Y" | "+Y"), rows, x @ ("-X" | "+X"), columns] => (*x, columns, *y, rows, false),
        [x @ ("-X" | "+X"), columns, y @ ("-Y" | "+Y"), rows] => (*x, columns, *y, rows, true),
        _ => return Err(source.malformed(format!("its size says {}, not `-Y height +X width`", quoted(last)))),
    };
    let (Ok(width), Ok(height)) = (columns.parse(), rows.parse()) else {
        return Err(source.malformed(format!("its size says {}", quoted(last))));
    };
    let (width, height) = source.size(width, height, MAX_PIXELS_PER_BYTE)?;
    Ok(Resolution { width, height, has_columns, is_flipped: [x == "-X", y == "+Y"] })
}

impl Resolution {
    /// Number of scanlines, and of pixels in each.
    fn scanlines(&self) -> (u32, u32) {
        if self.has_columns { (self.width, self.height) } else { (self.height, self.width) }
    }

    /// Pixels row by row from the top, from pixels in the order of the file.
    fn upright(&self, pixels: Vec<Rgb>) -> Vec<Rgb> {
        if !self.has_columns && self.is_flipped == [false, false] {
            return pixels;
        }
        let (width, height) = (self.width as usize, self.height as usize);
        let pixel = |x: usize, y: usize| {
            let x = if self.is_flipped[0] { width - 1 - x } else { x };
            let y = if self.is_flipped[1] { height - 1 - y } else { y };
            pixels.get(if self.has_columns { x * height + y } else { y * width + x }).copied().unwrap_or_default()
        };
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
    }
}

/// Reads the header's lines including the resolution line, without the empty line.
fn read_header(source: Source, bytes: &mut dyn ReadSeek) -> Result<Vec<String>, ImageError> {
    let mut lines: Vec<String> = Vec::new();
    let mut ended = false;
    while lines.len() < 1000 {
        let mut line = Vec::new();
        bytes.take(100_000).read_until(b'\n', &mut line).map_err(|e| source.failed(e))?;
        if line.pop() != Some(b'\n') {
            return Err(source.malformed("its header has no end"));
        }
        let line = String::from_utf8_lossy(&line).into_owned();
        match (line.is_empty(), ended) {
            (true, _) => ended = true,
            (false, true) => {
                lines.push(line);
                return Ok(lines);
            }
            (false, false) => lines.push(line),
        }
    }
    Err(source.malformed("its header has no end"))
}

/// Reads one row as RGBE pixels.
fn read_row(source: Source, bytes: &mut dyn ReadSeek, width: usize, row: &mut Vec<u8>) -> Result<(), ImageError> {
    let mut start = [0; 4];
    bytes.read_exact(&mut start).map_err(|e| source.failed(e))?;
    row.clear();
    let packed = RLE_WIDTHS.contains(&width) && start[..2] == [2, 2] && start[2] < 128;
    if !packed {
        return read_old_row(source, bytes, start, width, row);
    }
    if usize::from(start[2]) << 8 | usize::from(start[3]) != width {
        return Err(source.malformed("a row has the wrong width"));
    }
    row.resize(width * 4, 0);
    for channel in 0..4 {
        let mut targets = row.iter_mut().skip(channel).step_by(4);
        if let Err(error) = unpack_plane(bytes, width, |byte| targets.next().map(|t| *t = byte)) {
            return Err(source.failed(error));
        }
    }
    Ok(())
}

/// Reads a row of single pixels and of old runs, whose first pixel is `pixel`. The pixel (1, 1, 1,
/// n) repeats the last pixel n times; in a sequence of runs, each counts 256 times as much as the
/// run before.
fn read_old_row(
    source: Source,
    bytes: &mut dyn ReadSeek,
    pixel: [u8; 4],
    width: usize,
    row: &mut Vec<u8>,
) -> Result<(), ImageError> {
    let (mut pixel, mut last, mut unit) = (pixel, None, 1);
    loop {
        let run = last.filter(|_| pixel[..3] == [1, 1, 1]);
        let count = if run.is_some() { usize::from(pixel[3]).saturating_mul(unit) } else { 1 };
        if count > width.saturating_sub(row.len() / 4) {
            return Err(source.malformed("a run is longer than its row"));
        }
        unit = if run.is_some() { unit.saturating_mul(256) } else { 1 };
        last = Some(run.unwrap_or(pixel));
        row.extend(std::iter::repeat_n(run.unwrap_or(pixel), count).flatten());
        if row.len() >= width.saturating_mul(4) {
            return Ok(());
        }
        bytes.read_exact(&mut pixel).map_err(|e| source.failed(e))?;
    }
}

fn unpack_plane(bytes: &mut dyn BufRead, width: usize, mut put: impl FnMut(u8) -> Option<()>) -> io::Result<()> {
    let mut left = width;
    let mut buffer = [0; 128];
    while left > 0 {
        let mut code = [0];
        bytes.read_exact(&mut code)?;
        let run = code[0] > 128;
        let count = usize::from(if run { code[0] - 128 } else { code[0] });
        if count == 0 || count > left {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a run is longer than its row"));
        }
        let read = if run { 1 } else { count };
        bytes.read_exact(&mut buffer[..read])?;
        for i in 0..count {
            put(buffer[if run { 0 } else { i }]);
        }
        left -= count;
    }
    Ok(())
}

/// Image size and `key=value` lines, except those that describe the encoding.
pub(super) fn inspect(source: Source, bytes: &mut dyn ReadSeek) -> Result<Inspected, ImageError> {
    let lines = read_header(source, bytes)?;
    let size = size(source, &lines)?;
    let pairs = lines.iter().filter_map(|l| l.split_once('=').map(|(k, v)| (k.to_owned(), v.to_owned())));
    Ok((
        size,
        pairs.filter(|(key, _)| !["FORMAT", "EXPOSURE", "COLORCORR", "PRIMARIES"].contains(&key.as_str())).collect(),
    ))
}
