//! Scenes that no light reaches, of which the picture would be black.

use super::Assembly;
use crate::IntegratorChoice;
use crate::description::Description;
use crate::path::Path;
use crate::report::Finding;
use juggler_light::AnyLight;
use juggler_light::background::AnyBackground;
use juggler_material::{MaterialId, MaterialTable, SurfaceEmission};
use juggler_math::Rgb;

/// Whether a background lights the scene: environments, skies and studios do, and with path tracing
/// every background that is not black.
pub fn is_light_source(integrator: &IntegratorChoice, background: &AnyBackground) -> bool {
    let is_light =
        matches!(background, AnyBackground::Environment(_) | AnyBackground::Sky(_) | AnyBackground::Studio(_));
    is_light || integrator.follows_paths() && !background.mean_radiance().is_black()
}

/// Warning that the picture is black: a scene that does not change has objects, but no light with
/// power, no background, and no material that emits or shows its color without light. Obstacles
/// between light and camera are not checked.
pub fn warning(scene: &Description, assembly: &Assembly) -> Option<Finding> {
    let Assembly { integrator, lights, background, materials, .. } = assembly;
    let shows_light = integrator.follows_paths() || integrator.is_classic();
    if !shows_light || scene.animation.frames != 1 || assembly.objects.is_empty() {
        return None;
    }
    let backdrop = background.visible_as().unwrap_or(Rgb::BLACK);
    let is_lit = !(backdrop.is_black() && background.mean_radiance().is_black());
    let has_power =
        |light: &AnyLight| light.power(1.0) > 0.0 || !integrator.follows_paths() && !light.ambient().is_black();
    let mut used = assembly.object_materials.iter();
    if is_lit || lights.iter().any(|light| has_power(&light.at(0.5).light)) || used.any(|id| is_seen(*id, materials)) {
        return None;
    }
    let message = "no light reaches the camera: no light, background or material emits any";
    let help = "add a light or a background such as `\"background\": 0.5`, or increase the `intensity`, `power`, `radiance` or \
                `scale` of a source of light";
    Some(Finding::warning(message).at(Path::root()).help(help))
}

/// Whether a material emits light, or is seen without any.
pub fn is_seen(id: MaterialId, materials: &MaterialTable) -> bool {
    let emits = |emission: SurfaceEmission| emission.radiance.is_none_or(|radiance| !radiance.is_black());
    materials.emission(id).is_some_and(emits) || materials.shows_unlit(id)
}

#[cfg(test)]
mod tests {
    use crate::Scene;

    /// Whether the check of a scene of these members says that no light reaches the camera.
    fn is_dark(objects: &str, members: &str) -> bool {
        let text = format!(r#"{{"version": 1, "objects": [{{"shape": "plane"}}, {objects}] {members}}}"#);
        let problems = Scene::from_json(text, "test.json").unwrap().check();
        assert_eq!(problems.errors(), 0, "{problems}");
        problems.to_string().contains("no light reaches the camera")
    }

    #[test]
    fn scenes_without_light_are_warned_of() {
        let path = r#", "render": {"integrator": "path"}"#;
        let ball = |material: &str| format!(r#"{{"shape": "sphere", "material": {material}}}"#);
        let (black, lit) = (r#"{"emissive": {"radiance": 0}}"#, r#"{"emissive": {"radiance": 1}}"#);
        for (objects, members) in [
            (
                ball(r#"{"diffuse": {}}"#),
                r#", "lights": [{"point": {"position": [0, 3, 0], "intensity": 0}}]"#.to_owned(),
            ),
            (ball(black), format!(r#", "background": 0, "lights": [{{"ambient": {{}}}}] {path}"#)),
            (ball(r#"{"diffuse": {}}"#), format!(r#", "background": {{"studio": {{"scale": 0}}}} {path}"#)),
            (ball(r#"{"diffuse": {}}"#), format!(r#", "background": 0, "materials": {{"unused": {lit}}} {path}"#)),
        ] {
            assert!(is_dark(&objects, &members), "{objects} {members}");
        }
        for (objects, members) in [
            (ball(r#"{"diffuse": {}}"#), String::new()),
            (ball(r#"{"phong": {}}"#), r#", "background": 0, "lights": [{"ambient": {}}]"#.to_owned()),
            (ball(lit), format!(r#", "background": 0 {path}"#)),
            (ball(r#"{"unlit": {}}"#), format!(r#", "background": {{"studio": {{"scale": 0}}}} {path}"#)),
            (
                ball(r#"{"diffuse": {}}"#),
                r#", "background": {"studio": {"scale": 0, "visible_as": [1, 1, 1]}}"#.to_owned(),
            ),
            (
                ball(r#"{"diffuse": {}}"#),
                r#", "lights": [{"area": {"shape": {"rectangle": {"size": [1, 1]}}}}]"#.to_owned(),
            ),
            (
                ball(r#"{"diffuse": {}}"#),
                r#", "background": 0, "lights": [{"point": {"intensity": 0}}], "render": {"integrator": "normals"}"#
                    .to_owned(),
            ),
            (
                ball(r#"{"diffuse": {}}"#),
                r#", "lights": [{"point": {"intensity": "=frame"}}], "animation": {"frames": 9}"#.to_owned(),
            ),
        ] {
            assert!(!is_dark(&objects, &members), "{objects} {members}");
        }
    }
}
