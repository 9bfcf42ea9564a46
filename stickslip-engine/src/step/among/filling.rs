//! How ranks fill bodies together: each walks through some of them, and tells the others what it found.

use super::super::reference::is_reference;
use super::{Home, share_out_bodies};
use crate::geometry::{ParticleSite, sites};
use crate::grid::Periods;
use crate::ranks::{Census, Message, Partition, Ranks, gathered, message_to};
use crate::scene::{self, Scene};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeSet, HashSet};

/// What the particles come to that fill a body with bounds.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Walked {
    /// How many.
    pub count: usize,
    /// Their volume [m^3], in the plane area [m^2].
    pub volume: f64,
    /// Its centre [m].
    pub center: [f64; 3],
    /// Where the first begins [m].
    first: Option<[f64; 3]>,
}

/// Who has which of the particles that fill bodies.
pub struct SharedOut {
    /// The bodies; none of those without bounds.
    pub walked: Vec<Option<Walked>>,
    /// Which bodies have particles that begin with this rank.
    pub here: HashSet<usize>,
    /// Who owns which block.
    pub partition: Partition,
    /// Where each body begins.
    pub homes: Vec<Home>,
}

impl Walked {
    /// What they come to, each of which is shown by its place [m]; `None` of a body without bounds.
    pub fn of(scene: &Scene, body: &scene::Body, look: &mut dyn FnMut([f64; 3])) -> Option<Self> {
        let all = sites(&body.shape, &scene.lattice(body), scene.arrangement(body))?;
        let mut walked = Walked { count: 0, volume: 0.0, center: [0.0; 3], first: None };
        for ParticleSite { position, volume, .. } in all {
            look(position);
            walked.count += 1;
            walked.volume += volume;
            walked.first = walked.first.or(Some(position));
        }
        for ParticleSite { position, volume, .. } in walk(scene, body) {
            walked.center =
                std::array::from_fn(|k| walked.center[k] + position[k] * (volume / walked.volume));
        }
        Some(walked)
    }
}

/// The particles that fill a body, one after the other; none of a body without bounds.
pub fn walk<'a>(scene: &Scene, body: &'a scene::Body) -> impl Iterator<Item = ParticleSite> + 'a {
    sites(&body.shape, &scene.lattice(body), scene.arrangement(body)).into_iter().flatten()
}

/// Walks through the particles of all bodies, and shows those of some to each rank, by body and place [m].
pub fn walk_together(
    scene: &Scene,
    ranks: &dyn Ranks,
    look: &mut dyn FnMut(usize, [f64; 3]),
) -> Vec<Option<Walked>> {
    let mut own = Vec::new();
    for (number, body) in scene.bodies.iter().enumerate().skip(ranks.rank()).step_by(ranks.count()) {
        own.extend(Walked::of(scene, body, &mut |place| look(number, place)).map(|walked| (number, walked)));
    }
    let mut all = vec![None; scene.bodies.len()];
    for (number, walked) in gathered(ranks, &own).into_iter().flatten() {
        all[number] = Some(walked);
    }
    all
}

/// Shares out the particles of a scene; `block` tells the block of a place, in the first period.
pub fn share_out<const D: usize>(
    scene: &Scene,
    ranks: &dyn Ranks,
    (periods, block): (Periods<D>, impl Fn([f64; 3]) -> [i32; D]),
) -> SharedOut {
    let (mut census, mut reached, mut last) = (Census::new(periods), HashSet::new(), None);
    let walked = walk_together(scene, ranks, &mut |body, place| {
        let block = block(place);
        census.count(body, block);
        if last.replace((body, block)) != Some((body, block)) {
            reached.insert((body, block));
        }
    });
    let partition = census.of_all(ranks).partition(ranks);
    let wanted: BTreeSet<(usize, usize)> =
        reached.into_iter().map(|(body, block)| (partition.owner(block), body)).collect();
    let mut messages: Vec<Message> = Vec::new();
    let mut here = HashSet::new();
    for (rank, body) in wanted {
        if rank == ranks.rank() {
            here.insert(body);
        } else {
            message_to(&mut messages, rank).extend((body as u32).to_le_bytes());
        }
    }
    for (_, message) in ranks.exchange(messages) {
        here.extend(message.as_chunks().0.iter().map(|body| u32::from_le_bytes(*body) as usize));
    }
    let home = |walked: &Option<Walked>| {
        let first = walked.and_then(|walked| walked.first);
        let rank = first.map_or(0, |place| partition.owner(block(place)));
        Home::new(rank, walked.map_or(0, |walked| walked.count))
    };
    let mut homes: Vec<Home> = walked.iter().map(home).collect();
    let whole: Vec<usize> = (0..homes.len()).filter(|&body| is_reference(scene, body)).collect();
    for &body in &whole {
        here.remove(&body);
    }
    share_out_bodies(&mut homes, whole.clone(), ranks.count());
    here.extend(whole.into_iter().filter(|&body| homes[body].rank as usize == ranks.rank()));
    SharedOut { walked, here, partition, homes }
}
