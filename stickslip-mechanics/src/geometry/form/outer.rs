//! Nodes of little mass follow those near them: extended B-splines (Höllig, Reif and Wipper 2001).

use super::held::{Held, Image, Original, Turned};
use super::linear::solve;
use super::{Form, NoForm, digits};
use crate::tensor::Vector;

/// Nodes with less than this part of a cell's mass follow others. A plain node of tiny mass is thrown by cells by a
/// little impulse, and the surface with it.
const LEAST: f64 = 0.2;

/// Nodes that follow others: x_s = sum e x_m over a few masters m, with sum e = 1 and sum e X_m = X_s.
///
/// The transpose gives the masters the force on a follower, and its mass: f_m += e f_s. So momentum and spin are kept.
#[derive(Clone, Debug, Default)]
pub struct Followers {
    /// The nodes.
    pub nodes: Vec<u32>,
    /// Where the masters of each begin, and where those of the last end.
    pub starts: Vec<u32>,
    /// The masters.
    pub masters: Vec<u32>,
    /// Their shares e [-].
    pub shares: Vec<f64>,
}

impl Followers {
    /// The followers with their masters and shares.
    pub fn iter(&self) -> impl Iterator<Item = (usize, &[u32], &[f64])> {
        (self.nodes.iter().zip(self.starts.windows(2))).map(|(&node, ends)| {
            let all = ends[0] as usize..ends[1] as usize;
            (node as usize, &self.masters[all.clone()], &self.shares[all])
        })
    }

    /// The masters of a node and their shares, if it follows others.
    pub fn of(&self, node: usize) -> Option<(&[u32], &[f64])> {
        let place = self.nodes.binary_search(&(node as u32)).ok()?;
        let all = self.starts[place] as usize..self.starts[place + 1] as usize;
        Some((&self.masters[all.clone()], &self.shares[all]))
    }

    /// Their bytes in memory.
    pub fn bytes(&self) -> usize {
        4 * (self.nodes.len() + self.starts.len() + self.masters.len()) + 8 * self.shares.len()
    }
}

/// Volumes of the masters with those of their followers [m^3, m^2], the followers, and what faces hold.
pub type Shared<const D: usize> = (Vec<f64>, Followers, Option<Box<Held<D>>>);

/// A master of a node, or an image of one.
struct Master<const D: usize> {
    node: usize,
    share: f64,
    turned: Turned,
    /// From the master's place, turned over, to that of the image [m].
    shift: Vector<f64, D>,
}

/// Who follows whom, of nodes that have these volumes or are reached. Nodes behind faces follow their originals.
pub fn follow<const D: usize>(form: &Form<D>, own: &[f64], reached: &[bool]) -> Result<Shared<D>, NoForm> {
    let least = LEAST * form.cell.powi(D as i32);
    let whole = form.whole_volumes(own);
    let leads = |node: usize| whole[node] >= least;
    let mut volumes: Vec<f64> =
        (0..own.len()).map(|node| if leads(node) { own[node] } else { 0.0 }).collect();
    let mut followers = Followers { starts: vec![0], ..Followers::default() };
    let mut held = Held::default();
    for node in 0..own.len() {
        if leads(node) || !(reached[node] || own[node] > 0.0) {
            continue;
        }
        let mut sum = Vector::ZERO;
        for master in masters(form, node, &leads).ok_or(NoForm::Thin(form.cell))? {
            let Master { node: leader, share, turned, shift } = master;
            followers.masters.push(leader as u32);
            followers.shares.push(share);
            volumes[leader] += share * own[node];
            held.turned.push(turned);
            sum += shift * share;
            if turned != Turned::default() {
                let (node, master, volume) = (node as u32, leader as u32, share * own[node]);
                held.images.push(Image { node, master, share, turned, shift, volume });
            }
        }
        held.shifts.push(sum);
        followers.nodes.push(node as u32);
        followers.starts.push(followers.masters.len() as u32);
    }
    Ok((volumes, followers, (!form.faces.is_empty()).then(|| Box::new(held))))
}

/// Shares below this are left out.
const NO_SHARE: f64 = 1e-9;
/// What of the first pivot others must have, for masters to span all directions.
const PIVOT: f64 = 5e-3;

/// Masters of a node and their shares, by moving least squares with linear functions and weights 1/r^6, of those within
/// the smallest reach that tells all directions. An image has those of its original, turned over, or that alone.
fn masters<const D: usize>(
    form: &Form<D>,
    node: usize,
    leads: &dyn Fn(usize) -> bool,
) -> Option<Vec<Master<D>>> {
    let own = form.numbers(node).map(|n| n as isize);
    let Original { at, turned } = form.original(own);
    let original = form.node(at.map(|n| n as usize));
    let turned_over = |(there, share): ([isize; D], f64)| {
        // What lies beside the original one way lies beside its image the other way.
        let image = Vector::from_fn(|a| {
            let arm = there[a] - at[a];
            (if own[a] == at[a] { own[a] + arm } else { own[a] - arm }) as f64
        });
        let leader = form.original(there);
        let turned = leader.turned.and(turned);
        let node = form.node(leader.at.map(|n| n as usize));
        let shift = if turned == Turned::default() {
            Vector::ZERO
        } else {
            form.frame.place(image, form.cell) - turned.of(form.node_place(node))
        };
        Master { node, share, turned, shift }
    };
    if leads(original) {
        return Some(vec![turned_over((at, 1.0))]);
    }
    let mut reach = 1.5;
    while reach < 8.0 {
        let near = near(form, at, reach, leads);
        if near.len() >= D + 2
            && let Some(factors) = factors::<D>(&near)
        {
            let share = |(_, arm, weight): &([isize; D], Vector<f64, D>, f64)| {
                weight * (0..D).fold(factors[0], |sum, a| sum + factors[a + 1] * arm[a])
            };
            let shares = near.iter().map(|master| (master.0, share(master)));
            return Some(shares.filter(|(_, share)| share.abs() > NO_SHARE).map(turned_over).collect());
        }
        reach += 0.25;
    }
    None
}

/// Masters within a reach, and images of some, with their arms from the node and weights [cells].
fn near<const D: usize>(
    form: &Form<D>,
    at: [isize; D],
    reach: f64,
    leads: &dyn Fn(usize) -> bool,
) -> Vec<([isize; D], Vector<f64, D>, f64)> {
    let most = reach as isize;
    let side = (2 * most + 1) as usize;
    let mut found = Vec::new();
    for number in 0..side.pow(D as u32) {
        let arm = digits(number, [side; D]).map(|n| n as isize - most);
        let square = arm.iter().map(|a| a * a).sum::<isize>() as f64;
        let there: [isize; D] = std::array::from_fn(|a| at[a] + arm[a]);
        let original = form.original(there).at;
        if square > reach * reach || (0..D).any(|a| original[a] < 0 || original[a] >= form.counts[a] as isize)
        {
            continue;
        }
        if leads(form.node(original.map(|n| n as usize))) {
            found.push((there, Vector::from_fn(|a| arm[a] as f64), square.powi(-3)));
        }
    }
    found
}

/// c of the shares w (c_0 + c . r) with sum e = 1 and sum e r = 0; `None` where the masters do not span all directions.
fn factors<const D: usize>(near: &[([isize; D], Vector<f64, D>, f64)]) -> Option<[f64; 4]> {
    let mut rows = [[0.0; 5]; 4];
    rows[0][4] = 1.0;
    for (_, arm, weight) in near {
        let p: [f64; 4] = std::array::from_fn(|i| {
            if i == 0 {
                1.0
            } else if i <= D {
                arm[i - 1]
            } else {
                0.0
            }
        });
        for i in 0..=D {
            for j in 0..=D {
                rows[i][j] += weight * p[i] * p[j];
            }
        }
    }
    let least = PIVOT * rows[0][0];
    let found = solve(&mut rows[..=D], least)?;
    Some(std::array::from_fn(|i| found.get(i).copied().unwrap_or(0.0)))
}
