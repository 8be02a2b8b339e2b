//! How coarse a frame must be to be ready in time, from how long the last ones took.

/// Edges of the squares that stand for one pixel.
const STEPS: [u32; 14] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128];
/// Edges of the squares of the passes over the whole picture that come before its samples.
const PASSES: [u32; 4] = [8, 4, 2, 1];
/// Pixels of a frame about whose speed nothing is known.
const FIRST: f64 = 1500.0;
/// How much of the budget is planned for.
const PLANNED: f64 = 0.75;
/// How much the newest frame counts when it was faster than thought; a slower one counts fully.
const TRUST: f64 = 0.4;

/// What is known about the speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// Pixels a second, once any were rendered.
    rate: Option<f64>,
}

impl Pace {
    /// Takes in a frame, or what was done of it: so many pixels in so many seconds.
    pub fn learn(&mut self, pixels: f64, seconds: f64) {
        if !(pixels > 0.0 && seconds > 0.0) {
            return;
        }
        let new = pixels / seconds;
        self.rate = Some(self.rate.map_or(new, |old| if new < old { new } else { old + (new - old) * TRUST }));
    }

    /// Nothing is known any more.
    pub fn forget(&mut self) {
        self.rate = None;
    }

    /// The squares' edge for a picture of this size that is to be ready in `budget` seconds.
    pub fn coarseness(&self, size: [u32; 2], budget: f64) -> u32 {
        let most = self.rate.map_or(FIRST, |rate| rate * budget * PLANNED);
        let area = |step: u32| coarse_size(size, step).map(f64::from).iter().product::<f64>();
        STEPS.into_iter().find(|step| area(*step) <= most).unwrap_or(STEPS[STEPS.len() - 1])
    }
}

/// Squares of the next finer pass over the whole picture, for one that is shown in `shown` instead of `size` pixels; `None`
/// when all pixels are there.
pub fn finer(shown: [u32; 2], size: [u32; 2]) -> Option<u32> {
    let edge = |axis: usize| size[axis].div_ceil(shown[axis].max(1));
    PASSES.into_iter().find(|step| *step < edge(0).max(edge(1)))
}

/// Width and height in squares.
pub fn coarse_size(size: [u32; 2], coarseness: u32) -> [u32; 2] {
    size.map(|edge| edge.div_ceil(coarseness.max(1)).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [640, 480];

    #[test]
    fn what_fits_is_not_coarse_and_what_does_not_is_just_coarse_enough() {
        let mut pace = Pace::default();
        assert_eq!(pace.coarseness(SIZE, 0.03), 16, "nothing is known: 40 x 30");
        pace.learn(307_200.0, 0.02);
        assert_eq!(pace.coarseness(SIZE, 0.03), 1);
        pace.learn(307_200.0, 0.08);
        // 86,400 pixels in the planned 22.5 ms: 320 x 240 are 76,800.
        assert_eq!(pace.coarseness(SIZE, 0.03), 2);
        pace.learn(100.0, 10.0);
        assert_eq!(pace.coarseness(SIZE, 0.03), 128, "never nothing");
        pace.forget();
        assert_eq!(pace, Pace::default());
    }

    #[test]
    fn slowness_counts_at_once_and_speed_bit_by_bit() {
        let mut pace = Pace::default();
        pace.learn(1000.0, 1.0);
        pace.learn(2000.0, 1.0);
        assert_eq!(pace.rate, Some(1400.0));
        pace.learn(100.0, 1.0);
        assert_eq!(pace.rate, Some(100.0));
        pace.learn(0.0, 1.0);
        pace.learn(10.0, 0.0);
        assert_eq!(pace.rate, Some(100.0), "nothing says nothing");
    }

    #[test]
    fn passes_lead_from_any_coarseness_to_all_pixels() {
        for size in [SIZE, [641, 3], [1, 1], [20, 15], [1, 900]] {
            for first in STEPS {
                let (mut shown, mut steps) = (coarse_size(size, first), Vec::new());
                while let Some(step) = finer(shown, size) {
                    steps.push(step);
                    shown = coarse_size(size, step);
                }
                assert_eq!(shown, size, "from {first}");
                assert!(steps.len() <= 4 && steps.iter().all(|step| *step < first), "{size:?} from {first}: {steps:?}");
            }
        }
        assert_eq!(finer(coarse_size(SIZE, 16), SIZE), Some(8));
        assert_eq!(finer(coarse_size(SIZE, 3), SIZE), Some(2));
    }

    #[test]
    fn squares_cover_the_picture() {
        assert_eq!(coarse_size([641, 480], 16), [41, 30]);
        assert_eq!(coarse_size([1, 1], 128), [1, 1]);
    }
}
