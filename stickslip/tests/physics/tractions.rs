//! Pressure and shear at points of contact.
//!
//! Source: equilibrium; Hertz's line contact (Johnson, Contact Mechanics, 1985, section 4.2), p = p0 sqrt(1 - x^2/a^2)
//! with a = sqrt(4 P R / (pi E*)) and p0 = sqrt(P E* / (pi R)), E* = E / (1 - nu^2) beside a rigid plane.
//!
//! Set-up: plane strain, bodies on grids of their own. A disk spins on a block that falls on a fixed face beside a
//! moving wall, with friction; two blocks of one width on a rigid floor without friction, pressed by a traction; half
//! of a disk on a rigid floor under its weight, four cells on half of the contact's width, at rest.
//!
//! Expected: sums of area times traction are the impulses of pairs and faces in each step, to round-off; the pressure
//! is that of the traction in both contacts, a cell away from the edges within 3 %, and its sum within 0.5 %; Hertz's
//! peak and half-width within 10 %: his strains are small, and eight points lie on half of the width.

use crate::trial::{RUBBER, norm, start, take_steps};
use std::f64::consts::PI;
use stickslip::door::{ContactPoint, Simulation, Touched};

/// Traction on the body times area, -p n + tau [N].
fn force(point: &ContactPoint) -> [f64; 3] {
    [0, 1, 2].map(|k| point.area * (point.shear[k] - point.pressure * point.normal[k]))
}

/// Force of the first body on the second, by points of both.
fn force_of_pair(points: &[ContactPoint], [a, b]: [usize; 2]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for point in points {
        let sign = match (point.body, point.partner) {
            (body, Touched::Body(partner)) if [body, partner] == [a, b] => -1.0,
            (body, Touched::Body(partner)) if [body, partner] == [b, a] => 1.0,
            _ => continue,
        };
        sum.iter_mut().zip(force(point)).for_each(|(sum, f)| *sum += sign * f);
    }
    sum
}

#[test]
fn points_add_up_to_the_forces_of_pairs_and_faces() {
    let text = format!(
        r#"
        gravity = [0, -10]
        time.end = 1
        outputs.reactions = ["y_min"]
        contact = [{{ friction = 0.3 }}]
        {RUBBER}
        [space]
        dimension = "plane-strain"
        interior = "reference"
        cell = 0.1
        domain = {{ min = [-2, 0], max = [2, 3], y_min = "fixed" }}
        [[bodies]]
        name = "disk"
        material = "rubber"
        shape.ball = {{ center = [0.1, 0.72], radius = 0.3 }}
        velocity = [0, -1]
        spin = 6
        [[bodies]]
        name = "block"
        material = "rubber"
        shape.box = {{ min = [-0.5, 0.01], max = [0.5, 0.41] }}
        [[bodies]]
        name = "wall"
        material = "rubber"
        shape.half_space = {{ point = [-0.51, 0], normal = [1, 0] }}
        rigid.velocity = [0.2, 0.1]
        "#
    );
    let mut simulation = start(&text);
    assert_eq!(simulation.contact_points(), [], "no step, no force");
    let mut met = [0; 3];
    for _ in 0..400 {
        let (sums, walls) = (simulation.contact_sums(), simulation.walls());
        let dt = simulation.step(f64::INFINITY).expect("the trial is sound");
        let points = simulation.contact_points();
        let gained = |now: [f64; 3], before: Option<[f64; 3]>| {
            let before = before.unwrap_or_default();
            [0, 1, 2].map(|k| now[k] - before[k])
        };
        for sum in simulation.contact_sums() {
            let before = sums.iter().find(|before| before.bodies == sum.bodies);
            let impulse = gained(sum.impulse, before.map(|before| before.impulse));
            let found = force_of_pair(&points, sum.bodies);
            let off = norm([0, 1, 2].map(|k| impulse[k] - found[k] * dt));
            assert!(off <= 1e-11 * sum.magnitude, "{:?}: {impulse:?} {found:?} {dt}", sum.bodies);
        }
        for wall in simulation.walls() {
            let before = walls.iter().find(|before| before.body == wall.body);
            let impulse = gained(wall.impulse, before.map(|before| before.impulse));
            let face = Touched::Face { axis: 1, upper: false };
            let at_face = points.iter().filter(|point| (point.body, point.partner) == (wall.body, face));
            let found = at_face.map(force).fold([0.0; 3], |sum, f| [0, 1, 2].map(|k| sum[k] - f[k]));
            let off = norm([0, 1, 2].map(|k| impulse[k] - found[k] * dt));
            assert!(off <= 1e-11 * norm(wall.impulse), "{}: {impulse:?} {found:?} {dt}", wall.body);
        }
        for point in &points {
            let ContactPoint { body, partner, normal, area, pressure, .. } = *point;
            assert!((norm(normal) - 1.0).abs() < 1e-12 && area > 0.0 && pressure >= 0.0, "{point:?}");
            // A point of a disk of 0.3 m stands for less than a cell, and for half of that beside the block's.
            assert!(area < if matches!(partner, Touched::Body(0 | 1)) { 0.05 } else { 0.1 }, "{point:?}");
            match (body, partner) {
                (0, Touched::Body(1)) => met[0] += usize::from(normal[1] < 0.0),
                (1, Touched::Body(0)) => met[0] += usize::from(normal[1] > 0.0),
                (1, Touched::Body(2)) => met[1] += usize::from(normal[0] < 0.0),
                (1, Touched::Face { .. }) => met[2] += usize::from(normal[1] < 0.0),
                _ => {}
            }
        }
    }
    println!("points of disk and block, at the wall, on the face: {met:?}");
    assert!(met.iter().all(|&count| count > 10), "{met:?}");
}

/// Steps until dynamic relaxation has come to rest.
fn rest(simulation: &mut dyn Simulation) {
    while !simulation.relaxation().expect("asked for").at_rest && simulation.steps() < 20_000 {
        take_steps(simulation, 1);
    }
    let state = simulation.relaxation().expect("asked for");
    println!("{state:?} after {} steps", simulation.steps());
    assert!(state.at_rest);
}

#[test]
fn blocks_press_each_other_and_their_floor_evenly() {
    let text = format!(
        r#"
        time = {{ end = 20, relax = {{ residual = 1e-4 }} }}
        contact = [{{ friction = 0 }}]
        {RUBBER}
        [space]
        dimension = "plane-strain"
        interior = "reference"
        cell = 0.1
        [[bodies]]
        name = "upper"
        material = "rubber"
        shape.box = {{ min = [0, 0], max = [1, 0.5] }}
        [[bodies]]
        name = "lower"
        material = "rubber"
        shape.box = {{ min = [0, -0.5], max = [1, 0] }}
        [[bodies]]
        name = "floor"
        material = "rubber"
        shape.half_space = {{ point = [0, -0.5], normal = [0, 1] }}
        rigid = {{}}
        [[loads]]
        body = "upper"
        on = "y_max"
        traction = [0, "-10 kPa"]
        "#
    );
    let mut simulation = start(&text);
    rest(&mut *simulation);
    let points = simulation.contact_points();
    let exact = 10e3;
    for (body, partner, share, y, normal) in
        [(0, 1, 0.5, 0.0, -1.0), (1, 0, 0.5, 0.0, 1.0), (1, 2, 1.0, -0.5, -1.0)]
    {
        let all = points.iter().filter(|point| (point.body, point.partner) == (body, Touched::Body(partner)));
        let (mut area, mut sum, mut range) = (0.0, 0.0, [f64::INFINITY, 0.0_f64]);
        for point in all {
            let ContactPoint { undeformed: [x, y0, _], pressure, .. } = *point;
            (area, sum) = (area + point.area, sum + point.area * pressure);
            assert!((y0 - y).abs() < 1e-9 && (point.normal[1] - normal).abs() < 1e-3, "{point:?}");
            assert_eq!(point.shear, [0.0; 3]);
            if (0.1..=0.9).contains(&x) {
                range = [range[0].min(pressure / exact), range[1].max(pressure / exact)];
            }
        }
        println!("{body} at {partner}: area {area:.4}, force {:.5}, pressure {range:.4?}", sum / exact);
        assert!((area - share).abs() < 1e-9, "{area}");
        assert!((sum / (share * exact) - 1.0).abs() < 0.005, "{sum}");
        assert!(range[0] > 0.97 && range[1] < 1.03, "{range:?}");
    }
}

#[test]
fn a_disk_presses_its_floor_as_hertz_says() {
    let (radius, gravity, elastic) = (1.0, 7.0, 1e6 / (1.0 - 0.09));
    let text = format!(
        r#"
        gravity = [0, -{gravity}]
        time = {{ end = 20, relax = {{ residual = 1e-3 }} }}
        contact = [{{ friction = 0 }}]
        {RUBBER}
        [space]
        dimension = "plane-strain"
        interior = "reference"
        cell = 0.04
        domain = {{ min = [0, -0.4], max = [2, 3.2], x_min = "symmetry" }}
        [[bodies]]
        name = "disk"
        material = "rubber"
        shape.intersection = [
            {{ ball = {{ center = [0, {radius}], radius = {radius} }} }},
            {{ half_space = {{ point = [0, 0], normal = [-1, 0] }} }},
        ]
        [[bodies]]
        name = "floor"
        material = "rubber"
        shape.half_space = {{ point = [0, 0], normal = [0, 1] }}
        rigid = {{}}
        "#
    );
    let mut simulation = start(&text);
    rest(&mut *simulation);
    let points = simulation.contact_points();
    // Of the whole disk.
    let load = 2.0 * simulation.bodies()[0].mass * gravity;
    let half_width = (4.0 * load * radius / (PI * elastic)).sqrt();
    let peak = (load * elastic / (PI * radius)).sqrt();
    let sum = |of: &dyn Fn(&ContactPoint) -> f64| -> f64 { points.iter().map(|p| p.area * of(p)).sum() };
    let force = 2.0 * sum(&|point| point.pressure);
    // The second moment of Hertz's pressure is P a^2 / 4.
    let width = 2.0 * (2.0 * sum(&|point| point.pressure * point.position[0].powi(2)) / force).sqrt();
    let middle = points.iter().filter(|point| point.position[0] < 0.5 * half_width);
    let (mut found, mut exact) = (0.0, 0.0);
    for point in middle {
        found += point.pressure;
        exact += peak * (1.0 - (point.position[0] / half_width).powi(2)).sqrt();
    }
    let highest = found / exact;
    println!(
        "{} points, force {:.4}, peak {highest:.4}, half-width {:.4} of Hertz's {half_width:.4} m",
        points.len(),
        force / load,
        width / half_width
    );
    assert!((force / load - 1.0).abs() < 0.01, "{force} {load}");
    assert!((highest - 1.0).abs() < 0.1, "{highest}");
    assert!((width / half_width - 1.0).abs() < 0.1, "{width} {half_width}");
}
