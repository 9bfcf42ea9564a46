//! Systems of equations of bodies that push each other: sparse, with a block for each pair of bodies that touch.
//!
//! ```text
//! A x = b,   A = L U block by block, without exchange of rows
//! ```
//! Bodies are eliminated in the order of the fewest neighbours that are left (minimum degree: Tinney and Walker 1967,
//! Proc. IEEE 55, 1801-1809). A tower costs as much as it has bodies, and a wall little more.

use std::collections::BTreeSet;

/// What a body does to another one, or to itself.
pub type Block<const N: usize> = [[f64; N]; N];

/// In which order bodies are eliminated, and which blocks that fills.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// Of each body, its place in the order.
    places: Vec<usize>,
    /// Of each place, where its neighbours that are eliminated later begin in `later`.
    starts: Vec<usize>,
    /// Their places, ascending.
    later: Vec<usize>,
}

impl Pattern {
    /// That of so many bodies, of which these pairs touch; `None` if products of blocks number more than `most`.
    pub fn new(count: usize, pairs: &BTreeSet<[usize; 2]>, most: usize) -> Option<Self> {
        let mut neighbours = vec![Vec::new(); count];
        for &[a, b] in pairs {
            neighbours[a].push(b);
            neighbours[b].push(a);
        }
        neighbours.iter_mut().for_each(|list: &mut Vec<usize>| list.sort_unstable());
        let mut left: BTreeSet<[usize; 2]> = (0..count).map(|body| [neighbours[body].len(), body]).collect();
        let (mut order, mut of_body) = (Vec::with_capacity(count), vec![Vec::new(); count]);
        let mut products = 0;
        while let Some([degree, body]) = left.pop_first() {
            products += degree * degree;
            if products > most {
                return None;
            }
            let own = std::mem::take(&mut neighbours[body]);
            for &other in &own {
                left.remove(&[neighbours[other].len(), other]);
                neighbours[other] = united(&neighbours[other], &own, [body, other]);
                left.insert([neighbours[other].len(), other]);
            }
            order.push(body);
            of_body[body] = own;
        }
        let mut places = vec![0; count];
        order.iter().enumerate().for_each(|(place, &body)| places[body] = place);
        let (mut starts, mut later) = (vec![0], Vec::new());
        for body in order {
            let first = later.len();
            later.extend(of_body[body].iter().map(|&other| places[other]));
            later[first..].sort_unstable();
            starts.push(later.len());
        }
        Some(Pattern { places, starts, later })
    }

    /// The neighbours of a place that are eliminated later.
    fn later(&self, place: usize) -> &[usize] {
        &self.later[self.starts[place]..self.starts[place + 1]]
    }

    /// Where the block of two places stands, the first eliminated earlier.
    fn block(&self, early: usize, late: usize) -> usize {
        let found = self.later(early).binary_search(&late);
        self.starts[early] + found.expect("the pattern has all pairs that touch")
    }
}

/// All that is in one of two ascending lists, but for two entries.
fn united(a: &[usize], b: &[usize], without: [usize; 2]) -> Vec<usize> {
    let (mut all, mut i, mut j) = (Vec::with_capacity(a.len() + b.len()), 0, 0);
    while i < a.len() || j < b.len() {
        let next = match (a.get(i), b.get(j)) {
            (Some(x), Some(y)) => *x.min(y),
            (Some(x), None) | (None, Some(x)) => *x,
            (None, None) => break,
        };
        i += usize::from(a.get(i) == Some(&next));
        j += usize::from(b.get(j) == Some(&next));
        if !without.contains(&next) {
            all.push(next);
        }
    }
    all
}

/// A matrix of such a pattern, and then its factors.
#[derive(Clone, Debug)]
pub struct BlockMatrix<'a, const N: usize> {
    pattern: &'a Pattern,
    /// By place; of the factors their inverses.
    diagonal: Vec<Block<N>>,
    /// Blocks of (early, late) and of (late, early) places.
    upper: Vec<Block<N>>,
    lower: Vec<Block<N>>,
}

impl<'a, const N: usize> BlockMatrix<'a, N> {
    /// One that has these blocks of bodies and of no pairs.
    pub fn new(pattern: &'a Pattern, own: &[Block<N>]) -> Self {
        let mut diagonal = vec![[[0.0; N]; N]; own.len()];
        own.iter().zip(&pattern.places).for_each(|(block, &place)| diagonal[place] = *block);
        let none = vec![[[0.0; N]; N]; pattern.later.len()];
        BlockMatrix { pattern, diagonal, upper: none.clone(), lower: none }
    }

    /// Adds a b^T to the block of two bodies, the first of the rows.
    pub fn add(&mut self, bodies: [usize; 2], a: &[f64; N], b: &[f64; N]) {
        let [row, column] = bodies.map(|body| self.pattern.places[body]);
        let block = match row.cmp(&column) {
            std::cmp::Ordering::Equal => &mut self.diagonal[row],
            std::cmp::Ordering::Less => &mut self.upper[self.pattern.block(row, column)],
            std::cmp::Ordering::Greater => &mut self.lower[self.pattern.block(column, row)],
        };
        for (line, a) in block.iter_mut().zip(a) {
            line.iter_mut().zip(b).for_each(|(x, b)| *x += a * b);
        }
    }

    /// Makes it its factors; says whether there are any.
    pub fn factor(&mut self) -> bool {
        let BlockMatrix { pattern, diagonal, upper, lower } = self;
        for place in 0..diagonal.len() {
            let Some(inverse) = inverse(&diagonal[place]) else { return false };
            diagonal[place] = inverse;
            let (first, later) = (pattern.starts[place], pattern.later(place));
            for block in &mut lower[first..first + later.len()] {
                *block = product(block, &inverse);
            }
            for (i, &early) in later.iter().enumerate() {
                let [left, above] = [lower[first + i], upper[first + i]];
                take_product(&mut diagonal[early], &left, &above);
                // Both lists ascend.
                let mut places = pattern.starts[early]..pattern.starts[early + 1];
                for (j, &late) in later.iter().enumerate().skip(i + 1) {
                    let found = places.find(|&place| pattern.later[place] == late);
                    let block = found.expect("what is left of the neighbours are neighbours of each other");
                    let [beside, right] = [lower[first + j], upper[first + j]];
                    take_product(&mut upper[block], &left, &right);
                    take_product(&mut lower[block], &beside, &above);
                }
            }
        }
        true
    }

    /// A^-1 b, by the factors.
    pub fn solve(&self, b: &[[f64; N]]) -> Vec<[f64; N]> {
        let BlockMatrix { pattern, diagonal, upper, lower } = self;
        let mut x = vec![[0.0; N]; b.len()];
        b.iter().zip(&pattern.places).for_each(|(b, &place)| x[place] = *b);
        for place in 0..x.len() {
            let own = x[place];
            for (i, &row) in pattern.later(place).iter().enumerate() {
                subtract(&mut x[row], &lower[pattern.starts[place] + i], &own);
            }
        }
        for place in (0..x.len()).rev() {
            let mut own = x[place];
            for (j, &column) in pattern.later(place).iter().enumerate() {
                subtract(&mut own, &upper[pattern.starts[place] + j], &x[column]);
            }
            x[place] = times(&diagonal[place], &own);
        }
        pattern.places.iter().map(|&place| x[place]).collect()
    }
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// x -= A y
fn subtract<const N: usize>(x: &mut [f64; N], a: &Block<N>, y: &[f64; N]) {
    x.iter_mut().zip(a).for_each(|(x, line)| *x -= dot(line, y));
}

/// A x
pub fn times<const N: usize>(a: &Block<N>, x: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|k| dot(&a[k], x))
}

#[inline(always)]
fn product<const N: usize>(a: &Block<N>, b: &Block<N>) -> Block<N> {
    let mut c = [[0.0; N]; N];
    for (c, a) in c.iter_mut().zip(a) {
        for (a, b) in a.iter().zip(b) {
            c.iter_mut().zip(b).for_each(|(c, b)| *c += a * b);
        }
    }
    c
}

/// C -= A B
#[inline(always)]
fn take_product<const N: usize>(c: &mut Block<N>, a: &Block<N>, b: &Block<N>) {
    let change = product(a, b);
    for (line, change) in c.iter_mut().zip(&change) {
        line.iter_mut().zip(change).for_each(|(x, change)| *x -= change);
    }
}

/// The inverse of a block, by elimination with the largest entry left of each column; `None` if it has none.
pub fn inverse<const N: usize>(block: &Block<N>) -> Option<Block<N>> {
    let (mut left, mut right) = (*block, [[0.0; N]; N]);
    right.iter_mut().enumerate().for_each(|(i, line)| line[i] = 1.0);
    for k in 0..N {
        let largest = (k..N).max_by(|&i, &j| left[i][k].abs().total_cmp(&left[j][k].abs()))?;
        left.swap(k, largest);
        right.swap(k, largest);
        let scale = 1.0 / left[k][k];
        if !scale.is_finite() {
            return None;
        }
        left[k].iter_mut().chain(&mut right[k]).for_each(|x| *x *= scale);
        let (from, with) = (left[k], right[k]);
        for i in (0..N).filter(|&i| i != k) {
            let factor = left[i][k];
            left[i].iter_mut().zip(&from).for_each(|(x, y)| *x -= factor * y);
            right[i].iter_mut().zip(&with).for_each(|(x, y)| *x -= factor * y);
        }
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ring of bodies with a chord, askew: A x is the b that x was found from.
    #[test]
    fn factors_solve_what_they_are_of() {
        const COUNT: usize = 9;
        let pairs: BTreeSet<[usize; 2]> = (0..COUNT)
            .map(|i| [i, (i + 1) % COUNT])
            .chain([[2, 6]])
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        let pattern = Pattern::new(COUNT, &pairs, usize::MAX).expect("it is small");
        let some = |i: usize, j: usize, k: usize| ((7 * i + 3 * j + 5 * k) as f64).sin();
        let mut all = vec![vec![[[0.0; 3]; 3]; COUNT]; COUNT];
        let own: Vec<Block<3>> = (0..COUNT)
            .map(|i| {
                std::array::from_fn(|j| {
                    std::array::from_fn(|k| some(i, j, k) + if j == k { 6.0 } else { 0.0 })
                })
            })
            .collect();
        let mut matrix = BlockMatrix::new(&pattern, &own);
        own.iter().enumerate().for_each(|(i, block)| all[i][i] = *block);
        for &[a, b] in &pairs {
            for [row, column] in [[a, b], [b, a]] {
                let [u, v]: [[f64; 3]; 2] = [0, 1].map(|s| std::array::from_fn(|k| some(row, column + s, k)));
                matrix.add([row, column], &u, &v);
                all[row][column] = std::array::from_fn(|j| std::array::from_fn(|k| u[j] * v[k]));
            }
        }
        assert!(matrix.factor());
        let wanted: Vec<[f64; 3]> = (0..COUNT).map(|i| std::array::from_fn(|k| some(k, i, 1))).collect();
        let b: Vec<[f64; 3]> = (0..COUNT)
            .map(|i| std::array::from_fn(|k| (0..COUNT).map(|j| dot(&all[i][j][k], &wanted[j])).sum()))
            .collect();
        let found = matrix.solve(&b);
        let off = found.iter().flatten().zip(wanted.iter().flatten()).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-13, "{found:?} {wanted:?}");
    }

    /// A chain of n bodies is eliminated from its ends: n products of blocks, and not n^2.
    #[test]
    fn a_chain_costs_as_much_as_it_has_links() {
        let pairs = (1..1000).map(|i| [i - 1, i]).collect();
        assert!(Pattern::new(1000, &pairs, 999).is_some());
        assert!(Pattern::new(1000, &pairs, 500).is_none());
    }
}
