//! `repeat`: a table of a list that stands for many, with indices in its formulas and names.

use super::Context;
use super::quantity::{QuantityInput, Ratio};
use super::read::Read;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::sync::Arc;

/// Indices that count from 0, each with how many values it has; a later one may depend on those before it.
pub struct Repeat(Arc<[DocumentNode]>);

/// What a table may stand for.
const MOST: usize = 1_000_000;

impl Repeat {
    /// Does `each` for all values of the indices, the last of them the fastest; once where nothing is repeated.
    ///
    /// # Errors
    /// Names that no formula can use, counts that are no whole numbers, and whatever `each` finds.
    pub fn each(
        repeat: Option<&Repeat>,
        context: &Context,
        mut each: impl FnMut() -> Result<(), Fault>,
    ) -> Result<(), Fault> {
        let mut left = MOST;
        match repeat {
            Some(Repeat(indices)) => Self::over(indices, context, (&mut left, &mut each)),
            None => each(),
        }
    }

    fn over(
        indices: &[DocumentNode],
        context: &Context,
        (left, each): (&mut usize, &mut dyn FnMut() -> Result<(), Fault>),
    ) -> Result<(), Fault> {
        let Some((index, inner)) = indices.split_first() else {
            return each().map_err(|fault| context.parameters.at_indices(fault));
        };
        let count = QuantityInput::<Ratio>::new(index);
        let allowed = format!("a whole number from 0 on, of at most {MOST} repetitions in all");
        let whole = |value: f64| value.fract() == 0.0 && value >= 0.0 && value <= *left as f64;
        let count = count.checked(context, &allowed, whole);
        let count = count.map_err(|fault| context.parameters.at_indices(fault))? as usize;
        // Turns count whether or not anything comes of them.
        context.parameters.with_index(index, count, &mut || match left.checked_sub(1) {
            None => Err(index.fault(&*allowed)),
            Some(fewer) => {
                *left = fewer;
                Self::over(inner, context, (left, each))
            }
        })
    }
}

impl Read for Repeat {
    fn wanted() -> String {
        "a table of indices and how many values they have: { i = 10, j = 5 }".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::Table(indices) if !indices.is_empty() => {
                indices.iter().try_for_each(|index| QuantityInput::<Ratio>::read(index).map(drop))?;
                Ok(Repeat(indices.clone()))
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for Repeat {
    fn schema_name() -> Cow<'static, str> {
        "Repeat".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "object",
            "description": "Indices that count from 0, each with how many values it has: { i = 10, j = \"i + 1\" }. \
                            Formulas use them by name, text in braces: name = \"grain {i}\".",
            "additionalProperties": { "type": ["integer", "string"] },
            "minProperties": 1
        })
    }
}
