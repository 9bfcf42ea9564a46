//! `particles.pvd`: the particles through time, for ParaView.

use super::file::{OutputError, ReadError};
use super::folder::OutputFolder;
use super::frames::Frames;
use super::schedule::Schedule;
use super::vtu::{NUMBER, Points, SYMMETRIC, TENSOR, VECTOR, Vtu};
use super::{Observer, PARTICLES};
use crate::door::{ParticleSnapshot, SnapshotColumn, View};
use crate::scene::Scene;
use crate::tensor::Symmetric;
use std::path::Path;

/// Bytes of a particle in a snapshot but for its history: 23 numbers and two whole ones.
pub(super) const PARTICLE_BYTES: usize = 23 * size_of::<f64>() + 2 * size_of::<u32>();

/// Arrays of every file; the others are history.
const OF_ALL: [&str; 14] = [
    "points",
    "connectivity",
    "offsets",
    "types",
    "velocity",
    "stress",
    "pressure",
    "von_mises",
    "deformation",
    "body",
    "number",
    "mass",
    "volume",
    "dimension",
];

/// Writes `particles.pvd` and `particles/`.
pub(super) struct ParticlesObserver {
    schedule: Schedule,
    frames: Frames,
}

impl ParticlesObserver {
    pub(super) fn create(scene: &Scene, folder: &OutputFolder) -> Result<Self, OutputError> {
        let interval = scene.outputs.particles.unwrap_or(f64::INFINITY);
        let schedule = Schedule::every(interval).and_at(&scene.outputs.particles_at);
        Ok(ParticlesObserver { schedule, frames: Frames::create(folder, PARTICLES)? })
    }
}

impl Observer for ParticlesObserver {
    fn next(&self) -> f64 {
        self.schedule.next()
    }

    fn observe(&mut self, view: &dyn View) -> Result<(), OutputError> {
        let time = view.time();
        self.frames.make_room()?;
        let snapshot = view.snapshot();
        let history: usize = snapshot.history.iter().map(|column| size_of_val(&column.values[..])).sum();
        let bytes = PARTICLE_BYTES * snapshot.mass.len() + history;
        self.frames.push(time, bytes, move || encode_particles(&snapshot, time));
        self.schedule.recorded(time);
        Ok(())
    }

    fn conclude(&mut self) -> Result<(), OutputError> {
        self.frames.finish()
    }

    fn replaces(&self) -> bool {
        true
    }
}

/// A snapshot at a time [s] as a file for ParaView, ready to be written.
///
/// Beside the columns of the snapshot it holds, from the Cauchy stress sigma (tension positive) [Pa]:
///
/// ```text
/// pressure  = -tr(sigma) / 3
/// von_mises = sqrt(3/2 s : s),   s = sigma - tr(sigma)/3 I
/// ```
pub fn encode_particles(snapshot: &ParticleSnapshot, time: f64) -> Vtu {
    let body: Vec<i32> = snapshot.body.iter().map(|&body| body as i32).collect();
    let stress = || snapshot.stress.iter().map(|&sigma| Symmetric(sigma));
    let pressure: Vec<f64> = stress().map(|sigma| -sigma.trace() / 3.0).collect();
    let von_mises: Vec<f64> = stress()
        .map(|sigma| {
            let s = sigma.deviator();
            (1.5 * s.double_dot(&s)).sqrt()
        })
        .collect();

    let mut file = Vtu::new(time, &snapshot.position);
    file.field("dimension", snapshot.dimension as f64);
    file.point_data("velocity", VECTOR, snapshot.velocity.as_flattened());
    file.point_data("stress", SYMMETRIC, snapshot.stress.as_flattened());
    file.point_data("pressure", NUMBER, &pressure);
    file.point_data("von_mises", NUMBER, &von_mises);
    file.point_data("deformation", TENSOR, snapshot.deformation.as_flattened());
    file.point_data("body", NUMBER, &body);
    file.point_data("number", NUMBER, &snapshot.number);
    file.point_data("mass", NUMBER, &snapshot.mass);
    file.point_data("volume", NUMBER, &snapshot.volume);
    for SnapshotColumn { name, unit, kind, values } in &snapshot.history {
        file.described((name, unit), *kind, values);
    }
    file
}

/// The particles in a file that [`encode_particles`] made, bit for bit.
///
/// # Errors
/// The file is missing, cut short, or was written by another program.
pub fn read_particles(path: &Path) -> Result<ParticleSnapshot, ReadError> {
    let file = Points::open(path)?;
    Ok(ParticleSnapshot {
        dimension: file.field("dimension")? as usize,
        body: file.numbers::<i32>("body")?.into_iter().map(|body| body as u32).collect(),
        number: file.numbers("number")?,
        position: file.array("points")?,
        velocity: file.array("velocity")?,
        mass: file.numbers("mass")?,
        volume: file.numbers("volume")?,
        stress: file.array("stress")?,
        deformation: file.array("deformation")?,
        history: (file.names().filter(|name| !OF_ALL.contains(name)))
            .map(|name| {
                let (unit, kind, values) = file.described(name)?;
                Ok(SnapshotColumn { name: name.to_string(), unit, kind, values })
            })
            .collect::<Result<_, ReadError>>()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::column::Kind;
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

    #[test]
    fn particles_come_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("00000.vtu");
        // 16384 numbers of eight bytes fill a block exactly; the others leave a partial block, one block, or none.
        for particles in [0, 1, 1000, 16384, 40001] {
            let written = snapshot(particles);
            encode_particles(&written, 0.25).write(&path).unwrap();
            assert_eq!(read_particles(&path).unwrap(), written, "{particles} particles");
        }
    }

    #[test]
    fn a_file_cut_anywhere_is_an_error_that_names_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("00007.vtu");
        encode_particles(&snapshot(500), 0.25).write(&path).unwrap();
        let whole = fs::read(&path).unwrap();
        let end = whole.len() - "\n</AppendedData>\n</VTKFile>\n".len();
        for length in (0..end).step_by(97) {
            fs::write(&path, &whole[..length]).unwrap();
            let error = read_particles(&path).unwrap_err();
            assert!(error.to_string().contains("00007.vtu"), "{error}");
        }
    }
}
