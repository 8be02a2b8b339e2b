//! Common items of most programs: `use juggler::prelude::*;`
//!
//! Textures and backgrounds keep their modules' names: `texture::Gradient`, `background::Gradient`.

pub use crate::{Error, ImageExt, Picture, Settings, View};
pub use juggler_camera::*;
pub use juggler_imaging::{AnyCurve, ImageFormat, Tone};
pub use juggler_integrator as integrator;
pub use juggler_light::*;
pub use juggler_material::*;
pub use juggler_math::{Image, Rgb, Vec2, Vec3, vec2, vec3};
pub use juggler_render::{Control, Scheduler};
pub use juggler_scene::{Object, Scene};
pub use juggler_shape::*;
pub use juggler_texture::{self as texture, Input};
