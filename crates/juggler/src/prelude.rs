//! What most programs need: `use juggler::prelude::*;`
//!
//! Textures and backgrounds stay behind their modules' names: `texture::Gradient`, `background::Gradient`.

pub use crate::{Error, ImageExt, Picture, Settings, View};
pub use juggler_imaging::{AnyCurve, Format, Tone};
pub use juggler_math::{Image, Rgb, Vec2, Vec3, vec2, vec3};
pub use juggler_scene::{Object, Scene};
pub use juggler_tracer::camera::*;
pub use juggler_tracer::light::*;
pub use juggler_tracer::material::*;
pub use juggler_tracer::render::{Control, Scheduler};
pub use juggler_tracer::shape::*;
pub use juggler_tracer::texture::Input;
pub use juggler_tracer::{background, integrator, texture};
