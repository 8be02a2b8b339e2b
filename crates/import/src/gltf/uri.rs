//! Names of other files (URIs, RFC 3986) and data that stands in the document (data URIs, RFC
//! 2397).
//!
//! Names are relative to the folder of the document and stay inside it. Other URIs are refused by
//! name, because a scene file must not make the program open arbitrary files or connections.

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::borrow::Cow;

/// Decoder of base64 that accepts missing padding and unused bits, as browsers do.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// Why a URI is not read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum UriError {
    /// The URI is empty.
    #[error("the name of the file is empty")]
    Empty,
    /// The URI has a scheme, such as `https`.
    #[error("`{uri}`: URIs with the scheme `{scheme}` are not read; copy the file beside the document")]
    Scheme {
        /// The URI.
        uri: String,
        /// Its scheme.
        scheme: String,
    },
    /// The name is an absolute path.
    #[error("`{0}` is an absolute path; only files in the folder of the document are read")]
    Absolute(String),
    /// The name leaves the folder of the document by `..`.
    #[error("`{0}` leaves the folder of the document; only files in it are read")]
    Outside(String),
    /// The name contains a control character.
    #[error("`{0}` contains a control character")]
    Control(String),
    /// The data URI has no comma before its data.
    #[error("the data URI has no comma, which ends its type")]
    Comma,
    /// The data URI has a `%` without two hexadecimal digits.
    #[error("the data URI has a `%` that two hexadecimal digits do not follow")]
    Percent,
    /// The data URI is not valid base64.
    #[error("the data URI is not valid base64: {0}")]
    Base64(String),
}

/// Data of a data URI.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EncodedData<'u> {
    /// Base64; percent-encoding is possible.
    Base64(&'u str),
    /// Percent-encoding: each byte stands for itself or is `%` with two hexadecimal digits.
    Percent(&'u str),
}

/// A URI of a buffer or an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Uri<'u> {
    /// Data in the document.
    Data {
        /// Type of the data, such as `image/png`; empty if the URI states none.
        media_type: &'u str,
        /// The data, encoded.
        data: EncodedData<'u>,
    },
    /// Names of a file in the order in which they are tried: percent-decoded, then as written. The
    /// separators are `/`.
    File(Vec<String>),
}

impl<'u> Uri<'u> {
    /// First name of a file; `None` for data.
    pub fn file_name(&self) -> Option<&str> {
        match self {
            Self::Data { .. } => None,
            Self::File(names) => names.first().map(String::as_str),
        }
    }

    /// Classifies a URI.
    ///
    /// # Errors
    ///
    /// The URI names something outside of the document's folder, or data in an unknown encoding.
    pub fn parse(uri: &'u str) -> Result<Self, UriError> {
        if let Some((scheme, rest)) = split_scheme(uri) {
            return match scheme.to_ascii_lowercase().as_str() {
                "data" => data(rest),
                drive if drive.len() == 1 => Err(UriError::Absolute(uri.to_owned())),
                scheme => Err(UriError::Scheme { uri: uri.to_owned(), scheme: scheme.to_owned() }),
            };
        }
        let mut names = Vec::new();
        let decoded = percent_decoded(uri.as_bytes()).and_then(|bytes| String::from_utf8(bytes).ok());
        for name in [decoded.as_deref(), Some(uri)].into_iter().flatten() {
            let name = file_name(name)?;
            if !names.contains(&name) {
                names.push(name);
            }
        }
        Ok(Self::File(names))
    }
}

/// Decodes the data of a data URI.
///
/// # Errors
///
/// The text is not valid base64 or percent-encoding.
pub fn decode(data: EncodedData<'_>) -> Result<Vec<u8>, UriError> {
    let base64 = match data {
        EncodedData::Base64(base64) => base64,
        EncodedData::Percent(text) => return percent_decoded(text.as_bytes()).ok_or(UriError::Percent),
    };
    let decoded = base64.contains('%').then(|| percent_decoded(base64.as_bytes())).flatten();
    let text = decoded.map_or(Cow::Borrowed(base64.as_bytes()), Cow::Owned);
    BASE64.decode(text).map_err(|error| UriError::Base64(error.to_string()))
}

/// The scheme of a URI, and what follows its colon.
fn split_scheme(uri: &str) -> Option<(&str, &str)> {
    let (scheme, rest) = uri.split_once(':')?;
    let is_scheme = scheme.starts_with(|first: char| first.is_ascii_alphabetic())
        && scheme.chars().all(|c| c.is_ascii_alphanumeric() || "+-.".contains(c));
    is_scheme.then_some((scheme, rest))
}

/// The parts of a data URI after `data:`.
fn data(rest: &str) -> Result<Uri<'_>, UriError> {
    let (head, data) = rest.split_once(',').ok_or(UriError::Comma)?;
    let (head, data) = match head.rsplit_once(';') {
        Some((head, encoding)) if encoding.trim().eq_ignore_ascii_case("base64") => (head, EncodedData::Base64(data)),
        _ => (head, EncodedData::Percent(data)),
    };
    let media_type = head.split(';').next().unwrap_or_default().trim();
    Ok(Uri::Data { media_type, data })
}

/// Checks the name of a file; returns it with the separators `/`.
fn file_name(name: &str) -> Result<String, UriError> {
    if name.is_empty() {
        return Err(UriError::Empty);
    }
    if name.chars().any(char::is_control) {
        return Err(UriError::Control(name.to_owned()));
    }
    if let Some((scheme, _)) = split_scheme(name)
        && scheme.len() == 1
    {
        return Err(UriError::Absolute(name.to_owned()));
    }
    let unified = name.replace('\\', "/");
    if unified.starts_with('/') {
        return Err(UriError::Absolute(name.to_owned()));
    }
    let mut depth = 0_usize;
    for step in unified.split('/') {
        depth = match step {
            "" | "." => depth,
            ".." => depth.checked_sub(1).ok_or_else(|| UriError::Outside(name.to_owned()))?,
            _ => depth + 1,
        };
    }
    Ok(unified)
}

/// Text with each `%` and two hexadecimal digits replaced by their byte; `None` if a `%` has no
/// digits.
fn percent_decoded(text: &[u8]) -> Option<Vec<u8>> {
    let mut decoded = Vec::with_capacity(text.len());
    let mut rest = text;
    while let Some((first, after)) = rest.split_first() {
        rest = after;
        if *first == b'%' {
            let ([high, low], after) = after.split_first_chunk::<2>()?;
            decoded.push((hex(*high)? << 4) | hex(*low)?);
            rest = after;
        } else {
            decoded.push(*first);
        }
    }
    Some(decoded)
}

/// Value of a hexadecimal digit.
fn hex(digit: u8) -> Option<u8> {
    char::from(digit).to_digit(16).and_then(|value| u8::try_from(value).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(uri: &str) -> Vec<String> {
        match Uri::parse(uri) {
            Ok(Uri::File(names)) => names,
            other => panic!("{uri}: {other:?}"),
        }
    }

    #[test]
    fn file_names_are_tried_percent_decoded_then_literally() {
        assert_eq!(names("a.bin"), ["a.bin"]);
        assert_eq!(names("my%20model/t%C3%BCr.bin"), ["my model/tür.bin", "my%20model/t%C3%BCr.bin"]);
        assert_eq!(names("50%.bin"), ["50%.bin"], "no percent-encoding");
        assert_eq!(names("%ff.bin"), ["%ff.bin"], "not UTF-8");
        assert_eq!(names("a\\b#1?.png"), ["a/b#1?.png"]);
        assert_eq!(names("./a/../b.bin"), ["./a/../b.bin"]);
        assert_eq!(names("模型.bin"), ["模型.bin"]);
    }

    #[test]
    fn names_outside_of_the_folder_are_refused() {
        let message = |uri: &str| Uri::parse(uri).unwrap_err().to_string();
        for uri in ["/etc/passwd", "\\\\host\\a", "//host/a", "C:\\a.bin", "c:/a.bin", "%2Fetc/passwd", "C%3A/a"] {
            assert!(message(uri).contains("absolute path"), "{uri}: {}", message(uri));
        }
        for uri in ["../a.bin", "a/../../b.bin", "%2e%2e/a.bin", "a\\..\\..\\b", "a/%2e%2e%2f../b"] {
            assert!(message(uri).contains("leaves the folder"), "{uri}: {}", message(uri));
        }
        assert_eq!(
            message("HTTP://example.org/a.bin"),
            "`HTTP://example.org/a.bin`: URIs with the scheme `http` are not read; copy the file beside the document"
        );
        assert!(message("file:///etc/passwd").contains("scheme `file`"));
        assert_eq!(message(""), "the name of the file is empty");
        assert!(message("a%00.bin").contains("control character"));
    }

    #[test]
    fn data_is_decoded() {
        let parse = |uri: &'static str| match Uri::parse(uri) {
            Ok(Uri::Data { media_type, data }) => (media_type, decode(data)),
            other => panic!("{uri}: {other:?}"),
        };
        let bytes = Ok(vec![0, 1, 254, 255]);
        assert_eq!(parse("data:application/octet-stream;base64,AAH+/w=="), ("application/octet-stream", bytes.clone()));
        assert_eq!(parse("DATA:;base64,AAH+/w"), ("", bytes.clone()), "without padding");
        assert_eq!(parse("data:image/png;name=a;base64,AAH%2B/w%3D%3D"), ("image/png", bytes));
        assert!(parse("data:;base64,A*").1.is_err());
        assert_eq!(parse("data:,a%20b%00%fF+"), ("", Ok(b"a b\0\xff+".to_vec())), "RFC 2397, without base64");
        assert_eq!(parse("data:text/plain;charset=utf-8,%41"), ("text/plain", Ok(b"A".to_vec())));
        assert_eq!(parse("data:,%4").1, Err(UriError::Percent));
        assert_eq!(Uri::parse("data:base64"), Err(UriError::Comma));
    }
}
