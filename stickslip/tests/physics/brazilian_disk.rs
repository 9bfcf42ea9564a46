//! A disk pressed between two platens shows the stress of the Brazilian test.
//!
//! Source: Frocht (1948), Photoelasticity, volume 2; two point loads P per thickness at (0, +-R), with r1, r2 the distances from them:
//!
//! ```text
//! sigma_xx = -(2P/pi) (x^2 (R - y)/r1^4 + x^2 (R + y)/r2^4 - 1/(2R))
//! sigma_yy = -(2P/pi) ((R - y)^3/r1^4 + (R + y)^3/r2^4 - 1/(2R))
//! sigma_xy =  (2P/pi) (x (R - y)^2/r1^4 - x (R + y)^2/r2^4)
//! centre: sigma_1 - sigma_2 = 8P/(pi D);   load axis 8PD/(pi (D^2 - 4y^2));   cross axis (8P/(pi D)) (1 - 4x^2/D^2)/(1 + 4x^2/D^2)^2
//! ```
//! Set-up: plane stress, half of the disk above a mirror at y = 0, a flat rigid platen without friction on top, which comes down by
//! 0.4 % of R along half a cosine within 30 transits and then rests for 10, while a PIC share takes the ringing. P is what the contact
//! reports, the mean of the last 5 transits, as the stress is. The platen is flat because the patch is then Hertz's, of half-width
//! 0.05 R: at the centre an arc of that half-angle differs from a point load by cos(0.05), 0.1 %; nearer to the load than 0.35 R the
//! patch and the grid's own width of contact (a cell or two) count, so the load axis is compared up to |y| = 0.65 R.
//!
//! Expected: 2 % at the centre and 3 % along both axes at 80 cells a diameter, 3 % everywhere at 40 (slow). Measured at 40: 2.4 % at
//! the centre, 2.5 % and 2.2 % along the axes; on the lattice 1.6 %, 7.1 % and 1.6 %. The root mean square of the error over the disk is smaller with fitted particles than on the lattice (at 40 cells 1.7 % and 3.2 %).

use crate::trial::{run_to, start};
use std::f64::consts::PI;

const RADIUS: f64 = 1.0;
/// Longitudinal transit of a disk: E = rho = 1, nu = 0.3.
const TRANSIT: f64 = 2.0 * RADIUS / 1.16;

/// Errors of sigma_1 - sigma_2 over the exact one at the centre.
#[derive(Debug)]
struct Errors {
    center: f64,
    load_axis: f64,
    cross_axis: f64,
    /// Root mean square over the disk, further than 0.35 R from the loads.
    all: f64,
}

fn pressed(cells: usize, particles: &str) -> Errors {
    let cell = 2.0 * RADIUS / cells as f64;
    let ramp = 30.0 * TRANSIT;
    let top = RADIUS + 6.0 * cell;
    let scene = format!(
        r#"
        [space]
        dimension = "plane-stress"
        cell = {cell}
        domain = {{ min = [{left}, 0], max = [{right}, {top}], y_min = "symmetry" }}
        [time]
        end = {end}
        pic_share = 0.005
        [materials]
        glass = {{ density = 1, hypoelastic = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}
        [[bodies]]
        name = "disk"
        material = "glass"
        shape.intersection = [
            {{ ball = {{ center = [0, 0], radius = {RADIUS} }} }},
            {{ half_space = {{ point = [0, 0], normal = [0, -1] }} }},
        ]
        particles = "{particles}"
        [[bodies]]
        name = "platen"
        material = "glass"
        shape.box = {{ min = [-0.5, {RADIUS}], max = [0.5, {thick}] }}
        particles = "fitted"
        rigid = {{ velocity = [0, "if(t < {ramp}, -{speed} * sin(pi * t / {ramp}), 0)"] }}
        "#,
        left = -1.2 * RADIUS,
        right = 1.2 * RADIUS,
        thick = RADIUS + 4.0 * cell,
        end = 40.0 * TRANSIT,
        speed = 0.004 * RADIUS * PI / (2.0 * ramp),
    );
    let mut simulation = start(&scene);
    run_to(&mut *simulation, 35.0 * TRANSIT, |_| {});
    simulation.take_contacts();
    let mut sums: Vec<[f64; 3]> = Vec::new();
    let (mut load, mut looks, mut before) = (0.0, 0.0, simulation.time());
    run_to(&mut *simulation, 40.0 * TRANSIT, |s| {
        load +=
            s.take_contacts().iter().map(|contact| contact.force[1].abs()).sum::<f64>() * (s.time() - before);
        before = s.time();
        if s.steps() % 8 == 0 {
            let stress = s.snapshot().stress;
            sums.resize(stress.len(), [0.0; 3]);
            for (sum, s) in sums.iter_mut().zip(stress) {
                (0..3).for_each(|k| sum[k] += s[[0, 1, 3][k]]);
            }
            looks += 1.0;
        }
    });
    let load = load / (5.0 * TRANSIT);
    let snapshot = simulation.snapshot();
    let disk = || (0..sums.len()).filter(|&p| snapshot.body[p] == 0);
    let found = |p: usize| sums[p].map(|sum| sum / (looks * load));
    let place = |p: usize| [snapshot.position[p][0], snapshot.position[p][1]];
    let compare = |takes: &dyn Fn([f64; 2]) -> bool| {
        // The tensors are averaged before their difference is taken: noise of a difference does not average out.
        let mut mean = [[0.0; 3]; 2];
        for p in disk().filter(|&p| takes(place(p))) {
            (0..3).for_each(|k| {
                mean[0][k] += found(p)[k];
                mean[1][k] += exact(place(p))[k];
            });
        }
        difference(mean[0]) / difference(mean[1]) - 1.0
    };
    let along = |axis: usize| {
        let width = 2.0 * cell;
        let bins = (0.65 * RADIUS / width) as usize;
        let bin = |i: usize| {
            let low = i as f64 * width;
            compare(&|x| x[1 - axis].abs() < cell && (low..low + width).contains(&x[axis].abs()))
        };
        (0..bins).map(bin).fold(0.0_f64, |worst, error| if error.abs() > worst.abs() { error } else { worst })
    };
    let inner: Vec<usize> =
        disk().filter(|&p| place(p)[0].hypot(RADIUS - place(p)[1]) > 0.35 * RADIUS).collect();
    let squares =
        inner.iter().map(|&p| (difference(found(p)) - difference(exact(place(p)))).powi(2)).sum::<f64>();
    let errors = Errors {
        center: compare(&|x| x[0].hypot(x[1]) < 1.5 * cell),
        load_axis: along(1),
        cross_axis: along(0),
        all: (squares / inner.len() as f64).sqrt() / difference(exact([0.0; 2])),
    };
    println!("{cells} cells, {particles}: load {load:.5}, errors {errors:.4?}");
    errors
}

/// Stress of the unit load: xx, yy, xy.
fn exact([x, y]: [f64; 2]) -> [f64; 3] {
    let (a, b) = (RADIUS - y, RADIUS + y);
    let (r, s) = ((x * x + a * a).powi(2), (x * x + b * b).powi(2));
    let uniform = 0.5 / RADIUS;
    [
        -(2.0 / PI) * (x * x * a / r + x * x * b / s - uniform),
        -(2.0 / PI) * (a.powi(3) / r + b.powi(3) / s - uniform),
        (2.0 / PI) * (x * a * a / r - x * b * b / s),
    ]
}

fn difference([xx, yy, xy]: [f64; 3]) -> f64 {
    (xx - yy).hypot(2.0 * xy)
}

#[test]
fn the_exact_stress_has_the_textbooks_values_on_the_axes() {
    let d = 2.0 * RADIUS;
    for t in [0.0, 0.3, 0.8] {
        let load = 8.0 * d / (PI * (d * d - 4.0 * t * t));
        let cross = 8.0 / (PI * d) * (1.0 - 4.0 * t * t / (d * d)) / (1.0 + 4.0 * t * t / (d * d)).powi(2);
        assert!((difference(exact([0.0, t])) / load - 1.0).abs() < 1e-12);
        assert!((difference(exact([t, 0.0])) / cross - 1.0).abs() < 1e-12);
    }
}

#[test]
fn at_20_cells_fitted_particles_are_smoother_than_the_lattice() {
    let [fitted, lattice] = ["fitted", "lattice"].map(|particles| pressed(20, particles));
    assert!(fitted.center.abs() < 0.1, "{fitted:?}");
    assert!(fitted.all < lattice.all, "{fitted:?} {lattice:?}");
}

#[test]
#[ignore = "slow: half a minute at 40 cells"]
fn at_40_cells() {
    let [fitted, lattice] = ["fitted", "lattice"].map(|particles| pressed(40, particles));
    for error in [fitted.center, fitted.load_axis, fitted.cross_axis] {
        assert!(error.abs() < 0.03, "{fitted:?}");
    }
    assert!(fitted.all < lattice.all, "{fitted:?} {lattice:?}");
}

#[test]
#[ignore = "slow: minutes at 80 cells"]
fn at_80_cells() {
    let fitted = pressed(80, "fitted");
    assert!(fitted.center.abs() < 0.02, "{fitted:?}");
    assert!(fitted.load_axis.abs() < 0.03 && fitted.cross_axis.abs() < 0.03, "{fitted:?}");
}
