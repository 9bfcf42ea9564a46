//! How files of many points are cut into pieces: in the same way whoever has the points.

use super::vtk::VtkFile;
use std::collections::BTreeMap;
use std::ops::Range;

/// Points of a piece, where a stretch does not have more.
pub(super) const OF_A_PIECE: usize = 1 << 16;

/// Where a piece begins, among points in the order of stretches `S`, which stay together, and how many it has.
pub(super) struct PieceStart<S> {
    pub first: S,
    pub points: usize,
}

/// Pieces of a file with so many points in each stretch: one at least.
pub(super) fn cut<S: Clone + Default>(counts: &BTreeMap<S, usize>) -> Vec<PieceStart<S>> {
    let mut pieces: Vec<PieceStart<S>> = Vec::new();
    for (first, &count) in counts {
        match pieces.last_mut().filter(|piece| piece.points + count <= OF_A_PIECE) {
            Some(piece) => piece.points += count,
            None => pieces.push(PieceStart { first: first.clone(), points: count }),
        }
    }
    if pieces.is_empty() {
        pieces.push(PieceStart { first: S::default(), points: 0 });
    }
    pieces
}

/// How many points there are in each stretch, here and elsewhere.
pub(super) fn counts_of_both<S: Ord>(
    mut counts: BTreeMap<S, usize>,
    others: BTreeMap<S, usize>,
) -> BTreeMap<S, usize> {
    others.into_iter().for_each(|(stretch, count)| *counts.entry(stretch).or_default() += count);
    counts
}

/// The file of all pieces, each made of its rows.
pub(super) fn encoded<S>(pieces: &[PieceStart<S>], encode: impl Fn(Range<usize>) -> VtkFile) -> VtkFile {
    let mut end = 0;
    VtkFile::joined(pieces.iter().map(|piece| {
        let begin = end;
        end += piece.points;
        encode(begin..end)
    }))
}
