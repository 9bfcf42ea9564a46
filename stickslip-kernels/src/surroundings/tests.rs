use super::sums::{FIRST, FORCE, MASS, placed_rows};
use super::*;
use crate::basis::{Cubic, Gimp, Linear};
use crate::boundary::{Boundary, reflect};
use crate::grid::{ActiveBlocks, Lattice, next_of, node_at};
use crate::lanes::Processor;
use crate::matter::Particle;
use crate::particles::{ColumnStart, OwnColumns, Particles, deformation_entries, stress_entries};
use crate::tensor::{Matrix, Number, Symmetric, Vector};
use crate::transfer::{Stencil, offsets};

/// The boxes as which nodes see particles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Boxes {
    Own,
    WholeCells,
    TwoCells,
}

/// Particles strewn over a few cells before two mirrors, deformed and stressed.
fn body<const D: usize>() -> Particles<f64, D> {
    let random = |i: usize| (i as f64 * 0.754_877_666_2).fract();
    let place = |i: usize, n: usize| Vector::from_fn(|k| 5.0 * random((k + n) * i + k));
    let particle = |i: usize| {
        let mut deformation = Matrix::IDENTITY;
        let mut stress = Symmetric::ZERO;
        for (k, &[row, column]) in deformation_entries(D).iter().enumerate() {
            deformation.0[row][column] += 0.3 * random(31 * i + 7 * k) - 0.15;
        }
        (0..stress_entries(D)).for_each(|k| stress.0[k] = random(17 * i + 5 * k) - 0.5);
        Particle {
            position: place(i, 11),
            velocity: Vector::ZERO,
            spin: Vector::ZERO,
            mass: 1.0 + random(i),
            volume: 0.5 + random(2 * i + 1),
            half_width: 0.2 + 0.05 * random(3 * i),
            deformation,
            stress,
            number: i as u32,
        }
    };
    // Where they were at first, and where they are now.
    let mut particles = Particles::from_fn(300, OwnColumns::default(), particle);
    for i in 0..300 {
        particles.set(i, &Particle { position: place(i, 3), ..particle(i) });
    }
    particles
}

/// The same sums, particle by particle as the equations read, for every image of the node.
fn plainly<const D: usize, B: Basis<f64>>(
    (near, particles): (&Surroundings<'_, f64, D>, &Particles<f64, D>),
    node: [i32; D],
    first: Vector<f64, D>,
) -> MaterialSums<f64, D> {
    let mut sums = MaterialSums::<f64, D>::EMPTY;
    for turned in offsets::<D>(2) {
        let walls: Vec<&Wall> = near.walls.iter().filter(|wall| turned[wall.axis] == 1).collect();
        if walls.len() != turned.iter().sum::<usize>() {
            continue;
        }
        let image = walls.iter().fold(node, |node, wall| wall.image(node));
        let flip = |v: Vector<f64, D>| walls.iter().fold(v, |v, wall| reflect(v, wall.axis));
        let seen = |mut x: Vector<f64, D>| {
            walls.iter().for_each(|wall| x[wall.axis] = 2.0 * f64::from(wall.node) - x[wall.axis]);
            x
        };
        let sign = |i: usize| if i < D && turned[i] == 1 { -1.0 } else { 1.0 };
        let columns = particles.view();
        for (index, particle) in particles.iter().enumerate() {
            let stencil = Stencil::<f64, D, B>::of(&near.lattice, &particle);
            let Some(offset) = offsets::<D>(B::WIDTH)
                .find(|offset| (0..D).all(|i| stencil.base()[i] + offset[i] as i32 == image[i]))
            else {
                continue;
            };
            let (weight, gradient) = stencil.at(offset);
            let force = flip(-particle.stress.times(gradient)) * particle.volume;
            let gradient = flip(-gradient);
            let share = particle.room() * weight;
            let inverse = particle.deformation.inverse();
            let inverse = Matrix::from_fn(|i, j| inverse.0[i][j] * sign(i) * sign(j));
            let arm = seen(particle.position) - first;
            // SAFETY: nobody else uses the particles.
            let at = |k: usize| unsafe { *columns.at(ColumnStart::<D>::START + k, index) };
            let start = seen(Vector::from_fn(at));
            let mut placed = Vec::new();
            placed.extend((0..D).map(|i| start[i] - (0..D).map(|j| inverse.0[i][j] * arm[j]).sum::<f64>()));
            placed.extend(arm.0);
            placed.extend((0..D * D).map(|k| inverse.0[k / D][k % D]));
            for (k, number) in placed.into_iter().enumerate() {
                sums.0[FIRST + k / 4][k % 4] += share * number;
            }
            let pairs = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];
            for k in 0..stress_entries(D) {
                let stress = particle.stress.0[k] * sign(pairs[k][0]) * sign(pairs[k][1]);
                sums.0[FIRST + placed_rows(D) + k / 4][k % 4] += share * stress;
            }
            for i in 0..D {
                sums.0[0][i] += gradient[i] * particle.room();
                sums.0[MASS][i] += gradient[i] * particle.mass;
                sums.0[FORCE][i] += force[i];
            }
            sums.0[0][3] += share;
            sums.0[MASS][3] += particle.mass * weight;
        }
    }
    sums
}

fn particles_of_a_cell_side_by_side_give_the_sums<const D: usize, B: Basis<f64>>(boxes: Boxes) {
    let half_side = match boxes {
        Boxes::Own => None,
        Boxes::WholeCells => Some(0.5),
        Boxes::TwoCells => Some(1.0),
    };
    let lattice = Lattice { half_side, ..Lattice::new(Vector::ZERO, 1.0) };
    let particles = body::<D>();
    let mut active = ActiveBlocks::<D>::default();
    let base = |_, particle| {
        let (position, half_width) = particles.place(particle);
        let half = lattice.seen_half_side(half_width);
        std::array::from_fn(|i| Number::max(B::reach(position[i], half), -9.0).floor() as i32)
    };
    let number = |_, particle: usize| particles.numbers()[particle];
    active.update((1, |_| 300, B::WIDTH as i32 - 1), None, (base, number));
    let wall = |axis, node, inward| Wall { axis, node, inward, face: Face::Symmetry };
    let boundary = Boundary::new(vec![wall(0, 0, 1), wall(D - 1, 5, -1)]);
    for processor in Processor::available() {
        let near = Surroundings { active: &active, lattice, walls: &boundary.walls, processor };
        let seen = SeenBody {
            number: 0,
            columns: particles.view(),
            trusts_deformation: true,
            is_joined: [false; D],
        };
        for block in offsets::<D>(2).map(|block| block.map(|b| b as i32)) {
            let wanted = every_node(D) & 0x9e37_79b9_7f4a_7c15;
            let [everything, places] = [Wanted::Everything, Wanted::Places].map(|sought| {
                let mut sums = vec![MaterialSums::EMPTY; wanted.count_ones() as usize];
                sum_around::<f64, D, B>(
                    &near,
                    (&seen, block),
                    (wanted, sought),
                    (&mut sums, &mut Vec::new()),
                );
                sums
            });
            let mut nodes = wanted;
            for (sums, places) in everything.iter().zip(&places) {
                let node = node_at(block, next_of(&mut nodes).expect("as many nodes as sums"));
                let plain = plainly::<D, B>((&near, &particles), node, lattice.position(node_at(block, 0)));
                for (a, b) in sums.0.as_flattened().iter().zip(plain.0.as_flattened()) {
                    assert!((a - b).abs() < 1e-10, "{block:?} {node:?}: {sums:?} {plain:?}");
                }
                let placed = FIRST + placed_rows(D);
                assert_eq!(sums.0[..placed], places.0[..placed], "{block:?} {node:?}");
            }
        }
    }
}

#[test]
fn sums_are_those_of_the_equations() {
    particles_of_a_cell_side_by_side_give_the_sums::<2, Linear>(Boxes::Own);
    particles_of_a_cell_side_by_side_give_the_sums::<3, Linear>(Boxes::Own);
    for boxes in [Boxes::Own, Boxes::WholeCells] {
        particles_of_a_cell_side_by_side_give_the_sums::<2, Gimp>(boxes);
        particles_of_a_cell_side_by_side_give_the_sums::<3, Gimp>(boxes);
    }
    particles_of_a_cell_side_by_side_give_the_sums::<2, Cubic>(Boxes::TwoCells);
    particles_of_a_cell_side_by_side_give_the_sums::<3, Cubic>(Boxes::TwoCells);
}

#[test]
fn nodes_behind_a_wall() {
    let wall = Wall { axis: 1, node: 6, inward: -1, face: Face::Fixed };
    for (block, nodes) in [([0, 0], 0), ([0, 1], 0xcccc), ([3, 2], 0xffff)] {
        assert_eq!(behind::<2>(&wall, block, 0), nodes, "{block:?}");
    }
    let wall = Wall { axis: 0, node: 1, inward: 1, face: Face::Fixed };
    assert_eq!(behind::<3>(&wall, [0; 3], -1), 0xffff);
}
