//! How a report was made: what a reader needs to make it again.

use jiff::Timestamp;
use std::time::Duration;

/// How a report was made.
#[derive(Clone, Debug)]
pub struct Making {
    /// The command as it was typed.
    pub command: String,
    /// When it was made.
    pub when: Timestamp,
    /// How long it took.
    pub took: Duration,
    /// Anything more to know: name and value.
    pub notes: Vec<(String, String)>,
}

impl Making {
    /// The present command, now, after it has taken this long.
    pub fn now(took: Duration) -> Self {
        let mut words: Vec<String> = std::env::args().skip(1).collect();
        words.insert(0, "stickslip".to_owned());
        Making { command: words.join(" "), when: Timestamp::now(), took, notes: Vec::new() }
    }

    /// The same with one more thing to know.
    pub fn note(mut self, name: impl Into<String>, value: impl Into<String>) -> Self {
        self.notes.push((name.into(), value.into()));
        self
    }

    /// Everything, as names and values.
    pub(super) fn rows(&self) -> Vec<(String, String)> {
        let machine = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let mut rows = vec![
            ("Command".to_owned(), self.command.clone()),
            ("Program".to_owned(), format!("stickslip {}", env!("CARGO_PKG_VERSION"))),
            ("Machine".to_owned(), format!("{machine}, {cores} processors")),
            ("Made".to_owned(), self.when.strftime("%Y-%m-%d %H:%M UTC").to_string()),
            ("Time taken".to_owned(), crate::progress::duration(self.took.as_secs_f64())),
        ];
        rows.extend(self.notes.iter().cloned());
        rows
    }
}

#[test]
fn the_time_is_said_in_minutes() {
    let when = Timestamp::from_second(951_782_399).unwrap();
    let making = Making { command: String::new(), when, took: Duration::from_secs(200), notes: Vec::new() };
    let rows = making.rows();
    assert!(rows.contains(&("Made".to_owned(), "2000-02-28 23:59 UTC".to_owned())), "{rows:?}");
    assert!(rows.contains(&("Time taken".to_owned(), "3 min 20 s".to_owned())), "{rows:?}");
}
