//! Juggler, a path tracer whose images are bit-identical on all machines.
//!
//! ```
//! use juggler::prelude::*;
//!
//! let red = Phong { shininess: 50.0, specular: 0.5.into(), ..Phong::new([0.8, 0.1, 0.1]) };
//! let scene = Scene::new()
//!     .size(32, 18)
//!     .material("red", red)
//!     .add(Object::new(Sphere::new(1.0)).at(0.0, 1.0, 0.0).material_named("red"));
//! let image = juggler::render(&scene, &Settings { samples: Some(4), ..Settings::default() })?;
//! assert_eq!((image.width(), image.height()), (32, 18));
//! # Ok::<(), juggler::Error>(())
//! ```
//!
//! - [`Scene`](scene::Scene) is built by a program or loaded from a file.
//! - [`Settings`] override values of the scene.
//! - [`render()`] renders an image in memory, [`render_to_file`] a file of any size.
//! - [`aovs`] are the arbitrary output variables (AOVs).
//! - [`RenderedImage`] is a rendered image in memory with its AOVs; [`ImageExt`] saves any image or
//!   converts it to bytes.
//! - [`Picture`] renders step by step, with progress, cancellation and statistics, and keeps the
//!   world with its acceleration structures for further renders.
//!
//! Rendering uses the current rayon thread pool. The facade re-exports the crates [`math`],
//! [`camera`], [`shape`], [`texture`], [`mod@bsdf`], [`material`], [`light`], [`world`],
//! [`integrator`], [`mod@render`], [`mesh`], [`scene`], [`imaging`] and [`film`]. The folder
//! `examples/` is a course in six lessons.

pub mod aovs;
pub mod comparison;
pub mod denoise;
mod error;
pub mod estimate;
mod formats;
mod image;
mod kinds;
mod ledger;
pub mod memory;
mod neighbor_scenes;
mod one_call;
mod partial_render;
mod picture;
pub mod prelude;
pub mod probe;
mod render_stats;
mod rendered_image;
mod scene_fingerprint;
mod settings;
pub mod stage;
mod viewpoint;

pub use aovs::{Aov, AovSet, MAX_GAIN};
pub use denoise::Denoiser;
pub use error::Error;
pub use formats::{MODEL_FORMATS, loader};
pub use image::ImageExt;
pub use juggler_bsdf as bsdf;
pub use juggler_camera as camera;
pub use juggler_film as film;
pub use juggler_imaging as imaging;
pub use juggler_integrator as integrator;
pub use juggler_light as light;
pub use juggler_material as material;
pub use juggler_math as math;
pub use juggler_math::{BuildControl, BuildStage};
pub use juggler_mesh as mesh;
pub use juggler_render as render;
pub use juggler_scene as scene;
pub use juggler_shape as shape;
pub use juggler_texture as texture;
pub use juggler_world as world;
pub use kinds::{by_name, check_name, names};
pub use ledger::Ledger;
pub use one_call::{render, render_to_file};
pub use partial_render::RenderOrigin;
pub use picture::{Picture, View};
pub use render_stats::RenderStats;
pub use rendered_image::{RenderedImage, SAMPLES, SAMPLES_PER_TILE, TONE};
pub use settings::{Limit, Settings};
pub use stage::Stage;
