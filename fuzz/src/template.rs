//! A folder of results of a small run, of which one file at a time is replaced by what is to be read.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use stickslip::run::{Checkpointing, RunOptions, run};
use stickslip::scene::{Loaded, parse};
use stickslip::step::build;
use tempfile::TempDir;

/// Some of every output.
pub const SCENE: &str = r#"
gravity = [0, -9.81]
space = { dimension = "plane-strain", cell = 0.25, domain = { min = [-2, -1], max = [2, 3], leaving = "remove" } }
time.end = 0.02
[materials.m]
density = 1000
von_mises = { young_modulus = 2e5, poisson_ratio = 0.3, yield_stress = 2e3 }
[[bodies]]
name = "low"
material = "m"
shape.ball = { center = [0, 0.3], radius = 0.3 }
[[bodies]]
name = "high"
material = "m"
shape.ball = { center = [0.1, 0.88], radius = 0.3 }
velocity = [0, -2]
[[bodies]]
name = "floor"
material = "m"
shape.half_space = { point = [0, 0], normal = [0, 1] }
rigid = {}
[[bodies]]
name = "flap"
material = "m"
shape.box = { min = [0.6, 0.1], max = [0.9, 0.6] }
rigid.free = {}
[[joints]]
name = "pin"
body = "flap"
hinge = { point = [0.7, 0.5], stiffness = 40, dashpot = 2 }
[[contact]]
friction = 0.3
[[supports]]
name = "hook"
body = "high"
within.ball = { center = [0.1, 1.1], radius = 0.15 }
stiffness = 2e3
[[references]]
body = "high"
quantity = "y"
value = "1 m - 2 m/s * t"
label = "fall"
[outputs]
tables = 0.005
particles = 0.01
grid = 0.02
samples = 0.005
checkpoints = 0.01
reactions = ["floor"]
tractions = {}
[outputs.fringes]
interval = 0.01
samples = 2
stress_parameter = 4e3
width = 40
bodies = ["low", "high"]
[[outputs.groups]]
name = "balls"
bodies = ["low", "high"]
[[outputs.groups]]
name = "all"
bodies = ["*"]
[[outputs.sections]]
name = "waist"
point = [0, 0.3]
normal = [0, 1]
[[outputs.probes]]
name = "heart"
at = [0.1, 0.9]
fixed_in = "material"
[[outputs.fabric]]
name = "pile"
within = { min = [-1, 0], max = [1, 1.5] }
[[outputs.arrivals]]
quantity = "speed"
threshold = 0.2
bodies = ["low", "high"]
[[outputs.fronts]]
name = "wave"
quantity = "von_mises"
threshold = 1e3
from = [0, 0.6]
direction = [0, -1]
bodies = ["low"]
"#;

/// A folder of results that goes with the program.
pub struct Template {
    folder: TempDir,
    /// The scene of the run.
    pub loaded: Loaded,
}

impl Template {
    /// The one of this program.
    pub fn get() -> &'static Template {
        static TEMPLATE: OnceLock<Template> = OnceLock::new();
        TEMPLATE.get_or_init(|| {
            // In memory, where there is such a folder.
            let memory = Path::new("/dev/shm");
            let folder = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
            let folder = folder.expect("a folder can be made");
            let loaded = parse("template.toml", SCENE, &[]).unwrap_or_else(|error| panic!("{error}"));
            let mut simulation = build(&loaded.scene).unwrap_or_else(|problem| panic!("{problem}"));
            let checkpoints = Checkpointing { every: None, at_end: true, keep: 9 };
            let options =
                RunOptions { checkpoints, threads: 1, ..RunOptions::new(folder.path().join("run")) };
            run(&loaded.scene, simulation.as_mut(), &options, &mut |_| {}).unwrap_or_else(|e| panic!("{e}"));
            Template { folder, loaded }
        })
    }

    /// The folder of results.
    pub fn path(&self) -> PathBuf {
        self.folder.path().join("run")
    }

    /// Where what is drawn goes.
    pub fn out(&self, name: &str) -> String {
        self.folder.path().join(name).display().to_string()
    }

    /// The bytes of a file of the results.
    pub fn file(&self, name: &str) -> Vec<u8> {
        fs::read(self.path().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Looks at the results with other bytes in a file.
    pub fn with(&self, name: &str, bytes: &[u8], look: impl FnOnce(&Path)) {
        let path = self.path().join(name);
        let before = fs::read(&path).ok();
        fs::write(&path, bytes).expect("the folder takes all");
        look(&self.path());
        match before {
            Some(before) => fs::write(&path, before).expect("the folder takes all"),
            None => fs::remove_file(&path).expect("it was written"),
        }
    }
}
