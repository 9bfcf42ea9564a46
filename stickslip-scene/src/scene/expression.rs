//! Formulas in scene files.

use super::formula::{DEEPEST, Function};
use super::outside::OutsideValue;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// A number that may depend on time, and in loads on place: `"5 m/s * min(t / 1 ms, 1)"`, compiled.
///
/// Free variables are `t`, the simulated time in seconds, and where a place is known `x` to `z` and `x0` to `z0` in
/// metres; parameters and units are already resolved to SI. Serialised, it is the number, the text of the formula, the
/// table, or the name of what comes from outside.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// The same number always.
    Constant(f64),
    /// A formula with `t` or a place in it.
    Formula(Box<Program>),
    /// Values at times.
    Table(TimeTable),
    /// A component of what a function from outside says, of the one that is in [`Moment::outside`].
    Outside(OutsideValue),
    /// How fast another changes, which comes not from outside.
    Rate(Box<Expression>),
}

/// Names of the coordinates that formulas of place know: of a point now, and of the same point at the start.
pub(super) const PLACE: [&str; 6] = ["x", "y", "z", "x0", "y0", "z0"];

/// What the free variables of formulas stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moment {
    /// Simulated time [s].
    pub time: f64,
    /// Where a point is [m].
    pub place: [f64; 3],
    /// Where it was at the start [m].
    pub start: [f64; 3],
    /// What the function from outside said, if there is one.
    pub outside: [f64; 3],
}

/// Values at times, straight lines in between, and before the first and after the last time the value there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TimeTable {
    /// Times [s], ascending, each with its value in SI units.
    table: Vec<[f64; 2]>,
}

impl TimeTable {
    /// The table of these times [s] and values; `None` where there is no row, or a time is not after the one before.
    pub fn new(table: Vec<[f64; 2]>) -> Option<Self> {
        let ascends = table.windows(2).all(|pair| pair[0][0] < pair[1][0]);
        (ascends && !table.is_empty()).then_some(TimeTable { table })
    }

    /// The last time [s].
    pub fn end(&self) -> f64 {
        self.table.last().map_or(0.0, |[time, _]| *time)
    }

    /// Its rows: times [s], and values.
    pub fn rows(&self) -> &[[f64; 2]] {
        &self.table
    }

    /// Whether the rows beside the one at this time are no nearer to it than this [s].
    pub fn is_lone(&self, time: f64, near: f64) -> bool {
        let beside = |[row, _]: &[f64; 2]| *row != time && (row - time).abs() < near;
        let here = self.table.partition_point(|[row, _]| *row < time);
        let around = here.saturating_sub(1)..self.table.len().min(here + 2);
        !self.table[around].iter().any(beside)
    }

    /// The value at time `t` [s].
    pub fn at(&self, t: f64) -> f64 {
        let after = self.table.partition_point(|[time, _]| *time <= t);
        match (after.checked_sub(1).map(|before| self.table[before]), self.table.get(after)) {
            (Some([start, from]), Some([end, to])) => from + (to - from) * ((t - start) / (end - start)),
            (Some([_, value]), None) | (None, Some(&[_, value])) => value,
            (None, None) => f64::NAN,
        }
    }
}

/// A formula as instructions for a stack of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    text: String,
    pub(super) code: Vec<Instruction>,
}

/// One instruction: takes its numbers from the stack and leaves one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Instruction {
    Push(f64),
    Time,
    /// A coordinate of [`PLACE`].
    Place(usize),
    Negate,
    Add,
    Subtract,
    Multiply,
    Divide,
    Power,
    Less,
    LessOrEqual,
    Equal,
    NotEqual,
    /// The second of three numbers if the first is not zero, else the third.
    Choose,
    Call(Function),
}

impl Expression {
    /// The value at time `t` [s] of an expression without place, in SI units.
    pub fn at(&self, t: f64) -> f64 {
        self.at_moment(&Moment { time: t, ..Moment::default() })
    }

    /// The value, if it is the same always.
    pub fn constant(&self) -> Option<f64> {
        match self {
            Expression::Constant(value) => Some(*value),
            Expression::Formula(_) | Expression::Table(_) | Expression::Outside(_) | Expression::Rate(_) => {
                None
            }
        }
    }

    /// The value at a time and a place, in SI units.
    pub fn at_moment(&self, moment: &Moment) -> f64 {
        match self {
            Expression::Constant(value) => *value,
            Expression::Formula(program) => run(&program.code, moment),
            Expression::Table(table) => table.at(moment.time),
            Expression::Outside(value) => moment.outside[value.component()],
            Expression::Rate(value) => value.slope(moment),
        }
    }

    /// What comes from outside, if it does.
    pub fn outside(&self) -> Option<&OutsideValue> {
        if let Expression::Outside(value) = self { Some(value) } else { None }
    }

    /// From the instructions for the formula `text`.
    pub(super) fn new(text: &str, code: Vec<Instruction>) -> Expression {
        match code[..] {
            [Instruction::Push(value)] => Expression::Constant(value),
            _ => Expression::Formula(Box::new(Program { text: text.to_string(), code })),
        }
    }
}

impl Serialize for Expression {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Expression::Constant(value) => serializer.serialize_f64(*value),
            Expression::Formula(program) => serializer.serialize_str(&program.text),
            Expression::Table(table) => table.serialize(serializer),
            Expression::Outside(value) => value.serialize(serializer),
            Expression::Rate(value) => {
                let mut table = serializer.serialize_map(Some(1))?;
                table.serialize_entry("rate_of", value)?;
                table.end()
            }
        }
    }
}

/// Numbers that well-formed code has on the stack at most: at each level of brackets and powers an operand and two
/// arguments of `if` wait for what stands deeper, and the deepest has a number of its own.
pub(super) const HIGHEST: usize = 3 * DEEPEST + 1;

/// Numbers that wait for their operator. They need no memory of the system's: a step asks for prescribed motion.
struct Stack {
    numbers: [f64; HIGHEST],
    height: usize,
}

pub(super) const WELL_FORMED: &str =
    "the parser emits an operator after its operands, and refuses what nests too deep";

impl Stack {
    fn push(&mut self, number: f64) {
        *self.numbers.get_mut(self.height).expect(WELL_FORMED) = number;
        self.height += 1;
    }

    fn pop(&mut self) -> f64 {
        self.height = self.height.checked_sub(1).expect(WELL_FORMED);
        self.numbers[self.height]
    }
}

/// The number that well-formed code leaves on the stack at a moment.
pub(super) fn run(code: &[Instruction], moment: &Moment) -> f64 {
    let mut stack = Stack { numbers: [0.0; HIGHEST], height: 0 };
    for instruction in code {
        let mut pop = || stack.pop();
        let truth = |is: bool| if is { 1.0 } else { 0.0 };
        let value = match *instruction {
            Instruction::Push(value) => value,
            Instruction::Time => moment.time,
            Instruction::Place(which) if which < 3 => moment.place[which],
            Instruction::Place(which) => moment.start[which - 3],
            Instruction::Negate => -pop(),
            Instruction::Call(function) if function.arguments() == 1 => function.of(pop(), 0.0),
            Instruction::Choose => {
                let (otherwise, then, condition) = (pop(), pop(), pop());
                if condition != 0.0 { then } else { otherwise }
            }
            binary => {
                let (b, a) = (pop(), pop());
                match binary {
                    Instruction::Add => a + b,
                    Instruction::Subtract => a - b,
                    Instruction::Multiply => a * b,
                    Instruction::Divide => a / b,
                    Instruction::Power => libm::pow(a, b),
                    Instruction::Less => truth(a < b),
                    Instruction::LessOrEqual => truth(a <= b),
                    Instruction::Equal => truth(a == b),
                    Instruction::NotEqual => truth(a != b),
                    Instruction::Call(function) => function.of(a, b),
                    _ => unreachable!("all other instructions are matched above"),
                }
            }
        };
        stack.push(value);
    }
    stack.pop()
}
