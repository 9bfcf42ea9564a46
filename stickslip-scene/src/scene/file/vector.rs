//! Vectors as scene files write them: two components in the plane, three in space.

use super::Context;
use super::loads::{Varying, VaryingVector};
use super::quantity::{AngularVelocity, Measure, QuantityInput, Ratio};
use super::read::Read;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::units::Powers;
use crate::scene::{Dimension, Expression};
use crate::tensor::Vector;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// A vector: as many quantities as the scene has dimensions.
pub struct VectorInput<M> {
    node: DocumentNode,
    parts: Vec<QuantityInput<M>>,
}

/// An angular velocity: a vector, in the plane a number.
pub struct SpinInput(DocumentNode);

/// An angular velocity that may vary in time.
pub struct VaryingSpin(DocumentNode);

impl<M: Measure> VectorInput<M> {
    /// Its components in SI units; in the plane the third is zero.
    pub fn value(&self, context: &Context) -> Result<[f64; 3], Fault> {
        self.each(context, |part| part.value(context), 0.0)
    }

    /// Its components as functions of the place; in the plane the third is zero.
    pub fn over_place(&self, context: &Context) -> Result<[Expression; 3], Fault> {
        self.each(context, |part| part.over_place(context), Expression::Constant(0.0))
    }

    /// The two components of a point in the plane.
    pub fn pair(&self, context: &Context) -> Result<[f64; 2], Fault> {
        match &self.parts[..] {
            [x, y] => Ok([x.value(context)?, y.value(context)?]),
            _ => Err(self.node.fault("2 numbers: [x, y]")),
        }
    }

    /// The component across an axis, as written.
    pub fn part(&self, axis: usize) -> &QuantityInput<M> {
        &self.parts[axis]
    }

    /// Where it stands.
    pub fn node(&self) -> &DocumentNode {
        &self.node
    }

    fn each<T: Clone>(
        &self,
        context: &Context,
        of: impl Fn(&QuantityInput<M>) -> Result<T, Fault>,
        zero: T,
    ) -> Result<[T; 3], Fault> {
        match (&self.parts[..], context.dimension) {
            ([x, y], plane) if plane.is_plane() => Ok([of(x)?, of(y)?, zero]),
            ([x, y, z], Dimension::Space) => Ok([of(x)?, of(y)?, of(z)?]),
            (_, plane) if plane.is_plane() => {
                Err(self.node.fault("2 numbers, as the scene is plane: [x, y]"))
            }
            _ => Err(self.node.fault("3 numbers, as the scene is 3d: [x, y, z]")),
        }
    }
}

/// A unit vector.
pub fn direction(axis: &VectorInput<Ratio>, context: &Context) -> Result<[f64; 3], Fault> {
    match Vector(axis.value(context)?).direction() {
        Some(direction) => Ok(direction.0),
        None => Err(axis.node().fault("a direction: a vector that is not zero")),
    }
}

impl SpinInput {
    /// Its components in SI units; in the plane only the third is not zero.
    pub fn value(&self, context: &Context) -> Result<[f64; 3], Fault> {
        match context.dimension {
            Dimension::PlaneStrain | Dimension::PlaneStress => Ok([0.0, 0.0, self.turn()?.value(context)?]),
            Dimension::Space => self.vector()?.value(context),
        }
    }

    /// Where it stands.
    pub fn node(&self) -> &DocumentNode {
        &self.0
    }

    fn vector(&self) -> Result<VectorInput<AngularVelocity>, Fault> {
        match self.0.value {
            Value::List(_) => VectorInput::read(&self.0),
            _ => Err(self.0.fault("3 numbers, as the scene is 3d, like [0, \"5 rad/s\", 0]")),
        }
    }

    fn turn(&self) -> Result<QuantityInput<AngularVelocity>, Fault> {
        match self.0.value {
            Value::List(_) => Err(self.0.fault(ONE_TURN)),
            _ => Ok(QuantityInput::new(&self.0)),
        }
    }
}

/// What an angular velocity in the plane must be.
const ONE_TURN: &str = "one number, as the scene is plane: the turn about z, like \"5 rad/s\"";

impl VaryingSpin {
    /// Its components as functions of time; in the plane only the third is not zero.
    pub fn resolve(&self, context: &Context) -> Result<[Expression; 3], Fault> {
        let VaryingSpin(node) = self;
        match (&node.value, context.dimension.is_plane()) {
            (Value::List(_), true) => Err(node.fault(ONE_TURN)),
            (Value::List(_), false) => {
                VaryingVector::<AngularVelocity>::read(node)?.resolve(context, Dependence::Time)
            }
            (_, false) => Err(node.fault("3 numbers, as the scene is 3d, like [0, \"5 rad/s\", 0]")),
            (_, true) => {
                let zero = || Expression::Constant(0.0);
                let turn = Varying::<AngularVelocity>::read(node)?.resolve(context, Dependence::Time)?;
                Ok([zero(), zero(), turn])
            }
        }
    }
}

impl<M: Measure> Read for VectorInput<M> {
    fn wanted() -> String {
        format!("a list such as [0, \"{}\", 0], two in the plane", M::example()).replace("\"0.5\"", "0.5")
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::List(items) => {
                let parts = items.iter().map(QuantityInput::read).collect::<Result<_, _>>()?;
                Ok(VectorInput { node: node.clone(), parts })
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl Read for SpinInput {
    fn wanted() -> String {
        "a list such as [0, \"5 rad/s\", 0], one number in the plane".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) | Value::List(_) => Ok(SpinInput(node.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl Read for VaryingSpin {
    fn wanted() -> String {
        SpinInput::wanted()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) | Value::List(_) | Value::Table(_) => {
                Ok(VaryingSpin(node.clone()))
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl<M: Measure> JsonSchema for VectorInput<M> {
    fn schema_name() -> Cow<'static, str> {
        format!("Vector_{}", Powers::from(M::POWERS).symbol()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let part = QuantityInput::<M>::json_schema(generator);
        json_schema!({ "type": "array", "items": part, "minItems": 2, "maxItems": 3 })
    }
}

impl JsonSchema for SpinInput {
    fn schema_name() -> Cow<'static, str> {
        "Spin".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = QuantityInput::<AngularVelocity>::json_schema(generator);
        let vector = VectorInput::<AngularVelocity>::json_schema(generator);
        json_schema!({ "anyOf": [number, vector] })
    }
}

impl JsonSchema for VaryingSpin {
    fn schema_name() -> Cow<'static, str> {
        "VaryingSpin".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = Varying::<AngularVelocity>::json_schema(generator);
        let vector = VaryingVector::<AngularVelocity>::json_schema(generator);
        json_schema!({ "anyOf": [number, vector] })
    }
}
