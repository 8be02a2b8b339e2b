//! Lights and the selected camera over the shutter interval.

use super::lighting::load_light;
use super::meshes::Files;
use crate::description::Description;
use crate::motion::Tracks;
use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_world::SceneLight;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::sync::Arc;

/// Number of subintervals of the shutter interval. A changing light is constant in each of them,
/// evaluated at its midpoint.
const LIGHT_INTERVALS: usize = 256;

/// Lights with the content of their files. Lights with tracks change while the shutter is open.
pub fn lights(lights: &[AnyLight], tracks: &Tracks, files: Files<'_>) -> Vec<SceneLight> {
    let light = |(i, light): (usize, &AnyLight)| {
        // Errors of files are reported already.
        let keys = tracks.lights.get(&i).map(|keys| keys.iter().map(|key| load_light(i, key, files, &mut Vec::new())));
        let keys: Vec<AnyLight> = keys.into_iter().flatten().collect();
        let mut parts =
            (0..if keys.is_empty() { 0 } else { LIGHT_INTERVALS }).map(|part| light_in_interval(&keys, part, light));
        match parts.next() {
            Some(first) => SceneLight::from_states(&first, &parts.collect::<Vec<_>>()),
            None => SceneLight::from(light.clone()),
        }
    };
    lights.iter().enumerate().map(light).collect()
}

fn light_in_interval(keys: &[AnyLight], part: usize, otherwise: &AnyLight) -> AnyLight {
    let place = (part as f64 + 0.5) / LIGHT_INTERVALS as f64 * (keys.len() - 1) as f64;
    let key = place as usize;
    let (Some(from), Some(to)) = (keys.get(key), keys.get(key + 1)) else { return otherwise.clone() };
    let mut from = from.clone();
    let Some(mut light) = interpolate(&from, to, place - key as f64) else { return from };
    // Copy the content of the file, which is not part of the description. The file stays the same.
    if let (Some(to), Some(profile)) = (light.ies(), from.ies().and_then(|ies| ies.profile())) {
        to.set_profile(Arc::clone(profile));
    }
    light
}

/// Camera of this name at even times while the shutter is open; empty if the camera is static or a
/// default camera.
pub fn camera(tracks: &Tracks, name: &str, scene: &Description) -> Vec<AnyCamera> {
    let single = scene.camera.is_some() && name == "camera";
    let keys = tracks.cameras.get(if single { "" } else { name });
    keys.into_iter().flatten().map(|key| (**key).clone()).collect()
}

/// Interpolates two descriptions linearly, number by number.
fn interpolate<T: Serialize + DeserializeOwned>(from: &T, to: &T, fraction: f64) -> Option<T> {
    let (mut value, to) = (serde_json::to_value(from).ok()?, serde_json::to_value(to).ok()?);
    interpolate_json(&mut value, &to, fraction)?;
    T::deserialize(&value).ok()
}

fn interpolate_json(value: &mut Value, to: &Value, fraction: f64) -> Option<()> {
    match (value, to) {
        (Value::Number(from), Value::Number(to)) => {
            // Do not interpolate integers, which are counts.
            if from != to && from.is_f64() {
                *from = serde_json::Number::from_f64(from.as_f64()? * (1.0 - fraction) + to.as_f64()? * fraction)?;
            }
            Some(())
        }
        (Value::Array(from), Value::Array(to)) if from.len() == to.len() => {
            from.iter_mut().zip(to).try_for_each(|(from, to)| interpolate_json(from, to, fraction))
        }
        (Value::Object(from), Value::Object(to)) if from.len() == to.len() => {
            from.iter_mut().try_for_each(|(key, from)| interpolate_json(from, to.get(key)?, fraction))
        }
        (from, to) => (from == to).then_some(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::item::Item;

    fn lights(x: f64, intensity: f64, samples: u32) -> Vec<AnyLight> {
        let lights = format!(
            r#"[{{"point": {{"position": [{x}, 1, 0], "intensity": {intensity}, "samples": {samples}}}}},
                {{"ambient": {{"intensity": {intensity}}}}}]"#
        );
        serde_json::from_str(&lights).unwrap()
    }

    fn place(light: &SceneLight, time: f32) -> f32 {
        match &light.at(time).light {
            AnyLight::Point(point) => point.position.x,
            _ => panic!("no point"),
        }
    }

    fn lights_of(still: &[AnyLight], moments: &[Vec<AnyLight>]) -> Vec<SceneLight> {
        let mut tracks = Tracks::default();
        for i in 0..still.len() {
            let keys: Vec<Item<AnyLight>> = moments.iter().map(|lights| lights[i].clone().into()).collect();
            if keys.iter().any(|key| *key != still[i]) {
                tracks.lights.insert(i, keys);
            }
        }
        let (scene, sources, asset_cache, control) = Default::default();
        super::lights(
            still,
            &tracks,
            Files { scene: &scene, sources: &sources, asset_cache: &asset_cache, control: &control },
        )
    }

    #[test]
    fn light_positions_are_interpolated_between_keys() {
        let moments = [lights(0.0, 1.0, 2), lights(4.0, 2.0, 2), lights(4.0, 3.0, 2)];
        let all = lights_of(&moments[1], &moments);
        for (time, x) in [(0.0, 0.0), (0.25, 2.0), (0.5, 4.0), (0.99, 4.0)] {
            assert!((place(&all[0], time) - x).abs() < 0.02, "{time}");
        }
        assert!(all[0].moves() && all[1].moves());
        let still = lights_of(&moments[0], &[lights(0.0, 1.0, 2), lights(0.0, 1.0, 2)]);
        assert!(!still[0].moves() && place(&still[0], 0.5) == 0.0);
        assert!(!lights_of(&moments[0], &[])[0].moves());
        let counts = lights_of(&moments[0], &[lights(0.0, 1.0, 2), lights(2.0, 1.0, 5)]);
        assert!((place(&counts[0], 0.5) - 1.0).abs() < 0.01);
    }
}
