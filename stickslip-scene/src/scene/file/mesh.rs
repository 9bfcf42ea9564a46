//! Shapes from files: `shape.mesh = { file = "gear.stl", scale = "1 mm" }`.

use super::Context;
use super::files::read_file;
use super::quantity::{Length, QuantityInput};
use super::read::table;
use super::solid::beside;
use super::text::Text;
use super::vector::VectorInput;
use crate::geometry::{self, Bounds, MeshFault, Shape};
use crate::scene::error::Fault;
use std::io::Cursor;
use std::path::Path;

table! {
    /// What a closed surface of triangles holds, read from a file; in the plane a section of it.
    Mesh {
        /// An STL or PLY file (text or binary) or an OBJ file; a relative path starts at the folder of the scene file.
        file: Text,
        /// Length of the file's unit [m]: "1 mm". By default 1 m.
        scale: Option<QuantityInput<Length>>,
        /// How far it is moved after it is scaled [m]. By default not at all.
        translation: Option<VectorInput<Length>>,
        /// Height z at which the plane of the scene cuts it, after it is scaled [m]; plane scenes only.
        section: Option<QuantityInput<Length>>,
    }
}

/// Bytes that a file of a mesh may have.
const LARGEST_MESH: u64 = 1 << 32;

/// Corners of triangles in the units of their file.
type Triangles = Vec<[[f64; 3]; 3]>;

/// A file that holds no mesh.
enum Unread {
    /// It is no text, it ends early, it has words or numbers where there should be others.
    Garbled(String),
    /// Its triangles bound no solid.
    Fault(MeshFault),
}

impl Mesh {
    /// The mesh in SI units; in the plane, what that cuts out of it.
    pub fn resolve(&self, context: &Context) -> Result<Shape, Fault> {
        match (&self.section, context.dimension.is_plane()) {
            (None, false) => Ok(Shape::Mesh(self.solid(context)?)),
            (Some(section), false) => Err(section.node().fault("no section, as the scene is in space")),
            (None, true) => {
                let allowed = "the height z at which the plane of the scene cuts the mesh: \"1 mm\"";
                Err(Fault::new(&beside(self.file.node(), "section"), "nothing, the key is missing", allowed))
            }
            (Some(section), true) => {
                let (solid, height) = (self.solid(context)?, section.value(context)?);
                solid.section(height).ok_or_else(|| {
                    let Bounds { min, max } = solid.bounds();
                    section.refused(height, format!("a height within the mesh, {} m to {} m", min[2], max[2]))
                })
            }
        }
    }

    /// The mesh in SI units.
    fn solid(&self, context: &Context) -> Result<geometry::Mesh, Fault> {
        let name = self.file.value(context)?;
        let scale = self.scale.as_ref().map_or(Ok(1.0), |scale| scale.positive(context))?;
        let translation = self.translation.as_ref().map_or(Ok([0.0; 3]), |vector| vector.value(context))?;
        let path = context.folder.join(&name);
        let kind = path.extension().unwrap_or_default().to_ascii_lowercase();
        let read = match kind.to_str() {
            Some("stl") => stl,
            Some("obj") => obj,
            Some("ply") => ply,
            _ => return Err(self.file.refused(&name, "a file of triangles that ends in .stl, .obj or .ply")),
        };
        let bytes = read_file(&self.file, (&name, &path), (context.files, LARGEST_MESH))?;
        let solid = read(&bytes).and_then(|triangles| {
            if let Some(corner) =
                triangles.iter().flatten().find(|corner| corner.iter().any(|x| !x.is_finite()))
            {
                return Err(Unread::Garbled(format!("a corner at {corner:?}, which is no place")));
            }
            let placed = |x: [f64; 3]| std::array::from_fn(|k| scale * x[k] + translation[k]);
            // Faults are told in the units of the file.
            geometry::Mesh::new(&name, triangles.iter().copied()).map_err(Unread::Fault)?;
            geometry::Mesh::new(&name, triangles.iter().map(|corners| corners.map(placed)))
                .map_err(Unread::Fault)
        });
        solid.map_err(|unread| {
            let (found, help) = match &unread {
                Unread::Garbled(found) => (found.clone(), "write it anew, as STL, OBJ or PLY"),
                Unread::Fault(fault) => (fault.to_string(), fault.advice()),
            };
            let mut fault = self.file.refused(&name, "a closed surface of triangles that face outward");
            fault.problem.found = format!("in {}: {found}", file_name(&path));
            fault.help(Some(help.to_string()))
        })
    }
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The triangles of an STL file. A binary one says how many it has, and its length agrees;
/// its header may begin as a text does.
fn stl(bytes: &[u8]) -> Result<Triangles, Unread> {
    let garbled = |reason: std::io::Error| Unread::Garbled(format!("no STL: {reason}"));
    let mut bytes = bytes.to_vec();
    let count = bytes.get(80..84).map(|count| u32::from_le_bytes(count.try_into().expect("four bytes")));
    if count.is_some_and(|count| bytes.len() as u64 == 84 + 50 * u64::from(count)) {
        bytes[..80].fill(0);
    }
    let mut bytes = Cursor::new(bytes);
    let corners = |triangle: stl_io::Triangle| triangle.vertices.map(|corner| corner.0.map(f64::from));
    let triangles = stl_io::create_stl_reader(&mut bytes).map_err(garbled)?;
    triangles.map(|triangle| triangle.map(corners).map_err(garbled)).collect()
}

/// The triangles of a PLY file; polygons are cut into fans.
fn ply(bytes: &[u8]) -> Result<Triangles, Unread> {
    super::ply::triangles(bytes).map_err(|reason| Unread::Garbled(format!("no PLY: {reason}")))
}

/// The triangles of an OBJ file, of all its objects; polygons are cut into fans.
fn obj(bytes: &[u8]) -> Result<Triangles, Unread> {
    super::obj::triangles(bytes).map_err(|reason| Unread::Garbled(format!("no OBJ: {reason}")))
}
