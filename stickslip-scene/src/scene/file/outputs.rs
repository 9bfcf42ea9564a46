//! `[outputs]` and `[[references]]`: what is written, and what it is held against.

use super::Context;
use super::fringes::Fringes;
use super::measurements::{self, Arrival, Fabric, Front, Group, Probe, Sampling, Section, Tractions};
use super::quantity::{Duration, QuantityInput, evaluate};
use super::read::{Read, table};
use super::text::{Choice, Count, Text, Word, names_in};
use crate::column;
use crate::scene::document_node::{DocumentNode, Value};
use crate::scene::error::Fault;
use crate::scene::parameters::Dependence;
use crate::scene::units::Powers;
use crate::scene::{self, Body, Compression, NamedMaterial, Precision, SeriesFormat, SnapshotContent};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;

table! {
    /// What is written, and how often, in simulated time.
    Outputs {
        /// Interval between rows of bodies.csv, energy.csv and contacts.csv [s]; by default 1/200 of the run,
        /// with more than 30 bodies longer, 1/30 of it from 200 bodies on; with time.relax at most that of 100 steps,
        /// or of up to 667 with as many bodies.
        tables: Option<QuantityInput<Duration>>,
        /// Names of the bodies that have rows in bodies.csv, or patterns in which `*` is any letters; by default all.
        /// Bodies of [[references]] have them in any case.
        bodies: Option<Vec<Text>>,
        /// Interval between snapshots of the particles for ParaView [s], or "never"; by default 1/20 of the run, with
        /// more than 40 bodies longer, 1/4 of it from 200 bodies on.
        particles: Option<Interval>,
        /// Times of further snapshots of the particles [s].
        particles_at: Option<Vec<QuantityInput<Duration>>>,
        /// What snapshots hold; by default all columns of all particles, in single precision.
        snapshots: Option<Snapshots>,
        /// Interval between snapshots of the bodies' surfaces [s], or "never": triangles that move with the bodies, rigid
        /// ones too. Half-spaces have one where the domain has bounds.
        #[schemars(extend("default" = "never"))]
        surfaces: Option<Interval>,
        /// What files of the bodies' surfaces are for.
        #[schemars(extend("default" = "vtp"))]
        surface_format: Option<Word<SeriesFormat>>,
        /// Interval between snapshots of the grid for ParaView [s], or "never".
        #[schemars(extend("default" = "never"))]
        grid: Option<Interval>,
        /// Pictures of photoelastic fringes, and an animation of them: a camera behind a virtual polariscope.
        fringes: Option<Fringes>,
        /// Interval between checkpoints, from which `stickslip resume` goes on [s], or "never"; beside those that
        /// `stickslip run` makes by wall time, and at the end.
        #[schemars(extend("default" = "never"))]
        checkpoints: Option<Interval>,
        /// What non-dimensional time counts in, such as "diameter / c_L" [s]; tables then have a column `time_units`.
        time_unit: Option<QuantityInput<Duration>>,
        /// Interval between samples of probes, arrivals and fronts [s], or "step" for every step;
        /// by default 1/1000 of the run.
        samples: Option<Sampling>,
        /// Points at which velocity and stress are recorded: [[outputs.probes]].
        probes: Option<Vec<Probe>>,
        /// Thresholds whose first passing is recorded: [[outputs.arrivals]].
        arrivals: Option<Vec<Arrival>>,
        /// Fronts whose position and speed are recorded: [[outputs.fronts]].
        fronts: Option<Vec<Front>>,
        /// Planes through which forces and moments are recorded, at the times of the tables: [[outputs.sections]].
        sections: Option<Vec<Section>>,
        /// Faces of the domain and rigid bodies on which forces are recorded, at the times of the tables: names, or
        /// patterns of names: ["y_min", "plate*"].
        reactions: Option<Vec<Text>>,
        /// Bodies whose sums are recorded, at the times of the tables: [[outputs.groups]].
        groups: Option<Vec<Group>>,
        /// Packings whose stress and fabric are recorded, at the times of the tables: [[outputs.fabric]].
        fabric: Option<Vec<Fabric>>,
        /// Points of contact whose pressure and shear are recorded: those of bodies on grids of their own.
        tractions: Option<Tractions>,
    }
}

table! {
    /// What snapshots of the particles, and of the grid, hold.
    Snapshots {
        /// Number format of files, whatever the run computes with.
        #[schemars(extend("default" = "single"))]
        precision: Option<Word<Precision>>,
        /// How files are packed; other programs read both.
        #[schemars(extend("default" = "zlib"))]
        compression: Option<Word<Compression>>,
        /// Columns of the particles beside positions, body and number: velocity, stress, pressure, von_mises,
        /// deformation, mass, volume, and what laws remember; by default all. Pictures, and fringes of a finished run,
        /// need the first of these but for pressure and von_mises.
        columns: Option<Vec<Text>>,
        /// Names of the bodies whose particles they hold, or patterns in which `*` is any letters; by default all. Files
        /// of surfaces have the same bodies.
        bodies: Option<Vec<Text>>,
        /// Of each body only each so many-th particle; then there are no pictures, and no fringes of a finished run.
        #[schemars(extend("default" = 1))]
        every: Option<Count>,
    }
}

table! {
    /// A known answer for one quantity of one body.
    Reference {
        /// Name of the body.
        body: Text,
        /// A column of bodies.csv: x, vx, wz ...
        quantity: Text,
        /// Its exact value, a formula of `t`: "25 * sqrt(2) / 14 * t^2".
        value: Answer,
        /// What the answer assumes: "rigid sphere".
        label: Text,
    }
}

/// A time, or "never".
pub enum Interval {
    /// The word.
    Never,
    /// The time.
    Every(QuantityInput<Duration>),
}

/// A formula whose dimension depends on the quantity it is for.
pub struct Answer(DocumentNode);

/// Columns of `bodies.csv` that a reference can name, with powers of kilogram, metre and second.
const QUANTITIES: &[(&str, [i8; 3])] = &[
    ("x", [0, 1, 0]),
    ("y", [0, 1, 0]),
    ("z", [0, 1, 0]),
    ("vx", [0, 1, -1]),
    ("vy", [0, 1, -1]),
    ("vz", [0, 1, -1]),
    ("wx", [0, 0, -1]),
    ("wy", [0, 0, -1]),
    ("wz", [0, 0, -1]),
    ("mass", [1, 0, 0]),
    ("kinetic", [1, 2, -2]),
    ("strain", [1, 2, -2]),
];

/// What is written in a run of length `end` [s], and of each probe its table in the file.
pub fn resolve(
    outputs: Option<&Outputs>,
    (bodies, materials, end): (&[Body], &[NamedMaterial], f64),
    context: &Context,
) -> Result<(scene::Outputs, Vec<String>), Fault> {
    let mut resolved = scene::Outputs::of_bodies(bodies.len(), end);
    let Some(outputs) = outputs else { return Ok((resolved, Vec::new())) };
    if let Some(interval) = &outputs.tables {
        resolved.tables = interval.positive(context)?;
    }
    if let Some(names) = &outputs.bodies {
        let known: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
        resolved.bodies = Some(names_in(names, ("the name of a body", &known), context)?);
    }
    if let Some(interval) = &outputs.particles {
        resolved.particles = interval.value(context)?;
    }
    for time in outputs.particles_at.iter().flatten() {
        resolved.particles_at.push(time.positive(context)?);
    }
    resolved.particles_at.sort_by(f64::total_cmp);
    if let Some(snapshots) = &outputs.snapshots {
        resolved.snapshots = snapshots.resolve((bodies, materials), context)?;
    }
    if let Some(interval) = &outputs.surfaces {
        resolved.surfaces = interval.value(context)?;
    }
    if let Some(format) = &outputs.surface_format {
        resolved.surface_format = format.value(context)?;
    }
    if let Some(interval) = &outputs.grid {
        resolved.grid = interval.value(context)?;
    }
    if let Some(interval) = &outputs.checkpoints {
        resolved.checkpoints = interval.value(context)?;
    }
    if let Some(fringes) = &outputs.fringes {
        resolved.fringes = Some(fringes.resolve((bodies, end), context)?);
    }
    let (measurements, declared) = measurements::resolve(outputs, (bodies, end), context)?;
    resolved.measurements = measurements;
    outputs.tell_of_dead_keys(&resolved, end, context);
    Ok((resolved, declared))
}

impl Outputs {
    /// Tells of keys for files that there are none of, and of times after the end.
    fn tell_of_dead_keys(&self, resolved: &scene::Outputs, end: f64, context: &Context) {
        let late = |time: &&QuantityInput<Duration>| time.value(context).is_ok_and(|time| time > end);
        let count = self.particles_at.iter().flatten().filter(late).count();
        if let Some(time) = self.particles_at.iter().flatten().find(late) {
            let times = if count == 1 { "this time is".to_string() } else { format!("{count} times are") };
            let why = format!("{times} after the end of the run, {end} s: no snapshot comes of it");
            context.tell(&time.node().key(), why);
        }
        if let Some(first) = resolved.fringes.as_ref().map(|fringes| fringes.first).filter(|&at| at > end) {
            let why = format!("the first frame, at {first} s, is after the end of the run, {end} s");
            context.tell("outputs.fringes.first", why);
        }
        let snapshots = resolved.particles.is_some() || !resolved.particles_at.is_empty();
        let files = snapshots || resolved.surfaces.is_some() || resolved.grid.is_some();
        if self.snapshots.is_some() && !files {
            let why = "does not act: the scene has no snapshots of particles, surfaces or the grid";
            context.tell("outputs.snapshots", why);
        }
        if self.surface_format.is_some() && resolved.surfaces.is_none() {
            context.tell("outputs.surface_format", "does not act: the scene has no outputs.surfaces");
        }
        let wanted = &resolved.measurements;
        if self.samples.is_some() && wanted.probes.len() + wanted.arrivals.len() + wanted.fronts.len() == 0 {
            context.tell("outputs.samples", "does not act: the scene has no probes, arrivals or fronts");
        }
    }
}

impl Snapshots {
    fn resolve(
        &self,
        (bodies, materials): (&[Body], &[NamedMaterial]),
        context: &Context,
    ) -> Result<SnapshotContent, Fault> {
        let mut content = SnapshotContent::default();
        if let Some(precision) = &self.precision {
            content.precision = precision.value(context)?;
        }
        if let Some(compression) = &self.compression {
            content.compression = compression.value(context)?;
        }
        if let Some(columns) = &self.columns {
            let mut known: Vec<&str> = column::optional_in_files().collect();
            for history in materials.iter().flat_map(|material| material.law.history()) {
                if !known.contains(&history.column.name) {
                    known.push(history.column.name);
                }
            }
            content.columns = Some(names_in(columns, ("a column of particles", &known), context)?);
        }
        if let Some(names) = &self.bodies {
            let known: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
            content.bodies = Some(names_in(names, ("the name of a body", &known), context)?);
        }
        if let Some(every) = &self.every {
            content.every = every.value(context, 1..=MOST_EVERY)?;
        }
        Ok(content)
    }
}

/// Particles of which a snapshot holds one, at most.
const MOST_EVERY: usize = 1_000_000;

/// The known answers.
pub fn references(
    references: &[Reference],
    bodies: &[Body],
    context: &Context,
) -> Result<Vec<scene::Reference>, Fault> {
    let bodies: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    let names: Vec<&str> = QUANTITIES.iter().map(|(name, _)| *name).collect();
    let resolve = |reference: &Reference| {
        let body = reference.body.name_of(context, "the name of a body", &bodies)?;
        let quantity = reference.quantity.name_of(context, "a column of bodies.csv", &names)?;
        let (_, powers) =
            QUANTITIES.iter().find(|(name, _)| *name == quantity).expect("name_of found it in names");
        let powers = Powers::from(*powers);
        let allowed = format!("{}, like \"{}\"", powers.name(), powers.example());
        let value = evaluate(&reference.value.0, powers, &allowed, (context, Dependence::Time))?;
        Ok(scene::Reference { body, quantity, value, label: reference.label.value(context)? })
    };
    references.iter().map(resolve).collect()
}

impl Interval {
    fn value(&self, context: &Context) -> Result<Option<f64>, Fault> {
        match self {
            Interval::Never => Ok(None),
            Interval::Every(interval) => interval.positive(context).map(Some),
        }
    }
}

impl Choice for SeriesFormat {
    const WORDS: &'static [(&'static str, Self, &'static str)] = &[
        ("vtp", SeriesFormat::Vtp, "ParaView and PyVista, as polygons."),
        ("vtu", SeriesFormat::Vtu, "The same, as an unstructured grid, which meshio reads, too."),
        (
            "glb",
            SeriesFormat::Glb,
            "Blender, browsers and slides: models in glTF, in the colours of the bodies.",
        ),
    ];
}

impl Read for Interval {
    fn wanted() -> String {
        format!("{}, or \"never\"", QuantityInput::<Duration>::wanted())
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::Text(text) if text == "never" => Ok(Interval::Never),
            Value::Text(_) | Value::Number(_) => Ok(Interval::Every(QuantityInput::new(node))),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl Read for Answer {
    fn wanted() -> String {
        "a number, or a formula of t in quotes".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match node.value {
            Value::Text(_) | Value::Number(_) => Ok(Answer(node.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for Interval {
    fn schema_name() -> Cow<'static, str> {
        "Interval".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"], "examples": ["10 ms", "never"] })
    }
}

impl JsonSchema for Answer {
    fn schema_name() -> Cow<'static, str> {
        "Answer".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": ["number", "string"], "examples": ["1 m/s * t"] })
    }
}
