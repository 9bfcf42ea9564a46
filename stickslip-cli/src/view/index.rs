//! What there is to see: the first thing that the page asks for.

use super::open_frame::OpenFrame;
use crate::drawing::body_color;
use serde_json::{Value, json};
use stickslip::observe::{Frame, ReadError, Results, Status};

/// Colours of bodies before they repeat.
const BODY_COLORS: usize = 10;
/// Colours of a map.
const STEPS: usize = 64;

/// Colour maps that the page offers, those of `stickslip render` first in their kind.
const MAPS: [(&str, colorous::Gradient, bool); 8] = [
    ("viridis", colorous::VIRIDIS, false),
    ("cividis", colorous::CIVIDIS, false),
    ("magma", colorous::MAGMA, false),
    ("turbo", colorous::TURBO, false),
    ("greys", colorous::GREYS, false),
    // Red stands for the upper end.
    ("blue-red", colorous::RED_BLUE, true),
    ("purple-orange", colorous::PURPLE_ORANGE, false),
    ("spectral", colorous::SPECTRAL, true),
];

/// Titles, times, bodies, quantities and colours. `first` is the first of the frames, if there is one.
///
/// # Errors
/// The scene in `run.json` cannot be read.
pub fn index(results: &Results, frames: &[Frame], first: Option<&OpenFrame>) -> Result<Value, ReadError> {
    let manifest = results.manifest();
    let scene = results.scene()?;
    let quantities = first.map(|frame| frame.quantities.as_slice()).unwrap_or_default();
    Ok(json!({
        "title": manifest.title,
        "dimension": manifest.dimension,
        "cell": manifest.cell,
        "gravity": scene.gravity,
        "end": scene.time.end,
        "status": manifest.status,
        "times": frames.iter().map(|frame| frame.time).collect::<Vec<_>>(),
        "bodies": results.body_names(),
        "rigid": scene.bodies.iter().map(|body| body.is_rigid()).collect::<Vec<_>>(),
        "quantities": quantities,
        "left_out": left_out(results),
        "fringes": manifest.dimension == 2 && results.has_whole_snapshots(),
        "body_colors": (0..BODY_COLORS).map(body_color).collect::<Vec<_>>(),
        "maps": MAPS.map(|(name, gradient, reversed)| json!({ "name": name, "colors": colors(gradient, reversed) })),
    }))
}

/// How far a run is.
pub fn pulse(results: &Results, frames: usize, energy: u64) -> Value {
    let manifest = results.manifest();
    json!({
        "status": manifest.status,
        "running": manifest.status == Status::Running,
        "frames": frames,
        "time": results.frames().last().map(|frame| frame.time),
        "energy": energy,
    })
}

fn colors(gradient: colorous::Gradient, reversed: bool) -> Vec<String> {
    let at = |i: usize| if reversed { STEPS - 1 - i } else { i };
    (0..STEPS).map(|i| format!("{:x}", gradient.eval_rational(at(i), STEPS))).collect()
}

/// What the scene kept from its snapshots, in words; empty if nothing.
fn left_out(results: &Results) -> String {
    let scene = results.manifest().scene.value();
    let asked = |key: &str| scene.pointer(&format!("/outputs/snapshots/{key}"));
    let mut words = Vec::new();
    if let Some(every) = asked("every").and_then(|every| every.as_u64()).filter(|every| *every > 1) {
        words.push(format!("every {every}th particle"));
    }
    if let Some(Value::Array(columns)) = asked("columns") {
        let names: Vec<&str> = columns.iter().filter_map(Value::as_str).collect();
        words.push(format!("the columns {}", names.join(", ")));
    }
    if let Some(Value::Array(bodies)) = asked("bodies") {
        words.push(format!("the particles of {} bodies", bodies.len()));
    }
    match words.is_empty() {
        true => String::new(),
        false => format!("snapshots hold only {} (outputs.snapshots of the scene)", words.join("; ")),
    }
}
