//! Parser of photometric files (IES LM-63-1986, 1991, 1995 and 2002): the distribution of a
//! luminaire's intensity over directions. Only photometry of type C is supported.

use super::ies::IesProfile;

/// Error in a photometric file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct InvalidIes {
    /// Line at fault, counted from 1.
    pub line: usize,
    /// Message that states the error and the valid values.
    pub message: String,
}

/// Limit on the number of angles, above that of any real file.
const MAX_ANGLES: usize = 2000;
const MAX_VALUES: usize = 1 << 20;

/// Iterator over the numbers after the keywords, with the line of each.
struct Numbers<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    /// Line of the last number.
    line: usize,
}

impl<'a> Numbers<'a> {
    fn new(lines: impl Iterator<Item = (usize, &'a str)> + 'a, line: usize) -> Self {
        let separates = |c: char| c.is_whitespace() || c == ',';
        let words = lines.flat_map(move |(line, text)| {
            text.split(separates).filter(|word| !word.is_empty()).map(move |word| (line, word))
        });
        Self { words: Box::new(words), line }
    }

    fn error<T>(&self, message: impl Into<String>) -> Result<T, InvalidIes> {
        Err(InvalidIes { line: self.line, message: message.into() })
    }

    fn next(&mut self, what: &str) -> Result<f32, InvalidIes> {
        let Some((line, word)) = self.words.next() else {
            return self.error(format!("the file ends where {what} should come"));
        };
        self.line = line;
        match word.parse::<f32>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => self.error(format!("{what} should be a number, it is \"{}\"", word.escape_debug())),
        }
    }

    fn count(&mut self, what: &str, max: usize) -> Result<usize, InvalidIes> {
        let number = self.next(what)?;
        if number.fract() == 0.0 && (1.0..=max as f32).contains(&number) {
            return Ok(number as usize);
        }
        self.error(format!("{what} should be a whole number from 1 to {max}, it is {number}"))
    }

    fn list(&mut self, what: &str, count: usize) -> Result<Vec<f32>, InvalidIes> {
        (0..count).map(|_| self.next(what)).collect()
    }

    /// Increasing angles between 0 and `max`, in degrees.
    fn angles(&mut self, what: &str, count: usize, max: f32) -> Result<Vec<f32>, InvalidIes> {
        let mut angles: Vec<f32> = Vec::new();
        for _ in 0..count {
            let angle = self.next(what)?;
            if !(0.0..=max).contains(&angle) || angles.last().is_some_and(|last| *last >= angle) {
                return self.error(format!("each {what} should be more than the one before, from 0 to {max}"));
            }
            angles.push(angle);
        }
        Ok(angles)
    }
}

/// Parses the text of a file.
pub(super) fn parse(text: &str) -> Result<IesProfile, InvalidIes> {
    let mut lines = (1..).zip(text.lines());
    let tilt =
        lines.by_ref().find_map(|(line, text)| text.trim().strip_prefix("TILT=").map(|tilt| (line, tilt.trim())));
    let Some((line, tilt)) = tilt else {
        let message = "this is not a photometric file: no line begins with \"TILT=\"".to_owned();
        return Err(InvalidIes { line: text.lines().count().max(1), message });
    };
    let mut numbers = Numbers::new(lines, line);
    if tilt == "INCLUDE" {
        // Skip the effect of tilt on the lamp: the luminaire is used in its measured orientation.
        numbers.next("the lamp's position in the luminaire")?;
        let pairs = numbers.count("the number of tilt angles", MAX_ANGLES)?;
        numbers.list("a tilt angle or its factor", 2 * pairs)?;
    }
    parse_photometry(&mut numbers)
}

/// Parses the numbers after the tilt.
fn parse_photometry(numbers: &mut Numbers<'_>) -> Result<IesProfile, InvalidIes> {
    numbers.next("the number of lamps")?;
    numbers.next("the lumens of a lamp")?;
    let mut factor = numbers.next("the multiplier of candelas")?;
    let rows = numbers.count("the number of vertical angles", MAX_ANGLES)?;
    let planes = numbers.count("the number of horizontal angles", MAX_ANGLES)?;
    if rows * planes > MAX_VALUES {
        return numbers.error(format!("{rows} times {planes} values are too many; the limit is {MAX_VALUES}"));
    }
    match numbers.next("the type of photometry")? {
        1.0 => {}
        2.0 => return numbers.error("type B photometry is not supported, only type C"),
        3.0 => return numbers.error("type A photometry is not supported, only type C"),
        other => return numbers.error(format!("the type of photometry should be 1, 2 or 3, it is {other}")),
    }
    numbers.list("the units and the dimensions of the luminous opening", 4)?;
    factor *= numbers.next("the ballast factor")?;
    // A ballast factor in 1986 and 1991; later versions reserve the field, and its value is 1.
    factor *= numbers.next("the ballast-lamp factor")?;
    numbers.next("the watts")?;
    let vertical = numbers.angles("vertical angle", rows, 180.0)?;
    let horizontal = numbers.angles("horizontal angle", planes, 360.0)?;
    let line = numbers.line;
    let mut candelas = Vec::new();
    for _ in 0..rows * planes {
        let value = numbers.next("a candela value")? * factor;
        if !(0.0..=1e30).contains(&value) {
            return numbers.error("candela values should be 0 or more, and not too large");
        }
        candelas.push(value);
    }
    IesProfile::from_planes(vertical, &horizontal, &candelas).map_err(|message| InvalidIes { line, message })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "IESNA:LM-63-1995\n[TEST] 1\nTILT=NONE\n";

    fn error_of(text: &str) -> (usize, String) {
        let error = parse(text).unwrap_err();
        (error.line, error.message)
    }

    #[test]
    fn faults_name_their_line() {
        for (text, line, part) in [
            ("", 1, "TILT="),
            ("hello\nworld", 2, "TILT="),
            (HEAD, 3, "the number of lamps"),
            (&format!("{HEAD}1 -1 1 3 x 1"), 4, "horizontal angles should be a number, it is \"x\""),
            (&format!("{HEAD}1 -1 1\n3 1 2 1 0 0 0"), 5, "type B"),
            (&format!("{HEAD}1 -1 1\n3 1 3 1 0 0 0"), 5, "type A"),
            (&format!("{HEAD}1 -1 1 3 1 4"), 4, "should be 1, 2 or 3"),
            (&format!("{HEAD}1 -1 1 0 1 1"), 4, "whole number from 1 to 2000"),
            (&format!("{HEAD}1 -1 1 1e30 1 1"), 4, "whole number"),
            (&format!("{HEAD}1 -1 1 2000 2000 1"), 4, "too many"),
            (&format!("{HEAD}1 -1 1 2 1 1 1 0 0 0\n1 1 10\n0 0\n"), 6, "vertical angle"),
            (&format!("{HEAD}1 -1 1 2 1 1 1 0 0 0\n1 1 10\n0 190\n"), 6, "180"),
            (&format!("{HEAD}1 -1 1 2 1 1 1 0 0 0\n1 1 10\n0 90\n0\n1 NaN"), 8, "NaN"),
            (&format!("{HEAD}1 -1 1 2 1 1 1 0 0 0\n1 1 10\n0 90\n0\n1 -2"), 8, "0 or more"),
            (&format!("{HEAD}1 -1 1 2 1 1 1 0 0 0\n1 1 10\n0 90\n0\n1"), 8, "the file ends"),
            (&format!("{HEAD}1 -1 1 2 2 1 1 0 0 0\n1 1 10\n0 90\n0 77\n1 2 3 4"), 7, "horizontal angles"),
            ("TILT=INCLUDE\n1\n2\n0 90\n1", 5, "the file ends"),
        ] {
            let (at, message) = error_of(text);
            assert!(at == line && message.contains(part), "{text:?}: line {at}: {message}");
        }
    }

    /// Truncated and corrupted files give a profile or an error, never a panic.
    #[test]
    fn corrupted_ies_files_never_panic() {
        let text = format!("{HEAD}1 -1 1 3 2 1 1 0 0 0\n1 1 10\n0 45 90\n0 90\n1 2 3\n4 5 6\n");
        parse(&text).unwrap();
        for cut in 0..text.len() {
            let _ = parse(&text[..cut]);
            for garbage in ["9", "-", ",", "\u{7f}", "e9"] {
                let _ = parse(&format!("{}{garbage}{}", &text[..cut], &text[cut + 1..]));
            }
        }
    }

    #[test]
    fn tilt_and_factors_are_read() {
        let plain = parse("TILT=NONE\n1 1000 2 2 1 1 1 0 0 0\n0.5 1 10\n0 90\n0\n30 10").unwrap();
        let tilted = parse(
            "IESNA91\n[A] b\n TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8\n1, 1000, 1, 2, 1, 1, 1, 0, 0, 0,\n1 1 10\n0 90\n0\n30 10",
        );
        assert_eq!(plain, tilted.unwrap());
        assert_eq!(plain.max_candelas(), 30.0);
    }
}
