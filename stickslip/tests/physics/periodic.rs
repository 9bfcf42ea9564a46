//! Periodic faces: what leaves through one comes in through the other.
//!
//! Source: identity, waves in an unbounded medium, and Coulomb's law.
//!
//! | set-up | expected |
//! |---|---|
//! | bodies that collide while they move through the faces, once or several times, against the same without faces | the same particles, energies and contact forces to round-off of the steps, 1e-9 of sizes and speeds |
//! | free rigid bodies that collide through the faces, likewise | the same to 1e-8, as far as contact is solved |
//! | 120 free rigid disks that flow down a slope | overlap below 0.03 of a diameter, images counted; momentum by what gravity and the floor give to 1e-12 |
//! | a medium that fills the domain, moving through it as one | no stress at all |
//! | the same with a standing wave, sheared or compressed, of one period's length | its period L/c within 1 % (0.5 and 0.1 %) |
//! | a layer without end that slides down a slope | what gravity and friction give it, within 1e-3 (3e-4); its stress everywhere alike |
//!
//! A wave of 32 cells is slower by (k h)^2 / 24 = 0.16 % on the nodes, and by what the transfer smooths: of a sheared
//! one less, for particles carry rotation.

use crate::trial::{RUBBER, STRESS_UPDATES, largest_difference, norm, run_to, start, take_steps};
use std::f64::consts::TAU;
use stickslip::door::{ContactCursor, ParticleSnapshot, Simulation};

/// Bodies in a tube along x that is 2.4 m long, or endless.
struct Tube<'a> {
    dimension: &'a str,
    space: &'a str,
    time: &'a str,
    contact: &'a str,
    bodies: &'a str,
    /// Whether the tube has its period.
    periodic: bool,
}

impl Tube<'_> {
    fn start(&self) -> Box<dyn Simulation> {
        let (ends, faces) = match self.periodic {
            true => (["0", "2.4"], ", x_min = \"periodic\", x_max = \"periodic\""),
            false => (["-16", "16"], ""),
        };
        let corner = |x: &str, y: &str| match self.dimension {
            "3d" => format!("[{x}, {y}, {y}]"),
            _ => format!("[{x}, {y}]"),
        };
        start(&format!(
            r#"
            [space]
            dimension = "{}"
            interior = "grid"
            cell = 0.1
            domain = {{ min = {}, max = {}{faces} }}
            {}
            [time]
            end = 1
            {}
            [materials]
            rubber = {{ density = 1000, neo_hookean = {{ young_modulus = 1e5, poisson_ratio = 0.3 }} }}
            metal = {{ density = 2000, von_mises = {{ young_modulus = 3e5, poisson_ratio = 0.2, yield_stress = 2e3 }} }}
            [[contact]]
            friction = 0.3
            {}
            {}
            "#,
            self.dimension,
            corner(ends[0], "-1.2"),
            corner(ends[1], "1.2"),
            self.space,
            self.time,
            self.contact,
            self.bodies
        ))
    }
}

fn body(name: &str, shape: &str, motion: &str) -> String {
    format!("[[bodies]]\nname = \"{name}\"\nmaterial = \"rubber\"\nshape.{shape}\n{motion}\n")
}

/// Takes steps in the tube with its period and without, and compares the two.
fn compare(name: &str, tube: &Tube, steps: usize) {
    let mut simulations = [true, false].map(|periodic| Tube { periodic, ..*tube }.start());
    simulations.iter_mut().for_each(|simulation| take_steps(&mut **simulation, steps));
    let [with, without] = &simulations;
    let [a, b] = [with, without].map(|simulation| simulation.snapshot());
    let furthest = a.position.iter().map(|x| x[0]).fold(0.0, f64::max);
    assert!(furthest > 2.5, "{name}: nothing moves through the face: {furthest}");
    // A floor without bounds has particles only around others; where it is as a whole is compared.
    let of_first = |snapshot: &ParticleSnapshot| snapshot.body.iter().filter(|&&body| body == 0).count();
    assert_eq!(of_first(&a), of_first(&b), "{name}");
    let first = 0..of_first(&a);
    let centers = [with, without]
        .map(|simulation| simulation.bodies().iter().map(|body| body.position).collect::<Vec<_>>());
    let position = largest_difference(&a.position[first.clone()], &b.position[first.clone()])
        .max(largest_difference(&centers[0], &centers[1]));
    let velocity = largest_difference(&a.velocity[first.clone()], &b.velocity[first.clone()]);
    let stress = largest_difference(&a.stress[first.clone()], &b.stress[first]);
    let [x, y] = [with, without].map(|simulation| simulation.ledger());
    let energy = (x.total - y.total).abs() / y.kinetic;
    let momentum = norm([0, 1, 2].map(|i| x.momentum[i] - y.momentum[i])) / norm(y.momentum);
    let [f, g] = [with, without].map(|simulation| ContactCursor::default().read(&**simulation));
    assert_eq!(f.len(), g.len(), "{name}");
    let forces: [Vec<_>; 2] = [&f, &g].map(|all| all.iter().map(|contact| contact.mean.force).collect());
    let force = largest_difference(&forces[0], &forces[1]);
    let most = forces[1].iter().map(|&force| norm(force)).fold(0.0, f64::max);
    println!(
        "{name}: position {position:.1e} m, velocity {velocity:.1e} m/s, stress {stress:.1e} Pa, \
         energy {energy:.1e}, momentum {momentum:.1e}, force {force:.1e} of {most:.1e} N"
    );
    assert!(most > 0.0, "{name}: nothing touches");
    assert!(position < 1e-9 && velocity < 1e-8 && stress < 1e-3, "{name}");
    assert!(energy < 1e-9 && momentum < 1e-9 && force < 1e-8 * most, "{name}");
}

/// Two disks and a block between; in the endless tube the second stands before the first, in the periodic one behind.
fn three(dimension: &str, shift: f64, rigid: &str) -> String {
    let place =
        |x: f64, y: f64| if dimension == "3d" { format!("[{x}, {y}, 0]") } else { format!("[{x}, {y}]") };
    let corner =
        |x: f64, y: f64| if dimension == "3d" { format!("[{x}, {y}, {y}]") } else { format!("[{x}, {y}]") };
    let fast = format!("{rigid}velocity = {}", place(2.0, 0.0));
    let slow = format!("{rigid}velocity = {}", place(1.0, 0.1));
    body("left", &format!("ball = {{ center = {}, radius = 0.25 }}", place(1.95, 0.05)), &fast)
        + &body(
            "right",
            &format!("ball = {{ center = {}, radius = 0.22 }}", place(2.45 + shift, 0.02)),
            &slow,
        )
        + &body(
            "block",
            &format!(
                "box = {{ min = {}, max = {} }}",
                corner(2.7 + shift, -0.15),
                corner(2.95 + shift, 0.15)
            ),
            &slow,
        )
}

/// The three of [`three`], once in the endless tube and once with two of them a period back, as the periodic one wants
/// them.
fn compare_three(name: &str, dimension: &str, keys: (&str, &str, &str), steps: usize) {
    compare_bodies(name, dimension, keys, ("", steps));
}

/// The same of bodies that are deformable, or rigid.
fn compare_bodies(
    name: &str,
    dimension: &str,
    (space, time, contact): (&str, &str, &str),
    (rigid, steps): (&str, usize),
) {
    let bodies = [three(dimension, -2.4, rigid), three(dimension, 0.0, rigid)];
    let tube = |periodic: bool| Tube {
        dimension,
        space,
        time,
        contact,
        bodies: &bodies[usize::from(!periodic)],
        periodic,
    };
    // Bodies that start a period back stay a period back.
    let mut simulations = [true, false].map(|periodic| tube(periodic).start());
    simulations.iter_mut().for_each(|simulation| take_steps(&mut **simulation, steps));
    let [a, b] = [&simulations[0], &simulations[1]].map(|simulation| simulation.snapshot());
    let back = |p: usize| if a.body[p] == 0 { 0.0 } else { 2.4 };
    let place = |p: usize| [a.position[p][0] + back(p), a.position[p][1], a.position[p][2]];
    let places: Vec<_> = (0..a.body.len()).map(place).collect();
    let position = largest_difference(&places, &b.position);
    let velocity = largest_difference(&a.velocity, &b.velocity);
    let touching =
        simulations.each_ref().map(|simulation| ContactCursor::default().read(&**simulation).len());
    println!("{name}: position {position:.1e} m, velocity {velocity:.1e} m/s, pairs {touching:?}");
    assert_eq!(touching, [2, 2], "{name}");
    // Contacts of rigid bodies are solved to a tolerance.
    let bound = if rigid.is_empty() { 1e-9 } else { 1e-8 };
    assert!(position < bound && velocity < 10.0 * bound, "{name}");
}

#[test]
fn bodies_that_touch_through_the_face() {
    for basis in ["gimp", "linear", "spline", "cubic"] {
        for update in STRESS_UPDATES.into_iter().filter(|update| basis == "gimp" || *update != "last") {
            let (space, time) = (format!("basis = \"{basis}\""), format!("stress_update = \"{update}\""));
            compare_three(&format!("{basis}, {update}"), "plane-strain", (&space, &time, ""), 120);
        }
    }
    for transfer in ["flip", "apic", "xpic", "pic"] {
        let time = format!("transfer = \"{transfer}\"");
        compare_three(transfer, "plane-strain", ("", &time, ""), 120);
    }
    for law in ["kinematic", "separation", "regression", "gap", "traction", "glued"] {
        let contact = format!("law = \"{law}\"");
        compare_three(law, "plane-strain", ("", "", &contact), 120);
    }
    compare_three("plane stress", "plane-stress", ("", "", ""), 120);
    compare_three("space", "3d", ("", "", ""), 80);
}

/// All fly on: the fast one reaches the slow one in the third period.
#[test]
fn bodies_that_touch_after_periods_of_flight() {
    let metal = body("slow", "ball = { center = [1.2, 0], radius = 0.25 }", "velocity = [8, 0]")
        .replace("\"rubber\"", "\"metal\"");
    let bodies =
        body("fast", "ball = { center = [0.3, 0.05], radius = 0.25 }", "velocity = [10, 0]") + &metal;
    let tube =
        Tube { dimension: "plane-strain", space: "", time: "", contact: "", bodies: &bodies, periodic: true };
    compare("in the third period", &tube, 400);
}

/// Rigid bodies: one that turns as it goes through the face, one that is free.
#[test]
fn rigid_bodies_that_move_through_the_face() {
    let soft = body("soft", "ball = { center = [1.0, 0.35], radius = 0.3 }", "velocity = [1, -1]");
    let bar = "box = { min = [0.4, -0.2], max = [1.5, 0.0] }";
    for (name, motion, steps) in [
        ("turning", "rigid = { velocity = [3, 0], spin = 1 }", 150),
        ("free", "rigid.free = {}\nvelocity = [3, 0]\nspin = 1", 400),
    ] {
        let bodies = soft.clone() + &body("bar", bar, motion);
        let tube = Tube {
            dimension: "plane-strain",
            space: "",
            time: "",
            contact: "",
            bodies: &bodies,
            periodic: true,
        };
        compare(name, &tube, steps);
    }
}

/// Free rigid bodies that touch each other through the face: their exact surfaces see the nearest images.
#[test]
fn free_rigid_bodies_that_touch_through_the_face() {
    let time = "max_step = 1e-3";
    for dimension in ["plane-strain", "3d"] {
        let keys = ("", time, "restitution = 0.5");
        compare_bodies(dimension, dimension, keys, ("rigid.free = {}\n", 150));
    }
    // Both fly on, and meet in the third period.
    let bodies =
        body("fast", "ball = { center = [0.3, 0.05], radius = 0.25 }", "rigid.free = {}\nvelocity = [10, 0]")
            + &body(
                "slow",
                "box = { min = [1.0, -0.2], max = [1.4, 0.2] }",
                "rigid.free = {}\nvelocity = [8, 0]",
            );
    let tube =
        Tube { dimension: "plane-strain", space: "", time, contact: "", bodies: &bodies, periodic: true };
    compare("in the third period", &tube, 400);
}

/// A bed of free rigid disks, packed across the faces, slides and rolls down a slope.
#[test]
fn a_bed_of_rigid_disks_flows_through_the_faces() {
    let (period, end) = (12.0, 8.0);
    let mut simulation = start(&format!(
        r#"
        gravity = [0.6, -1]
        time = {{ end = {end}, max_step = 0.02 }}
        materials.stone = {{ density = 1, neo_hookean = {{ young_modulus = 1e3, poisson_ratio = 0.3 }} }}
        contact = [{{ friction = 0.3 }}]
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.5
        domain = {{ min = [0, -2], max = [{period}, 20], x_min = "periodic", x_max = "periodic" }}
        [[bodies]]
        name = "floor"
        material = "stone"
        shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
        rigid = {{}}
        [[packings]]
        name = "disk"
        material = "stone"
        shape.ball = {{ center = [0, 0], radius = 0.5 }}
        sizes.uniform = [0.8, 1]
        within.box = {{ min = [0, 0], max = [{period}, 10] }}
        count = 120
        rigid.free = {{}}
        "#
    ));
    let disks = |simulation: &dyn Simulation| -> Vec<([f64; 3], f64)> {
        let all = simulation.bodies();
        all.iter().skip(1).map(|body| (body.position, (body.mass / std::f64::consts::PI).sqrt())).collect()
    };
    // The deepest overlap of disks and nearest images, and how many pairs touch through a face.
    let look = |disks: &[([f64; 3], f64)]| {
        let (mut deepest, mut through) = (0.0_f64, 0);
        for (i, (a, r)) in disks.iter().enumerate() {
            for (b, s) in &disks[..i] {
                let off = a[0] - b[0];
                let overlap = r + s - (off - period * (off / period).round()).hypot(a[1] - b[1]);
                let inside = (a[0].rem_euclid(period) - b[0].rem_euclid(period)).abs();
                deepest = deepest.max(overlap);
                through += usize::from(overlap > -1e-3 && inside > 0.5 * period);
            }
        }
        (deepest, through)
    };
    let (mut cursor, mut deepest) = (ContactCursor::default(), 0.0_f64);
    cursor.read(&*simulation);
    run_to(&mut *simulation, end, |simulation| deepest = deepest.max(look(&disks(simulation)).0));
    let (_, through) = look(&disks(&*simulation));
    let floor = cursor.read(&*simulation).into_iter().filter(|pair| pair.body_a == 0);
    let force = floor.fold([0.0; 2], |[x, y], pair| [x + pair.mean.force[0], y + pair.mean.force[1]]);
    let mass: f64 = simulation.bodies().iter().skip(1).map(|body| body.mass).sum();
    let momentum = simulation.ledger().momentum;
    let off = [0.6, -1.0].into_iter().enumerate().map(|(k, g)| momentum[k] - end * (mass * g + force[k]));
    let off = off.fold(0.0_f64, |most, off| most.max(off.abs())) / (end * mass);
    let furthest = disks(&*simulation).iter().map(|(x, _)| x[0]).fold(0.0, f64::max);
    println!(
        "overlap {deepest:.1e}; {through} pairs touch through the faces; as far as {furthest:.1} m; momentum off by \
         {off:.1e} of the weight's"
    );
    assert!(furthest > 1.5 * period && through > 3, "{furthest} {through}");
    assert!(deepest < 0.03 && off < 1e-12, "{deepest} {off}");
}

/// On a floor without bounds, through the face.
#[test]
fn a_body_on_a_floor_without_bounds() {
    let bodies = body("soft", "ball = { center = [1.0, 0.3], radius = 0.3 }", "velocity = [3, -1]")
        + &body("floor", "half_space = { point = [0, 0], normal = [0, 1] }", "rigid.velocity = [0.5, 0]");
    let tube =
        Tube { dimension: "plane-strain", space: "", time: "", contact: "", bodies: &bodies, periodic: true };
    compare("floor", &tube, 200);
}

const SIDE: f64 = 3.2;

fn medium(basis: &str, velocity: [f64; 2]) -> Box<dyn Simulation> {
    start(&format!(
        r#"
        [space]
        dimension = "plane-strain"
        interior = "grid"
        cell = 0.1
        basis = "{basis}"
        [space.domain]
        min = [0, 0]
        max = [{SIDE}, 0.8]
        x_min = "periodic"
        x_max = "periodic"
        y_min = "periodic"
        y_max = "periodic"
        [time]
        end = 1
        [materials]
        {}
        [[bodies]]
        name = "medium"
        material = "rubber"
        shape.box = {{ min = [0, 0], max = [{SIDE}, 0.8] }}
        velocity = {velocity:?}
        "#,
        RUBBER.trim_start_matches("materials.")
    ))
}

#[test]
fn a_medium_that_moves_through_all_faces_has_no_stress() {
    for basis in ["gimp", "linear", "spline", "cubic"] {
        let mut simulation = medium(basis, [40.0, -25.0]);
        run_to(&mut *simulation, 0.2, |_| {});
        let snapshot = simulation.snapshot();
        let stress = snapshot.stress.iter().flatten().fold(0.0_f64, |most, s| most.max(s.abs()));
        println!("{basis}: stress {stress:.1e} Pa of 1e6");
        assert!(snapshot.position.iter().all(|x| x[0] > 2.0 * SIDE), "they are two periods on");
        assert!(stress < 1e-4, "{basis}: {stress}");
    }
}

/// v = V sin(2 pi x / L) along an axis, and when the velocities have turned round twice.
fn period_of_standing_wave(axis: usize) -> f64 {
    let mut simulation = medium("gimp", [0.0, 0.0]);
    let places = simulation.column(0, "position").expect("all have places");
    let speed = |x: f64| 1e-3 * (TAU * x / SIDE).sin();
    let velocity = |(_, [x, ..]): (u32, [f64; 3])| {
        let mut v = [0.0; 2];
        v[axis] = speed(x);
        v
    };
    let values: Vec<f64> = places.rows::<3>().flat_map(velocity).collect();
    drop(places);
    simulation.write(0, "velocity", &values).expect("as many as there are");
    // Amplitude: sum of v sin; its zeros are a quarter and three quarters of a period in.
    let amplitude = |simulation: &dyn Simulation| {
        let snapshot = simulation.snapshot();
        let each = snapshot.position.iter().zip(&snapshot.velocity);
        each.map(|(x, v)| v[axis] * (TAU * x[0] / SIDE).sin()).sum::<f64>()
    };
    let (mut last, mut zeros) = ((0.0, amplitude(&*simulation)), Vec::new());
    run_to(&mut *simulation, 0.4, |simulation| {
        let now = (simulation.time(), amplitude(simulation));
        if now.1 * last.1 < 0.0 {
            zeros.push(last.0 + (now.0 - last.0) * last.1 / (last.1 - now.1));
        }
        last = now;
    });
    2.0 * (zeros[1] - zeros[0])
}

#[test]
fn standing_waves_of_the_length_of_the_period() {
    let (young, poisson, density) = (1e6, 0.3, 1000.0_f64);
    let shear: f64 = young / (2.0 * (1.0 + poisson));
    let modulus: f64 = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    for (axis, modulus) in [(0, modulus), (1, shear)] {
        let found = period_of_standing_wave(axis);
        let exact = SIDE / (modulus / density).sqrt();
        println!(
            "along {axis}: period {found:.5} s, exact {exact:.5} s, {:+.2} %",
            100.0 * (found / exact - 1.0)
        );
        assert!((found / exact - 1.0).abs() < 0.01, "{axis}: {found} {exact}");
    }
}

/// The layer is joined to itself: no end of it meets a wall, none lifts.
#[test]
fn a_layer_without_end_slides_down_a_slope() {
    let (g, slope, friction) = (10.0, 30f64.to_radians(), 0.3);
    for floor in
        ["half_space = { point = [0, 0], normal = [0, 1] }", "box = { min = [0, -0.4], max = [0.8, 0] }"]
    {
        let mut simulation = start(&format!(
            r#"
            gravity = [{}, {}]
            damping.bulk_linear = 0.1
            [space]
            dimension = "plane-strain"
            interior = "grid"
            cell = 0.1
            domain = {{ min = [0, -0.4], max = [0.8, 1], x_min = "periodic", x_max = "periodic" }}
            [time]
            end = 1
            [materials]
            {}
            [[bodies]]
            name = "layer"
            material = "rubber"
            shape.box = {{ min = [0, 0], max = [0.8, 0.5] }}
            [[bodies]]
            name = "floor"
            material = "rubber"
            shape.{floor}
            rigid = {{}}
            [[contact]]
            friction = {friction}
            "#,
            g * slope.sin(),
            -g * slope.cos(),
            RUBBER.trim_start_matches("materials."),
        ));
        run_to(&mut *simulation, 1.0, |_| {});
        // However it bounces: the impulse of friction is mu times that of the floor, m (g cos t + v_y).
        let (time, [along, across, _]) = (simulation.time(), simulation.bodies()[0].velocity);
        let exact = g * slope.sin() * time - friction * (g * slope.cos() * time + across);
        let found = along;
        let snapshot = simulation.snapshot();
        let of_layer = |p: &usize| snapshot.body[*p] == 0;
        let row = |p: &usize| (snapshot.position[*p][1] - 0.475).abs() < 0.01;
        let tops: Vec<f64> =
            (0..snapshot.body.len()).filter(of_layer).filter(row).map(|p| snapshot.stress[p][1]).collect();
        let spread = tops.iter().fold(f64::NEG_INFINITY, |a, &b| a.max(b))
            - tops.iter().fold(f64::INFINITY, |a, &b| a.min(b));
        println!(
            "{floor}: {found:.9} m/s, exact {exact:.9} m/s; sigma_yy of a row differs by {spread:.1e} Pa"
        );
        assert!(
            (0..snapshot.body.len()).filter(of_layer).all(|p| snapshot.position[p][0] > 0.8),
            "it moves through the face"
        );
        assert!((found / exact - 1.0).abs() < 1e-3, "{found} {exact}");
        assert!(spread < 1e-6, "{spread}");
    }
}
