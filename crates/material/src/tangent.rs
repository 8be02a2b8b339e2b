//! Shading frames that follow the tangents of a surface.

use super::ShadingView;
use juggler_math::{Frame, Vec3, portable};
use juggler_shape::surface::Tangents;

/// Unit vectors that are perpendicular to a unit `normal` and to each other: the first along ∂p/∂u,
/// the second on the side of ∂p/∂v. Without tangents, any two.
///
/// With a tangent of the mesh, the first is that tangent orthogonalized against the normal N
/// (Gram-Schmidt), and the second w (N × T) (glTF 2.0, section 3.7.2.1).
pub fn axes(normal: Vec3, tangents: Option<&Tangents>) -> (Vec3, Vec3) {
    if let Some(given) = tangents.and_then(|tangents| tangents.given)
        && let Some(u) = given.along.reject_from_normalized(normal).try_normalize()
    {
        return (u, normal.cross(u) * given.sign);
    }
    let along = tangents.and_then(|t| Some((t, t.u.reject_from_normalized(normal).try_normalize()?)));
    let Some((tangents, u)) = along else {
        let frame = Frame::around(normal);
        return (frame.tangent, frame.bitangent);
    };
    let v = normal.cross(u);
    (u, if v.dot(tangents.v) < 0.0 { -v } else { v })
}

/// Shading frame around `normal`. With `turns`, its x axis is rotated by as many full turns from u
/// towards v; otherwise it is arbitrary.
pub fn frame(view: &ShadingView, normal: Vec3, turns: Option<f32>) -> Frame {
    let Some(turns) = turns else { return Frame::around(normal) };
    let (u, v) = axes(normal, view.tangents);
    let (sin, cos) = portable::sin_cos_turns(turns);
    let tangent = u * cos + v * sin;
    Frame { tangent, bitangent: normal.cross(tangent), normal }
}
