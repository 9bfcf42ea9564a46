//! `[[supports]]` and `[[loads]]`: what holds, presses, pulls or drives parts of bodies from outside.

use super::Context;
use super::csv_table::{CsvTable, TableColumns};
use super::outside::OrOutside;
use super::quantity::{
    Acceleration, Duration, Force, ForceOverVelocity, Length, Measure, Pressure, QuantityInput, Ratio,
    Stiffness, Velocity, evaluate,
};
use super::read::{Read, table};
use super::repeat::Repeat;
use super::shape::ShapeInput;
use super::text::{Choice, Text, Word};
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::units::Powers;
use crate::scene::{
    self, Action, Body, Dashpot, Expression, Extent, Part, SupportMotion, TimeTable, is_pattern,
};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::collections::HashSet;
use std::marker::PhantomData;

table! {
    /// What holds a part of a body, or drives it; without displacement and velocity it holds it where it is.
    Support {
        /// Its name in loads.csv; by default "support 1", "support 2" ...
        name: Option<Text>,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// Name of the body, one that deforms; a pattern in which `*` is any letters, such as "grain*", makes one on
        /// each body that matches.
        body: Text,
        /// Where on the body: its surface, a face of it, or all its particles.
        #[schemars(extend("default" = "surface"))]
        on: Option<Word<Extent>>,
        /// Only what lies in this shape at the start: within.ball = { center = [0, 0], radius = 1 }.
        within: Option<ShapeInput>,
        /// How far the part is from where it was at the start [m]; "free" along axes along which it is not held.
        displacement: Option<PartlyFree<Length>>,
        /// How fast the part moves [m/s]; "free" along axes along which it is not held.
        velocity: Option<PartlyFree<Velocity>>,
        /// Makes a spring of it: force over displacement, of all of the part [N/m]; by default as good as rigid.
        stiffness: Option<QuantityInput<Stiffness>>,
        /// Makes a dashpot of it: force over velocity, of all of the part [N s/m]; or "absorbing", which takes up the
        /// waves that come to a surface. By default none.
        dashpot: Option<DashpotInput>,
    }
}

table! {
    /// What pushes, pulls or heats a part of a body: one of force, traction, pressure, acceleration and temperature.
    Load {
        /// Its name in loads.csv; by default "load 1", "load 2" ...
        name: Option<Text>,
        /// Makes many of it: indices, and how many values each has, as of [[bodies]]. By default one.
        repeat: Option<Repeat>,
        /// Name of the body, one that deforms or is rigid and free; a pattern in which `*` is any letters, such as
        /// "grain*", makes one on each body that matches.
        body: Text,
        /// Where on the body: its surface, a face of it, or all its particles; by default the surface, for an
        /// acceleration and a temperature all particles.
        on: Option<Word<Extent>>,
        /// Only what lies in this shape at the start: within.ball = { center = [0, 0], radius = 1 }.
        within: Option<ShapeInput>,
        /// Force, shared out evenly over the part [N]; in the plane per metre of depth.
        force: Option<OrOutside<VaryingVector<Force>>>,
        /// Force per undeformed area [Pa].
        traction: Option<OrOutside<VaryingVector<Pressure>>>,
        /// Force per deformed area against the outward normal, which it follows [Pa].
        pressure: Option<OrOutside<Varying<Pressure>>>,
        /// Force per mass [m/s^2].
        acceleration: Option<OrOutside<VaryingVector<Acceleration>>>,
        /// How much warmer than at the start its particles are [K], a number without a unit; its material has a
        /// `thermal_expansion`.
        temperature: Option<Varying<Ratio>>,
    }
}

impl Choice for Extent {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("surface", Extent::Surface, "All of its surface."),
        ("x_min", Extent::Face { axis: 0, upper: false }, "Its surface that faces -x, within 45 degrees."),
        ("x_max", Extent::Face { axis: 0, upper: true }, "Its surface that faces x, within 45 degrees."),
        ("y_min", Extent::Face { axis: 1, upper: false }, "Its surface that faces -y, within 45 degrees."),
        ("y_max", Extent::Face { axis: 1, upper: true }, "Its surface that faces y, within 45 degrees."),
        (
            "z_min",
            Extent::Face { axis: 2, upper: false },
            "Its surface that faces -z; three dimensions only.",
        ),
        ("z_max", Extent::Face { axis: 2, upper: true }, "Its surface that faces z; three dimensions only."),
        ("volume", Extent::Volume, "All of its particles."),
    ];
}

/// A quantity that may vary in time and place: a number, a formula of `t` and of `x`, `y`, `z` now and `x0`, `y0`, `z0`
/// at the start, or a table.
pub struct Varying<M> {
    node: DocumentNode,
    measure: PhantomData<M>,
}

/// A vector of quantities that may vary.
pub struct VaryingVector<M> {
    node: DocumentNode,
    parts: Vec<Varying<M>>,
}

/// A vector of quantities that may vary, or of the word "free".
pub struct PartlyFree<M>(VaryingVector<M>);

/// A dashpot's number, or the word "absorbing".
pub struct DashpotInput(QuantityInput<ForceOverVelocity>);

impl DashpotInput {
    fn absorbs(&self) -> bool {
        matches!(&self.0.node().value, Value::Text(text) if text == "absorbing")
    }
}

impl Read for DashpotInput {
    fn wanted() -> String {
        format!("{}, or \"absorbing\"", QuantityInput::<ForceOverVelocity>::wanted())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) => Ok(DashpotInput(QuantityInput::new(node))),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for DashpotInput {
    fn schema_name() -> Cow<'static, str> {
        "Dashpot".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        QuantityInput::<ForceOverVelocity>::json_schema(generator)
    }
}

/// Loads and supports, and where in the file each is declared.
#[derive(Default)]
pub struct Loads {
    /// The supports, and then the loads.
    pub all: Vec<scene::Load>,
    /// Of each support, its table in the file: `supports[3]`.
    pub declared_supports: Vec<String>,
    /// Of each load.
    pub declared_loads: Vec<String>,
}

/// The supports, and then the loads, in the order of the file.
pub fn resolve(
    supports: &[Support],
    loads: &[Load],
    (bodies, context): (&[Body], &Context),
) -> Result<Loads, Fault> {
    let mut taken = HashSet::new();
    let [held, loaded] = [
        LoadableBodies::of(bodies, "the name of a body that deforms", |body| !body.is_rigid()),
        LoadableBodies::of(bodies, "the name of a body that deforms or is free", |body| {
            !body.is_prescribed()
        }),
    ];
    let mut resolved = Loads::default();
    for (table, support) in supports.iter().enumerate() {
        let Support { name, body, on, within, .. } = support;
        let place = Place { name, body, on, within, kind: "support", table };
        let mut add = |action| place.add(action, (&held, &mut taken), (&mut resolved.all, context));
        Repeat::each(support.repeat.as_ref(), context, || {
            let made = add((Action::Support(support.resolve(context)?), resolved.declared_supports.len()))?;
            resolved.declared_supports.extend(vec![format!("supports[{table}]"); made]);
            Ok(())
        })?;
    }
    for (table, load) in loads.iter().enumerate() {
        let Load { name, body, on, within, .. } = load;
        let place = Place { name, body, on, within, kind: "load", table };
        let mut add = |action| place.add(action, (&loaded, &mut taken), (&mut resolved.all, context));
        Repeat::each(load.repeat.as_ref(), context, || {
            let made = add((load.action(context, table)?, resolved.declared_loads.len()))?;
            resolved.declared_loads.extend(vec![format!("loads[{table}]"); made]);
            Ok(())
        })?;
    }
    Ok(resolved)
}

/// The bodies that loads may act on.
struct LoadableBodies<'a> {
    /// What these are.
    what: &'static str,
    names: Vec<&'a str>,
    /// Their places in the scene.
    places: Vec<usize>,
}

impl<'a> LoadableBodies<'a> {
    fn of(bodies: &'a [Body], what: &'static str, suits: impl Fn(&Body) -> bool) -> Self {
        let suitable = bodies.iter().enumerate().filter(|(_, body)| suits(body));
        let (places, names) = suitable.map(|(place, body)| (place, body.name.as_str())).unzip();
        LoadableBodies { what, names, places }
    }
}

/// What loads and supports have in common.
struct Place<'a> {
    name: &'a Option<Text>,
    body: &'a Text,
    on: &'a Option<Word<Extent>>,
    within: &'a Option<ShapeInput>,
    kind: &'static str,
    /// Number of its table among those of its kind.
    table: usize,
}

impl Place<'_> {
    /// One on each body that it names, and how many these are; `number` counts those before it.
    fn add(
        &self,
        (action, number): (Action, usize),
        (bodies, taken): (&LoadableBodies, &mut HashSet<String>),
        (loads, context): (&mut Vec<scene::Load>, &Context),
    ) -> Result<usize, Fault> {
        let (body_name, found) = self.body.names_of(context, bodies.what, &bodies.names)?;
        for (k, &found) in found.iter().enumerate() {
            let mut name = match self.name {
                Some(text) => text.value(context)?,
                None if is_pattern(&body_name) => self.kind.to_string(),
                None => format!("{} {}", self.kind, number + k + 1),
            };
            if is_pattern(&body_name) {
                name = format!("{name} on {}", bodies.names[found]);
            }
            if name.trim().is_empty() || !taken.insert(name.clone()) {
                let allowed = "a name that no other load or support has";
                let named = |text: &Text| text.refused(&name, allowed);
                let unnamed = || {
                    let found = format!("the name `{name}`, which another has");
                    Fault::new(&format!("{}s[{}]", self.kind, self.table), found, "a `name` of its own")
                };
                return Err(self.name.as_ref().map_or_else(unnamed, named));
            }
            loads.push(self.load((&name, bodies.places[found]), action.clone(), context)?);
        }
        Ok(found.len())
    }

    fn load(
        &self,
        (name, body): (&str, usize),
        action: Action,
        context: &Context,
    ) -> Result<scene::Load, Fault> {
        let load = scene::Load::new(name, body, action);
        let mut on = load.part.on;
        if let Some(word) = self.on {
            on = word.value(context)?;
            if context.dimension.is_plane() && matches!(on, Extent::Face { axis: 2, .. }) {
                return Err(word.refused(context, "another face, as the scene is plane"));
            }
            let no_area = matches!(load.action, Action::Pressure(_) | Action::Traction(_));
            let absorbs = matches!(
                &load.action,
                Action::Support(scene::Support { dashpot: Some(Dashpot::Absorbing), .. })
            );
            let no_area = no_area || absorbs;
            if on == Extent::Volume && no_area {
                return Err(word.refused(context, "a surface: a volume has no area"));
            }
            if on != Extent::Volume && load.action.is_on_particles() {
                return Err(word.refused(context, "\"volume\": a surface has no mass"));
            }
        }
        let within = self.within.as_ref().map(|shape| shape.resolve(context)).transpose()?;
        Ok(scene::Load { part: Part { on, within }, ..load })
    }
}

impl Support {
    fn resolve(&self, context: &Context) -> Result<scene::Support, Fault> {
        if let (Some(_), Some(velocity)) = (&self.displacement, &self.velocity) {
            let node = &velocity.0.node;
            return Err(Fault::new(&node.key(), "`velocity` beside `displacement`", "one of the two")
                .at(node.name_span()));
        }
        let mut support = scene::Support::fixed();
        if let Some(displacement) = &self.displacement {
            support.motion =
                displacement.resolve(context, SupportMotion::Displacement, Dependence::TimeAndPlace)?;
        }
        if let Some(velocity) = &self.velocity {
            let by_place =
                "one that varies from place to place is written as a displacement: \"0.1 Hz * t * x0\"";
            let motion = velocity.resolve(context, SupportMotion::Velocity, Dependence::Time);
            let varies =
                || velocity.resolve(context, SupportMotion::Velocity, Dependence::TimeAndPlace).is_ok();
            support.motion = motion.map_err(|fault| if varies() { fault.remark(by_place) } else { fault })?;
        }
        support.stiffness =
            self.stiffness.as_ref().map(|stiffness| positive(stiffness, context)).transpose()?;
        support.dashpot = match &self.dashpot {
            None => None,
            Some(dashpot) if dashpot.absorbs() => Some(Dashpot::Absorbing),
            Some(DashpotInput(number)) => Some(Dashpot::Whole(positive(number, context)?)),
        };
        Ok(support)
    }
}

impl Load {
    fn action(&self, context: &Context, number: usize) -> Result<Action, Fault> {
        let nodes = [
            self.force.as_ref().map(OrOutside::node),
            self.traction.as_ref().map(OrOutside::node),
            self.pressure.as_ref().map(OrOutside::node),
            self.acceleration.as_ref().map(OrOutside::node),
            self.temperature.as_ref().map(|input| &input.node),
        ];
        let allowed = "one of force, traction, pressure, acceleration and temperature";
        if let Some(second) = nodes.into_iter().flatten().nth(1) {
            let found = format!("`{}` beside another", second.name());
            return Err(Fault::new(&second.key(), found, allowed).at(second.name_span()));
        }
        if let Some(temperature) = &self.temperature {
            return Ok(Action::Temperature(temperature.resolve(context, Dependence::TimeAndPlace)?));
        }
        match (&self.force, &self.traction, &self.pressure, &self.acceleration) {
            (Some(force), ..) => Ok(Action::Force(vector(force, context)?)),
            (_, Some(traction), ..) => Ok(Action::Traction(vector(traction, context)?)),
            (_, _, Some(pressure), _) => {
                let number = |p: &Varying<Pressure>| {
                    Ok([p.resolve(context, Dependence::TimeAndPlace)?, NOTHING, NOTHING])
                };
                let [pressure, ..] = pressure.resolve(context, |i| i == 0, number)?;
                Ok(Action::Pressure(pressure))
            }
            (_, _, _, Some(acceleration)) => Ok(Action::Acceleration(vector(acceleration, context)?)),
            _ => Err(Fault::new(&format!("loads[{number}]"), "a load that does nothing", allowed)),
        }
    }
}

const NOTHING: Expression = Expression::Constant(0.0);

/// A vector that may vary in time and place, or come from outside.
fn vector<M: Measure>(
    input: &OrOutside<VaryingVector<M>>,
    context: &Context,
) -> Result<[Expression; 3], Fault> {
    input.resolve(
        context,
        |i| i < context.dimension.axes(),
        |vector| vector.resolve(context, Dependence::TimeAndPlace),
    )
}

/// What a number or formula says. A force in the plane is one per metre of depth, and may be written as that: in N or
/// in N/m; so for masses, and for whatever is a force times or over something else.
pub fn per_depth<M: Measure>(
    node: &DocumentNode,
    (context, dependence): (&Context, Dependence),
) -> Result<Expression, Fault> {
    let wanted = QuantityInput::<M>::wanted();
    let whole = Powers::from(M::POWERS);
    let found = evaluate(node, whole, &wanted, (context, dependence)).and_then(finite(node, &wanted));
    // All that has the unit of mass in it, and no pressure.
    if found.is_ok() || M::POWERS == Pressure::POWERS || M::POWERS[0] == 0 || !context.dimension.is_plane() {
        return found;
    }
    let part = whole.times(Powers::LENGTH, -1.0);
    let allowed = format!("{wanted}, or as much per metre of depth, {}", part.name());
    evaluate(node, part, &allowed, (context, dependence)).and_then(finite(node, &allowed))
}

/// Refuses a constant that is not finite.
fn finite<'a>(
    node: &'a DocumentNode,
    allowed: &'a str,
) -> impl Fn(Expression) -> Result<Expression, Fault> + 'a {
    move |value| match value {
        Expression::Constant(constant) if !constant.is_finite() => Err(node.fault(allowed)),
        value => Ok(value),
    }
}

/// A number above zero, such as a stiffness; in the plane as [`per_depth`] reads it.
pub fn positive<M: Measure>(input: &QuantityInput<M>, context: &Context) -> Result<f64, Fault> {
    let value = per_depth::<M>(input.node(), (context, Dependence::Constant))?.at(0.0);
    let allowed = || format!("{} above 0, like \"{}\"", M::name(), M::example());
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err(input.refused(value, allowed())) }
}

impl<M: Measure> Varying<M> {
    /// Its value in SI units; in the plane as [`per_depth`] reads it.
    pub fn resolve(&self, context: &Context, dependence: Dependence) -> Result<Expression, Fault> {
        match &self.node.value {
            Value::Table(_) => {
                Ok(Expression::Table(TableInput::read(&self.node)?.resolve::<M>(&self.node, context)?))
            }
            _ => per_depth::<M>(&self.node, (context, dependence)),
        }
    }

    fn is_free(&self) -> bool {
        matches!(&self.node.value, Value::Text(text) if text.trim() == "free")
    }
}

impl<M: Measure> VaryingVector<M> {
    /// Its components in SI units; in the plane the third is zero.
    pub fn resolve(&self, context: &Context, dependence: Dependence) -> Result<[Expression; 3], Fault> {
        self.sized(context)?;
        let mut resolved = [0.0; 3].map(Expression::Constant);
        for (part, resolved) in self.parts.iter().zip(&mut resolved) {
            *resolved = part.resolve(context, dependence)?;
        }
        Ok(resolved)
    }

    /// Where it stands.
    pub fn node(&self) -> &DocumentNode {
        &self.node
    }

    fn sized(&self, context: &Context) -> Result<(), Fault> {
        match (self.parts.len(), context.dimension.axes()) {
            (found, wanted) if found == wanted => Ok(()),
            (_, 2) => Err(self.node.fault("2 numbers, as the scene is plane: [x, y]")),
            _ => Err(self.node.fault("3 numbers, as the scene is 3d: [x, y, z]")),
        }
    }
}

impl<M: Measure> PartlyFree<M> {
    fn resolve(
        &self,
        context: &Context,
        motion: fn(Expression) -> SupportMotion,
        dependence: Dependence,
    ) -> Result<[Option<SupportMotion>; 3], Fault> {
        let PartlyFree(vector) = self;
        vector.sized(context)?;
        let mut resolved = [None, None, None];
        for (part, resolved) in vector.parts.iter().zip(&mut resolved) {
            if !part.is_free() {
                *resolved = Some(motion(part.resolve(context, dependence)?));
            }
        }
        if resolved.iter().all(Option::is_none) {
            return Err(vector
                .node
                .fault("a number along one axis at least: a part that is free needs no support"));
        }
        Ok(resolved)
    }
}

table! {
    /// Values at times: straight lines in between; before and after, the first and the last value.
    TableInput {
        /// Rows of a time and a value, times ascending: [["0 s", 0], ["1 ms", "3 kN"]].
        table: Option<Rows>,
        /// A file of them instead, text with a time and a value on each line: "0.001, 3000", in SI units, or in those
        /// that the first line has in brackets: "time [ms], force [kN]". A relative path starts at the folder of the
        /// scene file.
        csv: Option<Text>,
        /// Which columns of a file with more than two are the time and the value, by their names in the first line or by
        /// number from 1: ["time", "force"].
        columns: Option<TableColumns>,
    }
}

/// Rows of a table: the list of them.
pub struct Rows(DocumentNode);

impl TableInput {
    fn resolve<M: Measure>(&self, node: &DocumentNode, context: &Context) -> Result<TimeTable, Fault> {
        match (&self.table, &self.csv) {
            (Some(rows), None) if self.columns.is_none() => rows.resolve::<M>(context),
            (None, Some(file)) => CsvTable { file, columns: self.columns.as_ref(), context }.read::<M>(),
            _ => Err(node.fault("one of the keys table and csv, and columns beside csv only")),
        }
    }
}

impl Rows {
    fn resolve<M: Measure>(&self, context: &Context) -> Result<TimeTable, Fault> {
        let Rows(node) = self;
        let mut table: Vec<[f64; 2]> = Vec::new();
        for row in node.children() {
            let [time, value] = Rows::pair(row)?;
            let time_input = QuantityInput::<Duration>::new(time);
            let at = time_input.value(context)?;
            if let Some([before, _]) = table.last().filter(|[before, _]| *before >= at) {
                return Err(
                    time_input.refused(at, format!("a time after {before} s, that of the row before"))
                );
            }
            let value_input = QuantityInput::<M>::new(value);
            let value = per_depth::<M>(value, (context, Dependence::Constant))?.at(0.0);
            if !value.is_finite() {
                return Err(value_input.refused(value, QuantityInput::<M>::wanted()));
            }
            table.push([at, value]);
        }
        TimeTable::new(table).ok_or_else(|| node.fault(Rows::wanted()))
    }

    fn pair(row: &DocumentNode) -> Result<&[DocumentNode; 2], Fault> {
        let pair = if let Value::List(pair) = &row.value { (&pair[..]).try_into().ok() } else { None };
        pair.ok_or_else(|| row.fault("a time and a value"))
    }
}

impl Read for Rows {
    fn wanted() -> String {
        "a list of rows, each a time and a value: [[\"0 s\", 0], [\"1 ms\", 5]]".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        let Value::List(rows) = &node.value else { return Err(node.fault(Self::wanted())) };
        rows.iter().try_for_each(|row| Rows::pair(row).map(|_| ()))?;
        Ok(Rows(node.clone()))
    }
}

impl JsonSchema for Rows {
    fn schema_name() -> Cow<'static, str> {
        "Rows".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let number = json_schema!({ "type": ["number", "string"] });
        let row = json_schema!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 });
        json_schema!({ "type": "array", "items": row, "minItems": 1 })
    }
}

impl<M: Measure> Read for Varying<M> {
    fn wanted() -> String {
        format!("{}, a formula, {{ table = ... }} or {{ csv = ... }}", QuantityInput::<M>::wanted())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Number(_) | Value::Text(_) | Value::Table(_) => {
                Ok(Varying { node: node.clone(), measure: PhantomData })
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl<M: Measure> Read for VaryingVector<M> {
    fn wanted() -> String {
        format!("a list such as [0, \"{}\", 0], two in the plane", M::example())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::List(items) => {
                let parts = items.iter().map(Varying::read).collect::<Result<_, _>>()?;
                Ok(VaryingVector { node: node.clone(), parts })
            }
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl<M: Measure> Read for PartlyFree<M> {
    fn wanted() -> String {
        format!("a list such as [0, \"{}\", \"free\"], two in the plane", M::example())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::List(_) => VaryingVector::read(node).map(PartlyFree),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl<M: Measure> JsonSchema for Varying<M> {
    fn schema_name() -> Cow<'static, str> {
        format!("Varying_{}", Powers::from(M::POWERS).symbol()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (number, table) =
            (QuantityInput::<M>::json_schema(generator), generator.subschema_for::<TableInput>());
        json_schema!({ "anyOf": [number, table] })
    }
}

impl<M: Measure> JsonSchema for VaryingVector<M> {
    fn schema_name() -> Cow<'static, str> {
        format!("VaryingVector_{}", Powers::from(M::POWERS).symbol()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let part = Varying::<M>::json_schema(generator);
        json_schema!({ "type": "array", "items": part, "minItems": 2, "maxItems": 3 })
    }
}

impl<M: Measure> JsonSchema for PartlyFree<M> {
    fn schema_name() -> Cow<'static, str> {
        format!("PartlyFree_{}", Powers::from(M::POWERS).symbol()).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        VaryingVector::<M>::json_schema(generator)
    }
}
