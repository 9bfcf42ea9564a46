//! No contact: bodies pass through each other.

use super::PairLaw;
use crate::contact::{Change, Pair};
use crate::tensor::{Real, Vector};

/// Nothing at all.
pub struct None;

impl<T: Real, const D: usize> PairLaw<T, D> for None {
    fn change(&self, _: &Pair<T, D>, _: [Vector<T, D>; 2]) -> Change<T, D> {
        Change::NONE
    }
}
