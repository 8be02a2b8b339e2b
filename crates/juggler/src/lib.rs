//! Juggler, a ray tracer whose pictures are the same to the bit everywhere.
//!
//! ```
//! use juggler::prelude::*;
//!
//! let red = Phong { diffuse: Rgb::new(0.8, 0.1, 0.1).into(), ..Phong::default() };
//! let scene = Scene::new()
//!     .size(32, 18)
//!     .material("red", red)
//!     .add(Object::new(Sphere::default()).at(0.0, 1.0, 0.0).material_named("red"));
//! let image = juggler::render(&scene, &Settings { samples: Some(4), ..Settings::default() })?;
//! assert_eq!((image.width(), image.height()), (32, 18));
//! # Ok::<(), juggler::Error>(())
//! ```
//!
//! - [`Scene`](scene::Scene) is built here or loaded from a file,
//! - [`Settings`] say what is wanted beyond what the scene says,
//! - [`render()`] makes an image in memory, [`render_to_file`] a file of any size,
//! - [`layers`] are what can be asked for beside the picture,
//! - [`ImageExt`] saves an image in memory, and turns it into bytes,
//! - [`Picture`] does both step by step: with progress, cancelling, numbers afterwards; and it keeps
//!   the world with its acceleration structures for further pictures.
//!
//! Rendering uses the current rayon thread pool. The crates behind it, in the order of a ray's
//! journey: [`math`], [`camera`], [`shape`], [`texture`], [`mod@bsdf`], [`material`], [`light`],
//! [`world`], [`integrator`], [`mod@render`]; and [`scene`], [`imaging`], [`film`]. The folder
//! `examples/` is a course in five steps.

pub mod denoise;
mod error;
pub mod estimate;
mod frames;
mod image;
mod kinds;
pub mod layers;
pub mod memory;
mod part;
mod picture;
pub mod prelude;
pub mod probe;
mod settings;
mod viewpoint;

pub use denoise::Denoiser;
pub use error::Error;
pub use image::ImageExt;
pub use juggler_bsdf as bsdf;
pub use juggler_camera as camera;
pub use juggler_film as film;
pub use juggler_imaging as imaging;
pub use juggler_integrator as integrator;
pub use juggler_light as light;
pub use juggler_material as material;
pub use juggler_math as math;
pub use juggler_render as render;
pub use juggler_scene as scene;
pub use juggler_shape as shape;
pub use juggler_texture as texture;
pub use juggler_world as world;
pub use kinds::{by_name, check_name, names};
pub use layers::{Aov, LayerSet, MOST_GAIN};
pub use part::Origin;
pub use picture::{Outcome, Picture, View, render, render_to_file};
pub use settings::{Limit, Settings};
