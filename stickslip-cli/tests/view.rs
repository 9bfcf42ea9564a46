//! The viewer: its server from outside, and its page in a real browser.
//!
//! The latter needs Chromium with its driver and a Python with the package `selenium`, as the report does.

mod stickslip;

use serde_json::Value;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use stickslip::{Workplace, new_scene};

/// A process that ends with it.
struct Ended(Child);

impl Drop for Ended {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// A server of the command, which ends with it.
struct Server {
    _process: Ended,
    address: String,
}

/// What a server answers: its code, its head and the rest.
struct Answer {
    code: u16,
    head: String,
    body: Vec<u8>,
}

impl Server {
    fn start(workplace: &Workplace, arguments: &[&str]) -> Self {
        let arguments = [&["view", "--no-open"], arguments].concat();
        let mut child = workplace.command(&arguments).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let address = line.split_whitespace().next().expect("the first word is the address").to_owned();
        Server { _process: Ended(child), address }
    }

    fn host(&self) -> &str {
        self.address.strip_prefix("http://").and_then(|rest| rest.strip_suffix('/')).unwrap()
    }

    /// Sends a request as it stands, with the lines of its head.
    fn ask(&self, request: &str, head: &[&str]) -> Answer {
        let mut stream = TcpStream::connect(self.host()).unwrap();
        let head: String = head.iter().map(|line| format!("{line}\r\n")).collect();
        write!(stream, "{request} HTTP/1.1\r\n{head}Connection: close\r\n\r\n").unwrap();
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        let end = bytes.windows(4).position(|window| window == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let code = head.split_whitespace().nth(1).unwrap().parse().unwrap();
        Answer { code, head, body: bytes[end + 4..].to_vec() }
    }

    fn get(&self, path: &str) -> Answer {
        self.ask(&format!("GET {path}"), &[&format!("Host: {}", self.host())])
    }

    fn json(&self, path: &str) -> Value {
        let Answer { code, body, .. } = self.get(path);
        assert_eq!(code, 200, "{path}: {}", String::from_utf8_lossy(&body));
        serde_json::from_slice(&body).unwrap()
    }
}

/// A folder of results of the scene that `stickslip new` writes, coarse and short.
fn results() -> Workplace {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let short =
        ["--set", "cells_per_radius=4", "--set", "time.end=0.25 s", "--set", "outputs.particles=0.05 s"];
    workplace.succeed(&[&["run", "scene.toml"][..], &short].concat());
    workplace
}

#[test]
fn what_is_in_the_folder_is_served_and_nothing_else() {
    let workplace = results();
    let server = Server::start(&workplace, &["scene.results"]);
    let page = server.get("/");
    assert_eq!(page.code, 200);
    assert!(page.body.starts_with(b"<!DOCTYPE html><!-- Stickslip -->"));
    assert!(page.head.contains("Content-Security-Policy: default-src 'none'"), "{}", page.head);
    assert!(page.head.contains("Connection: close"), "connections that stay open keep others waiting");

    let index = server.json("/index");
    assert_eq!((index["times"].as_array().unwrap().len(), index["bodies"].as_array().unwrap().len()), (6, 2));
    assert_eq!(server.json("/pulse")["frames"], 6);
    assert!(server.json("/energy")["total"].as_array().unwrap().len() > 5);
    assert!(server.json("/body/0")["wz"].as_array().unwrap().len() > 5);
    let contacts: Vec<Value> = (0..6).map(|frame| server.json(&format!("/contacts/{frame}"))).collect();
    assert!(contacts.iter().all(|told| told["largest"].as_f64() > Some(0.0)), "{contacts:?}");
    // The second frame is in the first bounce, and at the start nothing has touched.
    let touching = |frame: usize| contacts[frame]["contacts"].as_array().unwrap().len();
    assert!((touching(0), touching(1)) == (0, 1), "{contacts:?}");

    // The count, and eight bytes a particle behind the head and the bodies.
    let frame = server.get("/frame/5").body;
    let word = |at: usize| u32::from_le_bytes(frame[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((&frame[..4], word(8)), (&b"SSV1"[..], 2));
    assert!(word(4) > 100 && frame.len() >= 72 + 2 * 16 + 8 * word(4));
    for quantity in ["pressure", "velocity", "velocity.x", "stress.xy", "deformation.volume_ratio"] {
        assert_eq!(server.get(&format!("/column/5/{quantity}")).body.len(), 16 + 4 * word(4), "{quantity}");
    }
    let skins = server.get("/skins").body;
    let corners = u32::from_le_bytes(skins[4..8].try_into().unwrap()) as usize;
    assert!(skins.starts_with(b"SSK1") && corners > 50);
    assert_eq!(server.get("/skins/5").body.len(), 12 * corners);
    assert_eq!(server.get("/skins/5/pressure").body.len(), 16 + 4 * corners);
    let history = server.json("/particle/0/7/velocity");
    assert_eq!(
        (history["time"].as_array().unwrap().len(), history["value"].as_array().unwrap().len()),
        (6, 6)
    );
    assert!(server.get("/fringes/2").body.starts_with(b"\x89PNG"));

    for missing in
        ["/frame/6", "/column/0/charm", "/body/2", "/run.json", "/../scene.toml", "/frame/../../run.json"]
    {
        assert_eq!(server.get(missing).code, 404, "{missing}");
    }
    let told = String::from_utf8(server.get("/column/0/charm").body).unwrap();
    assert!(told.contains("found `charm`; allowed: ") && told.contains("pressure"), "{told}");
}

#[test]
fn other_machines_and_other_pages_are_refused() {
    let workplace = results();
    let server = Server::start(&workplace, &["scene.results"]);
    assert!(server.address.starts_with("http://127.0.0.1:"), "loopback only: {}", server.address);
    let host = format!("Host: {}", server.host());
    let refused = |request: &str, head: &[&str]| server.ask(request, head).code;
    assert_eq!(refused("GET /index", &["Host: evil.example"]), 403);
    assert_eq!(refused("GET /index", &[&host, "Origin: http://evil.example"]), 403);
    assert_eq!(refused("GET /frame/0", &[&host, "Sec-Fetch-Site: cross-site"]), 403);
    assert_eq!(refused("POST /index", &[&host, "Content-Length: 0"]), 405);
    assert_eq!(
        refused("GET /index", &[&host, &format!("Origin: {}", server.address.trim_end_matches('/'))]),
        200
    );
}

/// Announced bodies, heads that come slowly or never end, and connections that say nothing: others are answered
/// meanwhile, and Ctrl-C ends the server.
#[test]
fn nobody_keeps_the_viewer_from_answering() {
    let workplace = results();
    let mut server = Server::start(&workplace, &["scene.results"]);
    let head = |more: &str| format!("GET / HTTP/1.1\r\nHost: {}\r\n{more}", server.host());
    let open = |bytes: &str| {
        let mut stream = TcpStream::connect(server.host()).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        stream.write_all(bytes.as_bytes()).unwrap();
        stream
    };
    let answered = |mut stream: TcpStream| {
        let mut bytes = Vec::new();
        // What was sent beyond a head may reset the connection behind the answer.
        let _ = stream.read_to_end(&mut bytes);
        String::from_utf8_lossy(&bytes).split(' ').nth(1).unwrap_or_default().to_owned()
    };
    let is_prompt = || {
        let begun = Instant::now();
        assert_eq!(server.get("/pulse").code, 200);
        assert!(begun.elapsed() < Duration::from_secs(2), "{:?}", begun.elapsed());
    };
    for length in ["1000000", "99999999999999", "18446744073709551615", "-1", "x"] {
        assert_eq!(answered(open(&head(&format!("Content-Length: {length}\r\n\r\n")))), "200", "{length}");
        let post = format!("POST / HTTP/1.1\r\nContent-Length: {length}\r\n\r\n");
        assert_eq!(answered(open(&post)), "405", "{length}");
    }
    // More than a browser opens, of each kind; a server of six threads would wait for any of them.
    let waiting: Vec<TcpStream> = (0..8)
        .flat_map(|_| ["", "GET / HT", &head(""), &head("Content-Length: 1000000\r\n\r\n")].map(open))
        .collect();
    is_prompt();
    assert_eq!(answered(open(&head(&"x".repeat(1 << 20)))), "431");
    assert_eq!(answered(open(&head(&format!("{}\r\n", "a: b\r\n".repeat(1000))))), "431");
    assert_eq!(answered(open("\0\r\n\r\n")), "400");
    is_prompt();
    // Five seconds are what a head gets.
    let codes: Vec<String> = waiting.into_iter().map(answered).collect();
    let count = |code: &str| codes.iter().filter(|found| *found == code).count();
    assert_eq!((count("408"), count("200")), (24, 8), "{codes:?}");

    let _silent: Vec<TcpStream> = (0..100).map(|_| open("")).collect();
    let begun = Instant::now();
    let pid = server._process.0.id().to_string();
    assert!(Command::new("kill").args(["-s", "INT", &pid]).status().unwrap().success());
    assert_eq!(server._process.0.wait().unwrap().code(), Some(0));
    assert!(begun.elapsed() < Duration::from_secs(3), "{:?}", begun.elapsed());
}

#[test]
fn a_run_that_goes_on_is_followed() {
    let workplace = results();
    let list = workplace.path("scene.results/particles.pvd");
    let whole = std::fs::read_to_string(&list).unwrap();
    let earlier: Vec<&str> = whole.lines().filter(|line| !line.contains("00005.vtu")).collect();
    std::fs::write(&list, earlier.join("\n")).unwrap();
    let server = Server::start(&workplace, &["scene.results"]);
    assert_eq!(server.json("/pulse")["frames"], 5);
    assert_eq!(server.get("/frame/5").code, 404);
    std::fs::write(&list, whole).unwrap();
    assert_eq!(server.json("/pulse")["frames"], 6);
    assert_eq!(server.json("/index")["times"].as_array().unwrap().len(), 6);
    assert_eq!(server.get("/frame/5").code, 200);
}

#[test]
fn a_scene_is_seen_before_it_runs() {
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    let server = Server::start(&workplace, &["scene.toml", "--set", "cells_per_radius=3"]);
    let index = server.json("/index");
    assert_eq!(index["times"], serde_json::json!([0.0]));
    assert!(server.get("/frame/0").body.len() > 500);
    drop(server);
    assert_eq!(std::fs::read_dir(workplace.path("")).unwrap().count(), 1, "nothing is left beside the scene");
}

#[test]
fn one_file_names_its_size_and_replaces_no_others() {
    let workplace = results();
    let said = workplace.succeed(&["view", "scene.results", "--html", "seen.html", "--frames", "3"]);
    assert!(said.contains("3 frames of") && said.contains("at most"), "{said}");
    let page = std::fs::read_to_string(workplace.path("seen.html")).unwrap();
    for route in ["/index", "/energy", "/frame/2", "/column/2/pressure", "/body/1", "/contacts/2"] {
        assert!(page.contains(&format!("data-route=\"{route}\"")), "{route}");
    }
    assert!(page.contains("data-route=\"/skins/2/pressure\"") && said.contains("and surfaces"), "{said}");
    assert!(!page.contains("data-route=\"/frame/3\""));
    workplace.succeed(&["view", "scene.results", "--html", "seen.html", "--columns", "stress.xy"]);

    workplace.write("thesis.html", "years of work");
    workplace.write("homepage.html", "<!DOCTYPE html><title>mine</title>");
    for (wrong, word) in [
        (&["scene.results", "--html", "thesis.html"][..], "no page in HTML"),
        (&["scene.results", "--html", "homepage.html"], "does not say that Stickslip made it"),
        (&["scene.results", "--html", "seen.html", "--columns", "charm"], "allowed: velocity"),
        (&["scene.results", "--set", "cells_per_radius=2"], "allowed with a scene file"),
        (&["nowhere"], "nowhere"),
    ] {
        let ran = workplace.run(&[&["view"], wrong].concat());
        assert_eq!(ran.code, Some(2), "{wrong:?}: {}", ran.stderr);
        assert!(ran.stderr.contains(word), "{wrong:?}: {}", ran.stderr);
    }
}

/// What a reader does with a page, and what comes of it; `None` where there is no browser and nobody requires one.
fn use_viewer(address: &str) -> Option<Value> {
    let python = stickslip::python_with_browser()?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/look_at_viewer.py");
    let mut command = Command::new(&python);
    command.arg(script).arg(address).args(std::env::var_os("STICKSLIP_TEST_SCREENSHOT"));
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    Some(serde_json::from_slice(&output.stdout).unwrap())
}

fn assert_works(told: &Value, address: &str) {
    for nothing in ["complaints", "requests"] {
        assert_eq!(told[nothing], Value::Array(Vec::new()), "{nothing} at {address}");
    }
    let seen = |state: &str, what: &str| told[state][what].as_f64().unwrap();
    assert!(seen("loaded", "inked") > 0.02, "{told}");
    assert!(seen("colored", "colors") > 20.0, "a column has many colours: {told}");
    assert_eq!(seen("without_bodies", "inked"), 0.0, "{told}");
    assert!(seen("cut", "inked") < 0.9 * seen("with_bodies", "inked"), "{told}");
    let text = |name: &str| told[name].as_str().unwrap();
    assert!(text("colorbar").contains("speed [") && text("colorbar").contains("m/s]"), "{told}");
    assert!(text("picked").contains("particle") && text("picked").contains("speed"), "{told}");
    assert!(text("forces").contains("contacts"), "{told}");
    assert!(text("readout").contains("kinetic") && text("readout").contains("J"), "{told}");
    assert!(text("cut_at").contains("to ") && text("cut_at").contains('m'), "{told}");
    assert_eq!(told["saved"]["bar"], true, "{told}");
    assert!(told["sides"].as_object().unwrap().values().all(|inked| inked.as_f64() > Some(0.02)), "{told}");
    let charts: Vec<&str> = told["charts"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert!(charts[0].starts_with("Energy") && charts[2].contains("particle"), "{charts:?}");
}

fn assert_surfaces(told: &Value) {
    let seen = |state: &str| told[state]["inked"].as_f64().unwrap();
    let share = seen("surfaces") / seen("with_bodies");
    assert!((share - 1.0).abs() < 0.1, "surfaces cover what particles do: {told}");
}

#[test]
fn a_reader_plays_colours_picks_and_cuts_in_a_browser() {
    let workplace = results();
    let server = Server::start(&workplace, &["scene.results"]);
    let Some(told) = use_viewer(&server.address) else { return };
    assert_works(&told, &server.address);
    assert_eq!(told["played_to"], 5);
    assert!(told["velocities"].as_str().unwrap().contains("m/s"), "{told}");
    assert_eq!(told["fringes"], true, "the scene is plane");
    assert_surfaces(&told);

    workplace.succeed(&["view", "scene.results", "--html", "seen.html"]);
    let address = format!("file://{}", workplace.path("seen.html").display());
    let told = use_viewer(&address).unwrap();
    assert_works(&told, &address);
    assert_surfaces(&told);
}

/// A disk that lies on a bar for as long as somebody looks: frames come by themselves, unless the reader looks back, and
/// the end is told.
#[test]
fn a_run_that_goes_on_is_followed_in_a_browser() {
    let Some(python) = stickslip::python_with_browser() else { return };
    let workplace = Workplace::new();
    workplace.write("scene.toml", &new_scene());
    // Undamped, so coarse a disk bounces on for 15 s of its time and then leaves the domain.
    let long = [
        "cells_per_radius=3",
        "bodies[0].velocity=[0, 0]",
        "damping.viscous=20",
        "time.end=1000 s",
        "outputs.particles=0.2 s",
    ];
    let set = long.iter().flat_map(|value| ["--set", value]);
    let arguments: Vec<&str> =
        ["run", "scene.toml", "--threads", "1", "--max-time", "5 min"].into_iter().chain(set).collect();
    let mut run = workplace.command(&arguments);
    let running = Ended(run.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap());
    let start = Instant::now();
    while !workplace.path("scene.results/particles.pvd").exists() {
        assert!(start.elapsed() < Duration::from_secs(60), "the run has not begun");
        std::thread::sleep(Duration::from_millis(50));
    }
    let server = Server::start(&workplace, &["scene.results"]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/look_at_viewer.py");
    let mut look = Command::new(&python);
    let mut look =
        Ended(look.arg(script).args(["--follow", &server.address]).stdout(Stdio::piped()).spawn().unwrap());
    let mut said = BufReader::new(look.0.stdout.take().unwrap());
    let mut line = String::new();
    said.read_line(&mut line).unwrap();
    assert_eq!(line.trim(), "followed");
    let interrupt = Command::new("kill").args(["-INT", &running.0.id().to_string()]).status();
    assert!(interrupt.is_ok_and(|status| status.success()));
    let told: Value = serde_json::from_reader(said).unwrap();
    for nothing in ["complaints", "requests"] {
        assert_eq!(told[nothing], Value::Array(Vec::new()), "{nothing}: {told}");
    }
    assert!(told["looks"]["inked"].as_f64() > Some(0.02), "{told}");
    let status = told["status"].as_str().unwrap();
    assert!(status.starts_with("running: ") && status.contains(" of 1"), "{told}");
    assert_eq!(told["stays"][0], told["stays"][1], "a frame that is looked at stays: {told}");
    assert_eq!(told["switch"], false, "what has ended is not followed: {told}");
    assert_eq!(
        server.json("/index")["times"].as_array().unwrap().len() as u64,
        told["frames"].as_u64().unwrap()
    );
}

#[test]
fn a_scene_in_space_is_seen_in_a_browser() {
    let workplace = Workplace::new();
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/paper/backspin.toml");
    let short =
        ["--set", "cells_per_radius=2", "--set", "time.end=20 ms", "--set", "outputs.particles=10 ms"];
    workplace.succeed(&[&["run", scene.to_str().unwrap(), "--out", "results"][..], &short].concat());
    let server = Server::start(&workplace, &["results"]);
    let Some(told) = use_viewer(&server.address) else { return };
    assert_works(&told, &server.address);
    assert_eq!(told["sides"].as_object().unwrap().len(), 4);
}
