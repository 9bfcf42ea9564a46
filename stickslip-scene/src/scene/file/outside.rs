//! `{ outside = "NAME" }`: what the file only names, and the program that runs the scene gives.

use super::Context;
use super::read::{Read, check_keys, field};
use super::text::Text;
use crate::outside::OUTSIDE;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::{Expression, OutsideValue};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

/// What is read as `I`, or the name of a function from outside.
pub struct OrOutside<I> {
    node: DocumentNode,
    /// The one, or the other.
    input: Result<I, Text>,
}

impl<I> OrOutside<I> {
    /// Its components: `read` from what stands there, or those of a function from outside that are among `components`.
    pub fn resolve(
        &self,
        context: &Context,
        components: impl Fn(usize) -> bool,
        read: impl FnOnce(&I) -> Result<[Expression; 3], Fault>,
    ) -> Result<[Expression; 3], Fault> {
        match &self.input {
            Ok(input) => read(input),
            Err(name) => {
                let name = name.value(context)?;
                Ok([0, 1, 2].map(|i| match components(i) {
                    true => Expression::Outside(OutsideValue::new(&name, i)),
                    false => Expression::Constant(0.0),
                }))
            }
        }
    }

    /// Where it stands.
    pub fn node(&self) -> &DocumentNode {
        &self.node
    }
}

impl<I: Read> Read for OrOutside<I> {
    fn wanted() -> String {
        I::wanted()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        let outside =
            matches!(&node.value, Value::Table(children) if children.iter().any(|c| c.name() == OUTSIDE));
        let input = if outside {
            check_keys(node, &[OUTSIDE])?;
            Err(field(node, OUTSIDE)?)
        } else {
            Ok(I::read(node)?)
        };
        Ok(OrOutside { node: node.clone(), input })
    }
}

impl<I: JsonSchema> JsonSchema for OrOutside<I> {
    fn schema_name() -> Cow<'static, str> {
        format!("OrOutside_{}", I::schema_name()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let input = I::json_schema(generator);
        let mut name = Text::json_schema(generator);
        name.insert(
            "description".into(),
            "Name of a function that the program which runs the scene gives, such as one of Python.".into(),
        );
        let outside = json_schema!({
            "type": "object",
            "properties": { OUTSIDE: name },
            "required": [OUTSIDE],
            "additionalProperties": false,
        });
        json_schema!({ "anyOf": [input, outside] })
    }
}
