//! A ray's journey, station by station:
//!
//! 1. a [`camera`] turns a point of the film into a ray,
//! 2. with numbers from a [`sampler`], each a pure function of (seed, pixel, sample, dimension);
//! 3. the [`world`] finds what the ray meets:
//! 4. a [`shape`] in its own space,
//! 5. seen as a [`surface`],
//! 6. whose [`material`] reads its [`texture`]s
//! 7. and becomes the numbers of a [`bsdf`] at this one point;
//! 8. [`light`]s say what arrives there, on some ways by polished balls ([`manifold`]), the [`background`] what a ray that
//!    leaves the world sees;
//! 9. an [`integrator`] says what the point adds, and which rays go on;
//! 10. the [`film`] sums it, with what else is asked for ([`layer`]), and [`render`] drives it all on every core.
//!
//! This crate opens no file, reads no clock, no environment variable, and shows no window.

#[macro_use]
mod closed_set;

pub mod background;
pub mod bsdf;
pub mod camera;
pub mod emitter;
pub mod film;
pub mod frames;
pub mod integrator;
pub mod layer;
pub mod light;
pub mod manifold;
pub mod material;
pub mod medium;
pub mod render;
pub mod sampler;
pub mod shape;
pub mod surface;
pub mod texture;
pub mod world;
