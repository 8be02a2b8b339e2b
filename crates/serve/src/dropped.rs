//! Files that a page uploads because they were dropped on it: a scene, model or mesh with the files
//! that it names. They stay in memory, and the scene reads no others.
//!
//! The body of an upload consists of the length of a JSON text in bytes (u32, little-endian), the
//! text `{"name": "duck.gltf", "files": [["duck.gltf", 2000], ["duck.bin", 300]]}`, and the bytes
//! of the files in this order.

use juggler_session::SceneFiles;
use serde::Deserialize;

/// Maximum length of the JSON text, in bytes.
const MAX_HEAD: usize = 1 << 20;
/// Maximum number of files.
const MAX_FILES: usize = 10_000;
/// Maximum length of a name, in bytes.
const MAX_NAME: usize = 1024;

/// Names and sizes of the files.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    name: String,
    files: Vec<(String, u64)>,
}

/// Reads the body of an upload. An error is the reason of the refusal.
pub fn parse(body: &[u8]) -> Result<SceneFiles, &'static str> {
    const CUT: &str = "the upload is shorter than it says";
    let (length, rest) = body.split_first_chunk().ok_or(CUT)?;
    let length = usize::try_from(u32::from_le_bytes(*length)).unwrap_or(usize::MAX);
    if length > MAX_HEAD {
        return Err("the list of files is too long");
    }
    let (head, mut rest) = rest.split_at_checked(length).ok_or(CUT)?;
    let Head { name, files } = serde_json::from_slice(head).map_err(|_| "the list of files is not valid")?;
    if files.len() > MAX_FILES || files.iter().any(|(name, _)| name.len() > MAX_NAME || name.is_empty()) {
        return Err("there are too many files, or a name is empty or too long");
    }
    if files.iter().all(|(file, _)| *file != name) {
        return Err("the scene is not among the files");
    }
    let mut contents = Vec::with_capacity(files.len());
    for (name, size) in files {
        let size = usize::try_from(size).map_err(|_| CUT)?;
        let (bytes, after) = rest.split_at_checked(size).ok_or(CUT)?;
        contents.push((name, bytes.to_vec()));
        rest = after;
    }
    if !rest.is_empty() {
        return Err("the upload is longer than it says");
    }
    Ok(SceneFiles { name, files: contents.into_iter().collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body(head: &str, bytes: &[u8]) -> Vec<u8> {
        [&(head.len() as u32).to_le_bytes(), head.as_bytes(), bytes].concat()
    }

    #[test]
    fn files_are_cut_from_the_body() {
        let found = parse(&body(r#"{"name": "a.obj", "files": [["a.mtl", 2], ["a.obj", 3]]}"#, b"xyabc")).unwrap();
        let expected = [("a.mtl", &b"xy"[..]), ("a.obj", b"abc")];
        assert_eq!(found.name, "a.obj");
        assert_eq!(found.files, expected.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect());
    }

    #[test]
    fn malformed_uploads_are_refused() {
        let one = r#"{"name": "a", "files": [["a", 3]]}"#;
        assert!(parse(&body(one, b"abc")).is_ok());
        let huge = one.replace('3', "18446744073709551615");
        let wrong = [
            Vec::new(),
            vec![9, 0, 0],
            vec![255; 8],
            body(one, b"ab"),
            body(one, b"abcd"),
            body(&huge, b"abc"),
            body(&one.replace('3', "-1"), b"abc"),
            body(&one.replace(r#"name": "a"#, r#"name": "b"#), b"abc"),
            body(&one.replace('a', ""), b"abc"),
            body(&one.replace('a', &"a".repeat(2000)), b"abc"),
            body("{}", b""),
            body(r#"{"name": "a", "files": [["a", 0]], "b": 1}"#, b""),
        ];
        for (number, body) in wrong.iter().enumerate() {
            assert!(parse(body).is_err(), "{number}");
        }
    }
}
