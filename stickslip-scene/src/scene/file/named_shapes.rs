//! `[shapes]`: shapes by name, to be used wherever a shape is.

use super::Context;
use super::read::Read;
use super::shape::ShapeInput;
use super::text::Text;
use crate::geometry::{Revolved, Shape};
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::collections::HashSet;

/// How deep shapes that name others may go.
const DEEPEST: usize = 16;
/// What all uses of names in a scene may take together [bytes].
const MOST: usize = 400_000_000;

/// Shapes by name, as the file has them.
pub struct ShapeTable(Vec<(DocumentNode, ShapeInput)>);

/// Shapes by name that can be used: while the table is read those above, then all of them.
#[derive(Default)]
pub struct NamedShapes {
    all: RefCell<Vec<NamedShape>>,
    /// Names that something used.
    used: RefCell<HashSet<String>>,
    /// What uses of names have taken so far [bytes], and how deep names go in the shape that is read.
    taken: Cell<usize>,
    depth: Cell<usize>,
}

struct NamedShape {
    name: String,
    shape: Shape,
    /// What it takes [bytes], and how deep names go in it, its own too.
    size: usize,
    depth: usize,
}

impl ShapeTable {
    /// Adds all shapes of the table to those of the context; each may name those above it.
    pub fn resolve(&self, context: &Context) -> Result<(), Fault> {
        let NamedShapes { all, depth, .. } = context.shapes;
        for (node, input) in &self.0 {
            depth.set(0);
            let shape = input.resolve(context)?;
            let (size, depth) = (size(&shape), 1 + depth.get());
            if depth > DEEPEST {
                let found = format!("a shape that names others {DEEPEST} deep");
                return Err(Fault::new(
                    &node.key(),
                    found,
                    "shapes that are nearer to those they are made of",
                )
                .at(node.name_span()));
            }
            all.borrow_mut().push(NamedShape { name: node.name().to_string(), shape, size, depth });
        }
        Ok(())
    }
}

impl NamedShapes {
    /// Whether something used the shape of this name.
    pub fn uses(&self, name: &str) -> bool {
        self.used.borrow().contains(name)
    }

    /// The shape with this name.
    pub fn named(&self, text: &Text, context: &Context) -> Result<Shape, Fault> {
        let all = self.all.borrow();
        let names: Vec<&str> = all.iter().map(|named| named.name.as_str()).collect();
        let what = "a shape such as shape.ball = { center = [0, 0, 1], radius = 1 }, or the name of one above it \
                    in [shapes]";
        let name = text.name_of(context, what, &names)?;
        let named = all.iter().find(|named| named.name == name).expect("name_of found it in names");
        let taken = self.taken.get().saturating_add(named.size);
        if taken > MOST {
            let allowed =
                format!("names whose shapes take {} MB of memory at most together", MOST / 1_000_000);
            return Err(text.refused(&name, allowed));
        }
        self.taken.set(taken);
        self.depth.set(self.depth.get().max(named.depth));
        self.used.borrow_mut().insert(name);
        Ok(named.shape.clone())
    }
}

/// How many bytes a shape takes; what copies share is not counted.
fn size(shape: &Shape) -> usize {
    let within = match shape {
        Shape::Union(shapes) | Shape::Intersection(shapes) | Shape::Difference(shapes) => {
            shapes.iter().map(size).sum()
        }
        Shape::Rotated { shape, .. } => size(shape),
        Shape::Polygon { points, .. } | Shape::Revolved(Revolved { points, .. }) => size_of_val(&points[..]),
        _ => 0,
    };
    size_of::<Shape>() + within
}

impl Read for ShapeTable {
    fn wanted() -> String {
        "a table of shapes: tip.ball = { center = [0, 0, 1], radius = 1 }".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        let Value::Table(children) = &node.value else { return Err(node.fault(Self::wanted())) };
        let shape = |child: &DocumentNode| Ok((child.clone(), ShapeInput::read(child)?));
        children.iter().map(shape).collect::<Result<_, _>>().map(ShapeTable)
    }
}

impl JsonSchema for ShapeTable {
    fn schema_name() -> Cow<'static, str> {
        "Shapes".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let shape = generator.subschema_for::<ShapeInput>();
        json_schema!({ "type": "object", "additionalProperties": shape })
    }
}
