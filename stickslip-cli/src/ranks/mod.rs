//! Processes that share a run: `mpirun -n 8 stickslip run scene.toml`.
//!
//! All of them are this program with the same words. The first does what these ask for. The others wait for the scenes
//! that it simulates, read each for themselves, and have their part of the simulation ([`stickslip::shared`]): they
//! write their pieces of files of particles, and say nothing but what is wrong with them. Of a family of runs
//! (`mpirun -n 8 stickslip sweep`) each makes some.

mod alike;
#[cfg(feature = "mpi")]
mod mpi;

use crate::commands::Command;
use crate::failure::Failure;
use crate::sweep::Family;
use miette::miette;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};
use stickslip::door::Simulation;
use stickslip::lanes::Processor;
use stickslip::observe::{PROGRAM, SceneSource};
use stickslip::ranks::Ranks;
use stickslip::scene::{Loaded, WasRead};
use stickslip::shared;
use stickslip::step::ParticleLoop;

/// The ranks that this process is the first of, if there are any.
static OTHERS: OnceLock<Others> = OnceLock::new();

struct Others {
    ranks: Arc<dyn Ranks>,
    /// How many of them are on its machine, itself included.
    here: usize,
    /// How many of these may run on the same processors.
    neighbours: usize,
}

/// Processes of a launcher with this in their environment have nothing to do with each other.
const ALONE: &str = "STICKSLIP_ALONE";

/// What a launcher says of this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Launched {
    rank: usize,
    count: usize,
}

/// How launchers say which of how many processes one is: those of Open MPI, of MPICH and its kin, of MVAPICH, and of
/// SLURM. What SLURM says beside is there in scripts, too, which no launcher began.
const LAUNCHERS: [[&str; 2]; 4] = [
    ["OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"],
    ["PMI_RANK", "PMI_SIZE"],
    ["MV2_COMM_WORLD_RANK", "MV2_COMM_WORLD_SIZE"],
    ["SLURM_PROCID", "SLURM_STEP_NUM_TASKS"],
];

impl Launched {
    /// What the environment says, if a launcher began more than one process.
    pub fn together() -> Option<Self> {
        let number = |name: &str| std::env::var(name).ok()?.parse().ok();
        Self::said_by(&number).filter(|_| std::env::var_os(ALONE).is_none())
    }

    fn said_by(number: &dyn Fn(&str) -> Option<usize>) -> Option<Self> {
        let mut said = LAUNCHERS.iter().map(|names| names.map(number));
        let [rank, count] = said.find(|said| said.iter().all(Option::is_some))?;
        Some(Launched { rank: rank?, count: count? }).filter(|launched| launched.count > 1)
    }

    /// Whether it is the first one.
    pub fn is_first(self) -> bool {
        self.rank == 0
    }

    /// Does what a command asks for by all processes together.
    pub fn execute(self, command: Command) -> Result<(), Failure> {
        match command {
            Command::Run(_) | Command::Resume(_) | Command::Sweep(_) => self.share(command),
            _ if self.is_first() => command.execute(),
            _ => Ok(()),
        }
    }

    #[cfg(not(feature = "mpi"))]
    fn share(self, _: Command) -> Result<(), Failure> {
        let count = self.count;
        Err(Failure::Input(miette!(
            help = "build it with `cargo build --release --features mpi`, start it once, or set STICKSLIP_ALONE=1 for \
                    runs that have nothing to do with each other",
            "found {count} processes that are to share a run; allowed: one, for this program was built without MPI"
        )))
    }

    #[cfg(feature = "mpi")]
    fn share(self, command: Command) -> Result<(), Failure> {
        let (_universe, ranks) = mpi::Mpi::join().map_err(|problem| Failure::Run(miette!("{problem}")))?;
        end_all_on_panic();
        if ranks.count() == 1 {
            let count = self.count;
            return Err(Failure::Input(miette!(
                help = format!(
                    "start it by the launcher of the MPI that it was built with: {}",
                    mpi::Mpi::version()
                ),
                "a launcher began {count} processes, and MPI knows of one"
            )));
        }
        let ranks = Arc::new(ranks);
        let words: Vec<String> =
            std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
        alike::started(&*ranks, &words, &mpi::Mpi::machine())?;
        let alike = |of_this: Vec<u8>| ranks.gather(&of_this).iter().filter(|said| **said == of_this).count();
        let here = alike(bytes_of(&mpi::Mpi::machine()));
        let neighbours = alike(bytes_of(&(mpi::Mpi::machine(), processors_allowed())));
        if ranks.rank() > 0 {
            let mut followed = crate::commands::outlast_signals();
            followed = followed.and_then(|()| use_threads(command.threads(), neighbours));
            if let Err(failure) = followed {
                // The others would wait for this one.
                failure.print();
                mpi::Mpi::abort(i32::from(failure.exit_code()));
            }
            while follow(&ranks, ranks.clone(), neighbours) {}
            return Ok(());
        }
        let _ = OTHERS.set(Others { ranks: ranks.clone(), here, neighbours });
        let ended = command.execute();
        ranks.hear_first(&bytes_of(&Task::End));
        ended
    }
}

/// A process that panics cannot be waited for.
#[cfg(feature = "mpi")]
fn end_all_on_panic() {
    let told = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        told(panic);
        mpi::Mpi::abort(101);
    }));
}

/// Makes the threads of this process: as many as are asked for, or as there are processors for it and so many others
/// that may run on the same ones.
pub fn use_threads(threads: Option<usize>, neighbours: usize) -> Result<(), Failure> {
    use miette::IntoDiagnostic;
    let threads = threads.unwrap_or_else(|| {
        let allowed = std::thread::available_parallelism().map_or(1, usize::from);
        (allowed / neighbours).max(1)
    });
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build_global().into_diagnostic().map_err(Failure::Run)
}

/// Processes that work together here, this one among them.
pub fn count() -> usize {
    OTHERS.get().map_or(1, |others| others.ranks.count())
}

/// Has the others make their part of the runs of a family; they are given where there are any.
pub fn share_family(family: &Family) -> Option<Arc<dyn Ranks>> {
    let ranks = Arc::clone(&OTHERS.get()?.ranks);
    ranks.hear_first(&bytes_of(&Task::Sweep(family.clone())));
    Some(ranks)
}

/// Processes of the run that may run on the same processors, this one among them.
pub fn neighbours() -> usize {
    OTHERS.get().map_or(1, |others| others.neighbours)
}

/// Which part of a simulation is on this machine, about.
pub fn part_here() -> f64 {
    OTHERS.get().map_or(1.0, |others| others.here as f64 / others.ranks.count() as f64)
}

/// The processors on which this process may run, where the system says so.
#[cfg(feature = "mpi")]
fn processors_allowed() -> Option<String> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let allowed = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"))?;
    Some(allowed.trim().to_string())
}

/// What the first process wants of the others.
#[derive(Serialize, Deserialize)]
enum Task {
    /// To share the simulation of a scene, which ends at this time [s], and of which the first has read this.
    Simulate(Box<SceneSource>, f64, WasRead),
    /// To make some runs of a family.
    Sweep(Family),
    /// Nothing more.
    End,
}

/// Bytes of what processes tell each other.
fn bytes_of(said: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(said).expect("memory takes what is written")
}

/// Makes the simulation of a scene, which others share where there are any.
pub fn simulation(loaded: &Loaded, source: &SceneSource) -> Result<Box<dyn Simulation>, Failure> {
    let Some(Others { ranks, .. }) = OTHERS.get() else {
        return stickslip::step::build(&loaded.scene)
            .map_err(|problem| Failure::input(loaded.source.locate(problem)));
    };
    let source = SceneSource { text: Some(loaded.source.text().to_owned()), ..source.clone() };
    ranks.hear_first(&bytes_of(&Task::Simulate(Box::new(source), loaded.scene.time.end, loaded.was_read())));
    let said = ranks.tell_first(&bytes_of(&None::<String>));
    let unread = said.iter().zip(0..).find_map(|(said, rank)| {
        let problem: Option<String> = serde_json::from_slice(said).ok()?;
        Some((rank, problem?))
    });
    ranks.hear_first(&bytes_of(&unread.is_none()));
    if let Some((rank, problem)) = unread {
        return Err(Failure::Run(miette!(
            help = "all processes need the scene's folder and what it names, the same on each machine",
            "rank {rank} {problem}"
        )));
    }
    let path = ParticleLoop::Lanes(Processor::best());
    let lead = shared::lead(Arc::new(loaded.scene.clone()), path, (ranks.clone(), PROGRAM));
    lead.map_err(|problem| Failure::input(loaded.source.locate(problem)))
}

/// Shares what the first process does next; false if that is nothing.
#[cfg(feature = "mpi")]
fn follow(here: &mpi::Mpi, ranks: Arc<dyn Ranks>, neighbours: usize) -> bool {
    let task = serde_json::from_slice(&here.hear_first(&[])).expect("all processes are the same program");
    let (source, end, first) = match task {
        Task::Simulate(source, end, first) => (source, end, first),
        Task::Sweep(family) => {
            crate::sweep::among::follow(here, &family, neighbours);
            return true;
        }
        Task::End => return false,
    };
    let mut read = source.recorded().unwrap_or_else(|| source.load());
    if let Ok(loaded) = &mut read {
        loaded.scene.time.end = end;
    }
    let problem = match &read {
        Err(error) => Some(format!("cannot read the scene: {error}")),
        Ok(loaded) => first.differs(&loaded.was_read()),
    };
    let problem = problem.map(|problem| format!("on {} {problem}", mpi::Mpi::machine()));
    here.tell_first(&bytes_of(&problem));
    let all_read: bool = serde_json::from_slice(&here.hear_first(&[])).unwrap_or(false);
    if let (true, Ok(loaded)) = (all_read, read) {
        // What is wrong with the scene, the first one tells.
        let _ =
            shared::follow(Arc::new(loaded.scene), ParticleLoop::Lanes(Processor::best()), (ranks, PROGRAM));
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn launchers_say_which_process_one_is() {
        let says = |said: &'static [(&str, usize)]| {
            Launched::said_by(&|name| {
                said.iter().find(|(known, _)| *known == name).map(|(_, number)| *number)
            })
        };
        let second = Some(Launched { rank: 1, count: 4 });
        assert_eq!(says(&[("OMPI_COMM_WORLD_RANK", 1), ("OMPI_COMM_WORLD_SIZE", 4)]), second);
        assert_eq!(says(&[("PMI_RANK", 1), ("PMI_SIZE", 4)]), second);
        assert_eq!(says(&[("SLURM_PROCID", 1), ("SLURM_STEP_NUM_TASKS", 4)]), second);
        // A script, and one process.
        assert_eq!(says(&[("SLURM_PROCID", 0), ("SLURM_NTASKS", 4)]), None);
        assert_eq!(says(&[("PMI_RANK", 0), ("PMI_SIZE", 1)]), None);
        assert_eq!(says(&[]), None);
    }
}
