//! What outputs ask of all particles, whoever has them.

use super::Request;
use crate::door::View;
use crate::observe::arrivals::{Furthest, MassMean};
use crate::observe::fronts::FrontQuestion;
use crate::observe::points::PointsQuestion;
use crate::observe::sections::SectionCut;
use crate::observe::surfaces::CarriersQuestion;
use crate::ranks::{Ranks, bytes_of, combined, read};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// A question about all particles: what it finds among some of them and among others, joined, is what it finds among
/// all.
pub(in crate::observe) trait Question: Serialize {
    /// What it finds.
    type Answer: Serialize + DeserializeOwned;
    /// What it finds among the particles of a simulation, or those that a rank has of it.
    fn look(&self, view: &dyn View) -> Self::Answer;
    /// Both answers as one; it does not matter which is which.
    fn join(one: Self::Answer, other: Self::Answer) -> Self::Answer;
    /// What ranks are asked.
    fn asked(&self) -> Asked;
}

/// All questions that there are.
#[derive(Serialize, Deserialize)]
pub(in crate::observe) enum Asked {
    Furthest(Furthest),
    Mean(MassMean),
    Front(FrontQuestion),
    Points(PointsQuestion),
    Section(SectionCut),
    Carriers(CarriersQuestion),
    Near(Near),
}

impl Asked {
    /// The answer of all ranks, for the first.
    pub(super) fn said(&self, own: &dyn View, ranks: &dyn Ranks) -> Vec<u8> {
        match self {
            Asked::Furthest(question) => said(question, own, ranks),
            Asked::Mean(question) => said(question, own, ranks),
            Asked::Front(question) => said(question, own, ranks),
            Asked::Points(question) => said(&question.points(), own, ranks),
            Asked::Section(question) => said(question, own, ranks),
            Asked::Carriers(question) => said(question, own, ranks),
            Asked::Near(question) => said(question, own, ranks),
        }
    }
}

fn said<Q: Question>(question: &Q, own: &dyn View, ranks: &dyn Ranks) -> Vec<u8> {
    let all = combined(ranks, &question.look(own), Q::join);
    if ranks.rank() == 0 { bytes_of(&all) } else { Vec::new() }
}

/// The answer to a question about all particles of a simulation.
pub(in crate::observe) fn answer<Q: Question>(view: &dyn View, question: &Q) -> Q::Answer {
    match view.ask_ranks(&|| bytes_of(&Request::Question(question.asked()))) {
        Some(said) => read(&said[0]),
        None => question.look(view),
    }
}

/// Whether a particle of a body is so near to a place, along each axis.
#[derive(Clone, Serialize, Deserialize)]
pub(in crate::observe) struct Near {
    body: usize,
    places: Vec<[f64; 3]>,
    distance: f64,
}

impl Question for Near {
    /// Of each place.
    type Answer = Vec<bool>;

    fn look(&self, view: &dyn View) -> Vec<bool> {
        let mut near = vec![false; self.places.len()];
        view.visit(self.body, &mut |particle| {
            for (near, place) in near.iter_mut().zip(&self.places) {
                *near |= (0..3).all(|k| (particle.position[k] - place[k]).abs() <= self.distance);
            }
        });
        near
    }

    fn join(one: Vec<bool>, other: Vec<bool>) -> Vec<bool> {
        one.into_iter().zip(other).map(|(one, other)| one | other).collect()
    }

    fn asked(&self) -> Asked {
        Asked::Near(self.clone())
    }
}

/// Of each place, whether a particle of a body is nearer than a distance along each axis [m].
pub fn has_near(view: &dyn View, body: usize, (places, distance): (&[[f64; 3]], f64)) -> Vec<bool> {
    answer(view, &Near { body, places: places.to_vec(), distance })
}
