//! `juggler scenes`: lists the built-in scenes with their descriptions.

use crate::console;
use crate::failure::Failure;
use juggler::scene::built_in_scenes;

/// Prints the list.
pub fn run() -> Result<(), Failure> {
    let scenes = built_in_scenes();
    let width = scenes.iter().map(|scene| scene.name.chars().count()).max().unwrap_or(0);
    let lines: Vec<String> =
        scenes.iter().map(|scene| format!("{:width$}  {}", scene.name, scene.description())).collect();
    console::print_result(&lines.join("\n"))
}
