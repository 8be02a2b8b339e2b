//! Clamping of contributions (firefly removal), with an account of the energy that it removes.

use juggler_math::Rgb;

/// Limits of one contribution's brightest channel, in units of radiance; infinite for no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clamp {
    /// Limit of emission and direct lighting: paths of one or two segments.
    pub direct: f32,
    /// Limit of indirect lighting: paths of three or more segments.
    pub indirect: f32,
}

/// Number of path segments between camera and light, by which the limit is chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathKind {
    /// One segment, emission that the camera sees: [`Clamp::direct`].
    Emission,
    /// Two segments, direct lighting: [`Clamp::direct`].
    Direct,
    /// Three or more segments, indirect lighting: [`Clamp::indirect`].
    Indirect,
}

impl PathKind {
    /// Classifies a path by its number of segments.
    #[inline]
    pub fn from_segments(segments: u32) -> Self {
        match segments {
            0 | 1 => Self::Emission,
            2 => Self::Direct,
            _ => Self::Indirect,
        }
    }
}

/// Limits applied to the samples of a pass.
#[derive(Clone, Debug)]
pub struct ClampState {
    limits: Clamp,
    /// Absolute filter weight of each sample, since limits apply to radiance before filtering.
    weights: Vec<f32>,
    /// Energy removed from each sample: the sum of channel means.
    pub removed: Vec<f32>,
}

impl ClampState {
    /// Creates clamping by `limits`, without samples.
    pub fn new(limits: Clamp) -> Self {
        Self { limits, weights: Vec::new(), removed: Vec::new() }
    }

    /// Starts samples with these filter weights.
    pub fn begin(&mut self, weights: impl Iterator<Item = f32>) {
        self.weights.clear();
        self.weights.extend(weights.map(f32::abs));
        self.removed.clear();
        self.removed.resize(self.weights.len(), 0.0);
    }

    /// Clamps a contribution and records the difference by its `weight` in the sample. Contributions
    /// that are not finite are returned unchanged, to be reported.
    #[inline]
    pub fn limit(&mut self, slot: usize, path_kind: PathKind, radiance: Rgb, weight: f32) -> Rgb {
        let limit = match path_kind {
            PathKind::Emission | PathKind::Direct => self.limits.direct,
            PathKind::Indirect => self.limits.indirect,
        };
        let max = limit * self.weights[slot];
        let brightest = radiance.map(f32::abs).max_channel();
        if brightest <= max || !brightest.is_finite() || max.is_nan() {
            return radiance;
        }
        let kept = radiance * (max / brightest);
        let Rgb { r, g, b } = radiance - kept;
        self.removed[slot] += (r + g + b) / 3.0 * weight;
        kept
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn clamping() -> ClampState {
        let mut clamping = ClampState::new(Clamp { direct: 8.0, indirect: 2.0 });
        clamping.begin([1.0, 0.5, -0.5].into_iter());
        clamping
    }

    #[test]
    fn clamping_keeps_hue_and_records_the_removed_radiance() {
        let bright = Rgb::new(1.0, 4.0, 6.0);
        for (slot, path_kind, weight, limit) in [
            (0, PathKind::Direct, 1.0, 6.0),
            (0, PathKind::Indirect, 1.0, 2.0),
            (1, PathKind::Indirect, 0.5, 2.0),
            (2, PathKind::Indirect, -0.5, 2.0),
        ] {
            let mut clamping = clamping();
            let kept = clamping.limit(slot, path_kind, bright * weight, 1.0);
            let expected = bright * (limit / 6.0 * weight);
            assert!((kept - expected).map(f32::abs).max_channel() < 1e-6, "{kept:?} instead of {expected:?}");
            let removed = (11.0 - 11.0 * limit / 6.0) / 3.0 * weight;
            assert!((clamping.removed[slot] - removed).abs() < 1e-6, "{} instead of {removed}", clamping.removed[slot]);
        }
    }

    #[test]
    fn contributions_that_are_not_finite_are_kept() {
        let mut clamping = clamping();
        assert!(!clamping.limit(0, PathKind::Direct, Rgb::new(f32::INFINITY, 1.0, 1.0), 1.0).is_finite());
        assert!(!clamping.limit(0, PathKind::Direct, Rgb::new(f32::NAN, 1.0, 1.0), 1.0).is_finite());
        assert_eq!(clamping.limit(0, PathKind::Direct, Rgb::splat(8.0), 1.0), Rgb::splat(8.0));
        assert_eq!(clamping.removed, [0.0; 3]);
    }
}
