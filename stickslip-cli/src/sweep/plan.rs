//! Which runs a sweep is made of.

use super::OwnColumn;
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};
use stickslip::observe::as_text;

/// What is run: all that a sweep needs to go on.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Plan {
    /// The scene file; absolute, so that whoever goes on may stand elsewhere, or relative to the folder of the sweep
    /// where it lies in there, and goes with it.
    #[serde(serialize_with = "as_text")]
    pub scene: PathBuf,
    /// What is set.
    pub variations: Vec<Variation>,
    /// Columns of the user's own.
    pub columns: Vec<OwnColumn>,
}

/// A parameter or key and the values that it takes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Variation {
    /// As in `--set`.
    pub name: String,
    /// In the order in which the user gave them; a single one holds for all runs.
    pub values: Vec<String>,
}

/// One run of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Name of its folder in that of the sweep: `nu=0.3,friction=0.5`.
    pub folder: String,
    /// Name and value of everything that is set.
    pub settings: Vec<(String, String)>,
}

impl Variation {
    /// From `name` and `value,value,...`. Commas in brackets, parentheses and quotes do not separate.
    ///
    /// # Errors
    /// An empty value, or the same twice, in words.
    pub fn new(name: &str, list: &str) -> Result<Self, String> {
        let values: Vec<String> = separated(list).into_iter().map(|value| value.trim().to_owned()).collect();
        if values.iter().any(String::is_empty) {
            return Err(format!("found an empty value in `{list}`; allowed: name=value,value,..."));
        }
        if let Some(again) = (1..values.len()).find(|&i| values[..i].contains(&values[i])) {
            return Err(format!("found {} twice; allowed: different values", values[again]));
        }
        Ok(Variation { name: name.to_owned(), values })
    }

    fn varies(&self) -> bool {
        self.values.len() > 1
    }
}

impl Plan {
    /// For a scene file and the folder of the sweep.
    ///
    /// # Errors
    /// There is no folder in which the program works.
    pub fn new(scene: &Path, folder: &Path, variations: Vec<Variation>) -> io::Result<Self> {
        let [scene, folder] = [std::path::absolute(scene)?, std::path::absolute(folder)?];
        let scene = scene.strip_prefix(&folder).map_or(scene.clone(), Path::to_path_buf);
        Ok(Plan { scene, variations, columns: Vec::new() })
    }

    /// The scene file of a sweep in this folder.
    pub fn scene_file(&self, folder: &Path) -> PathBuf {
        folder.join(&self.scene)
    }
}

/// All combinations, the last parameter changing fastest.
pub fn members(variations: &[Variation]) -> Vec<Member> {
    let mut all: Vec<Vec<(String, String)>> = vec![Vec::new()];
    for variation in variations {
        let extended = |settings: Vec<(String, String)>| {
            variation.values.iter().map(move |value| {
                let mut settings = settings.clone();
                settings.push((variation.name.clone(), value.clone()));
                settings
            })
        };
        all = all.into_iter().flat_map(extended).collect();
    }
    let mut members: Vec<Member> = Vec::new();
    for settings in all {
        let name = folder(&settings, variations);
        let same = members.iter().filter(|member| member.folder == name).count();
        let folder = if same > 0 { format!("{name},{}", same + 1) } else { name };
        members.push(Member { folder, settings });
    }
    members
}

/// Names of the parameters that take several values.
pub fn varied(variations: &[Variation]) -> Vec<String> {
    variations.iter().filter(|each| each.varies()).map(|each| each.name.clone()).collect()
}

/// What a file system takes anywhere.
fn folder(settings: &[(String, String)], variations: &[Variation]) -> String {
    let varied = settings.iter().zip(variations).filter(|(_, variation)| variation.varies());
    let each: Vec<String> = varied.map(|((name, value), _)| format!("{name}={value}")).collect();
    let plain =
        |letter: char| if letter.is_alphanumeric() || "=.,+-_".contains(letter) { letter } else { '_' };
    each.join(",").chars().map(plain).collect()
}

fn separated(list: &str) -> Vec<&str> {
    let (mut parts, mut start, mut depth, mut quote) = (Vec::new(), 0, 0, None);
    for (at, letter) in list.char_indices() {
        match (quote, letter) {
            (Some(open), _) if letter == open => quote = None,
            (Some(_), _) => {}
            (None, '"' | '\'') => quote = Some(letter),
            (None, '(' | '[' | '{') => depth += 1,
            (None, ')' | ']' | '}') => depth -= 1,
            (None, ',') if depth == 0 => {
                parts.push(&list[start..at]);
                start = at + 1;
            }
            _ => {}
        }
    }
    parts.push(&list[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variation(name: &str, list: &str) -> Variation {
        Variation::new(name, list).unwrap()
    }

    #[test]
    fn commas_separate_values_but_not_parts_of_one() {
        assert_eq!(variation("nu", "0.22, 0.3").values, ["0.22", "0.3"]);
        assert_eq!(variation("v", "[1, 0],[0, 1]").values, ["[1, 0]", "[0, 1]"]);
        assert_eq!(variation("a", "min(1, 2)").values, ["min(1, 2)"]);
        assert_eq!(variation("title", "\"a, b\",c").values, ["\"a, b\"", "c"]);
    }

    #[test]
    fn empty_and_repeated_values_are_refused() {
        for wrong in ["", "0.22,,0.3", "0.22,"] {
            assert!(Variation::new("nu", wrong).unwrap_err().contains("empty"), "{wrong}");
        }
        assert!(Variation::new("nu", "0.3,0.3").unwrap_err().contains("0.3 twice"));
    }

    #[test]
    fn every_combination_is_a_run_in_a_folder_of_its_own() {
        let plan = [variation("nu", "0.22,0.3"), variation("cells", "20"), variation("law", "gap,\"no ne\"")];
        let members = members(&plan);
        let folders: Vec<&str> = members.iter().map(|member| member.folder.as_str()).collect();
        assert_eq!(
            folders,
            ["nu=0.22,law=gap", "nu=0.22,law=_no_ne_", "nu=0.3,law=gap", "nu=0.3,law=_no_ne_"]
        );
        let settings = [("nu", "0.22"), ("cells", "20"), ("law", "gap")];
        assert_eq!(members[0].settings, settings.map(|(name, value)| (name.to_owned(), value.to_owned())));
        assert_eq!(varied(&plan), ["nu", "law"]);
    }

    #[test]
    fn folders_that_would_be_the_same_are_numbered() {
        let folders: Vec<String> =
            members(&[variation("v", "[1 2],[1/2]")]).into_iter().map(|member| member.folder).collect();
        assert_eq!(folders, ["v=_1_2_", "v=_1_2_,2"]);
    }
}
