//! `juggler bench scenes`: the cost of rendering seven scenes, in instructions or in CPU time, of
//! one program or of two programs side by side. Unlike times, counts of instructions are nearly the
//! same in every run, also on a busy machine, so that they show changes of a percent.
//!
//! Each scene is a small crop that `juggler render` renders with one thread in a process of its
//! own.

mod bench_scene;
mod content;
mod files;
mod measure;
mod program;
mod quantity;
mod report;

use crate::console;
use crate::failure::Failure;
use crate::value::one_of;
use bench_scene::{BenchScene, SCENES};
use clap::Args;
use files::TemporaryFolder;
use measure::Bench;
use program::{Program, valgrind_version};
use quantity::Quantity;
use report::Report;

/// Flags of `juggler bench scenes`.
#[derive(Debug, Args)]
#[command(after_help = all_scenes())]
pub struct Scenes {
    /// Scenes to render [default: all]
    #[arg(value_name = "SCENE", value_parser = one_of(SCENES.each_ref(), |scene: &BenchScene| scene.name))]
    scenes: Vec<&'static BenchScene>,
    /// Quantity to measure [default: instructions if valgrind is installed, or else cpu-time]
    #[arg(long, value_name = "QUANTITY", value_parser = one_of(Quantity::ALL, Quantity::name))]
    measure: Option<Quantity>,
    /// Program to measure [default: this program]
    #[arg(long, value_name = "PROGRAM")]
    program: Option<String>,
    /// Second program to compare with, such as an older version
    #[arg(long, value_name = "PROGRAM")]
    beside: Option<String>,
    /// Number of measurements of CPU time; the median is reported
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    repeats: u32,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

fn all_scenes() -> String {
    let lines = SCENES.each_ref().map(|scene| format!("  {:16} {}", scene.name, scene.about));
    format!("Scenes, identical on every machine:\n{}", lines.join("\n"))
}

impl Scenes {
    /// Measures scene by scene and reports the results.
    pub fn run(self) -> Result<(), Failure> {
        let valgrind = valgrind_version();
        let quantity = match (self.measure, &valgrind) {
            (Some(Quantity::Instructions), None) => {
                return Err(Failure::System(
                    "valgrind, which counts instructions, is not installed; --measure cpu-time needs no other program"
                        .into(),
                ));
            }
            (Some(quantity), _) => quantity,
            (None, Some(_)) => Quantity::Instructions,
            (None, None) => Quantity::CpuTime,
        };
        let programs = self.programs()?;
        let folder = TemporaryFolder::create()?;
        let bench = Bench { programs: &programs, quantity, repeats: self.repeats, folder: folder.path() };
        let scenes = self.scenes().into_iter().map(|scene| bench.measure(scene)).collect::<Result<_, _>>()?;
        let valgrind = valgrind.filter(|_| quantity == Quantity::Instructions);
        let report = Report { quantity, valgrind, programs, scenes };
        console::print_result(&if self.json { report.to_json() } else { report.to_words() })
    }

    /// Scenes to measure: those on the command line, or all for which there are files.
    fn scenes(&self) -> Vec<&'static BenchScene> {
        if !self.scenes.is_empty() {
            return self.scenes.clone();
        }
        let (present, missing): (Vec<_>, Vec<_>) = SCENES.iter().partition(|scene| scene.exists());
        for BenchScene { name, about, .. } in missing {
            console::print_message(&format!("note: the scene `{name}` is left out: {about}"));
        }
        present
    }

    fn programs(&self) -> Result<Vec<Program>, Failure> {
        let own = match &self.program {
            Some(path) => path.clone(),
            None => {
                let path = std::env::current_exe();
                let path = path.map_err(|error| Failure::System(format!("cannot find this program: {error}")))?;
                path.to_string_lossy().into_owned()
            }
        };
        [own].into_iter().chain(self.beside.clone()).map(Program::find).collect()
    }
}
