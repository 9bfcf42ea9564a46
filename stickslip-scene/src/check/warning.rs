//! What is doubtful with a scene but allowed.

use crate::scene::Source;
use serde::{Deserialize, Serialize};
use std::fmt::{Display, Formatter, Result};

/// Something doubtful that a run may start with.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    /// Path of the key that it is about, such as `contact[1]`; empty where there is none.
    pub key: String,
    /// File, line and column of that key, once [`super::Report::placed`] has found them.
    pub place: Option<String>,
    /// What is doubtful, by how much, and what to try.
    pub text: String,
}

/// How the warning of contacts begins that may be too narrow for the cells.
pub(super) const NOT_RESOLVED: &str = "not resolved: ";

impl Warning {
    /// Whether it estimates what a run measures, which says at its end what it was.
    pub fn is_estimate(&self) -> bool {
        self.text.starts_with(NOT_RESOLVED)
    }

    /// A warning about a key.
    pub fn about(key: impl Into<String>, text: impl Into<String>) -> Self {
        Warning { key: key.into(), place: None, text: text.into() }
    }

    /// The same with the place of its key in the file.
    pub fn placed(self, source: &Source) -> Self {
        let key = source.written(&self.key);
        let place = (!key.is_empty()).then(|| source.place(&key));
        Warning { key, place, ..self }
    }
}

impl Display for Warning {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let named = [self.place.as_deref().unwrap_or(""), &self.key];
        named.iter().filter(|part| !part.is_empty()).try_for_each(|part| write!(f, "{part}: "))?;
        f.write_str(&self.text)
    }
}

/// `first`, and how many there are beside it: "`a` and 3 more".
pub(super) fn and_more(first: &str, others: usize) -> String {
    if others == 0 { first.to_string() } else { format!("{first} and {others} more") }
}

/// Warnings of one kind that are listed.
const MOST_LISTED: usize = 20;

/// The first of many warnings of one kind, and how many more there are.
pub(super) fn few(warnings: impl IntoIterator<Item = Warning>) -> impl Iterator<Item = Warning> {
    let mut listed: Vec<_> = warnings.into_iter().collect();
    let more = listed.len().saturating_sub(MOST_LISTED);
    if more > 1 {
        let key = listed[MOST_LISTED].key.clone();
        listed.truncate(MOST_LISTED);
        listed.push(Warning::about(key, format!("and {more} more keys are to be looked at in the same way")));
    }
    listed.into_iter()
}
