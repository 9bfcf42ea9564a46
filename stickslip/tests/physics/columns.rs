//! Columns that are looked at where they lie.
//!
//! Set-up: two balls of metal, one of which turns and flies so fast that it flows and its particles are sorted anew, in
//! space and in the plane, in double and single precision.
//!
//! Expected: by its name each column of a body is that of the snapshot, bit for bit; what the plane does not leave free
//! is zero; a name that is unknown is refused with those that are known.

use stickslip::{scene, step};

fn balls(dimension: &str, precision: &str) -> String {
    let v = |x: &str| if dimension == "3d" { format!("[{x}, 0]") } else { format!("[{x}]") };
    format!(
        r#"
        space = {{ dimension = "{dimension}", cell = 0.1, precision = "{precision}" }}
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
