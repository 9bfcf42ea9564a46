//! `stickslip view DIR|SCENE`: results in a browser.

use super::{assignment, load, open, say};
use crate::drawing::DrawError;
use crate::failure::Failure;
use crate::view::{Estimate, Library, serve, write};
use bytesize::ByteSize;
use clap::Args;
use miette::{IntoDiagnostic, miette};
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use stickslip::observe::SceneSource;
use stickslip::run::RunOptions;
use stickslip::scene::Loaded;
use tempfile::TempDir;

/// Look at results in a browser, also while the run goes on.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Folder of results, or a scene file: then its particles as they are before anything moves.
    what: PathBuf,

    /// Give a named parameter of the scene file another value; may be repeated.
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    parameters: Vec<(String, String)>,

    /// Port of this machine that the page is served from; a free one without this.
    #[arg(long, default_value_t = 0, hide_default_value = true, conflicts_with = "html")]
    port: u16,

    /// Only print where the page is. Without this, a terminal with a display opens a browser.
    #[arg(long)]
    no_open: bool,

    /// Write the page with all that it shows into one file, and serve nothing.
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,

    /// Frames in the file, evenly spread; all of them without this.
    #[arg(long, value_name = "COUNT", requires = "html", value_parser = clap::value_parser!(u32).range(1..))]
    frames: Option<u32>,

    /// Quantities in the file, with commas, such as velocity,pressure,stress.xy; those that are single numbers and the
    /// speed without this.
    #[arg(long, value_delimiter = ',', requires = "html")]
    columns: Option<Vec<String>>,
}

/// The longest file that is written: browsers do not read much more [bytes].
const LONGEST: u64 = 1_500_000_000;
/// Columns that tell nothing to the eye.
const DULL: [&str; 2] = ["mass", "volume"];

impl Arguments {
    pub fn execute(self) -> Result<(), Failure> {
        let made = if self.what.is_file() { Some(self.start()?) } else { None };
        if made.is_none() && !self.parameters.is_empty() {
            return Err(Failure::Input(miette!(
                "--set: allowed with a scene file; found the folder {}",
                self.what.display()
            )));
        }
        let folder = made.as_ref().map_or(self.what.as_path(), |made| made.path());
        let excerpt = self.excerpt(folder)?;
        let library = Library::open(folder, excerpt).map_err(Failure::input)?;
        match &self.html {
            Some(out) => self.write(&library, out),
            None => self.serve(&library),
        }
    }

    fn serve(&self, library: &Library) -> Result<(), Failure> {
        // So that a scene's folder goes when the user has seen enough.
        let stop = Arc::new(AtomicBool::new(false));
        end_on_signals(&stop).into_diagnostic().map_err(Failure::Run)?;
        let serving = serve(self.port);
        let serving =
            serving.map_err(|error| Failure::Input(miette!("--port: found {}: {error}", self.port)))?;
        say(&format!("{} shows {}; Ctrl-C ends", serving.address(), self.what.display()))?;
        if !self.no_open && has_display() {
            // The address stands above.
            let _ = opener::open_browser(serving.address());
        }
        serving.answer(library, &stop);
        Ok(())
    }

    fn write(&self, library: &Library, out: &Path) -> Result<(), Failure> {
        let quantities = self.quantities(library)?;
        let estimate = Estimate::of(library, quantities.len()).map_err(Failure::input)?;
        say(&format!("{}: {estimate}", out.display()))?;
        if estimate.bytes() > LONGEST {
            return Err(Failure::Input(miette!(
                help = "--frames and --columns make it smaller",
                "{}: found at most {}; allowed: {}",
                out.display(),
                ByteSize(estimate.bytes()).display().si(),
                ByteSize(LONGEST).display().si()
            )));
        }
        let written = write(library, &quantities, out);
        let length = written.map_err(|source| DrawError::Write { path: out.to_path_buf(), source })?;
        say(&format!("{} is written: {}", out.display(), ByteSize(length).display().si()))
    }

    /// Which frames the file is to hold: the first and the last, and others between them.
    fn excerpt(&self, folder: &Path) -> Result<Option<Vec<usize>>, Failure> {
        let Some(wanted) = self.frames else { return Ok(None) };
        let count = open(folder)?.frames().len();
        Ok(Some(spread(count, wanted as usize)))
    }

    fn quantities(&self, library: &Library) -> Result<Vec<String>, Failure> {
        let known = library.quantities().map_err(Failure::input)?;
        let ids = || known.iter().map(|quantity| quantity.id.as_str());
        let Some(wanted) = &self.columns else {
            let telling = |id: &&str| {
                !id.contains('.') && !DULL.contains(id) && !["stress", "deformation"].contains(id)
            };
            return Ok(ids().filter(telling).map(str::to_owned).collect());
        };
        if let Some(stranger) = wanted.iter().find(|name| !ids().any(|id| id == name.as_str())) {
            let allowed = ids().collect::<Vec<_>>().join(", ");
            return Err(Failure::Input(miette!("--columns: found `{stranger}`; allowed: {allowed}")));
        }
        Ok(wanted.clone())
    }

    /// Results of the scene at its start, in a folder that goes with the command.
    fn start(&self) -> Result<TempDir, Failure> {
        let Loaded { mut scene, source, .. } = load(&self.what, &self.parameters).map_err(Failure::input)?;
        scene.time.end = 0.0;
        scene.outputs.particles = Some(f64::INFINITY);
        let folder = tempfile::tempdir().into_diagnostic().map_err(Failure::Run)?;
        let simulation = stickslip::step::build(&scene);
        let mut simulation = simulation.map_err(|problem| Failure::input(source.locate(problem)))?;
        let path = std::path::absolute(&self.what).into_diagnostic().map_err(Failure::Run)?;
        let source = SceneSource { path, set: self.parameters.clone(), until: None, text: None };
        let options = RunOptions { source: Some(source), ..RunOptions::new(folder.path()) };
        stickslip::run::run(&scene, simulation.as_mut(), &options, &mut |_| {}).map_err(Failure::input)?;
        Ok(folder)
    }
}

/// Sets the flag at Ctrl-C, and where the program is asked to end.
fn end_on_signals(stop: &Arc<AtomicBool>) -> Result<(), ctrlc::Error> {
    let flag = Arc::clone(stop);
    ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))?;
    #[cfg(unix)]
    for signal in [libc::SIGTERM, libc::SIGHUP] {
        signal_hook::flag::register(signal, Arc::clone(stop)).map_err(ctrlc::Error::System)?;
    }
    Ok(())
}

/// So many of `count` things, evenly spread from the first to the last.
fn spread(count: usize, wanted: usize) -> Vec<usize> {
    if wanted >= count {
        return (0..count).collect();
    }
    let last = count - 1;
    (0..wanted)
        .map(|i| if wanted == 1 { last } else { (i * last + (wanted - 1) / 2) / (wanted - 1) })
        .collect()
}

#[test]
fn an_excerpt_has_the_first_and_the_last_frame() {
    assert_eq!(spread(11, 3), [0, 5, 10]);
    assert_eq!(spread(3, 9), [0, 1, 2]);
    assert_eq!((spread(7, 1), spread(0, 5)), (vec![6], vec![]));
}

/// Whether somebody sits before a screen.
fn has_display() -> bool {
    let screen = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let unix = cfg!(all(unix, not(target_os = "macos")));
    std::io::stdout().is_terminal() && (!unix || screen("DISPLAY") || screen("WAYLAND_DISPLAY"))
}
