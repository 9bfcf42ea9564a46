//! The surfaces of bodies in space as a model: glTF 2.0 in one binary file, which Blender, viewers, browsers and slides
//! open.
//!
//! The file is a JSON text and the numbers behind it (Khronos, glTF 2.0 specification, 4.4). The crates there are give
//! types for that text, which is short here, and do not pack the numbers: so it is written by hand.

use super::camera::{Camera, Point, Viewpoint};
use super::quantity::ColorQuantity;
use super::setting::Setting;
use super::skins::Mesh;
use super::{PictureStyle, Subject};
use crate::drawing::{Rgb, body_color};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io;

/// The bodies that have surfaces, as the file holds them.
pub struct Model {
    parts: Vec<Part>,
    /// Directions of the scene that lead right, up and to the viewer.
    directions: [Point; 3],
    extras: Value,
}

/// The surface of a body.
struct Part {
    name: String,
    /// Of the whole, where colours stand for bodies.
    color: Rgb,
    /// Places of the corners [m].
    positions: Vec<[f32; 3]>,
    /// Outward unit normals there.
    normals: Vec<[f32; 3]>,
    /// Colours there, where they stand for values; none else.
    colors: Vec<[f32; 3]>,
    /// Corners, counterclockwise seen from outside.
    triangles: Vec<[u32; 3]>,
}

/// What a file and the program call this kind.
pub const GENERATOR: &str = "\"generator\":\"Stickslip\"";
/// Codes of glTF.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const OF_CORNERS: u32 = 34962;
const OF_TRIANGLES: u32 = 34963;

impl Model {
    /// Of the surfaces in a snapshot at a time [s].
    pub(super) fn new(
        mesh: &Mesh,
        (subject, setting): (&Subject, &Setting),
        (time, look): (f64, &PictureStyle),
    ) -> Self {
        let camera = Camera::new(Viewpoint::Angles(0.0, 0.0), setting);
        let by_body = *subject.quantity == ColorQuantity::Body;
        let mut places: HashMap<u32, usize> = HashMap::new();
        let mut parts: Vec<Part> = Vec::new();
        // Of each corner, its number in its own body.
        let mut numbers = vec![u32::MAX; mesh.corners.len()];
        for (corners, &body) in mesh.triangles.iter().zip(&mesh.body) {
            let place = *places.entry(body).or_insert_with(|| {
                parts.push(Part::named(setting.bodies[body as usize].clone(), body_color(body as usize)));
                parts.len() - 1
            });
            let part = &mut parts[place];
            let triangle = corners.map(|corner| {
                let corner = corner as usize;
                if numbers[corner] == u32::MAX {
                    numbers[corner] = part.positions.len() as u32;
                    part.positions.push(mesh.corners[corner].0.map(|x| x as f32));
                    let normal = mesh.normals[corner].direction();
                    part.normals.push(normal.map_or([0.0, 0.0, 1.0], |normal| normal.0.map(|n| n as f32)));
                    if !by_body {
                        part.colors.push(look.scale.color(mesh.values[corner]).map(linear));
                    }
                }
                numbers[corner]
            });
            part.triangles.push(triangle);
        }
        let mut extras = json!({ "title": setting.title, "time": time });
        if !by_body {
            let [low, high] = look.scale.range;
            extras["range"] = json!([low, high]);
        }
        Model { parts, directions: [camera.right, camera.up, camera.toward], extras }
    }

    /// Bodies that have a surface.
    pub fn bodies(&self) -> usize {
        self.parts.len()
    }

    /// The file.
    ///
    /// # Errors
    /// It would be larger than its format allows.
    pub fn encode(&self) -> io::Result<Vec<u8>> {
        let mut numbers = Numbers::default();
        let meshes: Vec<Value> = (0..self.parts.len())
            .map(|i| {
                let part = &self.parts[i];
                let mut attributes = json!({
                    "POSITION": numbers.vectors(&part.positions, true),
                    "NORMAL": numbers.vectors(&part.normals, false),
                });
                if !part.colors.is_empty() {
                    attributes["COLOR_0"] = json!(numbers.vectors(&part.colors, false));
                }
                let primitive = json!({
                    "attributes": attributes, "indices": numbers.corners(&part.triangles), "material": i,
                });
                json!({ "name": part.name, "primitives": [primitive] })
            })
            .collect();
        let material = |part: &Part| {
            // The colours of corners are multiplied by this one.
            let [r, g, b] = if part.colors.is_empty() { part.color.map(linear) } else { [1.0; 3] };
            let surface =
                json!({ "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8 });
            json!({ "name": part.name, "pbrMetallicRoughness": surface, "doubleSided": true })
        };
        let parts = self.parts.len();
        let node = |i: usize| json!({ "name": self.parts[i].name, "mesh": i });
        // What is up in the scene is up in the file, whose y is that, and its front looks along z.
        let columns = (0..3).map(|axis| self.directions.map(|direction| direction[axis]));
        let matrix: Vec<f64> =
            columns.flat_map(|[x, y, z]| [x, y, z, 0.0]).chain([0.0, 0.0, 0.0, 1.0]).collect();
        let mut nodes: Vec<Value> = (0..parts).map(node).collect();
        nodes.push(json!({ "children": (0..parts).collect::<Vec<_>>(), "matrix": matrix }));
        // Its first words say whose it is.
        let document = json!({
            "asset": { "generator": "Stickslip", "version": "2.0", "extras": self.extras },
            "scene": 0,
            "scenes": [{ "nodes": [parts] }],
            "nodes": nodes,
            "meshes": meshes,
            "materials": self.parts.iter().map(material).collect::<Vec<_>>(),
            "accessors": numbers.accessors,
            "bufferViews": numbers.views,
            "buffers": [{ "byteLength": numbers.bytes.len() }],
        });
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let chunks = [(b"JSON", text), (b"BIN\0", numbers.bytes)];
        let length = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
        let whole = |count: usize| {
            u32::try_from(count)
                .map_err(|_| io::Error::other("a model may have 4 GB at most"))
                .map(u32::to_le_bytes)
        };
        let mut file = Vec::with_capacity(length);
        file.extend(b"glTF");
        file.extend(2_u32.to_le_bytes());
        file.extend(whole(length)?);
        for (kind, bytes) in chunks {
            file.extend(whole(bytes.len())?);
            file.extend(kind);
            file.extend(bytes);
        }
        Ok(file)
    }
}

impl Part {
    fn named(name: String, color: Rgb) -> Self {
        let (positions, normals, colors, triangles) = Default::default();
        Part { name, color, positions, normals, colors, triangles }
    }
}

/// The part of the file behind its text, and what the text says of it.
#[derive(Default)]
struct Numbers {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Numbers {
    /// Vectors, one a corner: the number by which the text calls them.
    fn vectors(&mut self, vectors: &[[f32; 3]], with_bounds: bool) -> usize {
        let mut accessor = json!({ "componentType": FLOAT, "count": vectors.len(), "type": "VEC3" });
        if with_bounds {
            let bound = |of: fn(f32, f32) -> f32| {
                vectors.iter().copied().reduce(|a, b| [0, 1, 2].map(|i| of(a[i], b[i])))
            };
            (accessor["min"], accessor["max"]) = (json!(bound(f32::min)), json!(bound(f32::max)));
        }
        self.add(vectors.as_flattened().iter().flat_map(|x| x.to_le_bytes()), OF_CORNERS, accessor)
    }

    /// The corners of triangles.
    fn corners(&mut self, triangles: &[[u32; 3]]) -> usize {
        let accessor =
            json!({ "componentType": UNSIGNED_INT, "count": 3 * triangles.len(), "type": "SCALAR" });
        self.add(triangles.as_flattened().iter().flat_map(|x| x.to_le_bytes()), OF_TRIANGLES, accessor)
    }

    fn add(&mut self, bytes: impl Iterator<Item = u8>, target: u32, mut accessor: Value) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        accessor["bufferView"] = json!(self.views.len());
        self.views.push(json!({ "buffer": 0, "byteOffset": start, "byteLength": length, "target": target }));
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }
}

/// Light of a colour's component as screens have it (IEC 61966-2-1).
fn linear(screen: f32) -> f32 {
    if screen <= 0.04045 { screen / 12.92 } else { ((screen + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::tensor::Vector;

    /// Two bodies, of which one is a triangle that shares no corner with the other.
    #[test]
    fn each_body_has_its_own_corners_and_up_is_up() {
        let corner = |x: f64, z: f64| Vector([x, 0.0, z]);
        let mesh = Mesh {
            corners: vec![
                corner(0.0, 0.0),
                corner(1.0, 0.0),
                corner(0.0, 2.0),
                corner(5.0, 0.0),
                corner(6.0, 0.0),
                corner(5.0, 3.0),
            ],
            normals: vec![Vector([0.0, -1.0, 0.0]); 6],
            reference: vec![[0.0; 3]; 6],
            values: (0..6).map(f64::from).collect(),
            triangles: vec![[3, 4, 5], [0, 1, 2]],
            body: vec![1, 0],
        };
        let setting = Setting {
            gravity: [0.0, 0.0, -9.81],
            bodies: vec!["first".to_owned(), "second".to_owned()],
            ..Setting::default()
        };
        let particles = stickslip::door::ParticleSnapshot { dimension: 3, ..Default::default() };
        let quantity = ColorQuantity::Pressure;
        let subject = Subject::new(&particles, &quantity, false);
        let look = super::super::tests::look(&subject);
        let model = Model::new(&mesh, (&subject, &setting), (0.5, &look));
        assert_eq!(model.bodies(), 2);
        let file = model.encode().unwrap();
        let whole = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&file[..4], whole(4), whole(8), whole(12) % 4), (&b"glTF"[..], 2, file.len(), 0));
        let text: Value = serde_json::from_slice(&file[20..20 + whole(12)]).unwrap();
        assert!(
            file[20..].starts_with(b"{\"asset\":{") && String::from_utf8_lossy(&file).contains(GENERATOR)
        );
        assert_eq!(
            (&text["meshes"][0]["name"], &text["asset"]["extras"]["time"]),
            (&json!("second"), &json!(0.5))
        );
        assert_eq!(
            (&text["accessors"][0]["min"], &text["accessors"][0]["max"]),
            (&json!([5.0, 0.0, 0.0]), &json!([6.0, 0.0, 3.0]))
        );
        // Columns of the matrix: where x, y and z of the scene lead.
        let matrix: Vec<f64> = serde_json::from_value(text["nodes"][2]["matrix"].clone()).unwrap();
        assert_eq!(&matrix[8..11], &[0.0, 1.0, 0.0], "z is up");
        let start = 20 + whole(12) + 8;
        assert_eq!(
            (whole(start - 8), text["buffers"][0]["byteLength"].as_u64()),
            (file.len() - start, Some((file.len() - start) as u64))
        );
        assert_eq!(f32::from_le_bytes(file[start..start + 4].try_into().unwrap()), 5.0);
        let last: Vec<usize> = (0..3).map(|k| whole(file.len() - 12 + 4 * k)).collect();
        assert_eq!(last, [0, 1, 2], "corners are counted body by body");
    }

    #[test]
    fn colours_become_light() {
        assert_eq!([linear(0.0), linear(1.0)], [0.0, 1.0]);
        assert!((linear(0.5) - 0.2140).abs() < 1e-4);
    }
}
