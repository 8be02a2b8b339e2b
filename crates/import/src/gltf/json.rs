//! Parsing of the JSON text to a [`Document`], with the place of an error.

use super::document::Document;
use super::error::{Fault, Place};
use super::limits::Limits;
use super::location::escaped;
use serde::Deserialize;
use serde_json::error::Category;
use serde_path_to_error::{Path, Segment};

/// JSON text of a file.
#[derive(Clone, Copy)]
pub(super) struct Json<'t> {
    /// The text.
    pub text: &'t [u8],
    /// Position of the text in a binary file; `None` if the text is the file.
    pub offset: Option<usize>,
}

/// Parses a document.
///
/// # Errors
///
/// The text is not valid JSON or exceeds a limit, or a property has the wrong type.
pub(super) fn parse(json: Json<'_>, limits: &Limits) -> Result<Document, Fault> {
    scan(json, limits)?;
    let mut deserializer = serde_json::Deserializer::from_slice(json.text);
    let document = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let fault = || json.fault(error.inner(), Some(error.path()));
        json.version_fault().unwrap_or_else(fault)
    })?;
    deserializer.end().map_err(|error| json.fault(&error, None))?;
    Ok(document)
}

impl Json<'_> {
    /// Fault of a document of glTF 1, whose properties have other types.
    fn version_fault(self) -> Option<Fault> {
        #[derive(Deserialize)]
        struct Head {
            asset: Option<Version>,
        }
        #[derive(Deserialize)]
        struct Version {
            version: serde_json::Value,
        }
        let head: Head = serde_json::from_slice(self.text).ok()?;
        let version = head.asset?.version;
        let is_old = version.as_str().is_some_and(|text| text.starts_with("1.")) || version.as_f64() == Some(1.0);
        is_old.then(|| Fault::at("/asset/version", "glTF 1.0; convert it first"))
    }

    /// Fault of an error, at the property that caused it if the JSON is valid.
    fn fault(self, error: &serde_json::Error, property: Option<&Path>) -> Fault {
        match property.filter(|_| error.classify() == Category::Data) {
            Some(property) => Fault::at(pointer(property), without_position(error)),
            None => Fault::new(self.place(error.line(), error.column()), without_position(error)),
        }
    }

    /// Place of a line and column, counted from 1.
    fn place(self, line: usize, column: usize) -> Place {
        let Some(offset) = self.offset else { return Place::Text { line: line as u64, column: column as u64 } };
        let ends = self.text.iter().enumerate().filter(|(_, byte)| **byte == b'\n').map(|(end, _)| end + 1);
        let start = line.checked_sub(2).and_then(|skipped| ends.clone().nth(skipped)).unwrap_or(0);
        Place::Byte((offset + start + column.saturating_sub(1)) as u64)
    }

    /// Place of a byte of the text.
    fn place_of_byte(self, position: usize) -> Place {
        let before = self.text.get(..position).unwrap_or(self.text);
        let line_start = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1);
        let line = before.iter().filter(|byte| **byte == b'\n').count() + 1;
        self.place(line, position - line_start + 1)
    }
}

/// Message of an error without its position.
fn without_position(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let position = format!(" at line {} column {}", error.line(), error.column());
    text.strip_suffix(&position).map_or_else(|| text.clone(), str::to_owned)
}

/// JSON pointer of the path of a value.
fn pointer(path: &Path) -> String {
    let tokens = path.iter().map(|segment| match segment {
        Segment::Seq { index } => format!("/{index}"),
        Segment::Map { key } => format!("/{}", escaped(key)),
        Segment::Enum { variant } => format!("/{}", escaped(variant)),
        Segment::Unknown => String::new(),
    });
    tokens.collect()
}

/// Checks nesting and numbers of elements before the document takes memory. Whether the text is
/// valid JSON does not matter here.
fn scan(json: Json<'_>, limits: &Limits) -> Result<(), Fault> {
    let (mut depth, mut containers, mut commas) = (0_usize, 0_usize, 0_usize);
    let mut key: &[u8] = b"";
    let mut position = 0;
    while let Some(byte) = json.text.get(position) {
        match byte {
            b'"' => {
                let end = string_end(json.text, position + 1);
                if depth == 1 {
                    key = json.text.get(position + 1..end).unwrap_or_default();
                }
                position = end;
            }
            b'{' | b'[' => {
                (depth, containers) = (depth + 1, containers + 1);
                if depth > limits.json_nesting {
                    let text = format!("arrays and objects are nested more than {} deep", limits.json_nesting);
                    return Err(Fault::new(json.place_of_byte(position), text));
                }
                if containers > limits.json_containers {
                    let text = format!("there are more than {} arrays and objects, the limit", limits.json_containers);
                    return Err(Fault::new(json.place_of_byte(position), text));
                }
                commas = if depth == 2 { 0 } else { commas };
            }
            b'}' | b']' => depth = depth.saturating_sub(1),
            b',' if depth == 2 => {
                commas += 1;
                check_count(key, commas + 1, limits)?;
            }
            _ => {}
        }
        position += 1;
    }
    Ok(())
}

/// Position of the quotation mark that ends a string.
fn string_end(text: &[u8], start: usize) -> usize {
    let mut position = start;
    loop {
        let rest = text.get(position..).unwrap_or_default();
        let Some(found) = rest.iter().position(|byte| matches!(byte, b'"' | b'\\')) else { return text.len() };
        position += found;
        if text.get(position) == Some(&b'"') {
            return position;
        }
        position += 2;
    }
}

/// Checks the number of elements of an array of the document.
fn check_count(key: &[u8], count: usize, limits: &Limits) -> Result<(), Fault> {
    let limit = match key {
        b"nodes" | b"meshes" => limits.nodes,
        b"accessors" | b"bufferViews" => limits.accessors,
        b"materials" => limits.materials,
        _ => return Ok(()),
    };
    if count <= limit {
        return Ok(());
    }
    let key = String::from_utf8_lossy(key);
    Err(Fault::at(format!("/{key}"), format!("there are more than {limit} {key}, the limit")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        parse(Json { text: text.as_bytes(), offset: None }, &Limits::default()).unwrap_err().to_string()
    }

    #[test]
    fn wrong_types_have_a_pointer() {
        let message = |rest: &str| message(&format!("{{\"asset\": {{\"version\": \"2.0\"}}, {rest}}}"));
        assert_eq!(
            message(r#""nodes": [{}, {"mesh": -1}]"#),
            "/nodes/1/mesh: invalid value: integer `-1`, expected an integer from 0 to 4294967295"
        );
        assert_eq!(
            message(r#""accessors": [{"componentType": 5124, "count": 1, "type": "SCALAR"}]"#),
            "/accessors/0/componentType: there is no component type 5124, expected one of 5120 to 5123, 5125, 5126"
        );
        assert_eq!(message(r#""buffers": [{}]"#), "/buffers/0: missing field `byteLength`");
        let mode = message(r#""meshes": [{"primitives": [{"attributes": {}, "mode": 7}]}]"#);
        assert_eq!(mode, "/meshes/0/primitives/0/mode: there is no mode 7, expected 0 to 6");
        let twice = message(r#""scene": 0, "scene": 1"#);
        assert_eq!(twice, "document: duplicate field `scene`");
        let unknown = message("\"cameras\": [{\"type\": \"\\u001b[31m\"}]");
        assert!(unknown.starts_with("/cameras/0/type: unknown variant `\u{fffd}[31m`"), "{unknown}");
        assert_eq!(tests::message("{}"), "document: missing field `asset`");
    }

    #[test]
    fn wrong_json_has_a_line_or_a_byte() {
        assert_eq!(message("{\n \"asset\" 2}"), "line 2, column 10: expected `:`");
        let binary = Json { text: b"{\n \"asset\" 2}", offset: Some(20) };
        let error = parse(binary, &Limits::default()).unwrap_err().to_string();
        assert_eq!(error, "byte 31: expected `:`");
        assert!(message("").starts_with("line 1, column 0: EOF"), "{}", message(""));
        assert!(message("{\"a\": \"\\").contains("EOF"), "{}", message("{\"a\": \"\\"));
    }

    #[test]
    fn old_versions_are_named() {
        let old = r#"{"asset": {"version": "1.0"}, "accessors": {"a": {}}}"#;
        assert_eq!(message(old), "/asset/version: glTF 1.0; convert it first");
        assert_eq!(message(&old.replace("\"1.0\"", "1.0")), "/asset/version: glTF 1.0; convert it first");
    }

    #[test]
    fn nesting_and_counts_are_limited() {
        let nested = |depth: usize| {
            format!("{{\"asset\": {{\"version\": \"2.0\"}}, \"extras\": {}{}}}", "[".repeat(depth), "]".repeat(depth))
        };
        let parse = |text: &str, limits: Limits| parse(Json { text: text.as_bytes(), offset: None }, &limits);
        assert!(parse(&nested(63), Limits::default()).is_ok());
        let error = parse(&nested(64), Limits::default()).unwrap_err().to_string();
        assert!(error.ends_with("arrays and objects are nested more than 64 deep"), "{error}");
        let text = r#"{"asset": {"version": "2.0", "generator": "[[[{{{"}, "nodes": [{}, {}, {"name": ",,,"}]}"#;
        let limits = Limits { nodes: 3, json_nesting: 3, json_containers: 6, ..Limits::default() };
        assert!(parse(text, limits).is_ok());
        let error = parse(text, Limits { nodes: 2, ..limits }).unwrap_err().to_string();
        assert_eq!(error, "/nodes: there are more than 2 nodes, the limit");
        let error = parse(text, Limits { json_containers: 5, ..limits }).unwrap_err().to_string();
        assert_eq!(error, "line 1, column 72: there are more than 5 arrays and objects, the limit");
    }
}
