//! What the programs of ranks that share a simulation do together: each with the particles that it has.

mod joint_file;
mod light;
mod meeting;
mod question;

pub(super) use light::{Look, bounds_on_ranks, light_on_ranks};
pub use meeting::{Meeting, meeting};
pub(super) use question::{Asked, Question, answer};
pub use question::{WantedStarts, cell_of, counts, has_near, starts};

use super::checkpoint::{CheckpointForm, MOST_PARTICLES, START, Section};
use super::file::{FileSum, ReadError};
use super::grid::{count_nodes, encode_nodes, first_in};
use super::particle_file::ParticleFile;
use super::particles::{begin, count_by_stretch, encode_piece, is_chosen};
use super::pieces::{counts_of_both, cut};
use super::state_sum::StateSum;
use super::vtk::{END, PieceSize, VtkFile};
use crate::door::{GridSnapshot, NotTakenUp, ParticleSnapshot, SavedShare, SavedState, Simulation, View};
use crate::ranks::{Message, Ranks, bytes_of, combined, gathered, message_to, read};
use crate::scene::{SnapshotContent, StartVelocities};
use joint_file::{JointFile, JointReading, Trouble};
use light::LightRequest;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::io;
use std::path::{self, Path, PathBuf};
use stickslip_engine::shared::Program;

/// What the programs of ranks can do with files of results.
pub const PROGRAM: Program = Program { act, find };

/// What the first rank asks of all.
#[derive(Serialize, Deserialize)]
enum Request {
    /// A file of particles.
    Particles(ParticlesRequest),
    /// A file of the nodes of the grid.
    Grid(GridRequest),
    /// The sections of a checkpoint there, packed or not.
    Sections(#[serde(with = "path_bytes")] PathBuf, bool),
    /// Where specimens are.
    Bounds(Look),
    /// The light of an instant.
    Light(LightRequest),
    /// Something about all particles.
    Question(Asked),
}

/// A file of particles that ranks write together.
#[derive(Serialize, Deserialize)]
pub(super) struct ParticlesRequest {
    #[serde(with = "path_bytes")]
    pub path: PathBuf,
    pub time: f64,
    pub content: SnapshotContent,
    /// Of each body, whether its particles are written.
    pub bodies: Vec<bool>,
}

/// A file of nodes that ranks write together.
#[derive(Serialize, Deserialize)]
pub(super) struct GridRequest {
    #[serde(with = "path_bytes")]
    pub path: PathBuf,
    pub time: f64,
    pub content: SnapshotContent,
}

fn act(own: &dyn Simulation, ranks: &dyn Ranks, asked: &[u8]) -> Vec<u8> {
    match read(asked) {
        Request::Particles(request) => bytes_of(&put_particles(own, ranks, &request)),
        Request::Grid(request) => bytes_of(&put_grid(own, ranks, &request)),
        Request::Sections(path, packed) => {
            let form = if packed { CheckpointForm::Compressed } else { CheckpointForm::Plain };
            bytes_of(&put_sections(own, ranks, (&path, form)))
        }
        Request::Bounds(look) => light::bounds(own, ranks, &look),
        Request::Light(request) => light::light(own, ranks, &request),
        Request::Question(asked) => asked.said(own, ranks),
    }
}

/// What the first rank says of what all have done.
///
/// # Errors
/// The disk of one of them is full or refuses, or nobody shares the simulation; so for those who ask.
fn ask<X: for<'de> Deserialize<'de>>(view: &dyn View, request: &Request) -> io::Result<X> {
    let said = view.ask_ranks(&|| bytes_of(request)).ok_or(io::ErrorKind::Unsupported)?;
    let done: Result<X, Trouble> = read(&said[0]);
    done.map_err(io::Error::from)
}

/// Paths between processes, which need be no text.
#[cfg(unix)]
mod path_bytes {
    use serde::{Deserializer, Serializer};
    use std::ffi::OsString;
    use std::os::unix::ffi::{OsStrExt, OsStringExt};
    use std::path::{Path, PathBuf};

    pub fn serialize<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(path.as_os_str().as_bytes())
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<PathBuf, D::Error> {
        let bytes: Vec<u8> = serde_bytes::deserialize(deserializer)?;
        Ok(OsString::from_vec(bytes).into())
    }
}

/// Paths between processes.
#[cfg(not(unix))]
mod path_bytes {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};
    use std::path::{Path, PathBuf};

    pub fn serialize<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
        path.serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<PathBuf, D::Error> {
        PathBuf::deserialize(deserializer)
    }
}

/// A path that is the same wherever processes stand, as far as it can be told.
fn absolute(path: &Path) -> PathBuf {
    path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
}

/// Has ranks write a file of their particles, the same as one would write: what went into it.
pub(super) fn write_particles(view: &dyn View, request: ParticlesRequest) -> io::Result<FileSum> {
    let path = absolute(&request.path);
    ask(view, &Request::Particles(ParticlesRequest { path, ..request }))
}

fn put_particles(view: &dyn View, ranks: &dyn Ranks, request: &ParticlesRequest) -> Result<FileSum, Trouble> {
    let ParticlesRequest { path, time, content, bodies } = request;
    let mut own = BTreeMap::new();
    for body in (0..bodies.len()).filter(|&body| bodies[body]) {
        let mut numbers = Vec::new();
        // Whatever has no masses has no particles.
        let _ = view.visit_column(body, "mass", &mut |number, _| numbers.push(number));
        let all = numbers.into_iter().map(|number| (body as u32, number));
        own.extend(count_by_stretch(all.filter(|which| is_chosen((bodies, content.every), *which))));
    }
    let pieces = cut(&combined(ranks, &own, counts_of_both));
    let ends: Vec<(u32, u32)> = pieces[1..].iter().map(begin).chain([(bodies.len() as u32, 0)]).collect();
    let wanted = |body, number| is_chosen((bodies, content.every), (body, number));
    let file = PiecedFile {
        path,
        points: pieces.iter().map(|piece| piece.points).collect(),
        rows: &|piece| view.snapshot_between([begin(&pieces[piece]), ends[piece]], &wanted),
        encode: &|rows| encode_piece(&rows, *time, content),
    };
    file.put(ranks)
}

/// Has ranks write a file of the nodes of the last step, the same as one would write: what went into it.
pub(super) fn write_grid(view: &dyn View, request: GridRequest) -> io::Result<FileSum> {
    let path = absolute(&request.path);
    ask(view, &Request::Grid(GridRequest { path, ..request }))
}

fn put_grid(view: &dyn View, ranks: &dyn Ranks, request: &GridRequest) -> Result<FileSum, Trouble> {
    let GridRequest { path, time, content } = request;
    let own = view.grid_snapshot();
    let pieces = cut(&count_nodes(&own, &|counts| combined(ranks, &counts, counts_of_both)));
    let first = |piece: usize| pieces.get(piece).map_or(own.mass.len(), |start| first_in(&own, &start.first));
    let file = PiecedFile {
        path,
        points: pieces.iter().map(|piece| piece.points).collect(),
        rows: &|piece| own.rows(first(piece)..first(piece + 1)),
        encode: &|rows| encode_nodes(&rows, *time, content),
    };
    file.put(ranks)
}

/// What a file has a point each for.
trait Rows: Serialize + DeserializeOwned {
    fn is_empty(&self) -> bool;
    /// Those of several ranks, in the order of the file.
    fn merged(parts: Vec<Self>) -> Self;
}

impl Rows for ParticleSnapshot {
    fn is_empty(&self) -> bool {
        self.number.is_empty()
    }

    fn merged(parts: Vec<Self>) -> Self {
        ParticleSnapshot::merged(parts)
    }
}

impl Rows for GridSnapshot {
    fn is_empty(&self) -> bool {
        self.mass.is_empty()
    }

    fn merged(parts: Vec<Self>) -> Self {
        GridSnapshot::merged(parts)
    }
}

/// A file of points that ranks write together, piece by piece.
struct PiecedFile<'a, R> {
    path: &'a Path,
    /// How many points of all ranks each piece has; there is a piece.
    points: Vec<usize>,
    /// What this rank has of a piece.
    rows: &'a dyn Fn(usize) -> R,
    /// A piece of what all have of it.
    encode: &'a dyn Fn(R) -> VtkFile,
}

impl<R: Rows> PiecedFile<'_, R> {
    /// Each rank packs every so many-th piece, for which the others send it what they have.
    fn put(self, ranks: &dyn Ranks) -> Result<FileSum, Trouble> {
        let PiecedFile { path, points, rows, encode } = self;
        let sizes: Vec<PieceSize> = points.iter().map(|&points| PieceSize::of_points(points)).collect();
        let mut first = None;
        let mut file: Option<JointFile> = None;
        let mut found = Vec::new();
        for round in (0..points.len()).step_by(ranks.count()) {
            let mut parts = Vec::new();
            let mut messages: Vec<Message> = Vec::new();
            for (rank, piece) in (round..points.len()).enumerate().take(ranks.count()) {
                let rows = rows(piece);
                match rank == ranks.rank() {
                    true => parts.push(rows),
                    false if rows.is_empty() => {}
                    false => *message_to(&mut messages, rank) = bytes_of(&rows),
                }
            }
            parts.extend(ranks.exchange(messages).iter().map(|(_, rows)| read::<R>(rows)));
            let mut packed = (round + ranks.rank() < points.len()).then(|| encode(R::merged(parts)));
            let header =
                packed.as_ref().filter(|_| round == 0).map_or(0, |packed| packed.header(&sizes).len());
            let file = file.get_or_insert_with(|| {
                let start = read(&ranks.hear_first(&bytes_of(&(header as u64))));
                JointFile::create(ranks, path, start)
            });
            let size = packed.as_ref().map(|packed| packed.sizes().swap_remove(0));
            file.put(&packed.as_mut().map_or_else(Vec::new, |packed| packed.take_bytes()));
            found.extend(gathered(ranks, &size).into_iter().flatten());
            first = first.or(packed);
        }
        let header =
            first.filter(|_| ranks.rank() == 0).map_or_else(String::new, |first| first.header(&found));
        file.expect("there is a piece").finish([header.as_bytes(), END], false)
    }
}

/// Has ranks write the particles of a checkpoint as sections of a file that has nothing else yet.
pub(super) fn write_sections(
    view: &dyn View,
    (path, form): (&Path, CheckpointForm),
) -> io::Result<Vec<Section>> {
    let path = absolute(path);
    ask(view, &Request::Sections(path, form == CheckpointForm::Compressed))
}

fn put_sections(
    own: &dyn Simulation,
    ranks: &dyn Ranks,
    (path, form): (&Path, CheckpointForm),
) -> Result<Vec<Section>, Trouble> {
    let mut file = JointFile::create(ranks, path, START as u64);
    let mut sections = Vec::new();
    let own_count = own.particles().div_ceil(MOST_PARTICLES);
    let rounds = combined(ranks, &own_count, usize::max);
    own.save_shares(MOST_PARTICLES, &mut |shares| {
        let (section, bytes) = Section::of(&shares, form);
        sections.push(section.at(file.put(&bytes)));
    });
    for _ in sections.len()..rounds {
        file.put(&[]);
    }
    let mut all = gathered(ranks, &sections).concat();
    all.sort_by_key(Section::place);
    file.finish([&super::checkpoint::first_line(), &[]], true).map(|_| all)
}

/// Has ranks take up a state, each some of its particles. None of a simulation that nobody shares.
pub(super) fn restore(
    simulation: &mut dyn Simulation,
    rest: &SavedState,
    particles: &ParticlesThere,
) -> Option<Result<(), NotTakenUp>> {
    simulation.restore_on_ranks(rest, &bytes_of(particles))
}

/// Where the particles of a state lie, of which ranks find some each.
#[derive(Serialize, Deserialize)]
pub enum ParticlesThere {
    /// In sections of a checkpoint.
    Checkpoint(CheckpointPlace),
    /// In pieces of a snapshot.
    Snapshot(SnapshotPlace),
}

/// Sections of a checkpoint.
#[derive(Serialize, Deserialize)]
pub struct CheckpointPlace {
    #[serde(with = "path_bytes")]
    path: PathBuf,
    sections: Vec<Section>,
}

/// Pieces of a snapshot.
#[derive(Serialize, Deserialize)]
pub struct SnapshotPlace {
    #[serde(with = "path_bytes")]
    path: PathBuf,
    pieces: usize,
    /// Of each of its bodies, the place in the state, if that has it.
    places: Vec<Option<usize>>,
}

impl ParticlesThere {
    pub(super) fn in_sections(path: &Path, sections: &[Section]) -> Self {
        let path = absolute(path);
        ParticlesThere::Checkpoint(CheckpointPlace { path, sections: sections.to_vec() })
    }

    /// Those of a snapshot, and its bodies that have particles: `names` are those of all, by their numbers.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn in_snapshot(path: &Path, names: &[String]) -> Result<(Self, Vec<String>), ReadError> {
        let head = ParticleFile::open_head(path)?;
        let pieces = head.pieces();
        let mut there = vec![false; names.len()];
        for piece in 0..pieces {
            for body in head.piece(piece)?.bodies()? {
                there.get_mut(body as usize).into_iter().for_each(|there| *there = true);
            }
        }
        let mut found = Vec::new();
        let places = names.iter().zip(there).map(|(name, is_there)| {
            is_there.then(|| {
                found.push(name.clone());
                found.len() - 1
            })
        });
        let places = places.collect();
        let path = absolute(path);
        Ok((ParticlesThere::Snapshot(SnapshotPlace { path, pieces, places }), found))
    }
}

/// Has ranks begin from the state of another run, of which `rest` is all but particles: the
/// [`state_sum`](super::state_sum) of that state. None of a simulation that nobody shares.
///
/// # Errors
/// A body of the same name is another one there, or a rank does not find its particles.
pub fn begin_on_ranks(
    simulation: &mut dyn Simulation,
    (rest, velocities): (&SavedState, StartVelocities),
    particles: &ParticlesThere,
) -> Option<Result<String, NotTakenUp>> {
    let mut sum = StateSum::new(rest.bodies.iter().map(|body| &body.name[..]));
    let add = &mut |body: usize, bytes: &[u8]| sum.add(body, bytes);
    let begun = simulation.begin_on_ranks((rest, velocities), &bytes_of(particles), add)?;
    Some(begun.map(|()| sum.finish(rest.time, rest.steps)))
}

fn find(ranks: &dyn Ranks, asked: &[u8], show: &mut dyn FnMut(Vec<SavedShare>)) -> Result<(), String> {
    let mut result = Ok(());
    let mut take = |shares: Result<Vec<SavedShare>, String>| match shares {
        Ok(shares) => show(shares),
        Err(problem) => result = Err(problem),
    };
    match read(asked) {
        ParticlesThere::Checkpoint(CheckpointPlace { path, sections }) => {
            JointReading::open(ranks, &path).each_share(
                sections.len(),
                &|section, file| sections[section].bytes(file),
                &mut |section, bytes| {
                    let shares = |bytes: Vec<u8>| {
                        sections[section].shares(&bytes).map_err(|problem| problem.to_string())
                    };
                    take(bytes.and_then(shares));
                },
            );
        }
        ParticlesThere::Snapshot(SnapshotPlace { path, pieces, places }) => {
            let head = OnceCell::new();
            let shares = |piece: usize| {
                let told = |error: ReadError| io::Error::other(error.problem.to_string());
                if head.get().is_none() {
                    let _ = head.set(ParticleFile::open_head(&path).map_err(told)?);
                }
                let head: &ParticleFile = head.get().expect("it was opened");
                let particles = head.piece(piece).and_then(|piece| piece.snapshot()).map_err(told)?;
                Ok(bytes_of(&SavedShare::of_snapshot(&particles, &places)))
            };
            JointReading::open(ranks, &path).each_share(
                pieces,
                &|piece, _| shares(piece),
                &mut |_, bytes| take(bytes.map(|bytes| read(&bytes))),
            );
        }
    }
    result
}
