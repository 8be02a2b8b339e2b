//! Errors: what is wrong in a glTF file, and where.

use juggler_math::message;
use std::fmt;

/// Position in a glTF file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// Byte of a binary file, counted from 0.
    Byte(u64),
    /// Position in a text.
    Text {
        /// Line, counted from 1.
        line: u64,
        /// Byte of the line, counted from 1.
        column: u64,
    },
    /// JSON pointer (RFC 6901) into the document, such as `/accessors/7`.
    Pointer(String),
    /// Another file that the document names.
    File {
        /// Name of the file.
        name: String,
        /// JSON pointer to the name.
        pointer: String,
    },
}

impl fmt::Display for Place {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Byte(byte) => write!(formatter, "byte {byte}"),
            Self::Text { line, column } => write!(formatter, "line {line}, column {column}"),
            Self::Pointer(pointer) if pointer.is_empty() => write!(formatter, "document"),
            Self::Pointer(pointer) => write!(formatter, "{}", message::excerpt(pointer, message::MAX_QUOTE)),
            Self::File { name, pointer } => {
                let [name, pointer] = [name, pointer].map(|text| message::excerpt(text, message::MAX_QUOTE));
                write!(formatter, "{name} ({pointer})")
            }
        }
    }
}

/// A violation of the format's rules or of a limit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {message}")]
pub struct Fault {
    /// Position of the fault.
    pub place: Place,
    /// Description of the found and the expected content, in one line.
    pub message: String,
}

impl Fault {
    /// Fault at a place. Control characters and long names are removed from the message.
    pub fn new(place: Place, text: impl fmt::Display) -> Self {
        Self { place, message: message::line(&text.to_string()) }
    }

    /// Fault at a JSON pointer.
    pub fn at(pointer: impl fmt::Display, text: impl fmt::Display) -> Self {
        Self::new(Place::Pointer(pointer.to_string()), text)
    }
}

/// Error of reading a glTF file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", lines(file, faults, *omitted))]
pub struct GltfError {
    /// Name of the file.
    pub file: String,
    /// The faults in the order of their discovery; at least one.
    pub faults: Vec<Fault>,
    /// Number of further faults.
    pub omitted: usize,
}

impl GltfError {
    /// Error of a single fault.
    pub fn new(file: impl Into<String>, fault: Fault) -> Self {
        Self { file: file.into(), faults: vec![fault], omitted: 0 }
    }
}

/// One line for each fault.
fn lines(file: &str, faults: &[Fault], omitted: usize) -> String {
    let file = message::excerpt(file, message::MAX_QUOTE);
    let mut lines: Vec<String> = faults.iter().map(|fault| format!("{file}: {fault}")).collect();
    if omitted > 0 {
        lines.push(format!("{file}: {omitted} further errors"));
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_name_file_and_place() {
        let mut error = GltfError::new(
            "car.glb",
            Fault::at("/accessors/7", "needs 48 bytes from byte 1020, bufferView 3 has 1052"),
        );
        assert_eq!(error.to_string(), "car.glb: /accessors/7: needs 48 bytes from byte 1020, bufferView 3 has 1052");
        let place = Place::File { name: "textures/wood.png".into(), pointer: "/images/3/uri".into() };
        error.faults = vec![Fault::new(place, "no such file"), Fault::new(Place::Text { line: 3, column: 7 }, "odd")];
        error.omitted = 2;
        let lines = "car.glb: textures/wood.png (/images/3/uri): no such file\ncar.glb: line 3, column 7: odd\n\
                     car.glb: 2 further errors";
        assert_eq!(error.to_string(), lines);
        assert_eq!(Fault::at("", "missing field `asset`").to_string(), "document: missing field `asset`");
        assert_eq!(Fault::new(Place::Byte(12), "a\u{1b}[31m").to_string(), "byte 12: a\u{fffd}[31m");
    }
}
