//! `run.json`: what was run, by which program, how it went and how long it took.

use super::file::{OutputError, ReadError, ReadProblem, open_file, read_bytes, replace_for_good};
use super::folder::OutputFolder;
use super::work::work;
use crate::check::Warning;
use crate::door::{RankShare, RelaxationState};
use crate::scene::{Loaded, Scene, SceneError, load, parse, steers_text};
use serde::de::{DeserializeOwned, Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::value::{RawValue, to_raw_value};
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::fmt::{self, Formatter};
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The key of the scene.
const SCENE: &str = "scene";

/// The record of a run. It is there from the first moment of the run, so that a folder of results is known as one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// `stickslip`.
    pub program: String,
    /// Version of the program.
    pub version: String,
    /// How the run stands.
    pub status: Status,
    /// What stopped it, if it failed or a check stopped it.
    pub error: Option<String>,
    /// Title of the scene.
    pub title: String,
    /// 2 or 3.
    pub dimension: usize,
    /// Side of a grid cell [m].
    pub cell: f64,
    /// Names of the bodies: number `i` of a snapshot's `body` is name `i` here.
    pub bodies: Vec<String>,
    /// How far the run has come.
    pub performance: Performance,
    /// How far dynamic relaxation came, if the scene asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub relaxation: Option<RelaxationState>,
    /// Simulated times at which it was taken up from a checkpoint [s].
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub resumed: Vec<f64>,
    /// Ends that it had reached, and beyond which it was continued [s]: its steps end there, too.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ends: Vec<f64>,
    /// What its bodies began from, if from another run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub begun_from: Option<BegunFrom>,
    /// SHA-256 of the particles at the end, see [`super::state_sum`]: the same for any number of threads and however
    /// often the run was interrupted. None of a run that failed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state_sum: Option<String>,
    /// What was doubtful about the scene before it began.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub scene_warnings: Vec<Warning>,
    /// What is wrong with its results, in the order in which it was found.
    pub warnings: Vec<RunWarning>,
    /// What checks found that the scene has only recorded, in the same order: no warnings.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<RunWarning>,
    /// How often the run was looked at for these.
    pub looks: u64,
    /// Bytes of each table at the end of the run: one that is shorter was cut since.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub tables: BTreeMap<String, u64>,
    /// Known answers, to be held against `bodies.csv`.
    pub references: Vec<ReferenceCurve>,
    /// Where the scene came from, if from a file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub source: Option<SceneSource>,
    /// The scene as run. [`Results::scene`](super::Results::scene) reads it.
    pub scene: SceneRecord,
}

/// A scene as run, in SI units, parameters resolved; numbers that are infinite stand as `null`.
#[derive(Clone, Debug)]
pub struct SceneRecord(Recorded);

#[derive(Clone, Debug)]
enum Recorded {
    /// Of a run that this process makes: a fraction of what its text would take.
    Here(Arc<Scene>),
    /// Of a record that was read: its text, which takes a tenth of the memory.
    Read(Arc<RawValue>),
}

impl SceneRecord {
    /// That of a scene which runs here.
    pub fn new(scene: &Scene) -> Self {
        SceneRecord(Recorded::Here(Arc::new(scene.clone())))
    }

    /// What it says of what `X` has, as text is read: without a value of all of it, unless letters must be replaced.
    ///
    /// # Errors
    /// It is not what `X` is.
    pub(super) fn read<X: DeserializeOwned>(&self) -> serde_json::Result<X> {
        match &self.0 {
            Recorded::Read(text) if !may_steer(text.get()) => serde_json::from_str(text.get()),
            _ => serde_json::from_value(self.value()),
        }
    }

    /// What it says.
    pub fn value(&self) -> Value {
        match &self.0 {
            Recorded::Here(scene) => Manifest::record(scene),
            Recorded::Read(text) => {
                let mut value = serde_json::from_str(text.get()).unwrap_or_default();
                replace_control_characters(&mut value);
                value
            }
        }
    }
}

/// Whether JSON may have such letters, as they are or written out.
fn may_steer(text: &str) -> bool {
    text.contains(steers_text) || ["\\u", "\\b", "\\f"].iter().any(|written| text.contains(written))
}

/// A key by which the parser of JSON knows what it makes itself.
const RAW: &str = "$serde_json::private::RawValue";

/// Any JSON, which is read and not kept.
struct AnyJson;

impl<'de> Deserialize<'de> for AnyJson {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AnyJson)
    }
}

impl<'de> Visitor<'de> for AnyJson {
    type Value = AnyJson;

    fn expecting(&self, f: &mut Formatter) -> fmt::Result {
        f.write_str("JSON")
    }

    fn visit_bool<E>(self, _: bool) -> Result<AnyJson, E> {
        Ok(AnyJson)
    }

    fn visit_i64<E>(self, _: i64) -> Result<AnyJson, E> {
        Ok(AnyJson)
    }

    fn visit_u64<E>(self, _: u64) -> Result<AnyJson, E> {
        Ok(AnyJson)
    }

    fn visit_f64<E>(self, _: f64) -> Result<AnyJson, E> {
        Ok(AnyJson)
    }

    fn visit_str<E>(self, _: &str) -> Result<AnyJson, E> {
        Ok(AnyJson)
    }

    fn visit_unit<E>(self) -> Result<AnyJson, E> {
        Ok(AnyJson)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<AnyJson, A::Error> {
        while list.next_element::<AnyJson>()?.is_some() {}
        Ok(AnyJson)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<AnyJson, A::Error> {
        while let Some(key) = map.next_key::<String>()? {
            if key == RAW {
                return Err(A::Error::custom("a key that no scene has"));
            }
            map.next_value::<AnyJson>()?;
        }
        Ok(AnyJson)
    }
}

impl PartialEq for SceneRecord {
    fn eq(&self, other: &Self) -> bool {
        self.value() == other.value()
    }
}

impl Serialize for SceneRecord {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.0 {
            Recorded::Here(scene) => scene.serialize(serializer),
            Recorded::Read(_) => self.value().serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for SceneRecord {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = Value::deserialize(deserializer)?;
        let text = to_raw_value(&value).map_err(D::Error::custom)?;
        Ok(SceneRecord(Recorded::Read(text.into())))
    }
}

/// The state of another run, from which bodies begin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BegunFrom {
    /// The checkpoint or the snapshot.
    #[serde(serialize_with = "as_text")]
    pub path: PathBuf,
    /// Simulated time there [s].
    pub time: f64,
    /// What was read: its [`super::state_sum`].
    pub state_sum: String,
}

/// A scene file with what was set on the command line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SceneSource {
    /// The file.
    #[serde(serialize_with = "as_text")]
    pub path: PathBuf,
    /// Parameters and keys that have other values than in the file: name and value.
    pub set: Vec<(String, String)>,
    /// To where the run goes on, if not to the end of the scene, as the user wrote it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<String>,
    /// The text of the file when it was run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub text: Option<String>,
}

/// A path in a record, which is text: what is no letter of it is replaced, and the path is not found again.
///
/// # Errors
/// As the serializer.
pub fn as_text<S: Serializer>(path: &Path, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&path.to_string_lossy())
}

impl SceneSource {
    /// Reads the scene from its file again, to be run to where `until` says.
    ///
    /// # Errors
    /// As [`load`].
    pub fn load(&self) -> Result<Loaded, SceneError> {
        self.read(|set| load(&self.path, set))
    }

    /// Reads the scene from the recorded text, to be run to where `until` says; files that it names are looked for
    /// beside where its own lay. None where no text was recorded.
    ///
    /// # Errors
    /// As [`parse`].
    pub fn recorded(&self) -> Option<Result<Loaded, SceneError>> {
        let (name, text) = (self.path.display().to_string(), self.text.as_ref()?);
        Some(self.read(|set| parse(&name, text, set)))
    }

    /// Whether the file is not there.
    pub fn is_gone(&self) -> bool {
        !self.path.exists()
    }

    fn read(
        &self,
        read: impl Fn(&[(String, String)]) -> Result<Loaded, SceneError>,
    ) -> Result<Loaded, SceneError> {
        let mut loaded = read(&self.set)?;
        if let Some(until) = &self.until {
            // Set after the file is read: intervals that follow from the end stay as they are.
            let with_end: Vec<_> =
                self.set.iter().cloned().chain([("time.end".to_string(), until.clone())]).collect();
            loaded.scene.time.end = read(&with_end)?.scene.time.end;
        }
        Ok(loaded)
    }
}

/// How a run stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// It has not ended; or it was killed, or its disk would not take how it ended.
    Running,
    /// It reached its end time.
    Finished,
    /// The user stopped it.
    Interrupted,
    /// It took as long as it was given.
    OutOfTime,
    /// A check of the scene's `[health]` ended it.
    Stopped,
    /// It could not go on.
    Failed,
}

/// Something that makes the results of a run doubtful, at its worst.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunWarning {
    /// What kind of thing.
    pub kind: String,
    /// What is wrong, by how much, and what is allowed.
    pub message: String,
    /// What to try.
    pub advice: String,
    /// Name of the body, if it is one.
    pub body: Option<String>,
    /// Where it is worst, if it has a place [m].
    pub position: Option<[f64; 3]>,
    /// When it was found first [s].
    pub time: f64,
    /// Looks that found it.
    pub count: usize,
    /// The measure that the message gives.
    pub worst: f64,
}

/// How far a run has come, and how fast.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Performance {
    /// Threads.
    pub threads: usize,
    /// Particles in all bodies.
    pub particles: usize,
    /// Simulated time reached [s].
    pub time: f64,
    /// Steps taken.
    pub steps: u64,
    /// Wall time, outputs included [s].
    pub wall_time: f64,
    /// Particles times steps over wall time [1/s].
    pub particle_steps_per_second: f64,
    /// Wall time of each verb of the step, in the order of the step.
    pub timings: Vec<Timing>,
    /// What each rank had and did, where several shared the run, since that was begun or taken up.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ranks: Vec<RankShare>,
}

/// Wall time spent in one verb of the step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// The verb.
    pub verb: String,
    /// Wall time so far [s].
    pub seconds: f64,
}

/// A known answer for one quantity of one body, sampled over the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceCurve {
    /// Name of the body.
    pub body: String,
    /// A column of `bodies.csv`.
    pub quantity: String,
    /// What the answer assumes.
    pub label: String,
    /// Time [s] and exact value, evenly from the start to the end of the run.
    pub points: Vec<[f64; 2]>,
}

/// What stands before the sum of a record, its last entry: a CRC-32 of all bytes before this.
const SUM: &str = ",\n  \"sum\": ";
/// Samples of a reference curve over a run: smooth at the width of a page.
const SAMPLES: usize = 201;

impl Manifest {
    /// Name of the file.
    pub const FILE: &'static str = "run.json";

    /// The record of a run that begins.
    pub fn new(scene: &Scene, performance: Performance) -> Self {
        Manifest {
            program: "stickslip".to_string(),
            version: env!("CARGO_PKG_VERSION").to_string(),
            status: Status::Running,
            error: None,
            title: scene.title.clone(),
            dimension: scene.dimension.axes(),
            cell: scene.discretization.cell,
            bodies: scene.bodies.iter().map(|body| body.name.clone()).collect(),
            performance,
            relaxation: None,
            resumed: Vec::new(),
            ends: Vec::new(),
            begun_from: None,
            state_sum: None,
            scene_warnings: Vec::new(),
            warnings: Vec::new(),
            remarks: Vec::new(),
            looks: 0,
            tables: BTreeMap::new(),
            references: reference_curves(scene),
            source: None,
            scene: SceneRecord::new(scene),
        }
    }

    /// A scene as the record has it.
    pub fn record(scene: &Scene) -> Value {
        serde_json::to_value(scene).expect("a scene is plain data whose keys are text")
    }

    /// Writes the record into the folder of the run.
    ///
    /// # Errors
    /// The disk is full or refuses; then the old record stays.
    pub fn write(&self, folder: &OutputFolder) -> Result<(), OutputError> {
        replace_for_good(&folder.join(Self::FILE), |file| {
            let text = work(|| serde_json::to_string_pretty(self))?;
            let text = text.strip_suffix("\n}").expect("a record has entries, each on a line of its own");
            file.write_all(&with_sum(text.as_bytes()))
        })
    }

    /// Says in the record of a run under way that it failed: where it lies, with as many bytes as it has, which a disk
    /// takes that has no room for another record.
    ///
    /// # Errors
    /// It cannot be written, or is not that of a run under way.
    pub fn mark_as_failed(folder: &OutputFolder) -> Result<(), OutputError> {
        const FAILED: &[u8] = b"\"failed\", ";
        const RUNNING: &[u8] = b"\"running\",";
        let path = folder.join(Self::FILE);
        let mark = || -> io::Result<()> {
            let mut bytes = read_bytes(&path)?;
            let is_known = || io::Error::from(io::ErrorKind::InvalidData);
            let status = bytes.windows(RUNNING.len()).position(|found| found == RUNNING);
            let status =
                status.filter(|at| bytes[..*at].ends_with(b"\n  \"status\": ")).ok_or_else(is_known)?;
            bytes[status..status + FAILED.len()].copy_from_slice(FAILED);
            let sum = find_sum(&bytes).ok_or_else(is_known)?;
            let marked = with_sum(&bytes[..sum]);
            if marked.len() != bytes.len() {
                return Err(is_known());
            }
            // What is no file is refused.
            drop(open_file(&path)?);
            let mut file = File::options().write(true).open(&path)?;
            file.write_all(&marked)?;
            file.sync_all()
        };
        mark().map_err(OutputError::at(&path))
    }

    /// Holds the record in a folder against its own sum.
    ///
    /// # Errors
    /// It is missing, or bytes of it have changed.
    pub(super) fn verify(folder: &Path) -> Result<(), ReadError> {
        let path = folder.join(Self::FILE);
        let bytes = read_bytes(&path).map_err(|error| ReadProblem::Io(error).at(&path))?;
        let same = find_sum(&bytes).is_some_and(|end| bytes == with_sum(&bytes[..end]));
        let changed = || ReadProblem::Layout("bytes of it have changed since the run wrote it".to_string());
        if same { Ok(()) } else { Err(changed().at(&path)) }
    }

    /// Reads the record of the run that wrote a folder. Control characters in it, which steer terminals and make XML
    /// ill-formed, are replaced.
    ///
    /// # Errors
    /// There is none, another program wrote it, or its dimension or cell is none.
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let path = folder.join(Self::FILE);
        let read = || -> Result<Manifest, ReadProblem> {
            let mut fields: BTreeMap<String, Box<RawValue>> = serde_json::from_slice(&read_bytes(&path)?)?;
            let scene = fields.remove(SCENE);
            scene.as_ref().map_or(Ok(AnyJson), |text| serde_json::from_str(text.get()))?;
            let mut record = Map::new();
            for (name, text) in fields {
                record.insert(name, serde_json::from_str(text.get())?);
            }
            record.extend(scene.is_some().then(|| (SCENE.to_string(), Value::Null)));
            let mut record = Value::Object(record);
            replace_control_characters(&mut record);
            let mut manifest: Manifest = serde_json::from_value(record)?;
            let read = scene.map(|text| SceneRecord(Recorded::Read(text.into())));
            manifest.scene = read.unwrap_or(manifest.scene);
            Ok(manifest)
        };
        let manifest = read().map_err(|problem| problem.at(&path))?;
        if manifest.program != "stickslip" {
            let found = format!("it is the record of `{}`, not of stickslip", manifest.program);
            return Err(ReadProblem::Layout(found).at(&path));
        }
        let Manifest { dimension, cell, .. } = manifest;
        let is_length = cell > 0.0 && cell.is_finite();
        if !matches!(dimension, 2 | 3) || !is_length {
            let found =
                format!("found dimension {dimension} and cell {cell} m; allowed: 2 or 3, and a length");
            return Err(ReadProblem::Layout(found).at(&path));
        }
        Ok(manifest)
    }
}

/// The text of a record with its sum behind it, which always has the same length.
fn with_sum(text: &[u8]) -> Vec<u8> {
    /// Of the largest number of 32 bits.
    const DIGITS: usize = 10;
    [text, format!("{SUM}{:>DIGITS$}\n}}\n", crc32fast::hash(text)).as_bytes()].concat()
}

/// Where the sum of a record begins.
fn find_sum(bytes: &[u8]) -> Option<usize> {
    bytes.windows(SUM.len()).rposition(|found| found == SUM.as_bytes())
}

/// Puts U+FFFD in the place of each control character in a text of a record; new lines and tabs stay.
fn replace_control_characters(record: &mut Value) {
    match record {
        Value::String(text) if text.contains(steers_text) => *text = text.replace(steers_text, "\u{fffd}"),
        Value::Array(list) => list.iter_mut().for_each(replace_control_characters),
        Value::Object(map) => {
            if map.keys().any(|key| key.contains(steers_text)) {
                let entries = std::mem::take(map).into_iter();
                map.extend(entries.map(|(key, value)| (key.replace(steers_text, "\u{fffd}"), value)));
            }
            map.values_mut().for_each(replace_control_characters);
        }
        _ => {}
    }
}

fn reference_curves(scene: &Scene) -> Vec<ReferenceCurve> {
    let times = (0..SAMPLES).map(|i| scene.time.end * i as f64 / (SAMPLES - 1) as f64);
    let curve = |reference: &crate::scene::Reference| ReferenceCurve {
        body: reference.body.clone(),
        quantity: reference.quantity.clone(),
        label: reference.label.clone(),
        // JSON has no infinities: a value that is not finite has no place on a plot either.
        points: times
            .clone()
            .map(|t| [t, reference.value.at(t)])
            .filter(|[_, value]| value.is_finite())
            .collect(),
    };
    scene.references.iter().map(curve).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the parser takes for its own would be no JSON to those who ask for the scene.
    #[test]
    fn a_scene_in_a_record_is_json_and_nothing_else() {
        let is_read = |text: &str| serde_json::from_str::<AnyJson>(text).is_ok();
        assert!(is_read(r#"{"a": [1, -2.5, "b", null, true, {"c": {}}]}"#));
        for wrong in [r#"{"$serde_json::private::RawValue": 5}"#, "[1e999]", "{", "[1] 2", &"[".repeat(200)] {
            assert!(!is_read(wrong), "{wrong}");
        }
        assert!(!is_read(r#"{"a": [{"$serde_json::private::RawValue": "x"}]}"#));
    }

    /// On a disk that takes no other file: the same length, and a sum that holds.
    #[test]
    fn a_record_is_marked_where_it_lies() {
        let folder = tempfile::tempdir().unwrap();
        let out = OutputFolder::prepare(folder.path()).unwrap();
        let mut scene = Scene::new(crate::scene::Dimension::Space, 1.0, 1.0);
        scene.title = "\"status\": \"running\",".to_string();
        let manifest = Manifest::new(&scene, Performance::default());
        manifest.write(&out).unwrap();
        let bytes = std::fs::read(out.join(Manifest::FILE)).unwrap();
        Manifest::mark_as_failed(&out).unwrap();
        let found = Manifest::read(folder.path()).unwrap();
        assert_eq!((found.status, &found.title), (Status::Failed, &scene.title));
        assert_eq!(std::fs::read(out.join(Manifest::FILE)).unwrap().len(), bytes.len());
        Manifest::verify(folder.path()).unwrap();
        // One that has ended says how already.
        assert!(Manifest::mark_as_failed(&out).is_err());
        // Without its sum it is not what the run wrote.
        std::fs::write(out.join(Manifest::FILE), &bytes[..find_sum(&bytes).unwrap()]).unwrap();
        Manifest::verify(folder.path()).unwrap_err();
    }
}
