//! Values that functions from outside give: `{ outside = "NAME" }`.

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
