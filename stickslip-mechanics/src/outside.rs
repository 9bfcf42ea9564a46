//! What a scene file only names, and the program that runs the scene gives: functions of Python, or of any library.

use std::error::Error;
use std::fmt;
use std::sync::Arc;

/// Key of a scene file under which such a name stands.
pub const OUTSIDE: &str = "outside";

/// What a message allows where a name was not given.
pub const GIVEN: &str =
    "a name that the program which runs the scene gives, such as that of a function in Python";

/// Why a function from outside has no answer.
#[derive(Clone, Debug)]
pub struct OutsideFault(pub Arc<dyn Error + Send + Sync>);

impl fmt::Display for OutsideFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// The same fault.
impl PartialEq for OutsideFault {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Where and when a function from outside is asked.
#[derive(Clone, Copy, Debug)]
pub struct OutsidePoints<'a> {
    /// Simulated time [s].
    pub time: f64,
    /// Where the points are [m].
    pub now: &'a [[f64; 3]],
    /// Where they were at the start [m].
    pub start: &'a [[f64; 3]],
}

/// A function of time and place from outside, in SI units: a force, a traction, a pressure, an acceleration, or the
/// velocity or spin of a rigid body, which has one point of no meaning.
pub trait OutsideFunction: fmt::Debug + Send + Sync {
    /// Its values at some points: vectors in space, of a pressure the first component alone.
    ///
    /// It must depend on nothing else, else runs do not repeat.
    ///
    /// # Errors
    /// Whatever keeps it from an answer; it ends the step.
    fn evaluate(&self, points: OutsidePoints<'_>, values: &mut [[f64; 3]]) -> Result<(), OutsideFault>;
}
