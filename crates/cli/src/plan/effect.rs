//! Checks that every flag and setting has an effect: a flag without effect is an error, a setting
//! of the scene without effect is a warning.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::plan::{Encoding, Movie, OutputKind};
use juggler::Settings;
use juggler::imaging::{AnimationFormat, DisplayLook, ImageFormat, Tone};
use juggler::integrator::AnyIntegrator;
use juggler::scene::Scene;

/// Kind of file that a command writes in the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A picture.
    Picture(Encoding),
    /// A partial render.
    PartialRender,
    /// A movie.
    Movie(AnimationFormat),
}

impl Target {
    /// Target of a render.
    pub fn new(output_kind: OutputKind, movie: Option<&Movie>) -> Self {
        match (output_kind, movie) {
            (_, Some(movie)) => Self::Movie(movie.format),
            (OutputKind::Picture(encoding), None) => Self::Picture(encoding),
            (OutputKind::PartialRender, None) => Self::PartialRender,
        }
    }
}

/// A flag, and whether it was given.
pub type FlagUse = (&'static str, bool);

/// Flags of a render that only some targets support. `several`: the command renders several frames.
pub fn flags(args: &RenderArgs, several: bool) -> [FlagUse; 15] {
    [
        ("--bits", args.bits.is_some()),
        ("--quality", args.quality.is_some()),
        ("--look", args.look.is_some()),
        ("--tone", args.tone.is_some()),
        ("--exposure", args.exposure.is_some()),
        ("--white-balance", args.white_balance.is_some()),
        // `off` is valid for targets without dithering.
        ("--dither on", args.dither == Some(true)),
        ("--fps", args.fps.is_some()),
        ("--plays", args.plays.is_some()),
        ("--frame", args.view.frame.is_some()),
        ("--at", args.view.at.is_some()),
        ("--aov", args.aov.is_some()),
        ("--aov-output", args.aov_output.is_some()),
        // A shard of several frames consists of whole frames.
        ("--shard", args.shard.is_some() && !several),
        ("--sample-range", args.sample_range.is_some()),
    ]
}

/// Fails for the first given flag that the target does not support.
pub fn check(target: Target, given: &[FlagUse]) -> Result<(), Failure> {
    let mut given = given.iter().filter(|(_, is_given)| *is_given);
    match given.find_map(|(flag, _)| unsupported(flag, target)) {
        Some(message) => Err(Failure::Invalid(message)),
        None => Ok(()),
    }
}

/// Reason why the target does not support a flag.
fn unsupported(flag: &str, target: Target) -> Option<String> {
    match target {
        Target::Picture(encoding) => unsupported_by_picture(flag, encoding),
        Target::PartialRender => unsupported_by_partial_render(flag),
        Target::Movie(format) => unsupported_by_movie(flag, format),
    }
}

fn unsupported_by_picture(flag: &str, Encoding { format, options }: Encoding) -> Option<String> {
    let is_dithered = format.is_tone_mapped() && options.look == DisplayLook::Plain && !options.png_16_bit;
    Some(match flag {
        "--quality" if format != ImageFormat::Jpeg => {
            format!("--quality is for JPEG and MP4 files; {format} files have none")
        }
        "--look" if !format.supports_display_looks() => {
            format!("--look is for PNG, JPEG and WebP pictures; a {format} file stores linear radiance")
        }
        "--tone" | "--exposure" | "--white-balance" if !format.is_tone_mapped() => {
            format!("{flag} is for PNG, JPEG and WebP pictures and for movies; {format} files store linear radiance")
        }
        "--dither on" if !is_dithered => {
            format!("{flag} is for 8-bit pictures without a display look; this {format} file is never dithered")
        }
        "--fps" | "--plays" => format!("{flag} is for movies: {}", AnimationFormat::extensions()),
        "--shard" => format!("{}; with --frames, it selects frames", makes_partial_render(flag)),
        "--sample-range" => makes_partial_render(flag),
        _ => return None,
    })
}

fn makes_partial_render(flag: &str) -> String {
    format!("{flag} makes a partial render, for `juggler merge`: give an output with the extension .jfilm")
}

fn unsupported_by_partial_render(flag: &str) -> Option<String> {
    Some(match flag {
        "--bits" | "--look" => format!("{flag} is for pictures; a partial render stores sums of samples"),
        "--quality" => "--quality is for JPEG and MP4 files; a partial render has none".into(),
        "--format" => "--format is for pictures; a partial render has one format".into(),
        "--fps" | "--plays" => format!("{flag} is for movies: {}", AnimationFormat::extensions()),
        "--aov-output" => "--aov-output is for pictures; give it to `juggler merge` instead".into(),
        _ => return None,
    })
}

fn unsupported_by_movie(flag: &str, format: AnimationFormat) -> Option<String> {
    Some(match flag {
        "--bits" | "--frame" | "--at" => format!("{flag} is for pictures; this {format} movie has several frames"),
        "--aov" => "--aov is for pictures, also numbered ones (-o 'frame_####.exr'), not for movies".into(),
        "--dither on" => format!("{flag} is for pictures; frames of a movie are never dithered"),
        "--quality" if !format.has_quality() => {
            format!("--quality is for JPEG and MP4 files; {format} has none")
        }
        "--plays" if !format.stores_play_count() => {
            format!("--plays is for .webp, .apng and .gif; the player decides how often an {format} plays")
        }
        "--sample-range" => makes_partial_render(flag),
        _ => return None,
    })
}

/// Fails for flags that have no effect on the scene with these settings.
pub fn check_scene(settings: &Settings, scene: &Scene) -> Result<(), Failure> {
    let wrong = |message: String| Err(Failure::Invalid(message));
    let (mut render, mut tone) = ((*scene.description.render).clone(), (*scene.description.tone).clone());
    Settings { max_depth: None, ..settings.clone() }.apply_to(&mut render, &mut tone)?;
    let integrator = render.integrator.unwrap_or_else(|| scene.integrator_choice().integrator);
    let follows_paths = matches!(integrator, AnyIntegrator::Classic(_) | AnyIntegrator::Path(_));
    if settings.max_depth.is_some() && !follows_paths {
        let name = integrator.name();
        return wrong(format!(
            "--max-depth is for the integrators `classic` and `path`; `{name}` has no maximum depth"
        ));
    }
    if settings.denoiser.is_some() && render.samples < 2 {
        return wrong("--denoise needs at least 2 samples per pixel to estimate the noise".into());
    }
    Ok(())
}

/// Warning of tone settings that have no effect on the target, if any.
pub fn ignored_tone_warning(target: Target, tone: &Tone) -> Option<String> {
    let Target::Picture(Encoding { format, .. }) = target else { return None };
    let usual = Tone::default();
    let idle = [
        ("curve", tone.curve != usual.curve),
        ("exposure_stops", tone.exposure_stops != usual.exposure_stops),
        ("white_balance", tone.white_balance != usual.white_balance),
    ];
    let names: Vec<String> =
        idle.iter().filter(|(_, is_set)| *is_set).map(|(name, _)| format!("`tone.{name}`")).collect();
    if format.is_tone_mapped() || names.is_empty() {
        return None;
    }
    let have = if names.len() == 1 { "has" } else { "have" };
    Some(format!("warning: {} {have} no effect: {format} files store linear radiance", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Plan;
    use juggler::integrator::IntegratorKind;

    fn refused(line: &str) -> Option<String> {
        match Plan::new(RenderArgs::from_words(line.split(' ')).unwrap()) {
            Ok(_) => None,
            Err(Failure::Invalid(message)) => Some(message),
            Err(other) => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn display_flags_are_rejected_for_scene_referred_formats() {
        for flag in ["--tone agx", "--exposure 1", "--white-balance 3200", "--look ham", "--dither on"] {
            let name = flag.split(' ').next().unwrap();
            for ending in ["exr", "hdr", "pfm"] {
                let message = refused(&format!("a {flag} -o b.{ending}")).unwrap();
                assert!(message.starts_with(name) && message.contains(" file"), "{message}");
            }
            for ending in ["png", "jpg", "webp"] {
                assert_eq!(refused(&format!("a {flag} -o b.{ending}")), None, "{flag} {ending}");
            }
        }
        // The picture merged from a partial render, and frames of a movie, are tone mapped.
        for line in ["a --tone agx -o b.jfilm", "a --exposure 1 -o b.gif", "a --dither off -o b.exr"] {
            assert_eq!(refused(line), None, "{line}");
        }
        assert!(refused("a --dither on --bits 16").is_some() && refused("a --dither on -o b.gif").is_some());
    }

    #[test]
    fn shards_of_a_picture_are_partial_renders() {
        assert!(refused("a --shard 0/2 -o a.png").unwrap().contains(".jfilm"));
        assert!(refused("a --sample-range 0..16 -o a.png").unwrap().contains(".jfilm"));
        assert!(refused("a --sample-range 0..16 -o a.gif").unwrap().contains(".jfilm"));
        assert_eq!(refused("a --shard 0/2 -o a.jfilm"), None);
    }

    #[test]
    fn max_depth_needs_an_integrator_with_depth_and_denoising_two_samples() {
        let acts = |integrator: &str, samples: u32, settings: &Settings| {
            let render = format!(r#"{{"integrator": "{integrator}", "samples": {samples}}}"#);
            let scene = Scene::from_json(format!(r#"{{"version": 1, "render": {render}}}"#), "a.json").unwrap();
            check_scene(settings, &scene).is_ok()
        };
        let deep = Settings { max_depth: Some(3), ..Settings::default() };
        assert!(acts("classic", 1, &deep) && acts("path", 1, &deep) && acts("normals", 1, &Settings::default()));
        assert!(!acts("normals", 1, &deep) && !acts("direct", 1, &deep));
        assert!(acts("normals", 1, &Settings { integrator: Some(IntegratorKind::Path), ..deep }));
        let denoised = Settings { denoiser: Some(juggler::Denoiser::Own), ..Settings::default() };
        assert!(!acts("path", 1, &denoised) && acts("path", 2, &denoised));
    }

    #[test]
    fn tones_without_effect_are_warned_of_by_name() {
        let encoding = |output: &str| Target::Picture(Encoding::new(None, None, None, output).unwrap());
        let text = r#"{"version": 1, "tone": {"curve": "linear", "exposure_stops": 0.5}}"#;
        let tone = Scene::from_json(text.to_owned(), "a.json").unwrap().description.tone.into_inner();
        let warning = ignored_tone_warning(encoding("a.exr"), &tone).unwrap();
        assert!(warning.contains("`tone.curve`, `tone.exposure_stops` have no effect"), "{warning}");
        assert_eq!(ignored_tone_warning(encoding("a.png"), &tone), None);
        assert_eq!(ignored_tone_warning(encoding("a.exr"), &Tone::default()), None);
    }
}
