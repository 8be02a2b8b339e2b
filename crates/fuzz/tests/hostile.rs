//! Mutations for every reader, and every number of the scene format at extreme values, in processes
//! with an address space of 2 GiB. The environment variables `JUGGLER_MUTATIONS` and
//! `JUGGLER_FIELDS` set their numbers.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

use juggler_fuzz::cases::{self, Outcome};
use juggler_fuzz::targets::TARGETS;
use juggler_fuzz::{fields, seeds};

const PROGRAM: &str = env!("CARGO_BIN_EXE_cases");

fn count(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(default)
}

#[test]
fn every_reader_accepts_its_seeds() {
    for target in TARGETS {
        let seeds = seeds::for_target(target.name);
        assert!(!seeds.is_empty(), "{} has no seeds", target.name);
        for seed in seeds {
            assert!((target.read)(&seed), "{}: {:?}", target.name, String::from_utf8_lossy(&seed));
        }
    }
}

#[test]
fn no_mutation_breaks_a_reader() {
    let count = count("JUGGLER_MUTATIONS", 200);
    let mut failures = Vec::new();
    for target in TARGETS {
        let Outcome { accepted, failures: own } = cases::run(PROGRAM, target.name, count);
        // A useful mutator yields both accepted and rejected files.
        assert!(accepted > 0 && accepted < count || !own.is_empty(), "{}: {accepted} of {count} accepted", target.name);
        failures.extend(own);
    }
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn every_number_of_the_format_may_be_extreme() {
    assert!(fields::fields().len() > 300, "{} numbers were found", fields::fields().len());
    let count = count("JUGGLER_FIELDS", 500);
    let Outcome { accepted, failures } = cases::run(PROGRAM, cases::FIELDS, count);
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
    assert!(accepted > count / 10, "{accepted} of {count} rendered");
}
