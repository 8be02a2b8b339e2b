//! Sanitizes text from files and command lines for messages: bounded length, no terminal control
//! characters.

/// Maximum number of characters of a name that a message quotes. File paths of usual length stay
/// whole.
pub const MAX_QUOTE: usize = 200;
/// Maximum number of characters of a line of a message.
pub const MAX_LINE: usize = 4000;

/// Excerpt of at most `max` characters on one line. A longer text is cut in the middle, which
/// becomes `…`. Control and bidirectional formatting characters become U+FFFD.
pub fn excerpt(text: &str, max: usize) -> String {
    let length = text.chars().count();
    if length <= max {
        return text.chars().map(printable).collect();
    }
    let kept = max.saturating_sub(1);
    let (head, tail) = (kept - kept / 2, kept / 2);
    let middle = (max > 0).then_some('…');
    text.chars().take(head).chain(middle).chain(text.chars().skip(length - tail)).map(printable).collect()
}

/// Sanitizes one line of a message: names between backticks keep [`MAX_QUOTE`] characters, the
/// whole line [`MAX_LINE`]. Control characters, line breaks included, become U+FFFD.
pub fn line(text: &str) -> String {
    let pieces: Vec<&str> = text.split('`').collect();
    // An unmatched backtick opens no quote.
    let is_quote = |number: usize| number % 2 == 1 && number + 1 < pieces.len();
    let pieces = pieces.iter().enumerate();
    let pieces =
        pieces.map(|(number, piece)| if is_quote(number) { excerpt(piece, MAX_QUOTE) } else { (*piece).into() });
    excerpt(&pieces.collect::<Vec<String>>().join("`"), MAX_LINE)
}

/// Sanitizes each line of a message by [`line()`]; line breaks stay.
pub fn lines(text: &str) -> String {
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Replaces control characters by U+FFFD in a text of any length; line breaks stay.
pub fn printable_lines(text: &str) -> String {
    text.chars().map(|character| if character == '\n' { character } else { printable(character) }).collect()
}

/// Replaces control characters, and bidirectional formatting characters that make a name look like
/// another, by U+FFFD.
fn printable(character: char) -> char {
    let turns = matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    if character.is_control() || turns { char::REPLACEMENT_CHARACTER } else { character }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excerpts_lose_their_middle() {
        assert_eq!(excerpt("abcdef", 6), "abcdef");
        assert_eq!(excerpt("abcdefg", 6), "abc…fg");
        assert_eq!(excerpt("äöüßéèê", 5), "äö…èê");
        assert_eq!(["ab", "abc"].map(|text| excerpt(text, 1)), ["…", "…"]);
        assert_eq!(excerpt("ab", 0), "");
    }

    #[test]
    fn control_characters_are_replaced_in_messages() {
        assert_eq!(excerpt("a\u{1b}[31m\nb\u{202e}gnp.exe", 40), "a\u{fffd}[31m\u{fffd}b\u{fffd}gnp.exe");
        assert_eq!(printable_lines("a\u{7}\nb"), "a\u{fffd}\nb");
    }

    #[test]
    fn messages_shorten_quoted_names_and_keep_other_words() {
        let long = "x".repeat(1_000_000);
        let quote = excerpt(&long, MAX_QUOTE);
        assert_eq!(quote.chars().count(), MAX_QUOTE);
        assert_eq!(
            line(&format!("`{long}` stands in `a` and `{long}`")),
            format!("`{quote}` stands in `a` and `{quote}`")
        );
        assert_eq!(line(&format!("never closed: `{long}")).chars().count(), MAX_LINE);
        assert_eq!(line(&"`\n".repeat(1_000_000)).chars().count(), MAX_LINE);
        let plain = "no material is called `red`, did you mean `bed`?\nhelp: `juggler check` tells more";
        assert_eq!(lines(plain), plain);
        assert_eq!(lines(&format!("a `{long}`\nb")), format!("a `{quote}`\nb"));
    }
}
