//! Outputs: standard output, files and numbered frames.

use crate::console;
use crate::failure::{Failure, missing_folder};
use juggler::imaging::atomic;
use juggler::imaging::regular::{self, ReadError};
use std::io::{ErrorKind, IsTerminal};
use std::ops::Range;
use std::path::Path;

/// File name that stands for standard output.
pub const STANDARD_OUTPUT: &str = "-";

/// Writes a text and a line break to standard output, or atomically to a file.
pub fn write_text(output: &str, text: &str) -> Result<(), Failure> {
    if output == STANDARD_OUTPUT {
        return console::print_result(text);
    }
    atomic::write(Path::new(output), format!("{text}\n").as_bytes())
        .map_err(|error| Failure::file("write", output, &error))
}

/// Whether a regular file exists whose content is not `text`, apart from line breaks at its end.
pub fn differs(path: &Path, text: &str) -> bool {
    let text = text.trim_end();
    match regular::read(path, (text.len() as u64).saturating_add(64)) {
        Ok(bytes) => String::from_utf8_lossy(&bytes).trim_end() != text,
        Err(ReadError::TooLarge { .. }) => true,
        // The writer reports a file that it cannot replace.
        Err(ReadError::Io(_)) => false,
    }
}

/// File name of a frame: a row of `#`, or `%04d`, becomes the frame number padded with zeros.
/// Without one, an underscore and four digits are inserted before the extension.
pub fn numbered(name: &str, frame: u32) -> String {
    let (folder, file) = split(name);
    if let Some((place, digits)) = place_of_number(file) {
        let (head, tail) = (file.get(..place.start), file.get(place.end..));
        return format!("{folder}{}{frame:0digits$}{}", head.unwrap_or_default(), tail.unwrap_or_default());
    }
    with_suffix(name, &format!("_{frame:04}"))
}

/// Name pattern of the frames of a file without a placeholder: `turn_####.png` for `turn.png`.
pub fn pattern(name: &str) -> String {
    with_suffix(name, "_####")
}

/// File name with a suffix before the extension.
fn with_suffix(name: &str, suffix: &str) -> String {
    let (folder, file) = split(name);
    match file.rsplit_once('.') {
        Some((stem, ending)) if !stem.is_empty() => format!("{folder}{stem}{suffix}.{ending}"),
        _ => format!("{folder}{file}{suffix}"),
    }
}

/// Whether a file name has a placeholder for the frame number.
pub fn has_number(name: &str) -> bool {
    place_of_number(split(name).1).is_some()
}

/// Splits a path into its folder, with the separator, and its file name.
fn split(name: &str) -> (&str, &str) {
    let file = Path::new(name).file_name().and_then(|file| file.to_str()).unwrap_or(name);
    name.split_at(name.len().saturating_sub(file.len()))
}

/// Position of the frame number in a file name, and its minimum number of digits: the last row of
/// `#`, otherwise the last `%d`, `%4d` or `%04d`.
fn place_of_number(file: &str) -> Option<(Range<usize>, usize)> {
    if let Some(last) = file.rfind('#') {
        let start = file.get(..last)?.trim_end_matches('#').len();
        return Some((start..last + 1, last + 1 - start));
    }
    file.rmatch_indices('%').find_map(|(start, _)| {
        let (digits, _) = file.get(start + 1..)?.split_once('d')?;
        let is_width = digits.len() <= 2 && digits.bytes().all(|byte| byte.is_ascii_digit());
        is_width.then(|| (start..start + digits.len() + 2, digits.parse().unwrap_or(1)))
    })
}

/// Fails if a picture would go to a terminal, where its bytes are unreadable and may act as control
/// characters, or nowhere.
pub fn check_stream(output: &str) -> Result<(), Failure> {
    if output != STANDARD_OUTPUT {
        return Ok(());
    }
    if is_standard_output_closed() {
        return Err(Failure::Invalid(
            "-o - writes the picture to standard output, which is closed (or /dev/null, opened for reading and \
             writing): give a file (-o picture.png), or redirect the output to a file (> picture.png) or a program \
             (| display)"
                .into(),
        ));
    }
    if std::io::stdout().is_terminal() {
        return Err(Failure::Invalid(
            "-o - writes the picture to standard output, which is a terminal: give a file (-o picture.png), or \
             redirect the output to a file (> picture.png) or a program (| display)"
                .into(),
        ));
    }
    Ok(())
}

/// Whether the program started without standard output. The standard library then opens `/dev/null`
/// for reading and writing in its place; `> /dev/null` opens it for writing only.
fn is_standard_output_closed() -> bool {
    let is_null = std::fs::read_link("/proc/self/fd/1").is_ok_and(|file| file == Path::new("/dev/null"));
    is_null && std::fs::read_to_string("/proc/self/fdinfo/1").is_ok_and(|info| is_read_and_write(&info))
}

/// Whether a file of this `/proc` information was opened for reading and writing.
fn is_read_and_write(info: &str) -> bool {
    const ACCESS_MODE: u32 = 3;
    const READ_AND_WRITE: u32 = 2;
    let flags = info.lines().find_map(|line| line.strip_prefix("flags:"));
    let flags = flags.and_then(|flags| u32::from_str_radix(flags.trim(), 8).ok());
    flags.is_some_and(|flags| flags & ACCESS_MODE == READ_AND_WRITE)
}

/// Fails if the folder of a file does not exist, before anything is rendered.
pub fn check_folder(file: &str) -> Result<(), Failure> {
    match missing_folder(file).filter(|_| file != STANDARD_OUTPUT) {
        Some(_) => Err(Failure::file("write", file, &ErrorKind::NotFound.into())),
        None => Ok(()),
    }
}

/// Fails if both the picture and the statistics go to standard output.
pub fn at_most_one_stream(output: &str, stats: Option<&str>) -> Result<(), Failure> {
    if output == STANDARD_OUTPUT && stats == Some(STANDARD_OUTPUT) {
        return Err(Failure::Invalid("picture and statistics cannot both go to standard output".into()));
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
            ("f_%04d.png", "f_0007.png"),
            ("a%d/f%d.exr", "a%d/f7.exr"),
            ("%3d.png", "007.png"),
            ("f_%04d_##.png", "f_%04d_07.png"),
            ("50%done.png", "507one.png"),
            ("100%.png", "100%_0007.png"),
            ("a%xd.png", "a%xd_0007.png"),
        ];
        for (name, numbered_name) in known {
            assert_eq!(numbered(name, 7), numbered_name);
        }
        assert_eq!(numbered("f##.png", 12_345), "f12345.png");
        assert_eq!((pattern("a.b/turn.png").as_str(), pattern("turn").as_str()), ("a.b/turn_####.png", "turn_####"));
        assert!(has_number("f_%04d.webp") && has_number("a/f#.webp") && !has_number("a#/f.webp"));
    }

    #[test]
    fn access_mode_is_read_from_the_flags() {
        let info = |flags: &str| format!("pos:\t0\nflags:\t{flags}\nmnt_id:\t29\n");
        assert!(is_read_and_write(&info("0100002")) && is_read_and_write(&info("02100002")));
        let others = [info("0100000"), info("0100001"), info("0100020"), info("x"), String::new()];
        assert!(others.iter().all(|info| !is_read_and_write(info)));
    }

    #[test]
    fn only_one_output_may_be_standard_output() {
        assert!(at_most_one_stream("-", Some("-")).is_err());
        assert!(at_most_one_stream("-", Some("a.json")).is_ok() && at_most_one_stream("a.png", Some("-")).is_ok());
    }
}
