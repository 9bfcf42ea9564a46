//! What a plane cuts out of a mesh.

use super::{Mesh, edges};
use crate::geometry::Shape;
use crate::tensor::Vector;
use std::collections::HashMap;

/// A corner is left out if it is off the line between its neighbours by less than this share of the mesh's size, as
/// where an edge of two triangles of one face is cut.
const STRAIGHT: f64 = 1e-9;

/// Borders of a section, each a polygon; the area goes round anticlockwise, and what is cut out of it clockwise.
type Borders = Vec<Vec<[f64; 2]>>;

impl Mesh {
    /// What the plane z = `height` [m] cuts out of it: a polygon, or several, perhaps with holes, as a shape in the
    /// plane of x and y. `None` where it cuts nothing. A corner of the mesh in the plane counts as above it.
    pub fn section(&self, height: f64) -> Option<Shape> {
        let (mut areas, mut holes): (Borders, Borders) = (Vec::new(), Vec::new());
        for border in self.borders(height) {
            if twice_area(&border) > 0.0 { areas.push(border) } else { holes.push(border) }
        }
        let polygon = |points: Vec<_>| Shape::Polygon { points: points.into(), height: [0.0; 2] };
        let mut parts: Vec<Vec<Shape>> = areas.iter().map(|area| vec![polygon(area.clone())]).collect();
        for hole in holes {
            // Of areas in each other, as of a ring in a ring, the smallest around it.
            let around = |area: &[[f64; 2]]| crate::geometry::polygon::contains(area, hole[0]);
            let nearest = (0..areas.len())
                .filter(|&i| around(&areas[i]))
                .min_by(|&i, &j| twice_area(&areas[i]).total_cmp(&twice_area(&areas[j])));
            parts[nearest?].push(polygon(hole));
        }
        let mut shapes: Vec<Shape> = (parts.into_iter())
            .map(|mut part| if part.len() == 1 { part.remove(0) } else { Shape::Difference(part) })
            .collect();
        match shapes.len() {
            0 => None,
            1 => shapes.pop(),
            _ => Some(Shape::Union(shapes)),
        }
    }

    /// The borders of the section. Each triangle that has corners on both sides of the plane gives a line, with the
    /// material to its left, from where its border goes down through the plane to where it comes up; the next triangle
    /// goes on there.
    fn borders(&self, height: f64) -> Borders {
        let corner = |number: u32| self.0.corners[number as usize];
        let above = |number: u32| corner(number)[2] >= height;
        let mut next = HashMap::new();
        let mut starts = Vec::new();
        for triangle in &self.0.triangles {
            let crossed = |up: bool| {
                let found =
                    edges(&triangle.corners).into_iter().find(|[a, b]| above(*a) != up && above(*b) == up);
                found.map(|[a, b]| [a.min(b), a.max(b)])
            };
            if let (Some(down), Some(up)) = (crossed(false), crossed(true)) {
                next.insert(down, up);
                starts.push(down);
            }
        }
        let place = |[a, b]: [u32; 2]| {
            let (a, b) = (corner(a), corner(b));
            let along = (height - a[2]) / (b[2] - a[2]);
            [0, 1].map(|k| a[k] + along * (b[k] - a[k]))
        };
        let size = Vector(self.0.bounds.size()).norm();
        let mut borders = Vec::new();
        for start in starts {
            let mut border = Vec::new();
            let mut edge = start;
            // Each edge belongs to one border.
            while let Some(onward) = next.remove(&edge) {
                border.push(place(edge));
                edge = onward;
            }
            let border = without_straight(border, STRAIGHT * size);
            if border.len() > 2 {
                borders.push(border);
            }
        }
        borders
    }
}

/// A polygon without corners that are nearer than `off` to the line between their neighbours [m].
fn without_straight(points: Vec<[f64; 2]>, off: f64) -> Vec<[f64; 2]> {
    let mut kept: Vec<[f64; 2]> = Vec::new();
    let straight = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        let ([x, y], [u, v]) = ([c[0] - a[0], c[1] - a[1]], [b[0] - a[0], b[1] - a[1]]);
        let length = x.hypot(y);
        u.hypot(v) <= off || length > 0.0 && (x * v - y * u).abs() <= off * length && u * x + v * y >= 0.0
    };
    for point in points {
        while let [.., a, b] = kept[..]
            && straight(a, b, point)
        {
            kept.pop();
        }
        kept.push(point);
    }
    // Around the corner with which it began.
    while let [a, .., y, z] = kept[..]
        && straight(y, z, a)
    {
        kept.pop();
    }
    while let [a, b, .., z] = kept[..]
        && straight(z, a, b)
    {
        kept.remove(0);
    }
    kept
}

/// Twice the area [m^2], negative where the corners go round clockwise.
fn twice_area(points: &[[f64; 2]]) -> f64 {
    let onward = points.iter().cycle().skip(1);
    let from = points[0];
    let across = |a: &[f64; 2], b: &[f64; 2]| {
        (a[0] - from[0]) * (b[1] - from[1]) - (b[0] - from[0]) * (a[1] - from[1])
    };
    points.iter().zip(onward).map(|(a, b)| across(a, b)).sum()
}

#[cfg(test)]
mod tests {
    use super::super::tests::cube;
    use super::*;

    /// A box within a box, its inside left out, and another box in that: area and holes, at any height.
    #[test]
    fn a_section_has_the_areas_of_what_it_cuts() {
        let mut triangles = cube([-2.0; 3], [2.0; 3]);
        triangles.extend(cube([-1.0; 3], [1.0; 3]).into_iter().map(|[a, b, c]| [a, c, b]));
        triangles.extend(cube([-0.5; 3], [0.5; 3]));
        triangles.extend(cube([3.0, 0.0, 0.0], [4.0, 1.0, 1.0]));
        let mesh = Mesh::new("test", triangles).expect("closed");
        // Of squares of a tenth, on whose corners all borders lie.
        let area = |height| {
            let shape = mesh.section(height)?;
            let middles = |i: i32| f64::from(i) / 10.0 + 0.05;
            let squares = (-30..50).flat_map(|i| (-30..30).map(move |j| [middles(i), middles(j), 0.0]));
            Some(squares.filter(|&middle| shape.contains(middle, 2)).count() as f64 / 100.0)
        };
        // The largest box, less the hole, with the one in it and the one beside it.
        for (height, expected) in
            [(1.5, 16.0), (0.7, 16.0 - 4.0 + 1.0), (0.3, 14.0), (-0.3, 13.0), (0.0, 13.0)]
        {
            let found = area(height).expect("cut");
            assert!((found - expected).abs() < 1e-12, "{height}: {found}");
        }
        assert_eq!(area(2.5), None);
        let shape = mesh.section(0.3).expect("cut");
        let inside = |x, y| shape.contains([x, y, 0.0], 2);
        assert!(
            inside(1.5, 0.0)
                && !inside(0.7, 0.7)
                && inside(0.2, 0.2)
                && inside(3.5, 0.5)
                && !inside(2.5, 0.5)
        );
    }

    /// Where a face is two triangles, its edge is still one line, and distances are those of the rectangle.
    #[test]
    fn the_section_of_a_box_is_a_rectangle() {
        let mesh = Mesh::new("test", cube([0.1, 0.2, 0.0], [1.3, 0.7, 1.0])).expect("closed");
        let Some(Shape::Polygon { points, .. }) = mesh.section(1.0 / 3.0) else { panic!("one polygon") };
        assert_eq!(points.len(), 4, "{points:?}");
        let expected = [[0.1, 0.2], [1.3, 0.2], [1.3, 0.7], [0.1, 0.7]];
        let near = |p: &[f64; 2]| expected.iter().any(|q| (p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12);
        assert!(points.iter().all(near), "{points:?}");
    }
}
