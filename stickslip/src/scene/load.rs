//! From a scene file to a [`Scene`].

use super::error::SceneError;
use super::source::Source;
use super::suggestion::did_you_mean;
use super::{Scene, file};
use std::path::Path;

/// A scene and the text that it came from.
#[derive(Debug)]
pub struct Loaded {
    /// What the text says.
    pub scene: Scene,
    /// The text, to show where a mistake that is found later stands.
    pub source: Source,
}

/// Reads the scene file at `path`, with `overrides` as [`parse`] takes them.
///
/// # Errors
/// A file that cannot be read, and what [`parse`] finds.
pub fn load(path: &Path, overrides: &[(String, String)]) -> Result<Loaded, SceneError> {
    let text = std::fs::read_to_string(path).map_err(|reason| SceneError::Unreadable {
        path: path.to_path_buf(),
        help: neighbour(path),
        reason,
    })?;
    parse(&path.display().to_string(), &text, overrides)
}

/// Reads a scene from its text; `name` stands for the file in messages.
///
/// Each override is a name and a value. A name without dots is a parameter: `("cells_per_radius", "4")`, `("contact", "gap")`,
/// `("angle", "pi / 6")`; a path with dots is any key: `("time.end", "1 s")`, `("bodies[0].velocity", "[1, 0, 0]")`.
///
/// # Errors
/// The first mistake, with file, line, column, key, what was found, what is allowed and a suggestion.
pub fn parse(name: &str, text: &str, overrides: &[(String, String)]) -> Result<Loaded, SceneError> {
    let source = Source::read(name, text, overrides)?;
    let scene = file::resolve(&source).map_err(|fault| source.show(fault))?;
    Ok(Loaded { scene, source })
}

/// The JSON schema of scene files, for editors.
pub fn schema() -> serde_json::Value {
    file::schema().to_value()
}

/// A scene beside a missing file with almost its name.
fn neighbour(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let wanted = path.file_name()?.to_str()?;
    let names: Vec<String> = std::fs::read_dir(folder)
        .ok()?
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .collect();
    let scenes = names.iter().map(String::as_str).filter(|name| name.ends_with(".toml") && *name != wanted);
    did_you_mean(wanted, scenes)
}
