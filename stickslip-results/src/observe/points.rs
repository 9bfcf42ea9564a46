//! Points at which the material is sampled, by a straight line through the particles around.

use super::file::OutputError;
use super::linear_fit::{LinearFit, PlaceSums};
use super::memory::Memory;
use super::shared::{Asked, Question, answer};
use crate::door::{ParticleView, View};
use crate::exact::ExactSum;
use crate::scene::{Anchor, Domain, Scene};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Motion and stress of the material at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PointSample {
    /// Where it is [m].
    pub position: [f64; 3],
    /// Its velocity [m/s].
    pub velocity: [f64; 3],
    /// Cauchy stress xx, yy, zz, xy, yz, xz, tension positive [Pa].
    pub stress: [f64; 6],
}

/// A point to sample.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SamplePoint {
    /// Where it is at the start [m].
    pub at: [f64; 3],
    /// Index of the body that it looks at; without it, all that are not rigid.
    pub body: Option<usize>,
    /// What it stays with.
    pub fixed_in: Anchor,
}

/// Points that are sampled together. Each looks at the particles within two cells:
///
/// ```text
/// q = sum_p a_p q_p / sum_p a_p,   a_p = m_p w(r_p) (1 + k . (x_p - x_m))
/// w(r) = (1 - r/R)^4 (1 + 4 r/R),   R = 2 cells        (Wendland's C2)
/// ```
///
/// with r the distance from the point, and k as of [`super::linear_fit`]: exact for what is linear in space up to the
/// surface, where few particles are on one side, and smooth in time; it smears a sharp front over about a cell. Of
/// several bodies around a point that names none, the one that weighs most there counts. A point of space takes the
/// particles that are there now; a point of the material takes those of the first sample, with their weights, for ever.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Points {
    points: Vec<(SamplePoint, TakenParticles)>,
    /// Indices of the bodies that are not rigid.
    bodies: Vec<usize>,
    radius: f64,
    /// Of points that take the particles around them now: whose, and the line through them.
    around: Vec<Option<(usize, LinearFit)>>,
    /// Where images of particles are, if the domain is periodic.
    #[serde(skip)]
    domain: Option<Domain>,
}

/// Which particles a point takes.
#[derive(Clone, Debug, Serialize, Deserialize)]
enum TakenParticles {
    /// Those around it now.
    Around,
    /// These: number and weight, in the order of the numbers. The point lies at their mean position and this beside it
    /// [m].
    These { weights: Vec<(u32, f64)>, beside: [f64; 3] },
}

/// R in cells.
const RADIUS: f64 = 2.0;

impl Points {
    /// Points in a scene. A point of the material that names no body belongs to the nearest.
    pub(super) fn new(scene: &Scene, points: impl IntoIterator<Item = SamplePoint>) -> Self {
        let free = |i: &usize| !scene.bodies[*i].is_rigid();
        let bodies: Vec<usize> = (0..scene.bodies.len()).filter(free).collect();
        let nearest = |at: [f64; 3]| {
            let distance = |i: usize| scene.bodies[i].shape.distance(at, scene.dimension.axes());
            bodies.iter().copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)))
        };
        let points = points.into_iter().map(|mut point| {
            if point.fixed_in == Anchor::Material && point.body.is_none() {
                point.body = nearest(point.at);
            }
            (point, TakenParticles::Around)
        });
        let domain = scene.domain.clone().filter(|domain| domain.periods() != [0.0; 3]);
        let radius = RADIUS * scene.discretization.cell;
        Points { points: points.collect(), bodies, radius, around: Vec::new(), domain }
    }

    /// The material at each point now; `None` where no particle is around.
    /// The first call binds the points of the material.
    pub(super) fn sample(&mut self, view: &dyn View) -> Vec<Option<PointSample>> {
        self.look_around(view);
        let (sums, found) = answer(view, self);
        let samples: Vec<_> = sums.iter().map(WeightedSum::mean).collect();
        for (i, mut weights) in found.into_iter().enumerate() {
            let Some(mean) = samples[i].filter(|_| self.binds(i)) else { continue };
            weights.sort_unstable_by_key(|(number, _)| *number);
            let (point, taken) = &mut self.points[i];
            *taken = TakenParticles::These {
                weights,
                beside: std::array::from_fn(|k| point.at[k] - mean.position[k]),
            };
        }
        let place = |(sample, (point, taken)): (Option<PointSample>, &(SamplePoint, TakenParticles))| {
            let mut sample = sample?;
            sample.position = match taken {
                TakenParticles::Around => point.at,
                TakenParticles::These { beside, .. } => {
                    std::array::from_fn(|k| sample.position[k] + beside[k])
                }
            };
            Some(sample)
        };
        samples.into_iter().zip(&self.points).map(place).collect()
    }

    /// Finds the line through the particles around each point that takes those of now.
    fn look_around(&mut self, view: &dyn View) {
        self.around = vec![None; self.points.len()];
        if !self.points.iter().any(|(_, taken)| matches!(taken, TakenParticles::Around)) {
            return;
        }
        let radius = self.radius;
        let most = |sums: BTreeMap<usize, PlaceSums>| {
            let most = sums.into_iter().reduce(|a, b| if b.1.weight() > a.1.weight() { b } else { a });
            most.map(|(body, sums)| (body, sums.fit(radius)))
        };
        self.around = answer(view, &Surroundings(self)).into_iter().map(most).collect();
    }

    /// Sums over particles at each point, and of points of the material that have none yet their numbers and weights.
    fn sums(&self, view: &dyn View) -> PointSums {
        let mut sums = vec![WeightedSum::default(); self.points.len()];
        let mut found: Vec<Vec<(u32, f64)>> = vec![Vec::new(); self.points.len()];
        for &body in &self.bodies {
            let mut here: Vec<usize> = Vec::new();
            here.extend((0..self.points.len()).filter(|&i| self.points[i].0.body.is_none_or(|b| b == body)));
            if here.is_empty() {
                continue;
            }
            view.visit(body, &mut |particle| {
                for &i in &here {
                    let weight = self.weight(i, (body, particle));
                    if weight != 0.0 {
                        sums[i].add(weight, particle);
                        if self.binds(i) {
                            found[i].push((particle.number, weight));
                        }
                    }
                }
            });
        }
        (sums, found)
    }

    /// How many.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether all bodies that they name are there.
    pub(super) fn fit(&self, bodies: usize) -> bool {
        let named = self.points.iter().filter_map(|(point, _)| point.body);
        named.chain(self.bodies.iter().copied()).all(|body| body < bodies)
    }

    /// Adds one of other points, and says which it is now.
    pub(super) fn add(&mut self, others: &Points, point: usize) -> usize {
        self.points.push(others.points[point].clone());
        self.points.len() - 1
    }

    /// Keeps which particles points take; points that are as they were take them up.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        let mut kept = self.points.clone();
        memory.keep("points", &mut kept)?;
        for (point, taken) in &mut self.points {
            if let Some((_, known)) = kept.iter().find(|(known, _)| known == point) {
                *taken = known.clone();
            }
        }
        Ok(())
    }

    /// Whether a point of the material has no particles yet.
    fn binds(&self, i: usize) -> bool {
        let (point, taken) = &self.points[i];
        point.fixed_in == Anchor::Material && matches!(taken, TakenParticles::Around)
    }

    /// m w of a particle, zero of most, and how far it is from a point [m].
    fn near(&self, i: usize, particle: &ParticleView) -> (f64, [f64; 3]) {
        let at = self.points[i].0.at;
        let place = match &self.domain {
            Some(domain) => domain.image_near(particle.position, at),
            None => particle.position,
        };
        let offset = std::array::from_fn(|k| place[k] - at[k]);
        (particle.mass * wendland(&offset, self.radius), offset)
    }

    /// a_p of a particle of a body, zero of most.
    fn weight(&self, i: usize, (body, particle): (usize, &ParticleView)) -> f64 {
        match &self.points[i] {
            (_, TakenParticles::Around) => match &self.around[i] {
                Some((of, fit)) if *of == body => {
                    let (weight, offset) = self.near(i, particle);
                    if weight > 0.0 { weight * fit.part(offset) } else { 0.0 }
                }
                _ => 0.0,
            },
            (_, TakenParticles::These { weights, .. }) => {
                let (Some(first), Some(last)) = (weights.first(), weights.last()) else { return 0.0 };
                if particle.number < first.0 || particle.number > last.0 {
                    return 0.0;
                }
                let place = weights.binary_search_by_key(&particle.number, |(number, _)| *number);
                place.map_or(0.0, |place| weights[place].1)
            }
        }
    }
}

/// See [`Points::sums`].
type PointSums = (Vec<WeightedSum>, Vec<Vec<(u32, f64)>>);

/// Points as ranks are asked about them.
#[derive(Serialize, Deserialize)]
pub(super) struct PointsQuestion {
    points: Points,
    domain: Option<Domain>,
}

impl Question for Points {
    type Answer = PointSums;

    fn look(&self, view: &dyn View) -> PointSums {
        self.sums(view)
    }

    fn join((mut sums, mut found): PointSums, (others, more): PointSums) -> PointSums {
        sums.iter_mut().zip(&others).for_each(|(sum, other)| sum.merge(other));
        found.iter_mut().zip(more).for_each(|(found, more)| found.extend(more));
        (sums, found)
    }

    fn asked(&self) -> Asked {
        Asked::Points(PointsQuestion { points: self.clone(), domain: self.domain.clone() })
    }
}

/// Asks which particles are around points that take those of now.
#[derive(Serialize)]
pub(super) struct Surroundings<'a>(pub &'a Points);

impl Question for Surroundings<'_> {
    /// Of each point, by body.
    type Answer = Vec<BTreeMap<usize, PlaceSums>>;

    fn look(&self, view: &dyn View) -> Self::Answer {
        let points = self.0;
        let mut sums = vec![BTreeMap::<usize, PlaceSums>::new(); points.points.len()];
        for &body in &points.bodies {
            let takes = |&i: &usize| {
                let (point, taken) = &points.points[i];
                matches!(taken, TakenParticles::Around) && point.body.is_none_or(|b| b == body)
            };
            let here: Vec<usize> = (0..points.points.len()).filter(takes).collect();
            if here.is_empty() {
                continue;
            }
            view.visit(body, &mut |particle| {
                for &i in &here {
                    let (weight, offset) = points.near(i, particle);
                    if weight > 0.0 {
                        sums[i].entry(body).or_default().add(weight, offset);
                    }
                }
            });
        }
        sums
    }

    fn join(mut sums: Self::Answer, others: Self::Answer) -> Self::Answer {
        for (sums, others) in sums.iter_mut().zip(others) {
            others.iter().for_each(|(&body, other)| sums.entry(body).or_default().merge(other));
        }
        sums
    }

    fn asked(&self) -> Asked {
        let Points { domain, .. } = self.0;
        Asked::Surroundings(PointsQuestion { points: self.0.clone(), domain: domain.clone() })
    }
}

impl PointsQuestion {
    /// The points that it is about.
    pub(super) fn points(&self) -> Points {
        Points { domain: self.domain.clone(), ..self.points.clone() }
    }
}

fn wendland([x, y, z]: &[f64; 3], radius: f64) -> f64 {
    let squared = x * x + y * y + z * z;
    if squared >= radius * radius {
        return 0.0;
    }
    let r = squared.sqrt() / radius;
    (1.0 - r).powi(4) * (1.0 + 4.0 * r)
}

/// Weighted sums over particles.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct WeightedSum {
    weight: ExactSum,
    position: [ExactSum; 3],
    velocity: [ExactSum; 3],
    stress: [ExactSum; 6],
}

impl WeightedSum {
    /// Adds a particle.
    pub(super) fn add(&mut self, weight: f64, particle: &ParticleView) {
        self.weight.add(weight);
        let vectors = self.position.iter_mut().zip(particle.position);
        let vectors = vectors.chain(self.velocity.iter_mut().zip(particle.velocity));
        vectors.chain(self.stress.iter_mut().zip(particle.stress)).for_each(|(sum, x)| sum.add(weight * x));
    }

    /// Adds the sums over others.
    fn merge(&mut self, other: &WeightedSum) {
        self.weight.merge(&other.weight);
        ExactSum::merge_each(&mut self.position, &other.position);
        ExactSum::merge_each(&mut self.velocity, &other.velocity);
        ExactSum::merge_each(&mut self.stress, &other.stress);
    }

    /// The mean; `None` of nothing.
    pub(super) fn mean(&self) -> Option<PointSample> {
        let weight = self.weight.value();
        let mean = |sum: &ExactSum| sum.value() / weight;
        (weight > 0.0).then(|| PointSample {
            position: self.position.each_ref().map(mean),
            velocity: self.velocity.each_ref().map(mean),
            stress: self.stress.each_ref().map(mean),
        })
    }
}
