//! Reading photometric files (IES LM-63-1986, 1991, 1995 and 2002): how strongly a luminaire shines into each
//! direction. Angles of type C; luminaires measured about other axes are refused.

use super::ies::Profile;

/// Why a photometric file cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {message}")]
pub struct InvalidIes {
    /// The line at fault, counted from 1.
    pub line: usize,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// More angles than any luminaire was ever measured at.
const MOST_ANGLES: usize = 2000;
const MOST_VALUES: usize = 1 << 20;

/// The numbers after the keywords, one by one, each with its line.
struct Numbers<'a> {
    words: Box<dyn Iterator<Item = (usize, &'a str)> + 'a>,
    /// Of the last number.
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

    fn wrong<T>(&self, message: impl Into<String>) -> Result<T, InvalidIes> {
        Err(InvalidIes { line: self.line, message: message.into() })
    }

    fn next(&mut self, what: &str) -> Result<f32, InvalidIes> {
        let Some((line, word)) = self.words.next() else {
            return self.wrong(format!("the file ends where {what} should come"));
        };
        self.line = line;
        match word.parse::<f32>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ => self.wrong(format!("{what} should be a number, it is \"{}\"", word.escape_debug())),
        }
    }

    fn count(&mut self, what: &str, most: usize) -> Result<usize, InvalidIes> {
        let number = self.next(what)?;
        if number.fract() == 0.0 && (1.0..=most as f32).contains(&number) {
            return Ok(number as usize);
        }
        self.wrong(format!("{what} should be a whole number from 1 to {most}, it is {number}"))
    }

    fn list(&mut self, what: &str, count: usize) -> Result<Vec<f32>, InvalidIes> {
        (0..count).map(|_| self.next(what)).collect()
    }

    /// Angles that grow, between bounds.
    fn angles(&mut self, what: &str, count: usize, most: f32) -> Result<Vec<f32>, InvalidIes> {
        let mut angles: Vec<f32> = Vec::new();
        for _ in 0..count {
            let angle = self.next(what)?;
            if !(0.0..=most).contains(&angle) || angles.last().is_some_and(|last| *last >= angle) {
                return self.wrong(format!("each {what} should be more than the one before, from 0 to {most}"));
            }
            angles.push(angle);
        }
        Ok(angles)
    }
}

/// Reads a file.
pub(super) fn read(text: &str) -> Result<Profile, InvalidIes> {
    let mut lines = (1..).zip(text.lines());
    let tilt =
        lines.by_ref().find_map(|(line, text)| text.trim().strip_prefix("TILT=").map(|tilt| (line, tilt.trim())));
    let Some((line, tilt)) = tilt else {
        let message = "this is no photometric file: it has no line that begins with \"TILT=\"".to_owned();
        return Err(InvalidIes { line: text.lines().count().max(1), message });
    };
    let mut numbers = Numbers::new(lines, line);
    if tilt == "INCLUDE" {
        // What tilting does to the lamp; a luminaire here hangs as it was measured.
        numbers.next("the lamp's position in the luminaire")?;
        let pairs = numbers.count("the number of tilt angles", MOST_ANGLES)?;
        numbers.list("a tilt angle or its factor", 2 * pairs)?;
    }
    measured(&mut numbers)
}

/// What stands after the tilt.
fn measured(numbers: &mut Numbers<'_>) -> Result<Profile, InvalidIes> {
    numbers.next("the number of lamps")?;
    numbers.next("the lumens of a lamp")?;
    let mut factor = numbers.next("the multiplier of candelas")?;
    let rows = numbers.count("the number of vertical angles", MOST_ANGLES)?;
    let planes = numbers.count("the number of horizontal angles", MOST_ANGLES)?;
    if rows * planes > MOST_VALUES {
        return numbers.wrong(format!("{rows} times {planes} values are too many, up to {MOST_VALUES} can be used"));
    }
    match numbers.next("the type of photometry")? {
        1.0 => {}
        2.0 => return numbers.wrong("photometry of type B cannot be used, only of type C"),
        3.0 => return numbers.wrong("photometry of type A cannot be used, only of type C"),
        other => return numbers.wrong(format!("the type of photometry should be 1, 2 or 3, it is {other}")),
    }
    numbers.list("the units and the size of the opening", 4)?;
    factor *= numbers.next("the ballast factor")?;
    // A factor of the ballast's in 1986 and 1991; reserved since then, and always 1.
    factor *= numbers.next("the ballast-lamp factor")?;
    numbers.next("the watts")?;
    let vertical = numbers.angles("vertical angle", rows, 180.0)?;
    let horizontal = numbers.angles("horizontal angle", planes, 360.0)?;
    let line = numbers.line;
    let mut candelas = Vec::new();
    for _ in 0..rows * planes {
        let value = numbers.next("a candela value")? * factor;
        if !(0.0..=1e30).contains(&value) {
            return numbers.wrong("candela values should be 0 or more, and not too large");
        }
        candelas.push(value);
    }
    Profile::new(vertical, &horizontal, &candelas).map_err(|message| InvalidIes { line, message })
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "IESNA:LM-63-1995\n[TEST] 1\nTILT=NONE\n";

    fn fault(text: &str) -> (usize, String) {
        let error = read(text).unwrap_err();
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
            let (at, message) = fault(text);
            assert!(at == line && message.contains(part), "{text:?}: line {at}: {message}");
        }
    }

    /// Whatever is cut off or garbled, reading ends with a profile or a fault.
    #[test]
    fn nothing_breaks_the_reader() {
        let text = format!("{HEAD}1 -1 1 3 2 1 1 0 0 0\n1 1 10\n0 45 90\n0 90\n1 2 3\n4 5 6\n");
        read(&text).unwrap();
        for cut in 0..text.len() {
            let _ = read(&text[..cut]);
            for garbage in ["9", "-", ",", "\u{7f}", "e9"] {
                let _ = read(&format!("{}{garbage}{}", &text[..cut], &text[cut + 1..]));
            }
        }
    }

    #[test]
    fn tilt_and_factors_are_read() {
        let plain = read("TILT=NONE\n1 1000 2 2 1 1 1 0 0 0\n0.5 1 10\n0 90\n0\n30 10").unwrap();
        let tilted = read(
            "IESNA91\n[A] b\n TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8\n1, 1000, 1, 2, 1, 1, 1, 0, 0, 0,\n1 1 10\n0 90\n0\n30 10",
        );
        assert_eq!(plain, tilted.unwrap());
        assert_eq!(plain.greatest(), 30.0);
    }
}
