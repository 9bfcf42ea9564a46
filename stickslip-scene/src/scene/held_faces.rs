//! Which faces of the domain hold a body on a grid of its own.

use super::{Body, Face, Scene};
use crate::geometry::form::{HeldFace, HeldFaces};

/// How near to a face a body ends that lies on it [cells].
const ON: f64 = 1e-9;

/// Points along the largest side of a body, for what of its surface lies on a face: at most two a cell.
const POINTS: f64 = 100.0;

impl Scene {
    /// The mirrors and fixed faces of the domain on which a part of a body's surface lies. A body that touches one at a
    /// point or along an edge alone meets it as a wall.
    pub fn held_faces(&self, body: &Body) -> HeldFaces {
        let (axes, cell) = (self.dimension.axes(), self.discretization.cell);
        let mut held = HeldFaces::default();
        let (Some(domain), Some(bounds)) = (&self.domain, body.shape.bounds(axes)) else { return held };
        for axis in 0..axes {
            let ends = [(domain.min[axis], bounds.min[axis]), (domain.max[axis], bounds.max[axis])];
            for (side, (at, end)) in ends.into_iter().enumerate() {
                let face = domain.faces[axis][side];
                // The box around a combined shape may be larger than the shape.
                let inside = if side == 0 { end - at } else { at - end };
                if matches!(face, Face::Symmetry | Face::Fixed) && inside <= ON * cell.max(at.abs()) {
                    held.0[axis][side] = Some(HeldFace { at, is_fixed: face == Face::Fixed });
                }
            }
        }
        if held.is_empty() {
            return held;
        }
        let largest = bounds.size()[..axes].iter().fold(0.0_f64, |most, side| most.max(*side));
        let spacing = (0.5 * cell).max(largest / POINTS);
        let surface = body.shape.surface(spacing, axes, &bounds.grown(spacing));
        for (axis, side, face) in HeldFaces(held.0).iter() {
            let mut alone = HeldFaces::default();
            alone.0[axis][side] = Some(face);
            if !surface.iter().any(|point| alone.hold((point.position, point.normal), cell)) {
                held.0[axis][side] = None;
            }
        }
        held
    }
}

#[cfg(test)]
mod tests {
    use super::super::parse;

    /// The half of a disk, however it is cut.
    #[test]
    fn a_mirror_holds_a_half_however_it_is_cut() {
        let ball = "{ ball = { center = [0, 0], radius = 0.1 } }";
        let cuts = [
            format!("intersection = [{ball}, {{ box = {{ min = [0, -1], max = [1, 1] }} }}]"),
            format!("intersection = [{ball}, {{ half_space = {{ point = [0, 0], normal = [-1, 0] }} }}]"),
            format!("difference = [{ball}, {{ half_space = {{ point = [0, 0], normal = [1, 0] }} }}]"),
            "ball = { center = [0, 0], radius = 0.1 }\nbeyond_mirrors = \"cut\"".to_string(),
        ];
        for cut in cuts {
            let text = format!(
                "[space]\ndimension = \"plane-strain\"\ncell = 0.02\ninterior = \"reference\"\n\
                 domain = {{ min = [0, -1], max = [1, 1], x_min = \"symmetry\", x_max = \"fixed\" }}\n[time]\nend = 1\n\
                 [materials.m]\ndensity = 1000\nneo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }}\n\
                 [[bodies]]\nname = \"half\"\nmaterial = \"m\"\nshape.{cut}\n"
            );
            let scene = parse("a.toml", &text, &[]).unwrap_or_else(|error| panic!("{error}")).scene;
            let held = scene.held_faces(&scene.bodies[0]);
            let faces: Vec<_> = held.iter().map(|(axis, side, _)| (axis, side)).collect();
            assert_eq!(faces, [(0, 0)], "{cut}");
        }
    }
}
