//! Numbers and quantities with units as scene files write them.

use super::Context;
use super::read::Read;
use crate::scene::Expression;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::units::Powers;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::marker::PhantomData;

/// A physical dimension with its name and an example.
pub trait Measure {
    /// Powers of kilogram, metre and second.
    const POWERS: [i8; 3];

    /// `a length [m]`
    fn name() -> String {
        Powers::from(Self::POWERS).name()
    }

    /// `0.4 m`
    fn example() -> String {
        Powers::from(Self::POWERS).example()
    }
}

macro_rules! measures {
    ($($(#[$about:meta])* $name:ident = $powers:expr;)*) => {
        $($(#[$about])* pub struct $name; impl Measure for $name { const POWERS: [i8; 3] = $powers; })*
    };
}
measures! {
    /// A plain number.
    Ratio = [0, 0, 0];
    /// In metres.
    Length = [0, 1, 0];
    /// In seconds.
    Duration = [0, 0, 1];
    /// In metres per second.
    Velocity = [0, 1, -1];
    /// In metres per second squared.
    Acceleration = [0, 1, -2];
    /// In radians per second.
    AngularVelocity = [0, 0, -1];
    /// In kilograms per cubic metre.
    Density = [1, -3, 0];
    /// In pascals.
    Pressure = [1, -1, -2];
    /// In pascals per metre per second.
    SurfaceViscosity = [1, -2, -1];
    /// In newtons.
    Force = [1, 1, -2];
    /// In newtons per metre.
    Stiffness = [1, 0, -2];
    /// In newtons per metre per second.
    ForceOverVelocity = [1, 0, -1];
    /// In newton metres.
    Moment = [1, 2, -2];
    /// In newton metres per radian per second.
    MomentOverSpin = [1, 2, -1];
    /// In kilograms.
    Mass = [1, 0, 0];
    /// In kilograms times square metres.
    MomentOfInertia = [1, 2, 0];
    /// In one over pascals.
    Compliance = [-1, 1, 2];
}

/// In radians.
pub struct Angle;

impl Measure for Angle {
    const POWERS: [i8; 3] = [0, 0, 0];

    fn name() -> String {
        "an angle [rad]".to_string()
    }

    fn example() -> String {
        "30 deg".to_string()
    }
}

/// A number in SI units, or text: a quantity with its unit or a formula.
pub struct QuantityInput<M> {
    node: DocumentNode,
    measure: PhantomData<M>,
}

impl<M: Measure> QuantityInput<M> {
    /// The quantity at `node`.
    pub fn new(node: &DocumentNode) -> Self {
        QuantityInput { node: node.clone(), measure: PhantomData }
    }

    /// Its value in SI units, finite.
    pub fn value(&self, context: &Context) -> Result<f64, Fault> {
        let value = self.extended(context)?;
        if value.is_finite() { Ok(value) } else { Err(self.refused(value, Self::wanted())) }
    }

    /// Its value in SI units, perhaps infinite.
    pub fn extended(&self, context: &Context) -> Result<f64, Fault> {
        let expression =
            evaluate(&self.node, Powers::from(M::POWERS), &Self::wanted(), (context, Dependence::Constant))?;
        let value = expression.at(0.0);
        if value.is_nan() { Err(self.refused(value, Self::wanted())) } else { Ok(value) }
    }

    /// Its value as a function of the place.
    pub fn over_place(&self, context: &Context) -> Result<Expression, Fault> {
        evaluate(&self.node, Powers::from(M::POWERS), &Self::wanted(), (context, Dependence::Place))
    }

    /// Its value, above zero.
    pub fn positive(&self, context: &Context) -> Result<f64, Fault> {
        let value = self.value(context)?;
        let allowed = || format!("{} above 0, like \"{}\"", M::name(), M::example());
        if value > 0.0 { Ok(value) } else { Err(self.refused(value, allowed())) }
    }

    /// Its value, which must satisfy what `allowed` says.
    pub fn checked(
        &self,
        context: &Context,
        allowed: &str,
        satisfied: impl Fn(f64) -> bool,
    ) -> Result<f64, Fault> {
        let value = self.value(context)?;
        if satisfied(value) { Ok(value) } else { Err(self.refused(value, allowed)) }
    }

    /// The fault of a value that is not allowed.
    pub fn refused(&self, value: f64, allowed: impl Into<String>) -> Fault {
        let mut fault = self.node.fault(allowed);
        if let Value::Text(text) = &self.node.value
            && (text.split_whitespace().count() > 2
                || !text.starts_with(['-', '.', '0', '1', '2', '3', '4', '5', '6', '7', '8', '9']))
        {
            let unit = Powers::from(M::POWERS).symbol();
            let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
            fault.problem.found = format!("{text:?}, which is {value}{unit}");
        }
        fault
    }

    /// Where it stands.
    pub fn node(&self) -> &DocumentNode {
        &self.node
    }
}

/// The unit of a plain quantity: one number and one unit behind it.
pub fn plain_unit(node: &DocumentNode) -> Option<&str> {
    let Value::Text(text) = &node.value else { return None };
    let unit = text.trim().trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE".contains(c)).trim();
    (!unit.is_empty() && unit.chars().all(char::is_alphabetic)).then_some(unit)
}

/// What a number or formula says, if it has the dimension `wanted`; `allowed` says so in words.
pub fn evaluate(
    node: &DocumentNode,
    wanted: Powers,
    allowed: &str,
    (context, variation): (&Context, Dependence),
) -> Result<Expression, Fault> {
    // Rates of decay are as good in hertz.
    let turns = allowed.contains(&AngularVelocity::example());
    if turns && plain_unit(node).is_some_and(|unit| unit.ends_with("Hz")) {
        let found = format!("{}, of which nobody knows whether it counts turns or radians", node.found());
        return Err(Fault::new(&node.key(), found, "\"rad/s\", \"rpm\" or \"1/s\"").at(node.span()));
    }
    let formula = context.parameters.formula(node, variation, allowed)?;
    if formula.kind.fits(wanted) {
        return Ok(formula.expression);
    }
    let found = format!("{}, {}", node.found(), formula.kind.name());
    Err(Fault::new(&node.key(), found, allowed).at(node.span()))
}

impl<M: Measure> Read for QuantityInput<M> {
    fn wanted() -> String {
        format!("{}, like \"{}\"", M::name(), M::example()).replace("\"0.5\"", "0.5")
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) => Ok(QuantityInput::new(node)),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl<M: Measure> JsonSchema for QuantityInput<M> {
    fn schema_name() -> Cow<'static, str> {
        format!("Quantity_{}", Powers::from(M::POWERS).symbol()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"], "examples": [M::example()] })
    }
}
