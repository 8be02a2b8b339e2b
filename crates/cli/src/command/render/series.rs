//! Several scenes, one after the other. A scene that fails does not stop the others.

use super::frame::RenderCommand;
use crate::console;
use crate::failure::Failure;
use crate::format::{counted, duration};
use crate::interrupt::Interrupts;
use crate::plan::Plan;
use std::fmt::Write;
use std::time::Instant;

/// Maximum number of failed scenes that the summary names.
const MAX_NAMED: usize = 10;

/// Numbers of scenes by their results.
#[derive(Debug, Default)]
struct Results {
    rendered: usize,
    /// Scenes whose pictures exist already.
    kept: usize,
    /// Names of failed scenes.
    failed: Vec<String>,
    /// Exit status of the first failed scene.
    status: u8,
}

/// Renders the scenes and prints a summary.
///
/// # Errors
///
/// [`Failure::Several`] if a scene failed, whose error is printed; [`Failure::Interrupted`] after a
/// signal, which ends all.
pub fn run(plans: Vec<Plan>, folder: Option<&str>) -> Result<(), Failure> {
    let (start, count) = (Instant::now(), plans.len());
    if let Some(folder) = folder {
        std::fs::create_dir_all(folder).map_err(|error| Failure::file("create", folder, &error))?;
    }
    let (mut results, mut interrupts) = (Results::default(), None);
    let is_quiet = plans.first().is_some_and(|plan| plan.quiet);
    for plan in plans {
        let scene = plan.scene.clone();
        let command = RenderCommand { reporter: plan.progress.reporter(), plan };
        let result = command.run(Instant::now(), &mut interrupts);
        if let Some(failure) = interrupts.as_ref().and_then(Interrupts::caught) {
            return Err(result.err().unwrap_or(failure));
        }
        results.add(scene, result);
    }
    if !is_quiet {
        console::print_result(&format!(
            "{}: {}, {}",
            counted(count as u128, "scene"),
            results.text(),
            duration(start.elapsed())
        ))?;
    }
    if results.failed.is_empty() { Ok(()) } else { Err(Failure::Several(results.status)) }
}

impl Results {
    /// Counts the result of a scene, `Ok(true)` if it was rendered, and prints its error.
    fn add(&mut self, scene: String, result: Result<bool, Failure>) {
        match result {
            Ok(true) => self.rendered += 1,
            Ok(false) => self.kept += 1,
            Err(failure) => {
                if let Some(message) = failure.message(console::color()) {
                    console::print_message(&message);
                }
                if self.failed.is_empty() {
                    self.status = failure.status();
                }
                self.failed.push(scene);
            }
        }
    }

    /// `3 rendered, 2 kept, 1 failed (bad.json)`.
    fn text(&self) -> String {
        let mut text = format!("{} rendered", self.rendered);
        if self.kept > 0 {
            let _ = write!(text, ", {} kept", self.kept);
        }
        if !self.failed.is_empty() {
            let named = self.failed.iter().take(MAX_NAMED).cloned().collect::<Vec<_>>().join(", ");
            let more = if self.failed.len() > MAX_NAMED { ", ..." } else { "" };
            let _ = write!(text, ", {} failed ({named}{more})", self.failed.len());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summary_counts_scenes_by_their_results() {
        let mut results = Results::default();
        results.add("a".into(), Ok(true));
        assert_eq!(results.text(), "1 rendered");
        results.add("b".into(), Ok(false));
        results.add("c".into(), Err(Failure::Several(3)));
        results.add("d".into(), Err(Failure::Several(2)));
        assert_eq!((results.text().as_str(), results.status), ("1 rendered, 1 kept, 2 failed (c, d)", 3));
        (0..9).for_each(|_| results.add("e".into(), Err(Failure::Negative)));
        assert!(results.text().ends_with("11 failed (c, d, e, e, e, e, e, e, e, e, ...)"));
    }
}
