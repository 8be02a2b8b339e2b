//! How much light reaches the middle of a scene: what tells a scene that renders near black before it is rendered.

use crate::description::Description;
use crate::path::Path;
use crate::report::Finding;
use juggler_light::AnyLight;
use juggler_math::range::shown;
use juggler_math::{Aabb, Vec2, Vec3, fun};
use juggler_world::Lamp;
use std::fmt;

/// Illuminance below which a picture is near black: white in it becomes level 39 of 255 in sRGB.
const DARK: f32 = 0.02;

/// The light of a scene that brings the most to the middle of its bounds, as if nothing stood in the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Illuminance {
    /// Where the light is described, `lights[2]`; nothing for the default light.
    pub light: Option<String>,
    /// Luminance of the light that arrives on a surface that faces it: 1 for `"intensity": 1` at distance 1.
    pub value: f32,
}

impl fmt::Display for Illuminance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let light = self.light.as_deref().unwrap_or("the default light");
        write!(f, "{light} brings an illuminance of {} to the middle of the scene", shown(significant(self.value)))
    }
}

/// What arrives at a point from one place of a light, or from everywhere for ambient light.
fn arriving(light: &AnyLight, point: Vec3) -> f32 {
    let direct = light.sample(point, Vec2::splat(0.5)).map_or(0.0, |sample| (sample.radiance / sample.pdf).luminance());
    direct.max(light.ambient().luminance())
}

/// The number of the light that brings the most to a point, and how much.
fn brightest(lamps: &[Lamp], point: Vec3) -> Option<(usize, f32)> {
    const MIDDLE: f32 = 0.5;
    let arriving = lamps.iter().map(|lamp| arriving(&lamp.at(MIDDLE).light, point)).enumerate();
    arriving.filter(|(_, value)| value.is_finite()).reduce(|most, next| if next.1 > most.1 { next } else { most })
}

/// The light that brings the most to the middle of the bounds; `described` tells lights of the scene from default ones.
pub fn at_the_middle(lamps: &[Lamp], described: bool, bounds: &Aabb) -> Option<Illuminance> {
    let (number, value) = brightest(lamps, bounds.center())?;
    Some(Illuminance { light: described.then(|| Path::root().key("lights").index(number).to_string()), value })
}

/// Warns of a still scene whose lights bring next to nothing to its middle, and to the places halfway to its corners, where
/// nothing else gives light.
pub fn warning(scene: &Description, lamps: &[Lamp], bounds: &Aabb) -> Option<Finding> {
    let is_dark = |value: f32| value * fun::exp2(scene.tone.exposure_stops) < DARK;
    let (center, half) = (bounds.center(), bounds.extent() * 0.25);
    let corners = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0);
    let (number, middle) = brightest(lamps, center)?;
    // All lights are evaluated at each corner, so that most scenes end here.
    if scene.animation.frames != 1 || !is_dark(middle) {
        return None;
    }
    let most = corners.filter_map(|corner| brightest(lamps, center + corner * half)).map(|(_, value)| value);
    let most = most.fold(middle, f32::max);
    // Lights of no light at all are warned of by themselves.
    if !(is_dark(most) && most > 0.0) {
        return None;
    }
    let middle = shown(significant(middle));
    let message =
        format!("the brightest light brings an illuminance of {middle} to the middle of the scene: near black");
    let finding = Finding::warning(message).at(Path::root().key("lights").index(number));
    Some(finding.help("raise its `intensity`, bring it nearer, or raise `tone.exposure_stops`"))
}

/// The number with two digits that count.
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
    fn the_brightest_light_is_told_by_closed_forms() {
        let far = r#"{"point": {"position": [0, 1, 9], "intensity": 9}}"#;
        for (lights, light, expected) in [
            (r#"{"point": {"position": [3, 5, 0], "intensity": 50}}"#, Some("lights[0]"), 2.0),
            (&*format!(r#"{far}, {{"directional": {{"intensity": 0.5}}}}"#), Some("lights[1]"), 0.5),
            (&*format!(r#"{far}, {{"ambient": {{"intensity": 0.1}}}}"#), Some("lights[0]"), 1.0 / 9.0),
            (r#"{"ambient": {"intensity": 0.1}}"#, Some("lights[0]"), 0.1),
            // The default light stands 4 radii from the middle, and brings 0.6.
            ("", None, 0.6),
        ] {
            let found = scene(lights, "").compile().unwrap().illuminance.unwrap();
            assert_eq!(found.light.as_deref(), light, "{lights}");
            assert!((found.value - expected).abs() < 1e-3 * expected, "{lights}: {}", found.value);
        }
    }

    #[test]
    fn near_black_scenes_are_warned_of() {
        let lamp = |intensity: f32| format!(r#"{{"point": {{"position": [0, 11, 0], "intensity": {intensity}}}}}"#);
        let warnings = |lights: &str, more: &str| scene(lights, more).check().warnings();
        assert_eq!(warnings(&lamp(1.0), ""), 1);
        let told = scene(&lamp(1.0), "").check().to_string();
        assert!(told.contains("an illuminance of 0.01 to the middle of the scene"), "{told}");
        assert_eq!(warnings(&lamp(3.0), ""), 0);
        for more in [
            r#", "tone": {"exposure_stops": 2}"#,
            r#", "animation": {"frames": 9}"#,
            r#", "background": {"sky": {}}"#,
            r#", "materials": {"lamp": {"emissive": {}}}"#,
        ] {
            assert_eq!(warnings(&lamp(1.0), more), 0, "{more}");
        }
        // A lamp for one corner alone, and one in the very middle.
        let spot = r#"{"spot": {"position": [0.4, 3, 0.4], "direction": [0, -1, 0], "cutoff_degrees": 10, "beam_degrees": 5, "intensity": 9}}"#;
        assert_eq!(warnings(spot, ""), 0);
        assert_eq!(warnings(r#"{"point": {"position": [0, 1, 0], "intensity": 1}}"#, ""), 0);
    }
}
