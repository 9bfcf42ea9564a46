//! Values that functions from outside give: `{ outside = "NAME" }`.

use super::course::{GAUSS, WEIGHTS};
use super::expression::{Expression, Moment};
use super::{Action, BodyMotion, Scene};
use crate::outside::{OUTSIDE, OutsideFault, OutsideFunction, OutsidePoints};
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// A component of what a function from outside says.
#[derive(Clone, Debug)]
pub struct OutsideValue {
    name: String,
    component: usize,
    function: Option<&'static dyn OutsideFunction>,
}

impl OutsideValue {
    /// A component of the function of this name, which is still to be given.
    pub fn new(name: &str, component: usize) -> Self {
        OutsideValue { name: name.to_string(), component, function: None }
    }

    /// The name of the function.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Which component of its values.
    pub fn component(&self) -> usize {
        self.component
    }

    /// The function, once it is given.
    pub fn function(&self) -> Option<&'static dyn OutsideFunction> {
        self.function
    }

    /// The vector that some expressions of time are over a step of `dt` from `time` on [s], the mean.
    ///
    /// # Errors
    /// A function from outside that has no answer.
    pub fn vector_over_step(
        expressions: &[Expression; 3],
        (time, dt): (f64, f64),
    ) -> Result<[f64; 3], OutsideFault> {
        let mut moment = Moment { time, ..Moment::default() };
        let outside = expressions.iter().find_map(Expression::outside);
        if let Some(function) = outside.and_then(OutsideValue::function) {
            let nowhere = [[0.0; 3]];
            let (mut values, mut said, mut bend) = ([[0.0; 3]], [[0.0; 3]], [[0.0; 3]]);
            let room = MeanRoom { values: &mut values, said: &mut said, bend: &mut bend };
            room.mean(function, (time, dt), [&nowhere, &nowhere])?;
            moment.outside = values[0];
        }
        Ok([0, 1, 2].map(|i| expressions[i].mean([time, time + dt], &moment)))
    }

    /// The vector that some expressions of time are at time `t` [s].
    ///
    /// # Errors
    /// A function from outside that has no answer.
    pub fn vector(expressions: &[Expression; 3], t: f64) -> Result<[f64; 3], OutsideFault> {
        let mut moment = Moment { time: t, ..Moment::default() };
        let outside = expressions.iter().find_map(Expression::outside);
        if let Some(function) = outside.and_then(OutsideValue::function) {
            let mut values = [[0.0; 3]];
            function
                .evaluate(OutsidePoints { time: t, now: &[[0.0; 3]], start: &[[0.0; 3]] }, &mut values)?;
            moment.outside = values[0];
        }
        Ok([0, 1, 2].map(|i| expressions[i].at_moment(&moment)))
    }
}

/// Times at which a function from outside is asked in a step: three, as Gauss's rule has them.
pub const LEAST_CALLS: usize = GAUSS.len();
/// And where the values at these are no straight line: at three more in each quarter.
pub const MOST_CALLS: usize = LEAST_CALLS * (1 + QUARTERS);
const QUARTERS: usize = 4;
/// Values are on a straight line if none is further off than this part of the largest [-].
const STRAIGHT: f64 = 0.01;

/// Room for the mean of a function from outside, for each of some points.
#[derive(Debug)]
pub struct MeanRoom<'a> {
    /// The means.
    pub values: &'a mut [[f64; 3]],
    /// What the function said last.
    pub said: &'a mut [[f64; 3]],
    /// How far it is from a straight line.
    pub bend: &'a mut [[f64; 3]],
}

impl MeanRoom<'_> {
    /// Finds the means over a step of `dt` from `time` on [s], at points that are here `now` and were there at the
    /// start.
    ///
    /// # Errors
    /// Those of the function.
    pub fn mean(
        self,
        function: &dyn OutsideFunction,
        (time, dt): (f64, f64),
        [now, start]: [&[[f64; 3]]; 2],
    ) -> Result<(), OutsideFault> {
        let MeanRoom { values, said, bend } = self;
        let all =
            |values: &mut [[f64; 3]], of: f64| values.iter_mut().flatten().for_each(|value| *value = of);
        let mut part = |(from, length): (f64, f64), share: f64, values: &mut [[f64; 3]]| {
            for ((x, weight), bent) in GAUSS.iter().zip(WEIGHTS).zip([-0.5, 1.0, -0.5]) {
                all(said, 0.0);
                let time = from + 0.5 * length * (1.0 + x);
                function.evaluate(OutsidePoints { time, now, start }, said)?;
                let sums = values.iter_mut().flatten().zip(bend.iter_mut().flatten());
                for ((value, bend), said) in sums.zip(said.iter().flatten()) {
                    *value += share * weight * said;
                    *bend += bent * said;
                }
            }
            let largest = |of: &[[f64; 3]]| of.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
            let is_bent = largest(bend) > STRAIGHT * largest(values).max(largest(said));
            all(bend, 0.0);
            Ok(is_bent)
        };
        all(values, 0.0);
        if part((time, dt), 1.0, values)? {
            all(values, 0.0);
            let quarter = dt / QUARTERS as f64;
            for i in 0..QUARTERS {
                part((time + i as f64 * quarter, quarter), 1.0 / QUARTERS as f64, values)?;
            }
        }
        Ok(())
    }
}

/// The same component of a function of the same name.
impl PartialEq for OutsideValue {
    fn eq(&self, other: &Self) -> bool {
        (&self.name, self.component) == (&other.name, other.component)
    }
}

impl Serialize for OutsideValue {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut table = serializer.serialize_map(Some(1))?;
        table.serialize_entry(OUTSIDE, &self.name)?;
        table.end()
    }
}

impl Scene {
    /// Gives what comes from outside its functions: `find` is asked for each of the names, for what of a body or a load
    /// it stands; one that has none stays without.
    ///
    /// # Errors
    /// The first of `find`.
    pub fn give_functions<E>(
        &mut self,
        mut find: impl FnMut(&str, OutsideUse) -> Result<Option<&'static dyn OutsideFunction>, E>,
    ) -> Result<(), E> {
        let motions = self.bodies.iter_mut().filter_map(|body| match &mut body.motion {
            BodyMotion::Rigid { velocity, spin } => {
                Some([(&mut velocity[..], OutsideUse::Vector), (&mut spin[..], OutsideUse::Spin)])
            }
            BodyMotion::Free { .. } | BodyMotion::FreeRigid(_) => None,
        });
        let loads = self.loads.iter_mut().filter_map(|load| match &mut load.action {
            Action::Force(values) | Action::Traction(values) | Action::Acceleration(values) => {
                Some((&mut values[..], OutsideUse::VectorAtPoints))
            }
            Action::Pressure(value) => Some((std::slice::from_mut(value), OutsideUse::NumberAtPoints)),
            Action::Temperature(_) | Action::Support(_) => None,
        });
        for (values, purpose) in motions.flatten().chain(loads) {
            let Some(name) = values.iter().find_map(Expression::outside).map(|value| value.name.clone())
            else {
                continue;
            };
            let found = find(&name, purpose)?;
            for value in values {
                if let Expression::Outside(value) = value {
                    value.function = found;
                }
            }
        }
        Ok(())
    }
}

/// What the values of a function from outside are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OutsideUse {
    /// A velocity: a vector, which depends on time alone.
    Vector,
    /// An angular velocity, in the plane a number, which depends on time alone.
    Spin,
    /// A vector at each point.
    VectorAtPoints,
    /// A number at each point.
    NumberAtPoints,
}
