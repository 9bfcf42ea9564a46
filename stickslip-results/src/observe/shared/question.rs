//! What outputs ask of all particles, whoever has them.

use super::Request;
use super::meeting::Meetings;
use crate::door::View;
use crate::observe::arrivals::{Furthest, MassMean};
use crate::observe::fronts::FrontQuestion;
use crate::observe::points::{PointsQuestion, Surroundings};
use crate::observe::sections::SectionCut;
use crate::observe::surfaces::CarriersQuestion;
use crate::ranks::{Ranks, bytes_of, combined, read};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::HashSet;

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
    Surroundings(PointsQuestion),
    Section(SectionCut),
    Carriers(CarriersQuestion),
    Near(Near),
    Counts(Counts),
    Starts(Starts),
    Meetings(Meetings),
}

impl Asked {
    /// The answer of all ranks, for the first.
    pub(super) fn said(&self, own: &dyn View, ranks: &dyn Ranks) -> Vec<u8> {
        match self {
            Asked::Furthest(question) => said(question, own, ranks),
            Asked::Mean(question) => said(question, own, ranks),
            Asked::Front(question) => said(question, own, ranks),
            Asked::Points(question) => said(&question.points(), own, ranks),
            Asked::Surroundings(question) => said(&Surroundings(&question.points()), own, ranks),
            Asked::Section(question) => said(question, own, ranks),
            Asked::Carriers(question) => said(question, own, ranks),
            Asked::Near(question) => said(question, own, ranks),
            Asked::Counts(question) => said(question, own, ranks),
            Asked::Starts(question) => said(question, own, ranks),
            Asked::Meetings(question) => said(question, own, ranks),
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

/// How many particles some bodies have, of those that know where they began.
#[derive(Clone, Serialize, Deserialize)]
pub(in crate::observe) struct Counts(Vec<usize>);

impl Question for Counts {
    /// Of each body how many, and one more than the largest of their numbers.
    type Answer = Vec<(usize, usize)>;

    fn look(&self, view: &dyn View) -> Self::Answer {
        let of_body = |&body: &usize| {
            let (mut count, mut end) = (0, 0);
            visit_starts(view, body, &mut |number, _| {
                (count, end) = (count + 1, end.max(number as usize + 1));
            });
            (count, end)
        };
        self.0.iter().map(of_body).collect()
    }

    fn join(one: Self::Answer, other: Self::Answer) -> Self::Answer {
        one.into_iter().zip(other).map(|(one, other)| (one.0 + other.0, one.1.max(other.1))).collect()
    }

    fn asked(&self) -> Asked {
        Asked::Counts(self.clone())
    }
}

/// Which particles of a body are wanted.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum WantedStarts {
    /// Those with these numbers.
    Numbers(Vec<u32>),
    /// Those that began in some cells of a grid of this side [m], which has a node at the origin.
    Cells(f64, Vec<[i64; 3]>),
}

/// Where wanted particles of some bodies began.
#[derive(Clone, Serialize, Deserialize)]
pub(in crate::observe) struct Starts(Vec<(usize, WantedStarts)>);

impl Question for Starts {
    type Answer = Vec<StartsOfBody>;

    fn look(&self, view: &dyn View) -> Self::Answer {
        let of_body = |(body, wanted): &(usize, WantedStarts)| {
            let mut found = Vec::new();
            match wanted {
                WantedStarts::Numbers(numbers) => {
                    let numbers: HashSet<u32> = numbers.iter().copied().collect();
                    visit_starts(view, *body, &mut |number, x| {
                        found.extend(numbers.contains(&number).then_some((number, x)));
                    });
                }
                WantedStarts::Cells(side, cells) => {
                    let cells: HashSet<[i64; 3]> = cells.iter().copied().collect();
                    visit_starts(view, *body, &mut |number, x| {
                        found.extend(cells.contains(&cell_of(x, *side)).then_some((number, x)));
                    });
                }
            }
            found
        };
        self.0.iter().map(of_body).collect()
    }

    fn join(one: Self::Answer, other: Self::Answer) -> Self::Answer {
        one.into_iter().zip(other).map(|(one, other)| [one, other].concat()).collect()
    }

    fn asked(&self) -> Asked {
        Asked::Starts(self.clone())
    }
}

/// Numbers of particles of a body, and where these began [m], in any order.
pub type StartsOfBody = Vec<(u32, [f64; 3])>;

/// Shows where the particles of a body were before anything moved [m]; of a simulation that does not know it none.
fn visit_starts(view: &dyn View, body: usize, look: &mut dyn FnMut(u32, [f64; 3])) {
    let mut look = |number: u32, x: &[f64]| look(number, [x[0], x[1], x[2]]);
    // What has no such column began nowhere.
    let _ = view.visit_column(body, "start", &mut look);
}

/// The cell of a place, of a grid of this side with a node at the origin.
pub fn cell_of(place: [f64; 3], side: f64) -> [i64; 3] {
    place.map(|x| (x / side).floor() as i64)
}

/// How many particles each of some bodies has that know where they began, and one more than the largest of their
/// numbers.
pub fn counts(view: &dyn View, bodies: &[usize]) -> Vec<(usize, usize)> {
    answer(view, &Counts(bodies.to_vec()))
}

/// Where wanted particles of each of some bodies began.
pub fn starts(view: &dyn View, wanted: Vec<(usize, WantedStarts)>) -> Vec<StartsOfBody> {
    answer(view, &Starts(wanted))
}
