//! Particles that were neighbours before anything moved: some of each body, chosen once.

use crate::door::{TracedParticle, View};
use crate::observe::{Memory, OutputError};
use crate::scene::Scene;
use std::collections::{HashMap, HashSet};

/// Neighbours of a body at its start.
#[derive(Default)]
pub(super) struct Neighbours {
    /// Where the chosen particles were [m].
    pub start: Vec<[f64; 3]>,
    /// Pairs of them, by their place in `start`.
    pub pairs: Vec<[u32; 2]>,
    /// Their numbers.
    numbers: Vec<u32>,
    /// Whether some of them have left the domain.
    lost: bool,
    /// Place in `start` of each particle of the body, by its number.
    place: Vec<u32>,
}

/// Particles in all bodies that deform whose neighbours are chosen; in a body at least [`FEWEST`] of them.
const MOST: usize = 500;
const FEWEST: usize = 24;
/// Neighbours are so near, in distances of particles: on a lattice, those across edges and faces of a particle's box.
const NEAR: f64 = 1.5;
/// Not chosen.
const NONE: u32 = u32::MAX;

/// Neighbours in each body; none in a rigid one.
pub(super) fn of_bodies(scene: &Scene, view: &dyn View) -> Vec<Neighbours> {
    // Rigid ones do not count: without bounds they have others all the time.
    let of_body = |i: usize| view.column(i, "start").map_or(0, |start| start.len());
    let all = (0..scene.bodies.len()).filter(|&i| !scene.bodies[i].is_rigid()).map(of_body).sum();
    (scene.bodies.iter().enumerate())
        .map(|(i, body)| if body.is_rigid() { Neighbours::default() } else { Neighbours::new(view, i, all) })
        .collect()
}

impl Neighbours {
    fn new(view: &dyn View, body: usize, all: usize) -> Self {
        let Ok(column) = view.column(body, "start") else { return Neighbours::default() };
        let mut numbers = column.numbers().to_vec();
        numbers.sort_unstable();
        let most = numbers.last().map_or(0, |&last| last as usize + 1);
        let mut start = vec![[0.0; 3]; most];
        column.rows::<3>().for_each(|(number, x)| start[number as usize] = x);
        let chosen = chosen(numbers.len(), (MOST * numbers.len() / all.max(1)).max(FEWEST));
        let chosen: Vec<u32> = chosen.into_iter().map(|rank| numbers[rank as usize]).collect();
        let mut seeds = vec![false; most];
        chosen.iter().for_each(|&number| seeds[number as usize] = true);
        let traced = view.trace(body, &chosen);
        let widest = traced.iter().map(|particle| particle.half_width).fold(0.0, f64::max);
        if widest == 0.0 {
            return Neighbours::default();
        }

        // All particles by cells as wide as the farthest neighbour, as far as a chosen one is near.
        let side = 2.0 * NEAR * widest;
        let cell = |x: [f64; 3]| x.map(|x| (x / side).floor() as i64);
        let around = |[i, j, k]: [i64; 3]| {
            let near = move |d: i64| [i + d % 3 - 1, j + d / 3 % 3 - 1, k + d / 9 - 1];
            (0..27).map(near)
        };
        let near: HashSet<[i64; 3]> = chosen.iter().flat_map(|&n| around(cell(start[n as usize]))).collect();
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for &number in &numbers {
            let x = start[number as usize];
            if near.contains(&cell(x)) {
                cells.entry(cell(x)).or_default().push(number);
            }
        }

        let mut half_width = vec![0.0; start.len()];
        traced.iter().for_each(|particle| half_width[particle.number as usize] = particle.half_width);
        let mut neighbours = Neighbours { place: vec![NONE; start.len()], ..Neighbours::default() };
        for &a in &chosen {
            let reach = 2.0 * NEAR * half_width[a as usize];
            for &b in around(cell(start[a as usize])).filter_map(|cell| cells.get(&cell)).flatten() {
                let distance = super::norm(super::minus(start[a as usize], start[b as usize]));
                let twice = seeds[b as usize] && b <= a;
                if !twice && distance > 0.0 && distance <= reach {
                    let pair = [a, b].map(|number| neighbours.choose(number, &start));
                    neighbours.pairs.push(pair);
                }
            }
        }
        neighbours
    }

    /// Place in `start` of a particle that is chosen now or was before.
    fn choose(&mut self, number: u32, start: &[[f64; 3]]) -> u32 {
        let place = &mut self.place[number as usize];
        if *place == NONE {
            *place = self.start.len() as u32;
            self.start.push(start[number as usize]);
            self.numbers.push(number);
        }
        *place
    }

    /// The chosen particles now, in the order of `start`; those that have left the domain are chosen no more.
    pub(super) fn particles(&mut self, view: &dyn View, body: usize) -> Vec<TracedParticle> {
        if self.start.is_empty() {
            return Vec::new();
        }
        let place = |number: u32| self.place.get(number as usize).copied().unwrap_or(NONE);
        let mut wanted = self.numbers.clone();
        wanted.sort_unstable();
        let mut traced = view.trace(body, &wanted);
        traced.sort_unstable_by_key(|particle| place(particle.number));
        if traced.len() < self.start.len() {
            self.keep(traced.iter().map(|particle| particle.number).collect());
        }
        traced
    }

    /// Chooses these only, of those that are chosen, in the same order.
    fn keep(&mut self, numbers: Vec<u32>) {
        self.lost = true;
        let mut now = vec![NONE; self.start.len()];
        for (new, &number) in numbers.iter().enumerate() {
            now[self.place[number as usize] as usize] = new as u32;
        }
        let mut there = now.iter().map(|&new| new != NONE);
        self.start.retain(|_| there.next().unwrap_or(false));
        self.pairs = (self.pairs.iter())
            .map(|pair| pair.map(|place| now[place as usize]))
            .filter(|pair| !pair.contains(&NONE))
            .collect();
        self.numbers = numbers;
        self.find_places();
    }

    fn find_places(&mut self) {
        self.place.fill(NONE);
        let most = self.numbers.iter().max().map_or(0, |&most| most as usize + 1);
        self.place.resize(most.max(self.place.len()), NONE);
        for (place, &number) in self.numbers.iter().enumerate() {
            self.place[number as usize] = place as u32;
        }
    }

    /// Keeps what was chosen once some of it is gone, or takes that up: it cannot be chosen anew then.
    pub(super) fn remember(&mut self, memory: &mut Memory) -> Result<(), OutputError> {
        if !self.lost && !memory.is_taking_up() {
            return Ok(());
        }
        let mut kept = (self.start.clone(), self.pairs.clone(), self.numbers.clone());
        if memory.keep("chosen", &mut kept)? {
            let (start, pairs, numbers) = kept;
            let fits = start.len() == numbers.len()
                && pairs.iter().flatten().all(|&place| (place as usize) < start.len());
            if fits {
                (self.start, self.pairs, self.numbers, self.lost) = (start, pairs, numbers, true);
                self.find_places();
            }
        }
        Ok(())
    }
}

/// So many of the numbers below `count`, ascending: one in each equal part, anywhere in it, so that no row of a lattice
/// is preferred.
fn chosen(count: usize, wanted: usize) -> Vec<u32> {
    if wanted >= count {
        return (0..count as u32).collect();
    }
    let first = |part: usize| part * count / wanted;
    (0..wanted)
        .map(|part| {
            let scattered = (part as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32;
            (first(part) + scattered as usize % (first(part + 1) - first(part))) as u32
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_chosen_all_over_the_body_once() {
        assert_eq!(chosen(3, 5), [0, 1, 2]);
        let some = chosen(1000, 300);
        assert_eq!(some.len(), 300);
        assert!(some.windows(2).all(|two| two[0] < two[1] && two[1] - two[0] < 8));
    }
}
