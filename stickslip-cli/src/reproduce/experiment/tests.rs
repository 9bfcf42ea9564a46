use super::*;
use crate::jobs::{Earlier, JobRunner};
use crate::reproduce::case::{PaperScene, TouchRule};
use crate::reproduce::chain::{self, Chain};
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// G of the disks over frequency [Pa], elastic and lost, of a Prony series, and K.
fn shear_of(case: PaperCase) -> (f64, impl Fn(f64) -> [f64; 2]) {
    let scene = case.job().expect("a scene").loaded.scene;
    let law = serde_json::to_value(scene.materials[0].law).expect("a law is written");
    let law = law.as_object().and_then(|law| law.values().next()).expect("a law with constants").clone();
    let [bulk, shear] = ["bulk_modulus", "shear_modulus"].map(|key| law[key].as_f64().expect("a constant"));
    let pairs: Vec<[f64; 2]> = serde_json::from_value(law["prony"].clone()).expect("pairs");
    let shear = move |frequency: f64| {
        // G (1 - sum g / (1 + i w tau))
        let relaxed = |[share, time]: &[f64; 2]| {
            let turns = 2.0 * PI * frequency * time;
            [share / (1.0 + turns * turns), share * turns / (1.0 + turns * turns)]
        };
        let sum = |part: usize| pairs.iter().map(|pair| relaxed(pair)[part]).sum::<f64>();
        [shear * (1.0 - sum(0)), shear * sum(1)]
    };
    (bulk, shear)
}

/// 9 K G / (3 K + G)
fn young(bulk: f64, shear: f64) -> f64 {
    9.0 * bulk * shear / (3.0 * bulk + shear)
}

/// Young's modulus of the disks goes with frequency as f^0.034 from 5 MHz down, the bulk modulus held, within 0.5 %
/// from 1 kHz to 1 MHz.
#[test]
fn the_disks_are_as_stiff_at_each_frequency_as_was_measured() {
    for place in Place::ALL {
        let (bulk, shear) = shear_of(as_known(place, 20));
        let fast = young(bulk, shear(1e15)[0]);
        for power in 0..=30 {
            let frequency = 1e3 * 10f64.powf(0.1 * f64::from(power));
            let storage = young(bulk, shear(frequency)[0]);
            let measured = fast * (frequency / 5e6).powf(0.034);
            assert!((storage / measured - 1.0).abs() < 5e-3, "{frequency} Hz: {storage} for {measured}");
        }
    }
}

/// Where losses fall to what ultrasound has, E''/E' is between 0.011 and 0.014 at 1.6 MHz, and falls with frequency.
#[test]
fn losses_fall_to_those_of_ultrasound() {
    let unknown = UNKNOWNS.iter().find(|unknown| unknown.settings[..] == [("losses", "0.24")]).expect("one");
    for &place in unknown.places {
        let (bulk, shear) = shear_of(unknown.case(place, 20));
        // E' and E'' of K and a complex G, by the derivative of E for the small part of it.
        let loss = |frequency: f64| {
            let [stored, lost] = shear(frequency);
            let slope = (young(bulk, 1.001 * stored) - young(bulk, stored)) / (0.001 * stored);
            slope * lost / young(bulk, stored)
        };
        let [slow, between, fast] = [1.6e3, 1.6e5, 1.6e6].map(loss);
        assert!(slow > between && between > fast, "{slow} {between} {fast}");
        assert!((0.011..0.014).contains(&fast), "{fast}");
    }
}

/// The first step of the ladder is the paper's simulation: its waves come to the disks when they do in the scene that
/// the other studies run. The laws differ by the square of the strain, 6e-4, and nothing relaxes.
#[test]
fn the_ladder_begins_with_the_papers_own_simulation() {
    let folder = tempfile::tempdir().expect("a folder");
    let stop = Arc::new(AtomicBool::new(false));
    let runner = JobRunner { folder: folder.path().to_path_buf(), threads: 2, stop, earlier: Earlier::Keep };
    let cases = [
        Ingredient::case(0, Place::Row, 20),
        chain::case(PaperScene::COLLINEAR, TouchRule::Traction, 20, &[]),
    ];
    let jobs: Vec<_> = cases.iter().map(|case| case.clone().job().expect("a scene")).collect();
    let runs = Runs::new(runner.work(&jobs).unwrap_or_else(|_| panic!("runs")));
    let [ours, paper] = cases.map(|case| {
        let results = runs.get(&case).expect("it ran");
        Chain::new(results).expect("a chain").arrivals().unwrap_or_default()
    });
    assert_eq!((ours.len(), paper.len()), (4, 4));
    for (ours, paper) in ours.iter().zip(&paper) {
        let [ours, paper] = [ours, paper].map(|time| time.expect("it came"));
        // Samples are a hundredth of a transit apart here, a step there.
        assert!((ours - paper).abs() < 0.02, "{ours} for {paper}");
    }
}

#[test]
fn every_unknown_is_somewhere() {
    for unknown in &UNKNOWNS {
        let mut arrangements: Vec<usize> =
            unknown.places.iter().map(|place| place.arrangement_index()).collect();
        let places = arrangements.len();
        arrangements.dedup();
        assert!(places > 0 && arrangements.len() == places, "{}: one place an arrangement", unknown.title);
    }
}
