//! All equations of a mechanism solved at once.
//!
//! Sweeps carry a push from a body to the next, and so need as many of them as the square of a tower's height. A direct
//! step finds where impulses that are soft come to rest: with the changes u of the bodies' velocities from where they
//! stand with the impulses l, and along rows g velocities r(u) that are too much,
//!
//! ```text
//! M u = sum g (l'(u) - l),     l'(u) = what a law makes of   l - r(u) / (e y)
//! ```
//! which is a step of the method of multipliers (Hestenes 1969; of contact Alart and Curnier 1991, Comput. Methods Appl.
//! Mech. Eng. 92, 353-375). The law is that of sweeps for rows that yield e y in place of y. So a face that bears on
//! more points than it needs has one answer, the one next to the impulses so far, and what is off after the step is
//! e y (l' - l), which the next one takes up. u is found by Newton's method: as long as no contact begins or ends to
//! push or to slip, one round is exact.

use super::row::JointRow;
use super::sparse::{Block, BlockMatrix, Pattern, inverse, times};
use super::sweeps::{Contacts, Packed};
use std::collections::BTreeSet;

/// How soft rows are at first, and how hard they may become.
const SOFT: f64 = 1e-2;
const HARDEST: f64 = 1e-6;
const SOFTEST: f64 = 1e1;
/// Of a velocity along a row, in units of its last place.
const ROUND_OFF: f64 = 16.0;
/// By how much they become harder where a step came to rest in few rounds, and softer where it did not.
const HARDER: f64 = 0.3;
const SOFTER: f64 = 4.0;
/// Rounds of Newton's method at most, and so few that rows may be harder.
pub const ROUNDS: usize = 12;
pub const FEW_ROUNDS: usize = 6;
/// Rounds end where what is off has fallen to this part of what it was, in energy.
const FALLEN: f64 = 1e-6;
/// Parts of a round that are tried until less is off than before.
const PARTS: [f64; 4] = [1.0, 0.5, 0.25, 0.0625];

/// Solves for all equations at once.
pub struct Direct<const N: usize> {
    pattern: Pattern,
    /// Inertia of each body, with what follows it at the nodes, and its inverse.
    own: Vec<Block<N>>,
    inverses: Vec<Block<N>>,
    softness: f64,
    /// How hard rows may become.
    hardest: f64,
    /// Steps and their rounds so far.
    pub rounds: usize,
}

/// How an impulse follows from a velocity: l' falls by `weight` times that along the row, and acts along the column.
#[derive(Clone, Copy)]
pub struct Term {
    pub weight: f64,
    /// The rows of the column, with their shares.
    pub column: [(usize, f64); 3],
    /// The rows of which the velocity is a sum, with their shares.
    pub row: [(usize, f64); 2],
}

/// Impulses that a law gives, and how they follow from velocities.
#[derive(Default)]
pub struct Answer {
    pub impulses: Vec<f64>,
    pub terms: Vec<Term>,
}

impl Answer {
    /// Takes the impulse of a row that follows its own velocity, or none.
    pub fn take(&mut self, row: usize, impulse: f64, weight: f64) {
        self.impulses[row] = impulse;
        if weight > 0.0 {
            let none = (row, 0.0);
            self.terms.push(Term { weight, column: [(row, 1.0), none, none], row: [(row, 1.0), none] });
        }
    }
}

impl<const N: usize> Direct<N> {
    /// For bodies with these matrices of inertia, to this part of the largest velocity; `None` where it would take more
    /// than `most` products of blocks.
    pub fn new(rows: &[Packed<N>], own: Vec<Block<N>>, (tolerance, most): (f64, usize)) -> Option<Self> {
        // Velocities count by their round-off over how soft rows are.
        let hardest = (ROUND_OFF * f64::EPSILON / tolerance).clamp(HARDEST, SOFT);
        let count = own.len();
        let pairs: BTreeSet<[usize; 2]> = (rows.iter().map(|row| row.bodies))
            .filter(|[a, b]| a != b && *a < count && *b < count)
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        let inverses = own.iter().map(inverse).collect::<Option<_>>()?;
        Some(Direct {
            pattern: Pattern::new(count, &pairs, most)?,
            own,
            inverses,
            softness: SOFT,
            hardest,
            rounds: 0,
        })
    }

    /// Takes a step from these impulses and changes of velocities, in so many rounds of Newton's method at most; says
    /// whether the equations could be solved.
    pub fn step(
        &mut self,
        (rows, changes): (&mut [Packed<N>], &mut [[f64; N]]),
        (held, contacts): (&[JointRow], &Contacts),
        most: usize,
    ) -> bool {
        self.rounds += 1;
        let begun = changes.to_vec();
        let mut velocities = begun.clone();
        let answer = |velocities: &[[f64; N]]| {
            let mut answer =
                Answer { impulses: rows.iter().map(|row| row.impulse).collect(), ..Answer::default() };
            for (number, joint) in held.iter().enumerate().filter(|(i, _)| rows[*i].yields > 0.0) {
                let yields = self.softness * rows[number].yields;
                let wanted = rows[number].wanted(velocities, yields);
                let weight = if wanted.abs() < joint.limit { 1.0 / yields } else { 0.0 };
                answer.take(number, wanted.clamp(-joint.limit, joint.limit), weight);
            }
            contacts.answer((rows, velocities), self.softness, &mut answer);
            answer
        };
        let mut now = answer(&velocities);
        let mut off = self.off(rows, (&velocities, &begun), &now);
        let (mut size, mut rounds) = (self.size(&off), 0);
        let enough = FALLEN * size;
        while rounds < most && size > enough {
            rounds += 1;
            self.rounds += 1;
            let mut matrix = BlockMatrix::new(&self.pattern, &self.own);
            now.terms.iter().for_each(|term| self.add(term, rows, &mut matrix));
            if !matrix.factor() {
                return false;
            }
            let way = matrix.solve(&off);
            let before = velocities.clone();
            let mut best: Option<(f64, f64)> = None;
            for part in PARTS {
                for ((v, before), way) in velocities.iter_mut().zip(&before).zip(&way) {
                    *v = std::array::from_fn(|k| before[k] + part * way[k]);
                }
                now = answer(&velocities);
                off = self.off(rows, (&velocities, &begun), &now);
                let found = self.size(&off);
                if best.is_none_or(|(least, _)| found < least) {
                    best = Some((found, part));
                }
                if found < size {
                    break;
                }
            }
            let Some((found, part)) = best else { return false };
            for ((v, before), way) in velocities.iter_mut().zip(&before).zip(&way) {
                *v = std::array::from_fn(|k| before[k] + part * way[k]);
            }
            now = answer(&velocities);
            off = self.off(rows, (&velocities, &begun), &now);
            size = found;
        }
        if size > enough {
            self.softness = (SOFTER * self.softness).min(SOFTEST);
            return false;
        }
        if rounds <= FEW_ROUNDS {
            self.softness = (HARDER * self.softness).max(self.hardest);
        }
        for (row, impulse) in rows.iter_mut().zip(&now.impulses) {
            let change = impulse - row.impulse;
            row.impulse = *impulse;
            row.give(change, changes);
        }
        changes.iter().flatten().all(|x| x.is_finite())
    }

    /// What is off with these velocities: sum g (l' - l) - M u.
    fn off(
        &self,
        rows: &[Packed<N>],
        (velocities, begun): (&[[f64; N]], &[[f64; N]]),
        answer: &Answer,
    ) -> Vec<[f64; N]> {
        let mut off: Vec<[f64; N]> = (self.own.iter().zip(velocities).zip(begun))
            .map(|((own, v), begun)| times(own, &std::array::from_fn(|k| begun[k] - v[k])))
            .collect();
        for (row, impulse) in rows.iter().zip(&answer.impulses) {
            let change = impulse - row.impulse;
            for side in 0..2 {
                if let Some(off) = off.get_mut(row.bodies[side]) {
                    off.iter_mut().zip(&row.directions[side]).for_each(|(off, g)| *off += change * g);
                }
            }
        }
        off
    }

    /// The energy of what is off.
    fn size(&self, off: &[[f64; N]]) -> f64 {
        let of = |(inverse, off): (&Block<N>, &[f64; N])| {
            times(inverse, off).iter().zip(off).map(|(a, b)| a * b).sum::<f64>()
        };
        self.inverses.iter().zip(off).map(of).sum()
    }

    /// Adds a term to the matrix M + sum w d g^T.
    fn add(&self, term: &Term, rows: &[Packed<N>], matrix: &mut BlockMatrix<N>) {
        let bodies = rows[term.row[0].0].bodies;
        let sum = |shares: &[(usize, f64)], side: usize| -> [f64; N] {
            std::array::from_fn(|k| {
                shares.iter().map(|(row, share)| share * rows[*row].directions[side][k]).sum()
            })
        };
        let free = |side: &usize| bodies[*side] < self.own.len();
        for i in (0..2).filter(free) {
            let column = sum(&term.column, i).map(|x| term.weight * x);
            for j in (0..2).filter(free) {
                matrix.add([bodies[i], bodies[j]], &column, &sum(&term.row, j));
            }
        }
    }
}
