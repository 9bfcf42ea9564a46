//! The polariscope against known fields of stress.

use super::*;
use crate::scene::{Light, Sensitivity};
use std::f64::consts::PI;

/// Stress for one fringe in these tests [Pa].
const FRINGE: f64 = 1e6;

fn polariscope(light: Light) -> Polariscope {
    Polariscope {
        sensitivity: Sensitivity::StressPerFringe(FRINGE),
        wavelength: Polariscope::MERCURY_GREEN,
        field: PolariscopeField::Dark,
        light,
        polarizer: None,
    }
}

/// Particles on a square lattice of side `h` where `inside` holds, with a field of stress xx, yy, xy.
fn lattice(
    h: f64,
    inside: impl Fn([f64; 2]) -> bool,
    stress: impl Fn([f64; 2]) -> [f64; 3],
) -> ParticleSnapshot {
    let mut particles = ParticleSnapshot { dimension: 2, ..ParticleSnapshot::default() };
    let reach = (2.0 / h) as i64;
    for (row, column) in (-reach..reach).flat_map(|row| (-reach..reach).map(move |column| (row, column))) {
        let x = [(column as f64 + 0.5) * h, (row as f64 + 0.5) * h];
        if inside(x) {
            let [xx, yy, xy] = stress(x);
            particles.number.push(particles.body.len() as u32);
            particles.body.push(0);
            particles.position.push([x[0], x[1], 0.0]);
            particles.velocity.push([0.0; 3]);
            particles.mass.push(h * h);
            particles.volume.push(h * h);
            particles.stress.push([xx, yy, 0.0, xy, 0.0, 0.0]);
            particles.deformation.push([1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        }
    }
    particles
}

fn in_disk([x, y]: [f64; 2]) -> bool {
    x.hypot(y) < 1.0
}

/// Disk of radius 1 pressed at its top and bottom (Timoshenko and Goodier, Theory of Elasticity, section 41), such that
/// the order at the centre is `order`:
///
/// ```text
/// xx = -k ((R - y) x^2 / r1^4 + (R + y) x^2 / r2^4 - 1/D),   k = 2 P / (pi t)
/// yy = -k ((R - y)^3 / r1^4 + (R + y)^3 / r2^4 - 1/D)
/// xy =  k ((R - y)^2 x / r1^4 - (R + y)^2 x / r2^4)
/// ```
fn brazilian(order: f64) -> impl Fn([f64; 2]) -> [f64; 3] {
    let k = 0.5 * order * FRINGE; // sigma_1 - sigma_2 = 8 P / (pi D t) = 4 k / D at the centre
    move |[x, y]| {
        let (above, below) = (1.0 - y, 1.0 + y);
        let (r1, r2) = ((x * x + above * above).powi(2), (x * x + below * below).powi(2));
        [
            -k * (above * x * x / r1 + below * x * x / r2 - 0.5),
            -k * (above.powi(3) / r1 + below.powi(3) / r2 - 0.5),
            k * (above * above * x / r1 - below * below * x / r2),
        ]
    }
}

fn window(size: usize) -> ImageWindow {
    ImageWindow::around([[-1.1, -1.1], [1.1, 1.1]], size)
}

fn stage(size: usize) -> Stage {
    Stage { window: window(size), specimens: vec![0] }
}

/// The order that the image has at a place.
fn order_at(map: &StressMap, window: &ImageWindow, x: [f64; 2]) -> f64 {
    let [column, row] = window.pixel(x).map(|pixel| pixel as usize);
    Optics::new(&polariscope(Light::Grey)).order(map.ray(column, row).unwrap())
}

/// benchmarks of the Brazilian disk at 80 cells across, one particle a cell: on the load axis
/// `8 P D / (pi t (D^2 - 4 y^2))`, on the cross axis `(8 P / (pi D t)) (1 - 4 x^2/D^2) / (1 + 4 x^2/D^2)^2`. The
/// tolerance is the curvature of the field over the reach of the kernel, which grows towards the loads.
#[test]
fn a_disk_under_two_forces_has_the_textbooks_orders() {
    let particles = lattice(2.0 / 80.0, in_disk, brazilian(6.0));
    // An odd size has a pixel in the middle of the disk.
    let window = window(881);
    let [map] = &stress_maps(&particles, &window)[..] else { panic!("one body") };
    let center = order_at(map, &window, [0.0, 0.0]);
    assert!((center / 6.0 - 1.0).abs() < 0.003, "{center}");
    for step in -10..=10 {
        // A pixel is sampled in its middle, up to half a pixel from the place.
        let z = (0.08 * f64::from(step) * window.scale()).round() / window.scale();
        let (along, across) = (order_at(map, &window, [0.0, z]), order_at(map, &window, [z, 0.0]));
        let exact = 6.0 / (1.0 - z * z);
        assert!((along / exact - 1.0).abs() < 0.02, "y = {z}: {along} {exact}");
        let exact = 6.0 * (1.0 - z * z) / (1.0 + z * z).powi(2);
        assert!((across / exact - 1.0).abs() < 0.02, "x = {z}: {across} {exact}");
    }
}

#[test]
fn linear_stress_is_met_exactly_up_to_the_surface() {
    let linear = |[x, y]: [f64; 2]| [1e6 * (2.0 + x - 0.5 * y), 2e5 * y, 3e5 * x];
    let particles = lattice(0.05, |[x, y]| x.abs() < 0.6 && y.abs() < 0.4, linear);
    let window = window(301);
    let [map] = &stress_maps(&particles, &window)[..] else { panic!("one body") };
    for (place, tolerance) in [([0.013, 0.0], 1e-3), ([0.58, 0.1], 2e-2), ([0.56, 0.36], 2e-2)] {
        let [column, row] = window.pixel(place).map(|pixel| pixel as usize);
        let (found, exact) = (map.ray(column, row).unwrap().stress, linear(window.position(column, row)));
        for i in 0..3 {
            assert!((found[i] - exact[i]).abs() < tolerance * 1e6, "{place:?} {found:?} {exact:?}");
        }
    }
}

#[test]
fn coverage_finds_the_surface_and_the_area() {
    let particles = lattice(2.0 / 40.0, in_disk, |_| [0.0; 3]);
    let window = window(440);
    let [map] = &stress_maps(&particles, &window)[..] else { panic!("one body") };
    let area: f64 = map.rays.iter().map(|ray| ray.coverage).sum::<f64>() / window.scale().powi(2);
    assert!((area / PI - 1.0).abs() < 0.02, "{area}");
    // Not a step of the lattice is seen: the rim is where it is to a quarter of a particle.
    for i in 0..72 {
        let (sin, cos) = (f64::from(i) * PI / 36.0).sin_cos();
        for (radius, covered) in [(1.0 - 0.0175, 1.0), (1.0 + 0.0175, 0.0)] {
            let [column, row] = window.pixel([radius * cos, radius * sin]).map(|pixel| pixel as usize);
            let coverage = map.ray(column, row).unwrap().coverage;
            assert!((coverage - covered).abs() < 0.01, "{i} {radius} {coverage}");
        }
    }
}

/// Pixels six particles wide: the body is where it is, and nothing beside it.
#[test]
fn a_small_picture_of_many_particles_has_all_its_light() {
    let particles = lattice(0.01, in_disk, |_| [0.5 * FRINGE, 0.0, 0.0]);
    let window = ImageWindow { low: [-1.2; 2], high: [1.2; 2], size: [40; 2] };
    let bench = OpticalBench::new(&polariscope(Light::Grey), Stage { window, specimens: vec![0] });
    let light = bench.light(&particles);
    let background = BACKGROUND[0];
    for (pixel, light) in light.iter().enumerate() {
        let [x, y] = window.position(pixel % 40, pixel / 40);
        // Beyond a pixel's diagonal and the reach.
        let beside = x.hypot(y) - 1.0;
        if beside > 0.12 {
            assert_eq!(*light, background, "({x}, {y})");
        } else if beside < -0.12 {
            assert!((light[0] - 1.0).abs() < 1e-9, "half an order is bright: {light:?} at ({x}, {y})");
        }
        assert!(light.iter().all(|light| light.is_finite()), "({x}, {y})");
    }
    let [map] = &stress_maps(&particles, &window)[..] else { panic!("one body") };
    let covered: f64 = map.rays.iter().map(|ray| ray.coverage).sum::<f64>() / window.scale().powi(2);
    assert!((covered / PI - 1.0).abs() < 0.01, "{covered}");
}

#[test]
fn uniform_stress_gives_uniform_light() {
    for (order, dark) in [(0.0, 0.0), (0.25, 0.5), (0.5, 1.0), (1.0, 0.0), (2.5, 1.0)] {
        let particles = lattice(0.05, in_disk, |_| [order * FRINGE, 0.0, 0.0]);
        let turned = lattice(0.05, in_disk, |_| [3e5, 3e5, 0.5 * order * FRINGE]);
        for (particles, field) in [
            (&particles, PolariscopeField::Dark),
            (&particles, PolariscopeField::Light),
            (&turned, PolariscopeField::Dark),
        ] {
            let bench = OpticalBench::new(&Polariscope { field, ..polariscope(Light::Grey) }, stage(101));
            let light = bench.light(particles);
            let exact = if field == PolariscopeField::Dark { dark } else { 1.0 - dark };
            for (column, row) in [(50, 50), (30, 60), (75, 41), (50, 9)] {
                let rgb = light[row * 101 + column];
                assert!(rgb.iter().all(|light| (light - exact).abs() < 1e-6), "{order} {field:?} {rgb:?}");
            }
        }
    }
}

#[test]
fn a_plane_polariscope_darkens_where_stress_lies_along_the_polariser() {
    let particles = lattice(0.05, in_disk, |_| [0.0, 0.5 * FRINGE, 0.0]);
    for (degrees, exact) in [(0.0, 0.0), (90.0, 0.0), (45.0, 1.0), (22.5, 0.5)] {
        let polarizer = Some(f64::to_radians(degrees));
        let bench = OpticalBench::new(&Polariscope { polarizer, ..polariscope(Light::Grey) }, stage(51));
        let light = bench.light(&particles)[25 * 51 + 25][0];
        assert!((light - exact).abs() < 1e-6, "{degrees}: {light}");
    }
}

/// The isochromatic colours of textbooks: black, grey, white, yellow, red, the tint of passage at a retardation of
/// about 560 nm, blue, green, yellow, red.
#[test]
fn white_light_gives_the_textbooks_colors() {
    let optics = Optics::new(&polariscope(Light::White));
    let color = |retardation: f64| {
        let order = retardation / 546.1;
        optics.light(&Phase { order, ..Phase::default() })
    };
    assert!(color(0.0).iter().all(|light| light.abs() < 1e-9));
    let [red, green, blue] = color(100.0);
    assert!(red < 0.45 && (red - green).abs() < 0.1 && blue > green, "grey {red} {green} {blue}");
    let [red, green, blue] = color(250.0);
    assert!(red > 0.8 && green > 0.8 && blue > 0.7, "white {red} {green} {blue}");
    let [red, green, blue] = color(400.0);
    assert!(red > 0.8 && green > 0.5 && blue < 0.1, "yellow {red} {green} {blue}");
    let [red, green, blue] = color(490.0);
    assert!(red > 2.0 * green && red > 2.0 * blue, "red {red} {green} {blue}");
    let [red, green, blue] = color(565.0);
    assert!(green < 0.1 && red > green && blue > green, "tint of passage {red} {green} {blue}");
    let [red, green, blue] = color(640.0);
    assert!(blue > 2.0 * red && blue > 2.0 * green, "blue {red} {green} {blue}");
    let [red, green, blue] = color(780.0);
    assert!(green > 1.5 * red && green > 1.2 * blue, "green {red} {green} {blue}");
    let [red, green, blue] = color(1020.0);
    assert!(red > 1.5 * green && red > blue, "red of the second order {red} {green} {blue}");
    let spread = |[red, green, blue]: LinearRgb| red.max(green).max(blue) - red.min(green).min(blue);
    assert!(spread(color(9000.0)) < 0.15, "white of high order");
}

#[test]
fn an_open_shutter_averages_light() {
    let bench = OpticalBench::new(&polariscope(Light::Grey), stage(51));
    let mut film = bench.film();
    let mut sum = 0.0;
    for order in [0.0, 0.125, 0.25, 0.375] {
        let particles = lattice(0.05, in_disk, |_| [order * FRINGE, 0.0, 0.0]);
        bench.expose(&particles, &mut film);
        sum += (PI * order).sin().powi(2);
    }
    assert_eq!(film.exposures(), 4);
    assert_eq!(film.develop().color(25, 25)[0], color::srgb_byte(0.25 * sum));
}

#[test]
fn fringes_finer_than_pixels_are_grey() {
    let steep = |[x, _]: [f64; 2]| [200.0 * (x + 2.0) * FRINGE, 0.0, 0.0];
    let particles = lattice(0.02, in_disk, steep);
    let light = OpticalBench::new(&polariscope(Light::Grey), stage(60)).light(&particles);
    let row = &light[30 * 60 + 20..30 * 60 + 40];
    assert!(row.iter().all(|rgb| (rgb[0] - 0.5).abs() < 0.1), "{row:?}");
}

/// A plate of two units of thickness with stress that varies through it has the order of the mean;
/// a hole beside it stays open.
#[test]
fn light_sums_stress_through_a_plate() {
    let sheet = lattice(0.1, |[x, y]| x.abs() < 0.5 && y.abs() < 0.5, |_| [0.0; 3]);
    let mut plate = ParticleSnapshot { dimension: 3, ..ParticleSnapshot::default() };
    for layer in 0..20 {
        let z = 0.1 * (f64::from(layer) + 0.5);
        for x in &sheet.position {
            plate.body.push(0);
            plate.position.push([x[0], x[1], z]);
            plate.mass.push(1e-3);
            plate.volume.push(1e-3);
            plate.stress.push([z * FRINGE, 0.0, 5e6, 0.0, 0.0, 0.0]);
        }
    }
    let window = window(101);
    let [map] = &stress_maps(&plate, &window)[..] else { panic!("one body") };
    let ray = map.ray(50, 50).unwrap();
    assert!((ray.path - 2.0).abs() < 1e-9 && (ray.coverage - 1.0).abs() < 1e-9, "{ray:?}");
    let mean = Optics::new(&polariscope(Light::Grey)).order(ray);
    assert!((mean - 1.0).abs() < 1e-9, "{mean}");
    let sensitivity = Sensitivity::StressThicknessPerFringe(FRINGE);
    let sum = Optics::new(&Polariscope { sensitivity, ..polariscope(Light::Grey) }).order(ray);
    assert!((sum - 2.0).abs() < 1e-9, "{sum}");
}

#[test]
fn force_chains_meet_where_bodies_touch() {
    let mut particles = lattice(0.1, |[x, y]| (x + 1.0).hypot(y) < 0.95, |_| [0.0; 3]);
    let other = lattice(0.1, |[x, y]| (x - 0.9).hypot(y) < 0.95, |_| [0.0; 3]);
    particles.body.extend(vec![1; other.body.len()]);
    particles.position.extend(&other.position);
    particles.mass.extend(&other.mass);
    particles.volume.extend(&other.volume);
    particles.stress.extend(&other.stress);
    let push = Push { bodies: [0, 1], force: 7.0 };
    let both = links(&particles, &[push], &[0, 1]);
    assert_eq!(both.len(), 2);
    for (link, x) in both.iter().zip([-1.0, 0.9]) {
        assert!((link.center[0] - x).abs() < 0.02 && link.center[1].abs() < 1e-9, "{link:?}");
        assert!((link.contact[0] + 0.05).abs() < 0.05 && link.contact[1].abs() < 1e-9, "{link:?}");
        assert_eq!(link.force, 7.0);
    }
    assert_eq!(links(&particles, &[push], &[1]).len(), 1);
    assert!(links(&particles, &[Push { force: -1.0, ..push }], &[0, 1]).is_empty());

    let window = ImageWindow::around([[-2.0, -1.0], [2.0, 1.0]], 200);
    let mut image = Image::new(window.size, [0; 3]);
    draw_links(&mut image, &window, (&both, 7.0));
    assert!(image.color(90, 50)[0] > 150 && image.color(110, 50)[0] > 150);
    assert_eq!(image.color(90, 60), [0; 3]);
}

/// The disk under two forces and the sequence of colours, to be looked at:
/// in the folder that STICKSLIP_TEST_PICTURES names.
#[test]
fn every_light_and_field_has_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let keep = std::env::var_os("STICKSLIP_TEST_PICTURES").map(std::path::PathBuf::from);
    let folder = keep.as_deref().unwrap_or(folder.path());
    let disk = lattice(2.0 / 80.0, in_disk, brazilian(4.0));
    let wedge = lattice(0.02, |[_, y]| y.abs() < 0.3, |[x, _]| [1.5 * (x + 1.1).max(0.0) * FRINGE, 0.0, 0.0]);
    let circular = polariscope(Light::Grey);
    let plane = Polariscope { polarizer: Some(0.3), ..circular };
    for (name, polariscope) in [
        ("grey", circular),
        ("light_field", Polariscope { field: PolariscopeField::Light, ..circular }),
        ("monochrome", polariscope(Light::Monochrome)),
        ("white", polariscope(Light::White)),
        ("plane", plane),
    ] {
        let bench = OpticalBench::new(&polariscope, stage(400));
        let images = [&disk, &wedge].map(|particles| bench.photograph(particles));
        assert_ne!(images[0], images[1]);
        for (what, image) in ["disk", "wedge"].iter().zip(images) {
            let path = folder.join(format!("{what}_{name}.png"));
            image.write_png(&mut std::fs::File::create(path).unwrap()).unwrap();
        }
    }
}
