//! Particles that were neighbours before anything moved: some of each body, chosen once.

use crate::door::{TracedParticle, View};
use crate::observe::{Memory, OutputError, WantedStarts, cell_of, counts, starts};
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
    /// Place in `start` of each of them, by its number.
    place: HashMap<u32, u32>,
}

/// Particles in all bodies that deform whose neighbours are chosen; in a body at least [`FEWEST`] of them.
const MOST: usize = 500;
const FEWEST: usize = 24;
/// Of more bodies that deform, so many are looked at, spread evenly over the list.
const MOST_BODIES: usize = 1 << 14;
/// Bodies whose particles are asked for at a time.
const TRACED_AT_A_TIME: usize = 1 << 10;
/// Bodies whose neighbours are looked for at a time.
const BODIES_AT_A_TIME: usize = 1 << 8;
/// Neighbours are so near, in distances of particles: on a lattice, those across edges and faces of a particle's box.
const NEAR: f64 = 1.5;
/// Neighbours of a particle on a lattice, in the plane and in space.
const AROUND: [usize; 2] = [8, 18];
/// Bytes of an entry in a table of places by numbers, with the room that such tables leave.
const PLACE: usize = 2 * size_of::<[u32; 2]>();

/// Memory that the particles take which are chosen of bodies that deform, with so many particles each: what is known of
/// them, and what they are as they are looked at [bytes].
pub(in crate::run) fn bytes_of(particles: &[usize], axes: usize) -> f64 {
    let looked_at = chosen(particles.len(), MOST_BODIES);
    let particles: Vec<usize> = looked_at.into_iter().map(|place| particles[place as usize]).collect();
    let (all, around) = (particles.iter().sum::<usize>().max(1), AROUND[axes - 2]);
    let of_body = |count: usize| count.min((MOST * count / all).max(FEWEST) * (1 + around));
    let pairs = size_of::<[u32; 2]>() * around / 2;
    let each = size_of::<TracedParticle>() + size_of::<[f64; 3]>() + size_of::<u32>() + PLACE + pairs;
    particles.into_iter().map(|count| (each * of_body(count)) as f64).sum()
}

/// Neighbours in each body; none in a rigid one.
pub(super) fn of_bodies(scene: &Scene, view: &dyn View) -> Vec<Neighbours> {
    // Rigid ones do not count: without bounds they have others all the time.
    let deforming = (0..scene.bodies.len()).filter(|&i| !scene.bodies[i].is_rigid());
    let deforming: Vec<usize> = deforming.collect();
    let looked_at = chosen(deforming.len(), MOST_BODIES);
    let looked_at: Vec<usize> = looked_at.into_iter().map(|place| deforming[place as usize]).collect();
    let extents = looked_at.chunks(BODIES_AT_A_TIME).flat_map(|some| counts(view, some));
    let extents: Vec<Extent> = extents.map(|(count, end)| Extent { count, end }).collect();
    let all: usize = extents.iter().map(|extent| extent.count).sum();
    let mut of_bodies: Vec<Neighbours> = scene.bodies.iter().map(|_| Neighbours::default()).collect();
    let there = looked_at.into_iter().zip(extents).filter(|(_, extent)| extent.count > 0);
    let there: Vec<(usize, Extent)> = there.collect();
    for some in there.chunks(BODIES_AT_A_TIME) {
        let seeds = some.iter().map(|&(body, extent)| {
            let wanted = (MOST * extent.count / all).max(FEWEST);
            (body, extent.numbers_at(chosen(extent.count, wanted), (view, body)))
        });
        let seeds: Vec<(usize, Vec<u32>)> = seeds.collect();
        let found = seeds.iter().zip(Neighbours::around(view, &seeds));
        found.for_each(|((body, _), neighbours)| of_bodies[*body] = neighbours);
    }
    of_bodies
}

/// How many particles a body has.
#[derive(Clone, Copy, Default)]
struct Extent {
    count: usize,
    /// One more than the largest of their numbers.
    end: usize,
}

impl Extent {
    /// The numbers of the particles that stand at some places in the order of numbers.
    fn numbers_at(self, places: Vec<u32>, (view, body): (&dyn View, usize)) -> Vec<u32> {
        if self.end == self.count {
            return places;
        }
        let mut numbers = Vec::with_capacity(self.count);
        // They were counted by this column.
        let _ = view.visit_column(body, "start", &mut |number, _| numbers.push(number));
        numbers.sort_unstable();
        places.into_iter().map(|place| numbers[place as usize]).collect()
    }
}

/// The cells at a cell and beside it.
fn beside([i, j, k]: [i64; 3]) -> impl Iterator<Item = [i64; 3]> {
    (0..27).map(move |d: i64| [i + d % 3 - 1, j + d / 3 % 3 - 1, k + d / 9 - 1])
}

impl Neighbours {
    /// Those of some particles of bodies, by their numbers.
    fn around(view: &dyn View, seeds: &[(usize, Vec<u32>)]) -> Vec<Self> {
        let traced = view.trace_each(seeds);
        let begun = starts(view, with(seeds, |(_, numbers), _| WantedStarts::Numbers(numbers.clone())));
        // Particles by cells as wide as the farthest neighbour, as far as a chosen one is near.
        let widest = |traced: &Vec<TracedParticle>| {
            2.0 * NEAR * traced.iter().map(|particle| particle.half_width).fold(0.0, f64::max)
        };
        let sides: Vec<f64> = traced.iter().map(widest).collect();
        let cells = |_: &(usize, Vec<u32>), place: usize| {
            let side = sides[place];
            let begun = begun[place].iter().filter(|_| side > 0.0);
            let mut cells: Vec<[i64; 3]> = begun.flat_map(|&(_, x)| beside(cell_of(x, side))).collect();
            cells.sort_unstable();
            cells.dedup();
            WantedStarts::Cells(side, cells)
        };
        let near = starts(view, with(seeds, cells));
        let each = seeds.iter().zip(&traced).zip(near.iter().zip(&sides));
        each.map(
            |(((_, numbers), traced), (near, &side))| {
                if side > 0.0 { Self::among(numbers, traced, (near, side)) } else { Self::default() }
            },
        )
        .collect()
    }

    /// Those of some particles of a body, which are traced, among those that began near them in cells of this side.
    fn among(seeds: &[u32], traced: &[TracedParticle], (near, side): (&[(u32, [f64; 3])], f64)) -> Self {
        let seeds: HashSet<u32> = seeds.iter().copied().collect();
        let start: HashMap<u32, [f64; 3]> = near.iter().copied().collect();
        let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
        for &(number, x) in near {
            cells.entry(cell_of(x, side)).or_default().push(number);
        }
        cells.values_mut().for_each(|numbers| numbers.sort_unstable());

        let mut neighbours = Neighbours::default();
        for particle in traced {
            let a = particle.number;
            let reach = 2.0 * NEAR * particle.half_width;
            for &b in beside(cell_of(start[&a], side)).filter_map(|cell| cells.get(&cell)).flatten() {
                let distance = super::norm(super::minus(start[&a], start[&b]));
                let twice = seeds.contains(&b) && b <= a;
                if !twice && distance > 0.0 && distance <= reach {
                    let pair = [a, b].map(|number| neighbours.choose(number, start[&number]));
                    neighbours.pairs.push(pair);
                }
            }
        }
        neighbours
    }

    /// Place in `start` of a particle that began there and is chosen now or was before.
    fn choose(&mut self, number: u32, start: [f64; 3]) -> u32 {
        *self.place.entry(number).or_insert_with(|| {
            self.start.push(start);
            self.numbers.push(number);
            self.start.len() as u32 - 1
        })
    }

    /// The numbers of the chosen particles, ascending.
    fn wanted(&self) -> Vec<u32> {
        let mut wanted = self.numbers.clone();
        wanted.sort_unstable();
        wanted
    }

    /// Brings the chosen particles into the order of `start`; those that have left the domain are chosen no more.
    fn order(&mut self, traced: &mut [TracedParticle]) {
        traced.sort_unstable_by_key(|particle| self.place.get(&particle.number).copied());
        if traced.len() < self.start.len() {
            self.keep(traced.iter().map(|particle| particle.number).collect());
        }
    }

    /// Chooses these only, of those that are chosen, in the same order.
    fn keep(&mut self, numbers: Vec<u32>) {
        self.lost = true;
        let mut now = vec![None; self.start.len()];
        for (new, number) in (0..).zip(&numbers) {
            now[self.place[number] as usize] = Some(new);
        }
        let mut there = now.iter().map(Option::is_some);
        self.start.retain(|_| there.next().unwrap_or(false));
        let pairs = self.pairs.iter().map(|pair| pair.map(|place| now[place as usize]));
        self.pairs = pairs.filter_map(|[a, b]| Some([a?, b?])).collect();
        self.numbers = numbers;
        self.find_places();
    }

    fn find_places(&mut self) {
        self.place = self.numbers.iter().copied().zip(0..).collect();
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

/// The chosen particles of each body now, in the order in which they are there at its start.
pub(super) fn particles(of_bodies: &mut [Neighbours], view: &dyn View) -> Vec<Vec<TracedParticle>> {
    let chosen = of_bodies.iter().enumerate().filter(|(_, neighbours)| !neighbours.start.is_empty());
    let wanted: Vec<(usize, Vec<u32>)> =
        chosen.map(|(body, neighbours)| (body, neighbours.wanted())).collect();
    let mut particles = vec![Vec::new(); of_bodies.len()];
    for some in wanted.chunks(TRACED_AT_A_TIME) {
        for ((body, _), mut traced) in some.iter().zip(view.trace_each(some)) {
            of_bodies[*body].order(&mut traced);
            particles[*body] = traced;
        }
    }
    particles
}

/// What is wanted of each of some bodies.
fn with<X>(
    bodies: &[(usize, X)],
    wanted: impl Fn(&(usize, X), usize) -> WantedStarts,
) -> Vec<(usize, WantedStarts)> {
    bodies.iter().enumerate().map(|(place, body)| (body.0, wanted(body, place))).collect()
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
