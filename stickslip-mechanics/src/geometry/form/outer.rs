//! Nodes of little mass follow those near them: extended B-splines (Höllig, Reif and Wipper 2001).

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

    /// Their bytes in memory.
    pub fn bytes(&self) -> usize {
        4 * (self.nodes.len() + self.starts.len() + self.masters.len()) + 8 * self.shares.len()
    }
}

/// Who follows whom, of nodes that have these volumes or are reached, and the volumes of the masters with those of
/// their followers.
pub fn follow<const D: usize>(
    form: &Form<D>,
    own: &[f64],
    reached: &[bool],
) -> Result<(Vec<f64>, Followers), NoForm> {
    let least = LEAST * form.cell.powi(D as i32);
    let leads = |node: usize| own[node] >= least;
    let mut volumes: Vec<f64> =
        own.iter().map(|&volume| if volume >= least { volume } else { 0.0 }).collect();
    let mut followers = Followers { starts: vec![0], ..Followers::default() };
    for node in 0..own.len() {
        if leads(node) || !(reached[node] || own[node] > 0.0) {
            continue;
        }
        let masters = masters(form, node, &leads).ok_or(NoForm::Thin(form.cell))?;
        for (master, share) in masters {
            followers.masters.push(master as u32);
            followers.shares.push(share);
            volumes[master] += share * own[node];
        }
        followers.nodes.push(node as u32);
        followers.starts.push(followers.masters.len() as u32);
    }
    Ok((volumes, followers))
}

/// Shares below this are left out.
const NO_SHARE: f64 = 1e-9;
/// What of the first pivot others must have, for masters to span all directions.
const PIVOT: f64 = 5e-3;

/// Masters of a node and their shares, by moving least squares with linear functions and weights 1/r^6, of those within
/// the smallest reach that tells all directions.
fn masters<const D: usize>(
    form: &Form<D>,
    node: usize,
    leads: &dyn Fn(usize) -> bool,
) -> Option<Vec<(usize, f64)>> {
    let at = form.numbers(node);
    let mut reach = 1.5;
    while reach < 8.0 {
        let near = near(form, at, reach, leads);
        if near.len() >= D + 2
            && let Some(factors) = factors::<D>(&near)
        {
            let share = |(_, arm, weight): &(usize, Vector<f64, D>, f64)| {
                weight * (0..D).fold(factors[0], |sum, a| sum + factors[a + 1] * arm[a])
            };
            let shares = near.iter().map(|master| (master.0, share(master)));
            return Some(shares.filter(|(_, share)| share.abs() > NO_SHARE).collect());
        }
        reach += 0.25;
    }
    None
}

/// Masters within a reach, with their arms from the node and weights [cells].
fn near<const D: usize>(
    form: &Form<D>,
    at: [usize; D],
    reach: f64,
    leads: &dyn Fn(usize) -> bool,
) -> Vec<(usize, Vector<f64, D>, f64)> {
    let most = reach as isize;
    let side = (2 * most + 1) as usize;
    let mut found = Vec::new();
    for number in 0..side.pow(D as u32) {
        let arm = digits(number, [side; D]).map(|n| n as isize - most);
        let square = arm.iter().map(|a| a * a).sum::<isize>() as f64;
        let there: [isize; D] = std::array::from_fn(|a| at[a] as isize + arm[a]);
        if square > reach * reach || (0..D).any(|a| there[a] < 0 || there[a] >= form.counts[a] as isize) {
            continue;
        }
        let node = form.node(there.map(|n| n as usize));
        if leads(node) {
            found.push((node, Vector::from_fn(|a| arm[a] as f64), square.powi(-3)));
        }
    }
    found
}

/// c of the shares w (c_0 + c . r) with sum e = 1 and sum e r = 0; `None` where the masters do not span all directions.
fn factors<const D: usize>(near: &[(usize, Vector<f64, D>, f64)]) -> Option<[f64; 4]> {
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
