//! Columns that are looked at where they lie.
//!
//! Set-up: two balls of metal, one of which turns and flies so fast that it flows and its particles are sorted anew, in
//! space and in the plane, in double and single precision.
//!
//! Expected: by its name each column of a body is that of the snapshot, bit for bit; what the plane does not leave free
//! is zero; a name that is unknown is refused with those that are known. Where a column lies in memory it is again
//! after every step and every state that is taken up, once the simulation has settled, and there it has the same
//! values. What is written is read back, moves the body as it should, and is refused where it cannot be.

use stickslip::door::{Ledger, NumberFormat, Simulation, WriteError};
use stickslip::scene::Scene;
use stickslip::{scene, step};

fn balls(dimension: &str, precision: &str) -> String {
    let v = |x: &str| if dimension == "3d" { format!("[{x}, 0]") } else { format!("[{x}]") };
    format!(
        r#"
        space = {{ dimension = "{dimension}", interior = "grid", cell = 0.1, precision = "{precision}" }}
        time.end = 1
        [materials.metal]
        density = 1000
        von_mises = {{ young_modulus = 1e6, poisson_ratio = 0.3, yield_stress = 500, hardening_modulus = 1e5 }}
        [[bodies]]
        name = "other"
        material = "metal"
        shape.ball = {{ center = {}, radius = 0.1 }}
        [[bodies]]
        name = "ball"
        material = "metal"
        shape.ball = {{ center = {}, radius = 0.3 }}
        velocity = {}
        spin = {}
        "#,
        v("-3, 0"),
        v("0, 0"),
        v("3, 1"),
        if dimension == "3d" { "[8, 6, 10]" } else { "12" },
    )
}

#[test]
fn columns_are_those_of_the_snapshot_in_any_dimension_and_precision() {
    for (dimension, precision) in [("3d", "double"), ("3d", "single"), ("plane-strain", "double")] {
        let text = balls(dimension, precision);
        let scene = scene::parse("columns.toml", &text, &[]).unwrap_or_else(|e| panic!("{e:?}")).scene;
        let mut simulation = step::build(&scene).unwrap();
        (0..40).for_each(|_| _ = simulation.step(f64::INFINITY).unwrap());

        let snapshot = simulation.snapshot();
        let first = snapshot.body.iter().filter(|&&body| body == 0).count();
        let names: Vec<&str> = simulation.columns(1).iter().map(|column| column.name).collect();
        assert!(names.ends_with(&["stress", "start", "plastic_strain"]), "{names:?}");
        for (described, values) in snapshot.columns() {
            let column = simulation.column(1, described.name).unwrap();
            assert_eq!(column.description, described);
            let components = described.kind.components();
            let mut copied = vec![f64::NAN; components * column.len()];
            column.copy_to(&mut copied);
            assert_eq!(copied, values[components * first..], "{} {dimension} {precision}", described.name);
        }
        let plastic_strain = simulation.column(1, "plastic_strain").unwrap();
        let remembered = &snapshot.remembered("plastic_strain").unwrap().values[first..];
        assert_eq!(plastic_strain.by_number::<1>().as_flattened(), remembered);
        assert!(plastic_strain.rows().any(|(_, [strain])| strain > 0.0), "it flows");

        // Rows are sorted by place, and say whose they are.
        let position = simulation.column(1, "position").unwrap();
        assert!(position.rows().all(|(number, x)| x == snapshot.position[first + number as usize]));
        assert!(!position.rows::<3>().map(|(number, _)| number).is_sorted());

        let spin = simulation.column(1, "spin").unwrap().by_number::<3>();
        assert!(spin.iter().all(|spin| spin[2] != 0.0 && (dimension == "3d" || spin[..2] == [0.0; 2])));

        let error = simulation.column(1, "strian").unwrap_err();
        assert_eq!((&error.name[..], &error.known), ("strian", &names));
        let said = error.to_string();
        assert!(
            said.starts_with("found a column `strian`") && said.ends_with("start, plastic_strain"),
            "{said}"
        );
    }
}

/// What lies at the place of a column: the numbers of each particle in the order of memory.
fn at_place(simulation: &dyn Simulation, body: usize, name: &str) -> Vec<Vec<f64>> {
    let place = simulation.column_place(body, name).unwrap();
    let number = |particle: usize, entry: usize| {
        let address = place.address + entry * place.stride;
        // SAFETY: the simulation is borrowed, and its columns are as long as the place says.
        unsafe {
            match place.format {
                NumberFormat::Single => {
                    f64::from(*std::ptr::with_exposed_provenance::<f32>(address).add(particle))
                }
                NumberFormat::Double => *std::ptr::with_exposed_provenance::<f64>(address).add(particle),
                NumberFormat::Count => {
                    f64::from(*std::ptr::with_exposed_provenance::<u32>(address).add(particle))
                }
            }
        }
    };
    let row = |particle: usize| (0..place.components.len()).map(|entry| number(particle, entry)).collect();
    (0..place.len).map(row).collect()
}

#[test]
fn columns_stay_where_they_are_once_settled() {
    for (dimension, precision) in [("3d", "single"), ("plane-strain", "double")] {
        let text = balls(dimension, precision);
        let scene = scene::parse("columns.toml", &text, &[]).unwrap_or_else(|e| panic!("{e:?}")).scene;
        let [mut simulation, mut other] = [(); 2].map(|()| step::build(&scene).unwrap());
        let names = ["position", "stress", "plastic_strain", "number"];
        let places = names.map(|name| simulation.column_place(1, name));
        let (mut moved, mut saved) = (0, None);
        for number in 0..40 {
            simulation.step(f64::INFINITY).unwrap();
            other.step(f64::INFINITY).unwrap();
            moved += usize::from(names.map(|name| simulation.column_place(1, name)) != places);
            simulation.settle();
            assert_eq!(names.map(|name| simulation.column_place(1, name)), places, "{number}");
            if number == 20 {
                saved = simulation.save();
            }
        }
        assert!(moved > 0, "particles were sorted");
        assert_eq!(simulation.snapshot(), other.snapshot(), "to settle changes no bit");

        let numbers = at_place(&*simulation, 1, "number");
        let stress = simulation.column(1, "stress").unwrap().by_number::<6>();
        let components = simulation.column_place(1, "stress").unwrap().components;
        for (number, found) in numbers.iter().zip(at_place(&*simulation, 1, "stress")) {
            let expected = components.iter().map(|&k| stress[number[0] as usize][k]);
            assert!(found.into_iter().eq(expected), "{dimension} {precision}");
        }
        simulation.restore(saved.unwrap()).unwrap();
        assert_eq!(names.map(|name| simulation.column_place(1, name)), places);
        assert_eq!(simulation.column_place(1, "strian"), None);
    }
}

/// The total stays within round-off, and what was written is part of the state.
fn what_was_written_is_booked(scene: &Scene, simulation: &dyn Simulation, before: &Ledger) {
    let (after, written) = (simulation.ledger(), simulation.written()[0]);
    assert!((after.total - before.total).abs() < 1e-12 * after.kinetic, "{before:?} {after:?}");
    assert_eq!((written.count, after.external_work - before.external_work), (2, written.energy));
    let gained = [0, 1, 2].map(|i| after.momentum[i] - before.momentum[i]);
    assert!((0..3).all(|i| (written.momentum[i] - gained[i]).abs() < 1e-12 * after.momentum[0].abs()));
    let saved = serde_json::to_value(simulation.save().unwrap()).unwrap();
    let mut other = step::build(scene).unwrap();
    other.restore(serde_json::from_value(saved).unwrap()).unwrap();
    assert_eq!(other.ledger(), after);
}

/// The wall takes one velocity and one spin, in either order, and what they change is booked.
fn what_is_written_to_a_rigid_body_is_that_of_the_whole(scene: &Scene, entries: usize) {
    let mut simulation = step::build(scene).unwrap();
    (0..3).for_each(|_| _ = simulation.step(f64::INFINITY).unwrap());
    let before = simulation.ledger();
    let spin = if entries == 3 { vec![1.0, -2.0, 3.0] } else { vec![3.0] };
    simulation.write(2, "spin", &spin).unwrap();
    simulation.write(2, "velocity", &[4.0, 5.0, 6.0][..entries]).unwrap();
    let (wall, after, written) = (&simulation.bodies()[2], simulation.ledger(), simulation.written()[2]);
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9 * (1.0 + b.abs());
    assert!((0..entries).all(|i| close(wall.velocity[i], [4.0, 5.0, 6.0][i])), "{wall:?}");
    assert!((3 - spin.len()..3).all(|i| close(wall.spin[i], spin[i + spin.len() - 3])), "{wall:?}");
    assert!(close(after.total, before.total) && written.count == 2);
    assert!(close(written.energy, after.kinetic - before.kinetic));
    for i in 0..3 {
        assert!(close(written.momentum[i], after.momentum[i] - before.momentum[i]));
        let turned = after.angular_momentum[i] - before.angular_momentum[i];
        assert!(close(written.angular_momentum[i], turned), "{written:?}");
    }
    // Each point of the body has its velocity.
    let [x, v] = ["position", "velocity"].map(|name| simulation.column(2, name).unwrap().by_number::<3>());
    let of_point = |i: usize| {
        let arm: [f64; 3] = std::array::from_fn(|k| x[i][k] - wall.position[k]);
        let turn = stickslip::tensor::cross(wall.spin, arm);
        (0..3).all(|k| (v[i][k] - wall.velocity[k] - turn[k]).abs() < 1e-5)
    };
    assert!((0..x.len()).all(of_point));
    for (name, values) in [("velocity", &[1.0][..]), ("spin", &[f64::NAN; 3][..spin.len()])] {
        let error = simulation.write(2, name, values).unwrap_err().to_string();
        assert!(error.contains("for body `wall`, which is rigid"), "{error}");
    }
    let error = simulation.write(2, "mass", &[1.0]).unwrap_err().to_string();
    assert!(error.contains("its mass is that of the scene"), "{error}");
    assert_eq!(simulation.ledger(), after);
}

#[test]
fn what_is_written_moves_bodies_and_nonsense_is_refused() {
    for (dimension, entries) in [("3d", 3), ("plane-strain", 2)] {
        let text = balls(dimension, "single")
            + "[[bodies]]\nname = \"wall\"\nmaterial = \"metal\"\nrigid = {}\nshape.box = { min = MIN, max = MAX }";
        let corner = |x: f64| format!("[{}]", vec![(x - 5.0).to_string(); entries].join(", "));
        let text = text.replace("MIN", &corner(0.0)).replace("MAX", &corner(0.2));
        let scene = scene::parse("columns.toml", &text, &[]).unwrap_or_else(|e| panic!("{e:?}")).scene;
        let mut simulation = step::build(&scene).unwrap();
        (0..10).for_each(|_| _ = simulation.step(f64::INFINITY).unwrap());
        let (before, step) = (simulation.bodies(), simulation.stable_step());
        let count = simulation.column(0, "mass").unwrap().len();

        let velocities: Vec<f64> = (0..count * entries).map(|i| [40.0, -30.0, 0.0][i % entries]).collect();
        let ledger = simulation.ledger();
        simulation.write(0, "velocity", &velocities).unwrap();
        simulation.write(0, "mass", &vec![0.5; count]).unwrap();
        what_was_written_is_booked(&scene, &*simulation, &ledger);
        let now = &simulation.bodies()[0];
        let off = |found: f64, expected: f64| (found - expected).abs() > 1e-6 * expected.abs();
        assert!(!off(now.mass, 0.5 * count as f64) && !off(now.velocity[0], 40.0), "{now:?}");
        assert!(simulation.stable_step() < 0.9 * step, "faster particles ask for shorter steps");
        let dt = simulation.step(f64::INFINITY).unwrap();
        let way = simulation.bodies()[0].position[1] - before[0].position[1];
        assert!((way / (-30.0 * dt) - 1.0).abs() < 0.01, "{way}");

        let mut refused = |body: usize, name: &str, values: &[f64], expected: &str| {
            let before = simulation.snapshot();
            let error = simulation.write(body, name, values).unwrap_err();
            assert!(error.to_string().contains(expected), "{error}");
            assert_eq!(simulation.snapshot(), before);
            error
        };
        let some = vec![1.0; count];
        refused(0, "masss", &some, "allowed: position, velocity,");
        let fixed = refused(0, "volume", &some, "allowed: velocity, spin, mass");
        assert_eq!(fixed, WriteError::Fixed { name: "volume".into() });
        refused(2, "mass", &some, "body `wall` is rigid");
        refused(0, "mass", &some[1..], &format!("found {} values; allowed: {count}, 1 for each", count - 1));
        for bad in [f64::NAN, f64::INFINITY, 1e300, 0.0, -1.0, 1e-300] {
            let mut values = some.clone();
            values[3] = bad;
            refused(
                0,
                "mass",
                &values,
                "for the particle at 3 in memory; allowed: finite numbers above zero",
            );
        }
        let free = text.replace("rigid = {}", "rigid = { free = {} }");
        let free = scene::parse("columns.toml", &free, &[]).unwrap_or_else(|e| panic!("{e:?}")).scene;
        what_is_written_to_a_rigid_body_is_that_of_the_whole(&free, entries);
        let mut values = vec![0.0; entries * count];
        values[2 * entries + 1] = f64::NAN;
        refused(0, "velocity", &values, "found NaN for the particle at 2 in memory");
    }
}
