//! The problems: scenes like any other, as text.

use serde::Serialize;
use std::fmt::{Display, Write as _};

/// How a problem is computed, in the words of scene files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct BenchScheme {
    /// `grid` or `reference`: a body on a grid of its own has neither a choice of basis nor of stress update.
    pub interior: &'static str,
    /// `linear` or `gimp`.
    pub basis: &'static str,
    /// `double` or `single`.
    pub precision: &'static str,
    /// `last`, `first` or `modified-last`.
    pub stress_update: &'static str,
}

impl Default for BenchScheme {
    /// Linear functions on the common grid, and what scene files have by default.
    fn default() -> Self {
        BenchScheme { interior: "grid", basis: "linear", precision: "double", stress_update: "modified-last" }
    }
}

/// One problem, computed in one way by so many threads.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchCase {
    /// `P1` to `P5`.
    pub problem: &'static str,
    /// What distinguishes it within the problem: `cube`, `64 balls`.
    pub variant: String,
    /// How it is computed.
    pub scheme: BenchScheme,
    /// Threads.
    pub threads: usize,
    /// The scene.
    #[serde(skip)]
    pub scene: String,
    /// About how many particles it has.
    #[serde(skip)]
    pub expected: usize,
}

impl BenchCase {
    /// Whether the two differ in one thing whose cost is asked for: blocks with and without contact,
    /// a cube in a wide domain, threads.
    pub fn is_compared_with(&self, other: &BenchCase) -> bool {
        let same = |of: fn(&BenchCase) -> &str| of(self) == of(other);
        let alike = match self.problem {
            "P1" | "P4" => matches!(other.problem, "P1" | "P4"),
            "P2" => same(|case| case.problem),
            "P3" => same(|case| case.problem) && same(|case| &case.variant),
            _ => false,
        };
        alike && self.scheme == other.scheme
    }

    /// A few words that no other case has: `P3 64 balls, linear f64 last, 2 threads`.
    pub fn label(&self) -> String {
        let BenchScheme { basis, stress_update, .. } = self.scheme;
        let number = self.scheme.number();
        let threads = if self.threads == 1 { String::new() } else { format!(", {} threads", self.threads) };
        let how = match self.scheme.is_reference() {
            true => format!("own grid {number}"),
            false => format!("{basis} {number} {stress_update}"),
        };
        format!("{} {}, {how}{threads}", self.problem, self.variant)
    }
}

impl BenchScheme {
    /// Bodies on grids of their own.
    pub fn reference() -> Self {
        BenchScheme { interior: "reference", ..BenchScheme::default() }
    }

    /// Whether bodies are on grids of their own.
    pub fn is_reference(&self) -> bool {
        self.interior == "reference"
    }

    /// `f64` or `f32`.
    pub fn number(&self) -> &'static str {
        if self.precision == "single" { "f32" } else { "f64" }
    }
}

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BenchExtent {
    /// All sizes.
    Full,
    /// What fits into a minute.
    Quick,
    /// A few hundred particles: whether everything works.
    Tiny,
}

const CUBE: &str = include_str!("../../../scenes/bench/cube.toml");
const BLOCKS: &str = include_str!("../../../scenes/bench/blocks.toml");
const BALLS: &str = include_str!("../../../scenes/bench/balls.toml");

/// P2 as it is.
pub const BLOCKS_IN_CONTACT: &str = "two blocks";
/// P2 with the same particles, and nothing between the blocks.
pub const BLOCKS_APART: &str = "without contact";

/// Cells of empty space round problem P4: its domain is 100 times larger than P1's, (32 + 2 * 208)^3 against
/// (32 + 2 * 32)^3 cells. Whole blocks of four, so that they cut the cube as those of P1 do.
const WIDE_MARGIN: usize = 208;

/// Particles of a ball, about.
const BALL: usize = 2145;

impl BenchExtent {
    /// Cells along the cube of P1.
    fn cells(self) -> usize {
        if self == BenchExtent::Tiny { 4 } else { 32 }
    }

    /// Balls along each side of the packs of P3.
    fn balls(self) -> &'static [usize] {
        match self {
            BenchExtent::Full => &[1, 2, 4, 8, 16],
            BenchExtent::Quick => &[2, 4, 6],
            BenchExtent::Tiny => &[1, 2],
        }
    }

    /// Cells along the cubes of P5: 1, 4 and 16 million particles.
    fn growth(self) -> &'static [usize] {
        match self {
            BenchExtent::Full => &[50, 79, 126],
            BenchExtent::Quick => &[],
            BenchExtent::Tiny => &[5, 6],
        }
    }
}

/// All that is measured, on one thread and then on all `threads`. What is compared stands side by side.
pub fn cases(extent: BenchExtent, threads: usize) -> Vec<BenchCase> {
    let linear = BenchScheme::default();
    let gimp = BenchScheme { basis: "gimp", ..linear };
    let mut cases = Vec::new();
    let mut add = |problem, variant: &str, (scheme, threads), (expected, scene)| {
        cases.push(BenchCase { problem, variant: variant.to_owned(), scheme, threads, scene, expected });
    };
    let mut in_parallel = vec![1];
    in_parallel.extend((threads > 1).then_some(threads));

    for scheme in schemes(extent) {
        let parallel = scheme == linear || scheme == gimp;
        for &threads in if parallel { &in_parallel[..] } else { &[1] } {
            add("P1", "cube", (scheme, threads), cube(scheme, extent.cells(), 32));
        }
        if scheme == linear {
            add("P4", "wide domain", (linear, 1), cube(linear, extent.cells(), WIDE_MARGIN));
        }
    }
    let own = BenchScheme::reference();
    add("P1", "cube", (own, 1), cube(own, extent.cells(), 32));
    for scheme in [linear, gimp] {
        let cells = extent.cells();
        let size: (_, &dyn Display) = ("cells", &cells);
        let apart: [(_, &dyn Display); 3] = [size, ("law", &"\"none\""), ("weight", &0)];
        for (variant, values) in [(BLOCKS_IN_CONTACT, &apart[..1]), (BLOCKS_APART, &apart)] {
            add("P2", variant, (scheme, 1), (8 * cells.pow(3), with(BLOCKS, scheme, values)));
        }
    }
    for (scheme, &side) in
        [linear, own].into_iter().flat_map(|scheme| extent.balls().iter().map(move |side| (scheme, side)))
    {
        let count = side.pow(3);
        let variant = format!("{count} ball{}", if count == 1 { "" } else { "s" });
        for &threads in if side == 4 { &in_parallel[..] } else { &[1] } {
            add("P3", &variant, (scheme, threads), (BALL * count, balls(scheme, side)));
        }
    }
    for &cells in extent.growth() {
        let variant = format!("{:.1} M", (8 * cells.pow(3)) as f64 / 1e6);
        add("P5", &variant, (linear, 1), cube(linear, cells, 32));
    }
    cases
}

/// A case of P1, P2 or P3 with about so many times as many particles, in one shape of the same proportions.
pub fn grown(case: &BenchCase, extent: BenchExtent, times: usize) -> BenchCase {
    let longer = (times as f64).cbrt();
    // Whole blocks of four cells, which ranks share out; more than before.
    let cells = (4 * (extent.cells() as f64 * longer / 4.0).round() as usize).max(extent.cells() + 4);
    let scheme = case.scheme;
    let (expected, scene) = match case.problem {
        "P1" => cube(scheme, cells, 32),
        "P2" => (8 * cells.pow(3), with(BLOCKS, scheme, &[("cells", &cells)])),
        _ => {
            let side = ((case.expected / BALL) as f64 * times as f64).cbrt().round() as usize;
            (BALL * side.pow(3), balls(scheme, side))
        }
    };
    BenchCase { scene, expected, ..case.clone() }
}

/// In which ways P1 is computed.
fn schemes(extent: BenchExtent) -> Vec<BenchScheme> {
    let mut schemes = Vec::new();
    for basis in ["linear", "gimp"] {
        for stress_update in ["last", "first", "modified-last"] {
            for precision in ["double", "single"] {
                let few =
                    stress_update == "last" || (stress_update == "modified-last" && precision == "double");
                if extent == BenchExtent::Full || few {
                    schemes.push(BenchScheme { basis, precision, stress_update, ..BenchScheme::default() });
                }
            }
        }
    }
    schemes
}

/// A cube and its number of particles.
fn cube(scheme: BenchScheme, cells: usize, margin: usize) -> (usize, String) {
    let turn = usize::from(scheme.stress_update != "last");
    (8 * cells.pow(3), with(CUBE, scheme, &[("cells", &cells), ("margin", &margin), ("turn", &turn)]))
}

/// A scene with other parameters than its file has; without the keys that bodies on grids of their own have not.
fn with(scene: &str, scheme: BenchScheme, others: &[(&str, &dyn Display)]) -> String {
    let BenchScheme { interior, basis, precision, stress_update } = scheme;
    let words = [
        ("interior", interior),
        ("basis", basis),
        ("precision", precision),
        ("stress_update", stress_update),
    ];
    let mut values: Vec<(String, String)> =
        words.iter().map(|(name, word)| (format!("{name} = "), format!("\"{word}\""))).collect();
    values.extend(others.iter().map(|(name, value)| (format!("{name} = "), value.to_string())));
    let mut text = String::new();
    let mut within = false;
    for line in scene.lines() {
        if line.starts_with('[') {
            within = line == "[parameters]";
        }
        if scheme.is_reference() && ["basis = ", "stress_update = "].iter().any(|key| line.starts_with(key)) {
            continue;
        }
        let replaced = values.iter().find(|(start, _)| within && line.starts_with(start.as_str()));
        match replaced {
            Some((start, value)) => writeln!(text, "{start}{value}"),
            None => writeln!(text, "{line}"),
        }
        .expect("a string takes all text");
    }
    text
}

/// Balls of 8 cells' diameter in a hexagonal pack with `side` balls along each side.
fn balls(scheme: BenchScheme, side: usize) -> String {
    /// Radius of a ball, as in the file [m].
    const RADIUS: f64 = 0.125;
    /// By how much the balls approach the middle of the pack [1/s].
    const APPROACH: f64 = 1.0;
    let mut scene = with(BALLS, scheme, &[]);
    let place = |i: usize, j: usize, k: usize| {
        let [x, y, z] = [i, j, k].map(|i| i as f64);
        let (odd_row, odd_layer) = (((j + k) % 2) as f64, (k % 2) as f64);
        let rows = 3f64.sqrt() * (y + odd_layer / 3.0);
        [2.0 * x + odd_row, rows, 2.0 * 6f64.sqrt() / 3.0 * z].map(|x| RADIUS * x)
    };
    let middle = place(side - 1, side - 1, side - 1).map(|x| 0.5 * x);
    for (i, j, k) in (0..side.pow(3)).map(|n| (n % side, n / side % side, n / side / side)) {
        let center = place(i, j, k);
        let flight = [8.0, 5.0, 3.0];
        let velocity: [f64; 3] = std::array::from_fn(|a| flight[a] - APPROACH * (center[a] - middle[a]));
        let spin = if (i + j + k).is_multiple_of(2) { 5.0 } else { -5.0 };
        write!(
            scene,
            "\n[[bodies]]\nname = \"ball {i} {j} {k}\"\nmaterial = \"rubber\"\n\
             shape.ball = {{ center = {center:?}, radius = \"radius\" }}\n\
             velocity = {velocity:?}\nspin = [{spin:?}, 0, 0]\n"
        )
        .expect("a string takes all text");
    }
    scene
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_problem_is_a_sound_scene() {
        for case in cases(BenchExtent::Tiny, 2) {
            let loaded = stickslip::scene::parse("bench", &case.scene, &[]).unwrap_or_else(|e| panic!("{e}"));
            stickslip::check::problems(&loaded.scene).unwrap_or_else(|e| panic!("{case:?}: {e:?}"));
        }
    }

    /// Twice as many particles within a quarter: balls and blocks are whole.
    #[test]
    fn cases_grow() {
        for case in cases(BenchExtent::Quick, 1).iter().filter(|case| case.expected > 100_000) {
            if matches!(case.problem, "P1" | "P2" | "P3") && !case.variant.contains("without") {
                let grown = grown(case, BenchExtent::Quick, 2);
                let times = grown.expected as f64 / case.expected as f64;
                assert!((1.5..2.5).contains(&times), "{}: {times}", case.label());
                assert_ne!(grown.scene, case.scene);
            }
        }
    }

    #[test]
    fn sizes_are_those_that_the_names_say() {
        let report = |scene: &str| {
            let loaded = stickslip::scene::parse("bench", scene, &[]).unwrap();
            stickslip::check::report(&loaded.scene).unwrap()
        };
        assert_eq!(report(&cube(BenchScheme::default(), 32, 32).1).particles, 262_144);
        assert_eq!(report(&with(BLOCKS, BenchScheme::default(), &[])).particles, 262_144);
        let blocks = |variant| {
            let cases = cases(BenchExtent::Tiny, 1);
            let case = cases.into_iter().find(|case| case.variant == variant).expect("it is measured");
            report(&case.scene)
        };
        let [pressed, apart] = [BLOCKS_IN_CONTACT, BLOCKS_APART].map(blocks);
        assert_eq!((pressed.particles, pressed.contacts.len()), (apart.particles, 1));
        assert!(apart.contacts.is_empty(), "{apart}");
        let pack = report(&balls(BenchScheme::default(), 2));
        assert_eq!(pack.bodies.len(), 8);
        assert!(pack.bodies.iter().all(|ball| (2080..2200).contains(&ball.particles)), "{pack}");
        assert!(!pack.contacts.is_empty(), "the balls touch");
    }

    #[test]
    fn parameters_are_replaced_where_they_stand() {
        let scheme = BenchScheme {
            basis: "gimp",
            precision: "single",
            stress_update: "first",
            ..BenchScheme::default()
        };
        let loaded = stickslip::scene::parse("bench", &cube(scheme, 8, 4).1, &[]).unwrap();
        let scene = loaded.scene;
        assert_eq!(scene.discretization.basis, stickslip::scene::BasisKind::Gimp);
        assert_eq!(scene.precision, stickslip::scene::Precision::Single);
        assert_eq!(scene.time.stress_update, stickslip::scene::StressUpdate::First);
        assert_eq!(scene.domain.unwrap().max, [12.0 * 0.03125; 3]);
    }

    #[test]
    fn bodies_are_where_the_scheme_says() {
        for (scheme, interior) in [
            (BenchScheme::default(), stickslip::scene::Interior::Grid),
            (BenchScheme::reference(), stickslip::scene::Interior::Reference),
        ] {
            for scene in [cube(scheme, 8, 4).1, balls(scheme, 2)] {
                let scene = stickslip::scene::parse("bench", &scene, &[]).unwrap().scene;
                assert!((0..scene.bodies.len()).all(|body| scene.interior(body) == interior));
            }
        }
    }
}
