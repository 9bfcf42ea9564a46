//! B1: the paper's sphere on an incline.

use super::reasons::{AT_A_DISTANCE, EXTRAPOLATED, PLANE_OF_PARTICLES};
use super::rolling_sphere::roll;
use crate::benchmark::{Allowed, Benchmark, Case, Laws, Miss, Reason, Resolution, Target};
use crate::failure::CaseFailure;
use crate::outcome::Outcome;

pub const BENCHMARK: Benchmark = Benchmark {
    name: "B1",
    title: "Sphere on an incline",
    source: "Bardenhagen et al. (2001), section 3.1, eqs. (23), (24), figures 3 to 6",
    picture: "
          _____
        /       \\            z
       |    o--R-|           |   gravity 10 m/s^2, inclined by pi/4 or pi/3 toward x
        \\ _____ /            |
   ---------+-----------     +---- x, distance down the slope
   /////////////////////
",
    set_up: "scenes/paper/inclined_plane_no_slip.toml and inclined_plane_slip.toml: R = 1.6 m, halved by a plane of \
symmetry; neo-Hookean, K = 6 MPa, G = 3 MPa, on a plane ten times as stiff and dense; 8 particles a cell; 2 s.",
    exact: "A rigid sphere: x = (25 sqrt 2/14) t^2 without slip, (5/2)(sqrt 3 - 2/7) t^2 with slip. Hertz lets the \
centre stand at R - (9 F^2/(16 R E*^2))^(1/3), with E* = 7.64 MPa 1.555 m and 1.565 m. Static contact radius: R/6.",
    laws: Laws::Contact,
    measure: "R/h",
    resolutions: &[Resolution::quick(4.0), Resolution::full(8.0)],
    targets: &[
        Target::new("x, rolling", 1.0, Allowed::Within(0.05), "cells of R/4 do not resolve a contact of R/6")
            .at(4.0),
        Target::new(
            "x, slipping",
            1.0,
            Allowed::Within(0.05),
            "cells of R/4 do not resolve a contact of R/6",
        )
        .at(4.0),
        Target::new("x, rolling", 1.0, Allowed::Within(0.01), FINE).at(8.0),
        Target::new("v, rolling", 1.0, Allowed::Within(0.02), FINE).at(8.0),
        Target::new(
            "acceleration, rolling",
            1.0,
            Allowed::Within(0.03),
            "the second half shows a drift that the start hides",
        )
        .at(8.0),
        Target::new(
            "height less Hertz, rolling [cells]",
            0.0,
            Allowed::Within(0.1),
            "a contact at a distance holds the sphere high",
        )
        .at(8.0),
        Target::new(
            "spin R/v, rolling",
            1.0,
            Allowed::Within(0.02),
            "the angle turned over the way in the second half: rolling is rolling",
        )
        .at(8.0)
        .missed(&[Miss { cells: 8.0, off: 0.06 }]),
        Target::new("x, slipping", 1.0, Allowed::Within(0.01), FINE).at(8.0),
        Target::new("v, slipping", 1.0, Allowed::Within(0.02), FINE).at(8.0),
        Target::new(
            "acceleration, slipping",
            1.0,
            Allowed::Within(0.03),
            "the second half shows a drift that the start hides",
        )
        .at(8.0),
        Target::new(
            "height less Hertz, slipping [cells]",
            0.0,
            Allowed::Within(0.1),
            "a contact at a distance holds the sphere high",
        )
        .at(8.0),
    ],
    reasons: &[
        AT_A_DISTANCE,
        EXTRAPOLATED,
        PLANE_OF_PARTICLES,
        Reason {
            laws: &["surface"],
            text: "A soft sphere does not roll as a rigid one: the spin is the elastic sphere's. Friction that \
drives it lets it creep, by Kalker's linear theory by Q/(G a^2 C11) = 0.021 of its speed (Q/P = 2/7, a = R/6, C11 = \
4.3, G = 5.5 MPa for both bodies), more where part of the patch slips, while its surface, shorter by 0.02 under \
Hertz's pressure, turns it faster. R/8 gives 0.960.",
        },
    ],
    run,
};

const FINE: &str = "the soft sphere follows the rigid one but for its settling";

fn run(case: &Case) -> Result<Outcome, CaseFailure> {
    let mut outcome = Outcome::default();
    let rolling = roll(
        "rolling",
        include_str!("../../../scenes/paper/inclined_plane_no_slip.toml"),
        case,
        &mut outcome,
    )?;
    let slipping =
        roll("slipping", include_str!("../../../scenes/paper/inclined_plane_slip.toml"), case, &mut outcome)?;
    outcome.measure("x, rolling", rolling.distance);
    outcome.measure("v, rolling", rolling.speed);
    outcome.measure("acceleration, rolling", rolling.acceleration);
    outcome.measure("height less Hertz, rolling [cells]", (rolling.height - 1.555) / rolling.cell);
    outcome.measure("spin R/v, rolling", rolling.rolling);
    outcome.measure("x, slipping", slipping.distance);
    outcome.measure("v, slipping", slipping.speed);
    outcome.measure("acceleration, slipping", slipping.acceleration);
    outcome.measure("height less Hertz, slipping [cells]", (slipping.height - 1.565) / slipping.cell);
    Ok(outcome)
}
