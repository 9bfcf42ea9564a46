//! What README and book say is true: their commands run, their scenes are scenes, their links lead somewhere, and every
//! key, word, column and equation number of the code stands there.

mod stickslip;

use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use stickslip::Workplace;

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace holds this crate").to_path_buf()
}

/// README, CHANGELOG and the book's chapters with their paths in the repository.
fn documents() -> Vec<(PathBuf, String)> {
    let mut paths: Vec<PathBuf> = ["README.md", "CHANGELOG.md", "ARCHITECTURE.md"].map(PathBuf::from).into();
    for entry in fs::read_dir(repository().join("book")).unwrap() {
        let name = PathBuf::from("book").join(entry.unwrap().file_name());
        if name.extension().is_some_and(|extension| extension == "md") {
            paths.push(name);
        }
    }
    paths.sort();
    paths
        .into_iter()
        .map(|path| (path.clone(), fs::read_to_string(repository().join(path)).unwrap()))
        .collect()
}

fn chapter(name: &str) -> String {
    fs::read_to_string(repository().join("book").join(name)).unwrap()
}

/// Contents of the fenced blocks of a language.
fn fenced(text: &str, language: &str) -> Vec<String> {
    let opening = format!("```{language}");
    let mut blocks = Vec::new();
    let mut lines = text.lines();
    while lines.by_ref().any(|line| line == opening) {
        let block: Vec<&str> = lines.by_ref().take_while(|line| *line != "```").collect();
        blocks.push(block.join("\n") + "\n");
    }
    blocks
}

/// A stand-in for `stickslip` that makes runs short: coarse, and over after a few snapshots.
#[cfg(unix)]
const SHORT: &str = r#"#!/bin/sh
case "$1" in
    run | check)
        grep -q '^cells_per_radius' "$2" && coarse="--set cells_per_radius=2"
        end="40 ms" particles="10 ms"
        # A wave crosses the paper's disks in a microsecond.
        grep -q '^cells_per_diameter' "$2" && coarse="--set cells_per_diameter=20" end="2 us" particles="0.5 us"
        # A blow of 3 ms.
        case "$2" in *drop_hammer*) end="1 ms" particles="0.5 ms" ;; esac
        ;;
    # Tests of their own run all parts of these.
    reproduce | bench) set -- $(echo "$@" | sed 's/--only [^ ]*//') ;;
esac
case "$1" in
    reproduce) exec "$STICKSLIP" "$@" --sketch --only backspin ;;
    run) exec "$STICKSLIP" "$@" $coarse --set time.end="$end" --set outputs.particles="$particles" ;;
    bench) exec "$STICKSLIP" "$@" --tiny --only P1 ;;
    # Runs are over before the times of which documents speak.
    render) exec "$STICKSLIP" $(echo "$@" | sed 's/--time [^ ]*//') ;;
    *) exec "$STICKSLIP" "$@" $coarse ;;
esac
"#;

/// Every command of a document runs, one after the other as a reader would type them, in a folder with the repository's
/// scenes. Documents do not wait for each other.
#[cfg(unix)]
#[test]
fn commands_run() {
    use std::os::unix::fs::PermissionsExt;
    let tools = Workplace::new();
    tools.write("stickslip", SHORT);
    fs::set_permissions(tools.path("stickslip"), fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", tools.path("").display(), std::env::var("PATH").unwrap());
    let waiting = std::sync::Mutex::new(documents().into_iter());
    let next = || waiting.lock().expect("no document fails while one is taken").next();
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                while let Some((document, text)) = next() {
                    commands_of(&document, &text, &path);
                }
            });
        }
    });
}

/// Runs the commands of a document, with `path` to find programs by.
#[cfg(unix)]
fn commands_of(document: &Path, text: &str, path: &str) {
    let workplace = Workplace::new();
    std::os::unix::fs::symlink(repository().join("scenes"), workplace.path("scenes")).unwrap();
    for block in fenced(text, "sh") {
        for line in block.lines() {
            let command = line.replace("cargo run --release --bin stickslip -- ", "stickslip ");
            if !command.starts_with("stickslip ") {
                continue;
            }
            let output = std::process::Command::new("sh")
                .args(["-c", &command])
                .current_dir(workplace.path(""))
                .env("PATH", path)
                .env("STICKSLIP", env!("CARGO_BIN_EXE_stickslip"))
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{}: {line}\n{said}", document.display());
        }
    }
}

#[test]
fn scenes_are_scenes() {
    let mut complete = 0;
    for (document, text) in documents() {
        for block in fenced(&text, "toml").iter().filter(|block| block.contains("[space]")) {
            let workplace = Workplace::new();
            workplace.write("scene.toml", block);
            let ran = workplace.run(&["check", "scene.toml"]);
            assert_eq!(ran.code, Some(0), "{}: {}", document.display(), ran.stderr);
            complete += 1;
        }
    }
    assert!(complete > 0);
}

#[test]
fn the_readmes_scene_is_the_file() {
    let read = |path: &str| fs::read_to_string(repository().join(path)).unwrap();
    assert_eq!(fenced(&read("README.md"), "toml"), [read("scenes/drum.toml")]);
}

#[test]
fn links_lead_to_files() {
    for (document, text) in documents() {
        for link in text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link) {
            let file = link.split('#').next().unwrap_or_default();
            if link.contains("://") || file.is_empty() {
                continue;
            }
            let target = repository().join(&document).with_file_name(file);
            assert!(target.exists(), "{}: {link} leads nowhere", document.display());
        }
    }
}

/// Files below a folder that end in `.rs`, but for what is built, by their paths in the repository.
fn sources(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(repository().join(folder)).unwrap().map(Result::unwrap) {
        let (path, name) = (folder.join(entry.file_name()), entry.file_name());
        if entry.file_type().unwrap().is_dir() {
            if name != "target" && name != "corpus" {
                sources(&path, found);
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path.to_str().unwrap().replace('\\', "/"));
        }
    }
}

/// Whether a line of code has an unsafe block, function, implementation or type of function.
fn is_unsafe(line: &str) -> bool {
    let code = line.split("//").next().unwrap_or_default();
    ["{", "fn", "impl", "extern"].iter().any(|next| code.contains(&["unsafe", next].join(" ")))
}

#[test]
fn every_file_with_unsafe_code_has_a_row_in_the_architecture() {
    let text = fs::read_to_string(repository().join("ARCHITECTURE.md")).unwrap();
    let (_, section) = text.split_once("\n## Where code is unsafe\n").expect("the section is there");
    let section = section.split("\n## ").next().unwrap();
    let rooms = section
        .lines()
        .filter_map(|line| line.strip_prefix("| `"))
        .map(|row| row.split(" | ").next().unwrap());
    let rooms: Vec<String> = rooms
        .flat_map(|room| room.split(['`', ',', ' ']).filter(|path| !path.is_empty()))
        .map(|path| {
            if path.starts_with("stickslip") {
                return path.into();
            }
            let in_crate = |name: &str| format!("stickslip-{name}/src/{path}");
            let is_there = |path: &String| repository().join(path).exists();
            let found = ["kernels", "engine"].map(in_crate).into_iter().find(is_there);
            found.unwrap_or_else(|| panic!("`{path}` is in neither crate"))
        })
        .collect();
    assert!(rooms.len() > 20, "{rooms:?}");
    let mut files = Vec::new();
    for entry in fs::read_dir(repository()).unwrap().map(Result::unwrap) {
        if entry.path().join("Cargo.toml").is_file() {
            sources(Path::new(&entry.file_name()), &mut files);
        }
    }
    files.retain(|path| fs::read_to_string(repository().join(path)).unwrap().lines().any(is_unsafe));
    let covers = |room: &str, file: &str| file == room || (room.ends_with('/') && file.starts_with(room));
    let bare: Vec<_> = files.iter().filter(|file| !rooms.iter().any(|room| covers(room, file))).collect();
    assert!(bare.is_empty(), "no row for {bare:?}");
    let idle: Vec<_> = rooms.iter().filter(|room| !files.iter().any(|file| covers(room, file))).collect();
    assert!(idle.is_empty(), "nothing is unsafe in {idle:?}");
}

/// Names of keys, of words to choose from, and of definitions that a JSON schema holds.
fn collect(schema: &Value, keys: &mut BTreeSet<String>, words: &mut BTreeSet<String>) {
    match schema {
        Value::Object(members) => {
            if let Some(Value::Object(properties)) = members.get("properties") {
                keys.extend(properties.keys().cloned());
            }
            if let Some(Value::String(word)) = members.get("const") {
                words.insert(word.clone());
            }
            members.values().for_each(|member| collect(member, keys, words));
        }
        Value::Array(items) => items.iter().for_each(|item| collect(item, keys, words)),
        _ => {}
    }
}

#[test]
fn every_key_and_word_of_scene_files_is_explained() {
    let schema = serde_json::from_str(&Workplace::new().succeed(&["schema"])).unwrap();
    let (mut keys, mut words) = (BTreeSet::new(), BTreeSet::new());
    collect(&schema, &mut keys, &mut words);
    let text = chapter("02-scene-file.md");
    let tables = [
        "space",
        "time",
        "damping",
        "health",
        "materials",
        "shapes",
        "bodies",
        "packings",
        "images",
        "point_clouds",
        "supports",
        "loads",
        "joints",
        "springs",
        "contact",
        "outputs",
        "references",
        "parameters",
    ];
    for key in keys {
        let measured = ["probes", "arrivals", "fronts", "sections", "groups", "fabric"]
            .contains(&key.as_str())
            && text.contains(&format!("[[outputs.{key}]]"));
        let heading = measured || tables.contains(&key.as_str()) && text.contains(&format!("[{key}"));
        assert!(heading || text.contains(&format!("`{key}`")), "no word on the key `{key}`");
    }
    for word in words {
        assert!(text.contains(&format!("`\"{word}\"`")), "no word on \"{word}\"");
    }
}

#[test]
fn every_column_is_explained() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &fenced(&chapter("02-scene-file.md"), "toml")[0]);
    workplace.succeed(&["run", "scene.toml", "--set", "time.end=1 ms", "--set", "outputs.grid=1 ms"]);
    let text = chapter("07-outputs.md");
    let quoted: BTreeSet<&str> = text.split('`').flat_map(str::split_whitespace).collect();
    for table in ["bodies.csv", "energy.csv", "contacts.csv"] {
        let written = fs::read_to_string(workplace.path("scene.results").join(table)).unwrap();
        for column in written.lines().next().unwrap().split(',') {
            assert!(quoted.contains(column), "{table}: no word on `{column}`");
        }
    }
    for folder in ["particles", "grid"] {
        let file = workplace.path("scene.results").join(folder).join("00000.vtu");
        let written = String::from_utf8_lossy(&fs::read(file).unwrap()).into_owned();
        let (_, arrays) = written.split_once("<PointData").unwrap();
        for array in arrays.split_once("</PointData>").unwrap().0.split("Name=\"").skip(1) {
            let name = array.split('"').next().unwrap();
            assert!(quoted.contains(name), "{folder}: no word on `{name}`");
        }
    }
}

#[test]
fn the_papers_equations_stand_in_the_book() {
    let book: String = documents().into_iter().map(|(_, text)| text).collect();
    for number in 1..=26 {
        assert!(book.contains(&format!("\\tag{{{number}}}")), "eq. ({number})");
    }
}
