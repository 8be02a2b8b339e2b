//! Channels of an EXR file that are its picture, and their place in the display window.
//!
//! The picture is the first of these that a file has:
//!
//! 1. channels `R`, `G`, `B`, upper or lower case;
//! 2. those of a layer named `Combined` (Blender: `ViewLayer.Combined.R`), `beauty`, `rgba`, `rgb`
//!    or `color`;
//! 3. channel `Y`;
//! 4. those of the only layer with `R`, `G` and `B`;
//! 5. the only channel beside alpha.

use crate::ImageError;
use crate::codec::{Source, quoted};
use crate::exr_windows::{ExrWindows, PixelWindow};
use exr::math::Vec2;
use exr::meta::header::Header as ExrHeader;

/// Names of layers that contain the picture, in lower case.
const PICTURES: [&str; 5] = ["combined", "beauty", "rgba", "rgb", "color"];
/// Number of pixels of a display window that is accepted whatever the length of the file. Larger
/// ones must be plausible for the length, as data windows must.
const SMALL_DISPLAY: u64 = 1 << 24;
/// Maximum number of layers that a message names.
const NAMED: usize = 8;

/// Channels of the picture.
#[derive(Clone, Debug)]
pub struct Selection<'h> {
    /// Header of their part.
    pub header: &'h ExrHeader,
    /// One name for gray, or those of red, green and blue.
    pub colors: Vec<String>,
    /// Name of the alpha channel, if there is one.
    pub alpha: Option<String>,
}

/// Layer of a part: channels that have the same name up to the last dot.
struct Layer<'h> {
    header: &'h ExrHeader,
    /// Name with the last dot, or empty.
    prefix: String,
    /// Channel names after the last dot.
    channels: Vec<String>,
}

impl<'h> Layer<'h> {
    fn channel(&self, letter: &str) -> Option<String> {
        let found = self.channels.iter().find(|channel| channel.eq_ignore_ascii_case(letter))?;
        Some(format!("{}{found}", self.prefix))
    }

    /// Selects channels of these letters, if the layer has all.
    fn select(&self, letters: &[&str]) -> Option<Selection<'h>> {
        let colors = letters.iter().map(|letter| self.channel(letter)).collect::<Option<_>>()?;
        Some(Selection { header: self.header, colors, alpha: self.channel("A") })
    }

    fn is_picture(&self) -> bool {
        let name = self.prefix.trim_end_matches('.').to_ascii_lowercase();
        let last = name.rsplit('.').next().unwrap_or_default();
        PICTURES.contains(&last)
    }
}

/// Layers of all parts with flat data, in file order.
fn layers(headers: &[ExrHeader]) -> Vec<Layer<'_>> {
    let mut layers: Vec<Layer> = Vec::new();
    for header in headers.iter().filter(|header| !header.deep) {
        let first = layers.len();
        for channel in &header.channels.list {
            let name = channel.name.to_string();
            let start = name.rfind('.').map_or(0, |dot| dot + 1);
            let (prefix, channel) = name.split_at_checked(start).unwrap_or(("", &name));
            match layers.iter_mut().skip(first).find(|layer| layer.prefix == prefix) {
                Some(layer) => layer.channels.push(channel.to_owned()),
                None => {
                    layers.push(Layer { header, prefix: prefix.to_owned(), channels: vec![channel.to_owned()] });
                }
            }
        }
    }
    layers
}

/// Selects the picture of a file.
pub fn picture<'h>(source: Source, headers: &'h [ExrHeader]) -> Result<Selection<'h>, ImageError> {
    let layers = layers(headers);
    let rgb = |layer: &Layer<'h>| layer.select(&["R", "G", "B"]);
    let plain = || layers.iter().filter(|layer| layer.prefix.is_empty());
    let named = || plain().find_map(rgb).or_else(|| layers.iter().filter(|layer| layer.is_picture()).find_map(rgb));
    let found = named().or_else(|| plain().find_map(|layer| layer.select(&["Y"])));
    let found = found.or_else(|| only(layers.iter().filter_map(rgb))).or_else(|| only(layers.iter().flat_map(singles)));
    found.ok_or_else(|| source.malformed(no_picture(&layers)))
}

/// The item of an iterator that has exactly one.
fn only<T>(mut items: impl Iterator<Item = T>) -> Option<T> {
    items.next().filter(|_| items.next().is_none())
}

/// Selections of each channel alone, except for the alpha of others.
fn singles<'h>(layer: &Layer<'h>) -> Vec<Selection<'h>> {
    let alpha = layer.channel("A").filter(|_| layer.channels.len() > 1);
    let names = layer.channels.iter().map(|channel| format!("{}{channel}", layer.prefix));
    let colors = names.filter(|name| alpha.as_ref() != Some(name));
    colors.map(|name| Selection { header: layer.header, colors: vec![name], alpha: alpha.clone() }).collect()
}

/// Message about a file without picture.
fn no_picture(layers: &[Layer]) -> String {
    if layers.is_empty() {
        return "it has no flat layers; deep data is not supported".to_owned();
    }
    let names = layers.iter().flat_map(|layer| layer.channels.iter().map(|name| format!("{}{name}", layer.prefix)));
    let listed: Vec<String> = names.clone().take(NAMED).map(|name| quoted(&name)).collect();
    let more = if names.count() > NAMED { ", …" } else { "" };
    format!(
        "none of its layers is the picture: channels R, G and B, or Y, or a layer `Combined` or `beauty`; its channels are {}{more}",
        listed.join(", ")
    )
}

/// Windows of a part. An empty display window stands for the data window.
pub fn windows(header: &ExrHeader) -> ExrWindows {
    let window = |Vec2(x, y): Vec2<i32>, Vec2(width, height): Vec2<usize>| PixelWindow {
        x: x.into(),
        y: y.into(),
        width: width as u64,
        height: height as u64,
    };
    let data = window(header.own_attributes.layer_position, header.layer_size);
    let display = header.shared_attributes.display_window;
    let display = window(display.position, display.size);
    ExrWindows { data, display: if display.width == 0 || display.height == 0 { data } else { display } }
}

/// Place of a part's pixels in the display window.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    width: usize,
    height: usize,
    /// Position of the data window in the display window.
    left: i64,
    top: i64,
}

impl Placement {
    /// Placement of a part, after a check of the size of its display window.
    pub fn new(source: Source, header: &ExrHeader, max_pixels_per_byte: u64) -> Result<Self, ImageError> {
        let ExrWindows { data, display } = windows(header);
        let is_small = display.width.saturating_mul(display.height) <= SMALL_DISPLAY;
        let most = if is_small { u64::MAX } else { max_pixels_per_byte };
        let (width, height) = source.size(display.width, display.height, most)?;
        let (left, top) = (data.x.saturating_sub(display.x), data.y.saturating_sub(display.y));
        Ok(Self { width: width as usize, height: height as usize, left, top })
    }

    /// Width and height of the image.
    pub fn size(&self) -> (u32, u32) {
        // `Placement::new` has checked that the sides fit 32 bits.
        (self.width as u32, self.height as u32)
    }

    /// Number of pixels of the image.
    pub fn pixels(&self) -> usize {
        self.width.saturating_mul(self.height)
    }

    /// Index in the image of a pixel of the data window; `None` outside of the display window.
    #[inline]
    pub fn index(&self, Vec2(x, y): Vec2<usize>) -> Option<usize> {
        let place = |at: usize, offset: i64, size: usize| {
            let at = i64::try_from(at).ok()?.checked_add(offset)?;
            usize::try_from(at).ok().filter(|at| *at < size)
        };
        Some(place(y, self.top, self.height)? * self.width + place(x, self.left, self.width)?)
    }
}
