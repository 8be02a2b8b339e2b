//! The command in a picture's metadata: it reproduces the picture, and omits flags that cannot
//! change it (output, threads, progress), so that equal pictures are equal files.

use crate::model_args::ModelArgs;
use crate::plan::{FrameOutput, Plan, TimeSelection};
use juggler::camera::film::Rect;
use juggler::imaging::{DisplayLook, Options, Primaries, SampleDepth, WhiteBalance};
use juggler::math::NamedKind;
use juggler::{Aov, Denoiser, Limit, Settings};
use std::fmt::Display;

/// Placeholder in a command for the file that contains the command.
const THIS_FILE: &str = "{this file}";

/// Shortest command line that reproduces the picture.
pub fn command(plan: &Plan, frame_output: &FrameOutput) -> String {
    // No flag sets a sampler.
    let Settings {
        size,
        samples,
        limit,
        integrator,
        sampler: _,
        max_depth,
        camera,
        shutter,
        seed,
        crop,
        transparent,
        aovs: _,
        denoiser: _,
        curve: _,
        exposure_stops: _,
        white_balance: _,
        primaries: _,
        dither: _,
    } = &plan.settings;
    let mut words = CommandLine(format!("juggler render {}", quoted(&plan.scene)));
    words.model(&plan.model);
    words.flag("--size", size.map(|[width, height]| format!("{width}x{height}")));
    match limit {
        Limit::Time { .. } => words.flag("--samples-from", Some(THIS_FILE)),
        Limit::Samples | Limit::Noise(_) => words.flag("--samples", *samples),
    }
    words.flag("--noise", if let Limit::Noise(level) = limit { Some(level) } else { None });
    words.flag("--integrator", integrator.map(NamedKind::name));
    words.flag("--max-depth", *max_depth);
    words.flag("--camera", camera.as_deref().map(quoted));
    words.time(&plan.times, frame_output.frame);
    words.flag("--shutter", shutter.map(|[open, close]| format!("{open}..{close}")));
    words.flag("--crop", crop.map(|Rect { x, y, width, height }| format!("{x},{y},{width},{height}")));
    words.flag("--seed", *seed);
    words.switch("--transparent", *transparent == Some(true));
    words.tone(&plan.settings);
    words.layers(&plan.settings);
    words.encoding(plan.options());
    words.0
}

fn list(aovs: &[Aov]) -> String {
    let names: Vec<&str> = aovs.iter().map(|aov| aov.name()).collect();
    names.join(",")
}

/// Command of a file's metadata, with the file's current name.
pub fn with_file_name(file: &str, command: &str) -> String {
    command.replace(THIS_FILE, &quoted(file))
}

struct CommandLine(String);

impl CommandLine {
    /// Flags that select what a model shows, and how.
    fn model(&mut self, model: &ModelArgs) {
        let chosen =
            [("--variant", &model.variant), ("--animation", &model.animation), ("--model-scene", &model.model_scene)];
        chosen.into_iter().for_each(|(name, value)| self.flag(name, value.as_deref().map(quoted)));
        self.switch("--lenient", model.lenient);
        model.stage.words().into_iter().for_each(|(name, value)| self.flag(name, Some(quoted(&value))));
    }

    /// Time or frame of the picture.
    fn time(&mut self, times: &TimeSelection, frame: f64) {
        match times {
            TimeSelection::At(seconds) => self.flag("--at", Some(seconds)),
            TimeSelection::Frame(_) | TimeSelection::Frames(_) => {
                self.flag("--frame", Some(frame).filter(|frame| *frame != 0.0));
            }
        }
    }

    /// Flags of tone mapping.
    fn tone(&mut self, settings: &Settings) {
        let Settings { curve, exposure_stops, white_balance, primaries, dither, .. } = settings;
        self.flag("--tone", curve.map(NamedKind::name));
        self.flag("--exposure", *exposure_stops);
        let light = white_balance.map(|WhiteBalance { kelvin, tint }| match tint {
            0.0 => kelvin.to_string(),
            tint => format!("{kelvin},{tint}"),
        });
        self.flag("--white-balance", light);
        self.flag("--primaries", primaries.map(Primaries::name));
        self.flag("--dither", dither.map(|dither| if dither { "on" } else { "off" }));
    }

    fn layers(&mut self, settings: &Settings) {
        let Settings { aovs, denoiser, .. } = settings;
        self.flag("--aov", Some(list(aovs)).filter(|_| !aovs.is_empty()));
        self.flag("--denoise", denoiser.map(Denoiser::name));
    }

    fn encoding(&mut self, options: Options) {
        let Options { png_16_bit, jpeg_quality, exr_depth, look, .. } = options;
        self.flag("--look", Some(look.name()).filter(|_| look != DisplayLook::Plain));
        self.flag("--bits", (png_16_bit || exr_depth == SampleDepth::Half).then_some(16));
        self.flag("--quality", Some(jpeg_quality).filter(|quality| *quality != Options::default().jpeg_quality));
    }

    fn switch(&mut self, name: &str, is_given: bool) {
        if is_given {
            self.0.push_str(&format!(" {name}"));
        }
    }

    fn flag(&mut self, name: &str, value: Option<impl Display>) {
        if let Some(value) = value {
            self.0.push_str(&format!(" {name} {value}"));
        }
    }
}

/// Quotes a word for a shell. Line breaks become `?`, since some picture formats cannot store them.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./,:=@+".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    let line: String = word.chars().map(|c| if c.is_control() { '?' } else { c }).collect();
    format!("'{}'", line.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::RenderArgs;

    fn commands(words: &[&str]) -> Vec<String> {
        let plan = Plan::new(RenderArgs::from_words(words.iter().copied()).unwrap()).unwrap();
        plan.frame_outputs(30, 24.0).unwrap().iter().map(|frame_output| command(&plan, frame_output)).collect()
    }

    #[test]
    fn reproducing_command_lists_only_flags_that_affect_the_picture() {
        assert_eq!(commands(&["a", "-o", "b.png", "--threads", "3", "--quiet", "--frame", "0"]), ["juggler render a"]);
        let all = "a.json --size 4x3 --samples 2 --integrator path --max-depth 5 --camera top --crop 1,2,3,4 --seed 7 \
                   --tone gamma --exposure -0.5 --white-balance 3200,-5 --primaries srgb --dither off --look ham --bits 16";
        let words: Vec<&str> = all.split_whitespace().collect();
        assert_eq!(commands(&words), [format!("juggler render {}", words.join(" "))]);
        assert_eq!(commands(&["a", "-o", "b.jpg", "--quality", "7"]), ["juggler render a --quality 7"]);
        assert_eq!(commands(&["a", "--at", "0.5"]), ["juggler render a --at 0.5"]);
        assert_eq!(commands(&["a", "--frames", "0..2"]), ["juggler render a", "juggler render a --frame 1"]);
    }

    #[test]
    fn words_are_quoted_where_a_shell_needs_it() {
        assert_eq!(commands(&["it's a.json"]), [r"juggler render 'it'\''s a.json'"]);
        assert_eq!(
            (quoted("größe/a.json"), quoted(""), quoted("a\nb")),
            ("größe/a.json".into(), "''".into(), "'a?b'".into())
        );
    }
}
