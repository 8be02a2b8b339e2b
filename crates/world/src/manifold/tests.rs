//! Ways against rays that are mirrored and refracted step by step in double precision.

use super::*;
use juggler_math::DVec3;
use juggler_math::testing::Random;

const IORS: [f32; 4] = [1.05, 1.33, 1.5, 2.42];

/// Where a ray leaves a ball of radius 1 around the origin that it meets, and in which direction.
fn through(origin: DVec3, direction: DVec3, way: Way) -> Option<(DVec3, DVec3)> {
    let enter = |origin: DVec3, direction: DVec3| {
        let b = origin.dot(direction);
        let discriminant = b * b - origin.length_squared() + 1.0;
        (discriminant > 0.0 && b < 0.0).then(|| origin + direction * (-b - discriminant.sqrt()))
    };
    let first = enter(origin, direction)?;
    let cos = -direction.dot(first);
    let Way::Refracted { ior } = way else {
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

fn ways() -> Vec<Way> {
    let refracted = IORS.map(|ior| Way::Refracted { ior });
    std::iter::once(Way::Mirrored).chain(refracted).collect()
}

const UNIT: Ball = Ball { center: Vec3::ZERO, radius: 1.0 };

fn place(random: &mut Random) -> Vec3 {
    let distance = 1.01 + 5.0 * random.f32().powi(3);
    random.unit_vector() * distance
}

#[test]
fn every_way_leads_from_one_end_to_the_other() {
    let mut random = Random::new(2601);
    for way in ways() {
        let mut found = 0;
        for _ in 0..5000 {
            let (from, to) = (place(&mut random), place(&mut random));
            let ends = [from, to].map(|place| UNIT.end(place).unwrap());
            // One that only just touches may miss, by rounding.
            for bend in bends(way, &ends[0], &ends[1]).into_iter().filter(|bend| bend.sine < 0.9999) {
                found += 1;
                let (last, direction) = through(from.as_dvec3(), bend.direction.as_dvec3(), way).unwrap();
                // How far it misses the end, against how much it spreads on its way there.
                let missed = (to.as_dvec3() - last).cross(direction).length();
                let spread =
                    1.0 + f64::from(spread(way, &ends[0], &ends[1], bend.sine)).max(1.0 / (1.0 - f64::from(bend.sine)));
                assert!(missed < 2e-4 * spread, "{way:?} {from} {to}: {bend:?} misses by {missed}");
                assert!((bend.touches[1].as_dvec3() - last).length() < 2e-4 * spread, "{way:?} {bend:?} {last}");
            }
        }
        assert!(found > 500, "{way:?}: {found}");
    }
}

#[test]
fn no_way_is_forgotten() {
    let mut random = Random::new(2602);
    for way in ways() {
        let (mut lost, mut all) = (0, 0);
        while all < 20_000 {
            let from = place(&mut random);
            let aim = random.unit_vector();
            let direction = (aim - from).normalize();
            let Some((last, onwards)) = through(from.as_dvec3(), direction.as_dvec3(), way) else { continue };
            let to = (last + onwards * f64::from(random.range(0.01, 4.0))).as_vec3();
            let ends = [UNIT.end(from), UNIT.end(to)];
            let [Some(from), Some(to)] = ends else { continue };
            all += 1;
            let near = |bend: &Bend| (bend.direction - direction).length() < 3e-3;
            lost += u32::from(!bends(way, &from, &to).iter().any(near));
        }
        // Where two ways are about to become one, rounding may take both.
        assert!(lost <= 10, "{way:?}: {lost} of {all}");
    }
}

#[test]
fn spreads_are_ratios_of_solid_angles() {
    let mut random = Random::new(2603);
    for way in ways() {
        let mut checked = 0;
        while checked < 2000 {
            let (from, aim) = (place(&mut random), random.unit_vector() * 0.97);
            let direction = (aim - from).normalize().as_dvec3();
            let (x, y) = direction.any_orthonormal_pair();
            let step = 1e-5;
            let Some((last, onwards)) = through(from.as_dvec3(), direction, way) else { continue };
            let length = f64::from(random.range(0.05, 3.0));
            let to = last + onwards * length;
            // Places of the neighbours on the plane across the way.
            let across = |offset: DVec3| {
                let (last, direction) = through(from.as_dvec3(), (direction + offset * step).normalize(), way)?;
                let t = (to - last).dot(onwards) / direction.dot(onwards);
                Some(last + direction * t)
            };
            let places = [x, -x, y, -y].map(across);
            let [Some(right), Some(left), Some(up), Some(down)] = places else { continue };
            let area = ((right - left).cross(up - down) / (4.0 * step * step)).dot(onwards).abs();
            let expected = area / to.length_squared();
            let ends = [from, to.as_vec3()].map(|place| UNIT.end(place));
            let [Some(near), Some(far)] = ends else { continue };
            let sine = from.as_dvec3().cross(direction).length() as f32;
            let stated = f64::from(spread(way, &near, &far, sine));
            checked += 1;
            let close = (stated - expected).abs() <= 5e-3 * expected + 2e-3;
            assert!(close, "{way:?} {from} {to}: {stated} instead of {expected}, sine {sine}");
        }
    }
}

#[test]
fn an_end_at_infinity_is_one_that_is_very_far() {
    let mut random = Random::new(2604);
    for way in ways() {
        for _ in 0..500 {
            let (from, toward) = (UNIT.end(place(&mut random)).unwrap(), random.unit_vector());
            let (infinite, far) = (End::infinity(toward), UNIT.end(toward * 1e6).unwrap());
            let (a, b) = (bends(way, &from, &infinite), bends(way, &from, &far));
            for (a, b) in a.iter().zip(&b).filter(|_| a.len() == b.len()) {
                assert!((a.direction - b.direction).length() < 1e-3, "{a:?} {b:?}");
            }
        }
    }
}
