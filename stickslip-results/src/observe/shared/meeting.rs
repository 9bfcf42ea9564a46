//! Parts of one body that meet: where it was far apart before it deformed and is not now.
//!
//! Each particle says where the material at the middle of its cell comes from,
//!
//! ```text
//! X(q) = X_p + F_p^-1 (q - x_p)
//! ```
//! the same of all particles of one piece, but for how much F varies over a cell. Of two pieces that meet in the cell
//! it differs by the way that they came towards each other.

use super::question::{Asked, Question, answer, cell_of};
use crate::door::View;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use stickslip_scene::tensor::Matrix;

/// Where parts of a body are farthest apart before it deformed that are in one cell now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// Middle of the cell [m].
    pub place: [f64; 3],
    /// How far apart they began, over their stretch there [m].
    pub apart: f64,
}

/// Places from which the middle of a cell comes, by its particles.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(in crate::observe) struct CellOrigins {
    cell: [i64; 3],
    min: [f64; 3],
    max: [f64; 3],
    /// Largest stretch from now to the start there.
    stretch: f64,
}

impl CellOrigins {
    fn merge(&mut self, other: &Self) {
        self.min = std::array::from_fn(|k| self.min[k].min(other.min[k]));
        self.max = std::array::from_fn(|k| self.max[k].max(other.max[k]));
        self.stretch = self.stretch.max(other.stretch);
    }
}

/// Which cells of a body hold what.
#[derive(Clone, Copy, Serialize, Deserialize)]
pub(in crate::observe) struct Meetings {
    body: usize,
    /// Side of the cells [m].
    side: f64,
    /// Of the scene.
    axes: usize,
}

impl Question for Meetings {
    type Answer = Vec<CellOrigins>;

    fn look(&self, view: &dyn View) -> Self::Answer {
        let mut begun: HashMap<u32, [f64; 3]> = HashMap::new();
        let mut inverses: HashMap<u32, Matrix<f64>> = HashMap::new();
        // What has no such columns began nowhere.
        let _ = view.visit_column(self.body, "start", &mut |number, x| {
            begun.insert(number, [x[0], x[1], x[2]]);
        });
        let _ = view.visit_column(self.body, "deformation", &mut |number, f| {
            let f = Matrix(std::array::from_fn(|i| std::array::from_fn(|j| f[3 * i + j])));
            inverses.insert(number, f.inverse());
        });
        let mut cells: HashMap<[i64; 3], CellOrigins> = HashMap::new();
        view.visit(self.body, &mut |particle| {
            let (Some(start), Some(inverse)) = (begun.get(&particle.number), inverses.get(&particle.number))
            else {
                return;
            };
            let cell = cell_of(particle.position, self.side);
            let middle: [f64; 3] = std::array::from_fn(|k| (cell[k] as f64 + 0.5) * self.side);
            let arm: [f64; 3] = std::array::from_fn(|k| match k < self.axes {
                true => middle[k] - particle.position[k],
                false => 0.0,
            });
            let f = &inverse.0;
            let from: [f64; 3] =
                std::array::from_fn(|i| start[i] + (0..3).map(|j| f[i][j] * arm[j]).sum::<f64>());
            let stretch = f.iter().flatten().map(|f| f * f).sum::<f64>().sqrt();
            let here = CellOrigins { cell, min: from, max: from, stretch };
            cells.entry(cell).and_modify(|known| known.merge(&here)).or_insert(here);
        });
        let mut all: Vec<CellOrigins> = cells.into_values().collect();
        all.sort_unstable_by_key(|origins| origins.cell);
        all
    }

    fn join(one: Self::Answer, other: Self::Answer) -> Self::Answer {
        let mut cells: HashMap<[i64; 3], CellOrigins> =
            one.into_iter().map(|origins| (origins.cell, origins)).collect();
        for here in other {
            cells.entry(here.cell).and_modify(|known| known.merge(&here)).or_insert(here);
        }
        let mut all: Vec<CellOrigins> = cells.into_values().collect();
        all.sort_unstable_by_key(|origins| origins.cell);
        all
    }

    fn asked(&self) -> Asked {
        Asked::Meetings(*self)
    }
}

/// Where parts of a body began farthest apart that are in one cell of this side now [m].
pub fn meeting(view: &dyn View, body: usize, (side, axes): (f64, usize)) -> Option<Meeting> {
    let of_cell = |origins: &CellOrigins| Meeting {
        place: std::array::from_fn(|k| match k < axes {
            true => (origins.cell[k] as f64 + 0.5) * side,
            false => 0.0,
        }),
        apart: (0..3).map(|k| (origins.max[k] - origins.min[k]).powi(2)).sum::<f64>().sqrt()
            / (origins.stretch / 3.0_f64.sqrt()).max(1.0),
    };
    let all = answer(view, &Meetings { body, side, axes });
    all.iter().map(of_cell).max_by(|a, b| a.apart.total_cmp(&b.apart))
}
