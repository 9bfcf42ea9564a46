//! Processes that share a run: `mpirun -n 8 stickslip run scene.toml`.
//!
//! All of them are this program with the same words. The first does what these ask for. The others wait for the scenes
//! that it simulates, read each for themselves, and have their part of the simulation ([`stickslip::shared`]): they
//! write nothing, and say nothing but what is wrong with them.

#[cfg(feature = "mpi")]
mod mpi;

use crate::commands::Command;
use crate::failure::Failure;
use miette::miette;
use serde::{Deserialize, Serialize};
use std::sync::{Arc, OnceLock};
use stickslip::door::Simulation;
use stickslip::lanes::Processor;
use stickslip::observe::SceneSource;
use stickslip::ranks::Ranks;
use stickslip::scene::Loaded;
use stickslip::shared;
use stickslip::step::ParticleLoop;

/// The ranks that this process is the first of, if there are any.
static OTHERS: OnceLock<(Arc<dyn Ranks>, usize)> = OnceLock::new();

/// What a launcher says of this process.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Launched {
    rank: usize,
    count: usize,
}

/// How launchers say which of how many processes one is: those of Open MPI, of MPICH and its kin, of MVAPICH, and SLURM's
/// with PMIx. What SLURM says beside is there in scripts, too, which no launcher began.
const LAUNCHERS: [[&str; 2]; 4] = [
    ["OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"],
    ["PMI_RANK", "PMI_SIZE"],
    ["MV2_COMM_WORLD_RANK", "MV2_COMM_WORLD_SIZE"],
    ["PMIX_RANK", "SLURM_STEP_NUM_TASKS"],
];

impl Launched {
    /// What the environment says, if a launcher began more than one process.
    pub fn together() -> Option<Self> {
        let number = |name: &str| std::env::var(name).ok()?.parse().ok();
        Self::said_by(&number)
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
            // Each takes runs of its own.
            Command::Sweep(_) => command.execute(),
            Command::Run(_) | Command::Resume(_) => self.share(command),
            _ if self.is_first() => command.execute(),
            _ => Ok(()),
        }
    }

    #[cfg(not(feature = "mpi"))]
    fn share(self, _: Command) -> Result<(), Failure> {
        if !self.is_first() {
            return Ok(());
        }
        let count = self.count;
        Err(Failure::Input(miette!(
            help = "build it with `cargo build --release --features mpi`, or start it once",
            "found {count} processes that are to share a run; allowed: one, for this program was built without MPI"
        )))
    }

    #[cfg(feature = "mpi")]
    fn share(self, command: Command) -> Result<(), Failure> {
        let (_universe, ranks) = mpi::Mpi::join().map_err(|problem| Failure::Run(miette!("{problem}")))?;
        end_all_on_panic();
        let (neighbours, ranks) = (ranks.neighbours(), Arc::new(ranks));
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
        if ranks.rank() > 0 {
            crate::commands::outlast_signals()?;
            use_threads(command.threads(), neighbours)?;
            while follow(&ranks, ranks.clone())? {}
            return Ok(());
        }
        let _ = OTHERS.set((ranks.clone(), neighbours));
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

/// Makes the threads of this process: as many as are asked for, or as there are processors for it.
pub fn use_threads(threads: Option<usize>, neighbours: usize) -> Result<(), Failure> {
    use miette::IntoDiagnostic;
    let threads = threads.unwrap_or_else(|| {
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        if is_bound() { all } else { (all / neighbours).max(1) }
    });
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build_global().into_diagnostic().map_err(Failure::Run)
}

/// Processes of the run on this machine.
pub fn neighbours() -> usize {
    OTHERS.get().map_or(1, |(_, neighbours)| *neighbours)
}

/// Whether the launcher lets this process run on some of the processors only, where the system says so.
fn is_bound() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let allowed = status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:"));
    let all = std::fs::read_to_string("/sys/devices/system/cpu/online");
    allowed.zip(all.ok()).is_some_and(|(allowed, all)| allowed.trim() != all.trim())
}

/// What the first process wants of the others.
#[derive(Serialize, Deserialize)]
enum Task {
    /// To share the simulation of a scene, which ends at this time [s].
    Simulate(Box<SceneSource>, f64),
    /// Nothing more.
    End,
}

/// Bytes of what processes tell each other.
fn bytes_of(said: &impl Serialize) -> Vec<u8> {
    serde_json::to_vec(said).expect("memory takes what is written")
}

/// Makes the simulation of a scene, which others share where there are any.
pub fn simulation(loaded: &Loaded, source: &SceneSource) -> Result<Box<dyn Simulation>, Failure> {
    let Some((ranks, _)) = OTHERS.get() else {
        return stickslip::step::build(&loaded.scene)
            .map_err(|problem| Failure::input(loaded.source.locate(problem)));
    };
    let source = SceneSource { text: Some(loaded.source.text().to_owned()), ..source.clone() };
    ranks.hear_first(&bytes_of(&Task::Simulate(Box::new(source), loaded.scene.time.end)));
    let said = ranks.tell_first(&bytes_of(&None::<String>));
    let unread = said.iter().zip(0..).find_map(|(said, rank)| {
        let problem: Option<String> = serde_json::from_slice(said).ok()?;
        Some((rank, problem?))
    });
    ranks.hear_first(&bytes_of(&unread.is_none()));
    if let Some((rank, problem)) = unread {
        return Err(Failure::Run(miette!(
            help = "all processes need the scene's folder and what it names",
            "rank {rank} {problem}"
        )));
    }
    let path = ParticleLoop::Lanes(Processor::best());
    let lead = shared::lead(&loaded.scene, path, ranks.clone());
    lead.map_err(|problem| Failure::input(loaded.source.locate(problem)))
}

/// Shares what the first process simulates next; false if that is nothing.
#[cfg(feature = "mpi")]
fn follow(here: &mpi::Mpi, ranks: Arc<dyn Ranks>) -> Result<bool, Failure> {
    let task = serde_json::from_slice(&here.hear_first(&[])).expect("all processes are the same program");
    let Task::Simulate(source, end) = task else { return Ok(false) };
    let read = source.recorded().unwrap_or_else(|| source.load());
    let problem =
        read.as_ref().err().map(|error| format!("on {} cannot read the scene: {error}", mpi::Mpi::machine()));
    here.tell_first(&bytes_of(&problem));
    let all_read: bool = serde_json::from_slice(&here.hear_first(&[])).unwrap_or(false);
    if let (true, Ok(mut loaded)) = (all_read, read) {
        loaded.scene.time.end = end;
        // What is wrong with the scene, the first one tells.
        let _ = shared::follow(&loaded.scene, ParticleLoop::Lanes(Processor::best()), ranks);
    }
    Ok(true)
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
        assert_eq!(says(&[("PMIX_RANK", 1), ("SLURM_STEP_NUM_TASKS", 4)]), second);
        // A script, and one process.
        assert_eq!(says(&[("SLURM_PROCID", 0), ("SLURM_NTASKS", 4)]), None);
        assert_eq!(says(&[("PMI_RANK", 0), ("PMI_SIZE", 1)]), None);
        assert_eq!(says(&[]), None);
    }
}
