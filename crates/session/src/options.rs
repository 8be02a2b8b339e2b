//! Options of a session.

use std::time::Duration;

/// Options with which a session is opened.
#[derive(Clone, Debug, PartialEq)]
pub struct SessionOptions {
    /// Width and height in pixels; `None` uses the scene's.
    pub size: Option<[u32; 2]>,
    /// Values of the scene by JSON pointer that differ from its file, as by
    /// [`Edit::Set`](crate::Edit::Set); a reset keeps them.
    pub values: Vec<(String, serde_json::Value)>,
    /// Whether missing and broken pictures of models are shown gray, with a warning.
    pub lenient: bool,
    /// Number of render threads, at most 1024; 0 uses all cores.
    pub threads: usize,
    /// Target duration of a frame while the camera moves, 30 ms by default. The session lowers the
    /// resolution to meet it.
    pub budget: Duration,
    /// Whether the scene's files are watched and reloaded when they change.
    pub watch: bool,
    /// Maximum memory in bytes of files in memory ([`Edit::Files`](crate::Edit::Files)) and of the
    /// scene that they make; scenes that need more are errors. `None` for no limit.
    pub max_memory: Option<u64>,
}

impl Default for SessionOptions {
    fn default() -> Self {
        let (size, values, budget) = (None, Vec::new(), Duration::from_millis(30));
        Self { size, values, lenient: false, threads: 0, budget, watch: false, max_memory: None }
    }
}
