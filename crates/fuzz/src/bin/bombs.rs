//! Runs all bombs against a program: `bombs PROGRAM [CLASS]`. Prints each failure and a summary
//! line per class. Exits with 1 if a bomb failed and with 2 if no program is given.

use juggler_fuzz::bombs::{all, run};
use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::PathBuf;
use std::process::ExitCode;

fn main() -> io::Result<ExitCode> {
    let mut words = std::env::args().skip(1);
    let Some(program) = words.next() else { return Ok(ExitCode::from(2)) };
    let program = PathBuf::from(program).canonicalize()?;
    let class = words.next();
    let mut out = io::stdout().lock();
    // By class: numbers of bombs, command lines and failures, and the longest time in seconds.
    let mut classes: BTreeMap<&str, (usize, usize, usize, f64)> = BTreeMap::new();
    for bomb in all().iter().filter(|bomb| class.as_deref().is_none_or(|class| class == bomb.class)) {
        let found = classes.entry(bomb.class).or_default();
        found.0 += 1;
        for result in run(&program, bomb)? {
            found.1 += 1;
            found.3 = found.3.max(result.seconds);
            if let Some(fault) = result.fault {
                found.2 += 1;
                let name: String = bomb.name.chars().take(100).collect();
                writeln!(out, "FAILED {}: {name}\n  juggler {}\n  {fault}", bomb.class, result.line)?;
            }
        }
    }
    for (class, (bombs, lines, failures, slowest)) in &classes {
        writeln!(
            out,
            "{class}: {bombs} bombs, {lines} command lines, {failures} failures, the slowest {slowest:.1} s"
        )?;
    }
    let failures: usize = classes.values().map(|(.., failures, _)| failures).sum();
    Ok(if failures == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
