//! Shared foundations of all crates: vectors, rays, bounding boxes, transforms, color, message
//! texts, and elementary functions with the same bits on every platform.
//!
//! Only scalar [`glam`] types are used (`Vec3`, not `Vec3A`): their sums and products are evaluated
//! in one fixed order on every platform and never fused. Sine, logarithm and other elementary
//! functions come from [`portable`].

#[doc(hidden)]
pub mod closed_set;

pub mod aabb;
mod build_control;
pub mod color;
pub mod distribution;
pub mod frame;
pub mod hash;
pub mod image;
pub mod message;
pub mod motion;
pub mod pixel_rows;
mod polar;
pub mod portable;
pub mod quaternion;
pub mod range;
pub mod ray;
pub mod robust;
pub mod suggest;
pub mod transform;
pub mod warp;

#[cfg(any(test, feature = "testing"))]
pub mod testing;

pub use aabb::Aabb;
pub use build_control::{BuildControl, BuildStage, Cancelled};
pub use closed_set::NamedKind;
pub use color::Rgb;
pub use frame::Frame;
pub use glam::{DMat3, DQuat, DVec2, DVec3, Mat3, UVec2, Vec2, Vec3, vec2, vec3};
pub use image::Image;
pub use motion::Motion;
pub use pixel_rows::PixelRows;
pub use range::MAX_LIGHT;
pub use ray::Ray;
pub use transform::Transform;
