//! Checks that flags and settings have an effect on a scene: a flag without effect is an error, a
//! setting of the scene without effect is a warning. The table of flags refuses flags that
//! the target does not support.

use crate::failure::Failure;
use crate::target::Target;
use juggler::Settings;
use juggler::imaging::Tone;
use juggler::integrator::AnyIntegrator;
use juggler::scene::Scene;

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
    let format = target.encoding()?.format;
    let usual = Tone::default();
    let idle = [
        ("curve", tone.curve != usual.curve),
        ("exposure_stops", tone.exposure_stops != usual.exposure_stops),
        ("white_balance", tone.white_balance != usual.white_balance),
        ("backdrop", tone.backdrop != usual.backdrop),
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
    use crate::encoding::{Encoding, EncodingChoice};
    use juggler::integrator::IntegratorKind;

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
        let encoding = |output: &str| Target::Picture(Encoding::new(EncodingChoice::default(), output).unwrap());
        let text = r#"{"version": 1, "tone": {"curve": "linear", "exposure_stops": 0.5}}"#;
        let tone = Scene::from_json(text.to_owned(), "a.json").unwrap().description.tone.into_inner();
        let warning = ignored_tone_warning(encoding("a.exr"), &tone).unwrap();
        assert!(warning.contains("`tone.curve`, `tone.exposure_stops` have no effect"), "{warning}");
        assert_eq!(ignored_tone_warning(encoding("a.png"), &tone), None);
        assert_eq!(ignored_tone_warning(encoding("a.exr"), &Tone::default()), None);
    }
}
