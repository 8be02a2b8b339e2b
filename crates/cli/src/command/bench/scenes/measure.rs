//! Measurements of a scene with one program or with two in turns.

use super::bench_scene::{BenchScene, CROP};
use super::program::{Job, Program, Render};
use super::quantity::Quantity;
use crate::failure::Failure;
use juggler_raybench::measure::median;
use std::path::Path;

/// Results for a scene.
pub struct SceneReport {
    pub scene: &'static str,
    /// Number of samples of all pixels that belong to the costs.
    pub samples: u64,
    /// Result of each program; of CPU times, the last render with the median of the times.
    pub results: Vec<Render>,
    /// Cost of the first program divided by that of the second; of CPU times, the median of the
    /// ratios of all pairs.
    pub ratio: Option<f64>,
}

/// A measurement of some programs.
pub struct Bench<'b> {
    pub programs: &'b [Program],
    pub quantity: Quantity,
    /// Number of measurements of CPU time.
    pub repeats: u32,
    pub folder: &'b Path,
}

impl Bench<'_> {
    /// Measures all programs in turns. Every second turn is in reverse order, so that a drift of
    /// the machine affects all alike.
    pub fn measure(&self, scene: &'static BenchScene) -> Result<SceneReport, Failure> {
        let file = scene.prepare(self.folder)?;
        let mut turns: Vec<Vec<Render>> = self.programs.iter().map(|_| Vec::new()).collect();
        let repeats = if self.quantity == Quantity::CpuTime { self.repeats } else { 1 };
        for turn in 0..repeats {
            let mut pairs: Vec<_> = self.programs.iter().zip(&mut turns).collect();
            if !turn.is_multiple_of(2) {
                pairs.reverse();
            }
            for (program, renders) in pairs {
                renders.push(self.render(program, &file, &scene.flags())?);
            }
        }
        let samples = self.quantity.samples() - self.quantity.subtracted_samples();
        Ok(SceneReport::new(scene.name, u64::from(CROP * CROP) * u64::from(samples), turns))
    }

    /// Renders a scene. The cost and the number of rays are those of the samples that count.
    fn render(&self, program: &Program, scene: &Path, flags: &[String]) -> Result<Render, Failure> {
        let render = |samples: u32| {
            let output = self.folder.join(format!("{samples}.pfm"));
            program.render(&Job { scene, flags, samples, output: &output }, self.quantity)
        };
        let (samples, subtracted) = (self.quantity.samples(), self.quantity.subtracted_samples());
        if subtracted == 0 {
            return render(samples);
        }
        // Counts of instructions do not depend on what runs at the same time.
        let (whole, part) = rayon::join(|| render(samples), || render(subtracted));
        let (mut whole, part) = (whole?, part?);
        whole.cost -= part.cost;
        whole.rays = whole.rays.saturating_sub(part.rays);
        Ok(whole)
    }
}

impl SceneReport {
    /// Report on the renders of all programs, turn by turn.
    fn new(scene: &'static str, samples: u64, turns: Vec<Vec<Render>>) -> Self {
        let ratio = match turns.as_slice() {
            [first, second] => Some(median(first.iter().zip(second).map(|(own, other)| own.cost / other.cost))),
            _ => None,
        };
        let results = turns.into_iter().filter_map(|renders| {
            let cost = median(renders.iter().map(|render| render.cost));
            Some(Render { cost, ..renders.into_iter().last()? })
        });
        Self { scene, samples, results: results.collect(), ratio }
    }

    /// Whether all programs gave the same picture.
    pub fn is_same_picture(&self) -> bool {
        self.results.windows(2).all(|pair| matches!(pair, [first, second] if first.hash == second.hash))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::bench::scenes::program::Build;

    fn render(cost: f64, hash: &str) -> Render {
        Render { cost, rays: 8, hash: hash.into(), build: Build::default() }
    }

    #[test]
    fn ratio_is_the_median_of_the_pairs() {
        let turns = vec![
            vec![render(1.0, "a"), render(3.0, "a"), render(20.0, "a")],
            vec![render(2.0, "a"), render(4.0, "a"), render(10.0, "a")],
        ];
        let report = SceneReport::new("cornell", 1024, turns);
        assert_eq!(report.ratio, Some(0.75));
        assert!(report.is_same_picture());
        let costs: Vec<f64> = report.results.iter().map(|render| render.cost).collect();
        assert_eq!(costs, [3.0, 4.0]);
    }

    #[test]
    fn one_program_has_no_ratio_and_other_pictures_are_noticed() {
        let alone = SceneReport::new("cornell", 1024, vec![vec![render(1.0, "a")]]);
        assert!(alone.ratio.is_none() && alone.is_same_picture());
        let differing = SceneReport::new("cornell", 1024, vec![vec![render(1.0, "a")], vec![render(1.0, "b")]]);
        assert!(!differing.is_same_picture());
    }
}
