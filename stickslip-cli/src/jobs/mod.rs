//! Many runs: side by side as cores and memory allow, each in a folder of its own, none done twice.

mod bench;
mod board;

use crate::failure::Failure;
use bench::{FreeResources, Need};
use board::Board;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use stickslip::observe::{Manifest, Results, SceneSource, Status};
use stickslip::run::RunOptions;
use stickslip::scene::{Loaded, Scene};

/// A scene to be run.
#[derive(Debug)]
pub struct Job {
    /// Name of its folder, unique among the jobs.
    pub name: String,
    /// The scene with its parameters.
    pub loaded: Loaded,
    /// The file from which it came, for the record; none of a scene that the program makes.
    pub source: Option<SceneSource>,
}

/// Where and how jobs are done.
#[derive(Clone, Debug)]
pub struct JobRunner {
    /// A folder in here is made for each job.
    pub folder: PathBuf,
    /// Threads that all jobs share.
    pub threads: usize,
    /// Set by whoever wants all runs to stop.
    pub stop: Arc<AtomicBool>,
    /// What becomes of runs that are there already.
    pub earlier: Earlier,
}

/// What becomes of results that are there already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Earlier {
    /// Those of the same scene with the same settings by the same version of the program stand.
    Keep,
    /// All is run again.
    Replace,
}

/// Results of jobs by their names, or why there are none.
pub type Outcomes = BTreeMap<String, Result<Results, String>>;

impl JobRunner {
    /// Does the jobs, the longest first. A run that fails does not keep the others from going on.
    ///
    /// # Errors
    /// A scene that cannot be built, before anything runs; the user stopped the runs.
    pub fn work(&self, jobs: &[Job]) -> Result<Outcomes, Failure> {
        let mut outcomes = Outcomes::new();
        let mut needs = Vec::new();
        for (number, job) in jobs.iter().enumerate() {
            let report = stickslip::check::report(&job.loaded.scene)
                .map_err(|problem| Failure::input(job.loaded.source.locate(problem)))?;
            let kept = if self.earlier == Earlier::Keep {
                finished(&self.path(job), &job.loaded.scene)
            } else {
                None
            };
            match kept {
                Some(results) => drop(outcomes.insert(job.name.clone(), Ok(results))),
                None => needs.push(Need {
                    job: number,
                    work: report.particles as f64 * report.steps as f64,
                    memory: report.memory + stickslip::run::memory(&report),
                }),
            }
        }
        let board = Board::new(needs.len(), outcomes.len());
        let done = FreeResources::new(needs, self.threads).work(|number, threads| {
            let job = &jobs[number];
            let outcome = (!self.stop.load(Ordering::Relaxed)).then(|| self.run(job, threads, &board));
            (job.name.clone(), outcome)
        });
        board.clear();
        if self.stop.load(Ordering::Relaxed) {
            return Err(Failure::Interrupted);
        }
        outcomes.extend(done.into_iter().filter_map(|(name, outcome)| Some((name, outcome?))));
        Ok(outcomes)
    }

    fn path(&self, job: &Job) -> PathBuf {
        self.folder.join(&job.name)
    }

    /// Runs a job on a few threads of its own.
    fn run(&self, job: &Job, threads: usize, board: &Board) -> Result<Results, String> {
        let lane = board.start(&job.name);
        let folder = self.path(job);
        let (stop, source) = (Arc::clone(&self.stop), job.source.clone());
        let options = RunOptions { stop, threads, source, ..RunOptions::new(&folder) };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let outcome = pool.map_err(|error| error.to_string()).and_then(|pool| {
            pool.install(|| {
                let scene = &job.loaded.scene;
                let built = stickslip::step::build(scene);
                let mut simulation =
                    built.map_err(|problem| job.loaded.source.locate(problem).to_string())?;
                let show = &mut |progress: &stickslip::run::Progress| lane.show(progress);
                stickslip::run::run(scene, &mut *simulation, &options, show)
                    .map_err(|error| error.to_string())
            })
        });
        lane.end(outcome.as_ref().err().map(String::as_str));
        outcome?;
        Results::open(&folder).map_err(|error| error.to_string())
    }
}

/// The finished results of just this scene by just this program, if they are there.
pub fn finished(folder: &Path, scene: &Scene) -> Option<Results> {
    let results = Results::open(folder).ok()?;
    let manifest = results.manifest();
    let same = manifest.version == env!("CARGO_PKG_VERSION")
        && manifest.status == Status::Finished
        && manifest.scene.value() == Manifest::record(scene);
    same.then_some(results)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = include_str!("../commands/new.toml");

    fn job(name: &str, overrides: &[(&str, &str)]) -> Job {
        let short = [("cells_per_radius", "2"), ("time.end", "20 ms")];
        let overrides =
            short.iter().chain(overrides).map(|(key, value)| (key.to_string(), value.to_string()));
        let overrides: Vec<(String, String)> = overrides.collect();
        let loaded = stickslip::scene::parse("new.toml", SCENE, &overrides).unwrap();
        Job { name: name.to_owned(), loaded, source: None }
    }

    fn jobs(folder: &Path) -> JobRunner {
        let stop = Arc::new(AtomicBool::new(false));
        JobRunner { folder: folder.to_path_buf(), threads: 2, stop, earlier: Earlier::Keep }
    }

    #[test]
    fn what_is_done_is_not_done_again_unless_a_setting_changed() {
        let folder = tempfile::tempdir().unwrap();
        let jobs = jobs(folder.path());
        let wall_time = |outcomes: &Outcomes, name: &str| {
            outcomes[name].as_ref().unwrap().manifest().performance.wall_time
        };
        let first = jobs.work(&[job("a", &[]), job("b", &[("friction", "0.1")])]).unwrap();
        let second = jobs.work(&[job("a", &[]), job("b", &[("friction", "0.2")])]).unwrap();
        assert_eq!(wall_time(&first, "a"), wall_time(&second, "a"));
        assert_ne!(wall_time(&first, "b"), wall_time(&second, "b"));
        let again = JobRunner { earlier: Earlier::Replace, ..jobs };
        let third = again.work(&[job("a", &[])]).unwrap();
        assert_ne!(wall_time(&first, "a"), wall_time(&third, "a"));
    }

    #[test]
    fn a_run_that_fails_leaves_the_others_alone() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        std::fs::write(folder.path().join("a/thesis.tex"), "years of work").unwrap();
        let outcomes = jobs(folder.path()).work(&[job("a", &[]), job("b", &[])]).unwrap();
        assert!(outcomes["a"].as_ref().unwrap_err().contains("thesis.tex"));
        assert!(outcomes["b"].is_ok());
    }

    #[test]
    fn who_stops_the_work_gets_no_results() {
        let folder = tempfile::tempdir().unwrap();
        let jobs = jobs(folder.path());
        jobs.stop.store(true, Ordering::Relaxed);
        assert!(matches!(jobs.work(&[job("a", &[])]), Err(Failure::Interrupted)));
    }
}
