//! Loads and supports on bodies on grids of their own: they act on the nodes by the functions at their points.
//!
//! ```text
//! f_I += N_I(X_s) f_s       M_I = sum_s |N_I(X_s)| dt (dt k_s + c_s)        v_I += dt (f_I + m_I g) / (m_I + M_I)
//! ```
//! The inertia of stiff supports is that of the common grid's `loads.rs`.

use super::super::Engine;
use crate::body::Particle;
use crate::door::StepError;
use crate::geometry::form::Weights;
use crate::lanes::Laned;
use crate::load::{CarriedPoint, LoadSums, LoadTime, PointForce};
use crate::part::PartPoint;
use crate::scene::{MeanRoom, OutsideValue};
use crate::tensor::{Matrix, Real, Symmetric, Vector, cross};
use stickslip_reference::contact::Deforming;

/// What loads do to these bodies in a step.
#[derive(Debug, Default)]
pub struct ReferenceLoads<const D: usize> {
    /// Of each body.
    pub bodies: Vec<OfBody<D>>,
    points: Vec<LoadedPoint<D>>,
}

/// What a body's nodes take.
#[derive(Clone, Debug, Default)]
pub struct OfBody<const D: usize> {
    /// M_I [kg]; none where nothing holds it.
    pub inertia: Vec<Vector<f64, D>>,
    /// Velocities half a step before, where something holds it [m/s].
    begun: Vec<Vector<f64, D>>,
}

/// A point of a load in a step.
#[derive(Debug)]
struct LoadedPoint<const D: usize> {
    load: usize,
    /// Place of its body among these.
    place: usize,
    weights: Weights<D>,
    felt: PointForce<f64, D>,
    at: Vector<f64, D>,
    /// Velocity half a step before [m/s].
    begun: Vector<f64, D>,
    measure: f64,
    /// What supports keep at nodes by their inertia [N].
    kept: Vec<(usize, Vector<f64, D>)>,
}

impl<T: Laned, const D: usize> Engine<T, D> {
    /// Adds what loads and supports do to the forces on the nodes.
    ///
    /// # Errors
    /// A function from outside that has no answer.
    pub(super) fn feel_reference_loads(&mut self, dt: f64) -> Result<ReferenceLoads<D>, StepError> {
        let mut felt = ReferenceLoads {
            bodies: vec![OfBody::default(); self.settings.references.len()],
            points: Vec::new(),
        };
        for load in 0..self.settings.loads.len() {
            if let Some(place) = self.reference_of(self.settings.loads[load].body) {
                self.feel_reference_load((load, place), dt, &mut felt)?;
            }
        }
        for (nodes, OfBody { inertia, begun }) in self.state.references.nodes.iter().zip(&mut felt.bodies) {
            if inertia.is_empty() {
                continue;
            }
            begun.clone_from(&nodes.velocities);
            for (node, masters, shares) in nodes.form.followers.iter() {
                let own = inertia[node];
                for (&master, share) in masters.iter().zip(shares) {
                    inertia[master as usize] += own * share.abs();
                }
            }
        }
        for point in &felt.points {
            self.state.references.nodes[point.place].push(&point.weights, point.felt.force);
        }
        Ok(felt)
    }

    fn feel_reference_load(
        &self,
        (number, place): (usize, usize),
        dt: f64,
        all: &mut ReferenceLoads<D>,
    ) -> Result<(), StepError> {
        let load = &self.settings.loads[number];
        let (nodes, time) = (&self.state.references.nodes[place], self.state.time);
        let particles = &self.state.bodies[load.body].particles;
        let points: Vec<(Weights<D>, Particle<f64, D>, PartPoint)> =
            load.points
                .iter()
                .map(|point| {
                    let weights =
                        nodes.form.weights(Vector::from_fn(|k| load.start(point)[k] - point.moved[k]));
                    let (at, rows) = nodes.map(&weights);
                    let mass = particles.get(point.particle as usize).mass.f64();
                    let deformation = Matrix::from_fn(|i, j| {
                        if i < D && j < D { rows[i][j] } else { f64::from(u8::from(i == j)) }
                    });
                    let point = PartPoint { arm: [0.0; 3], ..*point };
                    (weights, carrier(at, deformation, mass), point)
                })
                .collect();
        let mut outside = vec![[0.0; 3]; points.len()];
        if let Some(function) = load.action.outside().and_then(OutsideValue::function) {
            let now: Vec<_> = points.iter().map(|(_, carrier, _)| carrier.position.space()).collect();
            let start: Vec<_> = points.iter().map(|(.., point)| point.position).collect();
            let (mut said, mut bend) = (outside.clone(), outside.clone());
            let room = MeanRoom { values: &mut outside, said: &mut said, bend: &mut bend };
            room.mean(function, (time, dt), [&now, &start]).map_err(|reason| {
                let what = format!("the load on body `{}`", self.state.bodies[load.body].name);
                StepError::Outside { what, time, reason }
            })?;
        }
        let means = load.means(time, dt);
        for ((weights, particle, point), outside) in points.into_iter().zip(outside) {
            let velocity = nodes.at(&weights, &nodes.velocities);
            let carried = CarriedPoint { point: &point, particle: &particle, velocity, outside };
            let when = LoadTime { time, now: time, dt, means };
            let felt = load.at(carried, when, &self.state.loads[number]);
            if felt.inertia != Vector::ZERO {
                let inertia = &mut all.bodies[place].inertia;
                inertia.resize(nodes.masses.len(), Vector::ZERO);
                weights.each(|k, value, _| {
                    inertia[weights.node + nodes.form.offsets[k] as usize] += felt.inertia * value.abs();
                });
            }
            let (at, measure) = (particle.position, point.measure);
            all.points.push(LoadedPoint {
                load: number,
                place,
                weights,
                felt,
                at,
                begun: velocity,
                measure,
                kept: Vec::new(),
            });
        }
        Ok(())
    }
}

impl<const D: usize> ReferenceLoads<D> {
    /// Takes note of what supports keep by their inertia as the nodes are accelerated, and do not give.
    pub(super) fn keep(&mut self, bodies: &[Deforming<'_, D>], dt: f64) {
        for point in self.points.iter_mut().filter(|point| point.felt.inertia != Vector::ZERO) {
            let nodes = &*bodies[point.place].interior;
            let begun = &self.bodies[point.place].begun;
            let (inertia, kept) = (point.felt.inertia, &mut point.kept);
            let mut keep = |node: usize, share: f64| {
                let change = nodes.velocities[node] - begun[node];
                kept.push((node, Vector::from_fn(|i| -inertia[i] * share * change[i] / dt)));
            };
            let weights = &point.weights;
            weights.each(|k, value, _| {
                let node = weights.node + nodes.form.offsets[k] as usize;
                match nodes.form.followers.of(node) {
                    None => keep(node, value.abs()),
                    Some((masters, shares)) => (masters.iter().zip(shares))
                        .for_each(|(&master, share)| keep(master as usize, (value * share).abs())),
                }
            });
        }
    }

    /// What loads did to these bodies in a step, load by load, by the velocities that move them.
    pub(super) fn booked(&self, bodies: &[Deforming<'_, D>], dt: f64) -> Vec<(usize, LoadSums)> {
        let booked = self.points.chunk_by(|a, b| a.load == b.load).map(|points| {
            let mut sums = LoadSums::default();
            let measure: f64 = points.iter().map(|point| point.measure).sum();
            let middle =
                points.iter().map(|point| point.at * (point.measure / measure)).sum::<Vector<f64, D>>();
            for point in points {
                let nodes = &*bodies[point.place].interior;
                let now = nodes.at(&point.weights, &nodes.velocities);
                let (mut force, mean) = (point.felt.force, (now + point.begun) * 0.5);
                sums.work += force.dot(mean) * dt;
                let begun = &self.bodies[point.place].begun;
                for &(node, kept) in &point.kept {
                    force += kept;
                    sums.work += 0.5 * dt * kept.dot(nodes.velocities[node] + begun[node]);
                }
                let impulse = (force * dt).space();
                let moment = cross((point.at - middle).space(), impulse);
                for k in 0..3 {
                    sums.impulse[k] += impulse[k];
                    sums.moment[k] += moment[k];
                }
            }
            (points[0].load, sums)
        });
        booked.collect()
    }
}

/// A particle that stands where a point is.
pub(super) fn carrier<T: Real, const D: usize>(
    position: Vector<T, D>,
    deformation: Matrix<T>,
    mass: T,
) -> Particle<T, D> {
    Particle {
        position,
        velocity: Vector::ZERO,
        spin: Vector::ZERO,
        mass,
        volume: T::ZERO,
        half_width: T::ZERO,
        deformation,
        stress: Symmetric::ZERO,
        number: 0,
    }
}
