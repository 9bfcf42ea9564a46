//! Linear elasticity in plane strain by four-node elements, for answers that no formula gives.
//!
//! The change of volume is taken from the middle of each element, so that nearly incompressible ones do not lock
//! (selective reduced integration: Hughes 1980, Int. J. Numer. Methods Eng. 15).

/// n x n elements, and what holds and loads their nodes.
pub struct ElementGrid {
    n: usize,
    /// Places of the nodes, row by row [m].
    pub places: Vec<[f64; 2]>,
    poisson: f64,
    /// Prescribed displacement of each degree of freedom, x and y of a node after the other [m].
    pub prescribed: Vec<Option<f64>>,
    /// Force on each degree of freedom, per thickness [N/m].
    pub force: Vec<f64>,
}

impl ElementGrid {
    /// Elements of E = 1 on the image of the unit square.
    pub fn new(n: usize, poisson: f64, image: impl Fn(f64, f64) -> [f64; 2]) -> Self {
        let at = |k: usize| k as f64 / n as f64;
        let places: Vec<_> = (0..=n).flat_map(|j| (0..=n).map(move |i| (i, j))).collect();
        let places: Vec<_> = places.into_iter().map(|(i, j)| image(at(i), at(j))).collect();
        let count = 2 * places.len();
        ElementGrid { n, places, poisson, prescribed: vec![None; count], force: vec![0.0; count] }
    }

    /// Number of the node in a column and a row.
    pub fn node(&self, i: usize, j: usize) -> usize {
        j * (self.n + 1) + i
    }

    /// The nodes of each element, counterclockwise.
    fn elements(&self) -> impl Iterator<Item = [usize; 4]> + '_ {
        (0..self.n * self.n).map(|e| {
            let (i, j) = (e % self.n, e / self.n);
            [self.node(i, j), self.node(i + 1, j), self.node(i + 1, j + 1), self.node(i, j + 1)]
        })
    }

    /// Adds a body force per volume, and says how much of the area each node has.
    pub fn add_weight(&mut self, force: [f64; 2]) -> Vec<f64> {
        let mut areas = vec![0.0; self.places.len()];
        for nodes in self.elements().collect::<Vec<_>>() {
            for (_, area, weights) in gauss_points(nodes.map(|node| self.places[node])) {
                for (node, weight) in nodes.into_iter().zip(weights) {
                    areas[node] += weight * area;
                    (0..2).for_each(|i| self.force[2 * node + i] += weight * area * force[i]);
                }
            }
        }
        areas
    }

    /// Displacements, x and y of a node after the other [m].
    pub fn solve(&self) -> Vec<f64> {
        let (dofs, band) = (self.force.len(), 2 * self.n + 6);
        // Rows of the lower band: entry [dof][band - 1 - (dof - other)].
        let (mut matrix, mut load) = (vec![vec![0.0; band]; dofs], self.force.clone());
        for nodes in self.elements() {
            let element = self.stiffness(nodes);
            let dofs = degrees(nodes);
            for (a, &p) in dofs.iter().enumerate() {
                for (b, &q) in dofs.iter().enumerate() {
                    match (self.prescribed[p], self.prescribed[q]) {
                        (None, None) if q <= p => matrix[p][band - 1 + q - p] += element[a][b],
                        (None, Some(value)) => load[p] -= element[a][b] * value,
                        _ => {}
                    }
                }
            }
        }
        for dof in 0..dofs {
            if let Some(value) = self.prescribed[dof] {
                (matrix[dof][band - 1], load[dof]) = (1.0, value);
            }
        }
        solve_band(&mut matrix, load, band)
    }

    /// Twice the strain energy of displacements, per thickness [J/m].
    pub fn twice_the_energy(&self, displacement: &[f64]) -> f64 {
        let of_element = |nodes: [usize; 4]| {
            let (element, dofs) = (self.stiffness(nodes), degrees(nodes));
            let pair = |a: usize, b: usize| element[a][b] * displacement[dofs[a]] * displacement[dofs[b]];
            (0..8).flat_map(|a| (0..8).map(move |b| (a, b))).map(|(a, b)| pair(a, b)).sum::<f64>()
        };
        self.elements().map(of_element).sum()
    }

    /// Stiffness of an element: shape from four points, the volume's change from its middle.
    fn stiffness(&self, nodes: [usize; 4]) -> [[f64; 8]; 8] {
        let shear = 0.5 / (1.0 + self.poisson);
        let lame = self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson));
        let corners = nodes.map(|node| self.places[node]);
        let mut element = [[0.0; 8]; 8];
        let mut add = |s: [[f64; 2]; 4], area: f64, lame: f64, shear: f64| {
            for (a, row) in element.iter_mut().enumerate() {
                for (b, entry) in row.iter_mut().enumerate() {
                    let ([p, i], [q, j]) = ([a / 2, a % 2], [b / 2, b % 2]);
                    let same = if i == j { s[p][0] * s[q][0] + s[p][1] * s[q][1] } else { 0.0 };
                    *entry += area * (lame * s[p][i] * s[q][j] + shear * (same + s[p][j] * s[q][i]));
                }
            }
        };
        let mut whole = 0.0;
        for (slopes, area, _) in gauss_points(corners) {
            add(slopes, area, 0.0, shear);
            whole += area;
        }
        let (middle, ..) = at_point(corners, [0.0, 0.0]);
        add(middle, whole, lame, 0.0);
        element
    }
}

/// Degrees of freedom of an element's nodes.
fn degrees(nodes: [usize; 4]) -> [usize; 8] {
    std::array::from_fn(|k| 2 * nodes[k / 2] + k % 2)
}

/// At each of the four points of integration: gradients of the shape functions, the area there, and the functions.
fn gauss_points(corners: [[f64; 2]; 4]) -> [([[f64; 2]; 4], f64, [f64; 4]); 4] {
    let gauss = 1.0 / 3.0_f64.sqrt();
    [[-gauss, -gauss], [gauss, -gauss], [gauss, gauss], [-gauss, gauss]].map(|point| at_point(corners, point))
}

/// The same at a point of the square from -1 to 1, with the area of a point of weight 1.
fn at_point(corners: [[f64; 2]; 4], [x, y]: [f64; 2]) -> ([[f64; 2]; 4], f64, [f64; 4]) {
    const SQUARE: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let local = SQUARE.map(|[cx, cy]| [0.25 * cx * (1.0 + cy * y), 0.25 * cy * (1.0 + cx * x)]);
    let mut jacobian = [[0.0; 2]; 2];
    for (corner, slope) in corners.iter().zip(&local) {
        for i in 0..2 {
            (0..2).for_each(|j| jacobian[i][j] += corner[i] * slope[j]);
        }
    }
    let [[a, b], [c, d]] = jacobian;
    let area = a * d - b * c;
    let slopes = local.map(|[u, v]| [(d * u - c * v) / area, (a * v - b * u) / area]);
    (slopes, area, SQUARE.map(|[cx, cy]| 0.25 * (1.0 + cx * x) * (1.0 + cy * y)))
}

/// Cholesky's factors of a symmetric matrix in its lower band, and the solution.
fn solve_band(matrix: &mut [Vec<f64>], mut load: Vec<f64>, band: usize) -> Vec<f64> {
    let n = matrix.len();
    for row in 0..n {
        let first = row.saturating_sub(band - 1);
        for column in first..=row {
            let from = first.max(column.saturating_sub(band - 1));
            let (upper, lower) = matrix.split_at_mut(row);
            let of_row = &lower[0];
            let value = |line: &[f64], own: usize, k: usize| line[band - 1 + k - own];
            let sum: f64 = match column == row {
                true => (from..column).map(|k| value(of_row, row, k).powi(2)).sum(),
                false => {
                    (from..column).map(|k| value(of_row, row, k) * value(&upper[column], column, k)).sum()
                }
            };
            let left = value(of_row, row, column) - sum;
            let entry = if column == row { left.sqrt() } else { left / upper[column][band - 1] };
            lower[0][band - 1 + column - row] = entry;
        }
        let done: f64 = (first..row).map(|k| matrix[row][band - 1 + k - row] * load[k]).sum();
        load[row] = (load[row] - done) / matrix[row][band - 1];
    }
    for row in (0..n).rev() {
        load[row] /= matrix[row][band - 1];
        for k in row.saturating_sub(band - 1)..row {
            load[k] -= matrix[row][band - 1 + k - row] * load[row];
        }
    }
    load
}
