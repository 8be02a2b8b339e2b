//! Illuminance at the center of a scene, which tells before rendering whether the image will be
//! nearly black.

use crate::description::Description;
use crate::path::Path;
use crate::report::Finding;
use juggler_light::{AnyLight, Area, Point, Spot};
use juggler_math::range::format_number;
use juggler_math::{Aabb, Vec2, Vec3, portable};
use juggler_world::SceneLight;
use std::fmt;

/// Illuminance below which an image is nearly black: white becomes level 39 of 255 in sRGB.
const DARK: f32 = 0.02;

/// Scale of illuminances for readers of messages, without exposure.
const SCALE: &str = "0.1 is dim, 3 shows white paper as white";

/// Light of the highest illuminance at the center of the scene's bounds, without occlusion.
#[derive(Clone, Debug, PartialEq)]
pub struct Illuminance {
    /// Path of the light, such as `lights[2]`; `None` for the default light.
    pub light: Option<String>,
    /// Illuminance of a surface that faces the light: 1 for `"intensity": 1` at distance 1.
    pub value: f32,
}

impl fmt::Display for Illuminance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let light = self.light.as_deref().unwrap_or("the default light");
        let value = format_number(significant(self.value));
        write!(f, "{light} lights the center of the scene with {value} W per square unit ({SCALE})")
    }
}

/// Illuminance at a point from one position on a light; from all directions for ambient light.
fn illuminance_at(light: &AnyLight, point: Vec3) -> f32 {
    let direct = light.sample(point, Vec2::splat(0.5)).map_or(0.0, |sample| (sample.radiance / sample.pdf).luminance());
    direct.max(light.ambient().luminance())
}

/// Index of the light of the highest illuminance at a point, and that illuminance.
fn brightest(lights: &[SceneLight], point: Vec3) -> Option<(usize, f32)> {
    const MIDDLE: f32 = 0.5;
    let values = lights.iter().map(|light| illuminance_at(&light.at(MIDDLE).light, point)).enumerate();
    values.filter(|(_, value)| value.is_finite()).reduce(|most, next| if next.1 > most.1 { next } else { most })
}

/// Light of the highest illuminance at the center of the bounds. `described` is `false` for default
/// lights.
pub fn at_center(lights: &[SceneLight], described: bool, bounds: &Aabb) -> Option<Illuminance> {
    let (number, value) = brightest(lights, bounds.center())?;
    Some(Illuminance { light: described.then(|| Path::root().key("lights").index(number).to_string()), value })
}

/// Warning for a static scene whose lights leave its center and the points halfway to its corners
/// nearly black. Applies to scenes without other sources of light.
pub fn warning(scene: &Description, lights: &[SceneLight], bounds: &Aabb) -> Option<Finding> {
    let is_dark = |value: f32| value * portable::exp2(scene.tone.exposure_stops) < DARK;
    let (center, half) = (bounds.center(), bounds.extent() * 0.25);
    let corners = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0);
    let (number, middle) = brightest(lights, center)?;
    // Return early for most scenes, since the points halfway to the corners need all lights.
    if scene.animation.frames != 1 || !is_dark(middle) {
        return None;
    }
    let most = corners.filter_map(|corner| brightest(lights, center + corner * half)).map(|(_, value)| value);
    let most = most.fold(middle, f32::max);
    // Lights without power have a warning of their own.
    if !(is_dark(most) && most > 0.0) {
        return None;
    }
    let middle = format_number(significant(middle));
    let message =
        format!("the brightest light lights the center of the scene with {middle} W per square unit: nearly black");
    let finding = Finding::warning(message).at(Path::root().key("lights").index(number));
    let strength = scene.lights.get(number).map_or("intensity", |light| strength_key(light));
    Some(finding.help(format!("increase its `{strength}`, move it closer, or increase `tone.exposure_stops`")))
}

/// Key of a light's strength: the one that the scene gives, or that the light has by default.
fn strength_key(light: &AnyLight) -> &'static str {
    match light {
        AnyLight::Point(Point { power: Some(_), .. })
        | AnyLight::Spot(Spot { power: Some(_), .. })
        | AnyLight::Area(Area { power: Some(_), .. }) => "power",
        AnyLight::Area(_) => "radiance",
        AnyLight::Ambient(_) | AnyLight::Directional(_) | AnyLight::Point(_) | AnyLight::Spot(_) => "intensity",
    }
}

/// Rounds to two significant digits.
fn significant(value: f32) -> f32 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use crate::Scene;

    fn scene(lights: &str, more: &str) -> Scene {
        let objects = r#"[{"shape": "plane"}, {"shape": "sphere", "transform": [{"translate": [0, 1, 0]}]}]"#;
        let text = format!(r#"{{"version": 1, "lights": [{lights}], "objects": {objects}{more}}}"#);
        Scene::from_json(text, "test.json").unwrap()
    }

    #[test]
    fn brightest_illuminance_matches_closed_forms() {
        let far = r#"{"point": {"position": [0, 1, 9], "intensity": 9}}"#;
        for (lights, light, expected) in [
            (r#"{"point": {"position": [3, 5, 0], "intensity": 50}}"#, Some("lights[0]"), 2.0),
            (&*format!(r#"{far}, {{"directional": {{"intensity": 0.5}}}}"#), Some("lights[1]"), 0.5),
            (&*format!(r#"{far}, {{"ambient": {{"intensity": 0.1}}}}"#), Some("lights[0]"), 1.0 / 9.0),
            (r#"{"ambient": {"intensity": 0.1}}"#, Some("lights[0]"), 0.1),
            // The default light is 4 radii from the center, where its illuminance is 0.6.
            ("", None, 0.6),
        ] {
            let found = scene(lights, "").compile().unwrap().illuminance.unwrap();
            assert_eq!(found.light.as_deref(), light, "{lights}");
            assert!((found.value - expected).abs() < 1e-3 * expected, "{lights}: {}", found.value);
        }
    }

    #[test]
    fn near_black_scenes_are_warned_of() {
        let light = |intensity: f32| format!(r#"{{"point": {{"position": [0, 11, 0], "intensity": {intensity}}}}}"#);
        let warnings = |lights: &str, more: &str| scene(lights, more).check().warnings();
        assert_eq!(warnings(&light(1.0), ""), 1);
        let report = scene(&light(1.0), "").check().to_string();
        assert!(report.contains("lights the center of the scene with 0.01 W per square unit"), "{report}");
        assert!(report.contains("increase its `intensity`"), "{report}");
        for (area, key) in [("radiance", "radiance"), ("power", "power")] {
            let light = format!(r#"{{"area": {{"position": [0, 11, 0], "{area}": 0.1}}}}"#);
            let report = scene(&light, "").check().to_string();
            assert!(report.contains(&format!("increase its `{key}`")), "{report}");
        }
        assert_eq!(warnings(&light(3.0), ""), 0);
        for more in [
            r#", "tone": {"exposure_stops": 2}"#,
            r#", "animation": {"frames": 9}"#,
            r#", "background": {"sky": {}}"#,
            r#", "materials": {"emitter": {"emissive": {}}}"#,
        ] {
            assert_eq!(warnings(&light(1.0), more), 0, "{more}");
        }
        // One light for a corner only, and one at the very center.
        let spot = r#"{"spot": {"position": [0.4, 3, 0.4], "direction": [0, -1, 0], "cutoff_degrees": 10, "beam_degrees": 5, "intensity": 9}}"#;
        assert_eq!(warnings(spot, ""), 0);
        let report = scene(r#"{"point": {"position": [0, 1, 0], "intensity": 1}}"#, "").check().to_string();
        assert!(!report.contains("nearly black"), "{report}");
    }
}
