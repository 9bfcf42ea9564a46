//! A body on a grid of its own undeformed places: its nodes, and what a step does to them.

mod blocks;
mod pass;

pub use pass::{Asked, Straining, strain};

use std::sync::Arc;
use stickslip_mechanics::geometry::form::{Form, Reaction, Weights};
use stickslip_mechanics::tensor::Vector;

/// The nodes of a body. Those that follow others have the places and velocities of what they follow.
#[derive(Clone, Debug)]
pub struct Interior<const D: usize> {
    /// The grid.
    pub form: Arc<Form<D>>,
    /// Mass that moves with each node [kg]; zero of those that follow others.
    pub masses: Vec<f64>,
    /// Where the nodes are [m].
    pub places: Vec<Vector<f64, D>>,
    /// Their velocities half a step before these places [m/s].
    pub velocities: Vec<Vector<f64, D>>,
    /// Forces on them [N]. Those on followers are given to what they follow once a step, when all that acts is known.
    pub forces: Vec<Vector<f64, D>>,
    /// The same before that, of bodies that faces of the domain hold.
    ungathered: Vec<Vector<f64, D>>,
    density: f64,
}

/// What of a field is left when it is fitted, and steps to it at most.
const FITTED: f64 = 1e-13;
const FITS: usize = 500;

impl<const D: usize> Interior<D> {
    /// A body of this density, undeformed, with velocities by place [m/s].
    pub fn new(
        form: Arc<Form<D>>,
        density: f64,
        velocity: impl Fn(Vector<f64, D>) -> Vector<f64, D>,
    ) -> Self {
        let places: Vec<_> = (0..form.nodes()).map(|node| form.node_place(node)).collect();
        let mut interior = Interior {
            masses: form.node_volumes.iter().map(|volume| volume * density).collect(),
            velocities: places.iter().map(|place| velocity(*place)).collect(),
            forces: vec![Vector::ZERO; places.len()],
            ungathered: Vec::new(),
            density,
            places,
            form,
        };
        interior.form.hold(&mut interior.velocities);
        interior.follow();
        interior
    }

    /// Followers take the places and velocities of what they follow: x_s = sum e x_m, v_s = sum e v_m.
    pub fn follow(&mut self) {
        self.form.follow_places(&mut self.places);
        self.follow_velocities();
    }

    /// Followers take the velocities of what they follow, where these alone have changed.
    pub fn follow_velocities(&mut self) {
        self.form.follow(&mut self.velocities);
    }

    /// Gives the forces on followers to those that they follow: f_m += e f_s.
    pub fn gather_forces(&mut self) {
        if self.form.held.is_some() {
            self.ungathered.clone_from(&self.forces);
        }
        self.form.gather(&mut self.forces);
    }

    /// Values at the nodes whose field is nearest to values of particles, each by its volume, by conjugate gradients:
    ///
    /// ```text
    /// sum_p V_p N_I (sum_J N_J a_J - a_p) = 0        followers take the values of what they follow
    /// ```
    pub fn fitted(&self, values: &[Vector<f64, D>]) -> Vec<Vector<f64, D>> {
        let form = &*self.form;
        let weights: Vec<Weights<D>> = form.places.iter().map(|&place| form.weights(place)).collect();
        let scattered = |values: &dyn Fn(usize) -> Vector<f64, D>| {
            let mut sums = vec![Vector::<f64, D>::ZERO; form.nodes()];
            for (p, (weights, volume)) in weights.iter().zip(&form.volumes).enumerate() {
                let own = values(p) * *volume;
                weights.each(|k, value, _| sums[weights.node + form.offsets[k] as usize] += own * value);
            }
            form.gather(&mut sums);
            sums
        };
        let scaled = |sums: &[Vector<f64, D>]| -> Vec<Vector<f64, D>> {
            let scale = |(sum, &volume): (&Vector<f64, D>, &f64)| {
                if volume > 0.0 { *sum * (1.0 / volume) } else { Vector::ZERO }
            };
            sums.iter().zip(&form.node_volumes).map(scale).collect()
        };
        let product = |a: &[Vector<f64, D>], b: &[Vector<f64, D>]| -> f64 {
            a.iter().zip(b).map(|(a, b)| a.dot(*b)).sum()
        };
        let mut found = vec![Vector::<f64, D>::ZERO; form.nodes()];
        let mut left = scattered(&|p| values[p]);
        let mut next = scaled(&left);
        let mut along = next.clone();
        let mut size = product(&left, &next);
        let enough = FITTED * FITTED * size;
        for _ in 0..FITS {
            if size <= enough {
                break;
            }
            form.follow(&mut along);
            let pushed = scattered(&|p| self.at(&weights[p], &along));
            let step = size / product(&along, &pushed);
            for node in 0..found.len() {
                found[node] += along[node] * step;
                left[node] -= pushed[node] * step;
            }
            next = scaled(&left);
            let before = std::mem::replace(&mut size, product(&left, &next));
            along.iter_mut().zip(&next).for_each(|(along, next)| *along = *next + *along * (size / before));
        }
        form.follow(&mut found);
        found
    }

    /// v += dt (f / M + g), and followers after it. Supports hold nodes with inertia of theirs beside their own [kg];
    /// `inertia` is empty where there is no support.
    pub fn accelerate(&mut self, dt: f64, gravity: Vector<f64, D>, inertia: &[Vector<f64, D>]) {
        for (node, &mass) in self.masses.iter().enumerate().filter(|(_, mass)| **mass > 0.0) {
            let force = self.forces[node] + self.weight(node, gravity);
            self.velocities[node] += match inertia.get(node) {
                None => force * (dt / mass),
                Some(inertia) => Vector::from_fn(|i| force[i] / (mass + inertia[i])) * dt,
            };
        }
        self.follow_velocities();
    }

    /// Weight of a node: images pull the other way across a mirror [N].
    fn weight(&self, node: usize, gravity: Vector<f64, D>) -> Vector<f64, D> {
        let net = self.form.net_volume(node);
        Vector::from_fn(|k| gravity[k] * net[k] * self.density)
    }

    /// What the faces that hold a body did to it in a step that has accelerated it from these velocities [m/s].
    pub fn reactions(
        &self,
        before: &[Vector<f64, D>],
        gravity: Vector<f64, D>,
        inertia: &[Vector<f64, D>],
        dt: f64,
    ) -> Vec<Reaction<D>> {
        if self.form.held.is_none() {
            return Vec::new();
        }
        let changes: Vec<_> =
            self.velocities.iter().zip(before).map(|(now, before)| *now - *before).collect();
        self.form.reactions(
            (&self.places, &changes),
            (&self.ungathered, inertia),
            (self.density, gravity),
            dt,
        )
    }

    /// Masses [kg], places and velocities of all that moves with nodes, of half a model that half alone.
    pub fn carried(&self) -> impl Iterator<Item = (f64, Vector<f64, D>, Vector<f64, D>)> {
        self.form.carried().map(|carried| {
            let place = carried.turned.of(self.places[carried.node]) + carried.shift;
            (self.density * carried.volume, place, carried.turned.of(self.velocities[carried.node]))
        })
    }

    /// x += dt v, and followers after it.
    pub fn advance(&mut self, dt: f64) {
        let moved = self.places.iter_mut().zip(&self.velocities).zip(&self.masses);
        moved.filter(|(_, mass)| **mass > 0.0).for_each(|((place, velocity), _)| *place += *velocity * dt);
        self.form.follow_places(&mut self.places);
    }

    /// sum N_I a_I of values at the nodes.
    #[inline]
    pub fn at(&self, weights: &Weights<D>, values: &[Vector<f64, D>]) -> Vector<f64, D> {
        let mut sum = Vector::ZERO;
        weights.each(|k, value, _| sum += values[weights.node + self.form.offsets[k] as usize] * value);
        sum
    }

    /// f_I += N_I f, of a force at a place [N].
    #[inline]
    pub fn push(&mut self, weights: &Weights<D>, force: Vector<f64, D>) {
        let (forces, offsets) = (&mut self.forces, &self.form.offsets);
        weights.each(|k, value, _| forces[weights.node + offsets[k] as usize] += force * value);
    }

    /// x(X) [m] and F = sum x_I (x) grad N_I, row by row.
    #[inline]
    pub fn map(&self, weights: &Weights<D>) -> (Vector<f64, D>, [[f64; D]; D]) {
        let (mut place, mut own) = (Vector::ZERO, [[0.0; D]; D]);
        weights.each(|k, value, slope| {
            let x = self.places[weights.node + self.form.offsets[k] as usize];
            place += x * value;
            for i in 0..D {
                for a in 0..D {
                    own[i][a] += x[i] * slope[a];
                }
            }
        });
        let per_cell = 1.0 / self.form.cell;
        (place, own.map(|row| (self.form.frame.turned(row) * per_cell).0))
    }

    /// Momentum [N s].
    pub fn momentum(&self) -> Vector<f64, D> {
        self.carried().map(|(mass, _, velocity)| velocity * mass).sum()
    }

    /// Power of the forces on the nodes and of their weight [W].
    pub fn power(&self, gravity: Vector<f64, D>) -> f64 {
        let nodes = self.forces.iter().zip(&self.velocities).enumerate();
        nodes.map(|(node, (force, velocity))| (*force + self.weight(node, gravity)).dot(*velocity)).sum()
    }

    /// Kinetic energy [J].
    pub fn kinetic(&self) -> f64 {
        self.masses
            .iter()
            .zip(&self.velocities)
            .map(|(mass, velocity)| 0.5 * mass * velocity.dot(*velocity))
            .sum()
    }
}

#[cfg(test)]
pub(crate) mod tests;
