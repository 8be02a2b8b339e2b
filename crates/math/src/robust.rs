//! Rounding: error bounds, origins of follow-up rays, a quadratic that does not cancel.

use glam::Vec3;

/// Bound on the relative error of `n` rounded operations in a row (Higham 2002, section 3.1).
pub const fn gamma(n: u32) -> f32 {
    let e = n as f32 * (f32::EPSILON * 0.5);
    e / (1.0 - e)
}

/// Start of a ray that leaves a surface: `point` moved off it along the unit `normal`, to the side that
/// `direction` goes to. `error` bounds how far each coordinate of `point` may be from the true surface
/// (Pharr, Jakob, Humphreys, PBR 4th ed., section 6.8.6).
pub fn offset_origin(point: Vec3, error: f32, normal: Vec3, direction: Vec3) -> Vec3 {
    let n = normal.abs();
    let distance = error * (n.x + n.y + n.z);
    let signed = if direction.dot(normal) < 0.0 { -distance } else { distance };
    let offset = normal * signed;
    let moved = point + offset;
    // Rounding of the sum itself must not undo the move: go one float further.
    let push = |p: f32, o: f32| {
        if o > 0.0 {
            p.next_up()
        } else if o < 0.0 {
            p.next_down()
        } else {
            p
        }
    };
    Vec3::new(push(moved.x, offset.x), push(moved.y, offset.y), push(moved.z, offset.z))
}
