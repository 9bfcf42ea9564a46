//! The grid over an undeformed shape: all that is constant of a body, and the same of bodies that are alike.

pub mod cut;
mod frame;
mod held;
mod linear;
mod masses;
mod outer;
pub mod spline;

pub use frame::Frame;
pub use held::{Carried, Held, HeldFace, HeldFaces, Reaction, Turned};
pub use outer::Followers;

use crate::geometry::Shape;
use crate::tensor::Vector;
use cut::part;
use spline::{Axis, WIDTH};
use std::fmt::{Display, Formatter};

/// Particles along each side of a cell.
pub const PER_SIDE: usize = 2;

/// What of a particle's part of a cell must lie in the shape, else there is none: others take over its volume.
const LEAST_PART: f64 = 1e-3;

/// A grid over an undeformed shape, with its particles.
#[derive(Clone, Debug)]
pub struct Form<const D: usize> {
    /// Side of a cell [m].
    pub cell: f64,
    /// Where the grid lies.
    pub frame: Frame<D>,
    /// Nodes along each axis.
    pub counts: [usize; D],
    /// From a node to those of the cell whose first it is, in the order of [`Weights::each`].
    pub offsets: Vec<u32>,
    /// Cells that hold particles, and their particles, one after the other.
    pub cells: Vec<Cell>,
    /// Undeformed places of the particles [m].
    pub places: Vec<Vector<f64, D>>,
    /// Undeformed volumes of the particles [m^3], in the plane areas [m^2].
    pub volumes: Vec<f64>,
    /// Volume that moves with each node [m^3, m^2]: zero of nodes that follow others, and of those without use.
    pub node_volumes: Vec<f64>,
    /// Nodes that follow others.
    pub followers: Followers,
    /// Faces of the domain that hold the body.
    pub faces: HeldFaces,
    /// What they hold, if there are some.
    pub held: Option<Box<Held<D>>>,
}

/// A cell between the knots of the splines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// First of its nodes.
    pub node: u32,
    /// First of its particles.
    pub first: u32,
    /// How many particles it has.
    pub count: u32,
}

/// Functions of the nodes at a place: products over the axes.
#[derive(Clone, Copy, Debug)]
pub struct Weights<const D: usize> {
    /// First of the nodes.
    pub node: usize,
    /// Along each axis, by the grid's own axes.
    pub axes: [Axis; D],
}

/// Why a shape has no grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoForm {
    /// The shape has no bounds.
    Unbounded,
    /// It is too thin: it has this extent along an axis, and needs two cells [m].
    Thin(f64),
    /// The grid would have so many nodes.
    Large(f64),
}

impl Display for NoForm {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            NoForm::Unbounded => write!(f, "it has no bounds"),
            NoForm::Thin(extent) => write!(f, "{extent} m are less than two cells"),
            NoForm::Large(nodes) => write!(f, "its grid would have {nodes} nodes"),
        }
    }
}

/// Nodes of a grid at most: their numbers are u32.
const MOST_NODES: f64 = 4e9;

impl<const D: usize> Form<D> {
    /// Nodes that a place sees.
    pub const NODES: usize = WIDTH.pow(D as u32);

    /// The grid of cells of this side over a shape, which faces of the domain hold.
    ///
    /// # Errors
    /// The shape has no bounds, or is thinner than two cells with its images, or its grid is too large.
    pub fn new(shape: &Shape, cell: f64, faces: HeldFaces) -> Result<Self, NoForm> {
        let (frame, counts) = Frame::over(shape, cell, &faces)?;
        let mut form = Form {
            cell,
            frame,
            counts,
            offsets: Vec::new(),
            cells: Vec::new(),
            places: Vec::new(),
            volumes: Vec::new(),
            node_volumes: Vec::new(),
            followers: Followers::default(),
            faces,
            held: None,
        };
        form.offsets = (0..Self::NODES).map(|k| form.node(digits(k, [WIDTH; D])) as u32).collect();
        form.fill(shape);
        if form.places.is_empty() {
            return Err(NoForm::Thin(0.0));
        }
        let reached = form.reached(shape);
        form.share_out(&reached)?;
        form.weigh(shape);
        form.hold_nodes();
        Ok(form)
    }

    /// Places and volumes of the particles [m; m^3, m^2].
    pub fn parts(&self) -> Vec<([f64; 3], f64)> {
        self.places.iter().map(|place| place.space()).zip(self.volumes.iter().copied()).collect()
    }

    /// Nodes in all.
    pub fn nodes(&self) -> usize {
        self.counts.iter().product()
    }

    /// The node at these numbers along the axes.
    #[inline]
    pub fn node(&self, at: [usize; D]) -> usize {
        at.iter().zip(&self.counts).fold(0, |node, (at, count)| node * count + at)
    }

    /// Numbers of a node along the axes.
    pub fn numbers(&self, node: usize) -> [usize; D] {
        digits(node, self.counts)
    }

    /// Undeformed place of a node [m].
    pub fn node_place(&self, node: usize) -> Vector<f64, D> {
        let at = self.numbers(node);
        self.frame.place(Vector::from_fn(|a| at[a] as f64), self.cell)
    }

    /// The functions at an undeformed place; beyond the grid those of the nearest cell go on.
    #[inline]
    pub fn weights(&self, place: Vector<f64, D>) -> Weights<D> {
        let cells = self.frame.cells(place, self.cell);
        let (mut axes, mut at) = ([Axis::at(0.5); D], [0; D]);
        for a in 0..D {
            let last = (self.counts[a] - WIDTH) as f64;
            let base = (cells[a] - 0.5).floor().clamp(0.0, last);
            axes[a] = Axis::in_cell(base as i32, cells[a] - 0.5 - base);
            at[a] = base as usize;
        }
        Weights { node: self.node(at), axes }
    }

    /// Followers take the values of what they follow: a_s = sum e a_m.
    pub fn follow(&self, values: &mut [Vector<f64, D>]) {
        if let Some(held) = &self.held {
            return held.follow(&self.followers, values);
        }
        for (node, masters, shares) in self.followers.iter() {
            let all = masters.iter().zip(shares);
            values[node] = all.fold(Vector::ZERO, |sum, (&m, &share)| sum + values[m as usize] * share);
        }
    }

    /// The same of places: those behind faces lie where the images of what they follow lie.
    pub fn follow_places(&self, places: &mut [Vector<f64, D>]) {
        self.follow(places);
        let shifts = self.held.iter().flat_map(|held| &held.shifts);
        self.followers.nodes.iter().zip(shifts).for_each(|(&node, shift)| places[node as usize] += *shift);
    }

    /// What acts on followers acts on those that they follow: f_m += e f_s.
    pub fn gather(&self, values: &mut [Vector<f64, D>]) {
        if let Some(held) = &self.held {
            return held.gather(&self.followers, values);
        }
        for (node, masters, shares) in self.followers.iter() {
            let own = std::mem::replace(&mut values[node], Vector::ZERO);
            for (&master, &share) in masters.iter().zip(shares) {
                values[master as usize] += own * share;
            }
        }
    }

    /// Parts of cells that lie in the shape, [`PER_SIDE`] along each axis; their volumes sum to that of the shape.
    fn fill(&mut self, shape: &Shape) {
        let side = self.cell / PER_SIDE as f64;
        let (cell, frame) = (self.cell, self.frame);
        let place = |at: [f64; 3]| frame.place(Vector::<f64, D>::of(at), 1.0).space();
        let whole = side.powi(D as i32);
        let mut is_whole = Vec::new();
        let cells = self.counts.map(|count| count - (WIDTH - 1));
        for number in 0..cells.iter().product::<usize>() {
            let at = digits(number, cells);
            let middle = std::array::from_fn(|a| if a < D { (at[a] as f64 + 1.0) * cell } else { 0.0 });
            let distance = shape.distance(place(middle), D);
            if distance >= 0.5 * cell * (D as f64).sqrt() {
                continue;
            }
            let first = self.places.len();
            for sub in 0..PER_SIDE.pow(D as u32) {
                let numbers = digits(sub, [PER_SIDE; D]);
                let low = std::array::from_fn(|a| {
                    if a < D { (at[a] as f64 + 0.5) * cell + numbers[a] as f64 * side } else { 0.0 }
                });
                let part = part(shape, &place, (low, side), D);
                if part.volume > LEAST_PART * whole {
                    self.places.push(Vector::of(part.centroid()));
                    self.volumes.push(part.volume);
                    is_whole.push(part.volume > whole * (1.0 - 1e-12));
                }
            }
            if self.places.len() > first {
                let (node, count) = (self.node(at) as u32, (self.places.len() - first) as u32);
                self.cells.push(Cell { node, first: first as u32, count });
            }
        }
        let sum = |of: bool| -> f64 {
            (self.volumes.iter().zip(&is_whole)).filter(|(_, is)| **is == of).map(|(volume, _)| volume).sum()
        };
        let (inner, cut) = (sum(true), sum(false));
        if let Some(moments) = shape.moments(D)
            && cut > 0.0
            && moments.volume > inner
        {
            let factor = (moments.volume - inner) / cut;
            self.volumes
                .iter_mut()
                .zip(&is_whole)
                .filter(|(_, is)| !**is)
                .for_each(|(volume, _)| *volume *= factor);
        }
    }

    /// Nodes whose functions the shape reaches.
    fn reached(&self, shape: &Shape) -> Vec<bool> {
        let mut reached = vec![false; self.nodes()];
        let far = self.cell * (0.5 * (D as f64).sqrt() + 1e-6);
        for node in 0..self.nodes() {
            let at = self.numbers(node);
            if (0..D).any(|a| at[a] + WIDTH > self.counts[a]) {
                continue;
            }
            let middle = self.frame.place(Vector::from_fn(|a| at[a] as f64 + 1.0), self.cell);
            if shape.distance(middle.space(), D) < far {
                self.offsets.iter().for_each(|&offset| reached[node + offset as usize] = true);
            }
        }
        reached
    }

    /// Volume that moves with each node, and who follows whom.
    fn share_out(&mut self, reached: &[bool]) -> Result<(), NoForm> {
        let mut own = vec![0.0; self.nodes()];
        for (place, volume) in self.places.iter().zip(&self.volumes) {
            let weights = self.weights(*place);
            weights.each(|k, value, _| own[weights.node + self.offsets[k] as usize] += volume * value);
        }
        (self.node_volumes, self.followers, self.held) = outer::follow(self, &own, reached)?;
        Ok(())
    }
}

/// Numbers along the axes of what has a number among so many along each: the last axis runs first.
#[inline(always)]
pub fn digits<const D: usize>(mut number: usize, counts: [usize; D]) -> [usize; D] {
    let mut at = [0; D];
    for a in (0..D).rev() {
        at[a] = number % counts[a];
        number /= counts[a];
    }
    at
}

impl<const D: usize> Weights<D> {
    /// Calls with each node's number in the cell, its value [-] and its slopes along the grid's axes [1/cell].
    #[inline(always)]
    pub fn each(&self, mut f: impl FnMut(usize, f64, [f64; D])) {
        for k in 0..WIDTH.pow(D as u32) {
            let number = digits(k, [WIDTH; D]);
            let value = (0..D).map(|a| self.axes[a].value[number[a]]).product();
            let slope =
                std::array::from_fn(|b| {
                    (0..D)
                        .map(|a| {
                            if a == b { self.axes[a].slope[number[a]] } else { self.axes[a].value[number[a]] }
                        })
                        .product()
                });
            f(k, value, slope);
        }
    }
}

#[cfg(test)]
mod tests;
