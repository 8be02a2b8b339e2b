//! Structures of Embree 4's C interface (`rtcore_ray.h`, `rtcore_common.h`), for builds with one
//! instancing level.

use juggler_math::Ray;
use std::ffi::c_void;

/// `RTC_INVALID_GEOMETRY_ID`: no geometry, primitive or instance.
pub const INVALID: u32 = u32::MAX;

/// `RTCRay`.
#[repr(C, align(16))]
pub struct Ray1 {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    pub far: f32,
    mask: u32,
    id: u32,
    flags: u32,
}

/// `RTCHit`.
#[repr(C, align(16))]
pub struct Hit1 {
    normal: [f32; 3],
    uv: [f32; 2],
    pub primitive: u32,
    pub geometry: u32,
    instance: u32,
    instance_primitive: u32,
}

/// `RTCRayHit`.
#[repr(C, align(16))]
pub struct RayHit1 {
    pub ray: Ray1,
    pub hit: Hit1,
}

/// `RTCRay8`.
#[repr(C, align(32))]
pub struct Ray8 {
    origin: [[f32; 8]; 3],
    near: [f32; 8],
    direction: [[f32; 8]; 3],
    time: [f32; 8],
    pub far: [f32; 8],
    mask: [u32; 8],
    id: [u32; 8],
    flags: [u32; 8],
}

/// `RTCHit8`.
#[repr(C, align(32))]
pub struct Hit8 {
    normal: [[f32; 8]; 3],
    uv: [[f32; 8]; 2],
    pub primitive: [u32; 8],
    pub geometry: [u32; 8],
    instance: [u32; 8],
    instance_primitive: [u32; 8],
}

/// `RTCRayHit8`.
#[repr(C, align(32))]
pub struct RayHit8 {
    pub ray: Ray8,
    pub hit: Hit8,
}

/// Valid mask of a packet: -1 for active rays, 0 for inactive ones.
#[repr(C, align(32))]
pub struct Valid8(pub [i32; 8]);

/// `RTCIntersectArguments` and `RTCOccludedArguments`, which have the same layout.
#[repr(C)]
pub struct Arguments {
    flags: u32,
    features: u32,
    context: *mut c_void,
    filter: *mut c_void,
    callback: *mut c_void,
    /// Some builds have one more field.
    spare: [u64; 2],
}

impl Arguments {
    /// Embree's defaults, with or without the coherent flag for packets.
    pub const fn new(coherent: bool) -> Self {
        let nothing = std::ptr::null_mut();
        let flags = if coherent { 1 << 16 } else { 0 };
        Self { flags, features: u32::MAX, context: nothing, filter: nothing, callback: nothing, spare: [0; 2] }
    }
}

impl From<&Ray> for Ray1 {
    #[inline(always)]
    fn from(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.to_array(),
            near: ray.t_min,
            direction: ray.direction.to_array(),
            time: 0.0,
            far: ray.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }
}

impl From<&Ray> for RayHit1 {
    #[inline(always)]
    fn from(ray: &Ray) -> Self {
        let hit = Hit1 {
            normal: [0.0; 3],
            uv: [0.0; 2],
            primitive: INVALID,
            geometry: INVALID,
            instance: INVALID,
            instance_primitive: INVALID,
        };
        Self { ray: ray.into(), hit }
    }
}

impl Ray8 {
    /// Converts up to eight rays; also returns the mask of used lanes.
    #[inline(always)]
    pub fn of(rays: &[Ray]) -> (Self, Valid8) {
        let mut packet = Self {
            origin: [[0.0; 8]; 3],
            near: [0.0; 8],
            direction: [[0.0; 8]; 3],
            time: [0.0; 8],
            far: [0.0; 8],
            mask: [u32::MAX; 8],
            id: [0; 8],
            flags: [0; 8],
        };
        let mut valid = Valid8([0; 8]);
        for (lane, ray) in rays.iter().enumerate().take(8) {
            for axis in 0..3 {
                packet.origin[axis][lane] = ray.origin[axis];
                packet.direction[axis][lane] = ray.direction[axis];
            }
            packet.near[lane] = ray.t_min;
            packet.far[lane] = ray.t_max;
            valid.0[lane] = -1;
        }
        (packet, valid)
    }
}

impl From<Ray8> for RayHit8 {
    #[inline(always)]
    fn from(ray: Ray8) -> Self {
        let hit = Hit8 {
            normal: [[0.0; 8]; 3],
            uv: [[0.0; 8]; 2],
            primitive: [INVALID; 8],
            geometry: [INVALID; 8],
            instance: [INVALID; 8],
            instance_primitive: [INVALID; 8],
        };
        Self { ray, hit }
    }
}

// Sizes in C.
const _: () = assert!(size_of::<Ray1>() == 48 && size_of::<Hit1>() == 48 && size_of::<RayHit1>() == 96);
const _: () = assert!(size_of::<Ray8>() == 12 * 32 && size_of::<Hit8>() == 9 * 32 && size_of::<RayHit8>() == 21 * 32);
