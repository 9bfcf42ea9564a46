//! The gallery: scenes of real things that the program brings along, with the files that they need, how each is looked
//! at, and what of its physics is known.

mod measures;

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use stickslip::observe::{ReadError, Results, replace};

/// A scene of the gallery.
#[derive(Debug)]
pub struct Exhibit {
    /// Its name, that of its file without an ending.
    pub name: &'static str,
    /// The scene file.
    pub scene: &'static str,
    /// The meshes and images that it names, by name.
    files: &'static [(&'static str, &'static [u8])],
    /// How long it ran on two cores of the machine on which it was last measured [s].
    pub seconds: f64,
    /// Words of `stickslip render` for its picture and its animation.
    pub look: &'static [&'static str],
    /// Pixels of the picture.
    pub size: &'static str,
    /// Pixels of the animation.
    pub small_size: &'static str,
    /// What is known of its physics.
    pub check: PhysicsCheck,
}

/// A number of the results of a scene that theory or experiments say.
#[derive(Debug)]
pub struct PhysicsCheck {
    /// What the number is, with its unit.
    pub what: &'static str,
    /// Takes it from the results.
    pub measure: fn(&Results) -> Result<f64, ReadError>,
    /// The least and the largest that it may be.
    pub bounds: [f64; 2],
}

impl PhysicsCheck {
    /// Whether a value is within the bounds.
    pub fn holds(&self, value: f64) -> bool {
        let [low, high] = self.bounds;
        (low..=high).contains(&value)
    }
}

/// A file of the gallery's folder as text or as bytes.
macro_rules! file {
    ($reader:ident, $name:expr) => {
        $reader!(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/gallery/", $name))
    };
}

macro_rules! exhibits {
    ($($name:literal [$($file:literal),*] {
        seconds: $seconds:literal, look: $look:expr, picture: $size:literal, animation: $small:literal,
        check: $what:literal, $measure:ident, $bounds:expr $(,)?
    })*) => {
        &[$(Exhibit {
            name: $name,
            scene: file!(include_str, concat!($name, ".toml")),
            files: &[$(($file, file!(include_bytes, $file))),*],
            seconds: $seconds,
            look: &$look,
            size: $size,
            small_size: $small,
            check: PhysicsCheck { what: $what, measure: measures::$measure, bounds: $bounds },
        }),*]
    };
}

/// All of them, in the order in which they are listed. A static: of a constant the program has a copy for each use.
pub static EXHIBITS: &[Exhibit] = exhibits! {
    "wheel" [] {
        seconds: 3.0, look: ["--color", "von_mises"], picture: "430x310", animation: "400x290",
        check: "energy that rolling lost over what the polymer dissipated", loss_of_wheel, [0.97, 1.03]
    }
    "seal" [] {
        seconds: 20.0, look: ["--color", "yy"], picture: "640x360", animation: "480x270",
        check: "force over that of Hertz' line contact, squeezed by 5 %", force_of_seal, [0.97, 1.03]
    }
    "taylor_bar" [] {
        seconds: 10.0, look: ["--color", "plastic_strain"], picture: "560x600", animation: "400x420",
        check: "final length [mm]", length_of_bar, [21.2, 21.6]
    }
    "penetration" [] {
        seconds: 6.0, look: ["--color", "plastic_strain"], picture: "560x400", animation: "420x300",
        check: "speed after over Recht and Ipson's", speed_of_bolt, [0.96, 1.04]
    }
    "crystals" ["crystals.png"] {
        seconds: 7.0, look: ["--color", "yy", "--range=-4e8,4e8"], picture: "410x440", animation: "300x330",
        check: "stress of the crystals over that of the binder", bridging_of_stress, [2.5, 10.0]
    }
    "foam" ["foam.png"] {
        seconds: 45.0, look: ["--color", "von_mises"], picture: "640x520", animation: "420x340",
        check: "stress over that of buckling cells", plateau_of_foam, [0.7, 1.4]
    }
    "column_collapse" [] {
        seconds: 50.0, look: [], picture: "800x400", animation: "480x240",
        check: "run-out over width", run_out_of_column, [2.4, 5.0]
    }
    "silo" [] {
        seconds: 90.0, look: ["--color", "velocity"], picture: "430x490", animation: "300x340",
        check: "rate over that of a free-fall arch", rate_of_silo, [0.85, 1.25]
    }
    "hopper" [] {
        seconds: 140.0, look: ["--color", "velocity"], picture: "560x640", animation: "360x410",
        check: "rate over Beverloo's", rate_of_hopper, [0.8, 1.2]
    }
    "landslide" ["valley.obj"] {
        seconds: 18.0, look: [], picture: "560x380", animation: "380x260",
        check: "friction's work over weight times way", friction_of_slide, [0.24, 0.31]
    }
    "tread" ["tread.stl"] {
        seconds: 42.0, look: ["--color", "von_mises"], picture: "580x400", animation: "400x275",
        check: "force along over force down", friction_of_tread, [0.37, 0.45]
    }
    "ball_mill" [] {
        seconds: 60.0, look: [], picture: "560x560", animation: "360x360",
        check: "the motor's moment over that of the balls' weight", moment_of_mill, [0.93, 1.07]
    }
    "mixer" [] {
        seconds: 70.0, look: ["--color", "density", "--range", "2500,2600", "--hide", "legend"],
        picture: "480x480", animation: "300x300",
        check: "contacts of unlike grains over those by chance", mixing_of_grains, [0.8, 1.05]
    }
    "gears" ["pinion.stl", "gear.stl"] {
        seconds: 60.0, look: [], picture: "560x340", animation: "420x255",
        check: "power of the brake over that of the motor", efficiency_of_gears, [0.965, 0.985]
    }
    "force_chains" [] {
        seconds: 42.0, look: ["--fringes", "--stress-parameter", "8e3", "--force-chains"],
        picture: "500x500", animation: "250x250",
        check: "share of the force that contacts above the mean bear", share_of_chains, [0.64, 0.84]
    }
    "impact" [] {
        seconds: 180.0, look: ["--color", "velocity"], picture: "560x400", animation: "330x240",
        check: "depth over the law of Uehara et al.", depth_of_ball, [0.5, 2.0]
    }
};

impl Exhibit {
    /// The one of a name.
    pub fn named(name: &str) -> Option<&'static Exhibit> {
        EXHIBITS.iter().find(|exhibit| exhibit.name == name)
    }

    /// Its title.
    pub fn title(&self) -> &'static str {
        let found = self.scene.split_once("title = \"").and_then(|(_, rest)| rest.split_once("\"\n"));
        found.map_or("", |(title, _)| title)
    }

    /// How long it runs on two cores, as one reads it.
    pub fn time(&self) -> String {
        match self.seconds {
            seconds if seconds < 90.0 => format!("{seconds:.0} s"),
            seconds => format!("{:.0} min", seconds / 60.0),
        }
    }

    /// Writes the scene and its files into a folder, which may be there, and gives the path of the scene. Files that
    /// are there already stay, if they are the same.
    ///
    /// # Errors
    /// The folder cannot be written, or holds another file of one of these names.
    pub fn write(&self, folder: &Path) -> io::Result<PathBuf> {
        fs::create_dir_all(folder)?;
        let scene = format!("{}.toml", self.name);
        let all = [(scene.as_str(), self.scene.as_bytes())].into_iter().chain(self.files.iter().copied());
        for (name, bytes) in all.clone() {
            if fs::read(folder.join(name)).is_ok_and(|found| found != bytes) {
                let what = format!("{} is there already, and is another", folder.join(name).display());
                return Err(io::Error::new(io::ErrorKind::AlreadyExists, what));
            }
        }
        for (name, bytes) in all {
            replace(&folder.join(name), |file| file.write_all(bytes)).map_err(|error| error.source)?;
        }
        Ok(folder.join(scene))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each can be read, begins without overlap and fits into memory; each file of the folder belongs to one of them,
    /// or makes them.
    #[test]
    fn every_scene_of_the_gallery_is_sound() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut known = vec!["make_files.py".to_owned()];
        for exhibit in EXHIBITS {
            let path = exhibit.write(folder.path()).expect("it is written");
            let loaded = stickslip::scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(exhibit.title(), loaded.scene.title, "{}", exhibit.name);
            let report =
                stickslip::check::report(&loaded.scene).unwrap_or_else(|problem| panic!("{problem:?}"));
            assert!(report.memory < 5e8, "{}", exhibit.name);
            assert!(exhibit.scene.lines().count() <= 65, "{} is long to read", exhibit.name);
            known.push(format!("{}.toml", exhibit.name));
            known.extend(exhibit.files.iter().map(|(name, _)| (*name).to_owned()));
        }
        known.sort();
        let there = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gallery");
        let mut found: Vec<String> = fs::read_dir(there)
            .expect("the gallery")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        found.sort();
        assert_eq!(found, known);
    }

    /// The book's chapter shows picture and animation of each, and its time.
    #[test]
    fn the_book_shows_every_scene() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let chapter = fs::read_to_string(root.join("book/20-gallery.md")).expect("the chapter");
        // Lines may break anywhere.
        let chapter = chapter.split_whitespace().collect::<Vec<_>>().join(" ");
        for exhibit in EXHIBITS {
            let Exhibit { name, check, .. } = exhibit;
            let run = format!("`stickslip gallery run {name}`: {}.", exhibit.time());
            assert!(chapter.contains(&run), "{run}");
            for kind in ["png", "gif"] {
                let file = format!("docs/gallery/{name}.{kind}");
                assert!(chapter.contains(&file), "{file}");
                assert!(root.join(&file).exists(), "{file}");
            }
            let [low, high] = check.bounds;
            assert!(chapter.contains(&format!("{low} to {high}")), "{name}: {low} to {high}");
        }
    }

    #[test]
    fn files_of_the_user_are_not_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let exhibit = Exhibit::named("foam").expect("it is there");
        exhibit.write(folder.path()).expect("it is written");
        exhibit.write(folder.path()).expect("once more, the same");
        fs::write(folder.path().join("foam.png"), "mine").expect("a file");
        let error = exhibit.write(folder.path()).expect_err("another file is there");
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(fs::read(folder.path().join("foam.png")).expect("it stays"), b"mine");
    }
}
