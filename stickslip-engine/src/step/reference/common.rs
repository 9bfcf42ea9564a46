//! Bodies on the common grid as those on grids of their own meet them.
//!
//! A point q of a surface is looked for in the undeformed shape by the particles around it, and what acts there acts on
//! the nodes that move the point:
//!
//! ```text
//! X(q) = sum w_p (X_p + F_p^-1 (q - x_p)) / sum w_p     w_p = V_p S((q - x_p) / (h/2)), S: quadratic spline
//! g = phi(X) / |F^-T N|,  n = F^-T N / |F^-T N|         phi: distance from the undeformed shape, N = grad phi
//! W_i = N_i(q) / sum N_j(q)                             over nodes with mass
//! f_i -= W_i A (p n + tau)                              before velocities are integrated
//! u(q) = sum W_i v_i
//! ```
//! Of bodies that flow, places alone say where the material was, see [`ReferenceMap`]. Particles take the change of
//! the nodes' velocities, so momentum is kept to round-off. Of several ranks all know the particles and nodes near such
//! points, and find the same; each pushes the nodes that it has.

use super::super::among::Among;
use super::super::build::whole;
use super::super::loads::{before_mirrors, mirror};
use super::loads::carrier;
use super::{is_reference, layer_moduli};
use crate::Kernels;
use crate::body::{Body, Particle};
use crate::boundary::Boundary;
use crate::contact::Rules;
use crate::geometry::{MirroredShape, SignedDistance};
use crate::grid::{ActiveBlocks, Lattice, Node, SIDE, locate};
use crate::lanes::Laned;
use crate::scene::{ContactLaw, Scene};
use crate::surroundings::ReferenceMap;
use crate::tensor::{Matrix, Vector};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use stickslip_reference::contact::{Deforming, Obstacle, Touch};

/// How far from a point particles say where the material there was [cells].
const NEAR: f64 = 0.75;

/// How far a point is from a node that moves it, at most [cells].
const MARGIN: f64 = 2.0;

/// Half a side of the box that is a point to every basis [cells].
const POINT: f64 = 1e-3;

/// A body on the common grid that bodies on grids of their own may meet.
pub struct CommonPartner {
    /// Its number among all bodies.
    pub body: usize,
    /// Its undeformed shape with its images.
    whole: MirroredShape,
    /// Whether its material flows, and places alone say where it was.
    flows: bool,
    /// Its cell over the moduli of its longitudinal and its shear wave at rest [m/Pa].
    softness: [f64; 2],
}

impl CommonPartner {
    /// Those of a scene.
    pub fn of_scene<const D: usize>(scene: &Scene, rules: &Rules<impl Laned>) -> Vec<Self> {
        let own: Vec<usize> = (0..scene.bodies.len()).filter(|&body| is_reference(scene, body)).collect();
        let meets = |body: usize| {
            let law = |&other: &usize| rules.rule(rules.number(other, body)).law;
            own.iter().any(|other| law(other) != ContactLaw::None)
        };
        let is_common = |&body: &usize| !is_reference(scene, body) && !scene.bodies[body].is_rigid();
        let all = (0..scene.bodies.len()).filter(is_common).filter(|&body| meets(body));
        let partner = |body: usize| CommonPartner {
            body,
            whole: whole::<D>(scene, body),
            flows: !scene.materials[scene.bodies[body].material].law.trusts_deformation(),
            softness: layer_moduli(scene, body).map(|modulus| scene.discretization.cell / modulus),
        };
        all.map(partner).collect()
    }
}

/// Where nodes are, and which move a point.
pub(super) struct CommonGrid<'a, T: 'static, const D: usize> {
    pub active: &'a ActiveBlocks<D>,
    pub boundary: &'a Boundary,
    pub lattice: &'a Lattice<T, D>,
    pub kernels: &'static Kernels<T, D>,
}

impl<T: 'static, const D: usize> Clone for CommonGrid<'_, T, D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T: 'static, const D: usize> Copy for CommonGrid<'_, T, D> {}

/// What of bodies on the common grid is near surfaces that may touch them, by body, cell and number or by body and
/// node: the same on all ranks.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    particles: Vec<SkinParticle>,
    nodes: Vec<SkinNode>,
}

/// A particle near such a surface.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct SkinParticle {
    body: u32,
    cell: [i32; 3],
    number: u32,
    /// Where it is and where it was undeformed [m].
    places: [[f64; 3]; 2],
    /// F^-1 [-].
    inverse: [[f64; 3]; 3],
    volume: f64,
}

/// A node with mass near such a surface.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct SkinNode {
    body: u32,
    node: [i32; 3],
    velocity: [f64; 3],
}

/// A node that moves a point, the axes along which it is a mirror image, a bit each, and its share.
#[derive(Clone, Copy, Debug)]
struct Share<const D: usize> {
    node: [i32; D],
    mirrored: u32,
    share: f64,
}

impl<T: Laned, const D: usize> CommonGrid<'_, T, D> {
    /// Takes the nodes that move a point, those before mirrors for those behind them.
    fn each_node(&self, place: Vector<f64, D>, take: &mut dyn FnMut(Share<D>)) {
        let at = Vector::from_fn(|k| T::of(place[k]));
        let half_width = T::of(POINT) * self.lattice.cell;
        let point = Particle { half_width, ..carrier(at, Matrix::IDENTITY, T::ZERO) };
        let mut fold = |node: [i32; D], [own, _]: [T; 2]| {
            let (node, mirrored) = before_mirrors(self.boundary, node);
            if own > T::ZERO {
                take(Share { node, mirrored, share: own.f64() });
            }
        };
        (self.kernels.nodes_of)(self.lattice, &point, &[0.0; 3], &mut fold);
    }

    /// The nodes of a body with mass that move a point of it, with shares that sum to one.
    fn shares(&self, skin: &Skin, body: usize, place: Vector<f64, D>) -> Vec<(Share<D>, [f64; 3])> {
        let mut shares = Vec::new();
        self.each_node(place, &mut |share| {
            if let Some(node) = skin.node(body, three(share.node)) {
                shares.push((share, node.velocity));
            }
        });
        let sum: f64 = shares.iter().map(|(share, _)| share.share).sum();
        shares.iter_mut().for_each(|(share, _)| share.share /= sum);
        shares
    }

    /// Adds what the points that touch such bodies do to these to the forces on their nodes that are here.
    pub fn push(
        &self,
        (partners, skin): (&[CommonPartner], &Skin),
        nodes: &mut [Node<T, D>],
        touches: &[Touch<D>],
    ) {
        for touch in touches {
            let body = touch.memory.partner as usize;
            if partners.binary_search_by_key(&body, |partner| partner.body).is_err() {
                continue;
            }
            for (Share { node, mirrored, share }, _) in self.shares(skin, body, touch.at - touch.away) {
                let Some(index) = self.active.node_index(body, node) else { continue };
                let force = mirror(touch.force() * -share, mirrored);
                nodes[index].force += Vector::from_fn(|k| T::of(force[k]));
            }
        }
    }

    /// The cell of a place.
    fn cell(&self, place: [f64; 3]) -> [i32; 3] {
        let (origin, per_cell) = (self.lattice.origin.space(), 1.0 / self.lattice.cell.f64());
        let cell = |k: usize| ((place[k] - origin[k]) * per_cell).floor() as i32;
        [0, 1, 2].map(|k| if k < D { cell(k) } else { 0 })
    }

    /// The cells whose particles may lie near a place, the first and the last.
    fn cells_near(&self, place: [f64; 3]) -> [[i32; 3]; 2] {
        let reach = NEAR * self.lattice.cell.f64();
        [-reach, reach].map(|off| self.cell(place.map(|x| x + off)))
    }

    /// A box around a body's blocks that are here and points that these move; none where there are none.
    fn bounds(&self, body: usize) -> Option<[Vector<f64, D>; 2]> {
        let corner = |steps: i32| {
            let at = move |block: [i32; D]| -> Vector<f64, D> {
                let corner = self.lattice.position(std::array::from_fn(|k| (block[k] + steps) * SIDE));
                Vector::from_fn(|k| corner[k].f64())
            };
            self.active.slots_of_body(body).map(move |slot| at(self.active.slots[slot].1))
        };
        let low = corner(0).reduce(|a, b| Vector::from_fn(|k| a[k].min(b[k])))?;
        let high = corner(1).reduce(|a, b| Vector::from_fn(|k| a[k].max(b[k])))?;
        let margin = Vector([MARGIN * self.lattice.cell.f64(); D]);
        Some([low - margin, high + margin])
    }

    /// The particles of a body in a cell.
    fn particles_in(
        &self,
        (number, body): (usize, &Body<T, D>),
        cell: [i32; 3],
        all: &mut Vec<SkinParticle>,
    ) {
        // The first node that a particle reaches follows its place, and no box of one is larger than two cells.
        let home = |steps: i32, half: T| {
            let corner = self.lattice.position(std::array::from_fn(|k| cell[k] + steps));
            (self.kernels.home)(self.lattice, (corner, half))
        };
        let [low, high] = [home(0, self.lattice.cell), home(1, T::ZERO)];
        each_cell([three(low), three(high)], &mut |at| {
            for &index in self.active.particles_in(number, std::array::from_fn(|k| at[k])) {
                let particle = body.particles.get(index as usize);
                let place = particle.position.space();
                if self.cell(place) != cell {
                    continue;
                }
                let start = body.particles.start(index as usize).space();
                let f = Matrix::from_fn(|i, j| particle.deformation.0[i][j].f64());
                all.push(SkinParticle {
                    body: number as u32,
                    cell,
                    number: particle.number,
                    places: [place, start],
                    inverse: f.inverse().0,
                    volume: particle.volume.f64(),
                });
            }
        });
    }
}

impl Skin {
    /// That of a step, by the places of surfaces and the velocities that nodes have.
    pub(super) fn new<T: Laned, const D: usize>(
        grid: CommonGrid<'_, T, D>,
        (partners, bodies, nodes): (&[CommonPartner], &[Body<T, D>], &[Node<T, D>]),
        (surfaces, meet): (&[Deforming<'_, D>], &dyn Fn(usize, usize) -> bool),
        among: Option<&Among<T>>,
    ) -> Self {
        let mut skin = Skin::default();
        for &CommonPartner { body, .. } in partners {
            let Some(bounds) = grid.bounds(body) else { continue };
            let (mut cells, mut near) = (BTreeSet::new(), BTreeSet::new());
            for other in surfaces.iter().filter(|other| meet(other.body, body)) {
                for place in surface_in(other, &bounds) {
                    let place = place.space();
                    each_cell(grid.cells_near(place), &mut |cell| {
                        cells.insert(cell);
                    });
                    grid.each_node(Vector::of(place), &mut |share| {
                        near.insert(three(share.node));
                    });
                }
            }
            cells
                .iter()
                .for_each(|&cell| grid.particles_in((body, &bodies[body]), cell, &mut skin.particles));
            skin.nodes.extend(near.iter().map(|&node| SkinNode {
                body: body as u32,
                node,
                velocity: [0.0; 3],
            }));
        }
        skin.nodes.retain_mut(|node| node.take(grid, nodes));
        if let Some(among) = among {
            skin.particles = among.gathered(&skin.particles).concat();
            skin.nodes = among.gathered(&skin.nodes).concat();
        }
        skin.particles.sort_unstable_by_key(|particle| (particle.body, particle.cell, particle.number));
        skin.nodes.sort_unstable_by_key(|node| (node.body, node.node));
        skin
    }

    /// Takes the velocities that nodes have now.
    pub(super) fn follow<T: Laned, const D: usize>(
        &mut self,
        grid: CommonGrid<'_, T, D>,
        nodes: &[Node<T, D>],
        among: Option<&Among<T>>,
    ) {
        self.nodes.retain_mut(|node| node.take(grid, nodes));
        if let Some(among) = among {
            self.nodes = among.gathered(&self.nodes).concat();
            self.nodes.sort_unstable_by_key(|node| (node.body, node.node));
        }
    }

    fn node(&self, body: usize, node: [i32; 3]) -> Option<&SkinNode> {
        let place =
            self.nodes.binary_search_by_key(&(body as u32, node), |node| (node.body, node.node)).ok()?;
        Some(&self.nodes[place])
    }

    /// The particles of a body in a cell.
    fn particles_in(&self, body: usize, cell: [i32; 3]) -> &[SkinParticle] {
        let key = (body as u32, cell);
        let rest = &self.particles[self.particles.partition_point(|it| (it.body, it.cell) < key)..];
        &rest[..rest.partition_point(|it| (it.body, it.cell) == key)]
    }

    /// A box around the particles of a body, and what they see.
    fn bounds(&self, body: usize, reach: f64) -> [[f64; 3]; 2] {
        let first = self.particles.partition_point(|it| (it.body as usize) < body);
        let own = self.particles[first..].iter().take_while(|it| it.body as usize == body);
        let none = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
        own.fold(none, |[low, high], it| {
            let at = it.places[0];
            [[0, 1, 2].map(|k| low[k].min(at[k] - reach)), [0, 1, 2].map(|k| high[k].max(at[k] + reach))]
        })
    }
}

impl SkinNode {
    /// Takes the velocity that it has now: whether it has mass and this rank books it.
    fn take<T: Laned, const D: usize>(&mut self, grid: CommonGrid<'_, T, D>, nodes: &[Node<T, D>]) -> bool {
        let node: [i32; D] = std::array::from_fn(|k| self.node[k]);
        let index = grid.active.node_index(self.body as usize, node);
        let Some(index) = index.filter(|_| grid.active.books(locate(node).0)) else { return false };
        self.velocity = nodes[index].velocity.space();
        nodes[index].mass > T::ZERO
    }
}

/// Points of a surface in a box, where they are [m].
fn surface_in<'a, const D: usize>(
    body: &'a Deforming<'_, D>,
    [low, high]: &'a [Vector<f64, D>; 2],
) -> impl Iterator<Item = Vector<f64, D>> + 'a {
    let is_in = |at: &Vector<f64, D>| (0..D).all(|k| low[k] <= at[k] && at[k] <= high[k]);
    // No point lies beyond the nodes.
    let nodes = &body.interior.places;
    let overlaps =
        (0..D).all(|k| nodes.iter().any(|at| at[k] >= low[k]) && nodes.iter().any(|at| at[k] <= high[k]));
    let points = if overlaps { body.surface } else { &[] };
    points.iter().map(|point| body.interior.at(&point.weights, nodes)).filter(move |at| is_in(at))
}

/// Takes all cells from the first to the last.
fn each_cell([low, high]: [[i32; 3]; 2], take: &mut dyn FnMut([i32; 3])) {
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                take([x, y, z]);
            }
        }
    }
}

fn three<const D: usize>(node: [i32; D]) -> [i32; 3] {
    [0, 1, 2].map(|k| if k < D { node[k] } else { 0 })
}

/// A body on the common grid, by what of it is near.
pub(super) struct CommonBody<'a, T: 'static, const D: usize> {
    partner: &'a CommonPartner,
    grid: CommonGrid<'a, T, D>,
    skin: &'a Skin,
    bounds: [[f64; 3]; 2],
}

impl<'a, T: Laned, const D: usize> CommonBody<'a, T, D> {
    pub fn new(partner: &'a CommonPartner, (grid, skin): (CommonGrid<'a, T, D>, &'a Skin)) -> Self {
        let bounds = skin.bounds(partner.body, grid.lattice.cell.f64());
        CommonBody { partner, grid, skin, bounds }
    }

    /// Where the material at a place was, by the particles around it; none where there are none.
    fn map(&self, place: [f64; 3]) -> Option<ReferenceMap<f64, D>> {
        let reach = NEAR * self.grid.lattice.cell.f64();
        let flows = self.partner.flows;
        let (mut sum, mut start, mut center) = (0.0, Vector::<f64, D>::ZERO, Vector::<f64, D>::ZERO);
        let mut inverse = Matrix::<f64>::ZERO;
        each_cell(self.grid.cells_near(place), &mut |cell| {
            for particle in self.skin.particles_in(self.partner.body, cell) {
                let arm = Vector::<f64, D>::from_fn(|k| place[k] - particle.places[0][k]);
                let weight = (0..D).fold(particle.volume, |weight, k| weight * spline(1.5 * arm[k] / reach));
                let f = &particle.inverse;
                let carried = |i: usize| (0..D).map(|j| f[i][j] * arm[j]).sum::<f64>();
                start += Vector::from_fn(|i| particle.places[1][i] + if flows { 0.0 } else { carried(i) })
                    * weight;
                center -= arm * weight;
                inverse = Matrix::from_fn(|i, j| inverse.0[i][j] + f[i][j] * weight);
                sum += weight;
            }
        });
        if sum <= 0.0 {
            return None;
        }
        let share = 1.0 / sum;
        let inverse = Matrix::from_fn(|i, j| if i < D && j < D { inverse.0[i][j] * share } else { 0.0 });
        let (mut start, center) = (start * share, center * share);
        if flows {
            start -= Vector::from_fn(|i| (0..D).map(|j| inverse.0[i][j] * center[j]).sum());
        }
        Some(ReferenceMap { place: start, inverse, center })
    }
}

/// The quadratic spline, of a distance in its own cells.
fn spline(r: f64) -> f64 {
    let r = r.abs();
    if r < 0.5 {
        0.75 - r * r
    } else if r < 1.5 {
        0.5 * (1.5 - r) * (1.5 - r)
    } else {
        0.0
    }
}

impl<T: Laned, const D: usize> Obstacle for CommonBody<'_, T, D> {
    fn body(&self) -> usize {
        self.partner.body
    }

    fn level(&self, place: [f64; 3]) -> SignedDistance {
        let Some(map) = self.map(place) else {
            return SignedDistance { distance: f64::NAN, gradient: [0.0; 3] };
        };
        let offset = map.offset(Vector::ZERO, &self.partner.whole);
        SignedDistance { distance: offset.distance, gradient: offset.normal.space() }
    }

    fn velocity(&self, place: [f64; 3]) -> [f64; 3] {
        let shares = self.grid.shares(self.skin, self.partner.body, Vector::of(place));
        let own = |(Share { mirrored, share, .. }, velocity): &(Share<D>, [f64; 3])| {
            mirror(Vector::<f64, D>::of(*velocity), *mirrored) * *share
        };
        shares.iter().map(own).sum::<Vector<f64, D>>().space()
    }

    fn bounds(&self) -> [[f64; 3]; 2] {
        self.bounds
    }

    fn has_energy(&self) -> bool {
        true
    }

    fn softness(&self) -> [f64; 2] {
        self.partner.softness
    }

    fn is_tracked(&self) -> bool {
        false
    }
}
