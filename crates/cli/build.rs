//! Version of the compiler for `--stats`: the variable `JUGGLER_COMPILER` of the build.

use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(compiler).arg("--version").output();
    let version = output.map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned());
    println!("cargo::rustc-env=JUGGLER_COMPILER={}", version.unwrap_or_default());
}
