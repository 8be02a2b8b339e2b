//! `juggler probe`: explains a pixel, or finds fireflies.

mod fireflies;

use crate::args::ViewArgs;
use crate::console;
use crate::failure::Failure;
use crate::model_args::ModelArgs;
use crate::output::{self, STANDARD_OUTPUT};
use crate::plan::{effect, end_warning};
use crate::source;
use crate::value;
use clap::Args;
use juggler::probe::{Detail, Prober};
use juggler::render::Control;
use juggler::{Picture, Settings};
use rayon::ThreadPoolBuilder;
use serde::Serialize;
use serde_json::{Value, json};

/// Text after the help.
pub const EXAMPLES: &str = "\
Examples:
  juggler probe scene.json 320,180                  the pixel in column 320, row 180, as `juggler render` makes it
  juggler probe scene.json 320,180 --samples 1024 --branches 10 --tree-depth 8
  juggler probe scene.json --fireflies 20           the 20 brightest fireflies and their paths
  juggler probe scene.json 320,180 --stats -        the report as JSON

Exit status: 0 done, 2 the command line or the scene is wrong, 3 a file or the system failed.";

/// Flags of `juggler probe`.
#[derive(Debug, Args)]
pub struct Probe {
    /// Scene file, built-in scene (see `juggler scenes`), or `-` for standard input
    scene: String,

    /// Pixel: column and row, from 0 at the top left
    #[arg(value_name = "X,Y", value_parser = value::pixel, required_unless_present = "fireflies", conflicts_with = "fireflies")]
    pixel: Option<[u32; 2]>,

    /// Render the picture and report the N worst fireflies [default: 10]
    ///
    /// Fireflies are pixels that stand out from their neighborhood by chance.
    #[arg(long, value_name = "N", num_args = 0..=1, default_missing_value = "10", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    fireflies: Option<u32>,

    /// Number of samples to list, the brightest first
    #[arg(long, value_name = "N", default_value = "5", conflicts_with = "fireflies", value_parser = clap::value_parser!(u32).range(0..=10_000))]
    brightest: u32,

    /// Depth of the tree of paths, in vertices
    #[arg(long, value_name = "N", default_value = "5", conflicts_with = "fireflies", value_parser = clap::value_parser!(u32).range(0..=64))]
    tree_depth: u32,

    /// Branches per vertex in the tree of paths; smaller ones are summed
    #[arg(long, value_name = "N", default_value = "5", conflicts_with = "fireflies", value_parser = clap::value_parser!(u32).range(0..=10_000))]
    branches: u32,

    /// Write the results as JSON; `-` is standard output
    #[arg(long, value_name = "FILE")]
    stats: Option<String>,

    /// Number of rendering threads for --fireflies [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,

    #[command(flatten)]
    model: ModelArgs,

    #[command(flatten)]
    view: ViewArgs,
}

impl Probe {
    /// Probes the pixel, or finds the fireflies of the picture, and prints the report.
    pub fn run(self) -> Result<(), Failure> {
        let model = self.model.clone().for_view(self.view.size, self.view.camera.as_deref())?;
        let scene = source::load_model(&self.scene, &model, None)?;
        let frame = self.view.frame(scene.description.animation.frames_per_second);
        let beyond = self.view.frame.and_then(|frame| end_warning(frame, scene.description.animation.frames));
        beyond.iter().for_each(|warning| console::print_message(warning));
        let scene = if frame == 0.0 { scene } else { scene.at_frame(frame)? };
        let settings: Settings = self.view.settings()?;
        effect::check_scene(&settings, &scene)?;
        self.model.stage.check_floor(settings.transparent_of(&scene))?;
        // Apply the shutter first, since it decides what moves.
        let scene = settings.apply(&scene)?;
        let pool = ThreadPoolBuilder::new().num_threads(self.threads.map_or(0, usize::from)).build();
        let pool = pool.map_err(|error| Failure::System(format!("cannot start threads: {error}")))?;
        pool.install(|| {
            let picture = Picture::new(&scene, &settings)?;
            let warnings = &picture.compiled().warnings;
            if !warnings.list().is_empty() {
                console::print_message(&warnings.render(console::color()));
            }
            let prober = Prober::new(&scene, picture);
            match (self.pixel, self.fireflies) {
                (Some(pixel), _) => self.pixel(&prober, pixel),
                (None, count) => self.fireflies(&prober, count.unwrap_or_default() as usize),
            }
        })
    }

    fn pixel(&self, prober: &Prober, pixel: [u32; 2]) -> Result<(), Failure> {
        let detail =
            Detail { depth: self.tree_depth, branches: self.branches as usize, brightest: self.brightest as usize };
        let probe = prober.probe_pixel(pixel, &detail, &Control::default())?;
        self.tell(&probe, || probe.to_string())
    }

    fn fireflies(&self, prober: &Prober, count: usize) -> Result<(), Failure> {
        let fireflies = prober.find_fireflies(count, &Control::default())?;
        self.tell(&fireflies, || fireflies::to_words(&fireflies))
    }

    /// Writes JSON, and prints text unless JSON goes to standard output.
    fn tell(&self, reported: &impl Serialize, words: impl FnOnce() -> String) -> Result<(), Failure> {
        if let Some(file) = &self.stats {
            output::write_text(file, &to_json(&self.scene, reported))?;
        }
        if self.stats.as_deref() == Some(STANDARD_OUTPUT) {
            return Ok(());
        }
        console::print_result(&words())
    }
}

/// Results as JSON; numbers that JSON cannot represent are null.
fn to_json(scene: &str, reported: &impl Serialize) -> String {
    let mut object = json!({"version": 1, "scene": scene});
    if let (Some(object), Ok(Value::Object(more))) = (object.as_object_mut(), serde_json::to_value(reported)) {
        object.extend(more);
    }
    object.to_string()
}
