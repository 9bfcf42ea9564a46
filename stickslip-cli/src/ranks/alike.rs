//! Whether processes that share a run are the same program and were asked for the same.

use super::bytes_of;
use crate::failure::Failure;
use miette::miette;
use serde::{Deserialize, Serialize};
use stickslip::ranks::Ranks;
use stickslip::scene::sum_of_file;

/// A program, as it is on one machine.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Build {
    version: String,
    /// SHA-256 of its file, where that can be read.
    sha256: Option<String>,
}

/// What a process says of itself.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Said {
    build: Build,
    machine: String,
    words: Vec<String>,
}

impl Build {
    fn of_this() -> Self {
        let program = std::env::current_exe().and_then(|program| sum_of_file(&program));
        Build { version: env!("CARGO_PKG_VERSION").to_string(), sha256: program.ok() }
    }

    /// As far as both are known.
    fn is(&self, other: &Build) -> bool {
        let known = self.sha256.as_ref().zip(other.sha256.as_ref());
        self.version == other.version && known.is_none_or(|(a, b)| a == b)
    }

    fn told(&self) -> String {
        let sum = self.sha256.as_deref().unwrap_or("unknown");
        format!("{} with the sha256 {sum:.12}...", self.version)
    }
}

/// Holds the processes of a launcher against the first of them.
///
/// # Errors
/// One is another build, or was started with other words.
#[cfg_attr(not(feature = "mpi"), expect(dead_code, reason = "only processes share"))]
pub(super) fn started(ranks: &dyn Ranks, words: &[String], machine: &str) -> Result<(), Failure> {
    let own = Said { build: Build::of_this(), machine: machine.to_string(), words: words.to_vec() };
    held_against_first(ranks, &own)
}

fn held_against_first(ranks: &dyn Ranks, own: &Said) -> Result<(), Failure> {
    let all = ranks.gather(&bytes_of(own));
    // Another version may say other things of itself.
    let said = all.iter().map(|said| serde_json::from_slice::<Said>(said).ok());
    let said: Vec<Option<Said>> = said.collect();
    let first = said[0].as_ref().unwrap_or(own);
    let same_build = |said: &Option<Said>| said.as_ref().is_some_and(|said| said.build.is(&first.build));
    if let Some(rank) = said.iter().position(|said| !same_build(said)) {
        let (there, build) = match &said[rank] {
            Some(said) => (format!(" on {}", said.machine), said.build.told()),
            None => (String::new(), "of another version".to_string()),
        };
        let of_first = first.build.told();
        return Err(Failure::Input(miette!(
            help = "install one build of stickslip on all machines",
            "rank {rank}{there} runs another program: stickslip {build}, where the first has {of_first}"
        )));
    }
    if said.iter().flatten().any(|said| said.words != first.words) {
        return Err(Failure::Input(miette!(
            help = "set STICKSLIP_ALONE=1 for runs that have nothing to do with each other",
            "the processes of a launcher that share a run were started with other words each"
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::ranks::Threads;

    /// What three ranks say, of which the last is as given.
    fn with_last(last: impl Fn(&mut Said) + Sync) -> Vec<Result<(), String>> {
        let last = &last;
        std::thread::scope(|scope| {
            let all = Threads::start(3).into_iter().map(|ranks| {
                scope.spawn(move || {
                    let words = vec!["run".to_string()];
                    let machine = format!("host{}", ranks.rank());
                    let mut said = Said { build: Build::of_this(), machine, words };
                    if ranks.rank() == 2 {
                        last(&mut said);
                    }
                    held_against_first(&ranks, &said).map_err(|failure| failure.to_string())
                })
            });
            let all: Vec<_> = all.collect();
            all.into_iter().map(|one| one.join().expect("it ends")).collect()
        })
    }

    #[test]
    fn another_build_is_refused_with_its_rank_and_its_machine() {
        assert!(Build::of_this().sha256.is_some_and(|sum| sum.len() == 64));
        assert!(with_last(|_| ()).iter().all(Result::is_ok));
        // What cannot be known is not held against anybody.
        assert!(with_last(|said| said.build.sha256 = None).iter().all(Result::is_ok));
        for told in with_last(|said| said.build.sha256 = Some("0".repeat(64))) {
            let told = told.expect_err("it is another build");
            assert!(told.starts_with("rank 2 on host2 runs another program"), "{told}");
            assert!(told.contains("sha256 000000000000..."), "{told}");
        }
        let old = with_last(|said| said.build.version = "0.0.1".to_string());
        assert!(old.iter().all(|told| told.as_ref().is_err_and(|told| told.contains("stickslip 0.0.1"))));
        let words = with_last(|said| said.words.push("--quiet".to_string()));
        assert!(words.iter().all(|told| told.as_ref().is_err_and(|told| told.contains("other words"))));
    }
}
