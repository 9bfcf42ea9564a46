//! Values over time: their mean over a step, and where they turn.
//!
//! A step takes the mean of what acts in it, so that its impulse is right however short the pulse:
//!
//! ```text
//! mean = 1 / (t1 - t0)  integral of f(t) dt from t0 to t1
//! ```
//! of a table exactly; of a formula by Gauss's rule of three points on pieces that are halved where they must be, to
//! [`TOLERANCE`]. Where that is, two rules that differ tell, and enclosures ([`enclosure`]), which miss neither pulse
//! nor jump.

mod changes;
mod enclosure;
mod slope;
#[cfg(test)]
mod tests;

pub use changes::{Change, Changes, LEAST_PART, Passing};

use super::expression::{Expression, Instruction, Moment, Program, TimeTable, run};
use super::formula::Function;
use enclosure::enclose;

/// Error of the mean of a formula, as a part of its largest value in the step: what the pieces' errors add up to at
/// most, unless there are [`MOST_PIECES`].
pub const TOLERANCE: f64 = 1e-9;
/// Pieces into which a step is cut at most to find the mean of a formula.
pub const MOST_PIECES: usize = 64;
/// How much further than its samples an enclosure may reach, as a part of how far these are apart, and of their size,
/// before a pulse may hide between them.
const REACH: [f64; 2] = [8.0, 0.01];
/// Enclosures that are looked at for the next turn, at most.
const MOST_LOOKS: usize = 2000;
/// A turn is found to this part of the time in which it is looked for.
const SHARPNESS: f64 = 1e-11;

/// Where Gauss's rule of three points looks, from -1 to 1.
pub const GAUSS: [f64; 3] = [-0.774_596_669_241_483_4, 0.0, 0.774_596_669_241_483_4];
/// And with which weights.
pub const WEIGHTS: [f64; 3] = [5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0];
/// Where the rule of two points does, with equal weights.
const PAIR: f64 = 0.577_350_269_189_625_8;

/// What a value is within some time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Course {
    /// Its mean.
    pub mean: f64,
    /// The least that was seen.
    pub low: f64,
    /// The largest that was seen.
    pub high: f64,
}

impl Course {
    fn constant(value: f64) -> Self {
        Course { mean: value, low: value, high: value }
    }
}

impl Expression {
    /// The mean over the time `from` to `to` [s], at the place of a moment; at one time, the value then. What comes
    /// from outside is the mean that the moment has.
    pub fn mean(&self, times: [f64; 2], moment: &Moment) -> f64 {
        self.course(times, moment).mean
    }

    /// The mean over a step of `dt` from `time` on [s], of an expression without place.
    pub fn over_step(&self, time: f64, dt: f64) -> f64 {
        self.mean([time, time + dt], &Moment::default())
    }

    /// What it is within a time, at the place of a moment.
    pub fn course(&self, times: [f64; 2], moment: &Moment) -> Course {
        match self {
            Expression::Constant(value) => Course::constant(*value),
            Expression::Table(table) => table.course(times),
            Expression::Outside(value) => Course::constant(moment.outside[value.component()]),
            Expression::Formula(program) => program.course(times, moment),
            Expression::Rate(value) => Course::constant(value.rate(times, moment)),
        }
    }

    /// How fast it changes: the velocity of a displacement, the mean of which is exact over any time.
    pub fn into_rate(self) -> Expression {
        match self {
            Expression::Constant(_) => Expression::Constant(0.0),
            varies => Expression::Rate(Box::new(varies)),
        }
    }

    /// Its derivative by time at a moment.
    pub(super) fn slope(&self, moment: &Moment) -> f64 {
        match self {
            Expression::Formula(program) => slope::slope(&program.code, moment),
            Expression::Table(table) => table.slope(moment.time),
            // A rate of a rate is not asked for.
            Expression::Constant(_) | Expression::Outside(_) | Expression::Rate(_) => 0.0,
        }
    }

    /// By how much it changes within a time, over that time.
    fn rate(&self, [from, to]: [f64; 2], moment: &Moment) -> f64 {
        let at = |time: f64| self.at_moment(&Moment { time, ..*moment });
        if to > from {
            (at(to) - at(from)) / (to - from)
        } else {
            self.slope(&Moment { time: from, ..*moment })
        }
    }

    /// Whether it says the same at all places.
    pub fn is_of_time(&self) -> bool {
        match self {
            Expression::Constant(_) | Expression::Table(_) => true,
            Expression::Outside(_) => false,
            Expression::Formula(program) => !program.asks(|of| matches!(of, Instruction::Place(_))),
            Expression::Rate(value) => value.is_of_time(),
        }
    }

    /// The first turn after `from` and until `to` [s]: a row of a table, a jump or a kink of a formula, to a billionth
    /// of that time.
    pub fn next_turn(&self, times: [f64; 2]) -> Option<f64> {
        match self {
            Expression::Constant(_) | Expression::Outside(_) => None,
            Expression::Table(table) => table.next_row(times),
            Expression::Formula(program) => program.next_turn(times),
            Expression::Rate(value) => value.next_turn(times),
        }
    }
}

impl TimeTable {
    /// Its exact mean, and what it is at the ends and at rows between them.
    fn course(&self, [from, to]: [f64; 2]) -> Course {
        let rows = self.rows();
        let first = rows.partition_point(|[time, _]| *time <= from);
        let within = rows[first..].iter().take_while(|[time, _]| *time < to);
        let mut course = Course::constant(self.at(from));
        let (mut before, mut sum, mut cut) = ([from, self.at(from)], 0.0, false);
        let mut take = |row: [f64; 2]| {
            sum += (row[0] - before[0]) * (0.5 * (row[1] + before[1]));
            course = Course { low: course.low.min(row[1]), high: course.high.max(row[1]), ..course };
            before = row;
        };
        for &row in within {
            take(row);
            cut = true;
        }
        take([to, self.at(to)]);
        let mean = if cut { sum / (to - from) } else { self.at(0.5 * (from + to)) };
        Course { mean, ..course }
    }

    fn next_row(&self, [from, to]: [f64; 2]) -> Option<f64> {
        let rows = self.rows();
        let next = rows.get(rows.partition_point(|[time, _]| *time <= from))?[0];
        (next <= to).then_some(next)
    }
}

/// A piece of a step.
#[derive(Clone, Copy, Debug, Default)]
struct Piece {
    times: [f64; 2],
    integral: f64,
    error: f64,
}

impl Program {
    fn asks(&self, of: impl Fn(&Instruction) -> bool) -> bool {
        self.code.iter().any(of)
    }

    fn course(&self, times: [f64; 2], moment: &Moment) -> Course {
        let at = |time: f64| run(&self.code, &Moment { time, ..*moment });
        let [from, to] = times;
        if to <= from || !self.asks(|of| matches!(of, Instruction::Time)) {
            return Course::constant(at(from));
        }
        let whole = enclose(&self.code, times, Some(moment));
        if whole.low == whole.high {
            return Course::constant(whole.low);
        }
        let mut course = Course { mean: 0.0, low: f64::INFINITY, high: f64::NEG_INFINITY };
        let mut pieces = [Piece::default(); MOST_PIECES];
        pieces[0] = self.piece(times, moment, &mut course);
        let mut count = 1;
        loop {
            let error = pieces[..count].iter().map(|piece| piece.error).sum::<f64>();
            let allowed = TOLERANCE * (to - from) * course.low.abs().max(course.high.abs());
            // A formula that is no number has no error that is one.
            if error.is_nan() || error <= allowed || count == MOST_PIECES {
                break;
            }
            let worst = (0..count).max_by(|&a, &b| pieces[a].error.total_cmp(&pieces[b].error)).unwrap_or(0);
            let [start, end] = pieces[worst].times;
            let middle = 0.5 * (start + end);
            if middle <= start || end <= middle {
                break;
            }
            pieces[worst] = self.piece([start, middle], moment, &mut course);
            pieces[count] = self.piece([middle, end], moment, &mut course);
            count += 1;
        }
        let sum = pieces[..count].iter().map(|piece| piece.integral).sum::<f64>();
        Course { mean: sum / (to - from), ..course }
    }

    /// The integral over a piece, and how far it may be off.
    fn piece(&self, times: [f64; 2], moment: &Moment, course: &mut Course) -> Piece {
        let [from, to] = times;
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let at = |x: f64| run(&self.code, &Moment { time: middle + half * x, ..*moment });
        let (three, two) = (GAUSS.map(at), [-PAIR, PAIR].map(at));
        let mean = WEIGHTS.iter().zip(three).map(|(weight, value)| weight * value).sum::<f64>();
        let samples = || three.iter().chain(&two).copied();
        let low = samples().fold(f64::INFINITY, f64::min);
        let high = samples().fold(f64::NEG_INFINITY, f64::max);
        (course.low, course.high) = (course.low.min(low), course.high.max(high));
        let all = enclose(&self.code, times, Some(moment));
        let reach = REACH[0] * (high - low) + REACH[1] * low.abs().max(high.abs());
        let is_seen = !all.open && all.width() <= reach;
        let error = if is_seen { (mean - 0.5 * (two[0] + two[1])).abs() } else { all.width() };
        Piece { times, integral: mean * (to - from), error: error * (to - from) }
    }

    fn next_turn(&self, [from, to]: [f64; 2]) -> Option<f64> {
        if !self.asks(Instruction::is_choice) {
            return None;
        }
        let fine = (SHARPNESS * (to - from)).max(8.0 * f64::EPSILON * to.abs());
        // The right halves that are still to be looked at, the next one last.
        let mut rest = [0.0; 64];
        let (mut start, mut end, mut waiting) = (from, to, 0);
        for _ in 0..MOST_LOOKS {
            let is_open = start < end && enclose(&self.code, [start, end], None).open;
            if is_open && end - start > fine && waiting < rest.len() {
                rest[waiting] = end;
                waiting += 1;
                end = 0.5 * (start + end);
                continue;
            }
            let choices = |t: f64| enclose(&self.code, [t, t], None).choices;
            if is_open && choices(start) != choices(end) {
                return Some(end);
            }
            if waiting == 0 {
                return None;
            }
            waiting -= 1;
            (start, end) = (end, rest[waiting]);
        }
        None
    }
}

impl Program {
    /// Whether it says different things at different times.
    fn varies_in_time(&self) -> bool {
        self.asks(|of| matches!(of, Instruction::Time))
    }

    /// What it can be within a time, wherever.
    fn enclosed(&self, times: [f64; 2]) -> enclosure::Enclosure {
        enclose(&self.code, times, None)
    }
}

impl Instruction {
    /// Whether a formula chooses there, so that it may jump or have a kink.
    fn is_choice(&self) -> bool {
        match self {
            Instruction::Less | Instruction::LessOrEqual | Instruction::Equal | Instruction::NotEqual => true,
            Instruction::Call(function) => matches!(
                function,
                Function::Abs
                    | Function::Min
                    | Function::Max
                    | Function::Mod
                    | Function::Floor
                    | Function::Ceil
            ),
            _ => false,
        }
    }
}
