//! `[[point_clouds]]`: bodies from particles in a CSV file.

use super::Context;
use super::body::{Bodies, BodyKeys, Rigid, material_of};
use super::files::read_file;
use super::quantity::{Length, QuantityInput, Velocity};
use super::read::table;
use super::text::Text;
use super::vector::{SpinInput, VectorInput};
use crate::geometry::{CloudPoints, Curved, NoCloud, ParticleSite, Shape, mean_spacing, point_clouds};
use crate::scene::error::Fault;
use crate::scene::letters::is_no_letter;
use crate::scene::suggestion::did_you_mean;
use crate::scene::{self, BodyMotion, NamedMaterial};
use std::collections::HashMap;

table! {
    /// Bodies from the particles in a CSV file: one, or one of each value of its column `body`.
    PointCloud {
        /// What the body is called; with a column `body` "grain" makes "grain 7" of the value 7.
        name: Text,
        /// A CSV file whose first line names its columns: x, y, in space z; volume or mass of each particle; perhaps
        /// vx, vy, vz and body. Others are passed over. A relative path starts at the folder of the scene file.
        file: Text,
        /// What a length of 1 is in the file [m]; volumes count in its cube, in the plane in its square, velocities in
        /// it per second, masses in kg.
        #[schemars(extend("default" = "1 m"))]
        unit: Option<QuantityInput<Length>>,
        /// Name of the bodies' material.
        material: Text,
        /// Velocity of each at the start [m/s]; by default those of the file, or none.
        velocity: Option<VectorInput<Velocity>>,
        /// Angular velocity of each about its centre of mass at the start [rad/s]; by default none.
        spin: Option<SpinInput>,
        /// Makes the bodies rigid; excludes velocities in the file.
        rigid: Option<Rigid>,
    }
}

/// Bytes that a file of particles may have.
const LARGEST_FILE: u64 = 1 << 34;

/// Particles that it may have.
const MOST_PARTICLES: usize = 100_000_000;

/// Bodies that it may make.
const MOST_BODIES: usize = 100_000;

/// Bytes that the name of one may add to that of the table.
const LONGEST_LABEL: usize = 200;

/// Columns that are read.
const COLUMNS: [&str; 9] = ["x", "y", "z", "volume", "mass", "vx", "vy", "vz", "body"];

/// Where the columns are.
struct Columns {
    position: Vec<usize>,
    /// Of the volume, or else of the mass.
    volume: Result<usize, usize>,
    /// As many as axes, or none.
    velocity: Vec<usize>,
    body: Option<usize>,
}

impl PointCloud {
    /// Takes the bodies of the file.
    pub fn add_to(
        &self,
        bodies: &mut Bodies,
        (materials, declared, cell): (&[NamedMaterial], &str, f64),
        context: &Context,
    ) -> Result<(), Fault> {
        let (name, file) = (self.name.value(context)?, self.file.value(context)?);
        let material = material_of(&self.material, materials, context)?;
        let unit = self.unit.as_ref().map_or(Ok(1.0), |unit| unit.positive(context))?;
        let dimension = context.dimension.axes();
        let (labels, clouds) = self.read(&file, (unit, materials[material].density), context)?;
        let spacing = mean_spacing(&clouds, dimension);
        if spacing > cell {
            let found = format!("particles {spacing:.4} m apart, more than a cell");
            let help = "is `unit` that of the file? Each cell needs a particle at least".to_string();
            return Err(self.file_fault(&file, found, &format!("at most {cell} m")).help(Some(help)));
        }
        let per_side = (cell / spacing).round().clamp(1.0, 8.0) as usize;
        let keys = BodyKeys { velocity: &self.velocity, spin: &self.spin, rigid: &self.rigid };
        let (motion, by_place) = keys.motion(context)?;
        let velocities: Vec<Option<[f64; 3]>> = clouds.iter().map(mean_velocity).collect();
        let name_of = |label: &Option<String>| match label {
            Some(label) => format!("{name} {label}"),
            None => name.clone(),
        };
        let clouds = point_clouds(clouds, dimension, &file).map_err(|problem| {
            let (found, allowed) = match problem {
                NoCloud::Spread { parts, pixels } => (
                    format!("{parts} bodies in boxes of {:.1e} particles' size in all", pixels as f64),
                    format!("at most {MOST_BODIES} bodies, each in one place"),
                ),
                NoCloud::Sparse(body, filled) => (
                    format!(
                        "`{}`, whose particles fill {filled:.2} of the space around them",
                        name_of(&labels[body])
                    ),
                    "volumes that fill the space between particles, two deep at least".to_string(),
                ),
                NoCloud::Dense(body, filled) => (
                    format!(
                        "`{}`, whose particles fill the space around them {filled:.1} times",
                        name_of(&labels[body])
                    ),
                    "volumes that fill the space between particles once".to_string(),
                ),
            };
            let help = "is `unit` that of the file?".to_string();
            self.file_fault(&file, found, &allowed).help(Some(help))
        })?;
        for ((label, cloud), velocity) in labels.iter().zip(clouds).zip(velocities) {
            let shape = Shape::from(Curved::PointCloud(cloud));
            let mut body = scene::Body::new(&name_of(label), material, shape);
            body.particles_per_side = Some(per_side);
            (body.motion, body.velocity_by_place) = match velocity {
                Some(velocity) => (BodyMotion::Free { velocity, spin: [0.0; 3] }, None),
                None => (motion.clone(), by_place.clone()),
            };
            bodies.add(body, &self.name, declared)?;
        }
        Ok(())
    }

    /// The particles of each body, and its value in the column `body`.
    fn read(
        &self,
        file: &str,
        (unit, density): (f64, f64),
        context: &Context,
    ) -> Result<(Vec<Option<String>>, Vec<CloudPoints>), Fault> {
        let path = context.folder.join(file);
        let bytes = read_file(&self.file, (file, &path), (context.files, LARGEST_FILE))?;
        // What some programs put before text.
        let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&bytes);
        let mut reader = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
        let unread = |reason: csv::Error| self.file_fault(file, reason, "text with commas between columns");
        let header = reader.headers().map_err(unread)?.clone();
        let dimension = context.dimension.axes();
        let columns = self.columns((file, &header), dimension)?;
        let (mut labels, mut clouds, mut places) = (Vec::new(), Vec::<CloudPoints>::new(), HashMap::new());
        let mut record = csv::StringRecord::new();
        let mut count = 0;
        while reader.read_record(&mut record).map_err(unread)? {
            let line = record.position().map_or(0, csv::Position::line);
            let fault = |column: usize, found: &str, allowed: &str| {
                let name = header.get(column).unwrap_or_default();
                let found = format!("`{found}` as {name}");
                self.place_fault((file, line, column), found, allowed)
            };
            let number = |&column: &usize| {
                let text = record
                    .get(column)
                    .ok_or_else(|| fault(column, "", "a number, a row as long as the first"))?;
                let number = text.parse().ok().filter(|number: &f64| number.is_finite());
                number.ok_or_else(|| fault(column, text, "a finite number"))
            };
            let vector = |columns: &[usize]| {
                let mut vector = [0.0; 3];
                for (column, part) in columns.iter().zip(&mut vector) {
                    *part = unit * number(column)?;
                }
                Ok::<_, Fault>(vector)
            };
            let (Ok(column) | Err(column)) = columns.volume;
            let size = number(&column)?;
            if size <= 0.0 {
                return Err(fault(column, record.get(column).unwrap_or_default(), "a number above 0"));
            }
            let volume =
                if columns.volume.is_ok() { size * unit.powi(dimension as i32) } else { size / density };
            let site = ParticleSite::of_volume(vector(&columns.position)?, volume, dimension);
            let label = columns.body.map(|column| record.get(column).unwrap_or_default());
            if let Some((column, label)) = columns.body.zip(label)
                && (label.contains(is_no_letter) || label.len() > LONGEST_LABEL)
            {
                let allowed = format!("a name of at most {LONGEST_LABEL} bytes, without control characters");
                return Err(fault(column, label, &allowed));
            }
            let label = label.map(str::to_string);
            let place = *places.entry(label.clone()).or_insert(clouds.len());
            if place == clouds.len() {
                if clouds.len() == MOST_BODIES {
                    return Err(self.file_fault(file, "more bodies", &format!("at most {MOST_BODIES}")));
                }
                labels.push(label);
                clouds.push(CloudPoints::default());
            }
            clouds[place].sites.push(site);
            if !columns.velocity.is_empty() {
                clouds[place].velocities.push(vector(&columns.velocity)?);
            }
            count += 1;
            if count > MOST_PARTICLES {
                return Err(self.file_fault(file, "more particles", &format!("at most {MOST_PARTICLES}")));
            }
        }
        if clouds.is_empty() {
            return Err(self.file_fault(
                file,
                "no particles",
                "a row for each particle below the names of columns",
            ));
        }
        Ok((labels, clouds))
    }

    fn columns(
        &self,
        (file, header): (&str, &csv::StringRecord),
        dimension: usize,
    ) -> Result<Columns, Fault> {
        let names: Vec<String> = header.iter().map(str::to_lowercase).collect();
        let listed = names.join(", ");
        for name in COLUMNS {
            let mut places = (0..names.len()).filter(|&i| names[i] == name);
            if let Some(second) = places.nth(1) {
                return Err(self.place_fault(
                    (file, 1, second),
                    format!("a second column {name}"),
                    "one of each name",
                ));
            }
        }
        let find = |name: &str| names.iter().position(|found| found == name);
        let need = |name: &str, allowed: &str| {
            find(name).ok_or_else(|| {
                let help = did_you_mean(
                    name,
                    names.iter().map(String::as_str).filter(|name| !COLUMNS.contains(name)),
                );
                let help = help.map(|_| format!("columns are named {}", COLUMNS.join(", ")));
                self.file_fault(file, format!("no column {name} among `{listed}`"), allowed).help(help)
            })
        };
        let all = |names: &[&str], allowed: &str| -> Result<Vec<usize>, Fault> {
            names.iter().map(|name| need(name, allowed)).collect()
        };
        let position =
            all(&["x", "y", "z"][..dimension], "columns x, y and in space z, named in the first line")?;
        let volume = match (find("volume"), find("mass")) {
            (Some(volume), _) => Ok(volume),
            (None, Some(mass)) => Err(mass),
            (None, None) => Ok(need("volume", "a column volume or mass, named in the first line")?),
        };
        let of_velocity = ["vx", "vy", "vz"];
        let has_velocity = of_velocity[..dimension].iter().any(|name| find(name).is_some());
        let velocity = match has_velocity {
            true => all(&of_velocity[..dimension], "all of vx, vy and in space vz, or none of them")?,
            false => Vec::new(),
        };
        let beside = [self.velocity.as_ref().map(VectorInput::node), self.spin.as_ref().map(SpinInput::node)];
        if let Some(node) = beside.into_iter().flatten().next().filter(|_| has_velocity) {
            let found = format!("`{}` beside velocities in {file}", node.name());
            return Err(Fault::new(&node.key(), found, "one of the two").at(node.name_span()));
        }
        if self.rigid.is_some() && has_velocity {
            return Err(self.file_fault(
                file,
                "velocities of a rigid body",
                "no columns vx, vy, vz beside `rigid`",
            ));
        }
        Ok(Columns { position, volume, velocity, body: find("body") })
    }

    fn file_fault(&self, file: &str, found: impl std::fmt::Display, allowed: &str) -> Fault {
        let mut fault = self.file.refused(file, allowed);
        fault.problem.found = format!("in {file}: {found}");
        fault
    }

    /// A fault at a line and a column of the file, as editors count them: fields of a row from 1 on.
    fn place_fault(&self, (file, line, column): (&str, u64, usize), found: String, allowed: &str) -> Fault {
        let mut fault = self.file.refused(file, allowed);
        fault.problem.found = format!("in {file}, line {line}, column {}: {found}", column + 1);
        fault
    }
}

/// Mean velocity of particles over their volumes; `None` where they have no velocities.
fn mean_velocity(cloud: &CloudPoints) -> Option<[f64; 3]> {
    let volume: f64 = cloud.sites.iter().map(|site| site.volume).sum();
    let add = |sum: [f64; 3], (site, velocity): (&ParticleSite, &[f64; 3])| {
        std::array::from_fn(|k| sum[k] + velocity[k] * (site.volume / volume))
    };
    let mean = cloud.sites.iter().zip(&cloud.velocities).fold([0.0; 3], add);
    (!cloud.velocities.is_empty()).then_some(mean)
}
