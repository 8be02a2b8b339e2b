//! Checks that arithmetic which affects pixels is the same on every machine: no mathematical
//! function of the platform, and no fused multiply-add unless its rounding cannot matter.

use juggler_golden::rust_files;
use std::fs;
use std::path::Path;

/// Crates whose arithmetic affects pixels.
const CRATES: [&str; 18] = [
    "math",
    "bvh",
    "bsdf",
    "shape",
    "texture",
    "material",
    "light",
    "camera",
    "world",
    "integrator",
    "render",
    "mesh",
    "scene",
    "import",
    "expression",
    "film",
    "imaging",
    "denoise",
];

/// Functions that the standard library takes from the platform or leaves unspecified;
/// `juggler_math::portable` has all of them.
const PLATFORM: [&str; 22] = [
    "sin", "cos", "tan", "sin_cos", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "exp2", "exp_m1",
    "ln", "ln_1p", "log2", "log10", "powf", "powi", "cbrt", "hypot",
];

/// Files with conservative tests, padded for the rounding of fused and unfused multiplication:
/// candidates are tested again, exactly.
const FUSED: [&str; 2] = ["bvh/src/node.rs", "bvh/src/triangles/common_origin.rs"];

/// Code of a file before its tests, without comments.
fn code(path: &Path) -> String {
    let is_test = ["tests.rs", "testing.rs"].iter().any(|name| path.ends_with(name))
        || path.iter().any(|part| ["tests", "contract", "testing", "benches"].iter().any(|t| part == *t));
    if is_test {
        return String::new();
    }
    let text = fs::read_to_string(path).unwrap();
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap_or_default();
    code.lines().map(|line| line.split("//").next().unwrap_or_default()).collect::<Vec<_>>().join("\n")
}

/// Platform functions that the code calls, and `mul_add` unless `fused`.
fn calls(code: &str, fused: bool) -> Vec<&'static str> {
    let called = |name: &&str| code.contains(&format!(".{name}(")) || code.contains(&format!("::{name}("));
    let ours = |name: &&str| {
        let pure = ["portable", "libm"].iter().any(|module| code.contains(&format!("{module}::{name}(")));
        pure && !code.contains(&format!(".{name}("))
    };
    let platform = PLATFORM.iter().filter(|name| called(name) && !ours(name)).copied();
    platform.chain((!fused && code.contains("mul_add")).then_some("mul_add")).collect()
}

#[test]
fn pixels_do_not_depend_on_the_platforms_functions() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = 0;
    for path in CRATES.iter().flat_map(|name| rust_files(&crates.join(name).join("src"))) {
        let name = path.strip_prefix(&crates).unwrap().display().to_string();
        files += 1;
        let found = calls(&code(&path), FUSED.contains(&name.as_str()));
        assert!(found.is_empty(), "{name} calls {found:?}: take them from juggler_math::portable");
    }
    assert!(files > 100, "the source was not found");
}

#[test]
fn the_check_can_fail() {
    assert_eq!(calls("let y = x.sin() + portable::cos(x);", false), ["sin"]);
    assert_eq!(calls("f32::powf(x, 2.0); a.mul_add(b, c)", false), ["powf", "mul_add"]);
    assert_eq!(calls("a.mul_add(b, c)", true), [""; 0]);
}
