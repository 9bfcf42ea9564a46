//! Paler quarters of round bodies, by which one sees them turn.

use super::open_frame::OpenFrame;
use stickslip::observe::{ReadError, RecordedScene};

/// For each body that is round, by the number of a particle whether it is paler: told by where it was in the first
/// frame.
#[derive(Clone, Debug, Default)]
pub struct Quarters(Vec<Option<Vec<bool>>>);

/// Numbers that a frame may leave out for each that it has; of particles beyond none is paler.
const SPARSE: usize = 1000;

impl Quarters {
    /// By the first frame of a run, in a space of so many dimensions.
    ///
    /// # Errors
    /// The frame is cut short.
    pub fn of(first: &OpenFrame, scene: &RecordedScene, dimension: usize) -> Result<Self, ReadError> {
        let centers: Vec<_> = scene.bodies.iter().map(|body| body.shape.round_center()).collect();
        if centers.iter().all(Option::is_none) {
            return Ok(Quarters::default());
        }
        let positions = first.ordered(&first.file.positions()?);
        let mut quarters = vec![None; centers.len()];
        let mut start = 0;
        for run in &first.runs {
            let end = start + run.count as usize;
            if let Some(Some(center)) = centers.get(run.body as usize) {
                let most = first.numbers[end - 1] as usize + 1;
                let mut pale = vec![false; most.min(SPARSE * (end - start))];
                for (x, &number) in positions[start..end].iter().zip(&first.numbers[start..end]) {
                    let negative = (0..dimension).filter(|&axis| x[axis] < center[axis]).count();
                    if let Some(pale) = pale.get_mut(number as usize) {
                        *pale = negative % 2 == 1;
                    }
                }
                quarters[run.body as usize] = Some(pale);
            }
            start = end;
        }
        Ok(Quarters(quarters))
    }

    /// Whether a particle is paler.
    pub fn is_pale(&self, body: u32, number: u32) -> bool {
        let of_body = self.0.get(body as usize).and_then(Option::as_ref);
        of_body.and_then(|pale| pale.get(number as usize)).copied().unwrap_or(false)
    }
}
