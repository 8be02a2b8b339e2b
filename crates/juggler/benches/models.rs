//! Time and memory of reading models: `cargo bench -p juggler --bench models -- FILE...` prints a
//! table of each file's stages. The peak memory is that of the process until the end of a stage's
//! first run, so pass one file for it.
#![allow(clippy::print_stdout, reason = "that is its purpose")]

use juggler::MODEL_FORMATS;
use juggler::scene::model::{ModelChoice, ModelFile};
use std::collections::BTreeMap;
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

/// Number of runs of each stage, of which the least and the median are printed.
const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    // Cargo passes `--bench`.
    for file in std::env::args().skip(1).filter(|argument| argument != "--bench") {
        println!("{file}, {:.1} MB", std::fs::metadata(&file)?.len() as f64 / 1e6);
        timed("outline: file, JSON, structure, hash", || open(&file))?;
        timed("arrays: outline, decoded arrays, materials, objects", || {
            Ok(open(&file)?.parts(&ModelChoice::default(), "")?)
        })?;
        timed("scene: arrays, expanded and validated scene", || Ok(juggler::loader().load(&file)?))?;
        timed("world: scene, compiled with its trees", || Ok(juggler::loader().load(&file)?.compile()?))?;
    }
    Ok(())
}

/// Opens a model whose buffers are in the file.
fn open(file: &str) -> Result<Arc<dyn ModelFile>, Box<dyn Error>> {
    let ending = file.rsplit('.').next().unwrap_or_default();
    let format = MODEL_FORMATS.iter().find(|format| format.extensions().contains(&ending));
    Ok(format.ok_or("no format of models has this extension")?.open(file, std::fs::read(file)?, &BTreeMap::new())?)
}

/// Prints the times of some runs in milliseconds, and the peak memory.
fn timed<T>(what: &str, run: impl Fn() -> Result<T, Box<dyn Error>>) -> Result<(), Box<dyn Error>> {
    let (mut times, mut peak) = (Vec::new(), 0.0);
    for number in 0..RUNS {
        let start = Instant::now();
        let result = run()?;
        times.push(start.elapsed().as_secs_f64() * 1e3);
        drop(result);
        peak = if number == 0 { peak_megabytes() } else { peak };
    }
    times.sort_by(f64::total_cmp);
    let at = |run: usize| times.get(run).copied().unwrap_or_default();
    println!("  {what:<52} {:>9.1} ms, median {:>9.1}, peak {:>6.0} MB", at(0), at(RUNS / 2), peak);
    Ok(())
}

/// Peak memory of the process in MB; 0 if the system does not report it.
fn peak_megabytes() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    peak.and_then(|line| line.split_whitespace().next()?.parse::<f64>().ok()).unwrap_or_default() / 1e3
}
