//! Displayed frame: its texture, its placement, and conversions between points and pixels.

use crate::style;
use eframe::egui::{
    Color32, ColorImage, Context, Painter, Pos2, Rect, TextureFilter, TextureHandle, TextureOptions, Vec2, pos2, vec2,
};
use juggler_session::Frame;
use std::sync::Arc;

/// Maximum magnification.
const MAX_SCALE: f32 = 64.0;
/// Minimum magnification.
const MIN_SCALE: f32 = 1.0 / 16.0;

/// Magnification and position of the image.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImageView {
    /// Screen pixels per image pixel; `None` fits the image to its area.
    pub scale: Option<f32>,
    /// Offset of the image from the center of its area, in points.
    pub offset: Vec2,
}

/// Placement of the image on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Edges of the image, in points.
    pub rect: Rect,
    /// Width and height of the image, in pixels.
    size: [u32; 2],
    /// Screen pixels per image pixel.
    pub scale: f32,
}

impl ImageView {
    /// Places an image of `size` pixels in an area of the screen.
    pub fn place(&self, area: Rect, size: [u32; 2], pixels_per_point: f32) -> Placement {
        let size = size.map(|edge| edge.max(1));
        let [width, height] = size.map(|edge| edge as f32 / pixels_per_point);
        let fit = (area.width() / width).min(area.height() / height);
        let scale = self.scale.unwrap_or(fit).max(1e-3);
        let extent = vec2(width, height) * scale;
        let corner = area.center() + self.offset - extent / 2.0;
        let snap = |points: f32| (points * pixels_per_point).round() / pixels_per_point;
        let rect = Rect::from_min_size(pos2(snap(corner.x), snap(corner.y)), extent);
        Placement { rect, size, scale }
    }

    /// Switches between fitting the image and 100 %.
    pub fn toggle(&mut self) {
        let scale = if self.scale.is_none() { Some(1.0) } else { None };
        *self = Self { scale, offset: Vec2::ZERO };
    }

    /// Magnifies by a factor about the point `fixed`.
    pub fn magnify(&mut self, factor: f32, fixed: Pos2, area: Rect, placement: &Placement) {
        let scale = (placement.scale * factor).clamp(MIN_SCALE, MAX_SCALE);
        let middle = placement.rect.center() + (fixed - placement.rect.center()) * (1.0 - scale / placement.scale);
        *self = Self { scale: Some(scale), offset: middle - area.center() };
    }
}

impl Placement {
    /// Returns the film position under a point, in pixels; `None` outside of the image.
    pub fn film_position(&self, at: Pos2) -> Option<[f32; 2]> {
        let inside = self.rect.contains(at);
        let place = (at - self.rect.min) * self.pixels_per_point();
        inside.then(|| [place.x.min(self.size[0] as f32 - 0.001), place.y.min(self.size[1] as f32 - 0.001)])
    }

    /// Returns the pixel under a point; `None` outside of the image.
    pub fn pixel(&self, at: Pos2) -> Option<[u32; 2]> {
        self.film_position(at).map(|place| place.map(|edge| edge as u32))
    }

    /// Returns the pixel that is nearest to a point.
    pub fn nearest(&self, at: Pos2) -> [u32; 2] {
        let place = (at - self.rect.min) * self.pixels_per_point();
        let [width, height] = self.size;
        [(place.x.max(0.0) as u32).min(width - 1), (place.y.max(0.0) as u32).min(height - 1)]
    }

    /// Returns the rectangle from the upper left corner of one pixel to the lower right corner of
    /// another, in points.
    pub fn span(&self, from: [u32; 2], to: [u32; 2]) -> Rect {
        let point = |x: f32, y: f32| self.rect.min + vec2(x, y) / self.pixels_per_point();
        Rect::from_min_max(point(from[0] as f32, from[1] as f32), point(to[0] as f32 + 1.0, to[1] as f32 + 1.0))
    }

    /// Returns the number of image pixels per point.
    pub fn pixels_per_point(&self) -> f32 {
        self.size[0] as f32 / self.rect.width().max(1e-3)
    }
}

/// Texture of the newest frame.
#[derive(Default)]
pub struct FrameTexture {
    texture: Option<TextureHandle>,
    frame: u64,
    options: TextureOptions,
}

impl FrameTexture {
    /// Uploads a frame unless it is displayed already. Returns whether it was new.
    pub fn upload(&mut self, context: &Context, frame: &Frame, scale: f32, still: bool) -> bool {
        let pixels = match (frame.samples == 0.0, still) {
            (true, _) => Pixels::Coarse,
            (false, false) => Pixels::Passing,
            (false, true) => Pixels::Finished,
        };
        let options = filter(scale, pixels);
        let new = self.frame != frame.number || self.texture.is_none();
        if !new && options == self.options {
            return false;
        }
        (self.frame, self.options) = (frame.number, options);
        let image = image(frame, context.input(|input| input.max_texture_side));
        match &mut self.texture {
            Some(texture) => texture.set(image, options),
            none => *none = Some(context.load_texture("picture", image, options)),
        }
        new
    }

    /// Draws the frame.
    pub fn draw(&self, painter: &Painter, placement: &Placement) {
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            painter.rect_filled(placement.rect.expand(1.0), 0, style::EDGE);
            painter.image(texture.id(), placement.rect, whole, Color32::WHITE);
        }
    }
}

/// Kind of a frame's pixels, which decides their filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pixels {
    /// Coarser than image pixels.
    Coarse,
    /// Image pixels that the next frame will soon replace.
    Passing,
    /// Image pixels at rest.
    Finished,
}

/// Returns the texture filter: coarse pixels are interpolated, magnified image pixels stay squares.
fn filter(scale: f32, pixels: Pixels) -> TextureOptions {
    let square = pixels != Pixels::Coarse && (scale >= 2.0 || scale == 1.0);
    let magnification = if square { TextureFilter::Nearest } else { TextureFilter::Linear };
    let mipmap_mode = (scale < 0.6 && pixels == Pixels::Finished).then_some(TextureFilter::Linear);
    TextureOptions { magnification, mipmap_mode, ..TextureOptions::LINEAR }
}

/// Converts a frame for egui; a frame too large for the graphics card is subsampled.
fn image(frame: &Frame, most: usize) -> Arc<ColorImage> {
    let (width, height) = (frame.width as usize, frame.height as usize);
    let step = width.max(height).div_ceil(most.max(1)).max(1);
    if frame.rgba.len() != 4 * width * height || width == 0 {
        return Arc::new(ColorImage::filled([1, 1], Color32::BLACK));
    }
    if step == 1 {
        return Arc::new(ColorImage::from_rgba_premultiplied([width, height], &frame.rgba));
    }
    let rows = frame.rgba.chunks_exact(4 * width).step_by(step);
    let color = |pixel: &[u8]| match pixel {
        [red, green, blue, ..] => Color32::from_rgb(*red, *green, *blue),
        _ => Color32::BLACK,
    };
    let pixels: Vec<Color32> = rows.flat_map(|row| row.chunks_exact(4).step_by(step).map(color)).collect();
    Arc::new(ColorImage::new([width.div_ceil(step), height.div_ceil(step)], pixels))
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect { min: Pos2 { x: 100.0, y: 50.0 }, max: Pos2 { x: 900.0, y: 650.0 } };

    #[test]
    fn picture_fits_the_area_and_keeps_its_aspect_ratio() {
        let wide = ImageView::default().place(AREA, [1600, 900], 1.0);
        assert_eq!((wide.rect.width(), wide.rect.height(), wide.scale), (800.0, 450.0, 0.5));
        assert_eq!(wide.rect.center(), AREA.center());
        let high = ImageView::default().place(AREA, [300, 600], 2.0);
        assert_eq!((high.rect.width(), high.rect.height(), high.scale), (300.0, 600.0, 2.0));
    }

    #[test]
    fn window_positions_map_to_pixels() {
        let placement = ImageView::default().place(AREA, [1600, 900], 1.0);
        assert_eq!(placement.pixel(placement.rect.min), Some([0, 0]));
        assert_eq!(placement.pixel(placement.rect.center()), Some([800, 450]));
        assert_eq!(placement.pixel(placement.rect.max), Some([1599, 899]));
        assert_eq!(placement.pixel(placement.rect.min - vec2(1.0, 0.0)), None);
        assert_eq!(placement.nearest(pos2(-1e6, 1e9)), [0, 899]);
        let pixel = placement.span([800, 450], [800, 450]);
        assert_eq!((pixel.min, pixel.width()), (placement.rect.center(), 0.5));
    }

    #[test]
    fn magnification_keeps_the_point_under_the_pointer() {
        let mut view = ImageView::default();
        let before = view.place(AREA, [1600, 900], 1.0);
        let pointer = pos2(300.0, 400.0);
        view.magnify(3.0, pointer, AREA, &before);
        let after = view.place(AREA, [1600, 900], 1.0);
        assert_eq!(after.scale, 1.5);
        let [was, is] = [before, after].map(|placement| placement.film_position(pointer).unwrap());
        assert!((was[0] - is[0]).abs() < 1.0 && (was[1] - is[1]).abs() < 1.0, "{was:?} {is:?}");
        view.toggle();
        assert_eq!(view, ImageView::default());
    }

    #[test]
    fn frames_beyond_the_texture_limit_are_downsampled() {
        let rgba: Vec<u8> = (0..6 * 2).flat_map(|pixel| [pixel, 0, 0, 255]).collect();
        let frame = Frame { number: 1, revision: 0, width: 6, height: 2, rgba, size: [6, 2], samples: 1.0 };
        assert_eq!(image(&frame, 6).size, [6, 2]);
        let small = image(&frame, 4);
        assert_eq!(small.size, [3, 1]);
        assert_eq!(small.pixels.iter().map(|pixel| pixel.r()).collect::<Vec<_>>(), [0, 2, 4]);
        let torn = Frame { width: 7, ..frame };
        assert_eq!(image(&torn, 8).size, [1, 1]);
    }

    #[test]
    fn only_finished_pixels_use_nearest_filtering() {
        assert_eq!(filter(3.0, Pixels::Finished).magnification, TextureFilter::Nearest);
        assert_eq!(filter(3.0, Pixels::Coarse).magnification, TextureFilter::Linear);
        assert_eq!(filter(1.5, Pixels::Finished).magnification, TextureFilter::Linear);
        assert!(filter(0.3, Pixels::Finished).mipmap_mode.is_some());
        assert!(filter(0.3, Pixels::Passing).mipmap_mode.is_none());
    }
}
