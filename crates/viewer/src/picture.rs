//! The frame on the screen: its texture, its place, and which pixel lies under which point.

use crate::style;
use eframe::egui::{
    Color32, ColorImage, Context, Painter, Pos2, Rect, TextureFilter, TextureHandle, TextureOptions, Vec2, pos2, vec2,
};
use juggler_session::Frame;
use std::sync::Arc;

/// Most by which pixels are magnified.
const MOST: f32 = 64.0;
/// Least.
const LEAST: f32 = 1.0 / 16.0;

/// How large the picture is shown.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct View {
    /// Pixels of the screen for one of the picture; as many as fit when there is none.
    pub scale: Option<f32>,
    /// By how many points the picture is off the middle.
    pub offset: Vec2,
}

/// Where the picture lies on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Its edges, points of the screen.
    pub rect: Rect,
    /// Its pixels.
    size: [u32; 2],
    /// Pixels of the screen for one of the picture.
    pub scale: f32,
}

impl View {
    /// Where a picture lies in an area of the screen.
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

    /// Between all of it and its very pixels.
    pub fn toggle(&mut self) {
        let scale = if self.scale.is_none() { Some(1.0) } else { None };
        *self = Self { scale, offset: Vec2::ZERO };
    }

    /// Magnifies by a factor; what is at `fixed` stays there.
    pub fn magnify(&mut self, factor: f32, fixed: Pos2, area: Rect, placement: &Placement) {
        let scale = (placement.scale * factor).clamp(LEAST, MOST);
        let middle = placement.rect.center() + (fixed - placement.rect.center()) * (1.0 - scale / placement.scale);
        *self = Self { scale: Some(scale), offset: middle - area.center() };
    }
}

impl Placement {
    /// The place in the picture under a point, in pixels from its top left; nothing outside of it.
    pub fn film(&self, at: Pos2) -> Option<[f32; 2]> {
        let inside = self.rect.contains(at);
        let place = (at - self.rect.min) * self.pixels_per_point();
        inside.then(|| [place.x.min(self.size[0] as f32 - 0.001), place.y.min(self.size[1] as f32 - 0.001)])
    }

    /// The pixel under a point.
    pub fn pixel(&self, at: Pos2) -> Option<[u32; 2]> {
        self.film(at).map(|place| place.map(|edge| edge as u32))
    }

    /// The pixel that is nearest to a point, wherever that is.
    pub fn nearest(&self, at: Pos2) -> [u32; 2] {
        let place = (at - self.rect.min) * self.pixels_per_point();
        let [width, height] = self.size;
        [(place.x.max(0.0) as u32).min(width - 1), (place.y.max(0.0) as u32).min(height - 1)]
    }

    /// Where some pixels lie: from one's top left to another's bottom right.
    pub fn span(&self, from: [u32; 2], to: [u32; 2]) -> Rect {
        let point = |x: f32, y: f32| self.rect.min + vec2(x, y) / self.pixels_per_point();
        Rect::from_min_max(point(from[0] as f32, from[1] as f32), point(to[0] as f32 + 1.0, to[1] as f32 + 1.0))
    }

    /// Pixels of the picture a point.
    pub fn pixels_per_point(&self) -> f32 {
        self.size[0] as f32 / self.rect.width().max(1e-3)
    }
}

/// The texture of the newest frame.
#[derive(Default)]
pub struct Screen {
    texture: Option<TextureHandle>,
    frame: u64,
    options: TextureOptions,
}

impl Screen {
    /// Takes over a frame unless it is there already; whether it was new.
    pub fn take(&mut self, context: &Context, frame: &Frame, scale: f32, still: bool) -> bool {
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

    /// Draws it.
    pub fn draw(&self, painter: &Painter, placement: &Placement) {
        if let Some(texture) = &self.texture {
            let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
            painter.rect_filled(placement.rect.expand(1.0), 0, style::EDGE);
            painter.image(texture.id(), placement.rect, whole, Color32::WHITE);
        }
    }
}

/// What a frame's pixels are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pixels {
    /// Fewer than the picture has.
    Coarse,
    /// Those of the picture, soon to be replaced by the next.
    Passing,
    /// Those of a picture that stays.
    Finished,
}

/// How pixels are made larger or smaller: finished ones stay squares, coarse ones flow into each other.
fn filter(scale: f32, pixels: Pixels) -> TextureOptions {
    let square = pixels != Pixels::Coarse && (scale >= 2.0 || scale == 1.0);
    let magnification = if square { TextureFilter::Nearest } else { TextureFilter::Linear };
    let mipmap_mode = (scale < 0.6 && pixels == Pixels::Finished).then_some(TextureFilter::Linear);
    TextureOptions { magnification, mipmap_mode, ..TextureOptions::LINEAR }
}

/// A frame as egui wants it, with every so-manieth pixel when it is too large for the graphics card.
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
    fn fits_and_keeps_its_shape() {
        let wide = View::default().place(AREA, [1600, 900], 1.0);
        assert_eq!((wide.rect.width(), wide.rect.height(), wide.scale), (800.0, 450.0, 0.5));
        assert_eq!(wide.rect.center(), AREA.center());
        let high = View::default().place(AREA, [300, 600], 2.0);
        assert_eq!((high.rect.width(), high.rect.height(), high.scale), (300.0, 600.0, 2.0));
    }

    #[test]
    fn points_and_pixels() {
        let placement = View::default().place(AREA, [1600, 900], 1.0);
        assert_eq!(placement.pixel(placement.rect.min), Some([0, 0]));
        assert_eq!(placement.pixel(placement.rect.center()), Some([800, 450]));
        assert_eq!(placement.pixel(placement.rect.max), Some([1599, 899]));
        assert_eq!(placement.pixel(placement.rect.min - vec2(1.0, 0.0)), None);
        assert_eq!(placement.nearest(pos2(-1e6, 1e9)), [0, 899]);
        let pixel = placement.span([800, 450], [800, 450]);
        assert_eq!((pixel.min, pixel.width()), (placement.rect.center(), 0.5));
    }

    #[test]
    fn what_is_under_the_pointer_stays_when_magnified() {
        let mut view = View::default();
        let before = view.place(AREA, [1600, 900], 1.0);
        let pointer = pos2(300.0, 400.0);
        view.magnify(3.0, pointer, AREA, &before);
        let after = view.place(AREA, [1600, 900], 1.0);
        assert_eq!(after.scale, 1.5);
        let [was, is] = [before, after].map(|placement| placement.film(pointer).unwrap());
        assert!((was[0] - is[0]).abs() < 1.0 && (was[1] - is[1]).abs() < 1.0, "{was:?} {is:?}");
        view.toggle();
        assert_eq!(view, View::default());
    }

    #[test]
    fn too_large_a_frame_is_thinned_out() {
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
    fn pixels_are_squares_only_when_they_are_finished() {
        assert_eq!(filter(3.0, Pixels::Finished).magnification, TextureFilter::Nearest);
        assert_eq!(filter(3.0, Pixels::Coarse).magnification, TextureFilter::Linear);
        assert_eq!(filter(1.5, Pixels::Finished).magnification, TextureFilter::Linear);
        assert!(filter(0.3, Pixels::Finished).mipmap_mode.is_some());
        assert!(filter(0.3, Pixels::Passing).mipmap_mode.is_none());
    }
}
