//! Values out of range.

use crate::{MINIMAL, check, message};

#[test]
fn a_start_at_a_time_that_is_none_or_of_a_file() {
    check(
        MINIMAL,
        &[
            (
                "[time]",
                "[start]\nfrom = \"packing.results\"\nat = -1\n[time]",
                "7:6: start.at: found -1; allowed: a time [s] of 0 or more, like \"0.3 s\"",
            ),
            (
                "[time]",
                "[start]\nfrom = \"packing.results\"\nat = \"1 m\"\n[time]",
                "7:6: start.at: found \"1 m\", a length [m]; allowed: a time [s], like \"2.5 ms\"",
            ),
            (
                "[time]",
                "[start]\nfrom = \"packing.results/particles/00003.vtu\"\nat = 1\n[time]",
                "7:6: start.at: found 1; allowed: a time beside a folder of results: `from` names one of its files",
            ),
        ],
    );
}

#[test]
fn values_out_of_range() {
    check(
        MINIMAL,
        &[
            (
                "\"0.1 m\"",
                "\"-0.1 m\"",
                "3:8: space.cell: found \"-0.1 m\"; allowed: a length [m] above 0, like \"0.4 m\"",
            ),
            (
                "\"0.1 m\"",
                "1\ninterior = \"referense\"",
                "4:12: space.interior: found \"referense\"; allowed: \"grid\", \"reference\" or \"auto\"; did you mean `reference`?",
            ),
            (
                "\"0.1 m\"",
                "1\nbasis = \"cubik\"",
                "4:9: space.basis: found \"cubik\"; allowed: \"gimp\", \"linear\", \"spline\" or \"cubic\"; did you mean `cubic`?",
            ),
            (
                "\"0.1 m\"",
                "1\nbasis = \"CPDI\"",
                "4:9: space.basis: found \"CPDI\"; allowed: \"gimp\", \"linear\", \"spline\" or \"cubic\"; here: no domains that deform; bodies that stay whole stretch, turn and bend without them on grids of their own, interior = \"reference\", the default of elastic ones: leave `basis` out",
            ),
            (
                "radius = \"0.4 m\" }",
                "radius = \"0.4 m\" }\ninterior = \"mesh\"",
                "16:12: bodies[0].interior: found \"mesh\"; allowed: \"grid\" or \"reference\"",
            ),
            (
                "radius = \"0.4 m\" }",
                "radius = 1 }\n[[contact]]\nfriction_memory_length = 1\nfriction_memory_speed = 0",
                "18:25: contact[0].friction_memory_speed: found 0; allowed: a velocity [m/s] above 0, like \"5 m/s\"",
            ),
            (
                "radius = \"0.4 m\" }",
                "radius = 1 }\nspin = [0, 0, \"2 kHz\"]",
                "16:15: bodies[0].spin[2]: found \"2 kHz\", of which nobody knows whether it counts turns or radians; allowed: \"rad/s\", \"rpm\" or \"1/s\"",
            ),
            (
                "radius = \"0.4 m\" }",
                "radius = 1 }\n[[contact]]\nfriction = \"30 deg\"",
                "17:12: contact[0].friction: found \"30 deg\"; allowed: a coefficient: the tangent of an angle, \"tan(30 deg)\"",
            ),
            ("\"0.1 m\"", "0", "3:8: space.cell: found 0; allowed: a length [m] above 0, like \"0.4 m\""),
            (
                "\"0.4 m\"",
                "\"1 m - 2 m\"",
                "15:45: bodies[0].shape.ball.radius: found \"1 m - 2 m\", which is -1 m; allowed: a length [m] above 0, like \"0.4 m\"",
            ),
            (
                "\"1 s\"",
                "1\ncourant = 1.5",
                "7:11: time.courant: found 1.5; allowed: a number above 0 and up to 1",
            ),
            (
                "\"1 s\"",
                "1\npic_share = -0.1",
                "7:13: time.pic_share: found -0.1; allowed: a number from 0 to 1",
            ),
            (
                "\"1 s\"",
                "1\nrelax = { residual = 1 }",
                "7:22: time.relax.residual: found 1; allowed: a number above 0 and below 1",
            ),
            (
                "\"1 s\"",
                "1\nrelax = { residuum = 0.1 }",
                "7:11: time.relax.residuum: found unknown key `residuum`; allowed: residual; did you mean `residual`?",
            ),
            (
                "[time]",
                "[damping]\nviscous = -1\n[time]",
                "6:11: damping.viscous: found -1; allowed: a rate [1/s] from 0 on",
            ),
            (
                "[time]",
                "[damping]\nviscous = \"1 s\"\n[time]",
                "6:11: damping.viscous: found \"1 s\", a time [s]; allowed: a rate [1/s], like \"1 / 0.2 s\"",
            ),
            (
                "[time]",
                "[damping]\nlocal = 1\n[time]",
                "6:9: damping.local: found 1; allowed: a number from 0 to below 1",
            ),
            (
                "[time]",
                "[damping]\nglobal = 1\n[time]",
                "6:1: damping.global: found unknown key `global`; allowed: viscous, local, bulk_linear, bulk_quadratic; did you mean `local`?",
            ),
            (
                "\"1 s\"",
                "1\nmax_step = 0",
                "7:12: time.max_step: found 0; allowed: a time [s] above 0, like \"2.5 ms\"",
            ),
            (
                "[time]",
                "particles_per_side = 9\n[time]",
                "5:22: space.particles_per_side: found 9; allowed: a whole number from 1 to 8",
            ),
            (
                "[time]",
                "particles_per_side = 1.5\n[time]",
                "5:22: space.particles_per_side: found 1.5; allowed: a whole number from 1 to 8",
            ),
            (
                "[time]",
                "domain = { min = [0, 0, 0], max = [1, 1, 1], leaving = \"go\" }\n[time]",
                "5:56: space.domain.leaving: found \"go\"; allowed: \"stop\" or \"remove\"",
            ),
            (
                "[time]",
                "domain = { min = [0, 0, 0], max = [1, 0, 1] }\n[time]",
                "5:39: space.domain.max[1]: found 0; allowed: more than 0 m, the y of min",
            ),
            (
                "\"1000 kg/m^3\"",
                "-1",
                "9:11: materials.rubber.density: found -1; allowed: a density [kg/m^3] above 0, like \"1000 kg/m^3\"",
            ),
            (
                "\"3 MPa\"",
                "\"-3 MPa\"",
                "10:57: materials.rubber.neo_hookean.shear_modulus: found \"-3 MPa\" (-3000000 Pa); allowed: at least 0",
            ),
            (
                ", shear_modulus = \"3 MPa\"",
                "",
                "10:1: materials.rubber.neo_hookean: found bulk_modulus; allowed: two of bulk_modulus, shear_modulus, young_modulus, poisson_ratio, p_wave_modulus (not E with M)",
            ),
            (
                "material = \"rubber\"",
                "material = \"ruber\"",
                "14:12: bodies[0].material: found \"ruber\"; allowed: the name of a material (\"rubber\"); did you mean `rubber`?",
            ),
            (
                "neo_hookean = ",
                "neohookean = ",
                "10:1: materials.rubber.neohookean: found unknown key `neohookean`; allowed: density, volume_change, thermal_expansion, LAWS, outside; did you mean `neo_hookean`?",
            ),
            (
                "neo_hookean = ",
                "von_mises = ",
                "10:1: materials.rubber.von_mises: found no yield_stress; allowed: yield_stress, a positive number, like \"40 MPa\"",
            ),
            (
                "neo_hookean = { ",
                "von_mises = { yield_stress = \"1 MPa\", hardening_modulus = \"-1 MPa\", ",
                "10:59: materials.rubber.von_mises.hardening_modulus: found \"-1 MPa\" (-1000000 Pa); allowed: at least 0, for softening would follow the grid",
            ),
            (
                "neo_hookean = ",
                "viscoelastic = ",
                "10:1: materials.rubber.viscoelastic: found no prony; allowed: prony, a list of pairs [share, time], like [[0.5, \"10 ms\"]]",
            ),
            (
                "neo_hookean = { ",
                "viscoelastic = { prony = [[0.5, \"10 ms\"], [1.5, \"1 s\"]], ",
                "10:26: materials.rubber.viscoelastic.prony: found [[0.5, \"10 ms\"], [1.5, \"1 s\"]] (share 1.5); allowed: share above 0 and below 1",
            ),
            (
                "neo_hookean = { ",
                "viscoelastic = { prony = [[0.5, \"10 mm\"]], ",
                "10:33: materials.rubber.viscoelastic.prony[0][1]: found \"10 mm\", a length [m]; allowed: a time [s], like \"2.5 ms\"",
            ),
            (
                "neo_hookean = { ",
                "damage = { tensile_strength = \"1 MPa\", fracture_energy = \"-1 J/m^2\", ",
                "10:58: materials.rubber.damage.fracture_energy: found \"-1 J/m^2\" (-1 J/m^2); allowed: a positive number",
            ),
            (
                "neo_hookean = { ",
                "damage = { tensile_strength = 1, fracture_energy = 1, criterion = \"rankin\", ",
                "10:67: materials.rubber.damage.criterion: found \"rankin\"; allowed: \"rankine\" or \
                 \"modified-von-mises\"; did you mean `rankine`?",
            ),
            (
                "neo_hookean = { ",
                "damage = { tensile_strength = 1, fracture_energy = 1, criterion = \"rankine\", strength_ratio = 9, ",
                "10:95: materials.rubber.damage.strength_ratio: found 9; allowed: no strength_ratio with criterion = \
                 \"rankine\", by which nothing is crushed; \"modified-von-mises\" has one",
            ),
            (
                "neo_hookean = { ",
                "drucker_prager = { friction_angle = 30, ",
                "10:37: materials.rubber.drucker_prager.friction_angle: found 30 (30 rad); allowed: at least 0 and below \
                 1.5707963267948966 rad, a right angle; degrees have their unit",
            ),
            (
                "neo_hookean = { ",
                "mohr_coulomb = { friction_angle = \"30 kPa\", ",
                "10:35: materials.rubber.mohr_coulomb.friction_angle: found \"30 kPa\", a pressure [Pa]; allowed: an angle \
                 [rad], like \"30 deg\"",
            ),
            (
                "neo_hookean = { ",
                "drucker_prager = { friction_angle = \"20 deg\", dilation_angle = \"30 deg\", ",
                "10:64: materials.rubber.drucker_prager.dilation_angle: found \"30 deg\" (0.5235987755982988 rad); \
                 allowed: at most the friction_angle, 0.3490658503988659 rad, else flow would give energy instead of \
                 taking it",
            ),
            (
                "neo_hookean = ",
                "#",
                "8:12: materials.rubber: found no law; allowed: a law (LAWS), like neo_hookean = { bulk_modulus = \"6 MPa\", shear_modulus = \"3 MPa\" }",
            ),
            (
                "shear_modulus",
                "sheer_modulus",
                "10:41: materials.rubber.neo_hookean.sheer_modulus: found unknown key `sheer_modulus`; allowed: bulk_modulus, shear_modulus, young_modulus, poisson_ratio, p_wave_modulus; did you mean `shear_modulus`?",
            ),
        ],
    );
    let none = MINIMAL.split("[[bodies]]").next().unwrap();
    assert_eq!(
        message(&format!("bodies = []\n{none}")),
        "a.toml:1:10: bodies: found no body; allowed: at least one [[bodies]], [[packings]], [[images]] or [[point_clouds]]"
    );
}
