//! What changes in a scene over time, and what that says of the length of steps.
//!
//! Steps end where something turns: at rows of tables, at jumps and kinks of formulas. They are halved, and halved
//! again, where a formula is far from a straight line within them. None is made shorter than [`LEAST_PART`] of itself:
//! what is faster than that is taken by its mean.

use super::TOLERANCE;
use crate::scene::{Action, BodyMotion, Expression, JointKind, Moment, Scene, SupportMotion};
use std::collections::HashSet;

/// No step is cut to less than this part of its length [-].
pub const LEAST_PART: f64 = 0.125;
/// Something that turns more often within a step is noise to it, and taken by its mean.
const MOST_TURNS: usize = 4;
/// Further from a straight line within a step than this part of its largest value, a formula is too fast for it.
const CROOKED: f64 = 0.1;
/// A row of a table at which its slope changes by less than this part of its largest value in a step is none.
const BEND: f64 = 0.02;
/// The same of a formula.
const KINK: f64 = 1e-3;
/// How far from a turn of a formula it is looked at for that [steps].
const BESIDE: f64 = 0.01;
/// A part of a step that is rounding and not time [-].
const ROUNDING: f64 = 1e-6;
/// Enclosures that are looked at for what steps pass over, at most.
const MOST_LOOKS: usize = 20_000;

/// Something that changes in a scene.
#[derive(Clone, Debug)]
pub struct Change {
    /// Path of its key, such as `loads[0].force`.
    pub key: String,
    /// What it says.
    value: Expression,
    /// Its largest value until the end.
    largest: f64,
    /// Whether steps take its mean; else they take what it is at their ends.
    pub is_rate: bool,
}

/// All that changes in a scene, each once.
#[derive(Clone, Debug, Default)]
pub struct Changes(Vec<Change>);

/// What steps pass over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passing<'a> {
    /// What it is.
    pub change: &'a Change,
    /// When [s].
    pub time: f64,
}

impl PartialEq for Change {
    fn eq(&self, other: &Self) -> bool {
        (&self.key, &self.value) == (&other.key, &other.value)
    }
}

impl Changes {
    /// Those of a scene: gravity, loads and supports, prescribed motions, and what joints push with. What comes from
    /// outside is not among them.
    pub fn of(scene: &Scene) -> Self {
        let mut found = Found { end: scene.time.end, taken: HashSet::new(), all: Vec::new() };
        scene.gravity.0.iter().for_each(|value| found.add("gravity", true, value));
        let mut numbers = [0, 0];
        for load in &scene.loads {
            let kind = usize::from(load.is_support());
            let table = format!("{}[{}]", ["loads", "supports"][kind], numbers[kind]);
            numbers[kind] += 1;
            match &load.action {
                Action::Support(support) => {
                    support.motion.iter().flatten().for_each(|motion| match motion {
                        SupportMotion::Displacement(value) => {
                            found.add(&format!("{table}.displacement"), false, value);
                        }
                        SupportMotion::Velocity(value) => {
                            found.add(&format!("{table}.velocity"), true, value)
                        }
                    });
                }
                action => {
                    let is_rate = !matches!(action, Action::Temperature(_));
                    let key = format!("{table}.{}", action.key());
                    action.values().for_each(|value| found.add(&key, is_rate, value));
                }
            }
        }
        for (number, body) in scene.bodies.iter().enumerate() {
            let BodyMotion::Rigid { velocity, spin } = &body.motion else { continue };
            let of = [("velocity", velocity), ("spin", spin)];
            for (key, values) in of {
                let moves = values.iter().filter(|value| value.constant().is_none());
                for value in moves {
                    let key = if matches!(value, Expression::Rate(_)) { "displacement" } else { key };
                    found.add(&format!("bodies[{number}].rigid.{key}"), true, value);
                }
            }
        }
        for (number, joint) in scene.joints.iter().enumerate() {
            let (motor, push) = match &joint.kind {
                JointKind::Hinge { motor, .. } | JointKind::Planar { motor, .. } => (motor, "torque"),
                JointKind::Slider { motor, .. } => (motor, "force"),
                JointKind::Ball { .. } | JointKind::Weld | JointKind::Spring { .. } => continue,
            };
            found.add(&format!("joints[{number}].{push}"), true, &motor.push);
            motor.speed.iter().for_each(|speed| found.add(&format!("joints[{number}].speed"), true, speed));
        }
        Changes(found.all)
    }

    /// Tables whose first row is not before `end` [s], each with the time of its first: of these a run sees the first
    /// value alone.
    pub fn tables_not_begun(&self, end: f64) -> impl Iterator<Item = (&Change, f64)> {
        self.0.iter().filter_map(move |change| {
            let Expression::Table(table) = &change.value else { return None };
            let first = table.rows()[0][0];
            (first >= end).then_some((change, first))
        })
    }

    /// The length of a step from `time` on that would take `longest` [s].
    pub fn step(&self, time: f64, longest: f64) -> f64 {
        let next =
            self.0.iter().filter_map(|change| change.next_turn(time, longest)).fold(f64::NAN, f64::min);
        let way = next - time;
        // Where more than one and less than two steps remain to a turn, they are shared equally; not where an output
        // is due at the same time but for round-off.
        let longest = match way / longest {
            steps if (steps - 1.0).abs() < ROUNDING => longest,
            steps if steps < 1.0 => way,
            steps if steps < 2.0 => 0.5 * way,
            _ => longest,
        };
        self.0.iter().fold(longest, |longest, change| change.bounded(time, longest))
    }

    /// The first of what steps of this length pass over until `end` [s], change by change: what goes and comes back
    /// within the shortest to which they are cut.
    pub fn passed_over(&self, step: f64, end: f64) -> impl Iterator<Item = Passing<'_>> {
        self.0.iter().filter_map(move |change| {
            change.passed_over(LEAST_PART * step, end).map(|time| Passing { change, time })
        })
    }
}

/// What was found so far.
struct Found {
    end: f64,
    taken: HashSet<String>,
    all: Vec<Change>,
}

impl Found {
    /// Whether none like it was found.
    fn is_new(&mut self, is_rate: bool, value: &Expression) -> bool {
        match value {
            Expression::Formula(program) => self.taken.insert(format!("{is_rate} {program:?}")),
            _ => !self.all.iter().any(|other| other.is_rate == is_rate && other.value == *value),
        }
    }

    fn add(&mut self, key: &str, is_rate: bool, value: &Expression) {
        if let Expression::Rate(value) = value {
            return self.add(key, false, value);
        }
        let varies = match value {
            Expression::Constant(_) | Expression::Outside(_) | Expression::Rate(_) => false,
            Expression::Table(table) => table.rows().len() > 1,
            Expression::Formula(program) => program.varies_in_time(),
        };
        if varies && self.is_new(is_rate, value) {
            let course = value.course([0.0, self.end], &Moment::default());
            let looks = (0..=1000).map(|i| value.at(self.end * f64::from(i) / 1000.0).abs());
            let largest = looks.fold(course.low.abs().max(course.high.abs()), f64::max);
            self.all.push(Change { key: key.to_string(), value: value.clone(), largest, is_rate });
        }
    }
}

impl Change {
    /// Where it turns next, if that is not too near for the step and it is no noise to it, within two steps [s].
    fn next_turn(&self, time: f64, longest: f64) -> Option<f64> {
        let (nearest, last) = (time + LEAST_PART * longest, time + 2.0 * longest);
        let mut found = None;
        let mut from = nearest;
        for _ in 0..=MOST_TURNS {
            let Some(turn) = self.value.next_turn([from, last]) else { return found };
            if self.is_sharp(turn, longest) {
                found = found.or(Some(turn));
            }
            // Those behind the step do not matter, nor do those of a table that has one row a step.
            if turn > time + longest {
                return found;
            }
            from = turn;
        }
        // Too many turns to stop at each: at one that is worth it, or not at all.
        None
    }

    /// Whether a turn is worth a step that ends there: steps of other lengths change the energy of what swings, so that
    /// `sin(pi * min(t, 4 ms) / 4 ms)^2`, which is smooth where its parts are not, cuts none.
    fn is_sharp(&self, turn: f64, step: f64) -> bool {
        let Expression::Table(table) = &self.value else {
            let beside = BESIDE * step;
            let [before, here, after] = [turn - beside, turn, turn + beside].map(|time| self.value.at(time));
            let bend = (after - here - (here - before)).abs() / beside;
            return bend.is_nan() || bend * step > KINK * self.largest;
        };
        table.is_lone(turn, step) || table.bend(turn).abs() * step > BEND * self.largest
    }

    /// The longest of a step, its half, quarter and eighth in which it is nearly straight; all of the step, if none is.
    fn bounded(&self, time: f64, longest: f64) -> f64 {
        if !matches!(self.value, Expression::Formula(_)) || !self.value.is_of_time() {
            return longest;
        }
        // What turns within it has been cut there, or is too fast.
        if self.value.next_turn([time, time + longest * (1.0 - TOLERANCE)]).is_some() {
            return longest;
        }
        let parts = [1.0, 0.5, 0.25, LEAST_PART].map(|part| part * longest);
        parts.into_iter().find(|&step| !self.is_crooked([time, time + step])).unwrap_or(longest)
    }

    /// Whether it is far from a straight line within a time.
    fn is_crooked(&self, [from, to]: [f64; 2]) -> bool {
        const PARTS: usize = 8;
        let at = |part: f64| self.value.at(from + (to - from) * part);
        // It may turn where the time begins and ends, to round-off.
        let inner = [TOLERANCE, 1.0 - TOLERANCE].map(|part| from + (to - from) * part);
        let ends = inner.map(|time| self.value.at(time));
        let (mut low, mut high) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
        let mut off = 0.0_f64;
        for i in 1..PARTS {
            let part = i as f64 / PARTS as f64;
            let value = at(part);
            off = off.max((value - ends[0] - (ends[1] - ends[0]) * part).abs());
            (low, high) = (low.min(value), high.max(value));
        }
        let course = self.value.course(inner, &Moment::default());
        let hidden = (course.high - high).max(low - course.low);
        let size = self.largest.max(course.high.abs()).max(course.low.abs());
        off.max(hidden) > CROOKED * size
    }

    /// The first time at which it goes and comes back within a time as short as `least`, until `end` [s].
    fn passed_over(&self, least: f64, end: f64) -> Option<f64> {
        if !self.value.is_of_time() {
            return None;
        }
        let far = CROOKED * self.largest;
        let comes_back = |from: f64, to: f64, peak: f64| {
            let sides = [from, to].map(|t| peak - self.value.at(t.clamp(0.0, end)));
            sides[0] * sides[1] > 0.0 && sides[0].abs().min(sides[1].abs()) > far
        };
        let program = match &self.value {
            Expression::Formula(program) => program,
            Expression::Table(table) => {
                let half = 0.5 * least;
                let is_short = |row: &&[f64; 2]| comes_back(row[0] - half, row[0] + half, row[1]);
                let mut rows = table.rows().iter().filter(|[time, _]| (0.0..=end).contains(time));
                return rows.find(is_short).map(|[time, _]| *time);
            }
            Expression::Constant(_) | Expression::Outside(_) | Expression::Rate(_) => return None,
        };
        let mut rest = vec![[0.0, end]];
        for _ in 0..MOST_LOOKS {
            let [from, to] = rest.pop()?;
            if program.enclosed([from, to]).width() <= far {
                continue;
            }
            let middle = 0.5 * (from + to);
            if to - from > least {
                rest.extend([[middle, to], [from, middle]]);
                continue;
            }
            let course = self.value.course([from, to], &Moment::default());
            let beside = 0.25 * least;
            if [course.high, course.low].into_iter().any(|peak| comes_back(from - beside, to + beside, peak))
            {
                return Some(middle);
            }
        }
        None
    }
}
