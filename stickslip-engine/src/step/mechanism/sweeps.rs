//! Sweeps over all equations of joints and contacts until they hold.

use super::conjugate::Direction;
use super::direct::{Answer, Direct, FEW_ROUNDS, ROUNDS, Term};
use super::row::{JointRow, Row};
use super::six::{Six, SixMatrix};
use super::touch::{Grip, Touch};
use std::ops::Range;

/// An equation as sweeps see it: of the velocities of a body with those that count alone, three in the plane and six in
/// space.
#[derive(Clone)]
pub struct Packed<const N: usize> {
    /// Places of the free bodies; behind the last one stands all that no impulse moves.
    pub bodies: [usize; 2],
    pub directions: [[f64; N]; 2],
    response: [[f64; N]; 2],
    pub yields: f64,
    off: f64,
    pub impulse: f64,
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
    pub fn give(&self, impulse: f64, changes: &mut [[f64; N]]) {
        for side in 0..2 {
            let change = &mut changes[self.bodies[side]];
            for (change, response) in change.iter_mut().zip(&self.response[side]) {
                *change += impulse * response;
            }
        }
    }

    /// Velocity along it that is too much.
    #[inline(always)]
    pub fn along(&self, changes: &[[f64; N]]) -> f64 {
        let mut along = self.off;
        for side in 0..2 {
            let change = &changes[self.bodies[side]];
            for (change, direction) in change.iter().zip(&self.directions[side]) {
                along += change * direction;
            }
        }
        along
    }

    /// The impulse that leaves no velocity along it, were it the only equation; so much yields count for one.
    #[inline(always)]
    pub fn wanted(&self, changes: &[[f64; N]], yields: f64) -> f64 {
        self.impulse - self.along(changes) / yields
    }
}

/// The contacts of a mechanism: their rows follow those of its joints, the normal and then the others.
pub struct Contacts {
    pub grips: Vec<Grip>,
    /// Rows of each.
    width: usize,
    /// Whether they are those of a packing.
    packed: bool,
    /// How closely their impulses are found.
    tolerance: f64,
}

impl Contacts {
    fn of(touches: &[Touch]) -> Self {
        let width = touches.first().map_or(1, |touch| 1 + touch.tangents.len());
        let (packed, tolerance) = (packed(touches), tolerance(touches));
        Contacts { grips: touches.iter().map(|touch| touch.grip).collect(), width, packed, tolerance }
    }

    /// The rows of a contact, behind so many of joints.
    pub fn rows(&self, joints: usize, contact: usize) -> Range<usize> {
        let first = joints + contact * self.width;
        first..first + self.width
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

    /// Those of all contacts, of so many rows each.
    fn push_all<const N: usize, const ROWS: usize>(
        &mut self,
        grips: &[Grip],
        rows: &mut [Packed<N>],
        changes: &mut [[f64; N]],
    ) {
        for (own, grip) in rows.chunks_exact_mut(ROWS).zip(grips) {
            let own: &mut [Packed<N>; ROWS] = own.try_into().expect("chunks are as long as this");
            if own[0].yields > 0.0 {
                self.push(grip, own, changes);
            }
        }
    }

    /// The impulses of one contact, with all others as they are.
    #[inline(always)]
    fn push<const N: usize>(&mut self, grip: &Grip, rows: &mut [Packed<N>], changes: &mut [[f64; N]]) {
        let Some((normal, tangents)) = rows.split_first_mut() else { return };
        let push = pushed(grip, (normal, normal.yields), changes)[1];
        self.set(normal, push, changes);
        let yields = softest(tangents);
        let open = self.packed && push == 0.0 && tangents.iter().all(|row| row.impulse == 0.0);
        if grip.is_smooth() || yields == 0.0 || open && grip.cohesion == 0.0 && grip.drag == 0.0 {
            return;
        }
        let wanted = wanted_across(tangents, changes, yields);
        let size = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
        let borne = grip.borne(size, (push, yields));
        let scale = if borne < size { borne / size } else { 1.0 };
        for (row, wanted) in tangents.iter_mut().zip(wanted) {
            self.set(row, scale * wanted, changes);
        }
    }
}

/// The normal impulse that lets surfaces part as they should, and that which they bear: a push, or what pull holds them.
#[inline(always)]
fn pushed<const N: usize>(
    grip: &Grip,
    (normal, yields): (&Packed<N>, f64),
    changes: &[[f64; N]],
) -> [f64; 2] {
    let wanted = normal.wanted(changes, yields);
    if wanted > 0.0 || grip.adhesion == 0.0 {
        return [wanted, wanted.max(0.0)];
    }
    [wanted, (wanted - grip.way_in / yields).clamp(-grip.adhesion, 0.0)]
}

/// What the softest of rows yields.
#[inline(always)]
fn softest<const N: usize>(rows: &[Packed<N>]) -> f64 {
    rows.iter().map(|row| row.yields).fold(0.0, f64::max)
}

#[inline(always)]
fn wanted_across<const N: usize>(rows: &[Packed<N>], changes: &[[f64; N]], yields: f64) -> [f64; 2] {
    let mut wanted = [0.0; 2];
    for (wanted, row) in wanted.iter_mut().zip(rows) {
        *wanted = row.wanted(changes, yields);
    }
    wanted
}

impl Contacts {
    /// Impulses that contacts have with these velocities, by the law of sweeps where all yields so much more or less.
    pub fn answer<const N: usize>(
        &self,
        (rows, velocities): (&[Packed<N>], &[[f64; N]]),
        softness: f64,
        answer: &mut Answer,
    ) {
        let joints = rows.len() - self.grips.len() * self.width;
        for (contact, grip) in self.grips.iter().enumerate() {
            let Range { start: normal, end } = self.rows(joints, contact);
            let (first, tangents) = (normal + 1, &rows[normal + 1..end]);
            if rows[normal].yields <= 0.0 {
                continue;
            }
            let soft = softness * rows[normal].yields;
            let [wanted, push] = pushed(grip, (&rows[normal], soft), velocities);
            let held = wanted > 0.0 || -grip.adhesion < push && push < 0.0;
            answer.take(normal, push, if held { 1.0 / soft } else { 0.0 });
            let yields = softness * softest(tangents);
            if grip.is_smooth() || yields == 0.0 {
                (first..end).for_each(|row| answer.take(row, 0.0, 0.0));
                continue;
            }
            let wanted = wanted_across(tangents, velocities, yields);
            let size = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
            let borne = grip.borne(size, (push, yields));
            if borne >= size {
                (first..end).zip(wanted).for_each(|(row, wanted)| answer.take(row, wanted, 1.0 / yields));
                continue;
            }
            let along = wanted.map(|wanted| wanted / size);
            (first..end).zip(along).for_each(|(row, along)| answer.take(row, borne * along, 0.0));
            let (none, last) = ((normal, 0.0), end - 1);
            let share = |k: usize| if k < tangents.len() { along[k] } else { 0.0 };
            let slip = [(first, share(0)), (last, share(1))];
            // It slips by its push, by the slip where that is viscous, and turns.
            let drag = grip.drag * yields;
            if held && push > 0.0 && grip.friction.is_finite() {
                let column =
                    [slip[0], slip[1], none].map(|(row, share)| (row, share * grip.friction / (1.0 + drag)));
                answer.terms.push(Term { weight: 1.0 / soft, column, row: [(normal, 1.0), none] });
            }
            if drag > 0.0 {
                let weight = drag / (1.0 + drag) / yields;
                answer.terms.push(Term { weight, column: [slip[0], slip[1], none], row: slip });
            }
            if tangents.len() > 1 {
                let turn = [(first, -along[1]), (last, along[0])];
                let weight = borne / size / yields;
                answer.terms.push(Term { weight, column: [turn[0], turn[1], none], row: turn });
            }
        }
    }
}

/// Sweeps over all equations at most, after all else; the next step goes on with the impulses of this one.
const MAX_SWEEPS: usize = 200;
/// They end where no impulse changes a velocity by more than this part of the largest change.
const TOLERANCE: f64 = 1e-14;
/// The same where rigid bodies touch: many points of a face share a load in many ways, between which sweeps go on for
/// long. Where they touch at more than a few places it is the second.
const TOUCHING: [f64; 2] = [1e-9, 1e-6];
/// The same at the end of all sweeps, where nothing else led there: what is left over is small against what gravity does
/// in a step, and the next step takes it up; momentum is exact whatever is left.
const AT_LAST: f64 = 1e-5;
/// Sweeps that change this much more than the least go on from where they are, and along no direction.
const STRAYED: f64 = 10.0;
/// In a packing they end where so many of them leave more than this part of what was left before.
const PATIENCE: usize = 40;
const WORTH: f64 = 0.7;
const FEW: usize = 100;
/// Sweeps before the first direct step.
const FIRST_SWEEPS: usize = 12;
const FIRST_PACKED_SWEEPS: usize = 40;
/// Rounds of direct steps at most, all together: so many, but of large systems no more than this many rows can pay.
const MAX_ROUNDS: usize = 100;
const FEWEST_ROUNDS: usize = 10;
const ROWS_OF_ALL_ROUNDS: usize = 30_000;
/// More rows than these are left to sweeps.
const MOST_ROWS: usize = 7_000;
/// In a packing none is tried while sweeps change velocities by more than this part of the largest: then much begins or
/// ends to push or to slip.
const NEARLY: f64 = 5e-5;
/// In a packing a direct step pays that leaves less than this part of what was left before. Where much begins or ends
/// to push or to slip at once, as at an impact, sweeps are as near after the same time.
const PAYS: f64 = 0.7;
/// A direct step may take so many products of blocks a row: then it costs as much as some ten sweeps.
const AFFORDABLE: usize = 40;

/// Whether so many contacts may be those of a packing.
pub fn many(touches: usize) -> bool {
    touches > FEW
}

/// Whether contacts, in the order of pairs, are those of a packing. Faces that bear on each other do not count, as long
/// as they close no ring of free bodies: towers of any height are solved at once for little.
pub fn packed(touches: &[Touch]) -> bool {
    if !many(touches.len()) {
        return false;
    }
    // Of each body one that it hangs together with, up to one that all of them have in common.
    let mut parents: Vec<usize> = Vec::new();
    let of_packing = |pair: &[Touch]| {
        let [Some(a), Some(b)] = pair[0].normal.bodies else { return 0 };
        (parents.len()..=a.max(b)).for_each(|next| parents.push(next));
        let [a, b] = [a, b].map(|mut body| {
            while parents[body] != body {
                parents[body] = parents[parents[body]];
                body = parents[body];
            }
            body
        });
        parents[a] = b;
        if a == b || pair.len() == 1 { pair.len() } else { 0 }
    };
    many(touches.chunk_by(|a, b| a.contact.bodies == b.contact.bodies).map(of_packing).sum())
}

/// How closely the impulses of contacts are found.
pub fn tolerance(touches: &[Touch]) -> f64 {
    match touches {
        [] => TOLERANCE,
        _ => TOUCHING[usize::from(packed(touches))],
    }
}

/// Finds the impulses with which all equations hold, and adds what they change to the bodies' changes of velocity
/// (projected Gauss-Seidel; friction on the disc of De Saxce and Feng 1998; after some sweeps all that holds at once, by
/// [`Direct`], or where that would cost more than sweeps, along conjugate directions from sweep to sweep); says whether
/// they came to rest, down to velocities of `round_off`. `inertia` is that of the bodies with what follows them at the
/// nodes. In the plane, `dimension` 2, bodies move and turn in it.
pub fn solve(
    held: &mut [JointRow],
    touches: &mut [Touch],
    (changes, inertia, dimension): (&mut [Six], &[SixMatrix], usize),
    round_off: f64,
) -> bool {
    match dimension {
        2 => sweep_until::<3>(held, touches, (changes, inertia), round_off),
        _ => sweep_until::<6>(held, touches, (changes, inertia), round_off),
    }
}

/// Impulses and changes of velocities on the way.
#[derive(Clone)]
struct Found<const N: usize> {
    rows: Vec<Packed<N>>,
    changes: Vec<[f64; N]>,
}

impl<const N: usize> Found<N> {
    /// One sweep over the rows of joints and then of contacts.
    fn sweep(&mut self, held: &[JointRow], contacts: &Contacts) -> Sweep {
        let Found { rows, changes } = self;
        let mut sweep = Sweep { packed: contacts.packed, ..Sweep::default() };
        let (of_joints, of_touches) = rows.split_at_mut(held.len());
        for (row, JointRow { limit, .. }) in of_joints.iter_mut().zip(held) {
            if row.yields > 0.0 {
                let wanted = row.wanted(changes, row.yields).clamp(-*limit, *limit);
                sweep.set(row, wanted, changes);
            }
        }
        match contacts.width {
            2 => sweep.push_all::<N, 2>(&contacts.grips, of_touches, changes),
            _ => sweep.push_all::<N, 3>(&contacts.grips, of_touches, changes),
        }
        sweep
    }
}

fn sweep_until<const N: usize>(
    held: &mut [JointRow],
    touches: &mut [Touch],
    (all, inertia): (&mut [Six], &[SixMatrix]),
    round_off: f64,
) -> bool {
    let count = all.len();
    let changes: Vec<[f64; N]> = all.iter().map(pack).chain([[0.0; N]]).collect();
    let rows: Vec<Packed<N>> = (held.iter().map(|held| &held.row))
        .chain(touches.iter().flat_map(Touch::rows))
        .map(|row| Packed::new(row, count))
        .collect();
    let mut found = Found { rows, changes };
    found.rows.iter().for_each(|row| row.give(row.impulse, &mut found.changes));
    let contacts = Contacts::of(touches);
    let rests = found.settle((held, &contacts), inertia, round_off);
    let impulses = found.rows.iter().map(|row| row.impulse);
    let own = held.iter_mut().map(|held| &mut held.row).chain(touches.iter_mut().flat_map(Touch::rows_mut));
    own.zip(impulses).for_each(|(row, impulse)| row.impulse = impulse);
    for (all, change) in all.iter_mut().zip(&found.changes) {
        for (k, change) in change.iter().enumerate() {
            all[if N == 3 { [0, 1, 5][k] } else { k }] = *change;
        }
    }
    rests
}

impl<const N: usize> Found<N> {
    /// Solves until all comes to rest: by some sweeps, then all at once as long as that is worth it, and then by sweeps
    /// again; says whether it did.
    fn settle(
        &mut self,
        (held, contacts): (&[JointRow], &Contacts),
        inertia: &[SixMatrix],
        round_off: f64,
    ) -> bool {
        let touches = contacts.grips.len();
        let Contacts { packed, tolerance: close, .. } = *contacts;
        let first = if packed { FIRST_PACKED_SWEEPS } else { FIRST_SWEEPS };
        let rounds = (ROWS_OF_ALL_ROUNDS / self.rows.len().max(1)).clamp(FEWEST_ROUNDS, MAX_ROUNDS);
        let last = if touches > 0 { close.max(AT_LAST) } else { close };
        let rests = |sweep: &Sweep, tolerance: f64| sweep.moved <= tolerance * sweep.largest + round_off;
        if self.rows.len() > MOST_ROWS {
            return self.sweep_along((held, contacts), MAX_SWEEPS, |sweep| rests(sweep, last));
        }
        if self.sweep_along((held, contacts), first, |sweep| rests(sweep, close)) {
            return true;
        }
        let most = if packed { FEW_ROUNDS } else { ROUNDS };
        let own = inertia.iter().map(SixMatrix::part).collect();
        let sweep = self.sweep(held, contacts);
        let near = !packed || sweep.moved <= NEARLY * sweep.largest;
        let new = || Direct::new(&self.rows, own, (close, AFFORDABLE * self.rows.len()));
        if let Some(mut direct) = near.then(new).flatten() {
            let mut least = sweep.moved;
            let mut best = self.clone();
            while direct.rounds < rounds {
                let before = self.clone();
                let solved = direct.step((&mut self.rows, &mut self.changes), (held, contacts), most);
                if !solved {
                    *self = before;
                }
                let sweep = self.sweep(held, contacts);
                if rests(&sweep, if solved && packed { last } else { close }) {
                    return true;
                }
                let pays = solved && sweep.moved < PAYS * least;
                if sweep.moved < least {
                    (best, least) = (self.clone(), sweep.moved);
                }
                if packed && !pays {
                    break;
                }
            }
            *self = best;
        }
        self.sweep_along((held, contacts), MAX_SWEEPS, |sweep| rests(sweep, last))
    }

    /// So many sweeps at most along conjugate directions; says whether they came to rest.
    fn sweep_along(
        &mut self,
        (held, contacts): (&[JointRow], &Contacts),
        most: usize,
        rests: impl Fn(&Sweep) -> bool,
    ) -> bool {
        let mut direction = Direction::new(self.rows.len(), self.changes.len());
        let (mut impulses, mut changes, mut least) = (Vec::new(), Vec::new(), f64::INFINITY);
        let mut leasts = Vec::new();
        for number in 1..=most {
            impulses.clear();
            impulses.extend(self.rows.iter().map(|row| row.impulse));
            changes.clone_from(&self.changes);
            let sweep = self.sweep(held, contacts);
            if rests(&sweep) {
                return true;
            }
            least = least.min(sweep.moved);
            leasts.push(least);
            if contacts.packed && number > PATIENCE && least > WORTH * leasts[number - 1 - PATIENCE] {
                return false;
            }
            if sweep.moved > STRAYED * least {
                direction.forget();
            } else if number < most {
                // What the last sweep found holds all limits.
                direction.follow((&mut self.rows, &mut self.changes), (&impulses, &changes));
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::super::six::{SixFactor, at, join};
    use super::*;
    use crate::tensor::Matrix;

    const MASS: f64 = 20.0;
    /// What gravity gives in a step [m/s].
    const FALL: f64 = 0.02;

    /// A tower of boxes, 0.2 m by 0.1 m, that touch at their corners and between them: rows of their contacts, from the
    /// floor up, with the bodies' inertia.
    fn tower(count: usize, friction: f64) -> (Vec<Vec<Row>>, Vec<SixMatrix>, Grip) {
        let arm = |body: usize, [x, y]: [f64; 2]| [x, y - 0.1 * body as f64 - 0.05, 0.0];
        let mut all = Vec::new();
        for body in 0..count {
            for x in [-0.1, 0.1, 0.02] {
                let (below, place) = (body.checked_sub(1), [x, 0.1 * body as f64]);
                let row = |way: [f64; 3]| {
                    let other = below.map_or([0.0; 6], |below| at(arm(below, place), way.map(|x| -x)));
                    Row::new([Some(body), below], [at(arm(body, place), way), other])
                };
                all.push(vec![row([0.0, 1.0, 0.0]), row([1.0, 0.0, 0.0])]);
            }
        }
        let turning = Matrix::IDENTITY * (MASS * 0.05 / 12.0);
        let inertia = vec![SixMatrix::inertia(MASS, &turning); count];
        (all, inertia, Grip { friction, ..Grip::default() })
    }

    /// Thirty boxes that fall onto each other from rest: none moves, and each bears the weight above. By sweeps alone
    /// that would take some thousands.
    #[test]
    fn a_tower_bears_its_weight_in_one_step() {
        let count = 30;
        let (all, inertia, grip) = tower(count, 0.5);
        let factors: Vec<SixFactor> = inertia.iter().map(SixMatrix::factor).collect();
        let rows = all.into_iter().flatten().map(|mut row| {
            row.respond(&factors);
            Packed::<3>::new(&row, count)
        });
        let mut changes = vec![pack(&join([0.0, -FALL, 0.0], [0.0; 3])); count];
        changes.push([0.0; 3]);
        let mut found = Found { rows: rows.collect(), changes };
        let contacts =
            Contacts { grips: vec![grip; 3 * count], width: 2, packed: false, tolerance: TOUCHING[0] };
        assert!(found.settle((&[], &contacts), &inertia, 0.0), "it does not rest");
        let fastest = found.changes.iter().flatten().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(fastest < 1e-4 * FALL, "{fastest}");
        for (body, own) in found.rows.chunks_exact(6).enumerate() {
            let push: f64 = own.iter().step_by(2).map(|row| row.impulse).sum();
            let weight = (count - body) as f64 * MASS * FALL;
            assert!((push / weight - 1.0).abs() < 1e-4, "box {body}: {push} of {weight}");
        }
    }

    /// The impulses of a direct step are those of sweeps without end: a box that is pushed, slips and tips.
    #[test]
    fn a_direct_step_finds_what_sweeps_find() {
        for (push, spin) in [(0.0, 0.0), (0.03, 0.0), (0.5, 0.0), (0.01, 0.4)] {
            let (all, inertia, grip) = tower(1, 0.3);
            let factors: Vec<SixFactor> = inertia.iter().map(SixMatrix::factor).collect();
            let rows = all.into_iter().flatten().map(|mut row| {
                row.respond(&factors);
                Packed::<3>::new(&row, 1)
            });
            let begun = Found { rows: rows.collect(), changes: vec![[push, -FALL, spin], [0.0; 3]] };
            let contacts = Contacts { grips: vec![grip; 3], width: 2, packed: false, tolerance: TOUCHING[0] };
            let (mut swept, mut solved) = (begun.clone(), begun);
            for _ in 0..20_000 {
                swept.sweep(&[], &contacts);
            }
            assert!(solved.settle((&[], &contacts), &inertia, 0.0));
            for (a, b) in swept.changes[0].iter().zip(&solved.changes[0]) {
                assert!(
                    (a - b).abs() < 1e-8 * FALL,
                    "{push} {spin}: {:?} {:?}",
                    swept.changes,
                    solved.changes
                );
            }
        }
    }
}
