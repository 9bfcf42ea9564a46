//! Letters of texts that come from files, which terminals and other files take.

/// A text with escapes for letters that would steer a terminal.
pub fn escaped(text: &str) -> String {
    let letter = |letter: char| match letter.is_control() && letter != '\n' {
        true => letter.escape_default().to_string(),
        false => letter.to_string(),
    };
    text.chars().map(letter).collect()
}

/// Whether a letter has no place in a name: what steers terminals, and the last two of Unicode's first plane, which are
/// none and which XML does not take.
pub(super) fn is_no_letter(letter: char) -> bool {
    letter.is_control() || matches!(letter, '\u{fffe}' | '\u{ffff}')
}
