//! Derivatives by surface coordinates against finite differences.

use super::*;

#[test]
fn small_steps_agree_with_the_derivatives() {
    let (mut kinds, all) = (0, shapes().len());
    for shape in shapes() {
        let (bounding_sphere, mut random, mut measured, mut unclear) =
            (bounding_sphere(&shape), Random::new(750), 0, 0);
        for i in 0..600 {
            let aim = shape.sample(bounding_sphere.0 + random.unit_vector() * bounding_sphere.1 * 3.0, random.vec2());
            let ray = line(&mut random, bounding_sphere, 2.0);
            let direction = aim.filter(|_| i % 2 == 0).map_or(ray.direction, |aim| aim.point - ray.origin);
            let ray = Ray { direction, ..ray };
            let Some(hit) = shape.intersect(&ray) else { continue };
            let start = shape.surface(&ray, &hit);
            let Some(along) = shape.derivatives(start.local, &hit, 0.0) else { continue };
            let off = (along.u.dot(start.normal) / along.u.length()).abs()
                + (along.v.dot(start.normal) / along.v.length()).abs();
            assert!(off < 1e-4, "{shape:?}: {along:?} along {}", start.normal);
            // A step on the surface, small relative to a unit of the coordinates and to the shape.
            let length = 1e-3 * bounding_sphere.1.min(along.u.length()).min(along.v.length());
            let offset = random.unit_vector().reject_from(start.normal).normalize() * length;
            let near = Ray { direction: start.point + offset - ray.origin, ..ray };
            let Some(next) = shape.intersect(&near).filter(|next| next.primitive == hit.primitive) else { continue };
            let end = shape.surface(&near, &next);
            let (step, uv) = (end.point - start.point, end.uv - start.uv);
            // Far from the origin of points and coordinates, rounding hides the step.
            let noise =
                f32::EPSILON * (start.point.length() + start.uv.length() * (along.u.length() + along.v.length()));
            if noise > 0.01 * length {
                unclear += 1;
                continue;
            }
            if uv.x.abs() > 0.5 || step.length() > 3.0 * length {
                continue;
            }
            measured += 1;
            let expected = along.u * uv.x + along.v * uv.y;
            assert!((expected - step).length() < 0.05 * length + 4.0 * noise, "{shape:?}: {step}, expected {expected}");
        }
        assert!(measured + unclear > 20, "{measured} steps on {shape:?}");
        kinds += usize::from(measured > 20);
    }
    assert!(kinds * 10 > all * 8, "{kinds} of {all} have steps that can be measured");
}
