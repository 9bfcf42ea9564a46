//! The scene file as it is written: its tables, one file each, with what each key means and how it becomes part of a
//! [`Scene`](super::Scene). The documentation of a key here is its description in the schema.

mod array;
mod body;
mod contact;
mod csv_table;
mod damping;
mod files;
mod fringes;
mod health;
mod image;
mod joints;
mod loads;
mod material;
mod measurements;
mod mesh;
mod named_shapes;
mod obj;
mod other_constants;
mod other_laws;
mod outline;
mod outputs;
mod outside;
mod packing;
mod pixels;
mod ply;
mod point_cloud;
mod quantity;
mod read;
mod repeat;
mod shape;
mod solid;
mod space;
mod springs;
mod start;
mod text;
mod time;
mod unused;
mod vector;

pub use files::{Disk, SceneFiles};

use super::document_node::{DocumentNode, Value};
use super::error::Fault;
use super::parameters::{Dependence, Parameters};
use super::source::{Declared, Source, Told};
use super::{Damping, Dimension, Gravity, Scene};
use crate::check;
use named_shapes::NamedShapes;
use quantity::Acceleration;
use read::{Read, table};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use std::borrow::Cow;
use std::cell::RefCell;
use std::path::Path;
use std::sync::Arc;
use text::Text;

/// What values in a file are read with.
pub struct Context<'a> {
    /// The named parameters.
    pub parameters: &'a Parameters<'a>,
    /// How many components vectors have.
    pub dimension: Dimension,
    /// Shapes by name.
    pub shapes: &'a NamedShapes,
    /// Where the file lies, and those that it names.
    pub folder: &'a Path,
    /// What reads those.
    pub files: &'a dyn SceneFiles,
    /// Keys that turned out to do nothing.
    told: &'a RefCell<Vec<Told>>,
}

impl Context<'_> {
    /// Notes that a key does nothing, and why; once, however often its table is repeated.
    pub fn tell(&self, key: &str, why: impl Into<String>) {
        let mut told = self.told.borrow_mut();
        if told.iter().all(|(known, _)| known != key) {
            told.push((key.to_string(), why.into()));
        }
    }
}

/// What a file says.
pub(super) struct Resolved {
    pub scene: Scene,
    /// Where in the file what it lists is declared.
    pub declared: Declared,
    /// Keys that do nothing.
    pub told: Vec<Told>,
}

table! {
    /// A Stickslip scene. Numbers are SI or text with a unit ("6 MPa") or a formula ("radius / 8"); {name} puts a
    /// parameter into text.
    File {
        /// One line for plots, pictures and summaries; by default the name of the file.
        title: Option<Text>,
        /// What the scene shows, and the numbers it must give.
        about: Option<Text>,
        /// Acceleration of every body, such as [0, 0, "-9.81 m/s^2"]; numbers, formulas of the time t or tables. By
        /// default none. It stands above the first [table].
        gravity: Option<loads::VaryingVector<Acceleration>>,
        /// Named numbers, formulas and words for the rest of the file; `--set name=value` replaces one.
        parameters: Option<ParameterTable>,
        /// Shapes by name, for use wherever a shape is: shape = "tooth", within = "clamp". Each may name those above it.
        shapes: Option<named_shapes::ShapeTable>,
        /// Dimensions, cells, particles and domain.
        space: space::Space,
        /// Duration and time step.
        time: time::Time,
        /// From where bodies begin, if not as their shapes are filled.
        start: Option<start::Start>,
        /// What slows the bodies down beside contact and materials; by default nothing, with `time.relax` a little.
        damping: Option<damping::Damping>,
        /// What a run watches while it goes on, and what it does where something is wrong; by default it warns.
        health: Option<health::Health>,
        /// The materials by name.
        materials: material::Materials,
        /// The bodies: [[bodies]]. There must be one at least, here, in a packing, an image or a point cloud.
        bodies: Option<Vec<body::Body>>,
        /// Many bodies at once, at random places in a container: [[packings]].
        packings: Option<Vec<packing::Packing>>,
        /// Bodies from an image, a body of each label or bright part: [[images]].
        images: Option<Vec<image::Image>>,
        /// Bodies from particles in CSV files: [[point_clouds]].
        point_clouds: Option<Vec<point_cloud::PointCloud>>,
        /// What holds parts of bodies, or drives them: [[supports]].
        supports: Option<Vec<loads::Support>>,
        /// What pushes or pulls parts of bodies: [[loads]].
        loads: Option<Vec<loads::Load>>,
        /// What joins free rigid bodies to each other and to the ground: [[joints]].
        joints: Option<Vec<joints::Joint>>,
        /// Springs and dashpots between parts of bodies: [[springs]].
        springs: Option<Vec<springs::SpringBetween>>,
        /// Rules for how bodies touch: [[contact]]. The first that matches a pair holds; a pair that none matches has
        /// the surface law without friction.
        contact: Option<Vec<contact::Contact>>,
        /// What is written, and how often.
        outputs: Option<outputs::Outputs>,
        /// Known answers that plots and summaries hold the run against: [[references]].
        references: Option<Vec<outputs::Reference>>,
    }
}

/// Named parameters: [`Parameters`] reads them.
pub struct ParameterTable(Arc<[DocumentNode]>);

/// The scene that a source describes.
///
/// # Errors
/// The first mistake found.
pub(super) fn resolve(source: &Source, files: &dyn SceneFiles) -> Result<Resolved, Fault> {
    let file = File::read(source.root())?;
    let parameters = Parameters::new(source, file.parameters.as_ref().map_or(&[], |table| &table.0))?;
    let values = parameters.resolved()?;
    let folder = source.folder();
    let (shapes, told) = (NamedShapes::default(), RefCell::default());
    let dimension = Dimension::Space;
    let mut context =
        Context { parameters: &parameters, dimension, shapes: &shapes, folder, files, told: &told };
    context.dimension = file.space.dimension.value(&context)?;
    let context = &context;
    file.shapes.map_or(Ok(()), |table| table.resolve(context))?;

    let time = file.time.resolve(context)?;
    let materials = file.materials.resolve(context)?;
    let domain = file.space.domain(context)?;
    let listed = file.bodies.as_deref().unwrap_or_default();
    let mut bodies = body::resolve(listed, (&materials, domain.as_ref()), context)?;
    for (i, packing) in file.packings.iter().flatten().enumerate() {
        let declared = format!("packings[{i}]");
        packing.add_to(&mut bodies, (&materials, &declared), (domain.as_ref(), context))?;
    }
    for (i, image) in file.images.iter().flatten().enumerate() {
        image.add_to(&mut bodies, (&materials, &format!("images[{i}]")), context)?;
    }
    for (i, cloud) in file.point_clouds.iter().flatten().enumerate() {
        let cell = file.space.discretization(context)?.cell;
        cloud.add_to(&mut bodies, (&materials, &format!("point_clouds[{i}]"), cell), context)?;
    }
    if bodies.all.is_empty() {
        let allowed = "at least one [[bodies]], [[packings]], [[images]] or [[point_clouds]]";
        return Err(Fault::new("bodies", "no body", allowed));
    }
    let body::Bodies { all: bodies, declared, .. } = bodies;
    let contact =
        contact::resolve(file.contact.as_deref().unwrap_or_default(), (&bodies, &materials), context)?;
    let (supports, loads) = (file.supports.unwrap_or_default(), file.loads.unwrap_or_default());
    let loads = loads::resolve(&supports, &loads, (&bodies, context))?;
    let joints = joints::resolve(file.joints.as_deref().unwrap_or_default(), (&bodies, context))?;
    let springs = file.springs.as_deref().unwrap_or_default();
    let springs = springs::resolve(springs, &joints.all, (&bodies, context))?;
    let known = (&bodies[..], &materials[..], time.end);
    let (outputs, declared_probes) = outputs::resolve(file.outputs.as_ref(), known, context)?;
    let declared = Declared::from([
        ("bodies", declared),
        ("outputs.probes", declared_probes),
        ("supports", loads.declared_supports),
        ("loads", loads.declared_loads),
        ("joints", joints.declared),
        ("springs", springs.declared),
    ]);
    let given = file.outputs.as_ref().is_some_and(|outputs| outputs.tables.is_some());
    let stem = source.name().rsplit(['/', '\\']).next().unwrap_or_default().trim_end_matches(".toml");
    let mut scene = Scene {
        title: file.title.as_ref().map_or_else(|| Ok(stem.to_string()), |title| title.value(context))?,
        about: file.about.as_ref().map_or(String::new(), Text::as_prose),
        parameters: values,
        dimension: context.dimension,
        precision: file.space.precision(context)?,
        discretization: file.space.discretization(context)?,
        domain,
        damping: match file.damping {
            Some(damping) => damping.resolve(context, time.relax)?,
            None => Damping::of(time.relax),
        },
        health: file.health.map(|health| health.resolve(context)).transpose()?.unwrap_or_default(),
        start: file.start.map(|start| start.resolve(context)).transpose()?,
        gravity: match file.gravity {
            Some(gravity) => Gravity(gravity.resolve(context, Dependence::Time)?),
            None => Gravity::default(),
        },
        outputs,
        references: outputs::references(file.references.as_deref().unwrap_or_default(), &bodies, context)?,
        time,
        materials,
        bodies: bodies.into(),
        loads: loads.all,
        joints: joints.all,
        springs: springs.all,
        contact,
    };
    if scene.time.relax.is_some() && !given {
        scene.outputs.tables = scene.rows_of_relaxation();
    }
    if file.space.leaves_interior_open(context)? {
        let outputs = file.outputs.as_ref();
        let of_grid = [
            ("space.basis", file.space.basis.is_some()),
            ("time.transfer", file.time.transfer.is_some()),
            ("time.stress_update", file.time.stress_update.is_some()),
            ("time.pic_share", file.time.pic_share.is_some()),
            ("outputs.grid", outputs.is_some_and(|outputs| outputs.grid.is_some())),
        ];
        let wanted = of_grid.into_iter().find(|(_, is_given)| *is_given).map(|(key, _)| key);
        check::choose_interior(&mut scene, wanted);
    }
    let mut told = told.take();
    told.extend(unused::keys(source.root(), (&scene, &shapes)));
    Ok(Resolved { scene, declared, told })
}

impl Read for ParameterTable {
    fn wanted() -> String {
        "a table: [parameters]".to_string()
    }

    fn read(node: &DocumentNode) -> Result<Self, Fault> {
        match &node.value {
            Value::Table(nodes) => Ok(ParameterTable(nodes.clone())),
            _ => Err(node.fault(Self::wanted())),
        }
    }
}

impl JsonSchema for ParameterTable {
    fn schema_name() -> Cow<'static, str> {
        "Parameters".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "object", "additionalProperties": { "type": ["number", "string"] } })
    }
}
