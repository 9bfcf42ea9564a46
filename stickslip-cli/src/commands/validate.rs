//! `stickslip validate`: the contact laws and the schemes of the step against problems with known answers.

use super::say;
use crate::failure::Failure;
use crate::files;
use crate::tell::tell;
use crate::validation::{broken, line, page, table, write_scenes};
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use miette::miette;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;
use stickslip_validation::{BENCHMARKS, Benchmark, LawUnderTest, Scheme, Suite, Tier, laws, schemes};

/// Run problems with known answers by every contact law or scheme of the step, and say how close each comes.
///
/// Exit code 1 where the law or the scheme of scenes that name none, or glue, misses a target that it is not known to
/// miss; nothing is asked of the others.
#[derive(Debug, Args)]
pub struct Arguments {
    /// Benchmarks to run; all without this.
    #[arg(value_name = "NAME", value_parser = benchmark_names(), ignore_case = true)]
    names: Vec<&'static Benchmark>,

    /// Contact law to run; may be repeated; all without this and `--scheme`.
    #[arg(long = "law", value_name = "LAW", value_parser = law_words())]
    laws: Vec<LawUnderTest>,

    /// Scheme to run benchmarks of the step itself by, a basis and a stress update; may be repeated; without this and
    /// `--law` the default one, with `--all` all.
    #[arg(long = "scheme", value_name = "SCHEME", value_parser = scheme_words())]
    schemes: Vec<&'static Scheme>,

    /// Run bodies on grids of their own; without this, `--law` and `--scheme` they run beside the laws and schemes.
    #[arg(long)]
    own: bool,

    /// Every resolution and every variant, which takes long; without this, about four and a half minutes on two cores.
    #[arg(long)]
    all: bool,

    /// Folder for the page and the scenes.
    #[arg(long, value_name = "DIR", default_value = "validation.results")]
    out: PathBuf,

    /// Runs at a time; as many as there are processors without this.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

fn benchmark_names() -> impl TypedValueParser<Value = &'static Benchmark> {
    let names = BENCHMARKS.iter().map(|benchmark| PossibleValue::new(benchmark.name).help(benchmark.title));
    PossibleValuesParser::new(names).map(|name| {
        let found = BENCHMARKS.iter().find(|benchmark| benchmark.name.eq_ignore_ascii_case(&name));
        found.expect("the name is one of them")
    })
}

fn law_words() -> impl TypedValueParser<Value = LawUnderTest> {
    let words = laws().into_iter().map(|law| PossibleValue::new(law.word).help(law.meaning));
    PossibleValuesParser::new(words)
        .map(|word| laws().into_iter().find(|law| law.word == word).expect("the word is one of them"))
}

fn scheme_words() -> impl TypedValueParser<Value = &'static Scheme> {
    let words = schemes().iter().map(|scheme| PossibleValue::new(&*scheme.word).help(&*scheme.meaning));
    PossibleValuesParser::new(words)
        .map(|word| schemes().iter().find(|scheme| scheme.word == word).expect("the word is one of them"))
}

fn unwritable(folder: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(miette!("cannot write to {}: {error}", folder.display()))
}

impl Arguments {
    /// Those that are named; without a name all, and none where only schemes are named.
    fn chosen_laws(&self) -> Vec<LawUnderTest> {
        match &self.laws[..] {
            [] if self.own || self.only(&self.schemes) => Vec::new(),
            [] => laws(),
            named => named.to_vec(),
        }
    }

    /// Those that are named; without a name the default one, with `--all` all, and none where only laws are named.
    fn chosen_schemes(&self) -> Vec<&'static Scheme> {
        match &self.schemes[..] {
            [] if self.own || self.only(&self.laws) => Vec::new(),
            [] => schemes().iter().filter(|scheme| self.all || scheme.default).collect(),
            named => named.to_vec(),
        }
    }

    /// Whether these are all that the command line names: without names of benchmarks, the others stay out.
    fn only<T>(&self, named: &[T]) -> bool {
        self.names.is_empty() && !named.is_empty()
    }

    pub fn execute(self) -> Result<(), Failure> {
        let chosen = |benchmark: &&'static Benchmark| {
            self.names.is_empty() || self.names.iter().any(|named| named.name == benchmark.name)
        };
        let suite = Suite {
            benchmarks: BENCHMARKS.iter().filter(chosen).collect(),
            laws: self.chosen_laws(),
            schemes: self.chosen_schemes(),
            own: self.own || (self.laws.is_empty() && self.schemes.is_empty()),
            tier: if self.all { Tier::Full } else { Tier::Quick },
            threads: match self.threads {
                Some(threads) => threads.into(),
                None => std::thread::available_parallelism().map_or(1, usize::from),
            },
        };
        // A folder that cannot be written shall be known before the work, not after it.
        fs::create_dir_all(&self.out).map_err(|error| unwritable(&self.out, &error))?;
        let (begin, file, scenes) = (Instant::now(), self.out.join("index.html"), self.out.join("scenes"));
        files::replaceable(&file, files::PAGE).map_err(|error| unwritable(&file, &error))?;
        let mut written: Result<(), Failure> = Ok(());
        let report = suite.run(&mut |finished, report| {
            tell!("{}", line(finished));
            // The page stands after each case: who stops the rest keeps what there is.
            let write = || -> Result<(), Failure> {
                write_scenes(finished.entry, finished.run, &scenes)
                    .map_err(|error| unwritable(&self.out, &error))?;
                Ok(page(report, begin.elapsed()).write(&file)?)
            };
            if written.is_ok() {
                written = write();
            }
        });
        written?;
        say(&table(&report))?;
        say(&format!("\npage in {}, scenes in {}", file.display(), scenes.display()))?;
        match broken(&report) {
            Some(broken) => Err(Failure::Run(miette!("{broken}"))),
            None => Ok(()),
        }
    }
}
