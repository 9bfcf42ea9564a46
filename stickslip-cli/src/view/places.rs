//! Places of a frame's particles as bytes: eight a particle.

use super::exposed::exposed;
use super::open_frame::OpenFrame;
use super::quarters::Quarters;
use stickslip::observe::ReadError;

/// First bytes of a frame.
const MAGIC: [u8; 4] = *b"SSV1";
/// Whole numbers that a coordinate can have within the frame's box.
const COORDINATES: f64 = 65535.0;
/// Whole numbers that the side of a particle can have.
const SIDES: f64 = 16383.0;

/// The frame as bytes, little-endian:
///
/// ```text
/// magic; u32 particles N, runs R, 1 if the sides of the particles are known
/// f64 lower corner of the box of all positions (3), its extent (3), largest side of a particle [m]
/// R times u32 body, count, first number, step between numbers (0: no even step)
/// N times u16 x, y, z within the box from 0 to 65535, 4 (side from 0 to 16383) + 2 (exposed) + (pale)
/// if a run has no even step: N times u32 number
/// ```
/// A particle at no finite place has no side. Without volumes in the file, every side is half a `cell` [m].
///
/// # Errors
/// The file is cut short.
pub fn places(
    frame: &OpenFrame,
    quarters: &Quarters,
    (dimension, cell): (usize, f64),
) -> Result<Vec<u8>, ReadError> {
    let positions = frame.ordered(&frame.file.positions()?);
    let volume = frame.quantities.iter().find(|quantity| quantity.id == "volume");
    let sides: Vec<f64> = match volume {
        Some(volume) => {
            let side = |v: f32| if dimension == 2 { f64::from(v).sqrt() } else { f64::from(v).cbrt() };
            frame.ordered(&volume.values(&frame.file)?).into_iter().map(side).collect()
        }
        None => vec![0.5 * cell; positions.len()],
    };
    let largest = sides.iter().copied().filter(|side| side.is_finite()).fold(0.0, f64::max);
    let open =
        if dimension == 3 { exposed(&frame.runs, &positions, &sides) } else { vec![true; positions.len()] };
    let [low, extent] = span(&positions);

    let mut bytes = Vec::with_capacity(88 + 16 * frame.runs.len() + 8 * positions.len());
    bytes.extend(MAGIC);
    for count in [positions.len(), frame.runs.len(), usize::from(volume.is_some())] {
        bytes.extend((count as u32).to_le_bytes());
    }
    for number in low.into_iter().chain(extent).chain([largest]) {
        bytes.extend(number.to_le_bytes());
    }
    for run in &frame.runs {
        bytes.extend([run.body, run.count, run.first, run.step].into_iter().flat_map(u32::to_le_bytes));
    }
    let mut particle = 0;
    for run in &frame.runs {
        for _ in 0..run.count {
            let x = positions[particle];
            let share = |axis: usize| ((x[axis] - low[axis]) / extent[axis] * COORDINATES).round() as u16;
            let side = if x.iter().all(|c| c.is_finite()) { sides[particle] / largest * SIDES } else { 0.0 };
            let pale = quarters.is_pale(run.body, frame.numbers[particle]);
            let looks = (side.round() as u16) << 2 | u16::from(open[particle]) << 1 | u16::from(pale);
            bytes.extend([share(0), share(1), share(2), looks].into_iter().flat_map(u16::to_le_bytes));
            particle += 1;
        }
    }
    if frame.runs.iter().any(|run| run.step == 0) {
        bytes.extend(frame.numbers.iter().flat_map(|number| number.to_le_bytes()));
    }
    Ok(bytes)
}

/// Lower corner and extent of the box around all finite positions; no extent is zero.
fn span(positions: &[[f64; 3]]) -> [[f64; 3]; 2] {
    let mut low = [f64::INFINITY; 3];
    let mut high = [f64::NEG_INFINITY; 3];
    for x in positions.iter().filter(|x| x.iter().all(|c| c.is_finite())) {
        for axis in 0..3 {
            low[axis] = low[axis].min(x[axis]);
            high[axis] = high[axis].max(x[axis]);
        }
    }
    let low = low.map(|low| if low.is_finite() { low } else { 0.0 });
    let extent = [0, 1, 2].map(|axis| if high[axis] > low[axis] { high[axis] - low[axis] } else { 1e-30 });
    [low, extent]
}
