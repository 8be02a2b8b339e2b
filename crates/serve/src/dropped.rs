//! Files that a page uploads because they were dropped on it: a scene, model or mesh with the files
//! that it names. They stay in memory, and the scene reads no others.
//!
//! The body of an upload consists of the length of a JSON text in bytes (u32, little-endian), the
//! text `{"name": "duck.gltf", "files": [["duck.gltf", 2000], ["duck.bin", 300]]}`, and the bytes
//! of the files in this order. Each file is received into its own memory, so that an upload needs no
//! more memory than its files.

use axum::body::{Body, BodyDataStream, Bytes};
use axum::http::StatusCode;
use futures_util::StreamExt;
use juggler_session::SceneFiles;
use serde::Deserialize;
use std::time::Duration;
use tokio::time::timeout;

/// Maximum length of the JSON text, in bytes.
const MAX_HEAD: usize = 1 << 20;
/// Maximum number of files.
const MAX_FILES: usize = 10_000;
/// Maximum length of a name, in bytes.
const MAX_NAME: usize = 1024;

/// Why an upload is refused. The messages contain nothing of the upload.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum UploadError {
    /// No byte arrived for too long.
    #[error("the upload stopped: no byte arrived for too long")]
    Silent,
    /// The connection broke.
    #[error("the connection broke during the upload")]
    Broken,
    /// The body exceeds the limit, or the machine has no memory for it.
    #[error("the files are larger than the limit")]
    TooLarge,
    /// The body ends early.
    #[error("the upload is shorter than it says")]
    Cut,
    /// The body has another form than described above.
    #[error("{0}")]
    Malformed(&'static str),
}

impl UploadError {
    /// Status of the response.
    pub fn status(self) -> StatusCode {
        match self {
            Self::Silent => StatusCode::REQUEST_TIMEOUT,
            Self::TooLarge => StatusCode::PAYLOAD_TOO_LARGE,
            Self::Broken | Self::Cut | Self::Malformed(_) => StatusCode::BAD_REQUEST,
        }
    }
}

/// Names and sizes of the files.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    name: String,
    files: Vec<(String, u64)>,
}

/// Body of an upload while it is received.
struct Upload {
    stream: BodyDataStream,
    /// Bytes that have arrived and belong to no file yet.
    received: Bytes,
    /// Maximum number of bytes that may still arrive.
    left: u64,
    /// Maximum time without a byte.
    silence: Duration,
}

/// Receives an upload of this `length`, or of at most `limit` bytes if none is stated. It fails if no
/// byte arrives for the time `silence`.
pub async fn receive(
    body: Body,
    length: Option<u64>,
    limit: u64,
    silence: Duration,
) -> Result<SceneFiles, UploadError> {
    let left = length.unwrap_or(limit);
    let mut upload = Upload { stream: body.into_data_stream(), received: Bytes::new(), left, silence };
    let text = upload.take(4).await?.first_chunk().map_or(u32::MAX, |bytes| u32::from_le_bytes(*bytes));
    let text = usize::try_from(text).ok().filter(|bytes| *bytes <= MAX_HEAD);
    let text = text.ok_or(UploadError::Malformed("the list of files is too long"))?;
    let Head { name, files } = head(&upload.take(text).await?)?;
    let sizes = files.iter().map(|(_, size)| *size).fold(0, u64::saturating_add);
    if sizes > upload.left.saturating_add(upload.received.len() as u64) {
        return Err(if length.is_some() { UploadError::Cut } else { UploadError::TooLarge });
    }
    let mut contents = Vec::with_capacity(files.len());
    for (name, size) in files {
        let size = usize::try_from(size).map_err(|_| UploadError::TooLarge)?;
        contents.push((name, upload.take(size).await?));
    }
    upload.end().await?;
    Ok(SceneFiles { name, files: contents.into_iter().collect() })
}

/// Reads and checks the JSON text.
fn head(text: &[u8]) -> Result<Head, UploadError> {
    let head: Head =
        serde_json::from_slice(text).map_err(|_| UploadError::Malformed("the list of files is not valid"))?;
    if head.files.len() > MAX_FILES || head.files.iter().any(|(name, _)| name.len() > MAX_NAME || name.is_empty()) {
        return Err(UploadError::Malformed("there are too many files, or a name is empty or too long"));
    }
    if head.files.iter().all(|(file, _)| *file != head.name) {
        return Err(UploadError::Malformed("the scene is not among the files"));
    }
    Ok(head)
}

impl Upload {
    /// Takes the next `count` bytes of the body, for which memory is reserved once.
    async fn take(&mut self, count: usize) -> Result<Vec<u8>, UploadError> {
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(count).map_err(|_| UploadError::TooLarge)?;
        while bytes.len() < count {
            if self.received.is_empty() && !self.arrive().await? {
                return Err(UploadError::Cut);
            }
            let missing = count.saturating_sub(bytes.len());
            bytes.extend_from_slice(&self.received.split_to(missing.min(self.received.len())));
        }
        Ok(bytes)
    }

    /// Waits for the next bytes; `false` at the end of the body.
    async fn arrive(&mut self) -> Result<bool, UploadError> {
        match timeout(self.silence, self.stream.next()).await {
            Err(_) => Err(UploadError::Silent),
            Ok(None) => Ok(false),
            Ok(Some(Err(_))) => Err(UploadError::Broken),
            Ok(Some(Ok(bytes))) => {
                self.left = self.left.checked_sub(bytes.len() as u64).ok_or(UploadError::TooLarge)?;
                self.received = bytes;
                Ok(true)
            }
        }
    }

    /// Checks that nothing follows.
    async fn end(mut self) -> Result<(), UploadError> {
        while self.received.is_empty() {
            if !self.arrive().await? {
                return Ok(());
            }
        }
        Err(UploadError::Malformed("the upload is longer than it says"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use futures_util::stream;
    use std::convert::Infallible;

    /// Limit of an upload without a stated length: a length, a JSON text of 37 bytes, and files.
    const LIMIT: u64 = 10_000;

    fn body(head: &str, bytes: &[u8]) -> Vec<u8> {
        [&(head.len() as u32).to_le_bytes(), head.as_bytes(), bytes].concat()
    }

    /// Receives a body that arrives in pieces of `size` bytes.
    fn received(body: &[u8], size: usize, length: Option<u64>) -> Result<SceneFiles, UploadError> {
        let pieces = body.chunks(size).map(|piece| Ok::<_, Infallible>(Bytes::copy_from_slice(piece)));
        let body = Body::from_stream(stream::iter(pieces.collect::<Vec<_>>()));
        let runtime = tokio::runtime::Builder::new_current_thread().enable_time().build().unwrap();
        runtime.block_on(receive(body, length, LIMIT, Duration::from_secs(30)))
    }

    /// Receives a body of stated length.
    fn whole(body: &[u8]) -> Result<SceneFiles, UploadError> {
        received(body, 5, Some(body.len() as u64))
    }

    #[test]
    fn files_are_cut_from_the_body() {
        let body = body(r#"{"name": "a.obj", "files": [["a.mtl", 2], ["empty", 0], ["a.obj", 3]]}"#, b"xyabc");
        let expected = [("a.mtl", &b"xy"[..]), ("empty", b""), ("a.obj", b"abc")];
        for size in [1, 2, 3, 7, 1000] {
            for length in [None, Some(body.len() as u64)] {
                let found = received(&body, size, length).unwrap();
                assert_eq!(found.name, "a.obj");
                let files = expected.into_iter().map(|(name, bytes)| (name.to_owned(), bytes.to_vec()));
                assert_eq!(found.files, files.collect());
            }
        }
    }

    #[test]
    fn malformed_uploads_are_refused() {
        let one = r#"{"name": "a", "files": [["a", 3]]}"#;
        assert!(whole(&body(one, b"abc")).is_ok());
        let huge = one.replace('3', "18446744073709551615");
        for cut in [Vec::new(), vec![9, 0, 0], body(one, b"ab"), body(&huge, b"abc")] {
            assert_eq!(whole(&cut).unwrap_err(), UploadError::Cut);
        }
        let wrong = [
            vec![255; 8],
            body(one, b"abcd"),
            body(&one.replace('3', "-1"), b"abc"),
            body(&one.replace(r#"name": "a"#, r#"name": "b"#), b"abc"),
            body(&one.replace('a', ""), b"abc"),
            body(&one.replace('a', &"a".repeat(2000)), b"abc"),
            body("{}", b""),
            body(r#"{"name": "a", "files": [["a", 0]], "b": 1}"#, b""),
        ];
        for (number, body) in wrong.iter().enumerate() {
            assert!(matches!(whole(body), Err(UploadError::Malformed(_))), "{number}");
        }
    }

    #[test]
    fn uploads_without_a_stated_length_are_limited() {
        let sized = |size: usize, sent: usize| {
            let head = format!(r#"{{"name": "a", "files": [["a", {size}]]}}"#);
            received(&body(&head, &vec![b' '; sent]), 100, None).map(drop)
        };
        let most = LIMIT as usize - 41;
        assert_eq!(sized(most, most), Ok(()));
        assert_eq!(sized(most + 1, most + 1), Err(UploadError::TooLarge), "before the files arrive");
        assert_eq!(sized(most, most + 100), Err(UploadError::TooLarge), "when they arrive");
        assert_eq!(sized(most, most - 1), Err(UploadError::Cut));
    }
}
