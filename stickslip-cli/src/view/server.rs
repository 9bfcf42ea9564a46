//! The page and its data on a port of this machine.
//!
//! Three things keep others out. The port is open to this machine alone. A request must name this machine as its host,
//! which one that came through a foreign name (DNS rebinding) does not. And a request that a page of another origin
//! made is refused. Addresses are [`Route`]s, never paths of the disk.
//!
//! Nobody can keep others waiting: connections have a thread each, as many as [`CONNECTIONS`], in which the head of a
//! request and the time for it are limited before anything is read; one answer ends a connection.

use super::library::{Content, Library, Refusal};
use super::page::POLICY;
use super::request::Request;
use super::route::Route;
use std::io::{self, BufWriter, ErrorKind, Read, Write};
use std::net::{Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Connections at a time; those beyond are ended at once. A browser keeps six.
const CONNECTIONS: usize = 64;
/// Answers that are made side by side.
const WORKERS: usize = 6;
/// Wait before anybody looks whether it is to stop.
const LOOK: Duration = Duration::from_millis(100);
/// Wait before new connections are looked for.
const PAUSE: Duration = Duration::from_millis(2);
/// Time in which the head of a request must have come.
const FOR_HEAD: Duration = Duration::from_secs(5);
/// Time in which an answer must have been taken.
const FOR_ANSWER: Duration = Duration::from_secs(120);
/// Time in which the other side is to end the connection after its answer.
const FOR_END: Duration = Duration::from_millis(500);

/// A page that is being served.
pub struct Serving {
    listener: TcpListener,
    port: u16,
}

/// What a request says of where it comes from.
#[derive(Debug, Default)]
struct Sender<'a> {
    host: Option<&'a str>,
    origin: Option<&'a str>,
    site: Option<&'a str>,
}

/// Opens a port of this machine: a free one for 0.
///
/// # Errors
/// The port is taken, or may not be opened.
pub fn serve(port: u16) -> io::Result<Serving> {
    let listener = TcpListener::bind(SocketAddr::from((Ipv4Addr::LOCALHOST, port)))?;
    listener.set_nonblocking(true)?;
    let port = listener.local_addr()?.port();
    Ok(Serving { listener, port })
}

/// What connections share.
struct Shared<'a> {
    library: &'a Library,
    stop: &'a AtomicBool,
    connections: AtomicUsize,
    /// Answers that are being made.
    answers: Mutex<usize>,
    made: Condvar,
}

impl Serving {
    /// Where a browser finds the page.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers until `stop` is set.
    pub fn answer(&self, library: &Library, stop: &AtomicBool) {
        let (connections, answers, made) = Default::default();
        let shared = &Shared { library, stop, connections, answers, made };
        std::thread::scope(|scope| {
            while !stop.load(Ordering::Relaxed) {
                // What cannot be taken is asked for again, as where the system has no more files to give.
                let Ok((stream, _)) = self.listener.accept() else {
                    std::thread::sleep(PAUSE);
                    continue;
                };
                if shared.connections.fetch_add(1, Ordering::Relaxed) >= CONNECTIONS {
                    shared.connections.fetch_sub(1, Ordering::Relaxed);
                    continue;
                }
                let respond = move || {
                    // A browser that has gone away wants no answer.
                    let _ = self.respond(shared, stream);
                    shared.connections.fetch_sub(1, Ordering::Relaxed);
                };
                if std::thread::Builder::new().spawn_scoped(scope, respond).is_err() {
                    shared.connections.fetch_sub(1, Ordering::Relaxed);
                }
            }
        });
    }

    fn respond(&self, shared: &Shared, stream: TcpStream) -> io::Result<()> {
        // Some systems hand the listener's way of waiting on.
        stream.set_nonblocking(false)?;
        let mut wire = Wire { stream, stop: shared.stop, until: Instant::now() + FOR_HEAD };
        let request = Request::read(&mut wire);
        let is_bare = request.as_ref().is_ok_and(|request| request.method == "HEAD");
        let part = if is_bare { Part::Head } else { Part::Whole };
        let (code, content) = match &request {
            Ok(request) => self.reply(shared, request),
            Err(no_request) => match no_request.code {
                Some(code) => told(code, no_request.reason),
                None => return Ok(()),
            },
        };
        wire.until = Instant::now() + FOR_ANSWER;
        send(code, &content, part, &mut wire)?;
        wire.end()
    }

    fn reply(&self, shared: &Shared, request: &Request) -> (u16, Content) {
        if !matches!(request.method.as_str(), "GET" | "HEAD") {
            return told(405, "only GET is answered");
        }
        shared.in_turn(|| answer(shared.library, self.port, &request.address, &|name| request.header(name)))
    }
}

impl Shared<'_> {
    /// Makes an answer once there are not too many others.
    fn in_turn<X>(&self, make: impl FnOnce() -> X) -> X {
        let answers = self.answers.lock().unwrap_or_else(PoisonError::into_inner);
        let mut answers = self
            .made
            .wait_while(answers, |answers| *answers >= WORKERS)
            .unwrap_or_else(PoisonError::into_inner);
        *answers += 1;
        drop(answers);
        let result = make();
        *self.answers.lock().unwrap_or_else(PoisonError::into_inner) -= 1;
        self.made.notify_one();
        result
    }
}

/// A connection that waits no longer than until then, or than the server lives.
struct Wire<'a> {
    stream: TcpStream,
    stop: &'a AtomicBool,
    until: Instant,
}

impl Wire<'_> {
    /// Tries again what may wait, for a while each time.
    fn patiently<X>(&mut self, mut act: impl FnMut(&mut TcpStream) -> io::Result<X>) -> io::Result<X> {
        self.stream.set_read_timeout(Some(LOOK))?;
        self.stream.set_write_timeout(Some(LOOK))?;
        loop {
            match act(&mut self.stream) {
                Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => {
                    if self.stop.load(Ordering::Relaxed) || Instant::now() >= self.until {
                        return Err(ErrorKind::TimedOut.into());
                    }
                }
                // One that sends a letter at a time has no more time than others.
                Ok(_) if Instant::now() >= self.until => return Err(ErrorKind::TimedOut.into()),
                other => return other,
            }
        }
    }

    /// Ends the connection after an answer. What the other side has sent beyond its request is read for a moment: the
    /// system would take back the answer otherwise.
    fn end(mut self) -> io::Result<()> {
        self.stream.shutdown(Shutdown::Write)?;
        self.until = Instant::now() + FOR_END;
        let mut piece = [0; 4096];
        while self.read(&mut piece)? > 0 {}
        Ok(())
    }
}

impl Read for Wire<'_> {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        self.patiently(|stream| stream.read(to))
    }
}

impl Write for Wire<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.patiently(|stream| stream.write(bytes))
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The status and the content that who asks for an address gets, at a port of this machine, with these headers.
pub fn answer<'a>(
    library: &Library,
    port: u16,
    address: &str,
    header: &dyn Fn(&str) -> Option<&'a str>,
) -> (u16, Content) {
    let sender = Sender { host: header("Host"), origin: header("Origin"), site: header("Sec-Fetch-Site") };
    let route = address.parse::<Route>();
    if let Err(reason) = sender.judge(port, route == Ok(Route::Page)) {
        return told(403, reason);
    }
    match route.map(|route| library.answer(&route)) {
        Ok(Ok(content)) => (200, content),
        Ok(Err(Refusal::Missing(what))) => told(404, &what),
        Ok(Err(Refusal::Broken(what))) => told(500, &what),
        Err(()) => told(404, "there is nothing of this name"),
    }
}

/// What of an answer is sent.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Head,
    Whole,
}

/// What a status means.
fn phrase(code: u16) -> &'static str {
    match code {
        200 => "OK",
        400 => "Bad Request",
        403 => "Forbidden",
        404 => "Not Found",
        405 => "Method Not Allowed",
        408 => "Request Timeout",
        431 => "Request Header Fields Too Large",
        _ => "Internal Server Error",
    }
}

/// Writes an answer, after which the connection ends.
fn send(code: u16, content: &Content, part: Part, to: &mut dyn Write) -> io::Result<()> {
    let length = content.bytes.len();
    let mut writer = BufWriter::new(to);
    write!(writer, "HTTP/1.1 {code} {}\r\n", phrase(code))?;
    for (name, value) in [
        ("Content-Type", content.kind),
        ("Content-Security-Policy", POLICY),
        ("Cross-Origin-Resource-Policy", "same-origin"),
        ("X-Content-Type-Options", "nosniff"),
        ("Referrer-Policy", "no-referrer"),
        ("Cache-Control", "no-store"),
        ("Connection", "close"),
    ] {
        write!(writer, "{name}: {value}\r\n")?;
    }
    write!(writer, "Content-Length: {length}\r\n\r\n")?;
    if part == Part::Whole {
        writer.write_all(&content.bytes)?;
    }
    writer.flush()
}

fn told(code: u16, text: &str) -> (u16, Content) {
    (code, Content { kind: "text/plain; charset=utf-8", bytes: text.as_bytes().to_vec() })
}

impl Sender<'_> {
    /// Whether a request may be answered: it names this machine, and no other site's page made it. A link to the page
    /// itself may stand anywhere.
    fn judge(&self, port: u16, is_page: bool) -> Result<(), &'static str> {
        let own = |host: &str| ["127.0.0.1", "localhost"].iter().any(|name| host == format!("{name}:{port}"));
        if !self.host.is_some_and(own) {
            return Err("the request names another host");
        }
        if self.origin.is_some_and(|origin| !origin.strip_prefix("http://").is_some_and(own)) {
            return Err("the request comes from another origin");
        }
        if self.site.is_some_and(|site| !["same-origin", "none"].contains(&site)) && !is_page {
            return Err("the request comes from another site");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_this_machine_and_its_own_page_are_answered() {
        let sender = |host, origin, site| Sender { host, origin, site };
        let own = Some("127.0.0.1:8000");
        let judge = |sender: Sender, is_page| sender.judge(8000, is_page).is_ok();
        assert!(judge(sender(own, None, None), false));
        assert!(judge(
            sender(Some("localhost:8000"), Some("http://localhost:8000"), Some("same-origin")),
            false
        ));
        assert!(!judge(sender(None, None, None), true), "no host");
        for host in ["127.0.0.1:8001", "evil.example:8000", "127.0.0.1", "127.0.0.1:8000.evil.example"] {
            assert!(!judge(sender(Some(host), None, None), true), "{host}");
        }
        for origin in ["http://evil.example", "null", "https://127.0.0.1:8000", "http://127.0.0.1:8001"] {
            assert!(!judge(sender(own, Some(origin), None), true), "{origin}");
        }
        assert!(!judge(sender(own, None, Some("cross-site")), false));
        assert!(judge(sender(own, None, Some("cross-site")), true), "a link to the page");
    }
}
