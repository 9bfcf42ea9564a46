//! What a run remembers beside the state of its simulation: how far its outputs and checks have come.

use super::file::OutputError;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};

/// Named values that are kept for a checkpoint, or taken up from one. The same line does both, see [`Memory::keep`], so
/// that what is saved and what is restored cannot differ.
#[derive(Debug)]
pub struct Memory {
    values: Values,
    mode: Mode,
    /// Names that were taken up.
    claimed: BTreeSet<String>,
    /// The checkpoint, for errors.
    path: PathBuf,
    /// Before each name.
    prefix: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Keeping,
    /// As taking up, but nothing outside of memory changes.
    Rehearsing,
    TakingUp,
}

/// Values by name, each in MessagePack.
pub(super) type Values = BTreeMap<String, Encoded>;

/// A value in MessagePack.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Encoded(#[serde(with = "serde_bytes")] Vec<u8>);

impl Memory {
    /// One that keeps what it is shown, for a checkpoint of this path.
    pub fn keeping(path: &Path) -> Self {
        Memory {
            values: Values::new(),
            mode: Mode::Keeping,
            claimed: BTreeSet::new(),
            path: path.to_path_buf(),
            prefix: String::new(),
        }
    }

    /// One that keeps what it is shown, and beside it what nobody took up from another: outputs that the scene leaves
    /// out for a while come back as they were.
    pub fn keeping_beside(path: &Path, unclaimed: &Memory) -> Self {
        let unclaimed = unclaimed.values.iter().filter(|(name, _)| !unclaimed.claimed.contains(*name));
        let values = unclaimed.map(|(name, value)| (name.clone(), value.clone())).collect();
        Memory { values, ..Memory::keeping(path) }
    }

    /// One that gives back what was kept, at first as a rehearsal.
    pub(super) fn of(values: Values, path: &Path) -> Self {
        Memory { values, mode: Mode::Rehearsing, ..Memory::keeping(path) }
    }

    /// What was kept.
    pub(super) fn into_values(self) -> Values {
        self.values
    }

    /// Whether values are taken up, not kept; a rehearsal is that too.
    pub fn is_taking_up(&self) -> bool {
        self.mode != Mode::Keeping
    }

    /// Whether files are to be made what they were: not in a rehearsal, which only looks whether they can be.
    pub fn is_in_earnest(&self) -> bool {
        self.mode == Mode::TakingUp
    }

    /// Where a file of this kind lies that belongs to the checkpoint: it goes when the checkpoint does.
    pub(super) fn beside(&self, kind: &str) -> PathBuf {
        self.path.with_extension(kind)
    }

    /// Whether something was kept under a whole name.
    pub(super) fn has(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }

    /// After a rehearsal: from now on in earnest.
    pub fn take_up(&mut self) {
        self.mode = Mode::TakingUp;
    }

    /// Keeps a value under a name, or gives it the one that was kept; a name that was not kept leaves it as it is, and
    /// gives false.
    ///
    /// # Errors
    /// What was kept under the name is something else.
    pub fn keep<T: Serialize + DeserializeOwned>(
        &mut self,
        name: &str,
        value: &mut T,
    ) -> Result<bool, OutputError> {
        let name = format!("{}{name}", self.prefix);
        if !self.is_taking_up() {
            let bytes =
                rmp_serde::to_vec_named(value).map_err(|error| self.wrong(&name, &error.to_string()))?;
            self.values.insert(name, Encoded(bytes));
            return Ok(true);
        }
        let Some(Encoded(bytes)) = self.values.get(&name) else { return Ok(false) };
        *value = rmp_serde::from_slice(bytes).map_err(|error| self.wrong(&name, &error.to_string()))?;
        self.claimed.insert(name);
        Ok(true)
    }

    /// Lets a part of the run remember under names that begin with its own.
    pub fn part<R>(&mut self, name: &str, remember: impl FnOnce(&mut Memory) -> R) -> R {
        let length = self.prefix.len();
        self.prefix += name;
        self.prefix += "/";
        let result = remember(self);
        self.prefix.truncate(length);
        result
    }

    /// The error for what does not fit.
    pub(super) fn wrong(&self, name: &str, what: &str) -> OutputError {
        let source = io::Error::new(io::ErrorKind::InvalidData, format!("what it has of `{name}`: {what}"));
        OutputError { path: self.path.clone(), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back_under_its_name_only() {
        let mut memory = Memory::keeping(Path::new("a.checkpoint"));
        let mut kept = (vec![f64::NEG_INFINITY, 0.1], String::from("ball"));
        memory.part("tables", |memory| memory.keep("rows", &mut kept)).unwrap();
        memory.keep("left out", &mut 3).unwrap();
        let mut memory = Memory::of(memory.into_values(), Path::new("a.checkpoint"));
        let mut found = (Vec::new(), String::new());
        assert!(!memory.keep("rows", &mut found).unwrap());
        assert_eq!(found, (Vec::new(), String::new()));
        memory.part("tables", |memory| memory.keep("rows", &mut found)).unwrap();
        assert_eq!(found, kept);
        // What nobody took up is kept on.
        let values = Memory::keeping_beside(Path::new("b.checkpoint"), &memory).into_values();
        assert_eq!(values.keys().collect::<Vec<_>>(), ["left out"]);
        let error = memory.part("tables", |memory| memory.keep("rows", &mut 0.0)).unwrap_err();
        assert!(
            error.to_string().contains("a.checkpoint") && error.to_string().contains("tables/rows"),
            "{error}"
        );
    }
}
