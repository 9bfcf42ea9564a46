//! A tree of boxes around triangles.

use crate::geometry::Bounds;

/// Triangles in boxes in boxes.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree {
    boxes: Vec<Branch>,
    /// Numbers of the triangles, those of a box side by side.
    order: Vec<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Branch {
    bounds: Bounds,
    /// First triangle in the order, or first of two boxes.
    first: u32,
    /// Triangles; none where there are two boxes.
    count: u32,
}

/// Most triangles in a box without boxes.
const MOST: usize = 4;

/// Boxes on the way to a triangle that may wait: two a level.
const WAITING: usize = 128;

impl Tree {
    /// A tree of triangles by their boxes.
    pub fn new(boxes: &[Bounds]) -> Self {
        let mut tree = Tree { boxes: Vec::new(), order: (0..boxes.len() as u32).collect() };
        let everything = Branch { bounds: Bounds::EMPTY, first: 0, count: boxes.len() as u32 };
        tree.boxes.push(everything);
        let mut next = 0;
        while next < tree.boxes.len() {
            let Branch { first, count, .. } = tree.boxes[next];
            let here = &mut tree.order[first as usize..(first + count) as usize];
            tree.boxes[next].bounds =
                here.iter().fold(Bounds::EMPTY, |all, &i| all.united(&boxes[i as usize]));
            if here.len() > MOST {
                let middle = |i: u32, k: usize| boxes[i as usize].min[k] + boxes[i as usize].max[k];
                let spread =
                    Bounds::around(here.iter().map(|&i| std::array::from_fn(|k| middle(i, k)))).size();
                let axis = (0..3).fold(0, |best, k| if spread[k] > spread[best] { k } else { best });
                let half = here.len() / 2;
                here.sort_unstable_by(|&i, &j| middle(i, axis).total_cmp(&middle(j, axis)).then(i.cmp(&j)));
                let child = |first: u32, count: u32| Branch { bounds: Bounds::EMPTY, first, count };
                let place = tree.boxes.len() as u32;
                tree.boxes.push(child(first, half as u32));
                tree.boxes.push(child(first + half as u32, count - half as u32));
                (tree.boxes[next].first, tree.boxes[next].count) = (place, 0);
            }
            next += 1;
        }
        tree
    }

    /// Visits triangles that may be nearer to a point than all before:
    /// `distance` gives the squared distance of a triangle, or infinity.
    pub fn nearest(&self, point: [f64; 3], mut distance: impl FnMut(usize) -> f64) {
        let mut nearest = f64::INFINITY;
        let mut waiting = [(0_u32, 0.0); WAITING];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (place, away) = waiting[count];
            if away >= nearest {
                continue;
            }
            let branch = &self.boxes[place as usize];
            if branch.count > 0 {
                for &triangle in &self.order[branch.first as usize..(branch.first + branch.count) as usize] {
                    nearest = nearest.min(distance(triangle as usize));
                }
                continue;
            }
            let [a, b] = [branch.first, branch.first + 1].map(|place| (place, self.away(place, point)));
            let (near, far) = if a.1 <= b.1 { (a, b) } else { (b, a) };
            waiting[count] = far;
            waiting[count + 1] = near;
            count += 2;
        }
    }

    /// Squared distance of a point from a box [m^2].
    fn away(&self, place: u32, point: [f64; 3]) -> f64 {
        let Bounds { min, max } = &self.boxes[place as usize].bounds;
        (0..3).map(|k| (min[k] - point[k]).max(point[k] - max[k]).max(0.0).powi(2)).sum()
    }

    /// Visits triangles whose boxes a ray along x from a point meets.
    pub fn along_x(&self, point: [f64; 3], mut visit: impl FnMut(usize)) {
        let mut waiting = [0_u32; WAITING];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let branch = &self.boxes[waiting[count] as usize];
            let Bounds { min, max } = &branch.bounds;
            if max[0] < point[0] || (1..3).any(|k| point[k] < min[k] || point[k] > max[k]) {
                continue;
            }
            if branch.count > 0 {
                let here = branch.first as usize..(branch.first + branch.count) as usize;
                self.order[here].iter().for_each(|&triangle| visit(triangle as usize));
            } else {
                waiting[count] = branch.first;
                waiting[count + 1] = branch.first + 1;
                count += 2;
            }
        }
    }
}
