//! The juggler program.
fn main() {}
