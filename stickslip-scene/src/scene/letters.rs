//! Letters of texts that come from files, which terminals and other files take.

/// A text with escapes for letters that would steer a terminal.
pub fn escaped(text: &str) -> String {
    let letter = |letter: char| match letter.is_control() && letter != '\n' {
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
    letter.is_control() || matches!(letter, '\u{fffe}' | '\u{ffff}')
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
