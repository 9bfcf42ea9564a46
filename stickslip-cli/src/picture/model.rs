//! The surfaces of bodies in space as a model, with the colours of a picture.

use super::camera::{Camera, Viewpoint};
use super::quantity::ColorQuantity;
use super::setting::Setting;
use super::skins::Mesh;
use super::{PictureStyle, Subject};
use crate::drawing::body_color;
use serde_json::json;
use std::collections::HashMap;
use stickslip::surface::model::{Model, ModelPart, linear};

/// Of the surfaces in a snapshot at a time [s].
pub fn model(
    mesh: &Mesh,
    (subject, setting): (&Subject, &Setting),
    (time, look): (f64, &PictureStyle),
) -> Model {
    let camera = Camera::new(Viewpoint::Angles(0.0, 0.0), setting);
    let by_body = *subject.quantity == ColorQuantity::Body;
    let mut places: HashMap<u32, usize> = HashMap::new();
    let mut parts: Vec<ModelPart> = Vec::new();
    // Of each corner, its number in its own body.
    let mut numbers = vec![u32::MAX; mesh.corners.len()];
    for (corners, &body) in mesh.triangles.iter().zip(&mesh.body) {
        let place = *places.entry(body).or_insert_with(|| {
            parts.push(ModelPart {
                name: setting.bodies[body as usize].clone(),
                color: body_color(body as usize),
                ..ModelPart::default()
            });
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
    Model::new(parts, [camera.right, camera.up, camera.toward].map(|direction| direction.0), extras)
}

#[cfg(test)]
mod tests {
    use super::*;
    use stickslip::tensor::Vector;

    /// Two bodies, of which one is a triangle that shares no corner with the other.
    #[test]
    fn each_body_has_its_own_corners_and_colours_of_values() {
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
        let model = model(&mesh, (&subject, &setting), (0.5, &look));
        let [second, first] = model.parts() else { panic!("two bodies") };
        assert_eq!((&first.name[..], &second.name[..]), ("first", "second"));
        assert_eq!((first.triangles[0], second.triangles[0]), ([0, 1, 2], [0, 1, 2]));
        assert_eq!(second.positions, [[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [5.0, 0.0, 3.0]]);
        let color = |value: f64| look.scale.color(value).map(linear);
        assert_eq!(first.colors, [0.0, 1.0, 2.0].map(color));
        assert_eq!(second.colors, [3.0, 4.0, 5.0].map(color));
    }
}
