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
    /// Its surface there.
    pub surface: Surface<T, D>,
    pub(super) volume_gradient: Vector<T, D>,
}

/// Two sides of a site.
#[derive(Clone, Copy, Debug)]
pub struct Encounter<T, const D: usize> {
    /// The two sides, in [`Survey::sides`].
    pub sides: [usize; 2],
    /// Number of the pair's rule.
    pub(super) rule: usize,
    pub(super) normal: Option<Vector<T, D>>,
    pub(super) gap: T,
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

/// Mass below this fraction of a full cell's does not make a node shared: that of a particle which reaches into the node's
/// surroundings by round-off of a cell. More would leave parts of a glued body that stick out by less to themselves.
fn trace<T: Real>() -> T {
    T::EPSILON * T::EPSILON
}

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

/// A node or one of its mirror images, with the signs that turn vectors between the two.
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

    /// h^D [m^3]
    fn cell_volume(&self) -> T {
        (0..D).fold(T::ONE, |v, _| v * self.lattice.cell)
    }

    fn survey_block<B: Basis<T>>(&self, meeting: &Meeting<D>, survey: &mut Survey<T, D>) {
        let n = nodes_per_block(D);
        let cell_volume = self.cell_volume();
        for local in 0..n {
            let present = |&&slot: &&u32| {
                let body = self.cover.slots[slot as usize].0 as usize;
                self.field.nodes[slot as usize * n + local].mass
                    > trace::<T>() * cell_volume * self.bodies[body].density
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
                    let rule = self.rules.number(survey.sides[a].body, survey.sides[b].body);
                    let rigid = [a, b].map(|side| self.bodies[survey.sides[side].body].rigid);
                    if self.rules.rule(rule).law == ContactLaw::None || rigid == [true; 2] {
                        continue;
                    }
                    let gap = self.gap(&survey.sides[first..last], [a, b].map(|side| side - first));
                    let gradients = [a, b].map(|side| survey.sides[side].volume_gradient);
                    let normal = (gradients[1] - gradients[0]).direction();
                    survey.encounters.push(Encounter { sides: [a, b], rule, normal, gap });
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
            let v = particle.room();
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
            modulus: owner.wave_modulus(&Matrix::IDENTITY, T::ONE),
        };
        Side { body, index, surface, volume_gradient }
    }

    /// Distance between the surfaces at a node, from the room that the bodies leave around it [cells].
    ///
    /// ```text
    /// gap / h = 1 - sum_a V_a / h^D,   V_a = sum_p V_p S_i(x_p)
    /// ```
    /// Where material fills space without a gap, the volumes interpolated to a node are a whole cell; a thin gap through the node
    /// takes its width times h^(D-1) from that. Overlap is negative. Needs no normal, and stairs of the particles' lattice
    /// average out. All bodies that touch either of the two count. A surface of radius R seems h^2/(6R) further away than its nearest point.
    fn gap(&self, sides: &[Side<T, D>], pair: [usize; 2]) -> T {
        let touches = |a: &Side<T, D>, b: &Side<T, D>| {
            self.rules.rule(self.rules.number(a.body, b.body)).law != ContactLaw::None
        };
        let counts = |(i, side): &(usize, &Side<T, D>)| {
            pair.contains(i) || pair.iter().any(|&of_pair| touches(side, &sides[of_pair]))
        };
        let volumes = sides.iter().enumerate().filter(counts).map(|(_, side)| side.surface.volume);
        T::ONE - volumes.sum::<T>() / self.cell_volume()
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
                    let (weight, gradient) = Stencil::<T, D, B>::new(&self.lattice, particle).at(offset);
                    if weight > T::ZERO {
                        f(particle, weight, gradient, image);
                    }
                }
            }
        }
    }
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
        let rule = rules.rule(encounter.rule);
        Pair {
            rule,
            surfaces: [&a.surface, &b.surface],
            normal: encounter.normal,
            gap: encounter.gap,
            limit: rule.max_strain * strain_rate,
        }
    }
}
