//! Where results go: standard output, files, numbered frames.

use crate::console;
use crate::failure::Failure;
use juggler::imaging::atomic;
use std::path::Path;

/// The name that means standard output.
pub const STANDARD_OUTPUT: &str = "-";

/// Writes a text and a line break to a file, which it replaces when complete, or to standard output.
pub fn write_text(output: &str, text: &str) -> Result<(), Failure> {
    if output == STANDARD_OUTPUT {
        return console::print(text);
    }
    atomic::write(Path::new(output), format!("{text}\n").as_bytes())
        .map_err(|error| Failure::file("write", output, &error))
}

/// The name of a frame's file: a row of `#` becomes the number, filled with zeros; without one, the number
/// comes before the ending, after an underscore, in four digits.
pub fn numbered(name: &str, frame: u32) -> String {
    let path = Path::new(name);
    let file = path.file_name().and_then(|file| file.to_str()).unwrap_or(name);
    let (folder, file) = name.split_at(name.len() - file.len());
    if let Some(last) = file.rfind('#') {
        let head = file.get(..=last).unwrap_or_default();
        let digits = head.len() - head.trim_end_matches('#').len();
        let (head, tail) = (head.trim_end_matches('#'), file.get(last + 1..).unwrap_or_default());
        return format!("{folder}{head}{frame:0digits$}{tail}");
    }
    match file.rsplit_once('.') {
        Some((stem, ending)) if !stem.is_empty() => format!("{folder}{stem}_{frame:04}.{ending}"),
        _ => format!("{folder}{file}_{frame:04}"),
    }
}

/// Refuses what would write twice to standard output.
pub fn at_most_one_stream(output: &str, stats: Option<&str>) -> Result<(), Failure> {
    if output == STANDARD_OUTPUT && stats == Some(STANDARD_OUTPUT) {
        return Err(Failure::Wrong("picture and statistics cannot both go to standard output".into()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_have_numbers() {
        let known = [
            ("frame_####.png", "frame_0007.png"),
            ("##/f#.exr", "##/f7.exr"),
            ("a#b##c.png", "a#b07c.png"),
            ("juggler.png", "juggler_0007.png"),
            ("a.b/juggler.tone.png", "a.b/juggler.tone_0007.png"),
            (".png", ".png_0007"),
            ("é####ü.png", "é0007ü.png"),
        ];
        for (name, numbered_name) in known {
            assert_eq!(numbered(name, 7), numbered_name);
        }
        assert_eq!(numbered("f##.png", 12_345), "f12345.png");
    }

    #[test]
    fn one_thing_on_standard_output() {
        assert!(at_most_one_stream("-", Some("-")).is_err());
        assert!(at_most_one_stream("-", Some("a.json")).is_ok() && at_most_one_stream("a.png", Some("-")).is_ok());
    }
}
