//! Contract tests of all backgrounds.

use super::*;
use juggler_math::testing::{Random, chi_squared, z_test};
use juggler_math::{DVec3, Frame, portable};

const SAMPLES: u32 = 1_000_000;
/// Significance level of each test: 1e-3 for all examples together.
const SIGNIFICANCE: f64 = 5e-5;

/// Cells of equal solid angle: bands of height by azimuths.
const BANDS: usize = 12;
const AZIMUTHS: usize = 24;

fn cell(direction: Vec3) -> usize {
    let index = |fraction: f32, count: usize| ((fraction * count as f32) as usize).min(count - 1);
    index(direction.y * 0.5 + 0.5, BANDS) * AZIMUTHS + index(direction_table::azimuth_turns(direction), AZIMUTHS)
}

/// Uniform grid of directions, `elevation_gradient` by `azimuths` in each cell.
fn grid(elevation_gradient: usize, azimuths: usize) -> impl Iterator<Item = Vec3> {
    let (rows, columns) = (BANDS * elevation_gradient, AZIMUTHS * azimuths);
    let azimuth = move |i: usize| ((i % columns) as f32 + 0.5) / columns as f32;
    let height = move |i: usize| ((i / columns) as f64 + 0.5) / rows as f64 * 2.0 - 1.0;
    (0..rows * columns).map(move |i| direction_table::direction(azimuth(i), height(i)))
}

/// Whether a density belongs to the sun's disk.
fn is_sun(background: &AnyBackground, pdf: f32) -> bool {
    matches!(background, AnyBackground::Sky(_)) && pdf > 500.0
}

/// The number of samples in each cell matches the integral of the density on a fine grid. Samples
/// of the sun's disk, which the grid misses, are counted separately against its probability.
#[test]
fn samples_follow_the_density_which_integrates_to_one() {
    for (number, background) in AnyBackground::examples().into_iter().enumerate() {
        let mut random = Random::new(103 + number as u64);
        let mut observed = vec![0.0; BANDS * AZIMUTHS + 1];
        let (mut disk, mut none, mut apart) = (Vec::new(), 0, 0);
        for _ in 0..SAMPLES {
            let Some(sample) = background.sample(random.vec2()) else {
                none += 1;
                continue;
            };
            let pdf = background.pdf(sample.wi);
            apart += u32::from((pdf / sample.pdf - 1.0).abs() > 1e-3);
            if is_sun(&background, pdf) {
                disk.push(sample.wi);
            } else {
                observed[cell(sample.wi)] += 1.0;
            }
        }
        if background.mean_radiance().is_black() {
            assert!(none == SAMPLES && background.pdf(Vec3::X) == 0.0, "{}", name(&background));
            continue;
        }
        // The density of a sample equals that of its direction, except for rounding across cell
        // boundaries.
        assert!(none == 0 && apart < SAMPLES / 500, "{}: {none} {apart}", name(&background));
        // A table column spans a whole number of grid columns; a table row does not match grid
        // rows.
        let size = 4.0 * std::f64::consts::PI / (BANDS * AZIMUTHS * 120 * 24) as f64;
        let mut expected = vec![0.0; BANDS * AZIMUTHS + 1];
        for direction in grid(120, 24) {
            let pdf = background.pdf(direction);
            if !is_sun(&background, pdf) {
                expected[cell(direction)] += f64::from(pdf) * size * f64::from(SAMPLES);
            }
        }
        let rest: f64 = expected.iter().sum();
        let sun = disk.len() as f64;
        let chance = 1.0 - sun / f64::from(SAMPLES);
        assert!((rest / f64::from(SAMPLES) - chance).abs() < 4e-3, "{}: {rest} {sun}", name(&background));
        let fit = (f64::from(SAMPLES) - sun) / rest;
        expected.iter_mut().for_each(|cell| *cell *= fit);
        chi_squared(&observed, &expected, SIGNIFICANCE)
            .unwrap_or_else(|error| panic!("{}: {error}", name(&background)));
        fills_its_disk(&disk).unwrap_or_else(|error| panic!("{}: {error}", name(&background)));
    }
}

/// Directions to a small disk are uniform: 4 rings of equal area by 8 sectors. The center of the
/// disk is the mean direction, its rim the farthest direction.
fn fills_its_disk(directions: &[Vec3]) -> Result<(), String> {
    if directions.len() < 1000 {
        return Ok(());
    }
    let axis = directions.iter().map(|w| w.as_dvec3()).sum::<DVec3>().normalize();
    let frame = Frame::around(axis.as_vec3());
    let squared = |w: &Vec3| w.as_dvec3().distance_squared(axis);
    let most = directions.iter().map(squared).fold(0.0, f64::max);
    let mut observed = [0.0; 32];
    for w in directions {
        let azimuth = portable::atan2(w.dot(frame.bitangent), w.dot(frame.tangent)) / std::f32::consts::TAU;
        let ring = ((squared(w) / most * 4.0) as usize).min(3);
        observed[ring * 8 + ((azimuth.rem_euclid(1.0) * 8.0) as usize).min(7)] += 1.0;
    }
    chi_squared(&observed, &[directions.len() as f64 / 32.0; 32], SIGNIFICANCE)
}

fn name(background: &AnyBackground) -> String {
    format!("{background:?}").chars().take(60).collect()
}

#[test]
fn samples_give_the_mean() {
    for (number, background) in AnyBackground::examples().into_iter().enumerate() {
        let mut random = Random::new(153 + number as u64);
        let mut values = Vec::new();
        for _ in 0..SAMPLES / 4 {
            let value = background.sample(random.vec2()).map_or(0.0, |sample| {
                let radiance = background.radiance(&Ray::new(Vec3::ZERO, sample.wi)).luminance();
                assert!(sample.wi.is_normalized() && sample.pdf > 0.0 && radiance.is_finite());
                f64::from(radiance / sample.pdf)
            });
            values.push(value);
        }
        let mean = f64::from(background.mean_radiance().luminance()) * 4.0 * std::f64::consts::PI;
        let measured = values.iter().sum::<f64>() / values.len() as f64;
        // Means of environment maps and skies are sums over cells.
        let near = (measured - mean).abs() < 5e-3 * mean || z_test(&values, mean, SIGNIFICANCE).is_ok();
        assert!(near, "{}: {measured} {mean}", name(&background));
        let radius = 3.0f32;
        let power = mean * std::f64::consts::PI * f64::from(radius * radius);
        assert!((f64::from(background.power(radius)) - power).abs() <= 1e-5 * power);
    }
}

/// The density is above 0 wherever there is light, tested on a grid.
#[test]
fn there_is_a_density_wherever_there_is_light() {
    for background in AnyBackground::examples() {
        for direction in grid(5, 5) {
            let light = background.radiance(&Ray::new(Vec3::ZERO, direction));
            assert!(light.is_black() || background.pdf(direction) > 0.0, "{background:?} {direction}");
        }
    }
}

#[test]
fn light_is_finite_and_never_negative() {
    let mut random = Random::new(102);
    for background in AnyBackground::examples() {
        background.check().unwrap();
        for size in [0.0, 1.0, 1e6, 1e18, 1e30] {
            for _ in 0..200 {
                let ray = Ray::new(random.point(size), random.unit_vector());
                let light = background.radiance(&ray);
                assert!(
                    light.to_array().iter().all(|v| *v >= 0.0 && v.is_finite()),
                    "{background:?} {ray:?} {light:?}"
                );
            }
        }
    }
    let lost = Ray::new(Vec3::splat(f32::INFINITY), Vec3::Y);
    assert!(Dome::default().radiance(&lost).is_finite());
}

#[test]
fn json_round_trips() {
    for background in AnyBackground::examples() {
        let text = serde_json::to_string(&background).unwrap();
        let again = serde_json::from_str::<AnyBackground>(&text).unwrap();
        assert!(text.starts_with(&format!("{{\"{}\":", background.name())), "{text}");
        assert_eq!(serde_json::to_string(&again).unwrap(), text);
        if !matches!(background, AnyBackground::Environment(_)) {
            let mut again = again;
            again.prepare().unwrap();
            assert_eq!(again, background, "{text}");
        }
    }
}

#[test]
fn invalid_fields_are_named() {
    for (json, field) in [
        (r#"{"solid": {"color": [0, -1, 0]}}"#, "color"),
        (r#"{"gradient": {"zenith": [1e39, 0, 0]}}"#, "zenith"),
        (r#"{"gradient": {"nadir": [-1, 0, 0]}}"#, "nadir"),
        (r#"{"gradient": {"axis": [0, 0, 0]}}"#, "axis"),
        (r#"{"dome": {"radius": 0}}"#, "radius"),
        (r#"{"dome": {"top": [0, 0, -2]}}"#, "top"),
        (r#"{"environment": {"file": "a", "scale": -1}}"#, "scale"),
        (r#"{"environment": {"file": "a", "rotation_degrees": 1e30}}"#, "rotation_degrees"),
        (r#"{"environment": {"file": "a", "up": [0, 0, 0]}}"#, "up"),
        (r#"{"environment": {"file": "a", "visible_as": [0, -1, 0]}}"#, "visible_as"),
        (r#"{"studio": {"scale": -1}}"#, "scale"),
        (r#"{"studio": {"rotation_degrees": 1e30}}"#, "rotation_degrees"),
        (r#"{"studio": {"up": [0, 0, 0]}}"#, "up"),
        (r#"{"studio": {"visible_as": [-1, 0, 0]}}"#, "visible_as"),
        (r#"{"sky": {"turbidity": 0.5}}"#, "turbidity"),
        (r#"{"sky": {"sun_elevation_degrees": 91}}"#, "sun_elevation_degrees"),
        (r#"{"sky": {"sun_azimuth_degrees": 1e9}}"#, "sun_azimuth_degrees"),
        (r#"{"sky": {"sun_direction": [0, 0, 0]}}"#, "sun_direction"),
        (r#"{"sky": {"ground_albedo": [0, 2, 0]}}"#, "ground_albedo"),
        (r#"{"sky": {"intensity": -1}}"#, "intensity"),
        (r#"{"sky": {"up": [0, 1e39, 0]}}"#, "up"),
    ] {
        let error = serde_json::from_str::<AnyBackground>(json).unwrap().check().unwrap_err();
        assert_eq!(error.field, field, "{json}");
    }
}
