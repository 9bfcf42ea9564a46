//! Letters of texts that come from files, which terminals and other files take.

/// Whether a letter steers a terminal: it moves the cursor, begins a command or a line, or turns the direction of
/// writing (embeddings, overrides and isolates of Unicode's bidirectional algorithm).
pub fn steers_terminal(letter: char) -> bool {
    letter.is_control() || matches!(letter, '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// The same in a text of lines and tabs.
pub fn steers_text(letter: char) -> bool {
    steers_terminal(letter) && !matches!(letter, '\n' | '\r' | '\t')
}

/// A text with escapes for letters that would steer a terminal.
pub fn escaped(text: &str) -> String {
    let letter = |letter: char| match steers_terminal(letter) && letter != '\n' {
        true => letter.escape_default().to_string(),
        false => letter.to_string(),
    };
    text.chars().map(letter).collect()
}

/// Letters of a message that quotes more than anybody reads: so many at its beginning, and at its end.
const QUOTED: [usize; 2] = [1500, 300];

/// A message of which the middle is left out where it is longer than a page.
pub fn shortened(message: &str) -> String {
    let [first, last] = QUOTED;
    // Bytes are not fewer than letters.
    let count = if message.len() > first + last { message.chars().count() } else { 0 };
    if count <= first + last {
        return message.to_string();
    }
    let begin: String = message.chars().take(first).collect();
    let end: String = message.chars().skip(count - last).collect();
    format!("{begin} ... {} letters more ... {end}", count - first - last)
}

/// Whether a letter has no place in a name: what steers terminals, and the last two of Unicode's first plane, which are
/// none and which XML does not take.
pub(super) fn is_no_letter(letter: char) -> bool {
    steers_terminal(letter) || matches!(letter, '\u{fffe}' | '\u{ffff}')
}

#[test]
fn letters_that_steer_a_terminal_are_written_out() {
    // What is shown as "exe.dat" is not what it is.
    assert_eq!(escaped("a\u{202e}tad.exe\u{202c}"), "a\\u{202e}tad.exe\\u{202c}");
    assert_eq!(escaped("red\u{1b}[31m\nline \u{e9}\u{5d0}"), "red\\u{1b}[31m\nline \u{e9}\u{5d0}");
    assert!(is_no_letter('\u{2066}') && !is_no_letter('\u{628}'));
}

#[test]
fn long_messages_lose_their_middle() {
    let long = "ab".repeat(500_000);
    let short = shortened(&long);
    assert!(short.starts_with("abab") && short.ends_with("abab"), "{short}");
    assert!(short.contains(" ... 998200 letters more ... ") && short.len() < 2000);
    assert_eq!(shortened(&short[..1800]), short[..1800]);
    // Letters of several bytes are not cut.
    assert!(shortened(&"\u{e9}".repeat(5000)).contains(" 3200 letters more "));
}
