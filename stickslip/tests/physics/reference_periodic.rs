//! Bodies on grids of their own between periodic faces.
//!
//! Source: identity, momentum, symmetry, and Love's and Weber's mean stress.
//!
//! | set-up | expected |
//! |---|---|
//! | a soft disk, another and a rigid bar that turns meet through a face, against the same in the middle of the domain | the same particles and forces of contact to 1e-9 of sizes and speeds, momentum to round-off |
//! | a disk that reaches another one in the third period | the same to 1e-9 as without faces |
//! | a disk that is pressed on its own images, against the same between mirrors | the same force of the plates within 1e-3 |
//! | a packing pressed between endless plates | sum of f_y l_y over contacts = force of the plates times their distance, within 1 % |
//! | disks across faces | the same bits by one, two and five threads, and after a resume |

use crate::trial::{RUBBER, largest_difference, norm, run_to, same_bits, start, take_steps};
use stickslip::door::{ContactCursor, Simulation};

const PERIOD: f64 = 4.8;

/// A scene in a box with periodic faces across x, of that length; without faces in one without end.
fn scene(dimension: &str, periodic: bool, bodies: &str) -> String {
    let (ends, faces) = match periodic {
        true => (["0", "4.8"], ", x_min = 'periodic', x_max = 'periodic'"),
        false => (["-64", "64"], ""),
    };
    let [min, max] = [("-2.4", ends[0]), ("2.4", ends[1])].map(|(side, x)| match dimension {
        "3d" => format!("[{x}, {side}, {side}]"),
        _ => format!("[{x}, {side}]"),
    });
    format!(
        "time.end = 1\n{RUBBER}\ncontact = [{{ friction = 0.3 }}]\n\
         [space]\ndimension = '{dimension}'\ncell = 0.1\ninterior = 'reference'\n\
         domain = {{ min = {min}, max = {max}{faces} }}\n{bodies}"
    )
}

fn vector(dimension: &str, [x, y, z]: [f64; 3]) -> String {
    if dimension == "3d" { format!("[{x}, {y}, {z}]") } else { format!("[{x}, {y}]") }
}

fn body(name: &str, shape: &str, motion: &str) -> String {
    format!("[[bodies]]\nname = '{name}'\nmaterial = 'rubber'\nshape.{shape}\n{motion}\n")
}

/// Two soft bodies and a rigid one that turns, each moved along x by so much.
fn three(dimension: &str, moved: [f64; 3]) -> String {
    let at = |place| vector(dimension, place);
    let soft = |v: f64| format!("velocity = {}", at([v, 0.1, 0.05]));
    let spin = if dimension == "3d" { "[0, 0, 0.4]" } else { "0.4" };
    let rigid = format!("rigid = {{ velocity = {}, spin = {spin} }}", at([0.3, 1.0, 0.0]));
    let ball = format!("ball = {{ center = {}, radius = 0.4 }}", at([1.95 + moved[0], 0.1, 0.0]));
    let boxed = |[low, high]: [[f64; 3]; 2]| format!("box = {{ min = {}, max = {} }}", at(low), at(high));
    let block = boxed([[2.38 + moved[1], -0.35, -0.3], [3.0 + moved[1], 0.35, 0.3]]);
    let bar = boxed([[1.2 + moved[2], -0.8, -0.3], [3.2 + moved[2], -0.36, 0.3]]);
    body("left", &ball, &soft(1.5)) + &body("right", &block, &soft(-1.0)) + &body("bar", &bar, &rigid)
}

/// Takes the three of [`three`] through their contact, here and there, and compares the two.
fn compare(name: &str, [here, there]: [&str; 2], back: &dyn Fn(usize) -> f64, steps: usize) {
    let mut simulations = [here, there].map(start);
    let begun = simulations.each_ref().map(|simulation| simulation.ledger().momentum);
    let (mut nearest, mut pairs) = (f64::INFINITY, 0);
    let mut cursors = [ContactCursor::default(), ContactCursor::default()];
    for _ in 0..steps / 10 {
        simulations.iter_mut().for_each(|simulation| take_steps(&mut **simulation, 10));
        let [a, b] = [&simulations[0], &simulations[1]].map(|simulation| simulation.snapshot());
        let shifted =
            |p: usize| [a.position[p][0] + back(a.body[p] as usize), a.position[p][1], a.position[p][2]];
        let places: Vec<_> = (0..a.body.len()).map(shifted).collect();
        let position = largest_difference(&places, &b.position);
        let velocity = largest_difference(&a.velocity, &b.velocity);
        let [f, g] = [0, 1].map(|i| cursors[i].read(&*simulations[i]));
        assert_eq!(f.len(), g.len(), "{name}");
        for (f, g) in f.iter().zip(&g) {
            let force = largest_difference(&[f.mean.force], &[g.mean.force]);
            // It acts where the first body of the pair is.
            let mut at = f.mean.position;
            at[0] += back(f.body_a);
            let off = largest_difference(&[at], &[g.mean.position]);
            assert!(force < 1e-8 * norm(g.mean.force).max(1.0) && off < 1e-8, "{name}: {f:?} {g:?}");
        }
        pairs = pairs.max(g.len());
        nearest = nearest.min(-position.max(0.1 * velocity));
    }
    let momentum = simulations.each_ref().map(|simulation| simulation.ledger().momentum);
    let [x, y] = [0, 1].map(|i| largest_difference(&[momentum[i]], &[begun[i]]));
    println!("{name}: off by {:.1e}, pairs {pairs}, momentum changed by {x:.3e} and {y:.3e}", -nearest);
    assert!(pairs > 0 && -nearest < 1e-9, "{name}: {} {pairs}", -nearest);
    assert!((x - y).abs() < 1e-6 * y.max(1.0), "{name}: {x} {y}");
}

#[test]
fn bodies_that_touch_through_the_face_do_as_those_in_the_middle() {
    for (dimension, steps) in [("plane-strain", 400), ("3d", 60)] {
        let half = 0.5 * PERIOD;
        // The left one and the bar are half a period on, near the upper face, the right one is near the lower one.
        let moved = [half, -half, half];
        let [here, there] = [moved, [0.0; 3]].map(|moved| scene(dimension, true, &three(dimension, moved)));
        compare(dimension, [&here, &there], &|body| -moved[body], steps);
    }
}

#[test]
fn a_disk_reaches_another_one_in_the_third_period() {
    let disk = |name: &str, x: f64, y: f64, v: f64| {
        body(
            name,
            &format!("ball = {{ center = [{x}, {y}], radius = 0.4 }}"),
            &format!("velocity = [{v}, 0]"),
        )
    };
    let bodies = |x: f64| disk("fast", 2.6, 0.2, 10.0) + &disk("slow", x, 0.0, 8.0);
    let here = scene("plane-strain", true, &bodies(0.6));
    let there = scene("plane-strain", false, &bodies(0.6 + PERIOD));
    compare("in the third period", [&here, &there], &|body| PERIOD * body as f64, 1200);
}

/// Disks in a box with faces that are all periodic keep their momentum to round-off, and their energy.
#[test]
fn disks_in_a_box_of_periodic_faces_keep_momentum_and_energy() {
    let disk = |name: &str, (x, y): (f64, f64), (u, v): (f64, f64)| {
        body(
            name,
            &format!("ball = {{ center = [{x}, {y}], radius = 0.4 }}"),
            &format!("velocity = [{u}, {v}]"),
        )
    };
    let bodies = disk("a", (0.3, -2.0), (-2.0, -1.5))
        + &disk("b", (4.6, 2.0), (1.0, 1.0))
        + &disk("c", (2.0, 0.0), (0.5, -2.5));
    let text = scene("plane-strain", true, &bodies)
        .replace("x_min =", "y_min = 'periodic', y_max = 'periodic', x_min =");
    let mut simulation = start(&text);
    let (momentum, mass) = (simulation.ledger().momentum, simulation.bodies()[0].mass);
    let energy = |simulation: &dyn Simulation| -> f64 {
        simulation.bodies().iter().map(|body| body.kinetic + body.strain).sum::<f64>()
            + simulation.ledger().friction
    };
    let before = energy(&*simulation);
    run_to(&mut *simulation, 4.0, |_| ());
    let off = norm([0, 1, 2].map(|k| simulation.ledger().momentum[k] - momentum[k])) / mass;
    let left = energy(&*simulation) / before;
    let pairs = simulation.contact_sums().len();
    println!("momentum off by {off:.1e} m/s, energy {left}, {pairs} pairs met");
    assert!(pairs >= 1 && off < 1e-11, "{pairs} {off}");
    assert!((left - 1.0).abs() < 0.01, "{left}");
}

/// Plates come together on a disk that is nearly as wide as the period: it presses on its own images as on mirrors.
#[test]
fn a_disk_presses_on_its_own_images_as_on_mirrors() {
    let plate = |name: &str, [low, high]: [f64; 2], v: f64| {
        body(
            name,
            &format!("box = {{ min = [0, {low}], max = [4.8, {high}] }}"),
            &format!("rigid.velocity = [0, '{v} * min(t / 0.02, 1)']"),
        )
    };
    let bodies = body("disk", "ball = { center = [2.4, 0], radius = 2.2 }", "")
        + &plate("floor", [-2.4, -2.2], 2.0)
        + &plate("lid", [2.2, 2.4], -2.0);
    let text = scene("plane-strain", true, &bodies).replace("friction = 0.3", "friction = 0");
    let force = |text: &str| {
        let (mut simulation, mut cursor) = (start(text), ContactCursor::default());
        run_to(&mut *simulation, 0.46, |_| ());
        cursor.read(&*simulation);
        run_to(&mut *simulation, 0.47, |_| ());
        let wide = simulation.snapshot().position.iter().map(|x| x[0]).fold(0.0, f64::max) - 2.4;
        let all = cursor.read(&*simulation);
        (all.iter().map(|contact| contact.mean.force[1].abs()).sum::<f64>(), wide)
    };
    let ((own, wide), (mirrors, _)) = (force(&text), force(&text.replace("periodic", "symmetry")));
    println!("plates push {own} N, between mirrors {mirrors} N; half {wide} m wide");
    assert!(wide > 2.3 && wide < 2.45, "it is as wide as the period: {wide}");
    assert!((own / mirrors - 1.0).abs() < 1e-3, "{own} {mirrors}");
}

/// Grains across the faces, between endless plates that come together by 0.35 m each and shear them.
pub fn packing() -> String {
    let plate = |name: &str, [low, high]: [f64; 2], v: f64| {
        let motion = format!(
            "rigid.velocity = ['{v} * min(t / 0.1, max(0, 3 - t / 0.1))', '7 * {v} * min(t / 0.1, max(0, 2 - t / 0.1))']"
        );
        body(name, &format!("box = {{ min = [0, {low}], max = [4.8, {high}] }}"), &motion)
    };
    let grains = "[[packings]]\nname = 'grain'\nmaterial = 'rubber'\nshape.ball = { center = [0, 0], radius = 0.45 }\n\
                  sizes = { uniform = [0.8, 1.2] }\ncount = 20\nseed = 5\n\
                  within.box = { min = [0, -2], max = [4.8, 2] }\n";
    scene(
        "plane-strain",
        true,
        &(plate("floor", [-2.3, -2.0], 0.5) + &plate("lid", [2.0, 2.3], -0.5) + grains),
    )
    .replace("time.end", "damping.viscous = 30\ntime.end")
}

#[test]
fn the_mean_stress_of_a_packing_is_that_of_its_plates() {
    let mut simulation = start(&packing());
    run_to(&mut *simulation, 0.7, |_| ());
    let mut cursor = ContactCursor::default();
    cursor.read(&*simulation);
    run_to(&mut *simulation, 0.9, |_| ());
    let (bodies, contacts) = (simulation.bodies(), cursor.read(&*simulation));
    let (mut push, mut virial, mut through) = ([0.0; 2], 0.0, 0);
    for pair in &contacts {
        // On the second body; arms of plates begin where they touch.
        let (force, to) = (pair.mean.force[1], bodies[pair.body_b].position);
        let from = match push.get_mut(pair.body_a) {
            Some(push) => {
                *push += force;
                pair.mean.position
            }
            None => bodies[pair.body_a].position,
        };
        virial += force * (to[1] - from[1]);
        through += usize::from((to[0] - from[0]).abs() > 0.5 * PERIOD);
    }
    let mean = 0.5 * (push[0] - push[1]) * (4.0 - 2.0 * 0.35);
    println!("plates {push:?} N, virial {virial} N m of {mean}; {through} pairs through the face");
    assert!(through > 2 && push[0] > 0.0 && (push[0] / push[1] + 1.0).abs() < 0.01, "{through} {push:?}");
    assert!((virial / mean - 1.0).abs() < 0.01, "{virial} {mean}");
}

#[test]
fn bits_do_not_depend_on_threads_or_resumes() {
    same_bits(&packing(), 300, [2, 5]);
    same_bits(&scene("3d", true, &three("3d", [2.4, -2.4, 2.4])), 60, [2, 5]);
}
