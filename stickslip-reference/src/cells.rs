//! The functions at the particles of each cell, laid out for several lanes.

use std::collections::HashMap;
use stickslip_kernels::lanes::{MOST_LANES, Numbers};
use stickslip_mechanics::geometry::form::Form;
use stickslip_mechanics::geometry::form::spline::WIDTH;
use stickslip_mechanics::tensor::{Real, Vector};

/// Values and slopes of the functions at the particles of cells: cells with the same parts share theirs.
#[derive(Clone, Debug)]
pub struct Table<T, const D: usize> {
    /// Of each cell, where its entries begin.
    starts: Vec<u32>,
    /// Of each node of a cell its value [-] and its slopes along the axes of space [1/m], particle by particle.
    entries: Vec<Numbers<T>>,
}

/// Entries of a node: its value and its slopes.
const fn entries(dimension: usize) -> usize {
    1 + dimension
}

impl<T: Real, const D: usize> Table<T, D> {
    /// Of a grid.
    pub fn new(form: &Form<D>) -> Self {
        let mut table = Table { starts: Vec::with_capacity(form.cells.len()), entries: Vec::new() };
        let mut known: HashMap<Vec<u64>, u32> = HashMap::new();
        for cell in &form.cells {
            let places = &form.places[cell.first as usize..][..cell.count as usize];
            // Places in the cell, to a billionth of it: round-off tells no cells apart.
            let within = |place: &Vector<f64, D>| {
                let weights = form.weights(*place);
                weights.axes.map(|axis| (axis.slope[WIDTH - 1] * 1e9).round() as u64)
            };
            let key: Vec<u64> = places.iter().flat_map(within).collect();
            let start = *known.entry(key).or_insert_with(|| table.add(form, places));
            table.starts.push(start);
        }
        table
    }

    fn add(&mut self, form: &Form<D>, places: &[Vector<f64, D>]) -> u32 {
        let start = self.entries.len();
        self.entries.resize(start + entries(D) * Form::<D>::NODES, Numbers::ZERO);
        for lane in 0..MOST_LANES {
            // Lanes beyond repeat the first.
            let weights = form.weights(places[if lane < places.len() { lane } else { 0 }]);
            weights.each(|k, value, slope| {
                let node = &mut self.entries[start + k * entries(D)..][..entries(D)];
                node[0].0[lane] = T::of(value);
                let slope = form.frame.turned(slope);
                for a in 0..D {
                    node[1 + a].0[lane] = T::of(slope[a] / form.cell);
                }
            });
        }
        start as u32
    }

    /// Of a cell: the values and slopes of its nodes, [`Table::ENTRIES`] each.
    #[inline(always)]
    pub fn of(&self, cell: usize) -> &[Numbers<T>] {
        &self.entries[self.starts[cell] as usize..][..Self::ENTRIES * Form::<D>::NODES]
    }

    /// Entries of a node: its value and its slopes.
    pub const ENTRIES: usize = entries(D);
}
