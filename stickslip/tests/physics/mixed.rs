//! A body on a grid of its own meets one on the common grid.
//!
//! Source: what two bodies owe whatever grids they are on: momentum to round-off, Coulomb's law, a rigid body on a
//! slope. Set-up: scenes of one body of each kind. Expected: as each claim says; energy within what the common grid
//! itself loses or gains.

use crate::trial::{RUBBER, run_to, same_bits, start};
use stickslip::door::Simulation;

/// A scene in the plane, of rubber (wave speed 36.7 m/s) and of a plastic that yields at 10 kPa.
fn scene(cell: f64, rest: &str) -> String {
    let clay = "materials.clay = { density = 1500, von_mises = { young_modulus = 1e6, poisson_ratio = 0.3, \
                yield_stress = 1e4 } }";
    format!(
        "space = {{ dimension = 'plane-strain', cell = {cell}, interior = 'grid' }}\ntime.end = 1\n{RUBBER}\n{clay}\n{rest}"
    )
}

/// Young's modulus 1 MPa, Poisson's ratio 0.3, 1000 kg/m^3: M = E (1 - nu) / ((1 + nu) (1 - 2 nu)).
const WAVE: f64 = 36.689_968_6;

fn body(name: &str, shape: &str, more: &str) -> String {
    format!("[[bodies]]\nname = '{name}'\nmaterial = 'rubber'\nshape.{shape}\n{more}\n")
}

fn disk(name: &str, [x, y]: [f64; 2], speed: f64, interior: &str) -> String {
    let shape = format!("ball = {{ center = [{x}, {y}], radius = 1 }}");
    body(name, &shape, &format!("velocity = [{speed}, 0]\ninterior = '{interior}'"))
}

fn energy(simulation: &dyn Simulation) -> f64 {
    simulation.bodies().iter().map(|body| body.kinetic + body.strain).sum()
}

fn momentum(simulation: &dyn Simulation) -> [f64; 2] {
    [0, 1].map(|k| simulation.bodies().iter().map(|body| body.mass * body.velocity[k]).sum())
}

/// Two disks meet head on at 4 % of the wave speed and part. By nodes of the common grid they lose 3.6 % at R/8.
#[test]
fn disks_of_both_kinds_keep_momentum_and_energy() {
    let speed = 0.04 * WAVE;
    for (cell, precision, exact, most) in
        [(0.125, "double", 1e-12, 0.03), (0.0625, "double", 1e-12, 0.005), (0.125, "single", 1e-5, 0.03)]
    {
        let bodies =
            disk("own", [-1.2, 0.03], speed, "reference") + &disk("common", [1.2, 0.03], -speed, "grid");
        let text = scene(cell, &bodies)
            .replace("interior = 'grid' }", &format!("precision = '{precision}', interior = 'grid' }}"));
        let mut simulation = start(&text);
        let (before, first) = (energy(&*simulation), momentum(&*simulation));
        run_to(&mut *simulation, 9.5 / WAVE, |_| ());
        let bodies = simulation.bodies();
        assert!(bodies[0].velocity[0] < 0.0 && bodies[1].velocity[0] > 0.0, "they have parted: {bodies:?}");
        let last = momentum(&*simulation);
        let scale = 1000.0 * std::f64::consts::PI * speed;
        assert!(
            (0..2).all(|k| (last[k] - first[k]).abs() < exact * scale),
            "{precision}: {first:?} {last:?}"
        );
        let left = energy(&*simulation) / before;
        println!("{precision}, {cell}: {left}");
        assert!((left - 1.0).abs() < most, "{precision}, {cell}: {left}");
    }
}

/// A floor on the common grid, on a rigid base that holds it, and a block on it, under weight.
fn block_on_floor(gravity: &str, more: &str) -> String {
    let block = format!("interior = 'reference'\n{more}");
    let bodies = body("block", "box = { min = [-1.03, 0], max = [1.07, 1] }", &block)
        + &body("floor", "box = { min = [-3, -1], max = [5, 0] }", "")
        + &body("base", "half_space = { point = [0, -1], normal = [0, 1] }", "rigid = {}");
    let rules = "contact = [{ between = ['floor', 'base'], friction = 10 }, \
                 { between = ['floor', 'block'], friction = 0.3 }, { law = 'none' }]";
    scene(0.25, &bodies).replace("time.end", &format!("gravity = {gravity}\n{rules}\ntime.end"))
}

/// v = v_0 - mu int g dt, of a weight that comes within .3 s: a floor and a block on which it falls hop for long.
#[test]
fn a_block_slides_on_a_floor_of_the_common_grid_by_its_coefficient() {
    let weight = "[0, { table = [[0, 0], [0.3, -1]] }]";
    let mut simulation = start(&block_on_floor(weight, "velocity = [0.6, 0]"));
    run_to(&mut *simulation, 1.0, |_| ());
    let lost = 0.6 - simulation.bodies()[0].velocity[0];
    println!("{lost}");
    assert!((lost / (0.3 * 0.85) - 1.0).abs() < 0.02, "{lost}");
}

/// On a slope of .2 a block of friction .3 stays where it is: it creeps by less than a hundredth of the way that it
/// would slide without friction. On the common grid alone the same.
#[test]
fn a_block_on_a_slope_of_the_common_grid_sticks() {
    let weight = "[{ table = [[0, 0], [0.3, 0.2]] }, { table = [[0, 0], [0.3, -1]] }]";
    let mut simulation = start(&block_on_floor(weight, ""));
    run_to(&mut *simulation, 0.5, |_| ());
    let early = simulation.bodies()[0].position[0];
    run_to(&mut *simulation, 1.0, |_| ());
    let late = simulation.bodies()[0].position[0];
    println!("{}", late - early);
    assert!(
        (late - early).abs() < 0.01 * 0.5 * 0.2 * (0.85_f64.powi(2) - 0.35_f64.powi(2)),
        "{}",
        late - early
    );
}

/// A rubber wheel that spins is thrown on a plastic plate, which is free: momentum and spin are kept, the plate yields,
/// and what is left of the energy with plastic work and friction is what there was.
#[test]
fn a_rubber_wheel_on_a_plastic_plate_keeps_momentum() {
    let wheel = body(
        "wheel",
        "ball = { center = [0, 0.51], radius = 0.5 }",
        "interior = 'reference'\nvelocity = [0, -3]\nspin = -6",
    );
    let plate =
        "[[bodies]]\nname = 'plate'\nmaterial = 'clay'\nshape.box = { min = [-1.5, -0.5], max = [1.5, 0] }\n";
    let mut simulation = start(&scene(0.0625, &format!("{wheel}{plate}[[contact]]\nfriction = 0.5\n")));
    let spin = |simulation: &dyn Simulation| -> f64 {
        simulation.bodies().iter().map(|body| body.angular_momentum[2]).sum()
    };
    let (first, turning, before) = (momentum(&*simulation), spin(&*simulation), energy(&*simulation));
    run_to(&mut *simulation, 0.6, |_| ());
    let (last, ledger) = (momentum(&*simulation), simulation.ledger());
    let bodies = simulation.bodies();
    assert!(bodies[0].velocity[1] > bodies[1].velocity[1], "they part: {bodies:?}");
    assert!(bodies[0].velocity[0] > 0.1, "it drives forth: {bodies:?}");
    let scale = -first[1];
    assert!((0..2).all(|k| (last[k] - first[k]).abs() < 1e-12 * scale), "{first:?} {last:?}");
    let turned = (spin(&*simulation) - turning) / turning.abs();
    let plastic = ledger.plastic;
    let left = (energy(&*simulation) + plastic + ledger.friction) / before;
    println!(
        "spin {turned}, plastic {}, friction {}, energy {left}",
        plastic / before,
        ledger.friction / before
    );
    assert!(turned.abs() < 1e-3, "{turned}");
    assert!(plastic > 0.1 * before, "{plastic}");
    assert!((left - 1.0).abs() < 0.03, "{left}");
}

/// All bits are the same on one, two and five threads, after a state was saved, taken back, and with lists made anew.
#[test]
fn bits_do_not_depend_on_threads_or_resumes() {
    ["plane-strain", "3d"].iter().for_each(|dimension| same_bits(&thrown(dimension), 40, [2, 5]));
}

/// A rubber wheel, or ball, that spins is thrown on a plastic plate.
pub fn thrown(dimension: &str) -> String {
    let wheel = body(
        "wheel",
        "ball = { center = [0, 0.51], radius = 0.5 }",
        "interior = 'reference'\nvelocity = [1, -3]\nspin = -6",
    );
    let plate =
        "[[bodies]]\nname = 'plate'\nmaterial = 'clay'\nshape.box = { min = [-1.5, -0.5], max = [1.5, 0] }\n";
    let plane = scene(0.125, &format!("{wheel}{plate}[[contact]]\nfriction = 0.5\n"));
    if dimension != "3d" {
        return plane;
    }
    [
        ("plane-strain", "3d"),
        ("[0, 0.51]", "[0, 0.51, 0]"),
        ("spin = -6", "spin = [0, 0, -6]"),
        ("[1, -3]", "[1, -3, 0]"),
        ("[-1.5, -0.5]", "[-1.5, -0.5, -0.6]"),
        ("[1.5, 0]", "[1.5, 0, 0.6]"),
    ]
    .iter()
    .fold(plane, |text, (from, to)| text.replace(from, to))
}
