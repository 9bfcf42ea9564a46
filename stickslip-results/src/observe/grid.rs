//! `grid.pvd`: the grid nodes that carry mass through time, for ParaView.

use super::file::{FileSum, OutputError, secure};
use super::folder::OutputFolder;
use super::frames::Frames;
use super::memory::Memory;
use super::pieces::{OF_A_PIECE, cut, encoded};
use super::schedule::Schedule;
use super::shared::{GridRequest, write_grid};
use super::vtk::{NUMBER, VECTOR, VtkFile};
use super::{GRID, Observer};
use crate::door::{GridSnapshot, View};
use crate::scene::{Scene, SeriesFormat, SnapshotContent};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};

/// Bytes of a node in a snapshot: 13 numbers and a whole one.
const NODE_BYTES: usize = 13 * size_of::<f64>() + size_of::<u32>();

/// Writes `grid.pvd` and `grid/`.
pub(super) struct GridObserver {
    schedule: Schedule,
    frames: Frames,
    /// How files hold it.
    content: SnapshotContent,
    /// Steps taken at the checkpoint from which the run went on, and the grid there.
    taken_up: Option<(u64, KeptGrid)>,
}

/// The grid at a checkpoint whose time no frame has yet. Nobody can make it anew, and a run that goes on from there
/// without a step, since it was at its end, ends with it.
#[derive(Clone)]
enum KeptGrid {
    /// Of one process: in the checkpoint.
    Nodes(GridSnapshot),
    /// Of ranks: the frame, in a file beside the checkpoint, and what is in that if it could be written.
    Frame(PathBuf, Option<FileSum>),
}

impl GridObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        Ok(GridObserver {
            schedule: Schedule::every(scene.outputs.grid.unwrap_or(f64::INFINITY)),
            frames: Frames::create(folder, GRID, SeriesFormat::Vtu)?,
            content: scene.outputs.snapshots.clone(),
            taken_up: None,
        })
    }
}

impl GridObserver {
    /// What was taken up, if it is the grid of the last step.
    fn kept(&self, view: &dyn View) -> Option<&KeptGrid> {
        self.taken_up.as_ref().filter(|(steps, _)| *steps == view.steps()).map(|(_, grid)| grid)
    }

    fn push(&mut self, time: f64, snapshot: GridSnapshot) {
        let bytes = NODE_BYTES * snapshot.mass.len();
        let content = self.content.clone();
        self.frames.push(time, bytes, move |_| encode_grid(&snapshot, time, &content).into());
    }

    /// What a checkpoint needs of the grid of the last step; `path` is for a file beside it.
    fn to_keep(&self, view: &dyn View, path: PathBuf) -> Option<KeptGrid> {
        if self.schedule.has(view.time()) {
            return None;
        }
        if let Some(kept) = self.kept(view) {
            return Some(kept.clone());
        }
        if view.shares().is_empty() {
            return Some(KeptGrid::Nodes(view.grid_snapshot()));
        }
        let write = || -> Result<FileSum, OutputError> {
            path.parent().map_or(Ok(()), fs::create_dir_all).map_err(OutputError::at(&path))?;
            let sum = self.frames.put_at(&path, |part| written(view, part, &self.content))?;
            secure(&path).map(|()| sum)
        };
        // That a checkpoint is not whole is no reason to end the run: one that needs it will say so.
        let sum = write().ok();
        Some(KeptGrid::Frame(path, sum))
    }
}

/// Puts a copy of the frame there, in which this was, at another place.
fn copy_of(path: &Path, sum: Option<FileSum>, part: &Path) -> io::Result<FileSum> {
    let wrong = |what: &dyn Display| {
        io::Error::other(format!("the grid at the checkpoint, {}: {what}", path.display()))
    };
    fs::copy(path, part).map_err(|error| wrong(&error))?;
    let copied = FileSum::of(&mut File::open(part)?, u64::MAX)?;
    if Some(copied) == sum { Ok(copied) } else { Err(wrong(&"it is not as it was written")) }
}

/// What went into a file of the nodes of all ranks.
fn written(view: &dyn View, path: &Path, content: &SnapshotContent) -> io::Result<FileSum> {
    let (path, content) = (path.to_path_buf(), content.clone());
    write_grid(view, GridRequest { path, time: view.time(), content })
}

impl Observer for GridObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        match self.kept(view).cloned() {
            Some(KeptGrid::Nodes(grid)) => self.push(time, grid),
            Some(KeptGrid::Frame(path, sum)) => {
                self.frames.put(time, |part| copy_of(&path, sum, part))?;
            }
            None if view.shares().is_empty() => {
                self.frames.make_room()?;
                self.push(time, view.grid_snapshot());
            }
            None => self.frames.put(time, |part| written(view, part, &self.content))?,
        }
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.frames.finish()
    }

    fn remember(&mut self, view: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        let (steps, path) = (view.steps(), memory.beside("vtu"));
        let (mut nodes, mut frame) = (None, None);
        if !memory.is_taking_up() {
            match self.to_keep(view, path.clone()) {
                Some(KeptGrid::Nodes(grid)) => nodes = Some((steps, grid)),
                Some(KeptGrid::Frame(_, sum)) => frame = Some((steps, sum)),
                None => {}
            }
        }
        memory.keep("grid", &mut nodes)?;
        memory.keep("frame", &mut frame)?;
        if memory.is_taking_up() {
            let nodes = nodes.filter(|(_, grid): &(u64, GridSnapshot)| grid.is_even());
            let nodes = nodes.map(|(steps, grid)| (steps, KeptGrid::Nodes(grid)));
            self.taken_up = nodes.or(frame.map(|(steps, sum)| (steps, KeptGrid::Frame(path, sum))));
        }
        self.schedule.remember(memory)?;
        self.frames.remember(memory)
    }

    fn replaces(&self) -> bool {
        true
    }
}

/// Nodes that stay together: a body; of one with many nodes, those in a plane across x; of a plane with many, those in
/// a line along z. It is the beginning of what [`place`] says of them, and stretches follow one another as nodes do.
pub(super) type NodeStretch = Vec<u64>;

/// A node's body, and its x and y as whole numbers in the same order.
fn place(grid: &GridSnapshot, node: usize) -> [u64; 3] {
    let ordered = |x: f64| {
        // Without a sign of zero.
        let bits = (x + 0.0).to_bits();
        if x < 0.0 { !bits } else { bits | 1 << 63 }
    };
    let [x, y, _] = grid.position[node];
    [u64::from(grid.body[node]), ordered(x), ordered(y)]
}

/// The first node, of those in a snapshot, that is not before a stretch.
pub(super) fn first_in(grid: &GridSnapshot, stretch: &[u64]) -> usize {
    let (mut first, mut end) = (0, grid.mass.len());
    while first < end {
        let middle = first.midpoint(end);
        match place(grid, middle)[..] < *stretch {
            true => first = middle + 1,
            false => end = middle,
        }
    }
    first
}

/// How many nodes there are in each stretch, in a snapshot and in those of others, which `join` adds.
pub(super) fn count_nodes(
    grid: &GridSnapshot,
    join: &dyn Fn(BTreeMap<NodeStretch, usize>) -> BTreeMap<NodeStretch, usize>,
) -> BTreeMap<NodeStretch, usize> {
    let mut all = BTreeMap::new();
    let mut too_large = BTreeSet::from([NodeStretch::new()]);
    for length in 1..=3 {
        let mut counts: BTreeMap<NodeStretch, usize> = BTreeMap::new();
        for place in (0..grid.mass.len()).map(|node| place(grid, node)) {
            if too_large.contains(&place[..length - 1]) {
                *counts.entry(place[..length].to_vec()).or_default() += 1;
            }
        }
        let (large, small): (BTreeMap<_, _>, BTreeMap<_, _>) =
            join(counts).into_iter().partition(|(_, count)| length < 3 && *count > OF_A_PIECE);
        all.extend(small);
        too_large = large.into_keys().collect();
        if too_large.is_empty() {
            break;
        }
    }
    all
}

/// The nodes of the last step's grid at a time [s] as a file for ParaView, ready to be written: in pieces of up to
/// 65,536 nodes, unless more of a body lie in a line along z.
///
/// Node by node and body by body: `mass` [kg], `velocity` [m/s], internal `force` [N], `contact_impulse` [N s] and the
/// index of the `body`; the side of a `cell` [m] holds for the whole file. Of the `content` precision and compression
/// count.
pub fn encode_grid(snapshot: &GridSnapshot, time: f64, content: &SnapshotContent) -> VtkFile {
    let pieces = cut(&count_nodes(snapshot, &|counts| counts));
    encoded(&pieces, |rows| encode_nodes(&snapshot.rows(rows), time, content))
}

/// The same as one piece.
pub(super) fn encode_nodes(snapshot: &GridSnapshot, time: f64, content: &SnapshotContent) -> VtkFile {
    let body: Vec<i32> = snapshot.body.iter().map(|&body| body as i32).collect();
    let mut file = VtkFile::new(time, &snapshot.position, content);
    file.field("dimension", snapshot.dimension as f64);
    file.field("cell", snapshot.cell);
    file.real("mass", NUMBER, &snapshot.mass);
    file.real("velocity", VECTOR, snapshot.velocity.as_flattened());
    file.real("force", VECTOR, snapshot.force.as_flattened());
    file.real("contact_impulse", VECTOR, snapshot.contact_impulse.as_flattened());
    file.whole("body", &body);
    file
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observe::pieces::counts_of_both;

    /// Nodes of three bodies: of a few, of two planes across x with more than a piece takes in each, and of a line of
    /// narrow planes.
    fn nodes() -> GridSnapshot {
        let box_of = |[x, y, z]: [i32; 3]| {
            (0..x).flat_map(move |i| (0..y).flat_map(move |j| (0..z).map(move |k| [i, j, k])))
        };
        let bodies = [[2, 3, 4], [2, 300, 250], [700, 10, 10]].into_iter().zip(0..);
        let mut grid = GridSnapshot { dimension: 3, cell: 0.5, ..GridSnapshot::default() };
        for (body, place) in bodies.flat_map(|(size, body)| box_of(size).map(move |place| (body, place))) {
            grid.body.push(body);
            grid.position.push(place.map(|i| 0.5 * f64::from(i) - 100.0));
            grid.mass.push(1.0);
            grid.velocity.push(place.map(f64::from));
            grid.force.push([0.0; 3]);
            grid.contact_impulse.push([0.0; 3]);
        }
        GridSnapshot::merged(vec![grid])
    }

    #[test]
    fn pieces_are_the_same_whoever_has_the_nodes() {
        let all = nodes();
        let counts = count_nodes(&all, &|counts| counts);
        assert_eq!(counts.values().sum::<usize>(), all.mass.len());
        let pieces = cut(&counts);
        assert!(pieces.iter().all(|piece| piece.points <= OF_A_PIECE) && pieces.len() >= 4);
        let ends = pieces.iter().scan(0, |end, piece| {
            let begin = *end;
            *end += piece.points;
            Some((begin, &piece.first))
        });
        ends.for_each(|(begin, first)| assert_eq!(first_in(&all, first), begin));
        // Of three, whose first has all of the first body, and nothing else that it says changes what is too large.
        let of = |rank: usize| {
            let rows = (0..all.mass.len())
                .filter(|row| if all.body[*row] == 0 { rank == 0 } else { row % 3 == rank });
            GridSnapshot::merged(rows.map(|row| all.rows(row..row + 1)).collect())
        };
        let parts = [0, 1, 2].map(of);
        let found = std::thread::scope(|scope| {
            let ranks = crate::ranks::Threads::start(3).into_iter().zip(&parts);
            let all: Vec<_> = ranks
                .map(|(ranks, part)| {
                    scope.spawn(move || {
                        count_nodes(part, &|counts| crate::ranks::combined(&ranks, &counts, counts_of_both))
                    })
                })
                .collect();
            all.into_iter().map(|one| one.join().unwrap()).collect::<Vec<_>>()
        });
        assert!(found.iter().all(|found| *found == counts));
        let merged = GridSnapshot::merged(parts.to_vec());
        assert_eq!(merged, all);
    }
}
