//! What sweeps are heading for.

use super::sweeps::Packed;

/// The direction of the nonsmooth nonlinear conjugate gradient method.
///
/// A sweep's change of the impulses is its steepest descent -g. With the direction p of the sweep before,
///
/// ```text
/// b = |g|^2 / |g_before|^2,     l <- l + b p,   p <- b p - g         where b <= 1;  else p <- 0
/// ```
/// (Silcowitz, Niebe and Erleben 2010). The norm is that of energy, sum l^2 / m, and the velocities change with the
/// impulses.
pub struct Direction<const N: usize> {
    impulses: Vec<f64>,
    changes: Vec<[f64; N]>,
    /// |g_before|^2 [J]; none before the first sweep.
    square: Option<f64>,
}

impl<const N: usize> Direction<N> {
    pub fn new(rows: usize, bodies: usize) -> Self {
        Direction { impulses: vec![0.0; rows], changes: vec![[0.0; N]; bodies], square: None }
    }

    /// Begins anew: sweeps go on along nothing.
    pub fn forget(&mut self) {
        self.impulses.fill(0.0);
        self.changes.fill([0.0; N]);
    }

    /// Goes on along it after a sweep that began with these impulses and changes.
    pub fn follow(
        &mut self,
        (rows, changes): (&mut [Packed<N>], &mut [[f64; N]]),
        (begun, begun_changes): (&[f64], &[[f64; N]]),
    ) {
        let squares = rows.iter().zip(begun).map(|(row, begun)| (row.impulse - begun).powi(2) * row.yields);
        let square = squares.sum::<f64>();
        let share = self.square.map_or(0.0, |before| if before > 0.0 { square / before } else { 0.0 });
        self.square = Some(square);
        if share > 1.0 {
            return self.forget();
        }
        for ((row, begun), along) in rows.iter_mut().zip(begun).zip(&mut self.impulses) {
            let descent = row.impulse - begun;
            row.impulse += share * *along;
            *along = share * *along + descent;
        }
        for ((change, begun), along) in changes.iter_mut().zip(begun_changes).zip(&mut self.changes) {
            for k in 0..N {
                let descent = change[k] - begun[k];
                change[k] += share * along[k];
                along[k] = share * along[k] + descent;
            }
        }
    }
}
