//! The gallery: scenes of real things that the program brings along, with the files that they need.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// A scene of the gallery.
#[derive(Debug)]
pub struct Exhibit {
    /// Its name, that of its file without an ending.
    pub name: &'static str,
    /// The scene file.
    scene: &'static str,
    /// The meshes and images that it names, by name.
    files: &'static [(&'static str, &'static [u8])],
    /// How long it ran on two cores of the machine on which it was last measured [s].
    pub seconds: f64,
}

/// A file of the gallery's folder as text or as bytes.
macro_rules! file {
    ($reader:ident, $name:expr) => {
        $reader!(concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/gallery/", $name))
    };
}

macro_rules! exhibits {
    ($($name:literal, $seconds:literal, [$($file:literal),*];)*) => {
        &[$(Exhibit {
            name: $name,
            scene: file!(include_str, concat!($name, ".toml")),
            files: &[$(($file, file!(include_bytes, $file))),*],
            seconds: $seconds,
        }),*]
    };
}

/// All of them, in the order in which they are listed.
pub const EXHIBITS: &[Exhibit] = exhibits! {
    "impact", 300.0, [];
    "column_collapse", 300.0, [];
    "silo", 300.0, [];
    "force_chains", 60.0, [];
    "ball_mill", 60.0, [];
    "landslide", 60.0, ["valley.obj"];
    "foam", 300.0, ["foam.png"];
    "crystals", 60.0, ["crystals.png"];
    "seal", 60.0, [];
    "wheel", 20.0, [];
    "tread", 120.0, ["tread.stl"];
    "gears", 60.0, ["pinion.stl", "gear.stl"];
    "taylor_bar", 60.0, [];
    "penetration", 60.0, [];
};

impl Exhibit {
    /// The one of a name.
    pub fn named(name: &str) -> Option<&'static Exhibit> {
        EXHIBITS.iter().find(|exhibit| exhibit.name == name)
    }

    /// Its title.
    pub fn title(&self) -> &'static str {
        between(self.scene, "title = \"", "\"\n")
    }

    /// What it shows, and what is known of that.
    pub fn about(&self) -> &'static str {
        between(self.scene, "about = \"\"\"\n", "\"\"\"")
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
        all.into_iter().try_for_each(|(name, bytes)| fs::write(folder.join(name), bytes))?;
        Ok(folder.join(scene))
    }
}

fn between(text: &'static str, before: &str, after: &str) -> &'static str {
    let found = text.split_once(before).and_then(|(_, rest)| rest.split_once(after));
    found.map_or("", |(found, _)| found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each can be read and has no problem; all files of the folder belong to one of them, or make them.
    #[test]
    fn every_scene_of_the_gallery_is_sound() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut known = vec!["make_files.py".to_owned()];
        for exhibit in EXHIBITS {
            let path = exhibit.write(folder.path()).expect("it is written");
            let loaded = stickslip::scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(exhibit.title(), loaded.scene.title, "{}", exhibit.name);
            assert!(exhibit.about().len() > 100, "{}", exhibit.name);
            known.push(format!("{}.toml", exhibit.name));
            known.extend(exhibit.files.iter().map(|(name, _)| (*name).to_owned()));
        }
        known.sort();
        let there = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gallery");
        let mut found: Vec<String> = fs::read_dir(there)
            .expect("the gallery")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .filter(|name| !name.ends_with(".results"))
            .collect();
        found.sort();
        assert_eq!(found, known);
    }

    #[test]
    fn files_of_the_user_are_not_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let exhibit = Exhibit::named("gears").expect("it is there");
        exhibit.write(folder.path()).expect("it is written");
        exhibit.write(folder.path()).expect("once more, the same");
        fs::write(folder.path().join("gear.stl"), "mine").expect("a file");
        let error = exhibit.write(folder.path()).expect_err("another file is there");
        assert_eq!(error.kind(), io::ErrorKind::AlreadyExists);
        assert_eq!(fs::read(folder.path().join("gear.stl")).expect("it stays"), b"mine");
    }
}
