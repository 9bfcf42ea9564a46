//! What contact did to a pair of bodies at the nodes of a block, in one use.

use super::Impulse;
use super::spread::Spread;
use crate::boundary::Boundary;
use crate::grid::{Lattice, locate, node_at};
use crate::tensor::{Real, Vector, cross};
use serde::{Deserialize, Serialize};

/// Surfaces closer than this are part of the area over which bodies touch, pushing in this step or not:
/// single nodes push by turns [cells].
const CLOSE: f64 = 0.01;

/// Sums over the nodes of a block. Whoever has the block adds them in one order, and pairs add up their blocks in the
/// order of these: so the sums of a pair do not depend on who has which block.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BlockSums {
    /// Indices of the bodies.
    pub bodies: [usize; 2],
    /// The block; in the plane its third place is 0.
    pub block: [i32; 3],
    /// On the second body [N s].
    pub impulse: [f64; 3],
    /// The same across the normal [N s].
    pub tangential: [f64; 3],
    /// Magnitudes of the nodes' impulses with their places [N s m].
    pub moment: [f64; 3],
    /// Of the impulse, about the origin [N m s].
    pub turn: [f64; 3],
    /// Along the normals [N s].
    pub normal: f64,
    /// Magnitudes of the nodes' impulses [N s].
    pub magnitude: f64,
    /// Work that friction took from the bodies [J].
    pub friction: f64,
    /// Work that bonds took where they gave way [J].
    pub adhesion: f64,
    /// Work that prescribed motion did on the others [J].
    pub work: f64,
    /// Shares of the area and where they lie.
    pub spread: Spread,
    /// Area times gap [m^3].
    pub gap: f64,
    /// Area times slip [m^3].
    pub slip: f64,
    /// Nodes that push.
    pub nodes: u64,
    /// Those of them whose impulse was reduced to the rule's largest strain.
    pub reduced: u64,
    /// Mirrors that the contact goes through, a bit each.
    pub mirrors: u32,
}

impl BlockSums {
    /// Whether the surfaces have parted, and it is what friction took last.
    pub fn is_of_parted(&self) -> bool {
        self.nodes == 0 && self.spread.area == 0.0
    }

    /// Lists the sums of impulses that follow one another block by block, ordered by pair and block; `works` tells what
    /// friction and bonds took by each [J].
    pub fn list<'a, T: Real, const D: usize>(
        all: &mut Vec<BlockSums>,
        impulses: impl Iterator<Item = &'a Impulse<T, D>>,
        (lattice, boundary): (&Lattice<T, D>, &Boundary),
        works: impl Fn(&Impulse<T, D>) -> [f64; 2],
    ) {
        all.clear();
        // Where those of the block at hand begin.
        let (mut first, mut last) = (0, None);
        for impulse in impulses {
            let pushes = impulse.change.pushes();
            if !pushes && impulse.gap > T::of(CLOSE) {
                continue;
            }
            let (block, _) = locate(impulse.node);
            if last != Some(block) {
                (first, last) = (all.len(), Some(block));
            }
            let here = all[first..].iter().rposition(|sums| sums.bodies == impulse.bodies);
            let place = here.map_or(all.len(), |here| first + here);
            if place == all.len() {
                let block = std::array::from_fn(|i| if i < D { block[i] } else { 0 });
                all.push(BlockSums { bodies: impulse.bodies, block, ..BlockSums::default() });
            }
            all[place].add(impulse, (lattice, boundary), works(impulse));
        }
        all.sort_unstable_by_key(BlockSums::rank);
    }

    /// Their order: by pair and block.
    pub fn rank(&self) -> ([usize; 2], [i32; 3]) {
        (self.bodies, self.block)
    }

    fn add<T: Real, const D: usize>(
        &mut self,
        impulse: &Impulse<T, D>,
        (lattice, boundary): (&Lattice<T, D>, &Boundary),
        [friction, adhesion]: [f64; 2],
    ) {
        self.friction += friction;
        self.adhesion += adhesion;
        // A node on a mirror sees the whole of the surface around it, and half of that is the image's.
        let mirrors = boundary.mirrors_through(impulse.node);
        let area = impulse.area.f64() / f64::from(1_u32 << mirrors.count_ones());
        let place = lattice.position(impulse.node).space();
        self.mirrors |= mirrors;
        self.spread.add(area, place);
        self.gap += area * (impulse.gap * lattice.cell).f64();
        self.slip += area * impulse.slip.f64();
        if !impulse.change.pushes() {
            return;
        }
        self.nodes += 1;
        self.reduced += u64::from(impulse.change.scale < T::ONE);
        let [on_a, on_b] = impulse.change.impulse.map(|j| j.space());
        let tangential = impulse.change.tangential.space();
        let magnitude = impulse.change.impulse[0].norm().f64().max(impulse.change.impulse[1].norm().f64());
        self.magnitude += magnitude;
        // The paper's own normals give impulses that are not quite opposite; the force is their mean.
        let on_second = std::array::from_fn(|i| 0.5 * (on_b[i] - on_a[i]));
        let turn = cross(place, on_second);
        for i in 0..3 {
            self.turn[i] += turn[i];
            self.tangential[i] += tangential[i];
            self.impulse[i] += on_second[i];
            self.moment[i] += magnitude * place[i];
        }
        self.normal -= impulse.change.normal.f64();
        self.work += impulse.work.f64();
    }

    /// The place of the block's first node in the image of the grid that is nearest to a place [m], and the same sums
    /// there.
    pub fn near<T: Real, const D: usize>(
        &self,
        lattice: &Lattice<T, D>,
        place: Option<[f64; 3]>,
    ) -> (BlockSums, [f64; 3]) {
        let node = node_at::<D>(std::array::from_fn(|i| self.block[i]), 0);
        let here = lattice.position(node).space();
        let there = place.map_or(here, |place| lattice.position_near(node, place));
        let way: [f64; 3] = std::array::from_fn(|i| there[i] - here[i]);
        if way == [0.0; 3] {
            return (*self, there);
        }
        let (moment, turn) = (Vector(self.moment) + Vector(way) * self.magnitude, cross(way, self.impulse));
        let moved = BlockSums {
            moment: moment.0,
            turn: (Vector(self.turn) + Vector(turn)).0,
            spread: self.spread.moved(way),
            ..*self
        };
        (moved, there)
    }
}
