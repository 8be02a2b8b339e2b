//! The module `juggler._native`, on which the Python package `juggler` is built. It takes scenes as
//! JSON text with assets for arrays, and settings as keywords; arrays come and go as bytes, so it
//! needs no library of arrays.

mod arrays;
mod budget;
mod cluster;
mod comparison;
mod denoise;
mod errors;
mod files;
mod image;
mod partial_render;
mod progressive;
mod renderer;
mod scene;
mod settings;
mod state;
mod task;
mod threads;

/// Classes and functions for the package `juggler`, which wraps all of them.
#[pyo3::pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    use crate::arrays::Asset;
    #[pymodule_export]
    use crate::cluster::{Ledger, encode_movie, scene_from_package, scene_package};
    #[pymodule_export]
    use crate::comparison::compare;
    #[pymodule_export]
    use crate::denoise::denoise;
    #[pymodule_export]
    use crate::files::{configuration, examples, main};
    #[pymodule_export]
    use crate::image::Image;
    #[pymodule_export]
    use crate::partial_render::{PartialRender, merge};
    #[pymodule_export]
    use crate::progressive::Progressive;
    #[pymodule_export]
    use crate::renderer::Renderer;
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::settings::{check_settings, setting_names};
    #[pymodule_export]
    use crate::task::{Canceler, panic_on_a_thread};
}
