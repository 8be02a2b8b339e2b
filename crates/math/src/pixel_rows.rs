//! Rows of pixels with alpha.

use crate::Rgb;
use std::borrow::Cow;

/// Whole rows of pixels, from the top: linear RGB premultiplied by alpha, and alpha (Porter and
/// Duff, Compositing Digital Images, 1984).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelRows<'a> {
    /// Colors of the pixels: light that reaches the camera from the objects alone.
    pub colors: &'a [Rgb],
    /// Alpha of the pixels, 0 (transparent) to 1, as many as colors; `None` if all are opaque.
    pub alpha: Option<&'a [f32]>,
}

impl<'a> PixelRows<'a> {
    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.colors.len()
    }

    /// Whether there are no pixels.
    pub fn is_empty(&self) -> bool {
        self.colors.is_empty()
    }

    /// Pieces of at most `count` pixels.
    pub fn chunks(mut self, count: usize) -> impl Iterator<Item = Self> {
        std::iter::from_fn(move || (!self.is_empty()).then(|| self.split_off(count.max(1))))
    }

    /// Takes the first `count` pixels; fewer at the end.
    pub fn split_off(&mut self, count: usize) -> Self {
        let count = count.min(self.len());
        let (colors, rest) = self.colors.split_at(count);
        let (alpha, rest_of_alpha) = self.alpha.map(|alpha| alpha.split_at(count.min(alpha.len()))).unzip();
        *self = Self { colors: rest, alpha: rest_of_alpha };
        Self { colors, alpha }
    }

    /// Straight colors, which are not multiplied by alpha; black where alpha is 0.
    pub fn straight(&self) -> Cow<'a, [Rgb]> {
        let Some(alpha) = self.alpha else { return Cow::Borrowed(self.colors) };
        let straight = |(color, alpha): (&Rgb, &f32)| if *alpha > 0.0 { *color / *alpha } else { Rgb::BLACK };
        Cow::Owned(self.colors.iter().zip(alpha).map(straight).collect())
    }
}

impl<'a> From<&'a [Rgb]> for PixelRows<'a> {
    /// Creates rows of opaque pixels.
    fn from(colors: &'a [Rgb]) -> Self {
        Self { colors, alpha: None }
    }
}

impl<'a> From<&'a Vec<Rgb>> for PixelRows<'a> {
    /// Creates rows of opaque pixels.
    fn from(colors: &'a Vec<Rgb>) -> Self {
        colors.as_slice().into()
    }
}

impl<'a, const N: usize> From<&'a [Rgb; N]> for PixelRows<'a> {
    /// Creates rows of opaque pixels.
    fn from(colors: &'a [Rgb; N]) -> Self {
        colors.as_slice().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_keep_colors_and_alpha_together() {
        let colors: Vec<Rgb> = (0..5).map(|i| Rgb::splat(i as f32)).collect();
        let alpha = [0.0, 0.25, 0.5, 0.75, 1.0];
        let rows = PixelRows { colors: &colors, alpha: Some(&alpha) };
        let pieces: Vec<PixelRows> = rows.chunks(2).collect();
        assert_eq!(pieces.iter().map(PixelRows::len).collect::<Vec<_>>(), [2, 2, 1]);
        assert_eq!(pieces[1], PixelRows { colors: &colors[2..4], alpha: Some(&alpha[2..4]) });
        assert_eq!(PixelRows::from(&colors).chunks(0).count(), 5);
        assert_eq!(PixelRows::from(&[]).chunks(3).count(), 0);
    }

    #[test]
    fn straight_colors_are_divided_by_alpha() {
        let colors = [Rgb::splat(0.5), Rgb::splat(0.5), Rgb::splat(2.0)];
        let rows = PixelRows { colors: &colors, alpha: Some(&[0.25, 1.0, 0.0]) };
        assert_eq!(*rows.straight(), [Rgb::splat(2.0), Rgb::splat(0.5), Rgb::BLACK]);
        assert_eq!(*PixelRows::from(&colors).straight(), colors);
    }
}
