//! What a run watches.

use crate::{MINIMAL, check};
use stickslip_scene::scene::{self, HealthCheck, Response};

#[test]
fn mistakes_in_health() {
    let health = |rest: &str| format!("[health]\n{rest}\n[time]");
    let cases = [
        (
            "enrgy = \"stop\"",
            "6:1: health.enrgy: found unknown key `enrgy`; allowed: KEYS; did you mean `energy`?",
        ),
        (
            "energy = \"halt\"",
            "6:10: health.energy: found \"halt\"; allowed: \"warn\", \"stop\", \"cut-step\", \"record\" or \"ignore\"",
        ),
        (
            "energy = 0.1",
            "6:10: health.energy: found 0.1; allowed: \"warn\", \"stop\", \"cut-step\", \"record\" or \"ignore\", or a table with the keys then, bound",
        ),
        ("energy = { bound = 0 }", "6:20: health.energy.bound: found 0; allowed: a number above 0"),
        (
            "energy = { limit = 1 }",
            "6:12: health.energy.limit: found unknown key `limit`; allowed: then, bound",
        ),
        (
            "tearing = { then = \"stop\", bound = 0.1 }",
            "6:36: health.tearing.bound: found 0.1; allowed: `then` alone: this check has no bound",
        ),
        (
            "noise = \"cut-step\"",
            "6:9: health.noise: found \"cut-step\"; allowed: \"cut-step\" for `energy` and `momentum` only; \"warn\", \"stop\", \"record\" or \"ignore\"",
        ),
        (
            "default = \"cut-step\"",
            "6:11: health.default: found \"cut-step\"; allowed: \"cut-step\" for `energy` and `momentum` only; \"warn\", \"stop\", \"record\" or \"ignore\"",
        ),
        ("retries = 21", "6:11: health.retries: found 21; allowed: a whole number from 0 to 20"),
        ("retries = 1.5", "6:11: health.retries: found 1.5; allowed: a whole number from 0 to 20"),
    ];
    let mut keys = vec!["default".to_string()];
    keys.extend(HealthCheck::ALL.map(|check| check.word().replace('-', "_")));
    keys.push("retries".to_string());
    for (rest, expected) in cases {
        check(MINIMAL, &[("[time]", &health(rest), &expected.replace("KEYS", &keys.join(", ")))]);
    }
}

#[test]
fn a_scene_says_what_each_check_does() {
    let text = MINIMAL.replacen(
        "[time]",
        "[health]\ndefault = \"ignore\"\nenergy = { then = \"stop\", bound = 0.01 }\nspeed = { bound = 0.1 }\n[time]",
        1,
    );
    let set = [("time.energy_drift".to_string(), "0.3".to_string())];
    let scene = scene::parse("a.toml", &text, &set).expect("a scene").scene;
    let said = |check| (scene.health.response(check), scene.health_bound(check));
    assert_eq!(said(HealthCheck::Energy), (Response::Stop, 0.01));
    assert_eq!(said(HealthCheck::Noise), (Response::Ignore, 0.15));
    assert_eq!(said(HealthCheck::Speed), (Response::Ignore, 0.1));
    assert_eq!(said(HealthCheck::Tearing), (Response::Ignore, f64::INFINITY));
    assert_eq!(said(HealthCheck::Contact), (Response::Ignore, f64::INFINITY));
    let plain = scene::parse("a.toml", MINIMAL, &set).expect("a scene").scene;
    assert_eq!(plain.health.response(HealthCheck::Speed), Response::Warn);
    assert_eq!(plain.health.response(HealthCheck::Contact), Response::Record);
    let strict = MINIMAL.replacen("[time]", "[health]\ndefault = \"stop\"\nspeed = \"warn\"\n[time]", 1);
    let strict = scene::parse("a.toml", &strict, &[]).expect("a scene").scene.health;
    assert_eq!(strict.response(HealthCheck::Contact), Response::Stop);
    assert_eq!(strict.response(HealthCheck::Speed), Response::Warn);
    assert_eq!(plain.health_bound(HealthCheck::Energy), 0.3);
    let cutting = "[health]\nenergy = \"cut-step\"\nmomentum = { then = \"cut-step\", bound = 0.1 }\n[time]";
    let cutting =
        scene::parse("a.toml", &MINIMAL.replacen("[time]", cutting, 1), &[]).expect("a scene").scene;
    assert_eq!(cutting.health.response(HealthCheck::Momentum), Response::CutStep);
    assert_eq!(cutting.health_bound(HealthCheck::Momentum), 0.1);
}
