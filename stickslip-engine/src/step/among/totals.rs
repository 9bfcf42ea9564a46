//! What bodies on several ranks add up to. The sums of a body go to the rank where it began, which rounds them once.

use super::Among;
use crate::body::{Body, TotalSums, Totals, TurningSums};
use crate::exact::ExactSum;
use crate::lanes::Laned;
use crate::ranks::dealt;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_bytes::ByteBuf;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Sums over the particles of a body before they are rounded, as [`ExactSum::write_to`] writes one after the other: in
/// memory they take twenty times as much.
type PackedSums = ByteBuf;

impl<T: Laned> Among<T> {
    /// What the particles of each body on all ranks add up to.
    pub fn totals<const D: usize>(&self, bodies: &[Body<T, D>]) -> Arc<[Totals]> {
        let own = here(bodies).map(|(body, it)| (body, packed(it.total_sums().all())));
        self.rounded(bodies.len(), own, &|parts| {
            let mut totals = TotalSums::default();
            parts.iter().for_each(|part| unpack(part, totals.all()));
            totals.rounded()
        })
    }

    /// The same of a body.
    pub fn totals_of<const D: usize>(&self, body: &Body<T, D>) -> Totals {
        let mut sums = body.total_sums();
        self.add_up(sums.all());
        sums.rounded()
    }

    /// The angular velocities of bodies with these totals [rad/s].
    pub fn spins<const D: usize>(&self, bodies: &[Body<T, D>], totals: &[Totals]) -> Arc<[[f64; 3]]> {
        let turning = |body: usize, it: &Body<T, D>| it.turning_sums(&totals[body], it.gyration());
        let own = here(bodies).map(|(body, it)| (body, packed(turning(body, it).all())));
        self.rounded(bodies.len(), own, &|parts| {
            let mut sums = TurningSums::default();
            parts.iter().for_each(|part| unpack(part, sums.all()));
            sums.spin::<D>()
        })
    }

    /// What the sums of each of so many bodies come to, of which each rank has its own part; nothing of those of which
    /// no rank has any.
    fn rounded<X: Clone + Default + Serialize + DeserializeOwned>(
        &self,
        bodies: usize,
        own: impl Iterator<Item = (usize, PackedSums)>,
        round: &dyn Fn(&[PackedSums]) -> X,
    ) -> Arc<[X]> {
        let of_home = own.map(|(body, sums)| (self.homes[body].rank as usize, (body, sums)));
        let mut here: BTreeMap<usize, Vec<PackedSums>> = BTreeMap::new();
        for (body, sums) in dealt(&*self.ranks, of_home) {
            here.entry(body).or_default().push(sums);
        }
        let found: Vec<(usize, X)> = here.iter().map(|(body, parts)| (*body, round(parts))).collect();
        let mut all = vec![X::default(); bodies];
        for (body, of_body) in self.gathered(&found).into_iter().flatten() {
            all[body] = of_body;
        }
        all.into()
    }
}

/// The bodies of which this rank has particles.
fn here<T: Laned, const D: usize>(bodies: &[Body<T, D>]) -> impl Iterator<Item = (usize, &Body<T, D>)> {
    bodies.iter().enumerate().filter(|(_, body)| !body.particles.is_empty())
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
