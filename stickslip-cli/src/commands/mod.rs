//! The commands, one file each.

mod bench;
mod check;
mod completions;
mod fringes;
mod gallery;
mod manual;
mod new;
mod plot;
mod render;
mod reproduce;
mod resume;
mod run;
mod schema;
mod sweep;
mod validate;
mod view;

use crate::failure::Failure;
use crate::ranks::part_here;
use crate::tell::tell;
use clap::Parser;
use miette::miette;
use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock, OnceLock};
use stickslip::check::{Report, free_memory};
use stickslip::lanes::Processor;
use stickslip::observe::Results;
use stickslip::run::ResumeError;
use stickslip::scene::{Loaded, NamePattern, Problem, SceneError, Start};

/// Many deformable bodies in frictional contact, by the material point method.
#[derive(Debug, Parser)]
#[command(name = "stickslip", version, long_version = build(), arg_required_else_help = true)]
pub enum Command {
    Run(run::Arguments),
    Resume(resume::Arguments),
    Sweep(sweep::Arguments),
    Check(check::Arguments),
    New(new::Arguments),
    Gallery(gallery::Arguments),
    Render(Box<render::Arguments>),
    Plot(plot::Arguments),
    Reproduce(reproduce::Arguments),
    Schema(schema::Arguments),
    Completions(completions::Arguments),
    Manual(manual::Arguments),
    Bench(bench::Arguments),
    Validate(validate::Arguments),
    View(view::Arguments),
}

/// The version with what it was built for, and by which instructions the machine steps.
fn build() -> &'static str {
    static SAID: LazyLock<String> = LazyLock::new(|| {
        use std::env::consts::{ARCH, OS};
        let kind = if cfg!(debug_assertions) { "development" } else { "release" };
        let instructions = match Processor::best() {
            Processor::Avx512 => "AVX-512",
            Processor::Avx2 => "AVX2 with fused multiply-add",
            Processor::Any => "those that the build assumes",
        };
        let version = env!("CARGO_PKG_VERSION");
        format!("{version}\nbuild: {kind}, {OS} on {ARCH}\ninstructions on this machine: {instructions}")
    });
    &SAID
}

impl Command {
    /// Threads that the user asks for.
    #[cfg(feature = "mpi")]
    pub fn threads(&self) -> Option<usize> {
        match self {
            Command::Run(arguments) => arguments.threads(),
            Command::Resume(arguments) => arguments.threads(),
            _ => None,
        }
    }

    /// Does what the user asks.
    pub fn execute(self) -> Result<(), Failure> {
        outlive_file_limits();
        Processor::limit().map_err(|refused| Failure::Input(miette!("{refused}")))?;
        match self {
            Command::Run(arguments) => arguments.execute(),
            Command::Resume(arguments) => arguments.execute(),
            Command::Sweep(arguments) => arguments.execute(),
            Command::Check(arguments) => arguments.execute(),
            Command::New(arguments) => arguments.execute(),
            Command::Gallery(arguments) => arguments.execute(),
            Command::Render(arguments) => arguments.execute(),
            Command::Plot(arguments) => arguments.execute(),
            Command::Reproduce(arguments) => arguments.execute(),
            Command::Schema(arguments) => arguments.execute(),
            Command::Completions(arguments) => arguments.execute(),
            Command::Manual(arguments) => arguments.execute(),
            Command::Bench(arguments) => arguments.execute(),
            Command::Validate(arguments) => arguments.execute(),
            Command::View(arguments) => arguments.execute(),
        }
    }
}

/// `name=value` of `--set`.
fn assignment(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok((name.trim().to_owned(), value.trim().to_owned()))
        }
        _ => Err("allowed: name=value, such as cells_per_radius=8".to_owned()),
    }
}

/// The scene of a file with the user's parameters.
fn load(path: &Path, parameters: &[(String, String)]) -> Result<Loaded, SceneError> {
    stickslip::scene::load(path, parameters)
}

/// Memory of the program itself, and of the chart that it draws at the end [bytes].
const PROGRAM: f64 = 6e7;
/// Memory of a particle of the last snapshot while its picture is drawn, as measured with 64,000 to 1.7 million of them
/// [bytes].
const DRAWN: f64 = 720.0;

/// What a run of a scene would be on this machine, with what is doubtful shown where it stands in the file.
fn report(loaded: &Loaded) -> Result<Report, Failure> {
    let report = stickslip::check::report(&loaded.scene);
    let mut report = report.map_err(|problem| Failure::input(loaded.source.locate(problem)))?;
    let drawn = loaded.scene.outputs.particles.map_or(0.0, |_| DRAWN * report.particles as f64);
    // What is on the machine of the first process, which draws once the simulation has gone.
    let run = part_here() * (report.memory + stickslip::run::memory(&report));
    report.memory = run.max(drawn) + PROGRAM;
    Ok(report.in_memory(free_memory()).placed(&loaded.source))
}

/// What a scene cannot begin from, where it says so; other errors as they are.
fn at_start(loaded: &Loaded, error: ResumeError) -> Failure {
    let Some(start) = &loaded.scene.start else { return Failure::input(error) };
    let allowed = match &error {
        ResumeError::Begin { .. } => {
            "a run whose bodies of the same names have the same shapes, particles and cells"
        }
        ResumeError::Lacks { .. } => {
            "a snapshot of all columns and particles of its bodies, as [outputs.snapshots] has without `columns`, \
             `bodies` and `every`, or a checkpoint, which has everything"
        }
        ResumeError::Unread(error) if is_of(&error.path, start) => {
            "a folder of results with a checkpoint in it, a checkpoint, or a snapshot in a folder of results"
        }
        _ => return Failure::input(error),
    };
    let key = if start.at.is_some() { "start.at" } else { "start.from" };
    let (found, allowed) = (error.to_string(), allowed.to_string());
    Failure::input(loaded.source.locate(Problem { key: key.to_string(), found, allowed, help: None }))
}

/// Whether a file belongs to what a scene begins from.
fn is_of(path: &Path, start: &Start) -> bool {
    let folder = start.from.parent().and_then(Path::parent).filter(|_| !start.from.is_dir());
    path.starts_with(&start.from) || folder.is_some_and(|folder| path.starts_with(folder))
}

/// The results in a folder.
fn open(folder: &Path) -> Result<Results, Failure> {
    Results::open(folder).map_err(Failure::input)
}

/// Refuses a time [s] before the first or after the last of those that are recorded.
fn recorded(time: f64, times: impl Iterator<Item = f64>) -> Result<(), Failure> {
    let [first, last] =
        times.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], t| [low.min(t), high.max(t)]);
    // Times are typed as they are read, with fewer digits.
    let margin = 1e-3 * (last - first);
    if first <= last && !(first - margin..=last + margin).contains(&time) {
        return Err(Failure::Input(miette!("--time: found {time} s; allowed: {first} s to {last} s")));
    }
    Ok(())
}

/// Refuses names that none of those are which are known, and patterns that match none.
fn are_names(wanted: &[String], known: &[String]) -> Result<(), Failure> {
    /// Names that a message lists.
    const MOST_LISTED: usize = 12;
    let is_known = |name: &str| {
        let pattern = NamePattern::new(name);
        known.iter().any(|known| pattern.matches(known))
    };
    let Some(unknown) = wanted.iter().find(|name| !is_known(name)) else { return Ok(()) };
    let mut listed: Vec<String> = known.iter().take(MOST_LISTED).cloned().collect();
    if known.len() > MOST_LISTED {
        listed.push(format!("and {} more", known.len() - MOST_LISTED));
    }
    let listed = listed.join(", ");
    Err(Failure::Input(miette!(
        "--body: found `{unknown}`; allowed: {listed}, or a pattern of them with `*`"
    )))
}

/// Writes to standard output. Whoever reads it may have had enough (`stickslip schema | head`): that is no failure.
fn say(text: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout(), "{}", text.trim_end()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Run(miette!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// A flag that is set by the first Ctrl-C, and by the signals by which batch systems and shells ask a program to end,
/// but for those that whoever started it has ignored (`nohup`). The second Ctrl-C ends the program at once.
fn stop_on_interrupt() -> Result<Arc<AtomicBool>, Failure> {
    static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    if let Some(watched) = STOP.get() {
        return Ok(Arc::clone(watched));
    }
    let stop = Arc::clone(STOP.get_or_init(Arc::default));
    let flag = Arc::clone(&stop);
    let installed = ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(i32::from(Failure::INTERRUPTED));
        }
        tell!("\nstopping after this step; Ctrl-C again ends at once");
    });
    installed.map_err(|error| Failure::Run(miette!("cannot watch for Ctrl-C: {error}")))?;
    #[cfg(unix)]
    for signal in ASKED.into_iter().filter(|&signal| !is_ignored(signal)) {
        let watched = signal_hook::flag::register(signal, Arc::clone(&stop));
        watched.map_err(|error| Failure::Run(miette!("cannot watch for signals: {error}")))?;
    }
    Ok(stop)
}

/// Signals by which the user, batch systems and shells ask a program to end.
#[cfg(unix)]
const ASKED: [libc::c_int; 5] = [libc::SIGTERM, libc::SIGHUP, libc::SIGXCPU, libc::SIGUSR1, libc::SIGUSR2];

/// Lets signals by which a run is asked to end pass: the first of its processes hears them, too, and ends it.
#[cfg(feature = "mpi")]
pub fn outlast_signals() -> Result<(), Failure> {
    #[cfg(unix)]
    for signal in ASKED.into_iter().chain([libc::SIGINT]) {
        // Nobody asks the flag: that the signal has a handler is enough.
        let watched = signal_hook::flag::register(signal, Arc::default());
        watched.map_err(|error| Failure::Run(miette!("cannot watch for signals: {error}")))?;
    }
    Ok(())
}

/// Whether whoever started the program wants it to ignore a signal, where the system says so.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask >> (signal - 1) & 1 == 1)
}

/// Lets a write beyond the longest file that the user may have fail as any other, where the system would end the
/// program.
fn outlive_file_limits() {
    // Nobody asks the flag: that the signal has a handler is enough.
    #[cfg(unix)]
    let _ = signal_hook::flag::register(libc::SIGXFSZ, Arc::default());
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_sound() {
        Command::command().debug_assert();
    }

    #[test]
    fn assignments_need_a_name_and_a_value() {
        assert_eq!(assignment("angle=30 deg").unwrap(), ("angle".to_owned(), "30 deg".to_owned()));
        assert_eq!(assignment("a = b=c").unwrap(), ("a".to_owned(), "b=c".to_owned()));
        for wrong in ["angle", "=3", "angle="] {
            assert!(assignment(wrong).is_err(), "{wrong}");
        }
    }
}
