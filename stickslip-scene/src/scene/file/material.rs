//! `[materials.NAME]`: density and a law from the list with its constants.

use super::quantity::{Angle, Density, Measure, QuantityInput, Ratio, evaluate};
use super::read::{Read, check_keys, field, unknown_key};
use super::text::{Choice, Text, Word};
use super::{Context, other_constants, other_laws};
use crate::material::{
    ANGLE, Constant, Form, Given, LAWS, Material, OUTSIDE_CONSTANTS, Quantity as Wanted, outside_law,
};
use crate::outside::OUTSIDE;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::suggestion::{did_you_mean, listed};
use crate::scene::units::Powers;
use crate::scene::{Dimension, NamedMaterial, Problem, VolumeChange};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::sync::Arc;

impl Choice for VolumeChange {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("own", VolumeChange::Own, "Its own."),
        (
            "averaged",
            VolumeChange::Averaged,
            "The mean around its nodes, for nearly incompressible materials.",
        ),
    ];
}

/// The materials by name.
pub struct Materials(Arc<[DocumentNode]>);

impl Materials {
    /// The materials in the order of the file.
    pub fn resolve(&self, context: &Context) -> Result<Vec<NamedMaterial>, Fault> {
        self.0.iter().map(|node| material(node, context)).collect()
    }
}

/// One material: its density and exactly one law.
fn material(node: &DocumentNode, context: &Context) -> Result<NamedMaterial, Fault> {
    let laws: Vec<&str> = LAWS.iter().map(|law| law.name).collect();
    let own = ["density", "volume_change", "thermal_expansion"];
    let keys: Vec<&str> = own.into_iter().chain(laws.iter().copied()).chain([OUTSIDE]).collect();
    if node.name() == "any" {
        return Err(Fault::new(&node.key(), "the name `any`, which matches every body", "another name"));
    }
    let other = |child: &&DocumentNode| !keys.contains(&child.name());
    if let Some((child, answer)) =
        node.children().iter().find(other).and_then(|child| Some((child, other_laws::answer(child.name())?)))
    {
        return Err(unknown_key(child, &keys).help(Some(answer)));
    }
    check_keys(node, &keys)?;
    let density = field::<QuantityInput<Density>>(node, "density")?.positive(context)?;
    let volume_change = field::<Option<Word<VolumeChange>>>(node, "volume_change")?;
    let volume_change = volume_change.map_or(Ok(VolumeChange::Own), |word| word.value(context))?;
    if volume_change == VolumeChange::Averaged && context.dimension == Dimension::PlaneStress {
        let found = "\"averaged\" in plane stress".to_string();
        let key = format!("{}.volume_change", node.key());
        let help = Some("a plate takes the thickness that leaves its volume free: nothing locks".to_string());
        return Err(Problem { key, found, allowed: "\"own\"".to_string(), help }.into());
    }
    let thermal_expansion = field::<Option<QuantityInput<Ratio>>>(node, "thermal_expansion")?;
    let thermal_expansion = thermal_expansion.map_or(Ok(0.0), |alpha| {
        alpha
            .checked(context, "a number per kelvin, of magnitude below 0.01, like 1.2e-5", |x| x.abs() < 0.01)
    })?;
    let is_law = |child: &&DocumentNode| child.name() == OUTSIDE || laws.contains(&child.name());
    let mut named = node.children().iter().filter(is_law);
    let Some(table) = named.next() else {
        let example = "neo_hookean = { bulk_modulus = \"6 MPa\", shear_modulus = \"3 MPa\" }";
        let allowed = format!("a law ({}), like {example}", laws.join(", "));
        return Err(Fault::new(&node.key(), "no law", allowed).at(node.name_span()));
    };
    if let Some(second) = named.next() {
        let found = format!("a second law, `{}` besides `{}`", second.name(), table.name());
        return Err(Fault::new(&second.key(), found, "one law").at(second.name_span()));
    }
    let built = match LAWS.iter().find(|law| law.name == table.name()) {
        Some(law) => law.build(&constants(table, (law.constants, None), context)?),
        None => {
            let given = constants(table, (OUTSIDE_CONSTANTS, Some("law")), context)?;
            outside_law(field::<Text>(table, "law")?.value(context)?, &given)
        }
    };
    let law = built.map_err(|bad| {
        let child =
            bad.key.as_ref().and_then(|key| table.children().iter().find(|child| child.name() == *key));
        let key = child.unwrap_or(table).key();
        let found = match child {
            Some(child) if !bad.found.is_empty() && bad.found != child.found() => {
                format!("{} ({})", child.found(), bad.found)
            }
            _ => bad.found,
        };
        Problem { key, found, allowed: bad.allowed, help: None }
    })?;
    if volume_change == VolumeChange::Averaged && matches!(law, Material::DruckerPrager(_)) {
        let help =
            "it opens by particles: with averaged volumes a column of sand lost 40 % of its height at rest";
        return Err(Problem {
            key: format!("{}.volume_change", node.key()),
            found: "\"averaged\" of `drucker_prager`".to_string(),
            allowed: "\"own\"".to_string(),
            help: Some(help.to_string()),
        }
        .into());
    }
    Ok(NamedMaterial { name: node.name().to_string(), density, law, volume_change, thermal_expansion })
}

/// The constants of a law in SI units; the key `other` is none of them.
fn constants(
    table: &DocumentNode,
    (declared, other): (&[Constant], Option<&str>),
    context: &Context,
) -> Result<Given, Fault> {
    let names: Vec<&str> = other.into_iter().chain(declared.iter().map(|constant| constant.name)).collect();
    let Value::Table(children) = &table.value else {
        return Err(table.fault(format!("a table {{ ... }} with the keys {}", names.join(", "))));
    };
    let mut given = Given::default();
    for child in children.iter().filter(|child| other != Some(child.name())) {
        let constant = declared.iter().find(|constant| constant.name == child.name());
        let constant = constant.ok_or_else(|| unknown_constant(child, &names))?;
        let values = match constant.form {
            Form::Number(wanted) => vec![number(child, &wanted, context)?],
            Form::Pairs(wanted, _) => pairs(child, (constant, &wanted), context)?,
            Form::Word(words) => vec![word(child, words, context)?],
        };
        given.put(child.name().to_string(), values);
    }
    Ok(given)
}

/// The fault of a key that is no constant of a law.
fn unknown_constant(child: &DocumentNode, known: &[&str]) -> Fault {
    let fault = unknown_key(child, known);
    match other_constants::meant(child.name(), known) {
        Some(meant) => fault.help(Some(format!("did you mean `{meant}`?"))),
        None => fault,
    }
}

/// Angles are numbers by their dimension, but are written with a unit.
fn is_angle(wanted: &Wanted) -> bool {
    wanted.unit.symbol == ANGLE.symbol
}

/// A value of it as one writes it.
fn example_of(wanted: &Wanted) -> String {
    match is_angle(wanted) {
        true => Angle::example(),
        false => Powers::from(wanted.unit.powers).example(),
    }
}

fn number(node: &DocumentNode, wanted: &Wanted, context: &Context) -> Result<f64, Fault> {
    let powers = Powers::from(wanted.unit.powers);
    let allowed = match powers == Powers::NONE {
        true if is_angle(wanted) => QuantityInput::<Angle>::wanted(),
        true => powers.name(),
        false => format!("{}, like \"{}\"", powers.name(), powers.example()),
    };
    Ok(evaluate(node, powers, &allowed, (context, Dependence::Constant))?.at(0.0))
}

/// The numbers of a list of pairs, one after the other.
fn pairs(
    node: &DocumentNode,
    (constant, wanted): (&Constant, &[Wanted; 2]),
    context: &Context,
) -> Result<Vec<f64>, Fault> {
    let [first, second] = wanted;
    let allowed = || format!("a list of pairs [{}, {}]: {}", first.name, second.name, constant.summary);
    let Value::List(rows) = &node.value else { return Err(node.fault(allowed())) };
    let mut values = Vec::new();
    for row in rows.iter() {
        let Value::List(pair) = &row.value else { return Err(row.fault(allowed())) };
        let [a, b] = &pair[..] else { return Err(row.fault(allowed())) };
        values.extend([number(a, first, context)?, number(b, second, context)?]);
    }
    Ok(values)
}

/// The place of a word among those that may stand here.
fn word(node: &DocumentNode, words: &[(&str, &str)], context: &Context) -> Result<f64, Fault> {
    let names = || words.iter().map(|(name, _)| *name);
    let quoted: Vec<String> = names().map(|name| format!("{name:?}")).collect();
    let allowed = listed(quoted.iter().map(String::as_str));
    let Value::Text(_) = node.value else { return Err(node.fault(allowed)) };
    let text = Text::read(node)?;
    let given = text.value(context)?;
    let place = names().position(|name| name == given);
    let place = place.ok_or_else(|| text.refused(&given, allowed).help(did_you_mean(&given, names())))?;
    Ok(place as f64)
}

/// What the schema says of a constant.
fn schema_of(constant: &Constant) -> Schema {
    let mut schema = match &constant.form {
        Form::Number(wanted) => {
            json_schema!({ "type": ["number", "string"], "examples": [example_of(wanted)] })
        }
        Form::Pairs(pair, most) => {
            let example = pair.map(|wanted| example_of(&wanted));
            json_schema!({
                "type": "array",
                "minItems": 1,
                "maxItems": most,
                "items": { "type": "array", "minItems": 2, "maxItems": 2, "items": { "type": ["number", "string"] } },
                "examples": [[example]],
            })
        }
        Form::Word(words) => {
            let words =
                words.iter().map(|(name, about)| json_schema!({ "const": name, "description": about }));
            let parameter =
                json_schema!({ "type": "string", "pattern": "\\{", "description": "A parameter in braces." });
            let all: Vec<Schema> = words.chain([parameter]).collect();
            json_schema!({ "anyOf": all })
        }
    };
    schema.insert("description".into(), constant.summary.into());
    schema
}

impl Read for Materials {
    fn wanted() -> String {
        "a table for each material: [materials.NAME] with density and a law".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::Table(materials) if !materials.is_empty() => Ok(Materials(materials.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for Materials {
    fn schema_name() -> Cow<'static, str> {
        "Materials".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut properties = serde_json::Map::new();
        let mut density = QuantityInput::<Density>::json_schema(generator);
        density.insert("description".into(), "Mass per undeformed volume [kg/m^3].".into());
        properties.insert("density".into(), density.into());
        let mut volume_change = Word::<VolumeChange>::json_schema(generator);
        volume_change.insert(
            "description".into(),
            "Whose change of volume a particle takes; its own by default.".into(),
        );
        properties.insert("volume_change".into(), volume_change.into());
        let mut expansion = QuantityInput::<Ratio>::json_schema(generator);
        expansion.insert(
            "description".into(),
            "Coefficient of thermal expansion [1/K], for loads that are temperatures; 0 by default.".into(),
        );
        properties.insert("thermal_expansion".into(), expansion.into());
        let constants_of = |constants: &[Constant]| -> serde_json::Map<_, _> {
            constants.iter().map(|constant| (constant.name.to_string(), schema_of(constant).into())).collect()
        };
        for law in LAWS {
            let constants = constants_of(law.constants);
            let table = json_schema!({
                "description": law.summary,
                "type": "object",
                "properties": constants,
                "additionalProperties": false,
            });
            properties.insert(law.name.into(), table.into());
        }
        let mut outside = constants_of(OUTSIDE_CONSTANTS);
        let mut law = Text::json_schema(generator);
        law.insert("description".into(), "Name of the law.".into());
        outside.insert("law".into(), law.into());
        let outside = json_schema!({
            "description": "A law that the program which runs the scene gives, such as a function of Python, with its \
                            moduli at small strain.",
            "type": "object",
            "properties": outside,
            "required": ["law"],
            "additionalProperties": false,
        });
        properties.insert(OUTSIDE.into(), outside.into());
        let names = LAWS.iter().map(|law| law.name).chain([OUTSIDE]);
        let one: Vec<Schema> = names.map(|name| json_schema!({ "required": [name] })).collect();
        json_schema!({
            "type": "object",
            "minProperties": 1,
            "additionalProperties": {
                "type": "object",
                "properties": properties,
                "required": ["density"],
                "oneOf": one,
                "additionalProperties": false,
            },
        })
    }
}
