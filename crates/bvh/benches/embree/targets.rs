//! Geometric means of speed ratios over all scenes, one per target.

/// Ratios per target, in the order in which the targets first occurred.
#[derive(Default)]
pub struct Targets {
    ratios: Vec<(String, Vec<f64>)>,
}

impl Targets {
    /// Adds a ratio; ignores values that are not positive and finite.
    pub fn add(&mut self, target: &str, ratio: f64) {
        if !ratio.is_finite() || ratio <= 0.0 {
            return;
        }
        match self.ratios.iter_mut().find(|(name, _)| name == target) {
            Some((_, ratios)) => ratios.push(ratio),
            None => self.ratios.push((target.to_owned(), vec![ratio])),
        }
    }

    /// Prints mean, minimum and number of ratios.
    pub fn print(&self) {
        println!("\n{:<68}{:>8}{:>8}{:>6}", "geometric means", "mean", "least", "of");
        for (name, ratios) in &self.ratios {
            let mean = (ratios.iter().map(|ratio| ratio.ln()).sum::<f64>() / ratios.len() as f64).exp();
            let least = ratios.iter().copied().fold(f64::INFINITY, f64::min);
            println!("{name:<68}{mean:>8.2}{least:>8.2}{:>6}", ratios.len());
        }
    }
}
