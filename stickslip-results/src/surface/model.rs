//! The surfaces of bodies as a model: glTF 2.0 in one binary file, which Blender, viewers, browsers and slides open.
//!
//! The file is a JSON text and the numbers behind it (Khronos, glTF 2.0 specification, 4.4). The crates there are give
//! types for that text, which is short here, and do not pack the numbers: so it is written by hand.

use crate::tensor::{Vector, cross};
use serde_json::{Value, json};
use std::io;

/// Surfaces of bodies, as the file holds them.
pub struct Model {
    parts: Vec<ModelPart>,
    directions: [[f64; 3]; 3],
    extras: Value,
}

/// The surface of a body.
#[derive(Clone, Debug, Default)]
pub struct ModelPart {
    /// Of the body.
    pub name: String,
    /// Of the whole where corners have no colours, as screens have it: red, green and blue from 0 to 1.
    pub color: [f32; 3],
    /// Places of the corners [m].
    pub positions: Vec<[f32; 3]>,
    /// Outward unit normals there.
    pub normals: Vec<[f32; 3]>,
    /// Colours there; none where the whole has one.
    pub colors: Vec<[f32; 3]>,
    /// Corners, counterclockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Vectors at the corners by their names, which begin with `_` and have capitals.
    pub vectors: Vec<(&'static str, Vec<[f32; 3]>)>,
    /// Numbers at the corners by their names, the same.
    pub numbers: Vec<(&'static str, Vec<f32>)>,
}

/// What a file and the program call this kind.
pub const GENERATOR: &str = "\"generator\":\"Stickslip\"";
/// How a file begins.
const MAGIC: &[u8; 4] = b"glTF";
/// Codes of glTF.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const OF_CORNERS: u32 = 34962;
const OF_TRIANGLES: u32 = 34963;

/// Directions of a scene that lead right, up and to the viewer in a model: up is against gravity, in space without it
/// z, in the plane y; right is along x, or near it.
pub fn upright(gravity: [f64; 3], dimension: usize) -> [[f64; 3]; 3] {
    let axis = |axis: usize| Vector::<f64, 3>::from_fn(|k| f64::from(u8::from(k == axis)));
    if dimension == 2 {
        return [0, 1, 2].map(|k| axis(k).0);
    }
    let up = (-Vector(gravity)).direction().unwrap_or(axis(2));
    let right = [0, 1].map(|k| axis(k) - up * up[k]).into_iter().find(|right| right.norm() > 0.5);
    let right = right.and_then(|right| right.direction()).expect("x or y lies across any direction");
    [right.0, up.0, cross(right.0, up.0)]
}

impl Model {
    /// Of some bodies, and of what else a file is to say; `directions` of the scene lead right, up and to the viewer.
    pub fn new(parts: Vec<ModelPart>, directions: [[f64; 3]; 3], extras: Value) -> Self {
        Model { parts, directions, extras }
    }

    /// Bodies that have a surface.
    pub fn parts(&self) -> &[ModelPart] {
        &self.parts
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
                for (name, values) in &part.vectors {
                    attributes[*name] = json!(numbers.vectors(values, false));
                }
                for (name, values) in &part.numbers {
                    attributes[*name] = json!(numbers.scalars(values));
                }
                let primitive = json!({
                    "attributes": attributes, "indices": numbers.corners(&part.triangles), "material": i,
                });
                json!({ "name": part.name, "primitives": [primitive] })
            })
            .collect();
        let material = |part: &ModelPart| {
            // The colours of corners are multiplied by this one.
            let color = if part.colors.is_empty() { part.color } else { [1.0; 3] };
            let [r, g, b] = color.map(linear);
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
        let mut document = json!({
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
        if parts == 0 {
            // The format knows no empty lists.
            document = json!({ "asset": document["asset"], "scene": 0, "scenes": [{}] });
        }
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
        file.extend(MAGIC);
        file.extend(2_u32.to_le_bytes());
        file.extend(whole(length)?);
        for (kind, bytes) in chunks {
            file.extend(whole(bytes.len())?);
            file.extend(kind);
            file.extend(bytes);
        }
        Ok(file)
    }

    /// Whether a file is a whole model: as long as it says, with a text that can be read, and with its numbers.
    ///
    /// # Errors
    /// What is missing.
    pub fn check(file: &[u8]) -> Result<(), &'static str> {
        let whole = |at: usize| {
            let bytes = file.get(at..at + 4)?.try_into().ok()?;
            usize::try_from(u32::from_le_bytes(bytes)).ok()
        };
        if !file.starts_with(MAGIC) || whole(8) != Some(file.len()) {
            return Err("model of the length that it says");
        }
        let text = whole(12).and_then(|length| file.get(20..)?.get(..length));
        let document: Value =
            text.and_then(|text| serde_json::from_slice(text).ok()).ok_or("readable text")?;
        let parts = document["meshes"].as_array().map_or(0, Vec::len);
        let start = 28 + text.map_or(0, <[u8]>::len);
        let numbers = document["buffers"][0]["byteLength"].as_u64().unwrap_or_default();
        let has_numbers = file.get(start..).is_some_and(|rest| rest.len() as u64 == numbers);
        if has_numbers && (numbers > 0 || parts == 0) { Ok(()) } else { Err("numbers behind the text") }
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

    /// Numbers, one a corner.
    fn scalars(&mut self, numbers: &[f32]) -> usize {
        let accessor = json!({ "componentType": FLOAT, "count": numbers.len(), "type": "SCALAR" });
        self.add(numbers.iter().flat_map(|x| x.to_le_bytes()), OF_CORNERS, accessor)
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
pub fn linear(screen: f32) -> f32 {
    if screen <= 0.04045 { screen / 12.92 } else { ((screen + 0.055) / 1.055).powf(2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(name: &str, x: f32, height: f32) -> ModelPart {
        ModelPart {
            name: name.to_string(),
            color: [1.0, 0.5, 0.0],
            positions: vec![[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 0.0, height]],
            normals: vec![[0.0, -1.0, 0.0]; 3],
            colors: Vec::new(),
            triangles: vec![[0, 1, 2]],
            vectors: Vec::new(),
            numbers: vec![("_VON_MISES", vec![1.0, 2.0, 4.0])],
        }
    }

    #[test]
    fn each_body_has_its_own_corners_and_up_is_up() {
        let parts = vec![triangle("second", 5.0, 3.0), triangle("first", 0.0, 2.0)];
        let model = Model::new(parts, upright([0.0, 0.0, -9.81], 3), json!({ "time": 0.5 }));
        assert_eq!(model.parts().len(), 2);
        let file = model.encode().unwrap();
        Model::check(&file).unwrap();
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
        let real = |at: usize| f32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        assert_eq!(real(start), 5.0);
        let stress =
            text["meshes"][1]["primitives"][0]["attributes"]["_VON_MISES"].as_u64().unwrap() as usize;
        let view = text["accessors"][stress]["bufferView"].as_u64().unwrap() as usize;
        let offset = text["bufferViews"][view]["byteOffset"].as_u64().unwrap() as usize;
        assert_eq!([0, 4, 8].map(|at| real(start + offset + at)), [1.0, 2.0, 4.0]);
        let last: Vec<usize> = (0..3).map(|k| whole(file.len() - 12 + 4 * k)).collect();
        assert_eq!(last, [0, 1, 2], "corners are counted body by body");
    }

    #[test]
    fn what_is_cut_is_no_model() {
        let file =
            Model::new(vec![triangle("a", 0.0, 1.0)], upright([0.0; 3], 2), json!({})).encode().unwrap();
        for end in 0..file.len() {
            assert!(Model::check(&file[..end]).is_err(), "{end}");
        }
        let nothing = Model::new(Vec::new(), upright([0.0; 3], 3), json!({})).encode().unwrap();
        Model::check(&nothing).unwrap();
    }

    #[test]
    fn a_model_stands_upright_and_is_not_mirrored() {
        for gravity in [[0.0, 0.0, -9.81], [0.0, -9.81, 0.0], [-1.0, 0.0, 0.0], [7.0, 0.0, -7.0], [0.0; 3]] {
            let [right, up, toward] = upright(gravity, 3).map(Vector);
            assert!(
                (Vector(cross(right.0, up.0)) - toward).norm() < 1e-12 && (up.norm() - 1.0).abs() < 1e-12
            );
            assert!(up.dot(Vector(gravity)) <= -0.999 * Vector(gravity).norm(), "{gravity:?}");
            assert!(right[0] > 0.0 || gravity[0] == -1.0, "x runs to the right");
        }
        assert_eq!(upright([3.0, -4.0, 0.0], 2)[1], [0.0, 1.0, 0.0]);
    }

    #[test]
    fn colours_become_light() {
        assert_eq!([linear(0.0), linear(1.0)], [0.0, 1.0]);
        assert!((linear(0.5) - 0.2140).abs() < 1e-4);
    }
}
