//! Which way along a surface is which: the frame of a scattering function, where that makes a difference.

use super::View;
use juggler_math::{Frame, Vec3, fun};
use juggler_shape::surface::Tangents;

/// Unit vectors across a unit `normal` and each other: one along ∂p/∂u, the other on the side to which ∂p/∂v goes. Any
/// two where the surface does not say.
pub fn axes(normal: Vec3, tangents: Option<&Tangents>) -> (Vec3, Vec3) {
    let along = tangents.and_then(|t| Some((t, t.u.reject_from_normalized(normal).try_normalize()?)));
    let Some((tangents, u)) = along else {
        let frame = Frame::around(normal);
        return (frame.tangent, frame.bitangent);
    };
    let v = normal.cross(u);
    (u, if v.dot(tangents.v) < 0.0 { -v } else { v })
}

/// The frame around `normal`; its x stands `turns` of a whole turn from u towards v, if that is asked for.
pub fn frame(view: &View, normal: Vec3, turns: Option<f32>) -> Frame {
    let Some(turns) = turns else { return Frame::around(normal) };
    let (u, v) = axes(normal, view.tangents);
    let (sin, cos) = fun::sin_cos_turns(turns);
    let tangent = u * cos + v * sin;
    Frame { tangent, bitangent: normal.cross(tangent), normal }
}
