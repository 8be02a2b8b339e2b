//! Thread pools, one for each process and number of threads.

use crate::errors::settings_error;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, Once, PoisonError};

/// Name of the threads, whose panics become exceptions.
const NAME: &str = "juggler-python";
/// Environment variable with the number of threads.
const VARIABLE: &str = "JUGGLER_THREADS";
/// Maximum number of threads.
const MAX_THREADS: usize = 1024;

/// What a pool is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Use {
    /// Builds and renders.
    Render,
    /// Short work, which must not wait for a render.
    Short,
}

/// Pools by process, use and number of threads.
type Pools = BTreeMap<(u32, Use, usize), Vec<Arc<ThreadPool>>>;

/// Maximum number of pools of one kind. More work than that shares them.
const MAX_POOLS: usize = 8;

/// Pools, each for one work at a time, since the tasks of two works in one pool hinder each other. A
/// process that is forked makes its own, since only the thread that forks lives on in it. The lock is
/// held only while the interpreter is attached, and therefore by no other thread when `os.fork` is
/// called.
static POOLS: Mutex<Pools> = Mutex::new(Pools::new());

/// Number of threads to use: `requested`, that of the environment, or one per core that the process
/// may use.
pub fn thread_count(requested: Option<usize>) -> PyResult<usize> {
    let check = |count: usize, what: &str| {
        if (1..=MAX_THREADS).contains(&count) {
            return Ok(count);
        }
        Err(settings_error("threads", format!("{what} is {count}, which is out of range: 1 to {MAX_THREADS}")))
    };
    if let Some(count) = requested {
        return check(count, "`threads`");
    }
    match std::env::var(VARIABLE) {
        Ok(text) if !text.is_empty() => {
            let wrong = || settings_error("threads", format!("{VARIABLE} is `{text}`, not a number"));
            let count = text.parse().map_err(|_| wrong())?;
            check(count, VARIABLE)
        }
        _ => Ok(std::thread::available_parallelism().map_or(1, std::num::NonZero::get)),
    }
}

/// Pool of this many threads. It is kept for the next call, and busy as long as the result lives.
pub fn pool(_: Python<'_>, threads: usize, purpose: Use) -> PyResult<Arc<ThreadPool>> {
    silence_panics();
    let key = (std::process::id(), purpose, threads);
    // No Python code runs while the lock is held.
    let found = {
        let mut pools = POOLS.lock().unwrap_or_else(PoisonError::into_inner);
        let pools = pools.entry(key).or_default();
        // The table itself holds one reference.
        match pools.iter().min_by_key(|pool| Arc::strong_count(pool)) {
            Some(pool) if Arc::strong_count(pool) == 1 || pools.len() >= MAX_POOLS => Ok(Arc::clone(pool)),
            _ => new_pool(threads).map(|pool| {
                let pool = Arc::new(pool);
                pools.push(Arc::clone(&pool));
                pool
            }),
        }
    };
    found.map_err(|error| settings_error("threads", format!("cannot start {threads} threads: {error}")))
}

fn new_pool(threads: usize) -> Result<ThreadPool, ThreadPoolBuildError> {
    ThreadPoolBuilder::new().num_threads(threads).thread_name(|number| format!("{NAME}-{number}")).build()
}

/// Prints no message for panics of these threads, which become exceptions.
fn silence_panics() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let previous = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |panic| {
            let is_own = std::thread::current().name().is_some_and(|name| name.starts_with(NAME));
            if !is_own {
                previous(panic);
            }
        }));
    });
}
