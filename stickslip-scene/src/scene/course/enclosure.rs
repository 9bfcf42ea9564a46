//! What a formula can be within some time: interval arithmetic (Moore 1966) on its instructions.
//!
//! A point of time tells nothing of what lies beside it. An enclosure does: no pulse and no jump within the time is
//! missed, however short. It may be wider than what the formula really is, less so the shorter the time.

use crate::scene::expression::{HIGHEST, Instruction, Moment, WELL_FORMED};
use crate::scene::formula::Function;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What a number of a formula can be within some time.
#[derive(Clone, Copy, Debug, Default)]
pub struct Enclosure {
    /// No less than this.
    pub low: f64,
    /// No more.
    pub high: f64,
    /// Whether a choice in it may turn within the time: a comparison, the smaller of two, a sign, a whole number.
    pub open: bool,
    /// The choices that do not, in one number.
    pub choices: u64,
    /// Whether it depends on a place that nobody says.
    anywhere: bool,
}

/// Encloses what the code of a formula leaves within the times `from` to `to` [s], at the place of a moment or, without
/// one, wherever.
pub fn enclose(code: &[Instruction], [from, to]: [f64; 2], place: Option<&Moment>) -> Enclosure {
    let mut stack = [Enclosure::default(); HIGHEST];
    let mut height = 0;
    for instruction in code {
        let mut pop = || {
            height = usize::checked_sub(height, 1).expect(WELL_FORMED);
            stack[height]
        };
        let value = match *instruction {
            Instruction::Push(value) => Enclosure::point(value),
            Instruction::Time => Enclosure::between(from, to),
            Instruction::Place(which) => match place {
                Some(moment) if which < 3 => Enclosure::point(moment.place[which]),
                Some(moment) => Enclosure::point(moment.start[which - 3]),
                None => Enclosure { anywhere: true, ..Enclosure::ANY },
            },
            Instruction::Negate => {
                let a = pop();
                Enclosure { low: -a.high, high: -a.low, ..a }
            }
            Instruction::Call(function) if function.arguments() == 1 => pop().function(function),
            Instruction::Choose => {
                let (otherwise, then, condition) = (pop(), pop(), pop());
                condition.choose(then, otherwise)
            }
            binary => {
                let (b, a) = (pop(), pop());
                a.binary(binary, b)
            }
        };
        stack[height] = value;
        height += 1;
    }
    assert!(height == 1, "{WELL_FORMED}");
    stack[0]
}

impl Enclosure {
    /// Any number.
    const ANY: Enclosure =
        Enclosure { low: f64::NEG_INFINITY, high: f64::INFINITY, open: false, choices: 0, anywhere: false };

    fn point(value: f64) -> Self {
        Enclosure::between(value, value)
    }

    fn between(low: f64, high: f64) -> Self {
        Enclosure { low, high, ..Enclosure::default() }
    }

    /// How far its ends are apart.
    pub fn width(&self) -> f64 {
        self.high - self.low
    }

    fn is_point(&self) -> bool {
        self.low == self.high
    }

    /// What follows from two of them.
    fn of(a: Enclosure, b: Enclosure, [low, high]: [f64; 2]) -> Self {
        // inf - inf and 0 inf can be anything.
        let [low, high] = match low.is_nan() || high.is_nan() {
            true => [f64::NEG_INFINITY, f64::INFINITY],
            false => [low, high],
        };
        Enclosure {
            low,
            high,
            open: a.open || b.open,
            choices: mixed(a.choices, b.choices),
            anywhere: a.anywhere || b.anywhere,
        }
    }

    /// Takes note of a choice: which it is, or that it turns.
    fn chosen(self, which: Option<u64>) -> Self {
        match which {
            Some(which) => Enclosure { choices: mixed(self.choices, which), ..self },
            // Where a front is depends on the place: it is somewhere always.
            None => Enclosure { open: self.open || !self.anywhere, ..self },
        }
    }

    /// The numbers between the least and the largest of some, which those of `a` and `b` lie between.
    fn around<const N: usize>(a: Enclosure, b: Enclosure, corners: [f64; N]) -> Self {
        let any = if corners.iter().any(|corner| corner.is_nan()) { f64::NAN } else { 0.0 };
        let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
        let high = corners.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Enclosure::of(a, b, [low + any, high + any])
    }

    /// What a function that rises with each number, or falls, makes of two.
    fn corners(self, b: Enclosure, of: impl Fn(f64, f64) -> f64) -> Self {
        let corners =
            [of(self.low, b.low), of(self.low, b.high), of(self.high, b.low), of(self.high, b.high)];
        Enclosure::around(self, b, corners)
    }

    fn binary(self, instruction: Instruction, b: Enclosure) -> Self {
        let a = self;
        match instruction {
            Instruction::Add => Enclosure::of(a, b, [a.low + b.low, a.high + b.high]),
            Instruction::Subtract => Enclosure::of(a, b, [a.low - b.high, a.high - b.low]),
            Instruction::Multiply => a.corners(b, |a, b| a * b),
            Instruction::Divide if b.low > 0.0 || b.high < 0.0 || b.is_point() => a.corners(b, |a, b| a / b),
            Instruction::Divide => Enclosure::of(a, b, [f64::NAN; 2]),
            Instruction::Power => a.power(b),
            Instruction::Less => a.compared(b, [a.high < b.low, a.low >= b.high]),
            Instruction::LessOrEqual => a.compared(b, [a.high <= b.low, a.low > b.high]),
            Instruction::Equal | Instruction::NotEqual => {
                let apart = a.high < b.low || a.low > b.high;
                let same = a.is_point() && b.is_point() && !apart;
                let is = if instruction == Instruction::Equal { [same, apart] } else { [apart, same] };
                a.compared(b, is)
            }
            Instruction::Call(Function::Min) => {
                let which = [a.high <= b.low, b.high <= a.low];
                a.picked(b, (which, [a.low.min(b.low), a.high.min(b.high)]))
            }
            Instruction::Call(Function::Max) => {
                let which = [b.high <= a.low, a.high <= b.low];
                a.picked(b, (which, [a.low.max(b.low), a.high.max(b.high)]))
            }
            Instruction::Call(Function::Mod) => a.remainder(b),
            Instruction::Call(Function::Atan2) if b.low > 0.0 || a.is_point() && b.is_point() => {
                a.corners(b, |a, b| Function::Atan2.of(a, b))
            }
            Instruction::Call(_) => Enclosure::of(a, b, [-PI, PI]),
            _ => unreachable!("all instructions of two numbers are matched above"),
        }
    }

    /// Whether something is so: surely, surely not, or yes and no.
    fn compared(self, b: Enclosure, [yes, no]: [bool; 2]) -> Self {
        match (yes, no) {
            (true, _) => Enclosure { anywhere: false, ..Enclosure::of(self, b, [1.0; 2]).chosen(Some(1)) },
            (_, true) => Enclosure { anywhere: false, ..Enclosure::of(self, b, [0.0; 2]).chosen(Some(2)) },
            _ => Enclosure::of(self, b, [0.0, 1.0]).chosen(None),
        }
    }

    /// The one of two that is picked, or what both can be.
    fn picked(self, b: Enclosure, ([first, second], both): ([bool; 2], [f64; 2])) -> Self {
        match (first, second) {
            (true, _) => self.chosen(Some(1)),
            (_, true) => b.chosen(Some(2)),
            _ => Enclosure::of(self, b, both).chosen(None),
        }
    }

    fn choose(self, then: Enclosure, otherwise: Enclosure) -> Self {
        let branch = match self.is_point() {
            true if self.low != 0.0 => then,
            true => otherwise,
            false => {
                Enclosure::of(then, otherwise, [then.low.min(otherwise.low), then.high.max(otherwise.high)])
            }
        };
        Enclosure::of(self, branch, [branch.low, branch.high])
    }

    fn power(self, b: Enclosure) -> Self {
        let (a, n) = (self, b.low);
        if a.low > 0.0 {
            return a.corners(b, libm::pow);
        }
        if !b.is_point() {
            return Enclosure::of(a, b, [f64::NAN; 2]);
        }
        let through_zero = a.low <= 0.0 && a.high >= 0.0;
        let ends = [libm::pow(a.low, n), libm::pow(a.high, n)];
        match n % 2.0 {
            _ if n < 0.0 && through_zero => Enclosure::of(a, b, [f64::NAN; 2]),
            0.0 if through_zero && n != 0.0 => Enclosure::around(a, b, [0.0, ends[0], ends[1]]),
            1.0 | -1.0 | 0.0 => Enclosure::around(a, b, ends),
            // Of negative numbers it has no value.
            _ => Enclosure::around(a, b, [libm::pow(a.low.max(0.0), n), libm::pow(a.high.max(0.0), n)]),
        }
    }

    /// a - b floor(a / b)
    fn remainder(self, b: Enclosure) -> Self {
        let a = self;
        let turns = [libm::floor(a.low / b.low), libm::floor(a.high / b.low)];
        if b.is_point() && turns[0] == turns[1] {
            let [p, q] = [a.low, a.high].map(|a| a - b.low * turns[0]);
            return Enclosure::of(a, b, [p.min(q), p.max(q)]).chosen(Some(turns[0].to_bits()));
        }
        Enclosure::of(a, b, [b.low.min(0.0), b.high.max(0.0)]).chosen(None)
    }

    fn whole(self, round: fn(f64) -> f64) -> Self {
        let [low, high] = [round(self.low), round(self.high)];
        let of = Enclosure { low, high, ..self };
        of.chosen((low == high).then_some(low.to_bits()))
    }

    fn function(self, function: Function) -> Self {
        let Enclosure { low, high, .. } = self;
        let ends = [low, high];
        let rising = |[low, high]: [f64; 2]| {
            Enclosure::around(self, Enclosure::default(), [function.of(low, 0.0), function.of(high, 0.0)])
        };
        match function {
            Function::Sin => self.wave(function, FRAC_PI_2),
            Function::Cos => self.wave(function, 0.0),
            Function::Tan => {
                let branch = ends.map(|x| libm::floor(x / PI + 0.5));
                match branch[0] == branch[1] {
                    true => rising(ends),
                    false => Enclosure::of(self, Enclosure::default(), [f64::NAN; 2]),
                }
            }
            Function::Asin | Function::Acos => rising(ends.map(|x| x.clamp(-1.0, 1.0))),
            Function::Sqrt | Function::Ln => rising(ends.map(|x| x.max(0.0))),
            Function::Atan | Function::Exp => rising(ends),
            Function::Abs if low < 0.0 && high > 0.0 => {
                Enclosure { low: 0.0, high: high.max(-low), ..self }.chosen(None)
            }
            Function::Abs => rising(ends).chosen(Some(u64::from(low < 0.0) + 1)),
            Function::Floor => self.whole(libm::floor),
            Function::Ceil => self.whole(libm::ceil),
            Function::Atan2 | Function::Min | Function::Max | Function::Mod => {
                unreachable!("functions of two numbers are instructions of two")
            }
        }
    }

    /// A wave between -1 and 1 with its first crest at this phase [rad].
    fn wave(self, function: Function, crest: f64) -> Self {
        // Whether one of `first` + n 2 pi lies within.
        let meets = |first: f64| {
            let turns = |x: f64| libm::floor((x - first) / TAU);
            turns(self.low) < turns(self.high)
        };
        let [a, b] = [self.low, self.high].map(|x| function.of(x, 0.0));
        let high = if meets(crest) { 1.0 } else { a.max(b) };
        let low = if meets(crest + PI) { -1.0 } else { a.min(b) };
        let [low, high] = if self.width() < TAU { [low, high] } else { [-1.0, 1.0] };
        Enclosure { low, high, ..self }
    }
}

/// Two numbers in one.
fn mixed(a: u64, b: u64) -> u64 {
    if b == 0 {
        return a;
    }
    (a.rotate_left(5) ^ b).wrapping_mul(0x9e37_79b9_7f4a_7c15)
}
