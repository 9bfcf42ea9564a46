//! What a benchmark is: its report, its targets, its resolutions.

use crate::failure::CaseFailure;
use crate::outcome::Outcome;
use crate::scheme::Scheme;
use stickslip::scene::ContactLaw;

/// A problem with a known answer.
#[derive(Debug)]
pub struct Benchmark {
    /// Short name: `B5`.
    pub name: &'static str,
    /// What it is, in a few words.
    pub title: &'static str,
    /// Where problem and answer come from.
    pub source: &'static str,
    /// A sketch in characters.
    pub picture: &'static str,
    /// Geometry, materials, loads, discretisation.
    pub set_up: &'static str,
    /// The exact answer.
    pub exact: &'static str,
    /// Which laws it can be put to.
    pub laws: Laws,
    /// What [`Resolution::cells`] counts: `"L/h"`.
    pub measure: &'static str,
    /// From coarse to fine.
    pub resolutions: &'static [Resolution],
    /// What is asked of the measured quantities.
    pub targets: &'static [Target],
    /// Why laws miss targets, as far as it is known.
    pub reasons: &'static [Reason],
    /// Runs it.
    pub run: fn(&Case) -> Result<Outcome, CaseFailure>,
}

/// Why some laws or schemes miss a benchmark's targets.
#[derive(Clone, Copy, Debug)]
pub struct Reason {
    /// The words of the laws or schemes.
    pub laws: &'static [&'static str],
    /// What keeps them from it.
    pub text: &'static str,
}

/// Which laws a benchmark can be put to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Laws {
    /// All that there are, even that by which bodies pass through each other.
    All,
    /// All by which bodies touch and part.
    Contact,
    /// Only the law that joins bodies for good.
    Glued,
    /// None: the step itself is asked, so its schemes vary; bodies that touch do so by the law of scenes that name
    /// none.
    Bulk,
}

/// Cells on the benchmark's length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Number of cells.
    pub cells: f64,
    /// The tier from which on it runs.
    pub tier: Tier,
}

/// How much is run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// All benchmarks within minutes.
    Quick,
    /// Every resolution.
    Full,
}

/// What is asked of one measured quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// Name of the quantity.
    pub metric: &'static str,
    /// Its exact value.
    pub exact: f64,
    /// What may be measured.
    pub allowed: Allowed,
    /// The resolution that the target is stated for; at others it is not judged. `None`: at each.
    pub at: Option<f64>,
    /// Why that much and no less.
    pub why: &'static str,
    /// Where the law or scheme of scenes that name none is known to miss it, and by how much at the most; any other
    /// miss is a fault of the program.
    pub misses: &'static [Miss],
}

/// A known miss, and how far it may go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Miss {
    /// The resolution.
    pub cells: f64,
    /// How far from the exact value it may be: what was measured and half as much again, if the benchmark has no reason
    /// for more.
    pub off: f64,
}

/// What may be measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    /// The exact value, give or take.
    Within(f64),
    /// No less than this.
    AtLeast(f64),
    /// No more than this.
    AtMost(f64),
    /// From the first to the second, both included.
    Between(f64, f64),
}

/// One law by one scheme at one resolution.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The law's word in scene files; that of scenes which name none where schemes vary.
    pub law: &'static str,
    /// Where bodies that deform are computed: `grid`, or `reference` for grids of their own.
    pub interior: &'static str,
    /// The scheme of the step; that of scenes which name none where laws vary, and nothing on grids of their own.
    pub scheme: &'static Scheme,
    /// Cells on the benchmark's length.
    pub cells: f64,
    /// How much is run.
    pub tier: Tier,
}

impl Benchmark {
    /// The resolutions that a tier runs.
    pub fn due(&self, tier: Tier) -> impl Iterator<Item = &'static Resolution> {
        self.resolutions.iter().filter(move |resolution| resolution.tier <= tier)
    }

    /// Why a law or a scheme misses targets, if that is known.
    pub fn reasons(&self, word: &str) -> impl Iterator<Item = &'static str> {
        self.reasons.iter().filter(move |reason| reason.laws.contains(&word)).map(|reason| reason.text)
    }
}

impl Laws {
    /// Whether a law is one of these.
    pub fn contains(self, law: ContactLaw) -> bool {
        match self {
            Laws::All => true,
            Laws::Contact => !matches!(law, ContactLaw::None | ContactLaw::Glued),
            Laws::Glued => law == ContactLaw::Glued,
            Laws::Bulk => false,
        }
    }
}

impl Resolution {
    /// Runs in every tier.
    pub const fn quick(cells: f64) -> Self {
        Resolution { cells, tier: Tier::Quick }
    }

    /// Runs in the full tier only.
    pub const fn full(cells: f64) -> Self {
        Resolution { cells, tier: Tier::Full }
    }
}

impl Target {
    /// A target at every resolution.
    pub const fn new(metric: &'static str, exact: f64, allowed: Allowed, why: &'static str) -> Self {
        Target { metric, exact, allowed, at: None, why, misses: &[] }
    }

    /// The same target, stated for one resolution.
    pub const fn at(self, cells: f64) -> Self {
        Target { at: Some(cells), ..self }
    }

    /// The same target, known to be missed by the law or scheme of scenes that name none.
    pub const fn missed(self, misses: &'static [Miss]) -> Self {
        Target { misses, ..self }
    }

    /// Whether a value that misses the target is as far off as one of the known misses at this resolution, and no
    /// farther.
    pub fn is_known(&self, value: f64, cells: f64, misses: &[Miss]) -> bool {
        misses.iter().any(|miss| miss.cells == cells && (value - self.exact).abs() <= miss.off)
    }

    /// Whether a measured value is good enough; what is not a number never is.
    pub fn is_met_by(&self, value: f64) -> bool {
        match self.allowed {
            Allowed::Within(tolerance) => (value - self.exact).abs() <= tolerance,
            Allowed::AtLeast(least) => value >= least,
            Allowed::AtMost(most) => value <= most,
            Allowed::Between(least, most) => value >= least && value <= most,
        }
    }
}

impl std::fmt::Display for Target {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.allowed {
            Allowed::Within(tolerance) => write!(f, "{} ± {tolerance}", self.exact),
            Allowed::AtLeast(least) => write!(f, "≥ {least}"),
            Allowed::AtMost(most) => write!(f, "≤ {most}"),
            Allowed::Between(least, most) => write!(f, "{least} to {most}"),
        }
    }
}

impl Case {
    /// The scene's `[[contact]]` between all bodies.
    pub fn contact(&self, friction: f64) -> String {
        format!("[[contact]]\nlaw = \"{}\"\nfriction = {friction}\n", self.law)
    }

    /// The scene's `[space]`: its dimension, the side of a cell [m] and the scheme's keys; further keys may follow.
    pub fn space(&self, dimension: &str, cell: f64) -> String {
        let (interior, keys) = (self.interior, self.keys("space"));
        format!("[space]\ndimension = \"{dimension}\"\ninterior = \"{interior}\"\ncell = {cell}\n{keys}")
    }

    /// The scene's `[time]`: its end [s] and the scheme's keys; further keys may follow.
    pub fn time(&self, end: f64) -> String {
        format!("[time]\nend = {end}\n{}", self.keys("time"))
    }

    fn keys(&self, table: &str) -> String {
        if self.is_own() { String::new() } else { self.scheme.keys(table) }
    }

    /// Whether bodies are on grids of their own.
    pub fn is_own(&self) -> bool {
        self.interior == "reference"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_hold_up_to_their_border_and_never_for_what_is_no_number() {
        let allowed = [
            (Allowed::Within(0.25), [0.75, 1.25], [0.7, 1.3]),
            (Allowed::Between(0.5, 2.0), [0.5, 2.0], [0.4, 2.1]),
        ];
        for (allowed, holds, fails) in allowed {
            let target = Target::new("x", 1.0, allowed, "a test");
            assert!(holds.into_iter().all(|x| target.is_met_by(x)), "{target}");
            assert!(!fails.into_iter().any(|x| target.is_met_by(x)), "{target}");
            assert!(!target.is_met_by(f64::NAN));
        }
        let [least, most] = [Allowed::AtLeast(0.9), Allowed::AtMost(0.9)]
            .map(|allowed| Target::new("x", 1.0, allowed, "a test"));
        assert!(least.is_met_by(0.9) && !least.is_met_by(0.8) && !least.is_met_by(f64::NAN));
        assert!(most.is_met_by(0.9) && !most.is_met_by(1.0) && !most.is_met_by(f64::NAN));
    }
}
