//! Orthonormal shading frames.

use glam::Vec3;

/// A right-handed orthonormal basis, `tangent × bitangent = normal`. Local z is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x axis.
    pub tangent: Vec3,
    /// Local y axis.
    pub bitangent: Vec3,
    /// Local z axis.
    pub normal: Vec3,
}

impl Frame {
    /// The basis of the coordinate axes.
    pub const AXES: Self = Self { tangent: Vec3::X, bitangent: Vec3::Y, normal: Vec3::Z };

    /// Constructs a frame around a unit normal (Duff et al., Building an Orthonormal Basis,
    /// Revisited, JCGT 2017). The tangent's direction is arbitrary.
    pub fn around(n: Vec3) -> Self {
        let sign = 1f32.copysign(n.z);
        let a = -1.0 / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            tangent: Vec3::new(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x),
            bitangent: Vec3::new(b, sign + n.y * n.y * a, -n.y),
            normal: n,
        }
    }

    /// Transforms a vector from local to world space.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal * v.z
    }

    /// Transforms a vector from world to local space.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{Random, close3};

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        let mut random = Random::new(51);
        let poles = [Vec3::Z, -Vec3::Z, Vec3::X, Vec3::Y, Vec3::new(0.0, 1e-20, -1.0), Vec3::new(3e-4, 0.0, -1.0)];
        for n in (0..10_000).map(|_| random.unit_vector()).chain(poles) {
            let frame = Frame::around(n);
            let (t, b) = (frame.tangent, frame.bitangent);
            assert!(t.is_normalized() && b.is_normalized(), "{n}");
            assert!(t.dot(b).abs() < 1e-6 && t.dot(n).abs() < 1e-6 && b.dot(n).abs() < 1e-6, "{n}");
            assert!(close3(t.cross(b), n, 1e-6), "{n}");
        }
    }

    #[test]
    fn local_and_world_are_inverse() {
        let mut random = Random::new(52);
        for _ in 0..1000 {
            let (frame, v) = (Frame::around(random.unit_vector()), random.point(10.0));
            assert!(close3(frame.to_local(frame.to_world(v)), v, 1e-6));
            assert!(close3(frame.to_world(Vec3::Z), frame.normal, 0.0));
        }
    }
}
