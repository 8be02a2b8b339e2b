//! Tests of light trees against brute force.

use super::*;
use juggler_math::testing::{Random, chi_squared};
use juggler_math::{DVec3, Frame, Vec2, warp};

/// Random light in the cube of half edge `size`, with a box of up to `extent`.
fn any_light(random: &mut Random, size: f32, extent: f32) -> LightBounds {
    let (point_on_light, half) = (random.point(size), random.vec3() * extent);
    let half = if random.below(2) == 0 { Vec3::ZERO } else { half };
    let bounds = Aabb { min: point_on_light - half, max: point_on_light + half };
    let axis = [random.unit_vector(), Vec3::NEG_Y][random.below(2)];
    let (cos_theta_o, cos_theta_e) = match random.below(5) {
        0 => (-1.0, 0.0),
        1 => (1.0, 0.0),
        2 => (1.0, random.range(-1.0, 1.0)),
        3 => (1.0, 1.0 - random.f32() * 1e-4),
        _ => (random.range(-1.0, 1.0), random.range(-0.2, 1.0)),
    };
    let power = random.f32() * [1.0, 1e-6, 1e3][random.below(3)] + f32::MIN_POSITIVE;
    LightBounds { bounds, axis, cos_theta_o, cos_theta_e, power, two_sided: random.below(3) == 0 }
}

fn any_lights(random: &mut Random, count: usize) -> Vec<LightBounds> {
    let extent = [0.01, 0.5, 3.0][random.below(3)];
    (0..count).map(|_| any_light(random, 1.0, extent)).collect()
}

fn any_normal(random: &mut Random) -> Vec3 {
    if random.below(3) == 0 { Vec3::ZERO } else { random.unit_vector() }
}

fn point_light(position: Vec3, power: f32) -> LightBounds {
    let bounds = Aabb { min: position, max: position };
    LightBounds { bounds, axis: Vec3::Y, cos_theta_o: -1.0, cos_theta_e: 0.0, power, two_sided: false }
}

/// Whether a random point of the light with a random normal illuminates a point: the reference for
/// the bounds.
fn illuminates(random: &mut Random, light: &LightBounds, point: Vec3, normal: Vec3) -> bool {
    let fraction = (random.vec3() * 3.0 - 1.0).clamp(Vec3::ZERO, Vec3::ONE);
    let point_on_light =
        (light.bounds.min + light.bounds.extent() * fraction).clamp(light.bounds.min, light.bounds.max);
    let size = (1.0 - light.cos_theta_o) * if random.below(2) == 0 { 1.0 } else { random.f32() };
    let rim = Vec3::from((warp::uniform_cone(Vec2::new(1f32.next_down(), random.f32()), size).truncate(), 0.0));
    let from_axis = rim.with_z(1.0 - size);
    let mut emitted = Frame::around(light.axis).to_world(from_axis).as_dvec3().normalize();
    if light.two_sided && random.below(2) == 0 {
        emitted = -emitted;
    }
    let from_light: DVec3 = point.as_dvec3() - point_on_light.as_dvec3();
    let leaves = from_light.normalize_or_zero().dot(emitted) > f64::from(light.cos_theta_e);
    leaves && (normal == Vec3::ZERO || -from_light.dot(normal.as_dvec3()) > 0.0)
}

#[test]
fn solid_angle_of_all_normals_is_exactly_four_pi() {
    use std::f64::consts::PI;
    assert_eq!(child_bounds::solid_angle(PI, PI).to_bits(), (4.0 * PI).to_bits());
    assert_eq!(juggler_math::portable::acos_f64(-1.0).to_bits(), PI.to_bits());
}

#[test]
fn no_light_that_illuminates_has_probability_zero() {
    let mut random = Random::new(1001);
    let mut illuminated = 0;
    for round in 0..400 {
        let lights = any_lights(&mut random, [1, 5, 9, 40, 300][round % 5]);
        let tree = LightTree::build(&lights);
        for _ in 0..10 {
            let size = [0.5, 1.0, 1.5, 30.0][random.below(4)];
            let point = random.point(size);
            let normal = any_normal(&mut random);
            for _ in 0..40 {
                let index = random.below(lights.len());
                if illuminates(&mut random, &lights[index], point, normal) {
                    illuminated += 1;
                    let probability = tree.probability(point, normal, index as u32);
                    assert!(probability > 0.0, "{point} {normal} {:?}", lights[index]);
                }
            }
        }
    }
    assert!(illuminated > 30_000, "{illuminated}");
}

#[test]
fn probabilities_sum_to_one_and_equal_those_of_the_samples_to_the_bit() {
    let mut random = Random::new(1002);
    let mut sampled = 0;
    for round in 0..120 {
        let lights = any_lights(&mut random, [1, 2, 8, 9, 70, 600][round % 6]);
        let tree = LightTree::build(&lights);
        let (point, normal) = (random.point(1.5), any_normal(&mut random));
        let probability = |index: usize| f64::from(tree.probability(point, normal, index as u32));
        let sum: f64 = (0..lights.len()).map(probability).sum();
        assert!((sum - 1.0).abs() < 1e-5 || sum == 0.0, "{sum}");
        for i in 0..300 {
            let u = [0.0, 1f32.next_down()].get(i).copied().unwrap_or_else(|| random.f32());
            let Some(sample) = tree.sample(point, normal, u) else {
                assert_eq!(sum, 0.0);
                continue;
            };
            sampled += 1;
            assert!(sample.probability > 0.0 && (0.0..1.0).contains(&sample.u_remapped), "{sample:?}");
            let probability = tree.probability(point, normal, sample.index);
            assert_eq!(sample.probability.to_bits(), probability.to_bits(), "{sample:?} {probability}");
        }
    }
    assert!(sampled > 20_000, "{sampled}");
}

#[test]
fn samples_are_as_frequent_as_their_probabilities_and_remapped_numbers_are_uniform() {
    let mut random = Random::new(1003);
    for count in [3usize, 8, 50, 400] {
        let mut lights = any_lights(&mut random, count);
        lights[0].cos_theta_o = -1.0;
        let (tree, point, samples) = (LightTree::build(&lights), random.point(1.0), 1_000_000);
        let normal = (lights[0].bounds.center() - point).normalize();
        let (mut observed, mut remapped) = (vec![0.0; count], [0.0; 20]);
        for _ in 0..samples {
            let sample = tree.sample(point, normal, random.f32()).unwrap();
            observed[sample.index as usize] += 1.0;
            remapped[(sample.u_remapped * 20.0) as usize] += 1.0;
        }
        let probability = |i: usize| f64::from(tree.probability(point, normal, i as u32)) * f64::from(samples);
        chi_squared(&observed, &(0..count).map(probability).collect::<Vec<_>>(), 1e-3 / 8.0).unwrap();
        chi_squared(&remapped, &[f64::from(samples) / 20.0; 20], 1e-3 / 8.0).unwrap();
    }
}

#[test]
fn few_lights_are_sampled_by_power_cosine_and_distance() {
    let lights = [point_light(Vec3::new(3.0, 0.0, 4.0), 2.0), point_light(Vec3::new(0.0, 0.0, 2.0), 0.5)];
    let tree = LightTree::build(&lights);
    // The importances are 2/25 and 0.5/4; a normal along z multiplies them by 4/5 and 1.
    let near = |normal, expected: f32| (tree.probability(Vec3::ZERO, normal, 0) / expected - 1.0).abs() < 1e-4;
    assert!(near(Vec3::ZERO, 0.08 / 0.205) && near(Vec3::Z, 0.064 / 0.189));
    assert!(tree.sample(Vec3::ZERO, -Vec3::Z, 0.5).is_none() && tree.sample(Vec3::ZERO, Vec3::X, 0.9).is_some());
    assert_eq!(tree.probability(Vec3::ZERO, Vec3::ZERO, 2), 0.0);
}

#[test]
fn lights_that_cannot_emit_are_never_sampled() {
    let none = LightTree::build(&[]);
    assert!(none.sample(Vec3::ZERO, Vec3::Y, 0.3).is_none() && none.probability(Vec3::ZERO, Vec3::Y, 0) == 0.0);
    let mut lights: Vec<_> =
        [0.0, -1.0, f32::NAN, f32::INFINITY, 1.0].map(|power| point_light(Vec3::X * 3.0, power)).to_vec();
    lights.push(LightBounds { bounds: Aabb::EMPTY, ..lights[4] });
    lights.push(LightBounds { bounds: Aabb::INFINITE, ..lights[4] });
    lights.push(LightBounds { axis: Vec3::NAN, ..lights[4] });
    let tree = LightTree::build(&lights);
    for u in [0.0, 0.5, 0.999] {
        assert_eq!(tree.sample(Vec3::ZERO, Vec3::ZERO, u).unwrap().index, 4);
    }
    assert_eq!(LightTree::build(&lights[..4]).sample(Vec3::ZERO, Vec3::ZERO, 0.5), None);
}

#[test]
fn coincident_lights_are_sampled_uniformly_even_from_their_position() {
    let lights = vec![point_light(Vec3::new(1.0, 2.0, 3.0), 7.0); 1000];
    let tree = LightTree::build(&lights);
    for point in [Vec3::ZERO, Vec3::new(1.0, 2.0, 3.0), Vec3::splat(1e38), Vec3::splat(1e-38)] {
        for index in [0, 1, 500, 999] {
            let probability = tree.probability(point, Vec3::ZERO, index);
            assert!((probability * 1000.0 - 1.0).abs() < 1e-3, "{point}: {probability}");
        }
    }
}

#[test]
fn light_tree_probabilities_do_not_depend_on_scale() {
    let mut random = Random::new(1004);
    let lights = any_lights(&mut random, 200);
    let tree = LightTree::build(&lights);
    // 2^±50 is about 1e±15.
    for exponent in [-50i32, -3, 10, 50] {
        let size = f32::from_bits(((127 + exponent) as u32) << 23);
        let scaled = |light: &LightBounds| LightBounds {
            bounds: Aabb { min: light.bounds.min * size, max: light.bounds.max * size },
            power: light.power * 8.0,
            ..*light
        };
        let other = LightTree::build(&lights.iter().map(scaled).collect::<Vec<_>>());
        for _ in 0..300 {
            let (point, normal, u) = (random.point(2.0), any_normal(&mut random), random.f32());
            assert_eq!(tree.sample(point, normal, u), other.sample(point * size, normal, u), "{exponent}");
        }
    }
}

#[test]
fn extreme_lights_give_finite_probabilities() {
    let mut random = Random::new(1005);
    let number = |random: &mut Random| {
        let exponent = random.range(-15.0, 15.0);
        random.range(-1.0, 1.0) * juggler_math::portable::powf(10.0, exponent)
    };
    let vector = |random: &mut Random| Vec3::new(number(random), number(random), number(random));
    let lights: Vec<_> = (0..500)
        .map(|_| {
            let bounds = Aabb::from_points([vector(&mut random), vector(&mut random)]);
            LightBounds { bounds, power: number(&mut random).abs(), ..any_light(&mut random, 1.0, 1.0) }
        })
        .collect();
    let tree = LightTree::build(&lights);
    for _ in 0..5000 {
        let (point, normal) = (vector(&mut random), any_normal(&mut random));
        if let Some(sample) = tree.sample(point, normal, random.f32()) {
            assert!(sample.probability > 0.0 && sample.probability <= 1.0 && sample.u_remapped < 1.0, "{sample:?}");
        }
        let sum: f64 = (0..500).map(|i| f64::from(tree.probability(point, normal, i))).sum();
        assert!((sum - 1.0).abs() < 1e-5 || sum == 0.0, "{point} {normal} {sum}");
    }
}

/// Lights at distances that halve repeatedly make deep trees.
#[test]
fn depth_is_bounded() {
    let mut lights: Vec<_> = (0..150).map(|i| point_light(Vec3::X * 0.5f32.powi(i), 1.0)).collect();
    lights.extend((0..20_000).map(|i| point_light(Vec3::X * (1e-30 * i as f32), 1.0)));
    let tree = LightTree::build(&lights);
    let sum: f64 = (0..20_150).map(|i| f64::from(tree.probability(Vec3::Y, Vec3::ZERO, i))).sum();
    assert!((sum - 1.0).abs() < 1e-4, "{sum}");
    assert!(tree.heap_bytes() < 20_150 * 300, "{}", tree.heap_bytes());
}

/// Variance of the one-sample estimator relative to the squared true value, with probabilities
/// summed over all lights.
fn relative_variance(lights: &[LightBounds], point: Vec3, normal: Vec3, probability: impl Fn(usize) -> f64) -> f64 {
    let contribution = |light: &LightBounds| {
        let to_light = light.bounds.center() - point;
        let squared = f64::from(to_light.length_squared());
        let cosine = f64::from(to_light.normalize().dot(normal)).max(0.0);
        let leaving = f64::from(-to_light.normalize().dot(light.axis)).max(0.0);
        let emission = if light.cos_theta_o < 0.0 { 1.0 } else { leaving };
        f64::from(light.power) * emission * cosine / squared
    };
    let truth: f64 = lights.iter().map(contribution).sum();
    let squares = lights.iter().enumerate().filter(|(_, light)| contribution(light) > 0.0);
    squares.map(|(i, light)| contribution(light) * contribution(light) / probability(i)).sum::<f64>() / (truth * truth)
        - 1.0
}

#[test]
fn light_tree_has_lower_variance_than_power_sampling() {
    let mut random = Random::new(1006);
    // Downlights below a ceiling, and point lights.
    let downlight = |random: &mut Random| {
        let position = Vec3::new(random.range(-20.0, 20.0), random.range(2.5, 3.0), random.range(-20.0, 20.0));
        let cos_theta_o = if random.below(4) == 0 { -1.0 } else { 1.0 };
        LightBounds { axis: Vec3::NEG_Y, cos_theta_o, ..point_light(position, random.range(0.5, 2.0)) }
    };
    let lights: Vec<_> = (0..2000).map(|_| downlight(&mut random)).collect();
    let tree = LightTree::build(&lights);
    let total: f64 = lights.iter().map(|light| f64::from(light.power)).sum();
    let (mut by_tree, mut by_power) = (0.0, 0.0);
    for _ in 0..100 {
        let point = Vec3::new(random.range(-20.0, 20.0), random.range(0.0, 2.0), random.range(-20.0, 20.0));
        let normal = Frame::around(Vec3::Y).to_world(warp::cosine_hemisphere(random.vec2()));
        let probability = |i: usize| f64::from(tree.probability(point, normal, i as u32));
        by_tree += relative_variance(&lights, point, normal, probability);
        by_power += relative_variance(&lights, point, normal, |i| f64::from(lights[i].power) / total);
    }
    assert!(by_tree * 100.0 < by_power, "{by_tree} {by_power}");
}

#[test]
fn light_tree_has_low_variance_among_randomly_oriented_lights() {
    let mut random = Random::new(1007);
    let flat = |random: &mut Random| {
        let position = Vec3::from_array([0; 3].map(|_| random.range(-1.0, 1.0)));
        let axis = random.unit_vector();
        LightBounds { axis, cos_theta_o: 1.0, ..point_light(position, random.range(0.5, 2.0)) }
    };
    let lights: Vec<_> = (0..2000).map(|_| flat(&mut random)).collect();
    let tree = LightTree::build(&lights);
    let mut variance = |reach: f32| {
        let of_point = |random: &mut Random| {
            let point = Vec3::from_array([0; 3].map(|_| random.range(-reach, reach)));
            let normal = random.unit_vector();
            relative_variance(&lights, point, normal, |i| f64::from(tree.probability(point, normal, i as u32)))
        };
        // NaN where no light arrives.
        let all: Vec<f64> = (0..300).map(|_| of_point(&mut random)).filter(|one| one.is_finite()).collect();
        assert!(all.len() > 200);
        all.iter().sum::<f64>() / all.len() as f64
    };
    let (among, around) = (variance(1.0), variance(4.0));
    assert!(among < 1.2 && around < 0.3, "{among} {around}");
}
