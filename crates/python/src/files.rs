//! The program, its built-in scenes and its configuration.

use juggler::scene::built_in_scenes;
use pyo3::prelude::*;
use std::ffi::OsString;

/// Runs the program with these words, the first of which is its name, and returns its exit status.
/// Signals have their default effect from then on.
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<OsString>) -> PyResult<u8> {
    let signal = py.import("signal")?;
    signal.call_method1("signal", (signal.getattr("SIGINT")?, signal.getattr("SIG_DFL")?))?;
    Ok(py.detach(|| juggler_cli::run(words)))
}

/// Names and descriptions of the built-in scenes.
#[pyfunction]
pub fn examples() -> Vec<(&'static str, String)> {
    built_in_scenes().iter().map(|scene| (scene.name, scene.description())).collect()
}

/// Version, features and threads, for reports of errors.
#[pyfunction]
pub fn configuration() -> PyResult<Vec<(&'static str, String)>> {
    let features =
        [("av1", cfg!(feature = "av1")), ("ktx2", cfg!(feature = "ktx2")), ("serve", cfg!(feature = "serve"))];
    let features: Vec<&str> = features.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| *name).collect();
    Ok(vec![
        ("version", env!("CARGO_PKG_VERSION").to_owned()),
        ("features", features.join(", ")),
        ("build", if cfg!(debug_assertions) { "unoptimized" } else { "optimized" }.to_owned()),
        ("system", format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)),
        ("threads", crate::threads::thread_count(None)?.to_string()),
    ])
}
