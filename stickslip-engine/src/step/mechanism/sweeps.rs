//! Sweeps over all equations of joints and contacts until they hold.

use super::row::{JointRow, Row};
use super::six::Six;
use super::touch::Touch;

/// An equation as sweeps see it: of the velocities of a body with those that count alone, three in the plane and six in
/// space.
struct Packed<const N: usize> {
    /// Places of the free bodies; behind the last one stands all that no impulse moves.
    bodies: [usize; 2],
    directions: [[f64; N]; 2],
    response: [[f64; N]; 2],
    yields: f64,
    off: f64,
    impulse: f64,
}

/// What a body has of a vector of six: all of it, or what there is of it in the plane.
fn pack<const N: usize>(six: &Six) -> [f64; N] {
    std::array::from_fn(|k| six[if N == 3 { [0, 1, 5][k] } else { k }])
}

impl<const N: usize> Packed<N> {
    fn new(row: &Row, count: usize) -> Self {
        Packed {
            bodies: row.bodies.map(|body| body.unwrap_or(count)),
            directions: row.directions.each_ref().map(pack),
            response: [0, 1]
                .map(|side| if row.bodies[side].is_some() { pack(&row.response[side]) } else { [0.0; N] }),
            yields: row.yields,
            off: row.off,
            impulse: row.impulse,
        }
    }

    /// Adds what an impulse changes.
    #[inline(always)]
    fn give(&self, impulse: f64, changes: &mut [[f64; N]]) {
        for side in 0..2 {
            let change = &mut changes[self.bodies[side]];
            for (change, response) in change.iter_mut().zip(&self.response[side]) {
                *change += impulse * response;
            }
        }
    }

    /// The impulse that leaves no velocity along it, were it the only equation; so much yields count for one.
    #[inline(always)]
    fn wanted(&self, changes: &[[f64; N]], yields: f64) -> f64 {
        let mut along = self.off;
        for side in 0..2 {
            let change = &changes[self.bodies[side]];
            for (change, direction) in change.iter().zip(&self.directions[side]) {
                along += change * direction;
            }
        }
        self.impulse - along / yields
    }
}

/// What a sweep over all equations changed.
#[derive(Default)]
struct Sweep {
    /// Whether its contacts are those of a packing.
    packed: bool,
    /// The largest change of a velocity, and the largest velocity that an impulse makes.
    moved: f64,
    largest: f64,
}

impl Sweep {
    #[inline(always)]
    fn set<const N: usize>(&mut self, row: &mut Packed<N>, impulse: f64, changes: &mut [[f64; N]]) {
        let change = impulse - row.impulse;
        row.impulse = impulse;
        row.give(change, changes);
        self.moved = self.moved.max((change * row.yields).abs());
        self.largest = self.largest.max((impulse * row.yields).abs()).max(row.off.abs());
    }

    /// The impulses of one contact, with all others as they are.
    #[inline(always)]
    fn push<const N: usize>(&mut self, friction: f64, rows: &mut [Packed<N>], changes: &mut [[f64; N]]) {
        let Some((normal, tangents)) = rows.split_first_mut() else { return };
        let push = normal.wanted(changes, normal.yields).max(0.0);
        self.set(normal, push, changes);
        let strength = if push > 0.0 { friction * push } else { 0.0 };
        let yields = tangents.iter().map(|row| row.yields).fold(0.0, f64::max);
        let open = self.packed && push == 0.0 && tangents.iter().all(|row| row.impulse == 0.0);
        if friction == 0.0 || yields == 0.0 || open {
            return;
        }
        let mut wanted = [0.0; 2];
        for (wanted, row) in wanted.iter_mut().zip(tangents.iter()) {
            *wanted = row.wanted(changes, yields);
        }
        let size = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
        let scale = if size > strength { strength / size } else { 1.0 };
        for (row, wanted) in tangents.iter_mut().zip(wanted) {
            self.set(row, scale * wanted, changes);
        }
    }
}

/// What sweeps are heading for: the direction of the nonsmooth nonlinear conjugate gradient method.
///
/// A sweep's change of the impulses is its steepest descent -g. With the direction p of the sweep before,
///
/// ```text
/// b = |g|^2 / |g_before|^2,     l <- l + b p,   p <- b p - g         where b <= 1;  else p <- 0
/// ```
/// (Silcowitz, Niebe and Erleben 2010). The norm is that of energy, sum l^2 / m, and the velocities change with the
/// impulses.
struct Direction<const N: usize> {
    impulses: Vec<f64>,
    changes: Vec<[f64; N]>,
    /// |g_before|^2 [J]; none before the first sweep.
    square: Option<f64>,
}

impl<const N: usize> Direction<N> {
    fn new(rows: usize, bodies: usize) -> Self {
        Direction { impulses: vec![0.0; rows], changes: vec![[0.0; N]; bodies], square: None }
    }

    /// Goes on along it after a sweep that began with these impulses and changes.
    fn follow(
        &mut self,
        (rows, changes): (&mut [Packed<N>], &mut [[f64; N]]),
        (begun, begun_changes): (&[f64], &[[f64; N]]),
    ) {
        let squares = rows.iter().zip(begun).map(|(row, begun)| (row.impulse - begun).powi(2) * row.yields);
        let square = squares.sum::<f64>();
        let share = self.square.map_or(0.0, |before| if before > 0.0 { square / before } else { 0.0 });
        self.square = Some(square);
        if share > 1.0 {
            self.impulses.fill(0.0);
            self.changes.fill([0.0; N]);
            return;
        }
        for ((row, begun), along) in rows.iter_mut().zip(begun).zip(&mut self.impulses) {
            let descent = row.impulse - begun;
            row.impulse += share * *along;
            *along = share * *along + descent;
        }
        for ((change, begun), along) in changes.iter_mut().zip(begun_changes).zip(&mut self.changes) {
            for k in 0..N {
                let descent = change[k] - begun[k];
                change[k] += share * along[k];
                along[k] = share * along[k] + descent;
            }
        }
    }
}

/// Sweeps over all equations at most, and over those of a packing: its next step goes on with the impulses of this one.
const MAX_SWEEPS: usize = 2000;
const MAX_PACKED_SWEEPS: usize = 200;
/// They end where no impulse changes a velocity by more than this part of the largest change.
const TOLERANCE: f64 = 1e-14;
/// The same where rigid bodies touch: many points of a face share a load in many ways, between which sweeps go on for
/// long.
const TOUCHING: f64 = 1e-9;
/// The same where they touch at more places than these. What is left over is small against what gravity does in a step,
/// and the next step, which begins with these impulses, takes it up; momentum is exact whatever is left.
const PACKED: f64 = 1e-5;
const FEW: usize = 100;

/// Whether so many contacts are those of a packing.
pub fn packed(touches: usize) -> bool {
    touches > FEW
}

/// Where sweeps end that find the impulses of so many contacts.
pub fn tolerance(touches: usize) -> f64 {
    match touches {
        0 => TOLERANCE,
        1..=FEW => TOUCHING,
        _ => PACKED,
    }
}

/// Finds the impulses with which all equations hold, and adds what they change to the bodies' changes of velocity
/// (projected Gauss-Seidel; friction on the disc of De Saxce and Feng 1998; of many contacts along conjugate
/// directions from sweep to sweep); says whether they came to rest, down to velocities of `round_off`. In the plane,
/// `dimension` 2, bodies move and turn in it.
pub fn solve(
    held: &mut [JointRow],
    touches: &mut [Touch],
    (changes, dimension): (&mut [Six], usize),
    round_off: f64,
) -> bool {
    match dimension {
        2 => sweep_until::<3>(held, touches, changes, round_off),
        _ => sweep_until::<6>(held, touches, changes, round_off),
    }
}

fn sweep_until<const N: usize>(
    held: &mut [JointRow],
    touches: &mut [Touch],
    all: &mut [Six],
    round_off: f64,
) -> bool {
    let count = all.len();
    let mut changes: Vec<[f64; N]> = all.iter().map(pack).chain([[0.0; N]]).collect();
    let mut rows: Vec<Packed<N>> = (held.iter().map(|held| &held.row))
        .chain(touches.iter().flat_map(Touch::rows))
        .map(|row| Packed::new(row, count))
        .collect();
    rows.iter().for_each(|row| row.give(row.impulse, &mut changes));
    let tolerance = tolerance(touches.len());
    let packed = packed(touches.len());
    let width = touches.first().map_or(1, |touch| 1 + touch.tangents.len());
    let frictions: Vec<f64> = touches.iter().map(|touch| touch.friction).collect();
    let most = if packed { MAX_PACKED_SWEEPS } else { MAX_SWEEPS };
    let mut direction = Direction::new(rows.len(), changes.len());
    let (mut begun, mut begun_changes) = (Vec::new(), Vec::new());
    let mut rests = false;
    for number in 1..=most {
        if packed {
            begun.clear();
            begun.extend(rows.iter().map(|row| row.impulse));
            begun_changes.clone_from(&changes);
        }
        let mut sweep = Sweep { packed, ..Sweep::default() };
        let (of_joints, of_touches) = rows.split_at_mut(held.len());
        for (row, JointRow { limit, .. }) in of_joints.iter_mut().zip(&*held) {
            if row.yields > 0.0 {
                let wanted = row.wanted(&changes, row.yields).clamp(-*limit, *limit);
                sweep.set(row, wanted, &mut changes);
            }
        }
        for (own, friction) in of_touches.chunks_exact_mut(width).zip(&frictions) {
            if own[0].yields > 0.0 {
                sweep.push(*friction, own, &mut changes);
            }
        }
        rests = sweep.moved <= tolerance * sweep.largest + round_off;
        if rests {
            break;
        }
        // What the last sweep found holds all limits.
        if packed && number < most {
            direction.follow((&mut rows, &mut changes), (&begun, &begun_changes));
        }
    }
    let impulses = rows.iter().map(|row| row.impulse);
    let own = held.iter_mut().map(|held| &mut held.row).chain(touches.iter_mut().flat_map(Touch::rows_mut));
    own.zip(impulses).for_each(|(row, impulse)| row.impulse = impulse);
    for (all, change) in all.iter_mut().zip(&changes) {
        for (k, change) in change.iter().enumerate() {
            all[if N == 3 { [0, 1, 5][k] } else { k }] = *change;
        }
    }
    rests
}
