//! `particles.pvd`: the particles through time, for ParaView.

use super::file::{OutputError, ReadError};
use super::folder::OutputFolder;
use super::frames::Frames;
use super::memory::Memory;
use super::particle_file::ParticleFile;
use super::pieces::{PieceStart, cut, encoded};
use super::schedule::Schedule;
use super::shared::{ParticlesRequest, write_particles};
use super::vtk::{PointArrays, VtkFile};
use super::{Observer, PARTICLES};
use crate::column::{ColumnDescription, DERIVED, IDENTITY, Kind, every, in_files};
use crate::door::{ColumnSource, ParticleSnapshot, SnapshotColumn, View};
use crate::scene::{Scene, SeriesFormat, SnapshotContent};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Writes `particles.pvd` and `particles/`.
pub(super) struct ParticlesObserver {
    schedule: Schedule,
    frames: Frames,
    content: Arc<SnapshotContent>,
    /// Of each body, whether its particles are written.
    bodies: Vec<bool>,
}

impl ParticlesObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let interval = scene.outputs.particles.unwrap_or(f64::INFINITY);
        let schedule = Schedule::every(interval).and_at(&scene.outputs.particles_at);
        let content = Arc::new(scene.outputs.snapshots.clone());
        let bodies = content.held(&scene.bodies);
        Ok(ParticlesObserver {
            schedule,
            frames: Frames::create(folder, PARTICLES, SeriesFormat::Vtu)?,
            content,
            bodies,
        })
    }
}

impl Observer for ParticlesObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        let content = self.content.clone();
        if !view.shares().is_empty() {
            self.frames.put(time, |path| {
                let request = ParticlesRequest {
                    path: path.to_path_buf(),
                    time,
                    content: SnapshotContent::clone(&content),
                    bodies: self.bodies.clone(),
                };
                write_particles(view, request)
            })?;
            self.schedule.recorded(time);
            return Ok(());
        }
        self.frames.make_room()?;
        let snapshot = chosen(view.snapshot(), &self.bodies, content.every);
        self.frames.push(time, snapshot.bytes(), move |_| encode_particles(&snapshot, time, &content).into());
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.frames.finish()
    }

    fn remember(&mut self, _: &dyn View, memory: &mut Memory) -> Result<(), OutputError> {
        self.schedule.remember(memory)?;
        self.frames.remember(memory)
    }

    fn replaces(&self) -> bool {
        true
    }
}

/// The particles of a snapshot that a file holds: of each body all or none, whose numbers are multiples of `every`.
pub(super) fn chosen(snapshot: ParticleSnapshot, bodies: &[bool], every: usize) -> ParticleSnapshot {
    if every == 1 && bodies.iter().all(|wanted| *wanted) {
        return snapshot;
    }
    snapshot.only(|body, number| is_chosen((bodies, every), (body, number)))
}

/// Whether a particle is one of these.
pub(super) fn is_chosen((bodies, every): (&[bool], usize), (body, number): (u32, u32)) -> bool {
    bodies[body as usize] && (number as usize).is_multiple_of(every)
}

/// A body, and which of so many of its numbers.
pub(super) type Stretch = (u32, u32);
/// Numbers of a body that stay together.
const STRETCH: u32 = 1 << 14;

/// How many of some particles, of these bodies and numbers, there are in each stretch.
pub(super) fn count_by_stretch(particles: impl Iterator<Item = (u32, u32)>) -> BTreeMap<Stretch, usize> {
    let mut counts = BTreeMap::new();
    particles.for_each(|(body, number)| *counts.entry((body, number / STRETCH)).or_default() += 1);
    counts
}

/// The bodies and numbers of the particles of a snapshot.
fn identity(snapshot: &ParticleSnapshot) -> impl Iterator<Item = (u32, u32)> + '_ {
    snapshot.body.iter().copied().zip(snapshot.number.iter().copied())
}

/// The body and the number from which on particles are in a piece.
pub(super) fn begin(piece: &PieceStart<Stretch>) -> (u32, u32) {
    let (body, stretch) = piece.first;
    (body, stretch * STRETCH)
}

/// A snapshot at a time [s] as a file for ParaView, ready to be written: in pieces of up to 65,536 particles.
///
/// It holds the columns of the snapshot, and behind each those of [`DERIVED`] that follow from it; first vectors and
/// tensors, then whose each particle is, then numbers, then history. What a reader cannot know, the units of history,
/// the file says. Of the `content` all but bodies and `every` count here.
pub fn encode_particles(snapshot: &ParticleSnapshot, time: f64, content: &SnapshotContent) -> VtkFile {
    let pieces = cut(&count_by_stretch(identity(snapshot)));
    if pieces.len() == 1 {
        return encode_piece(snapshot, time, content);
    }
    encoded(&pieces, |rows| encode_piece(&snapshot.rows(rows), time, content))
}

/// The same as one piece.
pub(super) fn encode_piece(snapshot: &ParticleSnapshot, time: f64, content: &SnapshotContent) -> VtkFile {
    let mut file = VtkFile::new(time, &snapshot.position, content);
    file.field("dimension", snapshot.dimension as f64);
    let wanted =
        |name: &str| content.columns.as_ref().is_none_or(|wanted| wanted.iter().any(|wanted| wanted == name));
    let add_with_derived = |file: &mut VtkFile, (column, values): (ColumnDescription, &[f64])| {
        if wanted(column.name) {
            file.described((column.name, ""), column.kind, values);
        }
        let derived = DERIVED.iter().filter(|derived| derived.from == column.name);
        for derived in derived.filter(|derived| wanted(derived.column.name)) {
            let values: Vec<f64> = values.chunks(column.kind.components()).map(derived.value).collect();
            file.described((derived.column.name, ""), derived.column.kind, &values);
        }
    };
    // The positions are the points themselves.
    let of_every = || snapshot.columns().filter(|(column, _)| column.name != POSITION);
    let is_number = |(column, _): &(ColumnDescription, &[f64])| column.kind == Kind::Number;
    of_every().filter(|column| !is_number(column)).for_each(|column| add_with_derived(&mut file, column));
    let [body, number] = IDENTITY;
    let bodies: Vec<i32> = snapshot.body.iter().map(|&body| body as i32).collect();
    file.whole(body, &bodies);
    file.whole(number, &snapshot.number);
    of_every().filter(is_number).for_each(|column| add_with_derived(&mut file, column));
    for SnapshotColumn { name, unit, kind, values } in
        snapshot.history.iter().filter(|column| wanted(&column.name))
    {
        file.described((name, unit), *kind, values);
    }
    file
}

/// The column that a file has as its points.
const POSITION: &str = every("position").name;

/// The particles in a file that [`encode_particles`] made with all columns: in double precision bit for bit.
///
/// # Errors
/// The file is missing, cut short, or was written by another program or without a column.
pub fn read_particles(path: &Path) -> Result<ParticleSnapshot, ReadError> {
    particles_of(&PointArrays::open(path)?)
}

/// The same of a file that is open.
pub(super) fn particles_of(file: &PointArrays) -> Result<ParticleSnapshot, ReadError> {
    let [body, number] = IDENTITY;
    let remembered = |name: &str| {
        let (unit, kind, values) = file.described(name)?;
        Ok(SnapshotColumn { name: name.to_string(), unit, kind, values })
    };
    Ok(ParticleSnapshot {
        body: file.whole::<i32>(body)?.into_iter().map(|body| body as u32).collect(),
        number: file.whole(number)?,
        history: (file.names().filter(|&name| !in_files().any(|known| known == name)))
            .map(remembered)
            .collect::<Result<_, ReadError>>()?,
        ..ParticleSnapshot::of_columns(file.field("dimension")? as usize, file)?
    })
}

/// All that a file of particles holds: places, body and number, and each column that it has, with its unit.
///
/// # Errors
/// The file is missing, cut short, or was written by another program.
pub fn read_columns(path: &Path) -> Result<FileColumns, ReadError> {
    let file = ParticleFile::open(path)?;
    Ok(FileColumns {
        position: file.positions()?,
        body: file.bodies()?,
        number: file.numbers()?,
        columns: file.columns().map(|column| file.column(column)).collect::<Result<_, ReadError>>()?,
    })
}

/// What a file of particles holds, a value for each particle.
#[derive(Clone, Debug, PartialEq)]
pub struct FileColumns {
    /// Where they are [m].
    pub position: Vec<[f64; 3]>,
    /// Whose they are: the body's place in the scene.
    pub body: Vec<u32>,
    /// Their numbers in their bodies.
    pub number: Vec<u32>,
    /// The other columns, in the order of the file.
    pub columns: Vec<SnapshotColumn>,
}

impl ColumnSource for PointArrays {
    type Error = ReadError;
    fn column<const N: usize>(&self, column: &ColumnDescription) -> Result<Vec<[f64; N]>, ReadError> {
        if column.name == POSITION { self.positions() } else { self.reals(column.name) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::pieces::OF_A_PIECE;
    use super::*;
    use crate::scene::{Compression, Precision};
    use std::fs;

    /// Enough particles for several blocks of every array, with values that use all their bits.
    fn snapshot(particles: usize) -> ParticleSnapshot {
        let value = |seed: usize, i: usize| ((seed + i) as f64 * 0.618).sin() * 1e6;
        let columns = |seed: usize| (0..particles).map(move |i| value(seed, i));
        ParticleSnapshot {
            dimension: 3,
            body: (0..particles).map(|i| (i % 7) as u32).collect(),
            number: (0..particles as u32).rev().collect(),
            position: columns(0).map(|x| [x, -x, 1e-300]).collect(),
            velocity: columns(1).map(|x| [x, 0.0, f64::INFINITY]).collect(),
            mass: columns(2).collect(),
            volume: columns(3).collect(),
            stress: columns(4).map(|x| [x, 2.0 * x, 3.0 * x, -x, 0.5 * x, 0.0]).collect(),
            deformation: columns(5).map(|x| [x, 1.0, 2.0, 3.0, x, 5.0, 6.0, 7.0, x]).collect(),
            // A file has some or none.
            history: [("damage", "", Kind::Number), ("back_stress", "Pa", Kind::Symmetric)]
                .iter()
                .filter(|_| particles % 2 == 1)
                .map(|&(name, unit, kind)| SnapshotColumn {
                    name: name.into(),
                    unit: unit.into(),
                    kind,
                    values: (0..particles * kind.components()).map(|i| value(6, i)).collect(),
                })
                .collect(),
        }
    }

    fn double() -> SnapshotContent {
        SnapshotContent { precision: Precision::Double, ..SnapshotContent::default() }
    }

    #[test]
    fn a_file_holds_the_columns_that_are_asked_for_in_single_precision() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("00000.vtu");
        let written = snapshot(30_001);
        let columns = ["pressure", "velocity", "damage"].map(str::to_string).to_vec();
        let content = SnapshotContent { columns: Some(columns), ..SnapshotContent::default() };
        encode_particles(&written, 0.25, &content).write(&path).unwrap();
        let file = PointArrays::open(&path).unwrap();
        assert_eq!(file.names().collect::<Vec<_>>().join(" "), "velocity pressure body number damage");
        let close = |found: f64, expected: f64| found == f64::from(expected as f32);
        let velocity = file.reals::<3>("velocity").unwrap();
        assert!(velocity.iter().zip(&written.velocity).all(|(a, b)| (0..3).all(|k| close(a[k], b[k]))));
        assert_eq!(file.whole::<u32>("number").unwrap(), written.number);
        let error = read_particles(&path).unwrap_err().to_string();
        assert!(error.contains("stress"), "{error}");
        let held = read_columns(&path).unwrap();
        assert_eq!((held.number.len(), held.position.len(), &held.body), (30_001, 30_001, &written.body));
        let names = held.columns.iter().map(|column| (column.name.as_str(), column.unit.as_str()));
        assert_eq!(names.collect::<Vec<_>>(), [("velocity", "m/s"), ("pressure", "Pa"), ("damage", "")]);
        // Each third particle of odd bodies.
        let some = written.only(|body, number| body % 2 == 1 && number % 3 == 0);
        assert!(some.number.len() > 3000 && some.body.iter().all(|body| body % 2 == 1));
        for (i, number) in some.number.iter().enumerate().step_by(100) {
            let row = written.number.iter().position(|other| other == number).unwrap();
            assert_eq!((some.stress[i], some.mass[i]), (written.stress[row], written.mass[row]));
            assert_eq!(some.history[1].values[6 * i..][..6], written.history[1].values[6 * row..][..6]);
        }
    }

    #[test]
    fn particles_come_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("00000.vtu");
        // 16384 numbers of eight bytes fill a block exactly; the others leave a partial block, one block, or none.
        for particles in [0, 1, 1000, 16384, 40001] {
            let written = snapshot(particles);
            for compression in [Compression::Zlib, Compression::None] {
                let content = SnapshotContent { compression, ..double() };
                encode_particles(&written, 0.25, &content).write(&path).unwrap();
                assert_eq!(read_particles(&path).unwrap(), written, "{particles} particles, {compression:?}");
            }
            // What is cut short is no file.
            let bytes = std::fs::read(&path).unwrap();
            std::fs::write(&path, &bytes[..bytes.len() - 60]).unwrap();
            assert!(particles == 0 || PointArrays::open(&path).unwrap().check().is_err(), "{particles}");
        }
    }

    /// Of three bodies, the second with as many particles as a piece takes: pieces end where stretches of numbers do,
    /// and hold the same particles as one would.
    #[test]
    fn a_file_of_many_particles_has_pieces() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("00000.vtu");
        let counts = [100, OF_A_PIECE + 5, 7];
        let whole = snapshot(counts.iter().sum::<usize>() | 1);
        let numbered =
            || counts.iter().zip(0..).flat_map(|(&count, body)| (0..count as u32).map(move |i| (body, i)));
        let body = numbered().map(|(body, _)| body).collect();
        let number = numbered().map(|(_, number)| number).collect();
        let written = ParticleSnapshot { body, number, ..whole.rows(0..counts.iter().sum()) };
        let pieces: Vec<usize> =
            cut(&count_by_stretch(identity(&written))).iter().map(|piece| piece.points).collect();
        let last = STRETCH as usize;
        assert_eq!(pieces, [100 + OF_A_PIECE - last, last + 5 + 7]);
        for compression in [Compression::Zlib, Compression::None] {
            let content = SnapshotContent { compression, ..double() };
            encode_particles(&written, 0.25, &content).write(&path).unwrap();
            let text = fs::read(&path).unwrap();
            let header = String::from_utf8_lossy(&text[..10_000]).into_owned();
            assert_eq!(header.matches("<Piece ").count(), 2, "{header}");
            assert!(read_particles(&path).unwrap() == written, "{compression:?}");
            let head = ParticleFile::open_head(&path).unwrap();
            let apart = (0..2).map(|piece| head.piece(piece).unwrap().snapshot().unwrap()).collect();
            assert!(ParticleSnapshot::merged(apart) == written, "{compression:?}");
            assert!(head.piece(2).is_err());
            PointArrays::open(&path).unwrap().check().unwrap();
        }
        let nothing = ParticleSnapshot::default();
        assert_eq!(cut(&count_by_stretch(identity(&nothing))).len(), 1);
    }

    #[test]
    fn arrays_follow_from_what_columns_are_described() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("00000.vtu");
        let written = snapshot(3);
        encode_particles(&written, 0.25, &double()).write(&path).unwrap();
        let file = PointArrays::open(&path).unwrap();
        let names: Vec<&str> = file.names().collect();
        let expected =
            "velocity stress pressure von_mises deformation body number mass volume damage back_stress";
        assert_eq!(names.join(" "), expected);
        // Of a stress x (1, 2, 3; -1, 1/2, 0): s = x (-1, 0, 1; -1, 1/2, 0), s : s = 2 x^2 (1 + 1 + 1/4).
        let (pressure, von_mises) =
            (file.reals::<1>("pressure").unwrap(), file.reals::<1>("von_mises").unwrap());
        for (i, &[x, ..]) in written.stress.iter().enumerate() {
            let expected: [f64; 2] = [-2.0 * x, x.abs() * 6.75_f64.sqrt()];
            let off = |found: f64, expected: f64| (found / expected - 1.0).abs();
            assert!(off(pressure[i][0], expected[0]) < 1e-14 && off(von_mises[i][0], expected[1]) < 1e-14);
        }
        assert_eq!(written.bytes(), 3 * (23 * 8 + 2 * 4 + 7 * 8));
    }

    #[test]
    fn a_file_cut_anywhere_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("00007.vtu");
        encode_particles(&snapshot(500), 0.25, &double()).write(&path).unwrap();
        let whole = fs::read(&path).unwrap();
        let end = whole.len() - "\n</AppendedData>\n</VTKFile>\n".len();
        for length in (0..end).step_by(97) {
            fs::write(&path, &whole[..length]).unwrap();
            let error = read_particles(&path).unwrap_err();
            assert!(error.to_string().contains("00007.vtu"), "{error}");
        }
    }
}
