//! Checks of render settings and lights that validation by schema cannot make.

use crate::description::{Description, Render};
use crate::integrator::{IntegratorChoice, IntegratorRequirements};
use crate::path::Path;
use crate::report::Finding;
use juggler_light::AnyLight;

/// Maximum width and height of an image, in pixels.
pub const MAX_EDGE: u32 = 65_536;
/// Maximum number of pixels of an image.
pub const MAX_PIXELS: u64 = 1 << 31;
/// Maximum distance of shutter times from the frame, in frames.
pub const MAX_SHUTTER: f64 = 1000.0;
/// Maximum number of samples per pixel.
pub const MAX_SAMPLES: u32 = 1 << 24;

/// Checks size, samples and shutter, which programs may have changed since the scene was read.
pub fn check(render: &Render, findings: &mut Vec<Finding>) {
    let path = Path::root().key("render");
    let [width, height] = render.size;
    if !(1..=MAX_EDGE).contains(&width) || !(1..=MAX_EDGE).contains(&height) {
        let message = format!("each number of `size` must be between 1 and {MAX_EDGE}, is {width} x {height}");
        findings.push(Finding::error(message).at(path.key("size")));
    } else if u64::from(width) * u64::from(height) > MAX_PIXELS {
        let pixels = u64::from(width) * u64::from(height);
        let message = format!("`size` has {pixels} pixels, the limit is {MAX_PIXELS}");
        findings.push(Finding::error(message).at(path.key("size")));
    }
    if !(1..=MAX_SAMPLES).contains(&render.samples) {
        let message = format!("`samples` must be between 1 and {MAX_SAMPLES}, is {}", render.samples);
        findings.push(Finding::error(message).at(path.key("samples")));
    }
    let [open, close] = render.shutter;
    if !(open <= close && open.abs() <= MAX_SHUTTER && close.abs() <= MAX_SHUTTER) {
        let message = format!(
            "the shutter must open before it closes, both within {MAX_SHUTTER} frames; found {open} to {close}"
        );
        findings.push(Finding::error(message).at(path.key("shutter")));
    }
}

/// Checks the lights of a scene, with their files loaded, and warns about lights without power.
pub fn check_lights(scene: &Description, lights: &[AnyLight], findings: &mut Vec<Finding>) {
    // In an animation, a light may be off for a while.
    let still = scene.animation.frames == 1;
    for (i, light) in lights.iter().enumerate() {
        let path = || Path::root().key("lights").index(i);
        if let Err(invalid) = light.check() {
            let path = path().key(light.name()).join(invalid.field);
            findings.push(Finding::error(invalid.message).at(&path));
        } else if still && is_loaded(light) && light.power(1.0) == 0.0 && light.ambient().is_black() {
            let warning = Finding::warning("this light emits no light").at(path());
            findings.push(warning.help("increase its `intensity` or `color`, or remove it"));
        }
    }
}

/// Warns about lights that have no effect with the integrator.
pub fn check_fit(scene: &Description, choice: &IntegratorChoice, findings: &mut Vec<Finding>) {
    let name = choice.integrator.name();
    if scene.tone.backdrop.is_some() && !scene.render.transparent {
        let message = "`backdrop` has no effect: the background hides it";
        let at = Path::root().key("tone").key("backdrop");
        findings.push(Finding::warning(message).at(at).help("write \"transparent\": true in `render`"));
    }
    let lights = Path::root().key("lights");
    if choice.follows_paths() {
        if let Some(i) = scene.lights.iter().position(|light| !light.ambient().is_black()) {
            let message = format!("an `ambient` light has no effect with the integrator `{name}`");
            let help = "use a background as ambient light: \"background\": [0.1, 0.1, 0.1]";
            findings.push(Finding::warning(message).at(lights.index(i)).help(help));
        }
        if let Some((i, light)) = scene.lights.iter().enumerate().find(|(_, light)| light.shadow_samples() > 1) {
            let path = lights.index(i).key(light.name()).key("samples");
            let message = format!("`samples` of a light has no effect with the integrator `{name}`");
            findings.push(Finding::warning(message).at(path).help("increase `render.samples` for smoother shadows"));
        }
        return;
    }
    if !choice.is_classic() {
        return;
    }
    let IntegratorRequirements { emitter, sky, .. } = IntegratorRequirements::from_scene(scene);
    // In a scene with lights, a sky may be a mere backdrop.
    for part in emitter.into_iter().chain(sky.filter(|_| scene.lights.is_empty())) {
        let warning =
            Finding::warning(format!("`{}` does not light the scene with the integrator `classic`", part.kind))
                .at(part.path);
        findings.push(warning.help("write \"integrator\": \"path\", or remove `integrator`"));
    }
}

/// Whether the content of the light's file is loaded, if the light has a file.
fn is_loaded(light: &AnyLight) -> bool {
    light.clone().ies().is_none_or(|ies| ies.profile().is_some())
}
