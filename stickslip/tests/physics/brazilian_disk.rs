//! A disk pressed between two platens shows the fringes of the Brazilian test: `scenes/brazilian_disk.toml`.
//!
//! Source: Frocht (1948), Photoelasticity, volume 2; two point loads P per thickness at (0, +-R), with r1,
//! r2 the distances from them:
//!
//! ```text
//! sigma_xx = -(2P/pi) (x^2 (R - y)/r1^4 + x^2 (R + y)/r2^4 - 1/(2R))
//! sigma_yy = -(2P/pi) ((R - y)^3/r1^4 + (R + y)^3/r2^4 - 1/(2R))
//! sigma_xy =  (2P/pi) (x (R - y)^2/r1^4 - x (R + y)^2/r2^4)
//! sigma_1 - sigma_2 at the centre 8P/(pi D), on the load axis 8PD/(pi (D^2 - 4y^2)),
//!     on the cross axis (8P/(pi D)) (1 - 4x^2/D^2)/(1 + 4x^2/D^2)^2
//! ```
//! Two flat rigid platens without friction come together by 0.4 % of D in 30 transits and rest for 10, while a PIC
//! share takes the ringing. P is what the contact reports, as a mean over the last 5 transits, as the stress is. What
//! is compared is what a picture shows: the fringe order of the polariscope's map of the stress, pixel by pixel. The
//! patch is Hertz's, of half-width 0.05 R: at the centre an arc of that half-angle differs from a point load by
//! cos(0.05), 0.1 %; nearer to the load than 0.35 R the patch and the grid's own width of contact (a cell or two)
//! count, so the load axis is compared up to |y| = 0.65 R.
//!
//! Expected: 2 % at the centre and 3 % along both axes at 80 cells a diameter; 2 % at 40 and 5 % at 20, everywhere that
//! is compared. Measured at the centre, along the load axis and across: 1.2, 1.2 and 1.2 % at 80 cells, 1.6, 1.6 and
//! 1.6 % at 40; on the lattice at 40 0.6, 0.7 and 1.1 %.

use std::f64::consts::PI;
use std::path::Path;
use stickslip::door::ContactCursor;
use stickslip::polariscope::{ImageWindow, StressMap, stress_maps};
use stickslip::scene::Scene;
use stickslip::{scene, step};

use crate::trial::run_to;

/// Pixels across the picture: odd, so that one is in the middle of the disk.
const PIXELS: usize = 441;
/// Width of the picture over R.
const WIDTH: f64 = 2.2;

/// Errors of the fringe order over the exact one.
#[derive(Debug)]
struct Errors {
    center: f64,
    load_axis: f64,
    cross_axis: f64,
    /// Root mean square over the disk, further than 0.35 R from the loads, over the order at the centre.
    all: f64,
}

fn brazilian(cells: usize, particles: &str) -> Scene {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/brazilian_disk.toml"));
    let overrides = [("cells_per_diameter", cells.to_string()), ("particles", particles.to_owned())];
    let overrides = overrides.map(|(key, value)| (key.to_owned(), value));
    scene::load(path, &overrides).unwrap_or_else(|error| panic!("{error}")).scene
}

fn pressed(cells: usize, particles: &str) -> Errors {
    let scene = brazilian(cells, particles);
    let number = |name: &str| scene.parameters[name].number().unwrap_or_else(|| panic!("{name} is a number"));
    let (radius, transit) = (number("radius"), number("transit"));
    let mut simulation = step::build(&scene).unwrap_or_else(|problem| panic!("{problem:?}"));
    run_to(&mut *simulation, 35.0 * transit, |_| {});
    let mut cursor = ContactCursor::default();
    cursor.read(&*simulation);
    let mut sums: Vec<[f64; 6]> = Vec::new();
    let (mut load, mut looks, mut before) = (0.0, 0.0, simulation.time());
    run_to(&mut *simulation, 40.0 * transit, |s| {
        // Both platens press, so half of the sum of their pushes.
        let pushes: f64 = cursor.read(s).iter().map(|contact| contact.mean.force[1].abs()).sum();
        load += 0.5 * pushes * (s.time() - before);
        before = s.time();
        if s.steps() % 8 == 0 {
            let stress = s.snapshot().stress;
            sums.resize(stress.len(), [0.0; 6]);
            for (sum, s) in sums.iter_mut().zip(stress) {
                (0..6).for_each(|k| sum[k] += s[k]);
            }
            looks += 1.0;
        }
    });
    let load = load / (5.0 * transit);
    // In units of R and of P/R.
    let mut mean = simulation.snapshot();
    mean.stress = sums.iter().map(|sum| sum.map(|s| s * radius / (looks * load))).collect();
    mean.position.iter_mut().for_each(|x| *x = x.map(|x| x / radius));
    mean.volume.iter_mut().for_each(|volume| *volume /= radius * radius);
    let edge = 0.5 * WIDTH;
    let window = ImageWindow::around([[-edge; 2], [edge; 2]], PIXELS);
    let maps = stress_maps(&mean, &window);
    let map = maps.iter().find(|map| map.body == 0).expect("the disk is in the picture");
    let picture = Picture { map, window };
    let errors = Errors {
        center: picture.error([0.0; 2]),
        load_axis: picture.worst(|t| [0.0, t]),
        cross_axis: picture.worst(|t| [t, 0.0]),
        all: picture.everywhere(),
    };
    println!("{cells} cells, {particles}: load {load:.5}, errors {errors:.4?}");
    errors
}

/// The stress on the pixels of a picture of the unit disk under unit load.
struct Picture<'a> {
    map: &'a StressMap,
    window: ImageWindow,
}

impl Picture<'_> {
    /// Relative error of the order at the pixel of a place.
    fn error(&self, place: [f64; 2]) -> f64 {
        let [column, row] = self.window.pixel(place).map(|pixel| pixel as usize);
        let ray = self.map.ray(column, row).expect("a pixel of the disk");
        ray.principal_difference() / difference(exact(self.window.position(column, row))) - 1.0
    }

    /// The largest error, with its sign, on an axis out to 0.65 R.
    fn worst(&self, axis: impl Fn(f64) -> [f64; 2]) -> f64 {
        let errors = (-65..=65).map(|t| self.error(axis(0.01 * f64::from(t))));
        errors.fold(0.0_f64, |worst, error| if error.abs() > worst.abs() { error } else { worst })
    }

    /// Root mean square of the error over the order at the centre.
    fn everywhere(&self) -> f64 {
        let (mut squares, mut count) = (0.0, 0.0);
        for (column, row) in (0..PIXELS).flat_map(|row| (0..PIXELS).map(move |column| (column, row))) {
            let [x, y] = self.window.position(column, row);
            if x.hypot(y) < 0.95 && x.hypot(1.0 - y.abs()) > 0.35 {
                let found = self.map.ray(column, row).expect("a pixel of the disk").principal_difference();
                squares += (found - difference(exact([x, y]))).powi(2);
                count += 1.0;
            }
        }
        f64::sqrt(squares / count) / difference(exact([0.0; 2]))
    }
}

/// Stress of the unit disk under the unit load: xx, yy, xy.
fn exact([x, y]: [f64; 2]) -> [f64; 3] {
    let (a, b) = (1.0 - y, 1.0 + y);
    let (r, s) = ((x * x + a * a).powi(2), (x * x + b * b).powi(2));
    [
        -(2.0 / PI) * (x * x * a / r + x * x * b / s - 0.5),
        -(2.0 / PI) * (a.powi(3) / r + b.powi(3) / s - 0.5),
        (2.0 / PI) * (x * a * a / r - x * b * b / s),
    ]
}

fn difference([xx, yy, xy]: [f64; 3]) -> f64 {
    (xx - yy).hypot(2.0 * xy)
}

#[test]
fn the_exact_stress_has_the_textbooks_values_on_the_axes() {
    for t in [0.0, 0.3, 0.8] {
        let load = 4.0 / (PI * (1.0 - t * t));
        let cross = 4.0 / PI * (1.0 - t * t) / (1.0 + t * t).powi(2);
        assert!((difference(exact([0.0, t])) / load - 1.0).abs() < 1e-12);
        assert!((difference(exact([t, 0.0])) / cross - 1.0).abs() < 1e-12);
    }
}

/// Errors of everything that is compared, the largest.
fn largest(errors: &Errors) -> f64 {
    [errors.center, errors.load_axis, errors.cross_axis, errors.all]
        .map(f64::abs)
        .into_iter()
        .fold(0.0, f64::max)
}

#[test]
fn at_20_cells() {
    for particles in ["fitted", "lattice"] {
        let errors = pressed(20, particles);
        assert!(largest(&errors) < 0.05, "{particles}: {errors:?}");
    }
}

#[test]
#[ignore = "slow: half a minute at 40 cells"]
fn at_40_cells() {
    for particles in ["fitted", "lattice"] {
        let errors = pressed(40, particles);
        assert!(largest(&errors) < 0.02, "{particles}: {errors:?}");
    }
}

#[test]
#[ignore = "slow: a minute at 80 cells"]
fn at_80_cells() {
    for particles in ["fitted", "lattice"] {
        let errors = pressed(80, particles);
        assert!(errors.center.abs() < 0.02, "{particles}: {errors:?}");
        assert!(errors.load_axis.abs() < 0.03 && errors.cross_axis.abs() < 0.03, "{particles}: {errors:?}");
    }
}
