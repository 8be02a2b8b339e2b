//! Syntax errors in words.

use jsonc_parser::ParseStringErrorKind;
use jsonc_parser::errors::ParseErrorKind as Kind;

/// Explains a syntax error at `word`. Returns the message and a suggestion.
pub fn explain(kind: &Kind, word: &str) -> (String, Option<String>) {
    let small = word.to_ascii_lowercase();
    let quoted = format!("write \"{word}\"");
    let (message, help) = match kind {
        Kind::UnterminatedObject => ("this `{` is never closed by `}`", ""),
        Kind::UnterminatedArray => ("this `[` is never closed by `]`", ""),
        Kind::UnterminatedCommentBlock => ("this comment is never closed by `*/`", ""),
        Kind::UnexpectedCloseBrace => ("unexpected `}`", ""),
        Kind::UnexpectedCloseBracket => ("unexpected `]`", ""),
        Kind::UnexpectedComma => ("unexpected `,`", ""),
        Kind::UnexpectedColon => ("unexpected `:`", ""),
        Kind::ExpectedComma => ("a `,` is missing here", ""),
        Kind::ExpectedColonAfterObjectKey => ("a `:` and a value must follow the key", ""),
        Kind::ExpectedObjectValue => ("a value must follow the `:`", ""),
        Kind::ExpectedStringObjectProperty => ("keys must be in double quotes", quoted.as_str()),
        Kind::String(fault) if *fault != ParseStringErrorKind::UnterminatedStringLiteral => (
            "in a string, `\\` begins an escape such as `\\n` or `\\u00e9`, and this is none",
            "write `/` in file names, as in \"C:/models/x.obj\", or `\\\\` for a backslash",
        ),
        Kind::SingleQuotedStringsNotAllowed => ("strings must be in double quotes", ""),
        Kind::NonFiniteNumbersNotAllowed => ("numbers must be finite", ""),
        Kind::HexadecimalNumbersNotAllowed => ("numbers must be decimal", "colors are written \"#rrggbb\", in quotes"),
        Kind::UnaryPlusNumbersNotAllowed => ("numbers must not begin with `+`", ""),
        Kind::BareDecimalPointNumbersNotAllowed => {
            ("digits are required on both sides of the decimal point", "write 0.5")
        }
        Kind::UnexpectedWord | Kind::UnexpectedToken if matches!(small.as_str(), "true" | "false" | "null") => {
            ("true, false and null must be in lower case", "")
        }
        Kind::UnexpectedWord | Kind::UnexpectedToken => {
            ("words must be in double quotes", "only true, false and null have none")
        }
        Kind::MultipleRootJsonValues => ("unexpected text after the end of the JSON value", ""),
        other => return (format!("invalid JSON: {}", lower_first(&other.to_string())), None),
    };
    (message.to_owned(), (!help.is_empty()).then(|| help.to_owned()))
}

fn lower_first(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_lowercase().chain(characters).collect())
}
