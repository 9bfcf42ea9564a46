//! Loads and supports: what acts on points of bodies from outside, and how the nodes feel it.
//!
//! A load acts on points that particles carry along ([`crate::part`]). A point moves with the nodes by
//!
//! ```text
//! x_s = x_p + r,   r = F_p (X_s - X_p)         dx_s/dt = sum_i N_i v_i,   N_i = S_i(x_p) + grad S_i(x_p) . r
//! ```
//! because particles move by sum S_i v_i and F by sum v_i (x) grad S_i. A force f at the point is N_i f at the nodes,
//! the transpose of that, so that it does the same work on both.

use crate::body::Particle;
use crate::part::{self, PartPoint, PartPoints};
use crate::scene::{Action, Dashpot, Expression, Extent, Load, Moment, RIGID, Scene, Spring, SupportMotion};
use crate::tensor::{Real, Vector};
use serde::{Deserialize, Serialize};
use stickslip_kernels::points::arm;

/// A load or a support with the points on which it acts.
#[derive(Clone, Debug)]
pub struct LoadPoints {
    /// What it does.
    pub action: Action,
    /// Index of its body.
    pub body: usize,
    /// The points by their numbers, of which each of several ranks has those that its particles carry; none of a
    /// temperature.
    pub points: Vec<PartPoint>,
    /// How many there are on all ranks.
    pub count: usize,
    /// Where the first of all was at the start [m].
    first: [f64; 3],
    /// Of a temperature, which particles of the body it heats, by number.
    pub heats: Vec<bool>,
    /// Area of all of them, or volume [m^2 or m^3].
    pub measure: f64,
    /// Stiffness along axes that are held, per area or volume [Pa/m or Pa/m^2].
    stiffness: f64,
    /// Dashpot along and across the surface's normal likewise [Pa s/m or Pa s/m^2].
    dashpot: [f64; 2],
    /// How far inside the surface the points lie [m].
    inset: f64,
}

/// A spring with the points of its ends.
#[derive(Clone, Debug)]
pub struct SpringPoints {
    /// Force over change of length [N/m].
    pub stiffness: f64,
    /// Force over its rate [N s/m].
    pub dashpot: f64,
    /// Length at the start [m].
    pub drawn: f64,
    /// Length without a force [m].
    pub rest: f64,
    /// Its ends.
    pub ends: [PartPoints; 2],
}

impl SpringPoints {
    /// A spring of a scene with its points.
    pub fn new(scene: &Scene, spring: &Spring) -> Self {
        let ends = [0, 1].map(|side| {
            let end = &spring.ends[side];
            PartPoints::new(scene, end.body, &end.part)
        });
        let drawn = (Vector(ends[0].center) - Vector(ends[1].center)).norm();
        let rest = spring.length.unwrap_or(drawn);
        SpringPoints { stiffness: spring.stiffness, dashpot: spring.dashpot, drawn, rest, ends }
    }
}

/// What a load did since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LoadSums {
    /// Impulse on the body [N s].
    pub impulse: [f64; 3],
    /// Impulse of moments about the middle of its part, where that is in each step [N m s].
    pub moment: [f64; 3],
    /// Work on the body [J].
    pub work: f64,
    /// How far a support of prescribed velocity has moved [m].
    pub driven: [f64; 3],
}

impl LoadSums {
    /// Adds what it did in a step.
    pub fn add(&mut self, step: &LoadSums) {
        let own = [&mut self.impulse, &mut self.moment, &mut self.driven].into_iter().flatten();
        own.zip([step.impulse, step.moment, step.driven].concat()).for_each(|(sum, x)| *sum += x);
        self.work += step.work;
    }
}

/// What acts on a point in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointForce<T, const D: usize> {
    /// Force at the start of the step [N].
    pub force: Vector<T, D>,
    /// By how much its impulse falls in the step, over the change of the velocity: dt (dt k + c) [kg].
    pub inertia: Vector<T, D>,
    /// Stiffness k of a support [N/m].
    pub spring: Vector<T, D>,
    /// What of the force its springs are [N].
    pub pull: Vector<T, D>,
    /// Velocity that a support prescribes, the mean over the step [m/s].
    pub speed: Vector<T, D>,
    /// That velocity where the step begins [m/s].
    pub begun: Vector<T, D>,
}

impl<T: Real, const D: usize> Default for PointForce<T, D> {
    fn default() -> Self {
        let nothing = Vector::ZERO;
        PointForce {
            force: nothing,
            inertia: nothing,
            spring: nothing,
            pull: nothing,
            speed: nothing,
            begun: nothing,
        }
    }
}

/// When a load acts on a point.
#[derive(Clone, Copy, Debug)]
pub struct LoadTime {
    /// When the step begins [s].
    pub time: f64,
    /// The time at which the point is where it is [s].
    pub now: f64,
    /// Length of the step [s].
    pub dt: f64,
    /// The means over the step of what the load prescribes, along each axis; of what tells places apart none.
    pub means: [Option<f64>; 3],
}

/// A point now.
#[derive(Clone, Copy, Debug)]
pub struct CarriedPoint<'a, T, const D: usize> {
    /// The point at the start.
    pub point: &'a PartPoint,
    /// The particle that carries it.
    pub particle: &'a Particle<T, D>,
    /// Its velocity [m/s].
    pub velocity: Vector<T, D>,
    /// What a function from outside says of it, if the load has one.
    pub outside: [f64; 3],
}

impl LoadPoints {
    /// A load of a scene with its points, on a body of so many particles; or with those alone that particles with some
    /// numbers carry, which ascend.
    ///
    /// A rigid support has springs of, per area,
    ///
    /// ```text
    /// k = RIGID M / (C^2 h)          M: wave modulus, C: Courant number, h: cell
    /// ```
    /// which give way as much as a layer of the body of thickness M/k does. They act half as deep inside the surface,
    /// which takes as much from how far the body gives way: N . K^-1 . N of its stiffness K falls by 2 d/E as N moves
    /// inward by d.
    pub fn new(scene: &Scene, load: &Load, particles: usize, here: Option<&[u32]>) -> Self {
        let heated = matches!(load.action, Action::Temperature(_));
        let mut heats = vec![false; if heated { particles } else { 0 }];
        let (mut points, mut count, mut first, mut measure) = (Vec::new(), 0, None, 0.0);
        part::visit(scene, load.body, &load.part, &mut |point| {
            measure += point.measure;
            if heated {
                heats[point.particle as usize] = true;
                return;
            }
            count += 1;
            first.get_or_insert(point.position);
            if here.is_none_or(|here| here.binary_search(&point.particle).is_ok()) {
                points.push(point);
            }
        });
        let (mut stiffness, mut dashpot, mut inset) = (0.0, [0.0; 2], 0.0);
        if let Action::Support(support) = &load.action {
            if support.is_rigid() {
                let material = &scene.materials[scene.bodies[load.body].material];
                let modulus = material.law.wave_modulus_at_rest(scene.dimension.thickness());
                let depth = if load.part.on == Extent::Volume { 2 } else { 1 };
                let stiffest = RIGID / scene.time.courant.powi(2);
                let cell = scene.cell(&scene.bodies[load.body]);
                stiffness = stiffest * modulus / cell.powi(depth);
                inset = 0.5 * cell / stiffest;
            } else {
                stiffness = support.stiffness.unwrap_or(0.0) / measure;
            }
            dashpot = match support.dashpot {
                None => [0.0; 2],
                Some(Dashpot::Whole(whole)) => [whole / measure; 2],
                Some(Dashpot::Absorbing) => {
                    let material = &scene.materials[scene.bodies[load.body].material];
                    let modulus = material.law.wave_modulus_at_rest(scene.dimension.thickness());
                    [modulus, material.law.elastic().shear_modulus]
                        .map(|modulus| (modulus * material.density).sqrt())
                }
            };
        }
        for point in &mut points {
            (0..3).for_each(|i| point.arm[i] -= inset * point.normal[i]);
        }
        LoadPoints {
            action: load.action.clone(),
            body: load.body,
            points,
            count,
            first: first.unwrap_or_default(),
            heats,
            measure,
            stiffness,
            dashpot,
            inset,
        }
    }

    /// Whether its dashpot differs along and across the surface's normal.
    fn resists_waves(&self) -> bool {
        self.dashpot[0] != self.dashpot[1]
    }

    /// Where a point was at the start of the run [m].
    pub fn start(&self, point: &PartPoint) -> [f64; 3] {
        std::array::from_fn(|i| point.position[i] - self.inset * point.normal[i] + point.moved[i])
    }

    /// The means over a step of `dt` from `time` on of the forces or velocities that it prescribes at all points alike.
    pub fn means(&self, time: f64, dt: f64) -> [Option<f64>; 3] {
        let mean = |value: &Expression| value.is_of_time().then(|| value.over_step(time, dt));
        match &self.action {
            Action::Force(values) | Action::Traction(values) | Action::Acceleration(values) => {
                values.each_ref().map(mean)
            }
            Action::Pressure(value) => [mean(value), None, None],
            Action::Temperature(_) => [None; 3],
            Action::Support(support) => support.motion.each_ref().map(|motion| match motion {
                Some(SupportMotion::Velocity(velocity)) => mean(velocity),
                Some(SupportMotion::Displacement(_)) | None => None,
            }),
        }
    }

    /// What acts on one of its points in a step.
    pub fn at<T: Real, const D: usize>(
        &self,
        carried: CarriedPoint<T, D>,
        LoadTime { time, now, dt, means }: LoadTime,
        sums: &LoadSums,
    ) -> PointForce<T, D> {
        let CarriedPoint { point, particle, velocity, outside } = carried;
        let place = place_of(particle, point).space();
        // Forces are the means over the step, displacements those of now.
        let moment = |time: f64| Moment { time, place, start: point.position, outside };
        let mean = |i: usize, value: &Expression| {
            means[i].unwrap_or_else(|| value.mean([time, time + dt], &moment(time)))
        };
        let vector = |values: &[Expression; 3], factor: f64| {
            Vector::of([0, 1, 2].map(|i| factor * mean(i, &values[i])))
        };
        let of = |force| PointForce { force, ..PointForce::default() };
        match &self.action {
            Action::Force(force) => of(vector(force, point.measure / self.measure)),
            Action::Traction(traction) => of(vector(traction, point.measure)),
            Action::Acceleration(acceleration) => of(vector(acceleration, particle.mass.f64())),
            Action::Pressure(pressure) => {
                let normal = deformed_area(particle, point);
                let pressure = mean(0, pressure);
                of(Vector::of(normal.map(|area| -pressure * area)))
            }
            Action::Temperature(_) => PointForce::default(),
            Action::Support(support) => {
                let mut felt = PointForce::default();
                let start = self.start(point);
                // As places of particles round, so that a body at rest in its place is there.
                let start = Vector::<T, D>::from_fn(|i| T::of(start[i] - point.arm[i]) + T::of(point.arm[i]));
                let place = place_of(particle, point);
                let normal = self.resists_waves().then(|| direction(deformed_area(particle, point)));
                let mut slips = [0.0; 3];
                for i in 0..D {
                    let Some(motion) = &support.motion[i] else { continue };
                    let (displacement, speed, begun) = match motion {
                        SupportMotion::Displacement(displacement) => {
                            let at = |time: f64| displacement.at_moment(&moment(time));
                            let [before, here, after] = [(time - dt).max(0.0), time, time + dt].map(at);
                            let span = time + dt - (time - dt).max(0.0);
                            (at(now), (after - here) / dt, (after - before) / span)
                        }
                        SupportMotion::Velocity(velocity) => {
                            (sums.driven[i], mean(i, velocity), velocity.at(time))
                        }
                    };
                    let k = self.stiffness * point.measure;
                    let away = (place[i] - start[i]).f64() - displacement;
                    slips[i] = velocity[i].f64() - speed;
                    felt.force[i] = T::of(-k * away);
                    felt.pull[i] = felt.force[i];
                    felt.spring[i] = T::of(k);
                    felt.speed[i] = T::of(speed);
                    felt.begun[i] = T::of(begun);
                    felt.inertia[i] = T::of(dt * dt * k);
                }
                // c = c_T I + (c_L - c_T) n (x) n; the inertia is the sum of a row, see the step's `loads.rs`.
                let [along, across] = self.dashpot.map(|dashpot| dashpot * point.measure);
                let n = normal.unwrap_or([0.0; 3]);
                let through = (0..D).map(|i| n[i] * slips[i]).sum::<f64>();
                for i in (0..D).filter(|&i| support.motion[i].is_some()) {
                    let row = (0..D).map(|j| (n[i] * n[j]).abs()).sum::<f64>();
                    felt.force[i] -= T::of(across * slips[i] + (along - across) * through * n[i]);
                    felt.inertia[i] += T::of(dt * (across + (along - across) * row));
                }
                felt
            }
        }
    }

    /// Whether what it prescribes stays as it is: whether nothing of it changes within the step from `time` on, nor
    /// until `end` [s].
    pub fn is_still(&self, time: f64, dt: f64, end: f64) -> bool {
        let place = self.first;
        let at = |value: &Expression, time: f64| {
            value.at_moment(&Moment { time, place, start: place, ..Moment::default() })
        };
        let constant = |value: &Expression| match value {
            Expression::Constant(_) => true,
            Expression::Table(table) => table.end() <= time,
            // Nobody knows what it says later.
            Expression::Outside(_) => false,
            Expression::Formula(_) | Expression::Rate(_) => {
                at(value, time) == at(value, time + dt) && at(value, time) == at(value, end)
            }
        };
        match &self.action {
            Action::Force(values) | Action::Traction(values) | Action::Acceleration(values) => {
                values.iter().all(constant)
            }
            Action::Pressure(value) | Action::Temperature(value) => constant(value),
            Action::Support(support) => support.motion.iter().flatten().all(|motion| match motion {
                SupportMotion::Displacement(displacement) => constant(displacement),
                SupportMotion::Velocity(velocity) => constant(velocity) && at(velocity, time) == 0.0,
            }),
        }
    }

    /// Moves what prescribes a velocity through a step.
    pub fn drive(&self, (time, dt): (f64, f64), sums: &mut LoadSums) {
        let Action::Support(support) = &self.action else { return };
        for (driven, motion) in sums.driven.iter_mut().zip(&support.motion) {
            if let Some(SupportMotion::Velocity(velocity)) = motion {
                *driven += dt * velocity.over_step(time, dt);
            }
        }
    }
}

/// Where a point is now, x_p + F (X_s - X_p) [m].
pub fn place_of<T: Real, const D: usize>(particle: &Particle<T, D>, point: &PartPoint) -> Vector<T, D> {
    particle.position + arm(particle, &point.arm)
}

/// Its direction; zero where it has none.
fn direction(area: [f64; 3]) -> [f64; 3] {
    Vector(area).direction().map_or([0.0; 3], |direction| direction.0)
}

/// J F^-T N dA [m^2]
fn deformed_area<T: Real, const D: usize>(particle: &Particle<T, D>, point: &PartPoint) -> [f64; 3] {
    let (jacobian, inverse) = (particle.deformation.det().f64(), particle.deformation.inverse());
    [0, 1, 2].map(|i| {
        let sum = (0..3).map(|j| inverse.0[j][i].f64() * point.normal[j]).sum::<f64>();
        jacobian * sum * point.measure
    })
}
