//! The functions at the particles of each cell, laid out for several lanes.

use std::collections::HashMap;
use std::sync::Arc;
use stickslip_kernels::lanes::{MOST_LANES, Numbers};
use stickslip_mechanics::geometry::form::spline::WIDTH;
use stickslip_mechanics::geometry::form::{Cell, Form};
use stickslip_mechanics::tensor::{Real, Vector};

/// Values and slopes of the functions at the particles of cells: cells with the same parts share theirs, also those of
/// several bodies.
#[derive(Clone, Debug)]
pub struct Table<T, const D: usize> {
    /// Of each cell, where its entries begin.
    starts: Vec<u32>,
    entries: Arc<Vec<Numbers<T>>>,
}

/// What tells cells apart: the places of their parts, the axes of their grid, and their side, to a billionth.
type Key = Vec<i64>;

/// Entries of cells, and where those begin that are known.
struct Entries<T, const D: usize> {
    /// Of each node of a cell its value [-] and its slopes along the axes of space [1/m], particle by particle.
    entries: Vec<Numbers<T>>,
    known: HashMap<Key, u32>,
}

/// Entries of a node: its value and its slopes.
const fn entries(dimension: usize) -> usize {
    1 + dimension
}

impl<T: Real, const D: usize> Table<T, D> {
    /// Of the grids of some bodies, one for each.
    pub fn of_all<'a>(forms: impl Iterator<Item = &'a Form<D>>) -> Vec<Self> {
        let mut all = Entries { entries: Vec::new(), known: HashMap::new() };
        let starts: Vec<Vec<u32>> = forms.map(|form| all.starts(form)).collect();
        let entries = Arc::new(all.entries);
        starts.into_iter().map(|starts| Table { starts, entries: entries.clone() }).collect()
    }

    /// Of a grid.
    pub fn new(form: &Form<D>) -> Self {
        Self::of_all([form].into_iter()).remove(0)
    }

    /// Of a cell: the values and slopes of its nodes, [`Table::ENTRIES`] each.
    #[inline(always)]
    pub fn of(&self, cell: usize) -> &[Numbers<T>] {
        &self.entries[self.starts[cell] as usize..][..Self::ENTRIES * Form::<D>::NODES]
    }

    /// Entries of a node: its value and its slopes.
    pub const ENTRIES: usize = entries(D);
}

impl<T: Real, const D: usize> Entries<T, D> {
    /// Where the entries of the cells of a grid begin.
    fn starts(&mut self, form: &Form<D>) -> Vec<u32> {
        // Round-off tells no cells apart.
        let rounded = |x: f64| (x * 1e9).round() as i64;
        let axes = form.frame.axes.iter().flat_map(|axis| axis.0.map(rounded));
        let grid: Key = axes.chain([form.cell.to_bits() as i64]).collect();
        let start = |cell: &Cell| {
            let places = &form.places[cell.first as usize..][..cell.count as usize];
            let within =
                |place: &Vector<f64, D>| form.weights(*place).axes.map(|axis| rounded(axis.slope[WIDTH - 1]));
            let key: Key = grid.iter().copied().chain(places.iter().flat_map(within)).collect();
            if let Some(start) = self.known.get(&key) {
                return *start;
            }
            let start = self.add(form, places);
            self.known.insert(key, start);
            start
        };
        form.cells.iter().map(start).collect()
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
}
