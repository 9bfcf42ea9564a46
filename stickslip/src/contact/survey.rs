//! Where bodies meet, and what the particles there say of their surfaces.

use super::{Pair, Rules, Surface};
use crate::basis::Basis;
use crate::body::{Body, Particle};
use crate::boundary::Boundary;
use crate::grid::{Cover, Field, Lattice, Meeting, node_at, nodes_per_block};
use crate::scene::{ContactLaw, Face};
use crate::tensor::{Matrix, Real, Symmetric, Vector};
use crate::transfer::{Stencil, offsets};
use rayon::prelude::*;
use std::ops::Range;

/// A node that two or more bodies share.
#[derive(Clone, Debug)]
pub struct Site<const D: usize> {
    /// The node.
    pub node: [i32; D],
    /// Its bodies, in [`Survey::sides`].
    pub sides: Range<usize>,
    /// Its pairs, in [`Survey::encounters`].
    pub encounters: Range<usize>,
}

/// One body's share of a site.
#[derive(Clone, Copy, Debug)]
pub struct Side<T, const D: usize> {
    /// Index of the body.
    pub body: usize,
    /// Its node in the field.
    pub index: usize,
    /// Mass there [kg].
    pub mass: T,
    /// Its surface there.
    pub surface: Surface<T, D>,
    volume_gradient: Vector<T, D>,
}

/// Two sides of a site.
#[derive(Clone, Copy, Debug)]
pub struct Encounter<T, const D: usize> {
    /// The two sides, in [`Survey::sides`].
    pub sides: [usize; 2],
    normal: Option<Vector<T, D>>,
    gap: T,
}

/// All sites of a step.
#[derive(Clone, Debug)]
pub struct Survey<T, const D: usize> {
    /// Nodes that two or more bodies share.
    pub sites: Vec<Site<D>>,
    /// Bodies at the sites.
    pub sides: Vec<Side<T, D>>,
    /// Pairs at the sites.
    pub encounters: Vec<Encounter<T, D>>,
}

impl<T, const D: usize> Default for Survey<T, D> {
    fn default() -> Self {
        Survey { sites: Vec::new(), sides: Vec::new(), encounters: Vec::new() }
    }
}

/// Mass below this fraction of a full cell's does not make a node shared.
const TRACE: f64 = 1e-10;

/// What a survey looks at.
pub struct Near<'a, T, const D: usize> {
    /// The blocks.
    pub cover: &'a Cover<D>,
    /// The bodies.
    pub bodies: &'a [Body<T, D>],
    /// The field, scattered.
    pub field: &'a Field<T, D>,
    /// Where the nodes are.
    pub lattice: Lattice<T, D>,
    /// The walls.
    pub boundary: &'a Boundary,
    /// Which law holds for which pair.
    pub rules: &'a Rules<T>,
}

/// A node or one of its mirror images.
struct Image<T, const D: usize> {
    node: [i32; D],
    sign: [T; D],
}

impl<T: Real, const D: usize> Near<'_, T, D> {
    /// Surveys every node that two or more bodies share.
    pub fn survey<B: Basis<T>>(&self) -> Survey<T, D> {
        let parts: Vec<Survey<T, D>> = (self.cover.meetings.par_chunks(8))
            .map(|meetings| {
                let mut part = Survey::default();
                meetings.iter().for_each(|meeting| self.survey_block::<B>(meeting, &mut part));
                part
            })
            .collect();
        let mut whole = Survey::default();
        for part in parts {
            let (sides, encounters) = (whole.sides.len(), whole.encounters.len());
            whole.sides.extend(part.sides);
            whole.encounters.extend(
                part.encounters.into_iter().map(|e| Encounter { sides: e.sides.map(|s| s + sides), ..e }),
            );
            whole.sites.extend(part.sites.into_iter().map(|site| Site {
                node: site.node,
                sides: site.sides.start + sides..site.sides.end + sides,
                encounters: site.encounters.start + encounters..site.encounters.end + encounters,
            }));
        }
        whole
    }

    fn survey_block<B: Basis<T>>(&self, meeting: &Meeting<D>, survey: &mut Survey<T, D>) {
        let n = nodes_per_block(D);
        let cell_volume = (0..D).fold(T::ONE, |v, _| v * self.lattice.cell);
        for local in 0..n {
            let present = |&&slot: &&u32| {
                let body = self.cover.slots[slot as usize].0 as usize;
                self.field.nodes[slot as usize * n + local].mass
                    > T::of(TRACE) * cell_volume * self.bodies[body].density
            };
            let slots = self.cover.slots_of(meeting);
            if slots.iter().filter(present).count() < 2 {
                continue;
            }
            let node = node_at(meeting.block, local);
            let governed = self.boundary.walls.iter().any(|wall| match wall.face {
                Face::Fixed => wall.depth(node) <= 0,
                _ => wall.depth(node) < 0,
            });
            if governed {
                continue;
            }
            let first = survey.sides.len();
            for &slot in slots.iter().filter(present) {
                survey.sides.push(self.side::<B>(node, slot as usize * n + local));
            }
            let (last, start) = (survey.sides.len(), survey.encounters.len());
            for a in first..last {
                for b in a + 1..last {
                    let encounter = self.encounter::<B>(node, [a, b], &survey.sides);
                    survey.encounters.push(encounter);
                }
            }
            survey.sites.push(Site { node, sides: first..last, encounters: start..survey.encounters.len() });
        }
    }

    fn side<B: Basis<T>>(&self, node: [i32; D], index: usize) -> Side<T, D> {
        let body = self.cover.slots[index / nodes_per_block(D)].0 as usize;
        let mut volume = T::ZERO;
        let (mut mass_gradient, mut volume_gradient) = (Vector::ZERO, Vector::ZERO);
        let mut stress = Symmetric::ZERO;
        self.each_particle::<B>(body, node, |particle, weight, gradient, image| {
            let v = particle.volume * particle.deformation.det();
            // The node sees a particle move away as the particle sees the node move: grad at the node = -grad S(x_p).
            let gradient = Vector::from_fn(|i| -gradient[i] * image.sign[i]);
            volume += v * weight;
            mass_gradient += gradient * particle.mass;
            volume_gradient += gradient * v;
            stress += mirrored(&particle.stress, image.sign) * (v * weight);
        });
        let mass = self.field.nodes[index].mass;
        let owner = &self.bodies[body];
        let surface = Surface {
            inverse_mass: if owner.rigid { T::ZERO } else { T::ONE / mass },
            normal: (-mass_gradient).direction(),
            stress: stress * (T::ONE / volume),
            volume,
            modulus: owner.material.law().wave_modulus(&Matrix::IDENTITY, T::ONE),
        };
        Side { body, index, mass, surface, volume_gradient }
    }

    fn encounter<B: Basis<T>>(
        &self,
        node: [i32; D],
        sides: [usize; 2],
        all: &[Side<T, D>],
    ) -> Encounter<T, D> {
        let [a, b] = sides.map(|side| &all[side]);
        let p: i32 = std::env::var("NORMP").map_or(0, |x| x.parse().unwrap());
        let w = |g: Vector<T, D>| (0..p).fold(g, |v, _| v * g.norm());
        let normal = (w(b.volume_gradient) - w(a.volume_gradient)).direction();
        let law = self.rules.between(a.body, b.body).law;
        let gap = match (law, normal) {
            (ContactLaw::Gap, Some(n)) => {
                -self.extent::<B>(a.body, node, n) - self.extent::<B>(b.body, node, -n)
            }
            _ => T::ZERO,
        };
        Encounter { sides, normal, gap }
    }

    /// How far the surfaces of a body's particles near a node reach along a direction, from the node [m].
    fn extent<B: Basis<T>>(&self, body: usize, node: [i32; D], direction: Vector<T, D>) -> T {
        let mut extent = T::of(f64::MIN);
        self.each_particle::<B>(body, node, |particle, _, _, image| {
            let n = Vector::from_fn(|i| direction[i] * image.sign[i]);
            let center = (particle.position - self.lattice.position(image.node)).dot(n);
            let _ = support(&particle.deformation, n);
            let sup = match SUP.get() { Some(&x) => T::of(x), None => support(&particle.deformation, n) };
            extent = extent.max(center + particle.half_width * sup);
        });
        extent
    }

    /// Calls `f(particle, weight, gradient, image)` for every particle of a body that reaches a node or an image of it.
    fn each_particle<B: Basis<T>>(
        &self,
        body: usize,
        node: [i32; D],
        mut f: impl FnMut(&Particle<T, D>, T, Vector<T, D>, &Image<T, D>),
    ) {
        let mut images = vec![Image { node, sign: [T::ONE; D] }];
        for wall in self.boundary.walls.iter().filter(|wall| wall.face == Face::Symmetry) {
            if wall.depth(node) < B::WIDTH as i32 {
                for i in 0..images.len() {
                    let Image { node, mut sign } = images[i];
                    sign[wall.axis] = -sign[wall.axis];
                    images.push(Image { node: wall.image(node), sign });
                }
            }
        }
        for image in &images {
            for offset in offsets::<D>(B::WIDTH) {
                let cell = std::array::from_fn(|i| image.node[i] - offset[i] as i32);
                for &index in self.cover.particles_in(body, cell) {
                    let particle = &self.bodies[body].particles[index as usize];
                    let (weight, gradient) = Stencil::new::<B>(&self.lattice, particle).at(offset);
                    if weight > T::ZERO {
                        f(particle, weight, gradient, image);
                    }
                }
            }
        }
    }
}

/// How far a cube of half-width one, deformed by F, reaches along a direction: sum_k |n . F e_k| [-].
fn support<T: Real, const D: usize>(deformation: &Matrix<T>, n: Vector<T, D>) -> T {
    (0..D).map(|k| (0..D).map(|i| n[i] * deformation.0[i][k]).sum::<T>().abs()).sum()
}

/// A stress seen in the mirrors that turn the axes with sign -1.
fn mirrored<T: Real, const D: usize>(stress: &Symmetric<T>, sign: [T; D]) -> Symmetric<T> {
    let sign: [T; 3] = std::array::from_fn(|i| if i < D { sign[i] } else { T::ONE });
    let s = stress.0;
    let [x, y, z] = sign;
    Symmetric([s[0], s[1], s[2], s[3] * x * y, s[4] * y * z, s[5] * x * z])
}

impl<T: Real, const D: usize> Survey<T, D> {
    /// The pair of an encounter, with the largest change of velocity for a cell and step: `strain_rate` is h/dt [m/s].
    pub fn pair<'a>(
        &'a self,
        encounter: &Encounter<T, D>,
        rules: &'a Rules<T>,
        strain_rate: T,
    ) -> Pair<'a, T, D> {
        let [a, b] = encounter.sides.map(|side| &self.sides[side]);
        let rule = rules.between(a.body, b.body);
        Pair {
            rule,
            surfaces: [&a.surface, &b.surface],
            normal: encounter.normal,
            gap: encounter.gap,
            limit: rule.max_strain * strain_rate,
        }
    }
}

/// tmp
pub static SUP: std::sync::OnceLock<f64> = std::sync::OnceLock::new();
