use super::*;
use crate::cells::Table;
use std::sync::Arc;
use stickslip_kernels::lanes::Processor;
use stickslip_kernels::matter::{Gyration, Matter, Particle};
use stickslip_kernels::particles::{OwnColumns, Particles};
use stickslip_mechanics::geometry::Shape;
use stickslip_mechanics::geometry::form::HeldFaces;
use stickslip_mechanics::material::Motion;
use stickslip_mechanics::material::{AtRest, Isotropic, Material, NeoHookean, Thickness};
use stickslip_mechanics::scheme::VolumeChange;
use stickslip_mechanics::tensor::{Matrix, Symmetric};

pub const DENSITY: f64 = 1000.0;
const YOUNG: f64 = 1e6;
const POISSON: f64 = 0.3;

/// A body with all that a step needs.
pub struct Alone<const D: usize> {
    pub interior: Interior<D>,
    pub particles: Particles<f64, D>,
    pub matter: Matter<f64>,
    pub table: Table<f64, D>,
    /// Speed of the fastest wave in undeformed lengths [m/s].
    pub signal: f64,
}

impl<const D: usize> Alone<D> {
    pub fn new(shape: &Shape, cell: f64, velocity: impl Fn(Vector<f64, D>) -> Vector<f64, D>) -> Self {
        let form = Arc::new(Form::<D>::new(shape, cell, HeldFaces::default()).unwrap());
        let law = Material::NeoHookean(NeoHookean { elastic: elastic() });
        let matter = Matter {
            material: Arc::new(law),
            density: DENSITY,
            expansion: 0.0,
            thickness: Thickness::Moved,
            gyration: Gyration { cell: 0.0, share: 0.0 },
            volume_change: VolumeChange::Own,
        };
        let particle = |p: usize| Particle {
            position: form.places[p],
            velocity: Vector::ZERO,
            spin: Vector::ZERO,
            mass: form.volumes[p] * DENSITY,
            volume: form.volumes[p],
            half_width: 0.25 * cell,
            deformation: Matrix::IDENTITY,
            stress: Symmetric::ZERO,
            number: p as u32,
        };
        let particles = Particles::from_fn(form.places.len(), OwnColumns::default(), particle);
        let interior = Interior::new(form.clone(), DENSITY, velocity);
        let mut alone = Alone { interior, particles, matter, table: Table::new(&form), signal: 0.0 };
        alone.strain(0.0);
        alone
    }

    pub fn strain(&mut self, dt: f64) {
        let mut ask = |asked: Asked| {
            let straining = Straining { body: 0, dt, viscosity: None, processor: Processor::best(), asked };
            let (found, _) =
                strain(&mut self.interior, &self.table, (&self.matter, &mut self.particles), straining);
            assert!(found.fault.is_none(), "{found:?}");
            found.signal
        };
        self.signal = ask(Asked::Forces);
        ask(Asked::State);
        self.interior.gather_forces();
    }

    /// A step by a Courant number, in which a function may change velocities; its length [s].
    pub fn step(&mut self, courant: f64, hold: impl Fn(&mut Interior<D>)) -> f64 {
        let dt = courant * self.interior.form.cell / self.signal;
        self.interior.accelerate(dt, Vector::ZERO, &[]);
        hold(&mut self.interior);
        self.interior.advance(dt);
        self.strain(dt);
        dt
    }

    /// Strain energy [J].
    pub fn strain_energy(&self) -> f64 {
        let density = |p: &Particle<f64, D>| {
            let energies = self.matter.material.energies(&p.deformation, &p.stress, &AtRest(&[]));
            energies[0] * p.mass / DENSITY
        };
        self.particles.iter().map(|p| density(&p)).sum()
    }
}

pub fn elastic() -> Isotropic<f64> {
    Isotropic {
        bulk_modulus: YOUNG / (3.0 * (1.0 - 2.0 * POISSON)),
        shear_modulus: YOUNG / (2.0 * (1.0 + POISSON)),
    }
}

/// Speed of a longitudinal wave [m/s].
pub fn p_wave() -> f64 {
    (elastic().p_wave_modulus() / DENSITY).sqrt()
}

fn angular_momentum(interior: &Interior<2>) -> f64 {
    let all = interior.masses.iter().zip(interior.places.iter().zip(&interior.velocities));
    all.map(|(m, (x, v))| m * (x[0] * v[1] - x[1] * v[0])).sum()
}

#[test]
fn a_disk_keeps_its_spin_and_energy() {
    let (radius, rim) = (1.0, 0.05 * p_wave());
    let spin = move |x: Vector<f64, 2>| Vector([-x[1], x[0]]) * (rim / radius);
    let mut disk = Alone::<2>::new(&Shape::disk([0.0; 2], radius), radius / 5.0, spin);
    // Inertia is that of a disk.
    let exact = 0.5 * DENSITY * std::f64::consts::PI * radius.powi(4) * rim / radius;
    assert!((angular_momentum(&disk.interior) / exact - 1.0).abs() < 1e-9);
    let (momentum, energy) =
        (angular_momentum(&disk.interior), disk.interior.kinetic() + disk.strain_energy());
    let (mut turns, mut time) = (0.0, 0.0);
    while turns < 20.0 {
        let dt = disk.step(0.7, |_| ());
        (turns, time) = (turns + dt * rim / radius / std::f64::consts::TAU, time + dt);
    }
    assert!((angular_momentum(&disk.interior) / momentum - 1.0).abs() < 1e-11, "after {time} s");
    let now = disk.interior.kinetic() + disk.strain_energy();
    assert!((now / energy - 1.0).abs() < 1e-3, "{now} for {energy}");
    assert!(disk.interior.momentum().norm() < 1e-9 * momentum);
}

/// Stress over the undeformed section of a neo-Hookean strip in plane strain that is free to narrow [Pa].
fn uniaxial(stretch: f64) -> f64 {
    let at = |across: f64| {
        let mut f = Matrix::IDENTITY;
        (f.0[0][0], f.0[1][1]) = (stretch, across);
        let motion =
            Motion { deformation: f, jacobian: f.det(), increment: f, stress: Symmetric::ZERO, dt: 1.0 };
        (f.det(), NeoHookean { elastic: elastic() }.stress(&motion))
    };
    let (mut low, mut high) = (0.1, 1.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if at(middle).1.0[1] > 0.0 { high = middle } else { low = middle }
    }
    let (jacobian, stress) = at(low);
    jacobian * stress.0[0] / stretch
}

#[test]
fn a_strip_is_pulled_to_three_times_its_length_by_the_exact_force() {
    // Between frictionless grips: the lattice of nodes fits it, and another that does not.
    for height in [0.4, 0.43] {
        let (length, cell) = (1.0, 0.1);
        let shape = Shape::rectangle([0.0, 0.0], [length, height]);
        let mut strip = Alone::<2>::new(&shape, cell, |_| Vector::ZERO);
        let masters = |interior: &Interior<2>, end: f64| -> Vec<usize> {
            let on = |node: &usize| (interior.form.node_place(*node)[0] - end).abs() < 1e-9;
            (0..interior.masses.len()).filter(|node| interior.masses[*node] > 0.0).filter(on).collect()
        };
        let ends = [0.0, length].map(|end| masters(&strip.interior, end));
        let (speed, mut stretch) = (0.01 * p_wave(), 1.0);
        for aim in [1.2, 2.0, 3.0] {
            let mut means = [0.0; 2];
            while stretch < aim {
                let forces: f64 = ends[1].iter().map(|&node| strip.interior.forces[node][0]).sum();
                if stretch > aim - 0.01 {
                    means = [means[0] - forces, means[1] + 1.0];
                }
                let dt = strip.step(0.4, |interior| {
                    for (node, velocity) in interior.velocities.iter_mut().enumerate() {
                        let x = interior.places[node][0] / (stretch * length);
                        // Damped towards even stretching.
                        velocity[0] = 0.98 * velocity[0] + 0.02 * speed * x;
                        velocity[1] *= 0.98;
                    }
                    ends[0].iter().for_each(|&node| interior.velocities[node][0] = 0.0);
                    ends[1].iter().for_each(|&node| interior.velocities[node][0] = speed);
                    interior.follow();
                });
                stretch += speed * dt / length;
            }
            let ratio = means[0] / means[1] / (uniaxial(aim - 0.005) * height);
            assert!((ratio - 1.0).abs() < 0.01, "height {height}, stretch {aim}: {ratio}");
        }
    }
}

/// A cantilever swings a hundred times.
#[test]
fn a_beam_of_four_cells_swings_on() {
    let (length, height, cell) = (1.0, 0.25, 0.0625);
    let shape = Shape::rectangle([0.0, 0.0], [length, height]);
    // Its first mode: the roots of cos k cosh k = -1.
    let (k, ratio) = (1.875104068711961_f64, 0.734095513740734);
    let shape_of = move |s: f64| (k * s).cosh() - (k * s).cos() - ratio * ((k * s).sinh() - (k * s).sin());
    let mode = move |x: Vector<f64, 2>| Vector([0.0, 0.002 * p_wave() * shape_of(x[0] / length)]);
    let mut beam = Alone::<2>::new(&shape, cell, mode);
    let form = beam.interior.form.clone();
    let clamped: Vec<usize> = (0..form.nodes()).filter(|&node| form.node_place(node)[0] < 1e-9).collect();
    let tip = form.weights(Vector([length, 0.5 * height]));
    let (mut time, mut crossings, mut before, mut last) = (0.0, Vec::new(), 0.0, 0.0_f64);
    let mut peaks = vec![0.0_f64];
    while crossings.len() < 201 {
        time += beam.step(0.8, |interior| {
            clamped.iter().for_each(|&node| interior.velocities[node] = Vector::ZERO);
            interior.follow();
        });
        let now = beam.interior.at(&tip, &beam.interior.places)[1] - 0.5 * height;
        if before < 0.0 && now >= 0.0 || before > 0.0 && now <= 0.0 {
            crossings.push(time);
            peaks.push(0.0);
        }
        last = last.max(now.abs());
        let peak = peaks.last_mut().expect("there is one");
        *peak = peak.max(now.abs());
        before = now;
    }
    let mean = |some: &[f64]| some.iter().sum::<f64>() / some.len() as f64;
    let left = mean(&peaks[180..200]) / mean(&peaks[1..21]);
    assert!((left - 1.0).abs() < 0.01, "amplitude after a hundred periods: {left} of {last}");
}

/// Lets nodes stand where a bent and stretched body has them, and move on.
fn bend<const D: usize>(alone: &mut Alone<D>) {
    let bent = |x: Vector<f64, D>| {
        let last = x[D - 1];
        Vector::from_fn(|k| {
            x[k] * (1.0 + 0.1 * k as f64) + 0.2 * last * (x[0] + 0.1 * last) + 0.05 * x[0] * x[1]
        })
    };
    alone.interior.places.iter_mut().for_each(|place| *place = bent(*place));
    alone.interior.follow();
}

/// Cells side by side give the forces of particles one by one, whether the body's grid is turned, its faces cut cells,
/// or rows are longer than lanes; and particles that stayed behind are, once shown, what they are one by one.
#[test]
fn forces_are_those_of_particles_one_by_one_and_do_not_depend_on_who_looks() {
    fn compare<const D: usize>(shape: &Shape, share: f64) {
        let changes = [VolumeChange::Own, VolumeChange::Averaged];
        changes.into_iter().for_each(|change| compare_by::<D>(shape, share, change));
    }
    fn compare_by<const D: usize>(shape: &Shape, share: f64, volume_change: VolumeChange) {
        let mut alone = Alone::<D>::new(shape, 0.1, |x| x * 0.3);
        alone.matter.volume_change = volume_change;
        bend(&mut alone);
        let whole: u32 = alone.table.blocks.iter().map(|block| block.count).sum();
        assert!(f64::from(whole) >= share * alone.interior.form.cells.len() as f64, "{whole}");
        let mut strained = |processor: Processor, asked: &[Asked]| {
            let mut all = alone.particles.clone();
            let interior = &mut alone.interior;
            let mut signal = 0.0;
            for &asked in asked {
                let straining = Straining { body: 0, dt: 0.0, viscosity: None, processor, asked };
                let (found, _) = strain(interior, &alone.table, (&alone.matter, &mut all), straining);
                assert!(found.fault.is_none(), "{found:?}");
                signal = f64::max(signal, found.signal);
            }
            let state = |p: Particle<f64, D>| -> Vec<f64> {
                let numbers = [&p.position.0[..], &p.velocity.0, p.deformation.0.as_flattened()].concat();
                numbers.into_iter().chain(p.stress.0.map(|stress| stress / YOUNG)).collect()
            };
            (interior.forces.clone(), signal, all.iter().flat_map(state).collect::<Vec<_>>())
        };
        let (one_by_one, slow, expected) = strained(Processor::Any, &[Asked::Forces]);
        let largest = one_by_one.iter().map(|force| force.norm()).fold(0.0, f64::max);
        for processor in Processor::available() {
            let (forces, signal, _) = strained(processor, &[Asked::Forces]);
            for (force, expected) in forces.iter().zip(&one_by_one) {
                assert!((*force - *expected).norm() < 1e-13 * largest, "{force:?} {expected:?}");
            }
            // A bound, which is another one along other axes.
            assert!((0.6..1.7).contains(&(signal / slow)), "{signal} {slow}");
            let shown = strained(processor, &[Asked::Forces, Asked::State]);
            assert!((&shown.0, shown.1) == (&forces, signal));
            let apart = shown.2.iter().zip(&expected).map(|(x, expected)| (x - expected).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-13 && shown.2.len() == expected.len());
        }
    }
    let cuboid = |size: [f64; 3]| Shape::Box { min: [0.0; 3], max: size };
    let turned = |shape: Shape| Shape::Rotated {
        shape: Box::new(shape),
        center: [0.1, 0.2, 0.0],
        axis: [0.0, 0.0, 1.0],
        angle: 0.4,
    };
    compare::<3>(&cuboid([0.5, 0.4, 1.1]), 1.0);
    compare::<3>(&turned(cuboid([0.5, 0.4, 1.1])), 1.0);
    compare::<3>(&cuboid([0.53, 0.4, 0.66]), 0.2);
    compare::<3>(&Shape::Ball { center: [0.0; 3], radius: 0.42 }, 0.1);
    compare::<2>(&cuboid([0.5, 1.1, 0.0]), 1.0);
    compare::<2>(&turned(cuboid([0.5, 1.1, 0.0])), 1.0);
    compare::<2>(&Shape::disk([0.0; 2], 0.42), 0.3);
}

/// Where particles share the dilatation of their cell, forces are what the strain energy loses as nodes move:
/// f_I = -dE/dx_I; and a stretch that is the same everywhere gives the forces of particles on their own.
#[test]
fn forces_of_shared_volumes_are_the_gradient_of_the_energy() {
    fn differ<const D: usize>(shape: &Shape) {
        let mut alone = Alone::<D>::new(shape, 0.1, |_| Vector::ZERO);
        alone.interior.places.iter_mut().for_each(|place| *place = *place * 1.1);
        alone.strain(0.0);
        let own = alone.interior.forces.clone();
        alone.matter.volume_change = VolumeChange::Averaged;
        alone.strain(0.0);
        let largest = own.iter().map(|force| force.norm()).fold(0.0, f64::max);
        let apart = own.iter().zip(&alone.interior.forces).map(|(a, b)| (*a - *b).norm());
        assert!(apart.fold(0.0, f64::max) < 1e-12 * largest);

        bend(&mut alone);
        alone.strain(0.0);
        let (forces, places) = (alone.interior.forces.clone(), alone.interior.places.clone());
        let largest = forces.iter().map(|force| force.norm()).fold(0.0, f64::max);
        let moved = 1e-6;
        let masters = (0..places.len()).filter(|&node| alone.interior.masses[node] > 0.0);
        for node in masters.step_by(7).collect::<Vec<_>>() {
            for (axis, &force) in forces[node].0.iter().enumerate() {
                let [ahead, behind] = [moved, -moved].map(|way| {
                    alone.interior.places.clone_from(&places);
                    alone.interior.places[node][axis] += way;
                    alone.interior.follow();
                    alone.strain(0.0);
                    alone.strain_energy()
                });
                let expected = (behind - ahead) / (2.0 * moved);
                let off = (force - expected).abs();
                assert!(off < 1e-5 * largest, "{node} {axis}: {force} {expected}");
            }
        }
    }
    differ::<2>(&Shape::disk([0.3, 0.2], 0.42));
    differ::<3>(&Shape::Ball { center: [0.3, 0.2, 0.1], radius: 0.25 });
}

/// A body that has swollen by a hundredth has slower waves than it had, and lanes without a particle have none: rows of
/// six cells leave lanes over on any processor.
#[test]
fn lanes_without_a_particle_have_no_waves() {
    let mut cube = Alone::<3>::new(&Shape::Box { min: [0.0; 3], max: [0.5; 3] }, 0.1, |_| Vector::ZERO);
    let rest = cube.signal;
    cube.interior.places.iter_mut().for_each(|place| *place = *place * 1.01);
    cube.strain(0.0);
    let particle = cube.particles.get(0);
    let density = DENSITY;
    let modulus = cube.matter.material.wave_modulus(
        Thickness::Moved,
        (&particle.deformation, particle.deformation.det()),
        &AtRest(&[]),
    );
    let exact = (modulus / density).sqrt() / 1.01;
    assert!(
        exact < 0.9998 * rest && (cube.signal / exact - 1.0).abs() < 1e-12,
        "{} {exact} {rest}",
        cube.signal
    );
}
