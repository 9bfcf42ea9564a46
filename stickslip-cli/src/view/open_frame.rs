//! A frame whose file is open, with its particles in an order that stays the same from frame to frame.

use super::quantity::{Quantity, quantities};
use rayon::prelude::*;
use std::path::Path;
use stickslip::observe::{ParticleFile, ReadError};

/// A snapshot in which particles stand body by body, by their numbers.
pub struct OpenFrame {
    /// The file.
    pub file: ParticleFile,
    /// What colour can stand for.
    pub quantities: Vec<Quantity>,
    /// The bodies that have particles, in the order of the scene.
    pub runs: Vec<Run>,
    /// Numbers of the particles in their bodies.
    pub numbers: Vec<u32>,
    /// Row of the file of each particle.
    rows: Vec<u32>,
}

/// The particles of a body: their numbers are `first`, `first + step` and so on, in no such order if `step` is 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// Index of the body.
    pub body: u32,
    /// How many.
    pub count: u32,
    /// Number of the first.
    pub first: u32,
    /// From one number to the next.
    pub step: u32,
}

impl OpenFrame {
    /// Opens the file of a frame.
    ///
    /// # Errors
    /// It is missing or damaged.
    pub fn open(path: &Path) -> Result<Self, ReadError> {
        let file = ParticleFile::open(path)?;
        let (bodies, numbers) = (file.bodies()?, file.numbers()?);
        let key = |row: usize| u64::from(bodies[row]) << 32 | u64::from(numbers[row]);
        let mut rows: Vec<u32> = (0..bodies.len() as u32).collect();
        rows.par_sort_unstable_by_key(|&row| key(row as usize));
        let numbers: Vec<u32> = rows.iter().map(|&row| numbers[row as usize]).collect();
        let mut runs = Vec::new();
        let mut start = 0;
        while start < rows.len() {
            let body = bodies[rows[start] as usize];
            let count = rows[start..].partition_point(|&row| bodies[row as usize] == body);
            runs.push(Run::of(body, &numbers[start..start + count]));
            start += count;
        }
        Ok(OpenFrame { quantities: quantities(&file), file, runs, numbers, rows })
    }

    /// Values that stand in the order of the file, in that of the frame.
    pub fn ordered<T: Copy + Send + Sync>(&self, values: &[T]) -> Vec<T> {
        self.rows.par_iter().map(|&row| values[row as usize]).collect()
    }

    /// Where a particle stands in the frame.
    pub fn place(&self, body: usize, number: u32) -> Option<usize> {
        let mut start = 0;
        for run in &self.runs {
            let end = start + run.count as usize;
            if run.body as usize == body {
                return self.numbers[start..end].binary_search(&number).ok().map(|place| start + place);
            }
            start = end;
        }
        None
    }

    /// A quantity at a particle.
    ///
    /// # Errors
    /// The file is cut short.
    pub fn value(&self, quantity: &Quantity, place: usize) -> Result<f32, ReadError> {
        Ok(quantity.values(&self.file)?[self.rows[place] as usize])
    }
}

impl Run {
    fn of(body: u32, numbers: &[u32]) -> Self {
        let first = numbers[0];
        let step = numbers.get(1).map_or(1, |second| second - first);
        let even = numbers.windows(2).all(|pair| pair[1] - pair[0] == step);
        Run { body, count: numbers.len() as u32, first, step: if even { step } else { 0 } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::door::ParticleSnapshot;
    use stickslip::observe::encode_particles;
    use stickslip::scene::SnapshotContent;

    #[test]
    fn particles_stand_body_by_body_and_by_number() {
        let count = 9;
        let snapshot = ParticleSnapshot {
            dimension: 2,
            body: vec![2, 0, 2, 0, 0, 2, 5, 5, 5],
            number: vec![4, 2, 0, 0, 1, 2, 9, 3, 4],
            position: (0..count).map(|i| [i as f64, 0.0, 0.0]).collect(),
            velocity: vec![[0.0; 3]; count],
            stress: vec![[0.0; 6]; count],
            deformation: vec![[0.0; 9]; count],
            mass: (0..count).map(|i| i as f64).collect(),
            volume: vec![1.0; count],
            history: Vec::new(),
        };
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frame.vtu");
        encode_particles(&snapshot, 0.0, &SnapshotContent::default()).write(&path).unwrap();
        let frame = OpenFrame::open(&path).unwrap();
        let run = |body, first, step| Run { body, count: 3, first, step };
        assert_eq!(frame.runs, [run(0, 0, 1), run(2, 0, 2), run(5, 3, 0)]);
        let mass = frame.quantities.iter().find(|quantity| quantity.id == "mass").unwrap();
        let masses = frame.ordered(&mass.values(&frame.file).unwrap());
        assert_eq!(masses, [3.0, 4.0, 1.0, 2.0, 5.0, 0.0, 7.0, 8.0, 6.0]);
        assert_eq!((frame.place(2, 2), frame.place(2, 1), frame.place(1, 0)), (Some(4), None, None));
        assert_eq!(frame.value(mass, 4).unwrap(), 5.0);
    }
}
