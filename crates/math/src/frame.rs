//! An orthonormal frame around a normal.

use glam::Vec3;

/// Three unit vectors at right angles, right-handed: `tangent × bitangent = normal`. Local z is the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x.
    pub tangent: Vec3,
    /// Local y.
    pub bitangent: Vec3,
    /// Local z.
    pub normal: Vec3,
}

impl Frame {
    /// Any frame around a unit normal (Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017).
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

    /// Local → world.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.tangent * v.x + self.bitangent * v.y + self.normal * v.z
    }

    /// World → local.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.tangent), v.dot(self.bitangent), v.dot(self.normal))
    }
}
