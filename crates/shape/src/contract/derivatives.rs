//! How surfaces run along their coordinates: by what is met a little further on.

use super::*;

#[test]
fn small_steps_go_as_the_derivatives_say() {
    let (mut kinds, all) = (0, shapes().len());
    for shape in shapes() {
        let (ball, mut random, mut seen, mut unclear) = (ball(&shape), Random::new(750), 0, 0);
        for i in 0..600 {
            let aim = shape.sample(ball.0 + random.unit_vector() * ball.1 * 3.0, random.vec2());
            let ray = line(&mut random, ball, 2.0);
            let direction = aim.filter(|_| i % 2 == 0).map_or(ray.direction, |aim| aim.point - ray.origin);
            let ray = Ray { direction, ..ray };
            let Some(hit) = shape.intersect(&ray) else { continue };
            let start = shape.surface(&ray, &hit);
            let Some(along) = shape.derivatives(start.local, &hit, 0.0) else { continue };
            let off = (along.u.dot(start.normal) / along.u.length()).abs()
                + (along.v.dot(start.normal) / along.v.length()).abs();
            assert!(off < 1e-4, "{shape:?}: {along:?} along {}", start.normal);
            // A step on the surface, small against a coordinate's unit and the shape.
            let length = 1e-3 * ball.1.min(along.u.length()).min(along.v.length());
            let way = random.unit_vector().reject_from(start.normal).normalize() * length;
            let near = Ray { direction: start.point + way - ray.origin, ..ray };
            let Some(next) = shape.intersect(&near).filter(|next| next.part == hit.part) else { continue };
            let end = shape.surface(&near, &next);
            let (step, uv) = (end.point - start.point, end.uv - start.uv);
            // What rounding leaves of a step far from the origin of points and coordinates says nothing.
            let noise =
                f32::EPSILON * (start.point.length() + start.uv.length() * (along.u.length() + along.v.length()));
            if noise > 0.01 * length {
                unclear += 1;
                continue;
            }
            if uv.x.abs() > 0.5 || step.length() > 3.0 * length {
                continue;
            }
            seen += 1;
            let told = along.u * uv.x + along.v * uv.y;
            assert!((told - step).length() < 0.05 * length + 4.0 * noise, "{shape:?}: {step} told {told}");
        }
        assert!(seen + unclear > 20, "{seen} steps on {shape:?}");
        kinds += usize::from(seen > 20);
    }
    assert!(kinds * 10 > all * 8, "{kinds} of {all} have steps that can be measured");
}
