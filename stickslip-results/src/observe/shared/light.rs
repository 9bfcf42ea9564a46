//! Light through bodies whose particles ranks have.
//!
//! Each body is given to one rank, so that all have about as many particles. It is sent those that others have, of some
//! bodies at a time and only what light needs of them, and makes of each body what one process makes of it. The first
//! rank puts this together in the order of the bodies.

use super::Request;
use crate::door::View;
use crate::polariscope::{
    BodyLight, ImageWindow, LinearRgb, Link, OpticalBench, Outline, Pair, Picture, Push, SeenBody,
    SeenParticle, Stage, framed, links_to, meeting_place, pairs, places_near, pressing, wide_cloud,
};
use crate::ranks::{Ranks, added, bytes_of, combined, dealt, gathered, read};
use crate::scene::Polariscope;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::ops::Range;

/// A look through a polariscope at the particles of all ranks.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(in crate::observe) struct Look {
    /// Of space, 2 or 3.
    pub dimension: usize,
    /// How many bodies there are.
    pub bodies: usize,
    pub specimens: Vec<usize>,
    pub polariscope: Polariscope,
}

/// The light of an instant, and what bodies push on each other.
#[derive(Serialize, Deserialize)]
pub(super) struct LightRequest {
    look: Look,
    window: ImageWindow,
    pushes: Vec<Push>,
}

/// Particles that a rank looks at at once, unless a body has more.
const AT_A_TIME: usize = 1 << 16;
/// Pixels of which it tells the first at once, unless a body has more.
const PIXELS_AT_A_TIME: usize = 1 << 16;

/// As [`crate::polariscope::bounds`]; none where nobody shares the simulation.
pub(in crate::observe) fn bounds_on_ranks(view: &dyn View, look: &Look) -> Option<[[f64; 2]; 2]> {
    let said = view.ask_ranks(&|| bytes_of(&Request::Bounds(look.clone())))?;
    read(&said[0])
}

/// The light on each pixel and the links of force chains, as one process has them; none where nobody shares the
/// simulation.
pub(in crate::observe) fn light_on_ranks(
    view: &dyn View,
    (look, window): (&Look, ImageWindow),
    pushes: Vec<Push>,
) -> Option<(Vec<LinearRgb>, Vec<Link>)> {
    let request = Request::Light(LightRequest { look: look.clone(), window, pushes });
    let said = view.ask_ranks(&|| bytes_of(&request))?;
    Some(read(&said[0]))
}

/// What the first rank says of where specimens are.
pub(super) fn bounds(view: &dyn View, ranks: &dyn Ranks, look: &Look) -> Vec<u8> {
    let mut own = Vec::new();
    let is_specimen = |body| look.specimens.contains(&body);
    Deal::of(view, ranks, look).each(&is_specimen, &mut |seen| own.push(wide_cloud(&seen).outline));
    bytes_of(&framed(gathered(ranks, &own).concat().into_iter()))
}

/// What the first rank says of light and links.
pub(super) fn light(view: &dyn View, ranks: &dyn Ranks, request: &LightRequest) -> Vec<u8> {
    let LightRequest { look, window, pushes } = request;
    let stage = Stage { window: *window, specimens: look.specimens.clone() };
    let bench = OpticalBench::new(&look.polariscope, stage);
    let (deal, pressing) = (Deal::of(view, ranks, look), pressing(pushes));
    let mut picture = (ranks.rank() == 0).then(|| bench.picture());
    let (mut lights, mut outlines) = (Vec::new(), Vec::new());
    deal.each(&|_| true, &mut |seen| {
        if pressing.contains(&seen.body) {
            outlines.push(wide_cloud(&seen).outline);
        }
        match (bench.light_of(&seen), &mut picture) {
            // The first bodies are those of the first rank.
            (Some(light), Some(picture)) => picture.add(&light),
            (light, _) => lights.extend(light),
        }
    });
    add_others(ranks, lights, &mut picture);
    let outlines: Vec<Outline> = gathered(ranks, &outlines).concat();
    let links = deal.links(&pairs(pushes, outlines.into_iter()));
    picture.map_or_else(Vec::new, |picture| bytes_of(&(bench.developed(picture), links)))
}

/// Adds the light of others to the picture of the first rank, in the order of ranks, which is that of their bodies.
fn add_others(ranks: &dyn Ranks, lights: Vec<BodyLight>, picture: &mut Option<Picture>) {
    let mut own: Vec<Vec<BodyLight>> = Vec::new();
    let mut pixels = 0;
    for light in lights {
        pixels += light.pixels();
        match own.last_mut().filter(|_| pixels <= PIXELS_AT_A_TIME) {
            Some(some) => some.push(light),
            None => {
                pixels = light.pixels();
                own.push(vec![light]);
            }
        }
    }
    let counts = gathered(ranks, &own.len());
    let mut own = own.into_iter();
    for (rank, count) in counts.into_iter().enumerate().skip(1) {
        let from = if ranks.rank() == 0 { &[rank][..] } else { &[] };
        for _ in 0..count {
            let some = if ranks.rank() == rank { own.next() } else { None };
            let message = some.map(|some| (0, bytes_of(&some)));
            for (_, some) in ranks.exchange_during(message.into_iter().collect(), from, &mut || ()) {
                let picture = picture.as_mut().expect("only the first rank is told");
                read::<Vec<BodyLight>>(&some).iter().for_each(|light| picture.add(light));
            }
        }
    }
}

/// Which rank looks at which bodies.
struct Deal<'a> {
    view: &'a dyn View,
    ranks: &'a dyn Ranks,
    look: &'a Look,
    /// Of each body.
    owners: Vec<usize>,
    /// Of each rank, the bodies that it looks at at once.
    batches: Vec<Vec<Range<usize>>>,
}

impl<'a> Deal<'a> {
    /// Bodies stay in their order, cut where all ranks have about as many particles.
    fn of(view: &'a dyn View, ranks: &'a dyn Ranks, look: &'a Look) -> Self {
        // Whatever has no masses has no particles.
        let own = |body| view.column(body, "mass").map_or(0, |column| column.numbers().len());
        let counts = combined(ranks, &(0..look.bodies).map(own).collect::<Vec<_>>(), added);
        let all = counts.iter().sum::<usize>().max(1);
        let (mut before, mut held) = (0, 0);
        let mut owners = Vec::with_capacity(counts.len());
        let mut batches: Vec<Vec<Range<usize>>> = vec![Vec::new(); ranks.count()];
        for (body, count) in counts.iter().enumerate() {
            let owner = ((2 * before + count) * ranks.count() / (2 * all)).min(ranks.count() - 1);
            (before, held) = (before + count, held + count);
            owners.push(owner);
            match batches[owner].last_mut().filter(|_| held <= AT_A_TIME) {
                Some(batch) => batch.end = body + 1,
                None => {
                    held = *count;
                    batches[owner].push(body..body + 1);
                }
            }
        }
        Deal { view, ranks, look, owners, batches }
    }

    /// Shows this rank those of its bodies that are wanted and have particles, one after the other.
    fn each(&self, wanted: &dyn Fn(usize) -> bool, look: &mut dyn FnMut(SeenBody)) {
        let rounds = self.batches.iter().map(Vec::len).max().unwrap_or_default();
        for round in 0..rounds {
            let bodies = self.batches.iter().filter_map(|batches| batches.get(round).cloned()).flatten();
            let here =
                bodies.filter(|body| wanted(*body)).map(|body| (self.owners[body], (body, self.here(body))));
            let mut all: BTreeMap<usize, Vec<(u32, SeenParticle)>> = BTreeMap::new();
            for (body, some) in dealt(self.ranks, here.filter(|(_, (_, some))| !some.is_empty())) {
                all.entry(body).or_default().extend(some);
            }
            for (body, mut some) in all {
                some.sort_unstable_by_key(|(number, _)| *number);
                let particles = some.into_iter().map(|(_, particle)| particle).collect();
                look(SeenBody { body, dimension: self.look.dimension, particles });
            }
        }
    }

    /// What this rank has of a body, by numbers.
    fn here(&self, body: usize) -> Vec<(u32, SeenParticle)> {
        let mut here = Vec::new();
        self.view.visit(body, &mut |particle| here.push((particle.number, particle.into())));
        here
    }

    /// The links of pairs: the rank of the body with fewer points sends those near the other to the rank of that one.
    fn links(&self, pairs: &[Pair]) -> Vec<Link> {
        if pairs.is_empty() {
            return Vec::new();
        }
        let by = |body: fn(&Pair) -> usize| {
            let mut by: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
            pairs.iter().enumerate().for_each(|(i, pair)| by.entry(body(pair)).or_default().push(i));
            by
        };
        let (of_few, of_many) = (by(|pair| pair.few.body), by(|pair| pair.many.body));
        let mut near = Vec::new();
        self.each(&|body| of_few.contains_key(&body), &mut |seen| {
            let cloud = wide_cloud(&seen);
            for &i in &of_few[&seen.body] {
                let many = &pairs[i].many;
                near.push((self.owners[many.body], (i, places_near(&cloud, many))));
            }
        });
        let near: BTreeMap<usize, Vec<[f64; 2]>> = dealt(self.ranks, near).into_iter().collect();
        let mut own: Vec<(usize, [f64; 2])> = Vec::new();
        self.each(&|body| of_many.contains_key(&body), &mut |seen| {
            let cloud = wide_cloud(&seen);
            let of_body = of_many[&seen.body].iter();
            own.extend(of_body.filter_map(|i| Some((*i, meeting_place(&near[i], &cloud)?))));
        });
        let mut places = vec![None; pairs.len()];
        gathered(self.ranks, &own).concat().into_iter().for_each(|(i, place)| places[i] = Some(place));
        links_to(&places, pairs, &self.look.specimens)
    }
}
