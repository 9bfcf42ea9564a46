//! How fast a value changes: exact derivatives by time, carried along with the numbers of a formula.

use crate::scene::expression::{HIGHEST, Instruction, Moment, TimeTable, WELL_FORMED};
use crate::scene::formula::Function;

/// The derivative by time of what the code of a formula leaves at a moment.
pub fn slope(code: &[Instruction], moment: &Moment) -> f64 {
    // Numbers, each with its derivative.
    let mut stack = [[0.0; 2]; HIGHEST];
    let mut height = 0;
    for instruction in code {
        let mut pop = || {
            height = usize::checked_sub(height, 1).expect(WELL_FORMED);
            stack[height]
        };
        let value = match *instruction {
            Instruction::Push(value) => [value, 0.0],
            Instruction::Time => [moment.time, 1.0],
            Instruction::Place(which) if which < 3 => [moment.place[which], 0.0],
            Instruction::Place(which) => [moment.start[which - 3], 0.0],
            Instruction::Negate => pop().map(|x| -x),
            Instruction::Call(function) if function.arguments() == 1 => of_one(function, pop()),
            Instruction::Choose => {
                let (otherwise, then, [condition, _]) = (pop(), pop(), pop());
                if condition != 0.0 { then } else { otherwise }
            }
            binary => {
                let (b, a) = (pop(), pop());
                of_two(binary, a, b)
            }
        };
        stack[height] = value;
        height += 1;
    }
    assert!(height == 1, "{WELL_FORMED}");
    stack[0][1]
}

fn of_one(function: Function, [x, rate]: [f64; 2]) -> [f64; 2] {
    let value = function.of(x, 0.0);
    let slope = match function {
        Function::Sin => libm::cos(x),
        Function::Cos => -libm::sin(x),
        Function::Tan => 1.0 + value * value,
        Function::Asin => 1.0 / (1.0 - x * x).sqrt(),
        Function::Acos => -1.0 / (1.0 - x * x).sqrt(),
        Function::Atan => 1.0 / (1.0 + x * x),
        Function::Sqrt => 0.5 / value,
        Function::Exp => value,
        Function::Ln => 1.0 / x,
        Function::Abs => x.signum(),
        Function::Floor | Function::Ceil => 0.0,
        Function::Atan2 | Function::Min | Function::Max | Function::Mod => {
            unreachable!("functions of two numbers are instructions of two")
        }
    };
    // What does not change has no slope, even where the function has none that is a number.
    [value, if rate == 0.0 { 0.0 } else { slope * rate }]
}

fn of_two(instruction: Instruction, [a, da]: [f64; 2], [b, db]: [f64; 2]) -> [f64; 2] {
    let truth = |is: bool| [f64::from(u8::from(is)), 0.0];
    match instruction {
        Instruction::Add => [a + b, da + db],
        Instruction::Subtract => [a - b, da - db],
        Instruction::Multiply => [a * b, da * b + a * db],
        Instruction::Divide => [a / b, (da - a / b * db) / b],
        Instruction::Power => {
            let value = libm::pow(a, b);
            let of_base = if da == 0.0 { 0.0 } else { b * libm::pow(a, b - 1.0) * da };
            let of_exponent = if db == 0.0 { 0.0 } else { value * libm::log(a) * db };
            [value, of_base + of_exponent]
        }
        Instruction::Less => truth(a < b),
        Instruction::LessOrEqual => truth(a <= b),
        Instruction::Equal => truth(a == b),
        Instruction::NotEqual => truth(a != b),
        Instruction::Call(Function::Min) => {
            if a <= b {
                [a, da]
            } else {
                [b, db]
            }
        }
        Instruction::Call(Function::Max) => {
            if a >= b {
                [a, da]
            } else {
                [b, db]
            }
        }
        Instruction::Call(Function::Mod) => [Function::Mod.of(a, b), da - libm::floor(a / b) * db],
        Instruction::Call(Function::Atan2) => [Function::Atan2.of(a, b), (b * da - a * db) / (a * a + b * b)],
        _ => unreachable!("all instructions of two numbers are matched above"),
    }
}

impl TimeTable {
    /// The slope of the straight line that begins or goes on at a time [s].
    pub(super) fn slope(&self, t: f64) -> f64 {
        let rows = self.rows();
        let after = rows.partition_point(|[time, _]| *time <= t);
        match (after.checked_sub(1).map(|before| rows[before]), rows.get(after)) {
            (Some([start, from]), Some([end, to])) => (to - from) / (end - start),
            _ => 0.0,
        }
    }

    /// By how much the slope changes at a row, which is at this time [s].
    pub(super) fn bend(&self, t: f64) -> f64 {
        let rows = self.rows();
        let before = rows.partition_point(|[time, _]| *time < t).checked_sub(1);
        self.slope(t) - before.map_or(0.0, |before| self.slope(rows[before][0]))
    }
}
