//! Which flags can act and which settings have an effect. One rule: a flag that cannot act is
//! refused, a setting of the scene that has no effect is warned of. Everything that decides it is
//! in this file.

use crate::args::RenderArgs;
use crate::failure::Failure;
use crate::plan::{Encoding, Product, Reel};
use juggler::Settings;
use juggler::imaging::{AnimationFormat, Format, Look, Tone};
use juggler::integrator::AnyIntegrator;
use juggler::scene::Scene;

/// What a command writes in the end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A picture.
    Picture(Encoding),
    /// A film part.
    Part,
    /// A movie.
    Movie(AnimationFormat),
}

impl Target {
    /// Of a render.
    pub fn new(product: Product, reel: Option<&Reel>) -> Self {
        match (product, reel) {
            (_, Some(reel)) => Self::Movie(reel.format),
            (Product::Picture(encoding), None) => Self::Picture(encoding),
            (Product::Part, None) => Self::Part,
        }
    }
}

/// A flag, and whether the command line has it.
pub type Given = (&'static str, bool);

/// The flags of a render that not every target can obey; `several`: the render makes several
/// frames.
pub fn given(args: &RenderArgs, several: bool) -> [Given; 15] {
    [
        ("--bits", args.bits.is_some()),
        ("--quality", args.quality.is_some()),
        ("--look", args.look.is_some()),
        ("--tone", args.tone.is_some()),
        ("--exposure", args.exposure.is_some()),
        ("--white-balance", args.white_balance.is_some()),
        // What is never dithered obeys `off`.
        ("--dither on", args.dither == Some(true)),
        ("--fps", args.fps.is_some()),
        ("--plays", args.plays.is_some()),
        ("--frame", args.view.frame.is_some()),
        ("--at", args.view.at.is_some()),
        ("--aov", args.aov.is_some()),
        ("--aov-output", args.aov_output.is_some()),
        // Of several frames a shard takes some, whole.
        ("--shard", args.shard.is_some() && !several),
        ("--sample-range", args.sample_range.is_some()),
    ]
}

/// Refuses the first flag that cannot act on the target, and says why.
pub fn check(target: Target, given: &[Given]) -> Result<(), Failure> {
    let mut given = given.iter().filter(|(_, is_given)| *is_given);
    match given.find_map(|(flag, _)| obstacle(flag, target)) {
        Some(message) => Err(Failure::Wrong(message)),
        None => Ok(()),
    }
}

/// Why a flag cannot act on a target.
fn obstacle(flag: &str, target: Target) -> Option<String> {
    match target {
        Target::Picture(encoding) => of_picture(flag, encoding),
        Target::Part => of_part(flag),
        Target::Movie(format) => of_movie(flag, format),
    }
}

fn of_picture(flag: &str, Encoding { format, options }: Encoding) -> Option<String> {
    let is_dithered = format.is_tone_mapped() && options.look == Look::Plain && !options.png_16_bit;
    Some(match flag {
        "--quality" if format != Format::Jpeg => {
            format!("--quality is for JPEG and MP4 files; a {format} file has none")
        }
        "--look" if !format.has_looks() => format!("--look is for levels; a {format} file keeps light as it is"),
        "--tone" | "--exposure" | "--white-balance" if !format.is_tone_mapped() => {
            format!("{flag} is for PNG, JPEG and WebP pictures and for movies; {format} files keep linear light")
        }
        "--dither on" if !is_dithered => {
            format!("{flag} is for pictures of 8 bits without a look; this {format} file is never dithered")
        }
        "--fps" | "--plays" => format!("{flag} is for moving pictures: {}", AnimationFormat::endings()),
        "--shard" => format!("{}; of several frames (--frames) it takes some", makes_part(flag)),
        "--sample-range" => makes_part(flag),
        _ => return None,
    })
}

fn makes_part(flag: &str) -> String {
    format!("{flag} makes a part of a picture, for `juggler merge`: give an output that ends in .jfilm")
}

fn of_part(flag: &str) -> Option<String> {
    Some(match flag {
        "--bits" | "--look" => format!("{flag} is for pictures; a film part keeps the sums as they are"),
        "--quality" => "--quality is for JPEG and MP4 files; a film part has none".into(),
        "--format" => "--format is for pictures; a film part has one format".into(),
        "--fps" | "--plays" => format!("{flag} is for moving pictures: {}", AnimationFormat::endings()),
        "--aov-output" => "--aov-output is for pictures; a film part keeps its AOVs itself, for `juggler merge`".into(),
        _ => return None,
    })
}

fn of_movie(flag: &str, format: AnimationFormat) -> Option<String> {
    Some(match flag {
        "--bits" | "--frame" | "--at" => format!("{flag} is for pictures; this {format} movie has several frames"),
        "--aov" => "--aov is for pictures: numbered ones (-o 'frame_####.exr') can have AOVs, a movie has none".into(),
        "--dither on" => format!("{flag} is for pictures; frames of a movie are never dithered"),
        "--quality" if !format.has_quality() => {
            format!("--quality is for JPEG and MP4 files; {format} has none")
        }
        "--plays" if !format.says_how_often() => {
            format!("--plays: how often an {format} is shown is up to who shows it; .webp .apng .gif say it")
        }
        "--sample-range" => makes_part(flag),
        _ => return None,
    })
}

/// Refuses flags that cannot act on a scene that is rendered with these settings.
pub fn check_scene(settings: &Settings, scene: &Scene) -> Result<(), Failure> {
    let wrong = |message: String| Err(Failure::Wrong(message));
    let (mut render, mut tone) = ((*scene.description.render).clone(), (*scene.description.tone).clone());
    Settings { max_depth: None, ..settings.clone() }.apply_to(&mut render, &mut tone)?;
    let integrator = render.integrator.unwrap_or_else(|| scene.integrator_choice().integrator);
    let follows_paths = matches!(integrator, AnyIntegrator::Classic(_) | AnyIntegrator::Path(_));
    if settings.max_depth.is_some() && !follows_paths {
        let name = integrator.name();
        return wrong(format!(
            "--max-depth is for the integrators `classic` and `path`; `{name}` follows no paths whose depth has a limit"
        ));
    }
    if settings.denoiser.is_some() && render.samples < 2 {
        return wrong("--denoise needs 2 samples a pixel or more: their differences are what it goes by".into());
    }
    Ok(())
}

/// Settings of a tone that have no effect on a target, as a warning; `None` where all have.
pub fn idle_tone(target: Target, tone: &Tone) -> Option<String> {
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
    Some(format!("warning: {} {have} no effect: {format} files keep linear light", names.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Plan;

    fn refused(line: &str) -> Option<String> {
        match Plan::new(RenderArgs::of(line.split(' ')).unwrap()) {
            Ok(_) => None,
            Err(Failure::Wrong(message)) => Some(message),
            Err(other) => panic!("{line}: {other:?}"),
        }
    }

    #[test]
    fn flags_of_levels_are_refused_where_light_is_kept() {
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
        // The picture that a part becomes, and the levels of a movie, obey them.
        for line in ["a --tone agx -o b.jfilm", "a --exposure 1 -o b.gif", "a --dither off -o b.exr"] {
            assert_eq!(refused(line), None, "{line}");
        }
        assert!(refused("a --dither on --bits 16").is_some() && refused("a --dither on -o b.gif").is_some());
    }

    #[test]
    fn parts_of_a_picture_are_film_parts() {
        assert!(refused("a --shard 0/2 -o a.png").unwrap().contains(".jfilm"));
        assert!(refused("a --sample-range 0..16 -o a.png").unwrap().contains(".jfilm"));
        assert!(refused("a --sample-range 0..16 -o a.gif").unwrap().contains(".jfilm"));
        assert_eq!(refused("a --shard 0/2 -o a.jfilm"), None);
    }

    #[test]
    fn depths_and_denoising_need_what_they_act_on() {
        let acts = |integrator: &str, samples: u32, settings: &Settings| {
            let render = format!(r#"{{"integrator": "{integrator}", "samples": {samples}}}"#);
            let scene = Scene::from_json(format!(r#"{{"version": 1, "render": {render}}}"#), "a.json").unwrap();
            check_scene(settings, &scene).is_ok()
        };
        let deep = Settings { max_depth: Some(3), ..Settings::default() };
        assert!(acts("classic", 1, &deep) && acts("path", 1, &deep) && acts("normals", 1, &Settings::default()));
        assert!(!acts("normals", 1, &deep) && !acts("direct", 1, &deep));
        assert!(acts("normals", 1, &Settings { integrator: Some("path".into()), ..deep }));
        let denoised = Settings { denoiser: Some(juggler::Denoiser::Own), ..Settings::default() };
        assert!(!acts("path", 1, &denoised) && acts("path", 2, &denoised));
    }

    #[test]
    fn tones_without_effect_are_warned_of_by_name() {
        let encoding = |output: &str| Target::Picture(Encoding::new(None, None, None, output).unwrap());
        let text = r#"{"version": 1, "tone": {"curve": "linear", "exposure_stops": 0.5}}"#;
        let tone = Scene::from_json(text.to_owned(), "a.json").unwrap().description.tone.into_inner();
        let warning = idle_tone(encoding("a.exr"), &tone).unwrap();
        assert!(warning.contains("`tone.curve`, `tone.exposure_stops` have no effect"), "{warning}");
        assert_eq!(idle_tone(encoding("a.png"), &tone), None);
        assert_eq!(idle_tone(encoding("a.exr"), &Tone::default()), None);
    }
}
