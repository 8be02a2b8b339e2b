//! What changes while the shutter is open, and is no object: lights and the camera that is looked through.

use super::lighting::loaded;
use super::meshes::Files;
use crate::description::Description;
use crate::motion::Tracks;
use juggler_camera::AnyCamera;
use juggler_light::AnyLight;
use juggler_world::Lamp;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::sync::Arc;

/// In so many parts of the time that the shutter is open, a light that changes is as it is in their middles.
const PARTS: usize = 256;

/// The lights, with what their files hold; those that have tracks change while the shutter is open.
pub fn lamps(lights: &[AnyLight], tracks: &Tracks, files: Files<'_>) -> Vec<Lamp> {
    let lamp = |(i, light): (usize, &AnyLight)| {
        // What is wrong with files has been said.
        let keys = tracks.lights.get(&i).map(|keys| keys.iter().map(|key| loaded(i, key, files, &mut Vec::new())));
        let keys: Vec<AnyLight> = keys.into_iter().flatten().collect();
        let mut parts = (0..if keys.is_empty() { 0 } else { PARTS }).map(|part| at_part(&keys, part, light));
        match parts.next() {
            Some(first) => Lamp::moving(&first, &parts.collect::<Vec<_>>()),
            None => Lamp::from(light.clone()),
        }
    };
    lights.iter().enumerate().map(lamp).collect()
}

fn at_part(keys: &[AnyLight], part: usize, otherwise: &AnyLight) -> AnyLight {
    let place = (part as f64 + 0.5) / PARTS as f64 * (keys.len() - 1) as f64;
    let key = place as usize;
    let (Some(from), Some(to)) = (keys.get(key), keys.get(key + 1)) else { return otherwise.clone() };
    let mut from = from.clone();
    let Some(mut light) = between(&from, to, place - key as f64) else { return from };
    // What its file holds is not part of its description; the file is the same.
    if let (Some(to), Some(profile)) = (light.ies(), from.ies().and_then(|ies| ies.profile())) {
        to.set_profile(Arc::clone(profile));
    }
    light
}

/// The camera of this name at even times; nothing when it does not move, or is not the scene's.
pub fn camera(tracks: &Tracks, name: &str, scene: &Description) -> Vec<AnyCamera> {
    let single = scene.camera.is_some() && name == "camera";
    let keys = tracks.cameras.get(if single { "" } else { name });
    keys.into_iter().flatten().map(|key| (**key).clone()).collect()
}

/// A share of the way from one thing to another: every number of its description goes straight.
fn between<T: Serialize + DeserializeOwned>(from: &T, to: &T, share: f64) -> Option<T> {
    let (mut value, to) = (serde_json::to_value(from).ok()?, serde_json::to_value(to).ok()?);
    go(&mut value, &to, share)?;
    T::deserialize(&value).ok()
}

fn go(value: &mut Value, to: &Value, share: f64) -> Option<()> {
    match (value, to) {
        (Value::Number(from), Value::Number(to)) => {
            // Counts stay counts.
            if from != to && from.is_f64() {
                *from = serde_json::Number::from_f64(from.as_f64()? * (1.0 - share) + to.as_f64()? * share)?;
            }
            Some(())
        }
        (Value::Array(from), Value::Array(to)) if from.len() == to.len() => {
            from.iter_mut().zip(to).try_for_each(|(from, to)| go(from, to, share))
        }
        (Value::Object(from), Value::Object(to)) if from.len() == to.len() => {
            from.iter_mut().try_for_each(|(key, from)| go(from, to.get(key)?, share))
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

    fn place(lamp: &Lamp, time: f32) -> f32 {
        match &lamp.at(time).light {
            AnyLight::Point(point) => point.position.x,
            _ => panic!("no point"),
        }
    }

    fn lamps_of(still: &[AnyLight], moments: &[Vec<AnyLight>]) -> Vec<Lamp> {
        let mut tracks = Tracks::default();
        for i in 0..still.len() {
            let keys: Vec<Item<AnyLight>> = moments.iter().map(|lights| lights[i].clone().into()).collect();
            if keys.iter().any(|key| *key != still[i]) {
                tracks.lights.insert(i, keys);
            }
        }
        let (scene, sources, library) = Default::default();
        lamps(still, &tracks, Files { scene: &scene, sources: &sources, library: &library })
    }

    #[test]
    fn lights_go_from_moment_to_moment() {
        let moments = [lights(0.0, 1.0, 2), lights(4.0, 2.0, 2), lights(4.0, 3.0, 2)];
        let all = lamps_of(&moments[1], &moments);
        for (time, x) in [(0.0, 0.0), (0.25, 2.0), (0.5, 4.0), (0.99, 4.0)] {
            assert!((place(&all[0], time) - x).abs() < 0.02, "{time}");
        }
        assert!(all[0].moves() && all[1].moves());
        let still = lamps_of(&moments[0], &[lights(0.0, 1.0, 2), lights(0.0, 1.0, 2)]);
        assert!(!still[0].moves() && place(&still[0], 0.5) == 0.0);
        assert!(!lamps_of(&moments[0], &[])[0].moves());
        let counts = lamps_of(&moments[0], &[lights(0.0, 1.0, 2), lights(2.0, 1.0, 5)]);
        assert!((place(&counts[0], 0.5) - 1.0).abs() < 0.01);
    }
}
