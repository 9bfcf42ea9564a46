//! What bodies on several ranks add up to. The sums of a body go to the rank where it began, which rounds them once.

use super::super::state::{ByBody, of_body};
use super::Among;
use crate::Kernels;
use crate::body::{Body, TotalSums, Totals, TurningSums};
use crate::exact::ExactSum;
use crate::lanes::Laned;
use crate::ranks::{dealt, told_first};
use serde_bytes::ByteBuf;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Sums over the particles of a body before they are rounded, as [`ExactSum::write_to`] writes one after the other: in
/// memory they take twenty times as much.
type PackedSums = ByteBuf;

impl<T: Laned> Among<T> {
    /// What the particles of each body on all ranks add up to, by body: the first knows it of all, the others of those
    /// of which they have particles.
    pub fn totals<const D: usize>(
        &self,
        bodies: &[Body<T, D>],
        kernels: &Kernels<T, D>,
    ) -> Arc<ByBody<Totals>> {
        let found = self.rounded(
            bodies,
            |_, it| packed(it.total_sums(kernels).all()),
            |parts| {
                let mut totals = TotalSums::default();
                parts.iter().for_each(|part| unpack(part, totals.all()));
                totals.rounded()
            },
        );
        let replies = found.iter().flat_map(|(known, ranks)| {
            ranks.iter().filter(|rank| **rank > 0).map(move |&rank| (rank, *known))
        });
        let here = dealt(&*self.ranks, replies);
        let known: Vec<(usize, Totals)> = found.into_iter().map(|(known, _)| known).collect();
        let all = told_first(&*self.ranks, &known);
        by_body(if self.ranks.rank() == 0 { all.concat() } else { here }).into()
    }

    /// The same of a body.
    pub fn totals_of<const D: usize>(&self, body: &Body<T, D>, kernels: &Kernels<T, D>) -> Totals {
        let mut sums = body.total_sums(kernels);
        self.add_up(sums.all());
        sums.rounded()
    }

    /// The angular velocities of bodies with these totals [rad/s], by body: the first knows all, the others none.
    pub fn spins<const D: usize>(
        &self,
        bodies: &[Body<T, D>],
        totals: &ByBody<Totals>,
        kernels: &Kernels<T, D>,
    ) -> Vec<(usize, [f64; 3])> {
        let turning = |body: usize, it: &Body<T, D>| {
            let totals = of_body(totals, body).expect("it has particles here");
            packed(it.turning_sums(kernels, totals).all())
        };
        let found = self.rounded(bodies, turning, |parts| {
            let mut sums = TurningSums::default();
            parts.iter().for_each(|part| unpack(part, sums.all()));
            sums.spin::<D>()
        });
        let known: Vec<(usize, [f64; 3])> = found.into_iter().map(|(known, _)| known).collect();
        by_body(told_first(&*self.ranks, &known).concat())
    }

    /// What the sums of bodies come to that began on this rank, and which ranks have a part of each.
    fn rounded<X, const D: usize>(
        &self,
        bodies: &[Body<T, D>],
        sums_of: impl Fn(usize, &Body<T, D>) -> PackedSums,
        round: impl Fn(&[PackedSums]) -> X,
    ) -> Vec<((usize, X), Vec<usize>)> {
        let here = bodies.iter().enumerate().filter(|(_, body)| !body.particles.is_empty());
        let of_home = here
            .map(|(body, it)| (self.homes[body].rank as usize, (body, self.ranks.rank(), sums_of(body, it))));
        let mut parts: BTreeMap<usize, (Vec<usize>, Vec<PackedSums>)> = BTreeMap::new();
        for (body, rank, sums) in dealt(&*self.ranks, of_home) {
            let (ranks, parts) = parts.entry(body).or_default();
            ranks.push(rank);
            parts.push(sums);
        }
        parts.into_iter().map(|(body, (ranks, parts))| ((body, round(&parts)), ranks)).collect()
    }
}

/// In the order of bodies.
fn by_body<X>(mut all: Vec<(usize, X)>) -> Vec<(usize, X)> {
    all.sort_unstable_by_key(|(body, _)| *body);
    all
}

fn packed<'a>(sums: impl Iterator<Item = &'a mut ExactSum>) -> PackedSums {
    let mut bytes = Vec::new();
    sums.for_each(|sum| sum.write_to(&mut bytes));
    PackedSums::from(bytes)
}

/// Adds packed sums to others.
fn unpack<'a>(mut bytes: &[u8], sums: impl Iterator<Item = &'a mut ExactSum>) {
    for sum in sums {
        let (other, behind) = ExactSum::read_from(bytes).expect("what a rank writes can be read");
        sum.merge(&other);
        bytes = behind;
    }
}
