//! Formulas in scene files.

use super::formula::{DEEPEST, Function};
use serde::{Serialize, Serializer};

/// A number that may depend on time: `"5 m/s * min(t / 1 ms, 1)"`, compiled.
///
/// The only free variable is `t`, the simulated time in seconds; parameters and units are already resolved to SI.
/// Serialised, it is the number or the text of the formula.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// The same number at every time.
    Constant(f64),
    /// A formula with `t` in it.
    Formula(Box<Program>),
}

/// A formula as instructions for a stack of numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    text: String,
    code: Vec<Instruction>,
}

/// One instruction: takes its numbers from the stack and leaves one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Instruction {
    Push(f64),
    Time,
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
    /// The value at time `t` [s], in SI units.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Expression::Constant(value) => *value,
            Expression::Formula(program) => run(&program.code, t),
        }
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
        }
    }
}

/// Numbers that well-formed code has on the stack at most: at each level of brackets and powers an operand and two
/// arguments of `if` wait for what stands deeper, and the deepest has a number of its own.
const HIGHEST: usize = 3 * DEEPEST + 1;

/// Numbers that wait for their operator. They need no memory of the system's: a step asks for prescribed motion.
struct Stack {
    numbers: [f64; HIGHEST],
    height: usize,
}

const WELL_FORMED: &str = "the parser emits an operator after its operands, and refuses what nests too deep";

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

/// The number that well-formed code leaves on the stack at time `t` [s].
pub(super) fn run(code: &[Instruction], t: f64) -> f64 {
    let mut stack = Stack { numbers: [0.0; HIGHEST], height: 0 };
    for instruction in code {
        let mut pop = || stack.pop();
        let truth = |is: bool| if is { 1.0 } else { 0.0 };
        let value = match *instruction {
            Instruction::Push(value) => value,
            Instruction::Time => t,
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
