//! Adaptive resolution: chooses the pixel block size of a frame from the measured render speed.

/// Edge lengths of the pixel blocks that a coarse frame may use, in pixels.
const STEPS: [u32; 14] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128];
/// Edge lengths of the blocks in the passes of increasing resolution that precede sampling.
const PASSES: [u32; 4] = [8, 4, 2, 1];
/// Number of pixels of the first frame, before any speed is measured.
const INITIAL_PIXELS: f64 = 1500.0;
/// Fraction of the time budget that the estimate may use.
const BUDGET_FRACTION: f64 = 0.75;
/// Weight of the newest measurement if it is faster than the estimate; a slower one replaces it.
const GAIN_WEIGHT: f64 = 0.4;

/// Running estimate of the render speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RenderRate {
    /// Pixels per second; `None` before the first measurement.
    rate: Option<f64>,
}

impl RenderRate {
    /// Updates the estimate: `pixels` were rendered in `seconds`. Values that are not positive are
    /// ignored.
    pub fn measure(&mut self, pixels: f64, seconds: f64) {
        if !(pixels > 0.0 && seconds > 0.0) {
            return;
        }
        let new = pixels / seconds;
        self.rate = Some(self.rate.map_or(new, |old| if new < old { new } else { old + (new - old) * GAIN_WEIGHT }));
    }

    /// Discards the estimate.
    pub fn forget(&mut self) {
        self.rate = None;
    }

    /// Returns the block edge length, in pixels, with which an image of `size` is expected to
    /// render within `budget` seconds.
    pub fn coarseness(&self, size: [u32; 2], budget: f64) -> u32 {
        let most = self.rate.map_or(INITIAL_PIXELS, |rate| rate * budget * BUDGET_FRACTION);
        let area = |step: u32| coarse_size(size, step).map(f64::from).iter().product::<f64>();
        STEPS.into_iter().find(|step| area(*step) <= most).unwrap_or(STEPS[STEPS.len() - 1])
    }
}

/// Returns the block edge length of the next pass of increasing resolution for an image of `size`
/// that is displayed in `displayed` pixels, or `None` at full resolution.
pub fn next_pass(displayed: [u32; 2], size: [u32; 2]) -> Option<u32> {
    let edge = |axis: usize| size[axis].div_ceil(displayed[axis].max(1));
    PASSES.into_iter().find(|step| *step < edge(0).max(edge(1)))
}

/// Returns the size of a coarse frame: width and height in blocks.
pub fn coarse_size(size: [u32; 2], coarseness: u32) -> [u32; 2] {
    size.map(|edge| edge.div_ceil(coarseness.max(1)).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [640, 480];

    #[test]
    fn coarseness_is_the_least_that_fits_the_frame_time() {
        let mut rate = RenderRate::default();
        assert_eq!(rate.coarseness(SIZE, 0.03), 16, "nothing is known: 40 x 30");
        rate.measure(307_200.0, 0.02);
        assert_eq!(rate.coarseness(SIZE, 0.03), 1);
        rate.measure(307_200.0, 0.08);
        // 86,400 pixels fit into the planned 22.5 ms; 320 x 240 are 76,800.
        assert_eq!(rate.coarseness(SIZE, 0.03), 2);
        rate.measure(100.0, 10.0);
        assert_eq!(rate.coarseness(SIZE, 0.03), 128, "never nothing");
        rate.forget();
        assert_eq!(rate, RenderRate::default());
    }

    #[test]
    fn render_rate_falls_at_once_and_rises_gradually() {
        let mut rate = RenderRate::default();
        rate.measure(1000.0, 1.0);
        rate.measure(2000.0, 1.0);
        assert_eq!(rate.rate, Some(1400.0));
        rate.measure(100.0, 1.0);
        assert_eq!(rate.rate, Some(100.0));
        rate.measure(0.0, 1.0);
        rate.measure(10.0, 0.0);
        assert_eq!(rate.rate, Some(100.0), "nothing says nothing");
    }

    #[test]
    fn refinement_passes_end_at_full_resolution() {
        for size in [SIZE, [641, 3], [1, 1], [20, 15], [1, 900]] {
            for first in STEPS {
                let (mut displayed, mut steps) = (coarse_size(size, first), Vec::new());
                while let Some(step) = next_pass(displayed, size) {
                    steps.push(step);
                    displayed = coarse_size(size, step);
                }
                assert_eq!(displayed, size, "from {first}");
                assert!(steps.len() <= 4 && steps.iter().all(|step| *step < first), "{size:?} from {first}: {steps:?}");
            }
        }
        assert_eq!(next_pass(coarse_size(SIZE, 16), SIZE), Some(8));
        assert_eq!(next_pass(coarse_size(SIZE, 3), SIZE), Some(2));
    }

    #[test]
    fn squares_cover_the_picture() {
        assert_eq!(coarse_size([641, 480], 16), [41, 30]);
        assert_eq!(coarse_size([1, 1], 128), [1, 1]);
    }
}
