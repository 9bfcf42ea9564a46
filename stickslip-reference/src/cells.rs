//! The functions at the particles of each cell, laid out for several lanes.

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;
use stickslip_kernels::lanes::{MOST_LANES, Numbers};
use stickslip_mechanics::geometry::form::spline::WIDTH;
use stickslip_mechanics::geometry::form::{Cell, Form, PER_SIDE};
use stickslip_mechanics::tensor::{Real, Vector};

/// Places in a cell where its particles lie if the shape does not cut their parts, the last axis first: in space; in
/// the plane, half of them.
pub const SITES: usize = PER_SIDE.pow(3);

/// Particles along an axis where their parts are whole, from the cell's lower face [cells].
pub const ALONG: [f64; PER_SIDE] = [0.25, 0.75];

/// How near to these places they lie [cells].
const NEAR: f64 = 1e-9;

/// Cells one after the other along the last axis, whose particles lie where those of whole cells do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Block {
    /// First node of the first one.
    pub node: u32,
    /// How many, at most [`MOST_LANES`].
    pub count: u32,
    /// Which of the lists of volumes has those of its particles.
    volumes: u32,
}

/// Volumes of the particles of a block: place by place a number for each cell, zero where there is none [m^3, m^2].
pub type Volumes<T> = [Numbers<T>; SITES];

/// Values and slopes of the functions at the particles of cells: cells with the same parts share theirs, also those of
/// several bodies.
#[derive(Clone, Debug)]
pub struct Table<T, const D: usize> {
    /// Of each cell, where its entries begin.
    starts: Vec<u32>,
    entries: Arc<Vec<Numbers<T>>>,
    /// Cells that go side by side.
    pub blocks: Vec<Block>,
    /// Numbers of the others.
    pub others: Vec<u32>,
    volumes: Arc<Vec<Volumes<T>>>,
}

/// What tells cells apart: the places of their parts, the axes of their grid, and their side.
type Key = Vec<i64>;

/// Cells of which no two are alike.
struct Kinds<'a, const D: usize> {
    known: HashMap<Key, u32>,
    firsts: Vec<(&'a Form<D>, &'a Cell)>,
}

/// How many cells of a grid differ.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellKinds {
    /// How many there are of which no two are alike.
    pub count: usize,
    /// The same number for grids that have the same cells.
    pub likeness: u64,
}

/// Entries of a node: its value and its slopes.
const fn entries(dimension: usize) -> usize {
    1 + dimension
}

impl<T: Real, const D: usize> Table<T, D> {
    /// Of the grids of some bodies, one for each.
    pub fn of_all<'a>(forms: impl Iterator<Item = &'a Form<D>>) -> Vec<Self> {
        let mut kinds = Kinds { known: HashMap::new(), firsts: Vec::new() };
        let mut lists = VolumeLists { lists: Vec::new(), known: HashMap::new() };
        let of_bodies: Vec<_> = forms.map(|form| (kinds.starts::<T>(form), lists.blocks(form))).collect();
        // Made in the memory that they need: lists that grow take twice of that.
        let mut entries = vec![Numbers::ZERO; Self::OF_CELL * kinds.firsts.len()];
        for (entries, (form, cell)) in entries.chunks_exact_mut(Self::OF_CELL).zip(kinds.firsts) {
            fill(entries, form, &form.places[cell.first as usize..][..cell.count as usize]);
        }
        let (entries, volumes) = (Arc::new(entries), Arc::new(lists.lists));
        let table = |(starts, (blocks, others))| Table {
            starts,
            entries: entries.clone(),
            blocks,
            others,
            volumes: volumes.clone(),
        };
        of_bodies.into_iter().map(table).collect()
    }

    /// Of a grid.
    pub fn new(form: &Form<D>) -> Self {
        Self::of_all([form].into_iter()).remove(0)
    }

    /// Of a cell: the values and slopes of its nodes, [`Table::ENTRIES`] each.
    #[inline(always)]
    pub fn of(&self, cell: usize) -> &[Numbers<T>] {
        &self.entries[self.starts[cell] as usize..][..Self::OF_CELL]
    }

    /// Volumes of the particles of a block.
    #[inline(always)]
    pub fn volumes(&self, block: &Block) -> &Volumes<T> {
        &self.volumes[block.volumes as usize]
    }

    /// Entries of a node: its value and its slopes.
    pub const ENTRIES: usize = entries(D);
    /// Entries of a cell.
    const OF_CELL: usize = Self::ENTRIES * Form::<D>::NODES;

    /// Memory that the tables of so many kinds of cells take, of so many cells in all [bytes].
    pub const fn bytes_of(kinds: usize, cells: usize) -> usize {
        kinds * Self::OF_CELL * size_of::<Numbers<T>>() + cells * (size_of::<u32>() + size_of::<Block>())
    }

    /// Memory of the tables that share one list of entries [bytes].
    pub fn bytes_of_all(tables: &[Self]) -> usize {
        let own = |table: &Self| {
            let numbers = table.starts.capacity() + table.others.capacity();
            numbers * size_of::<u32>() + table.blocks.capacity() * size_of::<Block>()
        };
        // Beside these, a few lists of volumes.
        let entries = tables.first().map_or(0, |table| table.entries.capacity() * size_of::<Numbers<T>>());
        entries + tables.iter().map(own).sum::<usize>()
    }
}

impl<'a, const D: usize> Kinds<'a, D> {
    /// Where the entries of the cells of a grid begin.
    fn starts<T: Real>(&mut self, form: &'a Form<D>) -> Vec<u32> {
        let start = |cell: &'a Cell| {
            let next = (Table::<T, D>::OF_CELL * self.firsts.len()) as u32;
            *self.known.entry(key(form, cell, BILLIONTH)).or_insert_with(|| {
                self.firsts.push((form, cell));
                next
            })
        };
        form.cells.iter().map(start).collect()
    }
}

impl CellKinds {
    /// Those of a grid.
    pub fn of<const D: usize>(form: &Form<D>) -> Self {
        let (mut kinds, mut likeness) = (HashSet::new(), DefaultHasher::new());
        for cell in &form.cells {
            // Grids that lie elsewhere differ by round-off, of which among so many cells some would be told apart.
            let key = key(form, cell, MILLIONTH);
            key.hash(&mut likeness);
            kinds.insert(key);
        }
        CellKinds { count: kinds.len(), likeness: likeness.finish() }
    }
}

/// Parts of a cell by which the places of its parts are told apart: not by round-off.
const BILLIONTH: f64 = 1e9;
const MILLIONTH: f64 = 1e6;

fn key<const D: usize>(form: &Form<D>, cell: &Cell, parts: f64) -> Key {
    let rounded = |x: f64| (x * parts).round() as i64;
    let places = &form.places[cell.first as usize..][..cell.count as usize];
    let axes = form.frame.axes.iter().flat_map(|axis| axis.0.map(rounded));
    let within =
        |place: &Vector<f64, D>| form.weights(*place).axes.map(|axis| rounded(axis.slope[WIDTH - 1]));
    axes.chain([form.cell.to_bits() as i64]).chain(places.iter().flat_map(within)).collect()
}

/// Writes the values and slopes of the nodes of a cell at its particles.
fn fill<T: Real, const D: usize>(all: &mut [Numbers<T>], form: &Form<D>, places: &[Vector<f64, D>]) {
    for lane in 0..MOST_LANES {
        // Lanes beyond repeat the first.
        let weights = form.weights(places[if lane < places.len() { lane } else { 0 }]);
        weights.each(|k, value, slope| {
            let node = &mut all[k * entries(D)..][..entries(D)];
            node[0].0[lane] = T::of(value);
            let slope = form.frame.turned(slope);
            for a in 0..D {
                node[1 + a].0[lane] = T::of(slope[a] / form.cell);
            }
        });
    }
}

/// Volumes of blocks, each list once.
struct VolumeLists<T> {
    lists: Vec<Volumes<T>>,
    known: HashMap<Vec<u64>, u32>,
}

impl<T: Real> VolumeLists<T> {
    /// The blocks of a grid, and the numbers of the cells that belong to none.
    fn blocks<const D: usize>(&mut self, form: &Form<D>) -> (Vec<Block>, Vec<u32>) {
        let (mut blocks, mut others) = (Vec::<(Block, Volumes<T>)>::new(), Vec::new());
        for (number, cell) in form.cells.iter().enumerate() {
            let Some(of_cell) = at_sites(form, cell) else {
                others.push(number as u32);
                continue;
            };
            let follows =
                |block: &Block| (block.count as usize) < MOST_LANES && block.node + block.count == cell.node;
            if !blocks.last().is_some_and(|(block, _)| follows(block)) {
                let block = Block { node: cell.node, count: 0, volumes: 0 };
                blocks.push((block, [Numbers::ZERO; SITES]));
            }
            let (block, volumes) = blocks.last_mut().expect("one has been pushed");
            for (list, volume) in volumes.iter_mut().zip(of_cell) {
                list.0[block.count as usize] = T::of(volume);
            }
            block.count += 1;
        }
        let numbered = |(block, list)| Block { volumes: self.number(list), ..block };
        (blocks.into_iter().map(numbered).collect(), others)
    }

    fn number(&mut self, list: Volumes<T>) -> u32 {
        let key = list.iter().flat_map(|volumes| volumes.0.map(|volume| volume.f64().to_bits())).collect();
        *self.known.entry(key).or_insert_with(|| {
            self.lists.push(list);
            (self.lists.len() - 1) as u32
        })
    }
}

/// Volumes of a cell's particles place by place, if all of them lie where those of whole cells do [m^3, m^2].
fn at_sites<const D: usize>(form: &Form<D>, cell: &Cell) -> Option<[f64; SITES]> {
    let mut volumes = [0.0; SITES];
    for particle in cell.first as usize..(cell.first + cell.count) as usize {
        let weights = form.weights(form.places[particle]);
        if weights.node != cell.node as usize {
            return None;
        }
        let mut site = 0;
        for axis in weights.axes {
            // The last slope of a function is its place in the cell.
            let at = axis.slope[WIDTH - 1];
            site = site * PER_SIDE + ALONG.iter().position(|along| (at - along).abs() < NEAR)?;
        }
        volumes[site] = form.volumes[particle];
    }
    Some(volumes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip_mechanics::geometry::Shape;
    use stickslip_mechanics::geometry::form::HeldFaces;

    /// Two equal disks and a larger one: a cell that lies inside of both sizes counts for each.
    #[test]
    fn tables_take_what_the_kinds_of_cells_tell() {
        let disk = |x: f64, radius: f64| {
            Form::<2>::new(&Shape::disk([x, 0.0], radius), 0.125, HeldFaces::default()).expect("it is thick")
        };
        let forms = [disk(0.0, 0.375), disk(1.0, 0.375), disk(3.0, 0.5)];
        let kinds = forms.each_ref().map(CellKinds::of);
        assert_eq!(kinds[0], kinds[1]);
        assert_ne!(kinds[0].likeness, kinds[2].likeness);
        let cells = forms.iter().map(|form| form.cells.len()).sum();
        let told = Table::<f64, 2>::bytes_of(kinds[0].count + kinds[2].count, cells);
        let held = Table::bytes_of_all(&Table::<f64, 2>::of_all(forms.iter()));
        assert!(held <= told && told < held + held / 10, "{told} {held}");
    }
}
