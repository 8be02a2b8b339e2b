//! The studio around a model file that was given in place of a scene.

use super::ModelSummary;
use crate::description::BackgroundInput;
use juggler_light::AnyLight;
use juggler_light::background::Studio;
use juggler_math::{Aabb, Rgb, Vec2, Vec3};
use std::f32::consts::PI;

/// Irradiance of the dimmed studio relative to the illuminance by the lights of the file.
const DIMMED_SHARE: f32 = 0.1;
/// Smallest and largest scale of the dimmed studio. A file of weak lights is no black picture, and
/// lights that overexpose what is near them leave the backdrop dark.
const SCALES: [f32; 2] = [0.02, 0.2];
/// Radiance of the studio of scale 1 that the camera sees: light gray.
const VISIBLE: f32 = 0.9;

/// Typical illuminance by lights in a box: the median over the center and the points halfway to the
/// corners, of those that any light reaches, without occlusion. Each light counts as if the surface
/// faced it. 0 without light.
pub fn illuminance(lights: &[&AnyLight], bounds: &Aabb) -> f32 {
    let (center, half) = if bounds.is_finite() && !bounds.is_empty() {
        (bounds.center(), bounds.extent() * 0.25)
    } else {
        (Vec3::ZERO, Vec3::ZERO)
    };
    let corners = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0);
    let at = |point: Vec3| -> f32 {
        let one = |light: &AnyLight| {
            let sample = light.sample(point, Vec2::splat(0.5));
            sample.map_or(0.0, |sample| (sample.radiance / sample.pdf).luminance())
        };
        lights.iter().map(|light| one(light)).filter(|value| value.is_finite()).sum()
    };
    let points = std::iter::once(Vec3::ZERO).chain(corners).map(|corner| center + corner * half);
    let mut values: Vec<f32> = points.map(at).filter(|value| *value > 0.0).collect();
    values.sort_by(f32::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Background of a scene around a model: nothing beside an image-based light, a studio around a
/// file without lights, and a dimmed studio beside lights. The lights dominate, while metal and
/// glass have something to reflect.
pub fn background(summary: &ModelSummary) -> Option<BackgroundInput> {
    if summary.has_environment {
        return None;
    }
    let mut studio = Studio::default();
    if summary.illuminance > 0.0 {
        let [least, most] = SCALES;
        let scale = (DIMMED_SHARE * summary.illuminance / PI).clamp(least, most);
        // Two digits are enough.
        studio.scale = format!("{scale:.1e}").parse().unwrap_or(scale);
    }
    studio.visible_as = Some(Rgb::splat(VISIBLE * studio.scale));
    Some(BackgroundInput::Kind(studio.into()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use juggler_light::background::AnyBackground;
    use juggler_light::{Directional, Point};

    fn found(lights: &[AnyLight]) -> f32 {
        illuminance(&lights.iter().collect::<Vec<_>>(), &Aabb { min: Vec3::splat(-4.0), max: Vec3::splat(4.0) })
    }

    fn studio(summary: &ModelSummary) -> Option<Studio> {
        match background(summary) {
            Some(BackgroundInput::Kind(AnyBackground::Studio(studio))) => Some(studio),
            _ => None,
        }
    }

    #[test]
    fn illuminance_is_that_of_closed_forms() {
        let sun = AnyLight::from(Directional { intensity: 3.0, ..Directional::default() });
        let bulb = |position| AnyLight::from(Point { position, intensity: Some(24.0), ..Point::default() });
        assert!((found(std::slice::from_ref(&sun)) - 3.0).abs() < 1e-5);
        // The points halfway to the corners are √12 from the center: all of them have 24 / 12.
        let point = bulb(Vec3::new(1e-3, 0.0, 0.0));
        assert!((found(std::slice::from_ref(&point)) - 2.0).abs() < 1e-2);
        assert!((found(&[sun, point]) - 5.0).abs() < 1e-2);
        assert_eq!(found(&[]), 0.0);
        assert!(illuminance(&[&bulb(Vec3::new(0.0, 2.0, 0.0))], &Aabb::EMPTY) == 6.0);
    }

    #[test]
    fn the_studio_is_dimmed_beside_lights_and_absent_beside_an_environment() {
        let scale = |illuminance| studio(&ModelSummary { illuminance, ..ModelSummary::default() }).map(|it| it.scale);
        assert_eq!(scale(0.0), Some(1.0));
        // A tenth of the irradiance of the lights.
        assert!(scale(PI).is_some_and(|scale| (scale - 0.1).abs() < 1e-6));
        assert_eq!((scale(1e-6), scale(f32::MAX)), (Some(0.02), Some(0.2)));
        let visible = studio(&ModelSummary { illuminance: PI, ..ModelSummary::default() }).and_then(|it| it.visible_as);
        assert!(visible.is_some_and(|color| (color.g - 0.09).abs() < 1e-6));
        let summary = ModelSummary { illuminance: PI, has_environment: true, ..ModelSummary::default() };
        assert!(background(&summary).is_none());
    }
}
