//! Means against exact integrals, and turns where they are.

use super::*;
use crate::scene::expression::Expression;
use std::f64::consts::PI;

/// A load's force by this formula.
fn force(text: &str) -> Expression {
    let scene = format!(
        "space = {{ dimension = \"plane-strain\", cell = 1 }}\ntime.end = 1\n\
         materials.m = {{ density = 1, neo_hookean = {{ young_modulus = 1, poisson_ratio = 0.3 }} }}\n\
         bodies = [{{ name = \"a\", material = \"m\", shape.box = {{ min = [0, 0], max = [1, 1] }} }}]\n\
         loads = [{{ body = \"a\", force = [{text}, 0] }}]\n"
    );
    let scene = crate::scene::parse("test", &scene, &[]).unwrap_or_else(|fault| panic!("{fault}")).scene;
    scene.loads[0].action.values().next().expect("a force").clone()
}

fn close(found: f64, exact: f64, scale: f64) {
    assert!((found - exact).abs() <= 1e-8 * scale, "{found} for {exact}");
}

/// Pulses of 1 N for 3 us within a step of 1 ms, wherever they are: 3e-3 N.
#[test]
fn no_pulse_is_missed() {
    for i in 0..40 {
        let at = 1e-3 * (f64::from(i) + 0.3) / 40.0;
        let pulse = force(&format!("\"if(t > {at:e} s, if(t < {:e} s, 1 N, 0), 0)\"", at + 3e-6));
        let within = (1e-3 - at).min(3e-6);
        close(pulse.over_step(0.0, 1e-3), within / 1e-3, 1.0);
        let table =
            force(&format!("{{ table = [[{at:e}, 0], [{:e}, 1], [{:e}, 0]] }}", at + 1.5e-6, at + 3e-6));
        if within == 3e-6 {
            close(table.over_step(0.0, 1e-3), 1.5e-3, 1e-3);
        }
        // A smooth one of 3 us: its integral is sqrt(pi) w.
        let smooth = force(&format!("\"1 N * exp(-((t - {at:e} s) / 1 us)^2)\""));
        if (5e-6..995e-6).contains(&at) {
            close(smooth.over_step(0.0, 1e-3), PI.sqrt() * 1e-3, 1.0);
        }
    }
}

#[test]
fn means_of_smooth_formulas() {
    let wave = force("\"sin(100 * t)\"");
    close(wave.over_step(0.1, 0.02), (10.0_f64.cos() - 12.0_f64.cos()) / 2.0, 1.0);
    // Sixteen periods in a step: 64 pieces are not enough for the last digits.
    close(wave.over_step(0.0, 1.0), (1.0 - 100.0_f64.cos()) / 100.0, 10.0);
    close(force("\"t^2\"").over_step(1.0, 2.0), 13.0 / 3.0, 9.0);
    close(force("\"1 / (1 + t)\"").over_step(0.0, 1.0), 2.0_f64.ln(), 1.0);
    close(force("\"sqrt(abs(t - 0.5))\"").over_step(0.0, 1.0), 4.0 / 3.0 * 0.5_f64.powf(1.5), 1.0);
    close(force("\"sin(t) / t\"").over_step(0.0, 1.0), 0.946_083_070_367_183, 1.0);
    // Half of the time, by a wave whose sign is asked.
    close(force("\"if(sin(40 * pi * t) > 0, 2 N, 0)\"").over_step(0.0, 0.1), 1.0, 2.0);
    // What is the same in a step is so to the last bit.
    let ramp = force("\"0.3 N * min(t / 1 ms, 1)\"");
    assert_eq!(ramp.over_step(2e-3, 1e-4), 0.3);
    close(ramp.over_step(0.0, 1e-3), 0.15, 0.3);
}

#[test]
fn turns_are_where_they_are() {
    let turns = |text: &str| {
        let value = force(text);
        let mut found = Vec::new();
        while let Some(next) = value.next_turn([found.last().copied().unwrap_or(0.0) + 1e-6, 0.1]) {
            found.push(next);
        }
        found
    };
    for (text, exact) in [
        ("\"if(t > 1 ms, if(t < 1.04 ms, 5 N, 0), 0)\"", vec![1e-3, 1.04e-3]),
        ("\"1 N * min(t / 20 ms, 1)\"", vec![0.02]),
        ("\"if(mod(t, 30 ms) < 10 ms, 1 N, 0)\"", vec![0.01, 0.03, 0.04, 0.06, 0.07, 0.09]),
        ("\"if(sin(50 * pi * t) > 0, 1 N, 0)\"", vec![0.02, 0.04, 0.06, 0.08]),
        ("\"if(t^2 < 0.0025, 1 N, 0)\"", vec![0.05]),
        ("\"sin(50 * pi * t)\"", vec![]),
        ("\"min(t, t)\"", vec![]),
        // A front is somewhere always; when it begins is a turn.
        ("\"if(t > 50 ms, if(x < 3 m/s * t, 1 N, 0), 0)\"", vec![0.05]),
        ("{ table = [[0, 0], [0.03, 1], [0.031, 0]] }", vec![0.03, 0.031]),
    ] {
        let found = turns(text);
        // sin is zero where the search ends, at .1, too.
        let found = found.into_iter().filter(|turn| *turn < 0.099).collect::<Vec<_>>();
        assert_eq!(found.len(), exact.len(), "{text}: {found:?}");
        found
            .iter()
            .zip(&exact)
            .for_each(|(found, exact)| assert!((found - exact).abs() < 1e-11, "{text}: {found}"));
    }
}

/// Steps of 1 ms end at turns, are no shorter than an eighth, and pass over noise.
#[test]
fn steps_end_where_something_turns() {
    let scene = |text: &str| {
        let mut scene = crate::scene::Scene::new(crate::scene::Dimension::Space, 1.0, 1.0);
        scene.gravity =
            crate::scene::Gravity([force(text), Expression::Constant(0.0), Expression::Constant(0.0)]);
        Changes::of(&scene)
    };
    let steps = |text: &str, until: f64| {
        let changes = scene(text);
        let mut ends = vec![0.0];
        while ends.last().is_some_and(|time| *time < until) {
            let time = ends.last().copied().expect("there is a first");
            ends.push(time + changes.step(time, 1e-3));
        }
        ends
    };
    let meets = |ends: &[f64], turn: f64| ends.iter().any(|end| (end - turn).abs() < 1e-12);
    let pulse = steps("{ table = [[0, 0], [3.1e-3, 0], [3.3e-3, 1], [3.5e-3, 0]] }", 0.01);
    assert!([3.1e-3, 3.3e-3, 3.5e-3].iter().all(|turn| meets(&pulse, *turn)), "{pulse:?}");
    assert!(pulse.len() < 15 && pulse.windows(2).all(|ends| ends[1] - ends[0] > 1.2e-4), "{pulse:?}");
    let jump = steps("\"if(t > 3.1 ms, 1, 0)\"", 0.01);
    assert!(meets(&jump, 3.1e-3) && jump.len() < 13, "{jump:?}");
    let noise = steps("\"if(mod(t, 0.01 ms) < 5 us, 1, 0)\"", 0.1);
    // A hundred steps, and one more where they add up to less than a tenth by round-off.
    assert!((101..=102).contains(&noise.len()), "{}", noise.len());
    let slow = steps("\"sin(10 * t)\"", 0.1);
    assert!((101..=102).contains(&slow.len()), "{}", slow.len());
    // Where a turn and the end of what is asked for are one but for round-off, a step ends there.
    let changes = scene("\"if(t > 3.1 ms, 1, 0)\"");
    for rest in [0.5e-3, 0.5e-3 - 1e-15, 0.5e-3 + 1e-15] {
        assert!((changes.step(2.6e-3, rest) - rest).abs() < 1e-14);
    }
    // Four steps a period: halved.
    let fast = steps("\"sin(500 * pi * t)\"", 0.1).len();
    assert!((110..=450).contains(&fast), "{fast}");
    let over = |text: &str| scene(text).passed_over(1e-3, 1.0).next().map(|passing| passing.time);
    assert_eq!(over("{ table = [[0, 0], [0.5, 0], [0.50001, 1], [0.50002, 0]] }"), Some(0.50001));
    assert_eq!(over("{ table = [[0, 0], [0.5, 0], [0.501, 1], [0.502, 0]] }"), None);
    assert_eq!(over("{ table = [[0, 0], [0.5, 0], [0.50001, 1]] }"), None);
    let gauss = over("\"exp(-((t - 0.3) / 1e-5)^2)\"").expect("a pulse of 10 us");
    assert!((gauss - 0.3).abs() < 2e-4, "{gauss}");
    assert!(over("\"sin(1e5 * t)\"").is_some() && over("\"sin(10 * t)\"").is_none());
}
