//! Table-driven tone mapping. Curves are monotonic, so each level has a smallest input. These
//! thresholds, exact to the last bit, yield the formula's levels without a power function per
//! channel. A second table, indexed by exponent and leading mantissa bits of the input, limits the
//! search among thresholds. Operations that mix channels come before the table.

use super::{ColorPipeline, Tone, level};
use juggler_math::{PixelRows, Rgb};

/// Low bits of an `f32` dropped for the second table's index, which keeps exponent and 8 mantissa
/// bits.
const SHIFT: u32 = 15;

/// Converts linear RGB to levels, with the results of [`Tone::levels`].
#[derive(Clone, Debug)]
pub struct Quantizer {
    gain: f32,
    /// Operations before the curve, if the settings mix channels.
    pipeline: Option<ColorPipeline>,
    /// `thresholds[k]`: smallest positive input of level k + 1; NaN if there is none, as for k =
    /// `top`.
    thresholds: Vec<f32>,
    /// `start[i]`: level of the smallest input in cell i.
    start: Vec<u16>,
    /// What shows through transparent pixels; black if `None`.
    backdrop: Option<Backdrop>,
}

/// Color behind transparent pixels.
#[derive(Clone, Debug)]
struct Backdrop {
    /// Display-linear color with the primaries of the file.
    color: Rgb,
    /// Display-linear values of all levels.
    decoded: Vec<f32>,
}

impl Backdrop {
    fn new(tone: &Tone, top: u16) -> Option<Self> {
        let color = tone.backdrop?;
        let color = tone.primaries.matrix_from_srgb().map_or(color, |matrix| matrix.color(color));
        let curve = tone.curve.channel_curve();
        let decoded = (0..=top).map(|level| curve.decode(f64::from(level) / f64::from(top)) as f32);
        Some(Self { color, decoded: decoded.collect() })
    }
}

impl Quantizer {
    /// Tables for levels 0 to `top`.
    pub fn new(tone: &Tone, top: u16) -> Self {
        let curve = tone.curve.channel_curve();
        let mut last = 1;
        let thresholds = (1..=top)
            .map(|k| {
                let guess = curve.decode((f64::from(k) - 0.5) / f64::from(top)) as f32;
                last = first_bits(last, guess.to_bits(), |bits| level(curve, f32::from_bits(bits), top) >= k);
                if last > f32::INFINITY.to_bits() { f32::NAN } else { f32::from_bits(last) }
            })
            .chain([f32::NAN]);
        let thresholds: Vec<f32> = thresholds.collect();
        let cells = (f32::INFINITY.to_bits() >> SHIFT) + 2;
        let mut reached = 0;
        let start = (0..cells).map(|cell| {
            let smallest = f32::from_bits((cell << SHIFT).min(f32::INFINITY.to_bits()));
            while thresholds.get(reached).is_some_and(|&t| t <= smallest) {
                reached += 1;
            }
            reached as u16
        });
        let start = start.collect();
        let backdrop = Backdrop::new(tone, top);
        Self { gain: tone.gain(), pipeline: ColorPipeline::new(tone), thresholds, start, backdrop }
    }

    /// Levels of a pixel; NaN becomes 0.
    pub fn levels(&self, pixel: Rgb) -> [u16; 3] {
        match &self.pipeline {
            None => pixel.to_array().map(|v| self.level(v * self.gain)),
            Some(pipeline) => pipeline.apply(pixel).to_array().map(|v| self.level(v)),
        }
    }

    /// Levels of a pixel, premultiplied by its alpha, over the backdrop of the tone or over black. The
    /// display's light is mixed, so that edges look the same over all colors.
    pub fn levels_over(&self, pixel: Rgb, alpha: f32) -> [u16; 3] {
        let Some(backdrop) = self.backdrop.as_ref().filter(|_| alpha < 1.0) else { return self.levels(pixel) };
        let backdrop_share = 1.0 - alpha.max(0.0);
        let straight = if alpha > 0.0 { pixel / alpha } else { Rgb::BLACK };
        let shown = self.levels(straight).map(|level| backdrop.decoded.get(usize::from(level)).copied());
        let mixed = Rgb::from(shown.map(Option::unwrap_or_default)) * alpha.max(0.0) + backdrop.color * backdrop_share;
        mixed.to_array().map(|channel| self.level(channel))
    }

    /// Level of one channel.
    fn level(&self, exposed: f32) -> u16 {
        if exposed > 0.0 {
            let cell = (exposed.to_bits() >> SHIFT) as usize;
            let (low, high) = (self.start[cell], self.start[cell + 1]);
            if high - low <= 1 {
                // Usual case with 256 levels: a comparison without an unpredictable branch.
                return low + u16::from(self.thresholds[low as usize] <= exposed);
            }
            let within = &self.thresholds[low as usize..high as usize];
            return low + within.partition_point(|&t| t <= exposed) as u16;
        }
        0
    }

    /// Appends three 8-bit levels per pixel, for a quantizer with top level 255.
    pub fn append_bytes<'p>(&self, rows: impl Into<PixelRows<'p>>, bytes: &mut Vec<u8>) {
        let (rows, start) = (rows.into(), bytes.len());
        bytes.resize(start + rows.len() * 3, 0);
        for (target, levels) in bytes[start..].chunks_exact_mut(3).zip(self.all_levels(rows)) {
            target.copy_from_slice(&levels.map(|level| level as u8));
        }
    }

    /// Appends three big-endian 16-bit levels per pixel.
    pub fn append_words<'p>(&self, rows: impl Into<PixelRows<'p>>, bytes: &mut Vec<u8>) {
        let (rows, start) = (rows.into(), bytes.len());
        bytes.resize(start + rows.len() * 6, 0);
        for (target, levels) in bytes[start..].chunks_exact_mut(6).zip(self.all_levels(rows)) {
            let [r, g, b] = levels.map(u16::to_be_bytes);
            target.copy_from_slice(&[r[0], r[1], g[0], g[1], b[0], b[1]]);
        }
    }

    /// Levels of all pixels, over the backdrop where they are transparent.
    pub fn all_levels<'p>(&'p self, rows: PixelRows<'p>) -> impl Iterator<Item = [u16; 3]> + 'p {
        let alpha = rows.alpha.unwrap_or_default().iter().copied().chain(std::iter::repeat(1.0));
        rows.colors.iter().zip(alpha).map(|(pixel, alpha)| self.levels_over(*pixel, alpha))
    }
}

/// Smallest value from `low` to one above infinity's bits for which the monotonic predicate
/// `holds`: widens exponentially from `guess`, then bisects.
fn first_bits(low: u32, guess: u32, holds: impl Fn(u32) -> bool) -> u32 {
    let end = f32::INFINITY.to_bits() + 1;
    let holds = |bits: u32| bits >= end || holds(bits);
    let (mut below, mut above) = (low, guess.clamp(low, end));
    let mut step = 1;
    // Bracket the answer: `below` does not hold, `above` does.
    while !holds(above) {
        below = above + 1;
        above = above.saturating_add(step).min(end);
        step = step.saturating_mul(2);
    }
    step = 1;
    while above > below {
        let probe = above.saturating_sub(step).max(below);
        if !holds(probe) {
            below = probe + 1;
            break;
        }
        above = probe;
        step = step.saturating_mul(2);
    }
    while below < above {
        let middle = below + (above - below) / 2;
        if holds(middle) { above = middle } else { below = middle + 1 }
    }
    above
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone::{Agx, AnyCurve, Gamma, Linear, Primaries, Reinhard, WhiteBalance};
    use juggler_math::testing::Random;

    fn tones() -> Vec<Tone> {
        let curves = [
            AnyCurve::default(),
            AnyCurve::Gamma(Gamma { gamma: 2.2 }),
            AnyCurve::Gamma(Gamma { gamma: 0.3 }),
            AnyCurve::Gamma(Gamma { gamma: 9.0 }),
            AnyCurve::Linear(Linear {}),
        ];
        let tone = |curve: &AnyCurve, exposure_stops| Tone { exposure_stops, ..Tone::new(curve.clone()) };
        curves.iter().flat_map(|c| [tone(c, 0.0), tone(c, -2.7)]).collect()
    }

    fn gray(quantizer: &Quantizer, x: f32) -> u16 {
        quantizer.levels(Rgb::splat(x))[0]
    }

    fn formula(tone: &Tone, x: f32, top: u16) -> u16 {
        tone.levels(Rgb::splat(x), top)[2]
    }

    #[test]
    fn the_table_equals_the_formula() {
        let mut random = Random::new(1);
        let special = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 0.0, -0.0, 1.0, f32::MAX, f32::MIN_POSITIVE, 1e-45];
        for (tone, top) in tones().iter().flat_map(|t| [(t, 255), (t, 65_535)]) {
            let quantizer = Quantizer::new(tone, top);
            let any_bits = (0..5_000).map(|_| f32::from_bits(random.bits())).collect::<Vec<_>>();
            let usual = (0..5_000).map(|_| random.range(-0.1, 1.2)).collect::<Vec<_>>();
            for x in special.into_iter().chain(any_bits).chain(usual) {
                assert_eq!(gray(&quantizer, x), formula(tone, x, top), "{tone:?} {top} {x:e}");
            }
        }
    }

    #[test]
    fn the_table_equals_the_formula_where_channels_are_crossed_too() {
        let mut random = Random::new(2);
        let balanced = Tone { white_balance: Some(WhiteBalance::default()), ..Tone::default() };
        let wide = Tone { primaries: Primaries::Rec2020, ..Tone::new(AnyCurve::Agx(Agx::default())) };
        for tone in [balanced, wide, Tone::new(AnyCurve::Reinhard(Reinhard::default()))] {
            let quantizer = Quantizer::new(&tone, 65_535);
            for _ in 0..2_000 {
                let pixel = random.rgb() * random.range(-0.1, 3.0);
                assert_eq!(quantizer.levels(pixel), tone.levels(pixel, 65_535), "{tone:?} {pixel:?}");
            }
        }
    }

    #[test]
    fn levels_change_exactly_at_their_thresholds() {
        for tone in tones().iter().filter(|t| t.exposure_stops == 0.0) {
            let quantizer = Quantizer::new(tone, 255);
            for &t in &quantizer.thresholds {
                for x in [t.next_down(), t, t.next_up()] {
                    assert_eq!(gray(&quantizer, x), formula(tone, x, 255), "{tone:?} {x:e}");
                }
            }
        }
    }

    #[test]
    fn every_level_of_both_depths_is_reached_from_its_own_decoded_value() {
        for top in [255u16, 65_535] {
            let quantizer = Quantizer::new(&Tone::default(), top);
            let curve = AnyCurve::default();
            for k in 0..=top {
                let linear = curve.channel_curve().decode(f64::from(k) / f64::from(top)) as f32;
                assert_eq!(gray(&quantizer, linear), k);
            }
        }
    }

    #[test]
    fn absurd_gammas_do_not_hang() {
        for gamma in [1e-30, 1e30, -1.0, 0.0, f64::NAN] {
            let quantizer = Quantizer::new(&Tone::new(AnyCurve::Gamma(Gamma { gamma })), 255);
            assert_eq!(gray(&quantizer, f32::NAN), 0);
        }
    }
}
