//! Several processes on two hosts: a link that is cut, a disk that is full, scenes of every kind, and memory.
//!
//! Set-up: two network namespaces, each with a host name of its own, joined by a link of 1 Gbit/s that takes 0.1 ms
//! each way: `netem` makes it, and `delayed_link.py` where the kernel has no such thing. Open MPI starts its processes
//! on the second host by a script in the place of `ssh`.
//!
//! Expected: every file has the bytes of one process's, and what was cut off or had no room goes on from its newest
//! checkpoint with another number of processes and ends in the same bits. No tolerance, but for memory.
//!
//! Needs root, `ip`, `tc`, `unshare` and `mount`, `mpirun` of Open MPI, a program with the feature `mpi`, and where
//! there is no `netem` Python and `/dev/net/tun`.
#![cfg(target_os = "linux")]

mod stickslip;

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use stickslip::{Disk, LONG, MANY_FILES, Ran, SHORT, Workplace, outcome, ranks, record, with, with_results};

/// Each of these tests takes all processors.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

fn one_at_a_time() -> MutexGuard<'static, ()> {
    ONE_AT_A_TIME.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Of the two hosts.
const ADDRESSES: [&str; 2] = ["10.77.0.1", "10.77.0.2"];
const NETWORK: &str = "10.77.0.0/24";

/// What Open MPI is told wherever it runs. Processes that wait let others run, for there may be more than processors.
const ANYWHERE: [&str; 6] = ["--oversubscribe", "--bind-to", "none", "--mca", "mpi_yield_when_idle", "1"];

/// When it takes a host for lost: after 3 s without a word it asks once a second, and after the third time without an
/// answer it ends the job.
const LOST_AFTER: [(&str, &str); 3] =
    [("oob_tcp_keepalive_time", "3"), ("oob_tcp_keepalive_intvl", "1"), ("oob_tcp_keepalive_probes", "3")];

/// In which a job ends whose link was cut: the 6 s above, 2 s in which processes are ended, and as much again for a
/// machine that does other work.
const CUT_OFF_WITHIN: Duration = Duration::from_secs(16);

/// No run of these tests takes as long.
const PATIENCE: Duration = Duration::from_secs(300);

/// Two network namespaces and the link between them, while this lives.
struct Hosts {
    names: [String; 2],
    /// Open MPI's own files and the script that it calls.
    folder: PathBuf,
    /// The program that is the link, where the kernel makes none with a delay.
    relay: Option<Child>,
}

/// What `ip` and `tc` are told, word by word; says what they answer if they refuse.
fn told(program: &str, line: &str) -> Result<(), String> {
    let output = Command::new(program).args(line.split_whitespace()).output();
    let output = output.map_err(|error| format!("{program}: {error}"))?;
    let answer = String::from_utf8_lossy(&output.stderr);
    output.status.success().then_some(()).ok_or_else(|| format!("{program} {line}: {answer}"))
}

impl Hosts {
    fn new(workplace: &Workplace) -> Self {
        static MADE: AtomicU32 = AtomicU32::new(0);
        let number = MADE.fetch_add(1, Ordering::Relaxed);
        let name = |host: &str| format!("stickslip-{}-{number}-{host}", std::process::id());
        let names = [name("a"), name("b")];
        let mut hosts = Hosts { names, folder: workplace.path("hosts"), relay: None };
        hosts.join().unwrap_or_else(|problem| {
            panic!(
                "two hosts need root, `ip`, `tc` and `unshare` (apt install iproute2 util-linux): {problem}"
            )
        });
        hosts.make_script();
        hosts
    }

    /// Makes the namespaces and the link.
    fn join(&mut self) -> Result<(), String> {
        for name in &self.names {
            told("ip", &format!("netns add {name}"))?;
        }
        if let Err(problem) = self.link_by_kernel() {
            println!("a program makes the link's delay, for the kernel does not: {}", problem.trim());
            let _ = told("ip", &format!("-n {} link delete wire", self.names[0]));
            self.link_by_relay()?;
        }
        for (name, address) in self.names.iter().zip(ADDRESSES) {
            told("ip", &format!("-n {name} address add {address}/24 dev wire"))?;
            told("ip", &format!("-n {name} link set wire up"))?;
            told("ip", &format!("-n {name} link set lo up"))?;
        }
        Ok(())
    }

    fn link_by_kernel(&self) -> Result<(), String> {
        let [a, b] = &self.names;
        told("ip", &format!("link add wire netns {a} type veth peer name wire netns {b}"))?;
        let shape =
            |name| told("tc", &format!("-n {name} qdisc add dev wire root netem delay 0.1ms rate 1gbit"));
        shape(a).and_then(|()| shape(b))
    }

    /// For kernels without `netem`.
    fn link_by_relay(&mut self) -> Result<(), String> {
        let mut relay = Command::new(std::env::var("STICKSLIP_PYTHON").unwrap_or_else(|_| "python3".into()));
        relay.arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/delayed_link.py"));
        relay.args(&self.names).args(["1e-4", "1e9"]).stdin(Stdio::piped()).stdout(Stdio::piped());
        let relay = relay.spawn().map_err(|error| format!("python3: {error}"))?;
        let said = self.relay.insert(relay).stdout.take().expect("it is piped");
        let mut line = String::new();
        BufReader::new(said).read_line(&mut line).map_err(|error| error.to_string())?;
        (line.trim() == "ready").then_some(()).ok_or_else(|| "delayed_link.py makes no link".to_string())
    }

    /// Open MPI calls it as it calls `ssh`: with a host, and a command line. What is in the environment here is not
    /// there, either.
    fn make_script(&self) {
        let (script, b) = (self.folder.join("agent"), &self.names[1]);
        for host in ["a", "b"] {
            fs::create_dir_all(self.folder.join(host)).unwrap();
        }
        let text = format!(
            "#!/bin/sh\nshift\nexec ip netns exec {b} unshare --uts env -i PATH=\"$PATH\" HOME=\"$HOME\" \
             TMPDIR={} sh -c 'hostname host-b; exec sh -c \"$0\"' \"$*\"\n",
            self.folder.join("b").display()
        );
        fs::write(&script, text).unwrap();
        fs::set_permissions(&script, fs::Permissions::from_mode(0o755)).unwrap();
    }

    /// So many processes of a command line, half of them on each host, with these parameters of Open MPI.
    fn together(&self, workplace: &Workplace, count: usize, parameters: &[(&str, &str)]) -> Command {
        let mut command = Command::new("ip");
        command.args(["netns", "exec", &self.names[0], "unshare", "--uts"]);
        command.args(["sh", "-c", "hostname host-a; exec \"$@\"", "sh", "mpirun"]).args(ANYWHERE);
        let [a, b] = ADDRESSES.map(|address| format!("{address}:{}", count / 2));
        command.args(["-n", &count.to_string(), "--host", &format!("{a},{b}")]);
        let script = self.folder.join("agent").display().to_string();
        let network = [
            ("plm_rsh_agent", &*script),
            ("btl", "tcp,self"),
            ("btl_tcp_if_include", NETWORK),
            ("oob_tcp_if_include", NETWORK),
        ];
        for (name, value) in network.iter().chain(parameters) {
            command.args(["--mca", name, value]);
        }
        command.current_dir(workplace.path("")).env("TMPDIR", self.folder.join("a"));
        command.envs(AS_ROOT);
        command
    }

    /// Takes the link down on one of the hosts, or up again.
    fn set_link(&self, host: usize, state: &str) {
        told("ip", &format!("-n {} link set wire {state}", self.names[host])).unwrap();
    }
}

impl Drop for Hosts {
    fn drop(&mut self) {
        if let Some(relay) = &mut self.relay {
            let _ = relay.kill();
            let _ = relay.wait();
        }
        for name in &self.names {
            let left = Command::new("ip").args(["netns", "pids", name]).output();
            let left =
                left.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default();
            for process in left.split_whitespace() {
                let _ = Command::new("kill").args(["-KILL", process]).status();
            }
            let _ = told("ip", &format!("netns delete {name}"));
        }
    }
}

const PROGRAM: &str = env!("CARGO_BIN_EXE_stickslip");

/// Containers have no other user.
const AS_ROOT: [(&str, &str); 2] = [("OMPI_ALLOW_RUN_AS_ROOT", "1"), ("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")];

/// So many processes on one host.
fn on_one_host(workplace: &Workplace, count: usize, words: &[&str]) -> Command {
    let mut command = Command::new("mpirun");
    command.args(ANYWHERE).args(["-n", &count.to_string(), PROGRAM]).args(words);
    command.current_dir(workplace.path("")).envs(AS_ROOT);
    command
}

fn spawn(mut command: Command) -> Child {
    command
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("`mpirun`, `ip` and `unshare` are there")
}

/// Waits for a launcher, which must end in time, and ends it if it does not.
fn ended(mut launcher: Child, within: Duration) -> Ran {
    let begun = Instant::now();
    let mut in_time = true;
    while launcher.try_wait().unwrap().is_none() {
        if begun.elapsed() > within {
            in_time = false;
            let process = launcher.id().to_string();
            let _ = Command::new("kill").args(["-TERM", &process]).status();
            std::thread::sleep(Duration::from_secs(5));
            let _ = launcher.kill();
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let output = launcher.wait_with_output().unwrap();
    let [stdout, stderr] =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    assert!(in_time, "still running after {within:?}: {stdout}{stderr}");
    Ran { code: output.status.code(), stdout, stderr }
}

/// Runs a command that must succeed.
fn succeed(command: Command) -> Ran {
    let words = format!("{command:?}");
    let ran = ended(spawn(command), PATIENCE);
    assert_eq!(ran.code, Some(0), "{words}: {}{}", ran.stdout, ran.stderr);
    ran
}

/// Every table, snapshot and picture has the same bytes in two folders, and the last states have the same sum.
fn assert_same(workplace: &Workplace, one: &str, other: &str) {
    let [one_outcome, outcome] = [one, other].map(|out| outcome(&workplace.path(out)));
    let names = |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one_outcome.0), names(&outcome.0), "files of {other}");
    for (name, bytes) in &one_outcome.0 {
        assert!(outcome.0[name] == *bytes, "{} of {other} differs", name.display());
    }
    assert!(one_outcome.1.is_string(), "{one} has ended");
    assert_eq!(one_outcome.1, outcome.1, "the last state of {other}");
}

fn checkpoints(workplace: &Workplace, out: &str) -> usize {
    let names = fs::read_dir(workplace.path(out).join("checkpoints")).into_iter().flatten().flatten();
    names.filter(|name| name.path().extension().is_some_and(|ending| ending == "checkpoint")).count()
}

/// One process on each, and two on each.
#[test]
#[ignore = "needs root and makes network namespaces"]
fn two_hosts_write_what_one_process_writes() {
    let _turn = one_at_a_time();
    let workplace = with_results(&SHORT);
    let hosts = Hosts::new(&workplace);
    for count in [2, 4] {
        let mut named = hosts.together(&workplace, count, &[]);
        named.arg("hostname");
        let names = succeed(named).stdout;
        assert_eq!(["host-a", "host-b"].map(|name| names.matches(name).count()), [count / 2; 2], "{names}");
        let out = count.to_string();
        let mut command = hosts.together(&workplace, count, &[]);
        command.args([PROGRAM, "run", "scene.toml", "--quiet", "--out", &out]).args(SHORT);
        succeed(command);
        assert_same(&workplace, "one", &out);
        let ranks = record(&workplace.path(&out))["performance"]["ranks"].clone();
        assert_eq!(ranks.as_array().map(Vec::len), Some(count));
    }
}

/// The folder of results is empty on the second host: what is there goes through the first process, and comes from it
/// where the run goes on.
#[test]
#[ignore = "needs root and makes network namespaces"]
fn results_that_one_host_does_not_see_are_those_of_one_process() {
    let _turn = one_at_a_time();
    let workplace = with_results(&LONG);
    let hosts = Hosts::new(&workplace);
    fs::create_dir(workplace.path("own")).unwrap();
    let hidden =
        "[ $(hostname) = host-a ] || { mount --make-rprivate / && mount -t tmpfs none own; }; exec \"$@\"";
    let on_both = |words: &[&str]| {
        let mut command = hosts.together(&workplace, 2, &[]);
        command.args(["unshare", "--mount", "sh", "-c", hidden, "sh", PROGRAM]).args(words);
        ended(spawn(command), PATIENCE)
    };
    let words = with(&["run", "scene.toml", "--quiet", "--out", "own/out", "--max-time", "1s"], &LONG);
    let stopped = on_both(&words);
    assert_eq!(stopped.code, Some(4), "{}", stopped.stderr);
    assert!(checkpoints(&workplace, "own/out") > 0);
    let resumed = on_both(&["resume", "own/out", "--quiet", "--threads", "1"]);
    assert_eq!(resumed.code, Some(0), "{}", resumed.stderr);
    assert_same(&workplace, "one", "own/out");
}

/// `-x` takes a variable to the other host: there each process has a run of its own, too.
#[test]
#[ignore = "needs root and makes network namespaces"]
fn processes_on_two_hosts_are_alone_where_they_are_told_so() {
    let _turn = one_at_a_time();
    let workplace = with_results(&SHORT);
    let hosts = Hosts::new(&workplace);
    let mut command = hosts.together(&workplace, 2, &[]);
    command.env("STICKSLIP_ALONE", "1").args(["-x", "STICKSLIP_ALONE", "sh", "-c"]);
    command.args(["exec \"$@\" --out alone$OMPI_COMM_WORLD_RANK", "sh"]);
    command.args([PROGRAM, "run", "scene.toml", "--quiet"]).args(SHORT);
    succeed(command);
    assert_same(&workplace, "one", "alone0");
    assert_same(&workplace, "one", "alone1");
}

/// On either host: Open MPI takes the other one for lost, says so and ends all processes on both. The run goes on from
/// its newest checkpoint, with three processes on one host.
#[test]
#[ignore = "needs root and makes network namespaces; takes a minute"]
fn a_run_whose_link_is_cut_ends_and_goes_on_with_another_number() {
    let _turn = one_at_a_time();
    let workplace = with_results(&LONG);
    let hosts = Hosts::new(&workplace);
    for (count, host) in [(2, 0), (4, 1)] {
        let out = format!("cut on host {host}");
        let mut command = hosts.together(&workplace, count, &LOST_AFTER);
        command.args([PROGRAM, "run", "scene.toml", "--quiet", "--out", &out]).args(LONG);
        let mut launcher = spawn(command);
        let begun = Instant::now();
        while checkpoints(&workplace, &out) < 2 {
            assert!(
                launcher.try_wait().unwrap().is_none() && begun.elapsed() < PATIENCE,
                "there are checkpoints soon"
            );
            std::thread::sleep(Duration::from_millis(10));
        }
        hosts.set_link(host, "down");
        let cut = Instant::now();
        let ran = ended(launcher, CUT_OFF_WITHIN);
        println!("{count} processes: the launcher ended {:.1} s after the cut", cut.elapsed().as_secs_f64());
        while !ranks(&out).is_empty() {
            assert!(cut.elapsed() < CUT_OFF_WITHIN, "ranks are left: {:?}", ranks(&out));
            std::thread::sleep(Duration::from_millis(10));
        }
        println!("{count} processes: the last rank ended {:.1} s after the cut", cut.elapsed().as_secs_f64());
        assert!(ran.code.is_some_and(|code| code != 0), "{:?}", ran.code);
        assert!(ran.stderr.contains("lost communication with a remote daemon"), "{}", ran.stderr);
        assert!(ran.stderr.contains(ADDRESSES[1]), "the lost host is named: {}", ran.stderr);
        assert_eq!(record(&workplace.path(&out))["status"], "running");
        hosts.set_link(host, "up");
        succeed(on_one_host(&workplace, 3, &["resume", &out, "--quiet", "--threads", "1"]));
        assert_same(&workplace, "one", &out);
    }
}

/// What is wrong is said once, all end, what is there can be read, and once there is room the run goes on with another
/// number of processes.
#[test]
#[ignore = "needs root, and mounts a disk"]
fn a_run_whose_disk_is_full_ends_and_goes_on_with_another_number() {
    let _turn = one_at_a_time();
    let words = with(&MANY_FILES, &["--threads", "1"]);
    let workplace = with_results(&words);
    let disk =
        Disk::mount(workplace.path("disk"), 700).expect("a disk that is full needs root, who may mount one");
    let words = with(&["run", "scene.toml", "--quiet", "--out", "disk/out"], &words);
    let ran = ended(spawn(on_one_host(&workplace, 3, &words)), PATIENCE);
    assert_eq!(ran.code, Some(1), "{}", ran.stderr);
    assert_eq!(ran.stderr.matches("error: cannot write disk/out/").count(), 1, "{}", ran.stderr);
    assert!(ran.stderr.contains("No space left on device"), "{}", ran.stderr);
    let checked = workplace.succeed(&["check", "disk/out"]);
    assert!(checked.contains("are as the run wrote them"), "{checked}");
    // Tables have the rows of the whole run as far as they go, and snapshots are whole.
    let [whole, written] = ["one", "disk/out"].map(|out| files(&workplace.path(out)));
    assert!(written.keys().any(|name| name.starts_with("particles")), "{:?}", written.keys());
    for (name, bytes) in &written {
        let same = match name.extension().and_then(|kind| kind.to_str()) {
            Some("csv") => whole[name].starts_with(bytes) && bytes.ends_with(b"\n"),
            Some("vtu") => whole[name] == *bytes,
            _ => true,
        };
        assert!(same, "{} is not what it should be", name.display());
    }
    disk.grow();
    assert!(checkpoints(&workplace, "disk/out") > 0);
    succeed(on_one_host(&workplace, 2, &["resume", "disk/out", "--quiet", "--threads", "1"]));
    assert_same(&workplace, "one", "disk/out");
}

/// Files of a run that has not ended, by their names in its folder, but for its record, its checkpoints and what has no
/// name of its own yet.
fn files(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    outcome(out)
        .0
        .into_iter()
        .filter(|(name, _)| name.extension().is_none_or(|kind| kind != "part"))
        .collect()
}

/// 512 balls, each of which touches its neighbours.
const BALLS: &str = r#"
[parameters]
cell = "31.25 mm"
radius = "2 * cell"
[space]
dimension = "3d"
interior = "grid"
cell = "cell"
basis = "linear"
[time]
end = "10 ms"
[materials.rubber]
density = "1000 kg/m^3"
neo_hookean = { bulk_modulus = "6 MPa", shear_modulus = "3 MPa" }
[[bodies]]
name = "ball {i} {j} {k}"
repeat = { k = 8, j = 8, i = 8 }
material = "rubber"
shape.ball = { center = ["2 * i * radius", "2 * j * radius", "2 * k * radius"], radius = "radius" }
velocity = ["8 - (i - 3.5) / 4", "5 - (j - 3.5) / 4", "3 - (k - 3.5) / 4"]
spin = ["3 - i", "j - 3", 2]
[[contact]]
friction = 0.3
[outputs]
tables = "1 ms"
particles = "5 ms"
"#;

/// Five blocks on each other, each a little further to one side.
const STACK: &str = r#"
gravity = [0.5, 0, -9.81]
[space]
dimension = "3d"
interior = "grid"
cell = 0.1
domain = { min = [-1, -1, 0], max = [2, 2, 3], z_min = "fixed" }
[time]
end = 0.1
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 3e5, poisson_ratio = 0.3 }
[[bodies]]
name = "block {i}"
repeat = { i = 5 }
material = "rubber"
shape.box = { min = ["0.05 * i", 0, "0.4 * i"], max = ["1 + 0.05 * i", 0.8, "0.4 * i + 0.4"] }
[[contact]]
friction = 0.4
[outputs]
tables = 0.005
particles = 0.05
"#;

/// A beam of four pieces that are glued to each other, with a weight on it.
const GLUED: &str = r#"
gravity = [0, -9.81]
[space]
dimension = "plane-strain"
interior = "grid"
cell = 0.05
domain = { min = [0, -1], max = [4, 2], x_min = "fixed" }
[time]
end = 0.3
[materials.soft]
density = 1000
neo_hookean = { young_modulus = 1e6, poisson_ratio = 0.3 }
[materials.hard]
density = 2000
neo_hookean = { young_modulus = 1e7, poisson_ratio = 0.3 }
[[bodies]]
name = "piece {i}"
repeat = { i = 4 }
material = "soft"
shape.box = { min = ["0.75 * i", 0], max = ["0.75 * i + 0.75", 0.5] }
[[bodies]]
name = "weight"
material = "hard"
shape.ball = { center = [2.6, 0.8], radius = 0.3 }
[[contact]]
between = ["weight", "any"]
friction = 0.3
[[contact]]
law = "glued"
[outputs]
tables = 0.005
particles = 0.05
grid = 0.1
"#;

/// Half a ball at a mirror and a whole ball near it, on a half-space.
const MIRROR: &str = r#"
gravity = [0, 0, -9.81]
[space]
dimension = "3d"
interior = "grid"
cell = 0.1
domain = { min = [-1, 0, -1], max = [3, 2, 3], y_min = "symmetry" }
[time]
end = 0.3
[materials.rubber]
density = 1000
neo_hookean = { young_modulus = 2e5, poisson_ratio = 0.3 }
[[bodies]]
name = "half a ball"
material = "rubber"
velocity = [2, 0, -2]
spin = [0, -4, 0]
shape.intersection = [
    { ball = { center = [0, 0, 0.55], radius = 0.5 } },
    { half_space = { point = [0, 0, 0], normal = [0, -1, 0] } },
]
[[bodies]]
name = "ball"
material = "rubber"
shape.ball = { center = [1.1, 0.45, 0.41], radius = 0.4 }
[[bodies]]
name = "floor"
material = "rubber"
shape.half_space = { point = [0, 0, 0], normal = [0, 0, 1] }
rigid = {}
[[contact]]
friction = 0.3
[outputs]
tables = 0.005
particles = 0.1
surfaces = 0.1
"#;

macro_rules! paper {
    ($name:literal) => {
        include_str!(concat!("../../scenes/paper/", $name, ".toml"))
    };
}

/// One to four processes on one host.
fn assert_any_number_writes_the_same(name: &str, scene: &str, values: &[&str]) {
    let _turn = one_at_a_time();
    let workplace = Workplace::new();
    workplace.write("scene.toml", scene);
    let values = values.iter().flat_map(|value| ["--set", value]).collect::<Vec<_>>();
    for count in 1..=4 {
        let out = count.to_string();
        let words = with(&["run", "scene.toml", "--quiet", "--threads", "1", "--out", &out], &values);
        let begun = Instant::now();
        succeed(on_one_host(&workplace, count, &words));
        let performance = record(&workplace.path(&out))["performance"].clone();
        println!(
            "{name}: {} particles, {} steps, {count} processes, {:.1} s",
            performance["particles"],
            performance["steps"],
            begun.elapsed().as_secs_f64()
        );
        assert_eq!(performance["ranks"].as_array().map_or(1, Vec::len), count, "{name}");
        assert_same(&workplace, "1", &out);
    }
}

#[test]
#[ignore = "takes a minute"]
fn any_number_of_processes_packs_512_balls() {
    assert_any_number_writes_the_same("balls", BALLS, &[]);
}

#[test]
#[ignore = "takes half a minute"]
fn any_number_of_processes_stacks_glues_and_mirrors() {
    for (name, scene) in [("stack", STACK), ("glued", GLUED), ("mirror", MIRROR)] {
        assert_any_number_writes_the_same(name, scene, &[]);
    }
}

/// Coarse and short.
#[test]
#[ignore = "takes minutes"]
fn any_number_of_processes_reproduces_the_paper() {
    let rolling = ["cells_per_radius=4", "time.end=0.2"];
    for (name, scene) in [
        ("backspin", paper!("backspin")),
        ("inclined_plane_slip", paper!("inclined_plane_slip")),
        ("inclined_plane_no_slip", paper!("inclined_plane_no_slip")),
    ] {
        assert_any_number_writes_the_same(name, scene, &rolling);
    }
    // Pictures of fringes take longer than the steps.
    let rarely = "outputs.fringes.interval=2 * transit";
    for (name, scene, cells) in [
        ("disks_collinear", paper!("disks_collinear"), "cells_per_diameter=20"),
        ("disks_glued", paper!("disks_glued"), "cells_per_diameter=20"),
        ("disks_zigzag", paper!("disks_zigzag"), "cells_per_diameter=20"),
        ("disks_plate", paper!("disks_plate"), "cells_per_diameter=16"),
    ] {
        assert_any_number_writes_the_same(name, scene, &[cells, rarely]);
    }
}

/// What MPI takes for itself in each process, and what of particles is on its way at a time [bytes].
const OF_MPI: f64 = 40e6;
/// How much more than its share of the particles' memory a rank may have.
const ALLOWED: f64 = 1.2;

/// The most memory that each rank of a run had resident, the first rank's first [bytes].
fn peaks(mut launcher: Child, out: &str) -> (Child, Vec<f64>) {
    let mut peaks = BTreeMap::<usize, f64>::new();
    let begun = Instant::now();
    while launcher.try_wait().unwrap().is_none() && begun.elapsed() < PATIENCE {
        for (rank, pid) in ranks(out) {
            let status = fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
            let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:")?.strip_suffix("kB"));
            if let Some(peak) = peak.and_then(|peak| peak.trim().parse::<f64>().ok()) {
                let most = peaks.entry(rank).or_default();
                *most = most.max(1024.0 * peak);
            }
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    (launcher, peaks.into_values().collect())
}

/// Peaks of the ranks of a run by so many processes on one host.
fn peaks_of_run(workplace: &Workplace, count: usize, (words, out): (&[&str], &str), code: i32) -> Vec<f64> {
    let launcher = spawn(on_one_host(workplace, count, &with(words, &["--quiet"])));
    let (launcher, peaks) = peaks(launcher, out);
    let ran = ended(launcher, PATIENCE);
    assert_eq!(ran.code, Some(code), "{}", ran.stderr);
    assert_eq!(peaks.len(), count, "all were seen");
    let megabytes = peaks.iter().map(|peak| format!("{:.0}", peak / 1e6)).collect::<Vec<_>>().join(", ");
    println!("{} by {count} processes, peak of each rank: {megabytes} MB", words[0]);
    peaks
}

/// Holds peaks of ranks against that of one process.
fn assert_share(peaks: &[f64], one: f64) {
    let allowed = ALLOWED * one / peaks.len() as f64 + OF_MPI;
    for (rank, peak) in peaks.iter().enumerate() {
        let (count, [peak, allowed]) = (peaks.len(), [*peak, allowed].map(|bytes| bytes / 1e6));
        assert!(peak <= allowed, "rank {rank} of {count} had {peak:.0} MB, more than {allowed:.0}");
    }
}

/// Problem P5 of the bench with two million particles, and what a scene has beside it. Columns are named, so that one
/// process draws no picture.
fn cube(beside: &str) -> (Workplace, Vec<&'static str>) {
    let workplace = Workplace::new();
    let named = "[outputs.snapshots]\ncolumns = [\"velocity\", \"stress\", \"deformation\", \"mass\"]\n";
    workplace.write("scene.toml", &[include_str!("../../scenes/bench/cube.toml"), named, beside].concat());
    let words = ["run", "scene.toml", "--threads", "1", "--checkpoint-every", "never", "--set", "cells=63"];
    (workplace, with(&words, &["--set", "time.end=0.003", "--set", "outputs.particles=1"]))
}

/// Snapshots have the same bytes from any number of processes; stopped with a checkpoint, and taken up by another
/// number.
#[test]
#[ignore = "takes minutes, and some 4 GB"]
fn memory_of_a_rank_falls_with_their_number() {
    let _turn = one_at_a_time();
    let (workplace, words) = cube("");
    let snapshots = |out: &str| {
        let of = |number: usize| workplace.path(&format!("{out}/particles/{number:05}.vtu"));
        [0, 1].map(|number| fs::read(of(number)).unwrap())
    };
    let alone = "memory of 1";
    let one = peaks_of_run(&workplace, 1, (&with(&words, &["--out", alone]), alone), 0)[0];
    let expected = snapshots(alone);
    for count in [2, 4] {
        // A name that is in the words of no other process.
        let out = format!("memory of {count}");
        assert_share(&peaks_of_run(&workplace, count, (&with(&words, &["--out", &out]), &out), 0), one);
        assert!(snapshots(&out) == expected, "{count} write what one writes");
        let stopped = format!("memory of stopped {count}");
        let briefly = with(&words, &["--max-time", "4s", "--out", &stopped]);
        assert_share(&peaks_of_run(&workplace, count, (&briefly, &stopped), 4), one);
        let others = 6 - count;
        let resumed = ["resume", &stopped, "--threads", "1"];
        assert_share(&peaks_of_run(&workplace, others, (&resumed, &stopped), 0), one);
        assert!(snapshots(&stopped) == expected, "{others} go on as one");
    }
}

/// A load that acts on every particle.
#[test]
#[ignore = "takes minutes, and some 4 GB"]
fn memory_of_loads_falls_with_the_number_of_ranks() {
    let _turn = one_at_a_time();
    let (workplace, words) = cube("[[loads]]\nbody = \"cube\"\nacceleration = [0, 0, -10]\n");
    let run = |count: usize| {
        let out = format!("memory of loads of {count}");
        let peaks = peaks_of_run(&workplace, count, (&with(&words, &["--out", &out]), &out), 0);
        (peaks, fs::read(workplace.path(&format!("{out}/particles/00001.vtu"))).unwrap())
    };
    let (one, expected) = run(1);
    for count in [2, 4] {
        let (peaks, snapshot) = run(count);
        assert_share(&peaks, one[0]);
        assert!(snapshot == expected, "{count} write what one writes");
    }
}

/// What a body may take in the memory of a rank that has nothing of it [bytes]: 400 that stay, most of them its entry
/// in the scene, and what reading that takes for a moment.
const OF_A_BODY_ELSEWHERE: f64 = 800.0;

/// One rank has a block, the other as many particles: in one body, and each in a body of its own.
#[test]
#[ignore = "takes a minute"]
fn bodies_elsewhere_take_little_memory() {
    let _turn = one_at_a_time();
    let workplace = Workplace::new();
    let least = |name: &str, other: &str| {
        let scene = format!(
            r#"
            space = {{ dimension = "3d", interior = "grid", cell = 1, basis = "linear" }}
            time.end = 0.01
            outputs.tables = 0.01
            materials.sand = {{ density = 1000, neo_hookean = {{ young_modulus = 1e6, poisson_ratio = 0.3 }} }}
            [[bodies]]
            name = "block"
            material = "sand"
            shape.box = {{ min = [300, 0, 0], max = [320, 20, 20] }}
            [[bodies]]
            material = "sand"
            particles_per_side = 1
            {other}
            "#
        );
        let file = format!("{name}.toml");
        workplace.write(&file, &scene);
        let words = ["run", &file, "--threads", "1", "--out", name];
        peaks_of_run(&workplace, 2, (&words, name), 0).into_iter().fold(f64::INFINITY, f64::min)
    };
    let together = least("together", "name = \"other\"\nshape.box = { min = [0, 0, 0], max = [40, 40, 40] }");
    let ends = [1, 2].map(|end| ["i", "j", "k"].map(|place| format!("4 * {place} + {end}")));
    let grains = format!(
        "name = \"grain {{i}} {{j}} {{k}}\"\nrepeat = {{ i = 40, j = 40, k = 40 }}\n\
         shape.box = {{ min = {:?}, max = {:?} }}",
        ends[0], ends[1]
    );
    let apart = least("apart", &grains);
    let each = (apart - together) / f64::from(40_i32.pow(3));
    println!("a body that is elsewhere takes {each:.0} bytes");
    assert!(each <= OF_A_BODY_ELSEWHERE, "a body that is elsewhere takes {each:.0} bytes");
}
