//! Folders of results: the record of a run, tables, snapshots and their list, by the readers of `render`, `plot`,
//! `view` and the library.

use crate::is_one_in;
use crate::template::Template;
use std::path::Path;
use std::sync::OnceLock;
use stickslip::observe::{Manifest, ParticleFile, Results, read_columns};
use stickslip_cli::door::{PORT, Viewer, ask};

/// One input of so many is drawn, too: pictures take a thousand times as long as reading. What is found by drawing is
/// drawn where it is replayed: one number is a multiple of the other.
const DRAWN: u64 = if cfg!(feature = "libfuzzer") { 5000 } else { 200 };

fn is_drawn(bytes: &[u8]) -> bool {
    is_one_in(DRAWN, bytes)
}

/// Asks the command for a file; that it may refuse is sound.
fn draw(words: &[&str], folder: &Path, out: &str) {
    let _ = std::fs::remove_file(out);
    let folder = folder.display().to_string();
    let _ = ask(&[&["stickslip", words[0], &folder], &words[1..], &["--out", out]].concat());
}

/// Asks the viewer of a folder for everything in a list.
fn view(folder: &Path, addresses: &[&str]) {
    let Ok(viewer) = Viewer::open(folder) else { return };
    let host = format!("127.0.0.1:{PORT}");
    for address in addresses {
        let (code, _) = viewer.answer(address, &[("Host", &host)]);
        assert!([200, 404, 500].contains(&code), "{address}: {code}");
    }
}

/// Reads the record of a run.
pub fn record(bytes: &[u8]) {
    let template = Template::get();
    template.with(Manifest::FILE, bytes, |folder| {
        let Ok(results) = Results::open(folder) else { return };
        let _ = results.scene().map(|scene| scene.bodies.iter().any(|body| body.is_rigid()));
        std::hint::black_box(results.has_whole_snapshots());
        view(
            folder,
            &["/index", "/pulse", "/energy", "/frame/0", "/skins", "/skins/1", "/body/1", "/contacts/1"],
        );
        if is_drawn(bytes) {
            draw(&["plot"], folder, &template.out("p.png"));
            draw(&["render", "--size", "200x200"], folder, &template.out("r.png"));
            draw(&["render", "--size", "200x200", "--fringes"], folder, &template.out("r.png"));
        }
    });
}

/// The record of the run, whole and with less of its scene.
pub fn record_seeds() -> Vec<Vec<u8>> {
    let bytes = Template::get().file(Manifest::FILE);
    let mut record: serde_json::Value = serde_json::from_slice(&bytes).expect("the program writes JSON");
    record["references"] = serde_json::json!([{
        "body": "high", "quantity": "y", "label": "fall", "points": [[0, 1], [0.02, 0.9]]
    }]);
    let short = serde_json::to_vec(&record).expect("JSON can be written");
    vec![short]
}

/// Tables of a run.
const TABLES: [&str; 17] = [
    "bodies.csv",
    "energy.csv",
    "contacts.csv",
    "loads.csv",
    "joints.csv",
    "probes.csv",
    "arrivals.csv",
    "sections.csv",
    "fronts.csv",
    "front_speeds.csv",
    "fringes.csv",
    "reactions.csv",
    "groups.csv",
    "group_contacts.csv",
    "removed.csv",
    "fabric.csv",
    "tractions.csv",
];

/// Reads a table: the first byte says which.
pub fn tables(bytes: &[u8]) {
    let Some((&which, rows)) = bytes.split_first() else { return };
    // The record stays as it is.
    static RESULTS: OnceLock<Results> = OnceLock::new();
    let template = Template::get();
    let results = RESULTS.get_or_init(|| Results::open(&template.path()).expect("the record is sound"));
    let which = usize::from(which) % TABLES.len();
    template.with(TABLES[which], rows, |folder| {
        match which {
            0..=2 => {
                let _ = std::hint::black_box((results.bodies_table(), results.contacts_table()));
                view(folder, &["/energy", "/body/1", "/contacts/0", "/contacts/2"]);
            }
            3 => drop(results.loads_table()),
            4 => drop(results.joints_table()),
            5 => drop(results.probes_table()),
            6 => drop(results.arrivals_table()),
            7 => drop(results.sections_table()),
            8 => drop(results.fronts_table()),
            9 => drop(results.front_speeds_table()),
            10 => drop(results.fringes_table()),
            11 => drop(results.reactions_table()),
            12 => drop(results.groups_table()),
            13 => drop(results.group_contacts_table()),
            14 => drop(results.removed_table()),
            15 => drop(results.fabric_table()),
            _ => drop(results.tractions_table()),
        }
        if is_drawn(bytes) {
            let table = [
                "bodies", "bodies", "contacts", "bodies", "bodies", "probes", "arrivals", "bodies", "fronts",
            ];
            let table = table.get(which).copied().unwrap_or("fronts");
            draw(&["plot", "--table", table], folder, &template.out("t.svg"));
        }
    });
}

/// Each table of the run, behind its number.
pub fn table_seeds() -> Vec<Vec<u8>> {
    let template = Template::get();
    let table = |(i, name): (usize, &&str)| [vec![i as u8], template.file(name)].concat();
    TABLES.iter().enumerate().map(table).collect()
}

/// Reads a snapshot.
pub fn snapshot(bytes: &[u8]) {
    let template = Template::get();
    template.with("particles/00001.vtu", bytes, |folder| {
        let path = folder.join("particles/00001.vtu");
        let Ok(file) = ParticleFile::open(&path) else { return };
        let whole = Results::open(folder).and_then(|results| results.particles(&results.frames()[1]));
        let _ = read_columns(&path);
        if let Ok(head) = ParticleFile::open_head(&path) {
            let _ = (0..head.pieces().min(3)).try_for_each(|piece| head.piece(piece)?.bodies().map(drop));
        }
        let columns: Vec<String> = file.columns().map(|column| column.name).collect();
        let column = |name: &String| format!("/column/1/{name}");
        let addresses: Vec<String> = columns.iter().take(20).map(column).collect();
        let fixed =
            ["/frame/1", "/particle/0/3/velocity.x", "/skins/1", "/skins/1/velocity", "/column/1/stress.xy"];
        view(folder, &fixed.into_iter().chain(addresses.iter().map(String::as_str)).collect::<Vec<_>>());
        if whole.is_ok() && is_drawn(bytes) {
            for color in ["body", "pressure", "von_mises"] {
                draw(
                    &["render", "--frame", "1", "--size", "200x200", "--color", color],
                    folder,
                    &template.out("r.png"),
                );
            }
            draw(
                &["render", "--frame", "1", "--size", "200x200", "--fringes"],
                folder,
                &template.out("r.png"),
            );
            view(folder, &["/fringes/1"]);
        }
    });
}

/// Snapshots of the run.
pub fn snapshot_seeds() -> Vec<Vec<u8>> {
    vec![Template::get().file("particles/00001.vtu")]
}

/// Reads the list of snapshots.
pub fn collection(bytes: &[u8]) {
    let template = Template::get();
    template.with("particles.pvd", bytes, |folder| {
        let Ok(results) = Results::open(folder) else { return };
        for frame in results.frames() {
            assert!(frame.path.starts_with(folder), "{}", frame.path.display());
            let inside = frame.path.components().all(|part| part.as_os_str() != "..");
            assert!(inside, "{}", frame.path.display());
        }
        if results.frames().len() < 50 {
            view(
                folder,
                &["/index", "/pulse", "/frame/0", "/frame/1", "/particle/0/3/pressure", "/contacts/1"],
            );
            if is_drawn(bytes) {
                draw(&["render", "--size", "200x200", "--time", "0.01"], folder, &template.out("r.png"));
            }
        }
    });
}

/// The list of the run.
pub fn collection_seeds() -> Vec<Vec<u8>> {
    vec![Template::get().file("particles.pvd")]
}
