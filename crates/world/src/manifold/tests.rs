//! Compares paths with rays that are reflected and refracted step by step in double precision.

use super::*;
use juggler_math::DVec3;
use juggler_math::testing::Random;

const IORS: [f32; 4] = [1.05, 1.33, 1.5, 2.42];

/// Traces a ray through the unit sphere: point and direction at which it leaves.
fn through(origin: DVec3, direction: DVec3, kind: SpecularPath) -> Option<(DVec3, DVec3)> {
    let enter = |origin: DVec3, direction: DVec3| {
        let b = origin.dot(direction);
        let discriminant = b * b - origin.length_squared() + 1.0;
        (discriminant > 0.0 && b < 0.0).then(|| origin + direction * (-b - discriminant.sqrt()))
    };
    let first = enter(origin, direction)?;
    let cos = -direction.dot(first);
    let SpecularPath::Refracted { ior } = kind else {
        return Some((first, direction + first * (2.0 * cos)));
    };
    let refract = |direction: DVec3, normal: DVec3, ratio: f64| {
        let cos = -direction.dot(normal);
        let squared = 1.0 - ratio * ratio * (1.0 - cos * cos);
        direction * ratio + normal * (ratio * cos - squared.sqrt())
    };
    let ior = f64::from(ior);
    let inside = refract(direction, first, 1.0 / ior);
    let last = first - inside * (2.0 * inside.dot(first));
    Some((last, refract(inside, -last, ior)))
}

fn kinds() -> Vec<SpecularPath> {
    let refracted = IORS.map(|ior| SpecularPath::Refracted { ior });
    std::iter::once(SpecularPath::Reflected).chain(refracted).collect()
}

const UNIT: SpecularSphere = SpecularSphere { center: Vec3::ZERO, radius: 1.0 };

fn random_point(random: &mut Random) -> Vec3 {
    let distance = 1.01 + 5.0 * random.f32().powi(3);
    random.unit_vector() * distance
}

#[test]
fn specular_paths_connect_both_end_points() {
    let mut random = Random::new(2601);
    for kind in kinds() {
        let mut found = 0;
        for _ in 0..5000 {
            let (from, to) = (random_point(&mut random), random_point(&mut random));
            let ends = [from, to].map(|point| UNIT.end_point(point).unwrap());
            // Rounding may make a grazing ray miss.
            let found_paths = connections(kind, &ends[0], &ends[1]);
            for connection in found_paths.iter().filter(|found| found.sine < 0.9999) {
                found += 1;
                let (last, direction) = through(from.as_dvec3(), connection.direction.as_dvec3(), kind).unwrap();
                // Distance by which the ray misses the end point, and how much rounding the path
                // amplifies.
                let missed = (to.as_dvec3() - last).cross(direction).length();
                let ratio = f64::from(solid_angle_ratio(kind, &ends[0], &ends[1], connection.sine));
                let amplification = 1.0 + ratio.max(1.0 / (1.0 - f64::from(connection.sine)));
                assert!(missed < 2e-4 * amplification, "{kind:?} {from} {to}: {connection:?} misses by {missed}");
                assert!(
                    (connection.vertices[1].as_dvec3() - last).length() < 2e-4 * amplification,
                    "{kind:?} {connection:?} {last}"
                );
            }
        }
        assert!(found > 500, "{kind:?}: {found}");
    }
}

#[test]
fn no_path_is_missed() {
    let mut random = Random::new(2602);
    for kind in kinds() {
        let (mut lost, mut all) = (0, 0);
        while all < 20_000 {
            let from = random_point(&mut random);
            let aim = random.unit_vector();
            let direction = (aim - from).normalize();
            let Some((last, onwards)) = through(from.as_dvec3(), direction.as_dvec3(), kind) else { continue };
            let to = (last + onwards * f64::from(random.range(0.01, 4.0))).as_vec3();
            let ends = [UNIT.end_point(from), UNIT.end_point(to)];
            let [Some(from), Some(to)] = ends else { continue };
            all += 1;
            let near = |connection: &Connection| (connection.direction - direction).length() < 3e-3;
            lost += u32::from(!connections(kind, &from, &to).iter().any(near));
        }
        // Rounding may lose two paths that are about to merge.
        assert!(lost <= 10, "{kind:?}: {lost} of {all}");
    }
}

#[test]
fn solid_angle_ratios_equal_finite_differences() {
    let mut random = Random::new(2603);
    for kind in kinds() {
        let mut checked = 0;
        while checked < 2000 {
            let (from, aim) = (random_point(&mut random), random.unit_vector() * 0.97);
            let direction = (aim - from).normalize().as_dvec3();
            let (x, y) = direction.any_orthonormal_pair();
            let step = 1e-5;
            let Some((last, onwards)) = through(from.as_dvec3(), direction, kind) else { continue };
            let length = f64::from(random.range(0.05, 3.0));
            let to = last + onwards * length;
            // Where neighboring rays cross the plane orthogonal to the path.
            let across = |offset: DVec3| {
                let (last, direction) = through(from.as_dvec3(), (direction + offset * step).normalize(), kind)?;
                let t = (to - last).dot(onwards) / direction.dot(onwards);
                Some(last + direction * t)
            };
            let places = [x, -x, y, -y].map(across);
            let [Some(right), Some(left), Some(up), Some(down)] = places else { continue };
            let area = ((right - left).cross(up - down) / (4.0 * step * step)).dot(onwards).abs();
            let expected = area / to.length_squared();
            let ends = [from, to.as_vec3()].map(|point| UNIT.end_point(point));
            let [Some(near), Some(far)] = ends else { continue };
            let sine = from.as_dvec3().cross(direction).length() as f32;
            let stated = f64::from(solid_angle_ratio(kind, &near, &far, sine));
            checked += 1;
            let close = (stated - expected).abs() <= 5e-3 * expected + 2e-3;
            assert!(close, "{kind:?} {from} {to}: {stated} instead of {expected}, sine {sine}");
        }
    }
}

#[test]
fn end_point_at_infinity_equals_a_distant_end_point() {
    let mut random = Random::new(2604);
    for kind in kinds() {
        for _ in 0..500 {
            let (from, toward) = (UNIT.end_point(random_point(&mut random)).unwrap(), random.unit_vector());
            let (infinite, far) = (EndPoint::infinity(toward), UNIT.end_point(toward * 1e6).unwrap());
            let (a, b) = (connections(kind, &from, &infinite), connections(kind, &from, &far));
            for (a, b) in a.iter().zip(&b).filter(|_| a.len() == b.len()) {
                assert!((a.direction - b.direction).length() < 1e-3, "{a:?} {b:?}");
            }
        }
    }
}
