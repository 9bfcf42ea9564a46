//! What is run for the report, how finely, and what came of it.

use crate::jobs::{Job, Outcomes};
use stickslip::observe::Results;
use stickslip::scene::SceneError;

/// How finely everything is resolved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PaperResolution {
    /// As coarse as anything runs: shows that the report works, not what the method can do.
    Sketch,
    /// Minutes on two cores.
    Quick,
    /// The paper's own resolution, and finer for convergence: hours on two cores.
    Full,
}

/// A scene of the paper with its settings.
#[derive(Clone, Debug, PartialEq)]
pub struct PaperCase {
    /// Name of the run and its folder: `backspin-traction-4`.
    pub name: String,
    scene: PaperScene,
    settings: Vec<(String, String)>,
}

/// A scene of the paper or of its experiment, which the program carries with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaperScene {
    name: &'static str,
    text: &'static str,
}

/// The scene `scenes/FOLDER/NAME.toml`.
macro_rules! paper_scene {
    ($folder:literal, $name:literal) => {
        PaperScene {
            name: $name,
            text: include_str!(concat!("../../../scenes/", $folder, "/", $name, ".toml")),
        }
    };
}

impl PaperScene {
    pub const NO_SLIP: Self = paper_scene!("paper", "inclined_plane_no_slip");
    pub const SLIP: Self = paper_scene!("paper", "inclined_plane_slip");
    pub const BACKSPIN: Self = paper_scene!("paper", "backspin");
    pub const COLLINEAR: Self = paper_scene!("paper", "disks_collinear");
    pub const ZIGZAG: Self = paper_scene!("paper", "disks_zigzag");
    pub const GLUED: Self = paper_scene!("paper", "disks_glued");
    pub const PLEXIGLAS_ROW: Self = paper_scene!("experiment", "plexiglas_row");
    pub const PLEXIGLAS_SLIDING: Self = paper_scene!("experiment", "plexiglas_sliding");
    pub const PLEXIGLAS_GLUED: Self = paper_scene!("experiment", "plexiglas_glued");
    pub const PLEXIGLAS_STRIPS: Self = paper_scene!("experiment", "plexiglas_strips");
    pub const PLEXIGLAS_FLATS: Self = paper_scene!("experiment", "plexiglas_flats");
    pub const PLEXIGLAS_SLIDING_FLATS: Self = paper_scene!("experiment", "plexiglas_sliding_flats");
    pub const PLEXIGLAS_PLATE: Self = paper_scene!("experiment", "plexiglas_plate");
}

/// Which bodies count as touching.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TouchRule {
    /// The one before the paper's, of 2000.
    Kinematic,
    /// The paper's of 2001.
    Traction,
    /// Stickslip's default.
    Surface,
}

/// What came of the runs.
pub struct Runs(Outcomes);

/// A run without results.
pub struct FailedRun<'a> {
    /// Its name.
    pub name: &'a str,
    /// What went wrong.
    pub error: &'a str,
}

impl PaperResolution {
    /// What it means, for the reader of the report.
    pub fn explanation(self) -> &'static str {
        match self {
            PaperResolution::Sketch => "a sketch: far too coarse to mean anything",
            PaperResolution::Quick => {
                "quick: coarser than the paper; run without --quick for the paper's own resolution"
            }
            PaperResolution::Full => "full: the paper's own resolution, and finer",
        }
    }
}

impl PaperCase {
    /// A scene with settings, as `stickslip run --set` takes them; `label` tells it from others of the same scene.
    pub fn new(scene: PaperScene, label: &str, settings: &[(&str, &str)]) -> Self {
        let settings = settings.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
        PaperCase { name: format!("{}-{label}", scene.name), scene, settings }
    }

    /// The same with one more word in its name.
    pub fn labelled(self, label: &str) -> Self {
        PaperCase { name: format!("{}-{label}", self.name), ..self }
    }

    /// The case, ready to be run.
    ///
    /// # Errors
    /// A setting does not fit the scene.
    pub fn job(self) -> Result<Job, SceneError> {
        let file = format!("{}.toml", self.scene.name);
        let loaded = stickslip::scene::parse(&file, self.scene.text, &self.settings)?;
        Ok(Job { name: self.name, loaded, source: None })
    }
}

impl TouchRule {
    /// The two that everything is run with, the paper's first.
    pub const BOTH: [TouchRule; 2] = [TouchRule::Traction, TouchRule::Surface];

    /// What chooses it in the paper's scenes. The paper has FLIP; Stickslip's own law goes with its own transfer.
    pub fn settings(self) -> [(&'static str, &'static str); 2] {
        let transfer = if self == TouchRule::Surface { "rflip" } else { "flip" };
        [("contact", self.word()), ("time.transfer", transfer)]
    }

    /// Its word in scenes.
    pub fn word(self) -> &'static str {
        match self {
            TouchRule::Kinematic => "kinematic",
            TouchRule::Traction => "traction",
            TouchRule::Surface => "surface",
        }
    }

    /// Its name in tables.
    pub fn short(self) -> &'static str {
        match self {
            TouchRule::Kinematic => "kinematic (older)",
            TouchRule::Traction => "traction (paper)",
            TouchRule::Surface => "surface (default)",
        }
    }

    /// Its name in sentences.
    pub fn title(self) -> &'static str {
        match self {
            TouchRule::Kinematic => "the rule before the paper's (kinematic)",
            TouchRule::Traction => "the paper's rule (traction)",
            TouchRule::Surface => "Stickslip's default (surface)",
        }
    }
}

impl Runs {
    /// What came of jobs.
    pub fn new(outcomes: Outcomes) -> Self {
        Runs(outcomes)
    }

    /// Results of a case, if it was run and did not fail.
    pub fn get(&self, case: &PaperCase) -> Option<&Results> {
        self.0.get(&case.name)?.as_ref().ok()
    }

    /// Names and results of all runs that did not fail.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Results)> {
        self.0.iter().filter_map(|(name, outcome)| Some((name.as_str(), outcome.as_ref().ok()?)))
    }

    /// The runs that failed.
    pub fn failures(&self) -> Vec<FailedRun<'_>> {
        let failed = self.0.iter().filter_map(|(name, outcome)| {
            let error = outcome.as_ref().err()?;
            Some(FailedRun { name, error })
        });
        failed.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::STUDIES;

    #[test]
    fn every_case_of_every_level_is_a_scene() {
        for level in [PaperResolution::Sketch, PaperResolution::Quick, PaperResolution::Full] {
            for case in STUDIES.iter().flat_map(|study| study.cases(level)) {
                let name = case.name.clone();
                case.job().unwrap_or_else(|error| panic!("{name}: {error}"));
            }
        }
    }

    #[test]
    fn cases_of_one_name_are_one_case() {
        let cases: Vec<PaperCase> =
            STUDIES.iter().flat_map(|study| study.cases(PaperResolution::Full)).collect();
        for (i, case) in cases.iter().enumerate() {
            assert!(cases[..i].iter().all(|other| other.name != case.name || other == case), "{}", case.name);
        }
    }
}
