//! Clamping: contributions that are too bright are dimmed, and what that takes away is counted.

use juggler_math::Rgb;

/// The most that one contribution of a path may bring to a sample, by its brightest channel; infinite for no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clamp {
    /// Of light that the camera sees, and that lights send straight to what it sees: paths of up to two stretches.
    pub direct: f32,
    /// Of light that comes by longer ways.
    pub indirect: f32,
}

/// How far light has come, and so which of the two limits holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// What the camera sees shine: [`Clamp::direct`].
    Seen,
    /// What lights light: [`Clamp::direct`].
    Direct,
    /// By longer ways: [`Clamp::indirect`].
    Indirect,
}

impl Way {
    /// Of a path of so many stretches from the camera to the light.
    #[inline]
    pub fn of(stretches: u32) -> Self {
        match stretches {
            0 | 1 => Self::Seen,
            2 => Self::Direct,
            _ => Self::Indirect,
        }
    }
}

/// The limits at work on some samples.
#[derive(Debug)]
pub struct Clamping {
    limits: Clamp,
    /// What the filter makes of each sample: limits are those of radiance as it comes in.
    weights: Vec<f32>,
    /// What was taken off each sample: the means of the channels, summed.
    pub taken: Vec<f32>,
}

impl Clamping {
    /// Creates clamping by `limits`, without samples.
    pub fn new(limits: Clamp) -> Self {
        Self { limits, weights: Vec::new(), taken: Vec::new() }
    }

    /// For samples of these weights in the filter.
    pub fn begin(&mut self, weights: impl Iterator<Item = f32>) {
        self.weights.clear();
        self.weights.extend(weights.map(f32::abs));
        self.taken.clear();
        self.taken.resize(self.weights.len(), 0.0);
    }

    /// What is left of a contribution to a sample. What is no finite number stays that, and is told as such.
    #[inline]
    pub fn limit(&mut self, slot: usize, way: Way, radiance: Rgb) -> Rgb {
        let limit = match way {
            Way::Seen | Way::Direct => self.limits.direct,
            Way::Indirect => self.limits.indirect,
        };
        let most = limit * self.weights[slot];
        let brightest = radiance.map(f32::abs).max_channel();
        if brightest <= most || !brightest.is_finite() || most.is_nan() {
            return radiance;
        }
        let kept = radiance * (most / brightest);
        let Rgb { r, g, b } = radiance - kept;
        self.taken[slot] += (r + g + b) / 3.0;
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clamping() -> Clamping {
        let mut clamping = Clamping::new(Clamp { direct: 8.0, indirect: 2.0 });
        clamping.begin([1.0, 0.5, -0.5].into_iter());
        clamping
    }

    #[test]
    fn hue_stays_and_nothing_is_lost_from_sight() {
        let bright = Rgb::new(1.0, 4.0, 6.0);
        for (slot, way, weight, limit) in [
            (0, Way::Direct, 1.0, 6.0),
            (0, Way::Indirect, 1.0, 2.0),
            (1, Way::Indirect, 0.5, 2.0),
            (2, Way::Indirect, -0.5, 2.0),
        ] {
            let mut clamping = clamping();
            let kept = clamping.limit(slot, way, bright * weight);
            let expected = bright * (limit / 6.0 * weight);
            assert!((kept - expected).map(f32::abs).max_channel() < 1e-6, "{kept:?} instead of {expected:?}");
            let taken = (11.0 - 11.0 * limit / 6.0) / 3.0 * weight;
            assert!((clamping.taken[slot] - taken).abs() < 1e-6, "{} instead of {taken}", clamping.taken[slot]);
        }
    }

    #[test]
    fn what_is_no_number_is_left_to_be_told_as_such() {
        let mut clamping = clamping();
        assert!(!clamping.limit(0, Way::Direct, Rgb::new(f32::INFINITY, 1.0, 1.0)).is_finite());
        assert!(!clamping.limit(0, Way::Direct, Rgb::new(f32::NAN, 1.0, 1.0)).is_finite());
        assert_eq!(clamping.limit(0, Way::Direct, Rgb::splat(8.0)), Rgb::splat(8.0));
        assert_eq!(clamping.taken, [0.0; 3]);
    }
}
