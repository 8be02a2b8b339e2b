use super::super::testing::{random_f64, random_rotation};
use super::*;
use juggler_math::testing::Random;

fn curve(times: &[f32], values: &[f32], components: usize, interpolation: Interpolation) -> Curve {
    Curve::new(times.to_vec(), values.to_vec(), components, interpolation).unwrap()
}

fn rotations(times: &[f32], rotations: &[DQuat]) -> Curve {
    let values: Vec<f32> = rotations.iter().flat_map(|q| q.as_quat().to_array()).collect();
    curve(times, &values, 4, Interpolation::Linear)
}

/// Rotation of a curve whose keys are at 0 and 1 s.
fn halfway(from: DQuat, to: DQuat, seconds: f64) -> DQuat {
    rotations(&[0.0, 1.0], &[from, to]).rotation(seconds).unwrap()
}

/// Angle between two rotations in degrees, accurate for small and large angles.
fn degrees_between(a: DQuat, b: DQuat) -> f64 {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    4.0 * (a - b).length().atan2((a + b).length()).to_degrees()
}

fn about(axis: DVec3, degrees: f64) -> DQuat {
    quaternion::from_axis_degrees(axis, degrees).unwrap()
}

#[test]
fn steps_hold_and_lines_connect() {
    let (times, values) = ([1.0, 2.0, 4.0], [10.0, 1.0, 20.0, 2.0, -20.0, 4.0]);
    let step = curve(&times, &values, 2, Interpolation::Step);
    let linear = curve(&times, &values, 2, Interpolation::Linear);
    for (seconds, held, between) in [
        (-5.0, [10.0, 1.0], [10.0, 1.0]),
        (1.0, [10.0, 1.0], [10.0, 1.0]),
        (1.25, [10.0, 1.0], [12.5, 1.25]),
        (2.0, [20.0, 2.0], [20.0, 2.0]),
        (3.5, [20.0, 2.0], [-10.0, 3.5]),
        (4.0, [-20.0, 4.0], [-20.0, 4.0]),
        (f64::INFINITY, [-20.0, 4.0], [-20.0, 4.0]),
        (f64::NAN, [10.0, 1.0], [10.0, 1.0]),
    ] {
        assert_eq!(step.evaluate(seconds), held, "{seconds}");
        assert_eq!(linear.evaluate(seconds), between, "{seconds}");
    }
    assert_eq!(linear.vector(1.25), DVec3::new(12.5, 1.25, 0.0));
    assert_eq!((linear.first_time(), linear.last_time()), (1.0, 4.0));
}

#[test]
fn splines_follow_their_formula() {
    let mut random = Random::new(21);
    for _ in 0..100 {
        let times = [0.5, 0.5 + random.range(0.1, 3.0)];
        let values: Vec<f32> = (0..12).map(|_| random.range(-5.0, 5.0)).collect();
        let spline = curve(&times, &values, 2, Interpolation::CubicSpline);
        let duration = f64::from(times[1]) - f64::from(times[0]);
        for _ in 0..20 {
            let s = random_f64(&mut random, 0.0, 1.0);
            let found = spline.evaluate(f64::from(times[0]) + s * duration);
            for (component, found) in found.iter().enumerate() {
                // Per key: in-tangents, values, out-tangents, of two components each.
                let [v0, b0, a1, v1] = [2, 4, 6, 8].map(|i| f64::from(values[i + component]));
                let expected = (2.0 * s.powi(3) - 3.0 * s.powi(2) + 1.0) * v0
                    + duration * (s.powi(3) - 2.0 * s.powi(2) + s) * b0
                    + (-2.0 * s.powi(3) + 3.0 * s.powi(2)) * v1
                    + duration * (s.powi(3) - s.powi(2)) * a1;
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        }
    }
}

#[test]
fn splines_reproduce_cubic_polynomials() {
    let polynomial = |t: f64| ((0.5 * t - 2.0) * t + 1.0) * t + 3.0;
    let slope = |t: f64| (1.5 * t - 4.0) * t + 1.0;
    let times = [0.0_f32, 0.5, 2.0, 3.0, 3.25];
    let keys = times.iter().map(|t| f64::from(*t));
    let values: Vec<f32> = keys.flat_map(|t| [slope(t), polynomial(t), slope(t)].map(|v| v as f32)).collect();
    let spline = curve(&times, &values, 1, Interpolation::CubicSpline);
    for step in 0..=130 {
        let t = f64::from(step) / 40.0;
        assert!((spline.evaluate(t)[0] - polynomial(t)).abs() < 1e-6, "{t}");
    }
}

#[test]
fn rotations_turn_at_constant_speed_along_the_shorter_arc() {
    let mut random = Random::new(22);
    for _ in 0..100 {
        let (from, axis) = (random_rotation(&mut random), random.unit_vector().as_dvec3());
        for degrees in [0.5, 3.0, 5.0, 90.0, 179.0, 181.0, 270.0, 357.0] {
            let to = about(axis, degrees) * from;
            let shorter = if degrees > 180.0 { 360.0 - degrees } else { degrees };
            for fraction in [0.0, 0.1, 0.25, 0.5, 0.8, 1.0] {
                let q = halfway(from, to, fraction);
                let found = degrees_between(from.as_quat().as_dquat(), q);
                // Below 3.6 degrees quaternions are interpolated linearly; keys are rounded.
                assert!((found - fraction * shorter).abs() < 1e-4, "{degrees} {fraction}: {found}");
                assert!((q.length() - 1.0).abs() < 1e-14);
            }
        }
    }
}

#[test]
fn linear_and_spherical_interpolation_meet() {
    // Angles just below and just above the limit of linear interpolation.
    for fraction in [0.1, 0.25, 0.5, 0.7] {
        let [below, above] = [3.62, 3.63].map(|degrees| {
            let q = halfway(DQuat::IDENTITY, about(DVec3::Y, degrees), fraction);
            degrees_between(DQuat::IDENTITY, q) / degrees
        });
        assert!((below - above).abs() < 5e-5, "{fraction}: {below} {above}");
    }
}

#[test]
fn half_turns_and_antipodal_keys_have_a_result() {
    let half_turn = about(DVec3::Z, 180.0);
    for (from, to) in [(DQuat::IDENTITY, half_turn), (half_turn, DQuat::IDENTITY), (half_turn, about(DVec3::X, 180.0))]
    {
        let middle = halfway(from, to, 0.5);
        assert!((degrees_between(from, middle) - 90.0).abs() < 1e-4);
        assert!((degrees_between(to, middle) - 90.0).abs() < 1e-4);
    }
    let mut random = Random::new(23);
    for _ in 0..100 {
        // One rotation by two quaternions: nothing turns.
        let q = random_rotation(&mut random);
        for fraction in [0.0, 0.3, 0.5, 0.9] {
            assert!(degrees_between(q, halfway(q, -q, fraction)) < 2e-5);
        }
    }
}

#[test]
fn splines_of_rotations_are_normalized() {
    let q = about(DVec3::new(1.0, -2.0, 0.5), 50.0).as_quat().to_array();
    let [zero, tangent] = [[0.0; 4], [3.0, 0.0, -1.0, 0.5]];
    let values = [zero, [0.0, 0.0, 0.0, 1.0], tangent, tangent, q, zero].concat();
    let spline = curve(&[0.0, 2.0], &values, 4, Interpolation::CubicSpline);
    for step in 0..=20 {
        let seconds = 0.1 * f64::from(step);
        let [x, y, z, w] = spline.evaluate(seconds)[..] else { panic!("four components") };
        let expected = DQuat::from_xyzw(x, y, z, w).normalize();
        assert!((spline.rotation(seconds).unwrap() - expected).length() < 1e-14);
    }
    // From q to -q the spline passes through 0.
    let opposite = q.map(|number| -number);
    let crossing = curve(&[0.0, 1.0], &[zero, q, zero, zero, opposite, zero].concat(), 4, Interpolation::CubicSpline);
    assert!(degrees_between(crossing.rotation(0.5).unwrap(), quaternion::normalized(q.map(f64::from)).unwrap()) < 1e-4);
}

#[test]
fn single_keys_are_constant() {
    for interpolation in [Interpolation::Step, Interpolation::Linear, Interpolation::CubicSpline] {
        let numbers = 4 * interpolation.elements_per_key();
        let constant = curve(&[2.0], &vec![0.5; numbers], 4, interpolation);
        for seconds in [-1.0, 2.0, 5.0] {
            assert_eq!(constant.evaluate(seconds), [0.5; 4]);
            assert_eq!(constant.rotation(seconds).unwrap(), DQuat::from_xyzw(0.5, 0.5, 0.5, 0.5));
        }
    }
}

#[test]
fn equal_keys_jump_to_the_later() {
    let jump = curve(&[0.0, 1.0, 1.0, 1.0, 2.0], &[0.0, 1.0, 50.0, 7.0, 9.0], 1, Interpolation::Linear);
    assert_eq!(jump.equal_keys(), 2);
    for (seconds, expected) in [(0.5, 0.5), (1.0, 7.0), (1.5, 8.0), (2.0, 9.0)] {
        assert_eq!(jump.evaluate(seconds), [expected]);
    }
    assert!((jump.evaluate(1.0_f64.next_down())[0] - 1.0).abs() < 1e-9);
    let ends = curve(&[1.0, 1.0, 2.0, 2.0], &[5.0, 6.0, 7.0, 8.0], 1, Interpolation::Linear);
    assert_eq!([0.0, 1.0, 2.0, 3.0].map(|seconds| ends.evaluate(seconds)[0]), [6.0, 6.0, 8.0, 8.0]);
    let on = curve(&[0.0, 1.0], &[0.0, 1.0], 1, Interpolation::Linear);
    assert_eq!([0.0, 0.9, 1.0].map(|seconds| on.is_on(seconds)), [false, false, true]);
}

#[test]
fn malformed_keys_are_refused() {
    let refuse = |times: &[f32], values: &[f32], interpolation| {
        Curve::new(times.to_vec(), values.to_vec(), 1, interpolation).unwrap_err()
    };
    let linear = Interpolation::Linear;
    assert_eq!(refuse(&[], &[], linear), CurveError::NoKeys);
    let error = refuse(&[0.0, 2.0, 1.5], &[0.0; 3], linear);
    assert_eq!(error, CurveError::Falling { key: 2, time: 1.5, previous: 2.0 });
    assert_eq!(error.to_string(), "key 2 is at 1.5 s, after a key at 2 s; times must rise");
    assert_eq!(refuse(&[0.0, 1.0], &[0.0; 3], linear), CurveError::Count { keys: 2, found: 3, expected: 2 });
    let count = refuse(&[0.0, 1.0], &[0.0; 2], Interpolation::CubicSpline);
    assert_eq!(count, CurveError::Count { keys: 2, found: 2, expected: 6 });
    assert!(matches!(refuse(&[0.0, f32::NAN], &[0.0; 2], linear), CurveError::Time { key: 1, .. }));
    assert!(matches!(refuse(&[f32::INFINITY], &[0.0], linear), CurveError::Time { key: 0, .. }));
    let nan = refuse(&[0.0, 1.0], &[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0], Interpolation::CubicSpline);
    assert!(matches!(nan, CurveError::Value { key: 1, .. }));
    assert!(Curve::new(vec![0.0], Vec::new(), usize::MAX, Interpolation::CubicSpline).is_err());
}

#[test]
fn zero_and_long_quaternions_are_found() {
    let zero = curve(&[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0], 4, Interpolation::Linear);
    assert_eq!(zero.check_rotations(), Err(CurveError::ZeroRotation { key: 1 }));
    assert_eq!((zero.rotation(0.5), zero.rotation(1.0)), (None, None));
    let long = curve(&[0.0, 1.0], &[0.0, 0.0, 0.0, 1.0005, 0.0, 3.0, 0.0, 0.0], 4, Interpolation::Step);
    assert_eq!((long.check_rotations(), long.unnormalized_rotations()), (Ok(()), 1));
    assert_eq!(long.rotation(1.0), Some(DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0)));
}

#[test]
fn extreme_keys_stay_finite() {
    let values = [f32::MAX, -f32::MAX, f32::MAX, f32::MIN, f32::MAX, f32::MIN];
    for times in [[f32::MIN, f32::MAX], [0.0, f32::from_bits(1)], [1e30, 2e30]] {
        let spline = curve(&times, &values, 1, Interpolation::CubicSpline);
        for fraction in [0.0, 1e-9, 0.3, 0.9, 1.0] {
            let seconds = f64::from(times[0]) + fraction * (f64::from(times[1]) - f64::from(times[0]));
            assert!(spline.evaluate(seconds)[0].is_finite());
        }
    }
}
