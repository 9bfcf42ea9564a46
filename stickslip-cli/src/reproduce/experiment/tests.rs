use super::*;
use crate::jobs::{Earlier, JobRunner};
use crate::reproduce::case::{PaperScene, TouchRule};
use crate::reproduce::chain::{self, Chain};
use std::f64::consts::PI;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Young's modulus of the disks goes with frequency as f^0.034 from 5 MHz down, the bulk modulus held, within 0.5 %
/// from 1 kHz to 1 MHz: E' of the Prony series, by G' = G (1 - sum g / (1 + (2 pi f tau)^2)).
#[test]
fn the_disks_are_as_stiff_at_each_frequency_as_was_measured() {
    for place in [Place::Row, Place::Sliding, Place::Glued, Place::Strips, Place::Flats] {
        let scene = as_known(place, 20).job().expect("a scene").loaded.scene;
        let law = serde_json::to_value(scene.materials[0].law).expect("a law is written");
        let law = law.as_object().and_then(|law| law.values().next()).expect("a law with constants").clone();
        let number = |key: &str| law[key].as_f64().expect("a constant");
        let (bulk, shear) = (number("bulk_modulus"), number("shear_modulus"));
        let young = |shear: f64| 9.0 * bulk * shear / (3.0 * bulk + shear);
        let pairs: Vec<[f64; 2]> = serde_json::from_value(law["prony"].clone()).expect("pairs");
        for power in 0..=30 {
            let frequency = 1e3 * 10f64.powf(0.1 * f64::from(power));
            let relaxed = |[share, time]: &[f64; 2]| share / (1.0 + (2.0 * PI * frequency * time).powi(2));
            let storage = young(shear * (1.0 - pairs.iter().map(relaxed).sum::<f64>()));
            let measured = young(shear) * (frequency / 5e6).powf(0.034);
            assert!((storage / measured - 1.0).abs() < 5e-3, "{frequency} Hz: {storage} for {measured}");
        }
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
