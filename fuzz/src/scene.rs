//! Scene files, with all that they may name: read, drawn as an error or checked, up to the estimate of what they cost.

use crate::{image, mesh};
use miette::GraphicalReportHandler;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::OnceLock;
use stickslip::check::report;
use stickslip::observe::Manifest;
use stickslip::scene::{Loaded, Scene, SceneError, parse_beside};

/// Particle sites of scenes that are checked: what takes long because it is large is no finding.
const MOST_SITES: f64 = 2e4;
/// Bodies of those.
const MOST_BODIES: usize = 60;
/// Grains of a packing that is tried.
const MOST_GRAINS: i64 = 6;
/// Sites that the check refuses in a body.
const REFUSED: f64 = 1e9;

/// Reads a scene and looks at what comes of it.
pub fn run(bytes: &[u8]) {
    let Ok(text) = str::from_utf8(bytes) else { return };
    if let Some(loaded) = read(text) {
        check(&loaded);
    }
}

/// The scene of a text, if it is one and its packings are small; an error is drawn.
pub fn read(text: &str) -> Option<Loaded> {
    if !packs_little(text) {
        return None;
    }
    parse_beside("a/scene.toml", text, &[], files()).map_err(draw).ok()
}

/// Draws an error over the lines at fault.
pub fn draw(error: SceneError) {
    assert!(!error.to_string().is_empty());
    let mut drawn = String::new();
    let report = miette::Report::new(error);
    GraphicalReportHandler::new().render_report(&mut drawn, report.as_ref()).expect("text takes all");
}

/// Checks a scene; what is too large for that is to be refused.
fn check(Loaded { scene, source, .. }: &Loaded) {
    assert!(Manifest::record(scene).is_object());
    let (sites, largest) = sites(scene);
    if largest > REFUSED {
        let problem = report(scene).expect_err("a body of so many sites is refused");
        draw(source.locate(problem));
        return;
    }
    if sites > MOST_SITES || scene.bodies.len() > MOST_BODIES {
        return;
    }
    match report(scene) {
        Err(problem) => draw(source.locate(problem)),
        Ok(report) => {
            assert!(report.memory >= 0.0, "{}", report.memory);
            let report = report.placed(source);
            assert!(report.to_string().len() > 10);
            assert!(report.in_memory(0.0).to_string().contains("would be killed"));
        }
    }
}

/// Particle sites in all bodies that have bounds, and in the largest.
pub fn sites(scene: &Scene) -> (f64, f64) {
    let sites = scene.bodies.iter().filter_map(|body| {
        let lattice = scene.lattice(body);
        Some(lattice.sites(&body.shape.bounds(lattice.dimension)?))
    });
    sites.fold((0.0, 0.0), |(all, largest), sites| (all + sites, largest.max(sites)))
}

/// Whether packings have few grains: grains find their places while the scene is read.
fn packs_little(text: &str) -> bool {
    let Ok(document) = text.parse::<toml::Table>() else { return true };
    let Some(toml::Value::Array(packings)) = document.get("packings") else { return true };
    let few = |packing: &toml::Value| match packing.get("count") {
        Some(count) => count.as_integer().is_some_and(|count| count <= MOST_GRAINS),
        None => packing.get("solid_fraction").is_none(),
    };
    packings.len() <= 2 && packings.iter().all(few)
}

/// What lies beside the scene.
fn files() -> &'static BTreeMap<PathBuf, Vec<u8>> {
    static FILES: OnceLock<BTreeMap<PathBuf, Vec<u8>>> = OnceLock::new();
    FILES.get_or_init(|| {
        let first = |seeds: fn() -> Vec<Vec<u8>>| seeds().swap_remove(0);
        let rows = b"time,value\n0,0\n0.1,1\n0.2,-2\n".to_vec();
        let named = [
            ("m.stl", first(mesh::stl_seeds)),
            ("m.obj", first(mesh::obj_seeds)),
            ("m.ply", first(mesh::ply_seeds)),
            ("i.png", first(image::png_seeds)),
            ("i2.png", first(image::png_seeds)),
            ("i.tif", first(image::tiff_seeds)),
            ("t.csv", rows),
        ];
        named.into_iter().map(|(name, bytes)| (PathBuf::from("a").join(name), bytes)).collect()
    })
}

/// Scenes of the repository, and some that name files.
pub fn seeds() -> Vec<Vec<u8>> {
    let whole: [&str; 9] = [
        include_str!("../../scenes/packing.toml"),
        include_str!("../../scenes/carriage.toml"),
        include_str!("../../scenes/loaded_beam.toml"),
        include_str!("../../scenes/drop_hammer.toml"),
        include_str!("../../scenes/brazilian_disk.toml"),
        include_str!("../../scenes/paper/disks_plate.toml"),
        include_str!("../../scenes/paper/inclined_plane_slip.toml"),
        include_str!("../../scenes/shapes/hoop.toml"),
        crate::template::SCENE,
    ];
    let named = NAMING.map(|bodies| format!("{HEAD}{bodies}"));
    let plane = PLANE.map(|bodies| format!("{}{bodies}", HEAD.replace("3d", "plane-strain")));
    let texts = whole.map(str::to_string).into_iter().chain(named).chain(plane);
    texts.map(String::into_bytes).collect()
}

const HEAD: &str = "space = { dimension = \"3d\", cell = 0.5 }\ntime.end = 1\n[materials.m]\ndensity = 1\n\
                    neo_hookean = { young_modulus = 1, poisson_ratio = 0.3 }\n";

/// Bodies that use files, packings, repetition and every shape, in space.
const NAMING: [&str; 7] = [
    "[[bodies]]\nname = \"a\"\nmaterial = \"m\"\nshape.mesh = { file = \"m.stl\", scale = \"2 m\" }\n\
     [[loads]]\nname = \"l\"\nbody = \"a\"\nwithin.ball = { center = [0, 0, 4], radius = 2 }\nforce = [0, 0, { csv = \"t.csv\" }]\n",
    "[[bodies]]\nname = \"a\"\nmaterial = \"m\"\nshape.mesh = { file = \"m.obj\", translation = [1, 0, 0] }\n\
     [[bodies]]\nname = \"b\"\nmaterial = \"m\"\nshape.mesh = { file = \"m.ply\", translation = [0, 0, 5] }\n",
    "[[images]]\nname = \"g\"\nfile = \"i.tif\"\npixel = 0.5\nmaterial = \"m\"\n",
    "[[images]]\nname = \"g\"\nfile = \"i*.png\"\npixel = 0.5\nmaterial = \"m\"\nthreshold = 1\nsolid = \"dark\"\n",
    "[[packings]]\nname = \"p\"\nmaterial = \"m\"\ncount = 4\nseed = 3\nsizes = { uniform = [0.8, 1.2] }\n\
     shape.ball = { center = [0, 0, 0], radius = 0.5 }\nwithin.box = { min = [0, 0, 0], max = [4, 4, 4] }\n",
    "[[bodies]]\nname = \"b {i}\"\nrepeat = { i = 3 }\nmaterial = \"m\"\nvelocity = [1, 0, \"i * 1 m/s\"]\n\
     shape.ellipsoid = { center = [\"3 * i\", 0, 0], semi_axes = [1, 1, 2] }\n\
     [[bodies]]\nname = \"t\"\nmaterial = \"m\"\nshape.torus = { center = [0, 9, 0], axis = [0, 0, 1], radius = 2, tube_radius = 1 }\n",
    "[[bodies]]\nname = \"r\"\nmaterial = \"m\"\n\
     shape.revolved = { center = [0, 0, 0], axis = [0, 0, 1], spline = [[0, 0], [2, 1], [0, 3]] }\n\
     [[bodies]]\nname = \"u\"\nmaterial = \"m\"\nrigid = { velocity = [0, 0, \"sin(t * 1 rad/s) * 1 m/s\"] }\n\
     shape.difference = [ { superquadric = { center = [9, 0, 0], semi_axes = [1, 1, 1], exponent = 3 } }, \
     { capsule = { start = [9, 0, 0], end = [9, 0, 5], radius = 0.4 } } ]\n",
];

/// The same in the plane.
const PLANE: [&str; 2] = [
    "[[images]]\nname = \"g\"\nfile = \"i.png\"\npixel = 0.5\nmaterial = \"m\"\nlabels = [1, 2]\n",
    "[[packings]]\nname = \"p\"\nmaterial = \"m\"\ncount = 5\ngap = 0.1\norientation = \"random\"\n\
     shape.rounded_box = { min = [0, 0], max = [2, 1], rounding = 0.2 }\nwithin.ball = { center = [0, 0], radius = 6 }\n",
];
