//! The page and its data on a port of this machine.
//!
//! Three things keep others out. The port is open to this machine alone. A request must name this machine as its host,
//! which one that came through a foreign name (DNS rebinding) does not. And a request that a page of another origin
//! made is refused. Addresses are [`Route`]s, never paths of the disk.

use super::library::{Content, Library, Refusal};
use super::page::POLICY;
use super::route::Route;
use std::io::{self, Write};
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use tiny_http::{Method, Request, Server, StatusCode};

/// Requests that are answered side by side: a browser keeps six connections at most.
const WORKERS: usize = 6;
/// Wait before a worker looks whether it is to stop.
const LOOK: Duration = Duration::from_millis(100);

/// A page that is being served.
pub struct Serving {
    server: Arc<Server>,
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
    let server = Server::http(SocketAddr::from((Ipv4Addr::LOCALHOST, port))).map_err(io::Error::other)?;
    let port = server.server_addr().to_ip().map_or(port, |address| address.port());
    Ok(Serving { server: Arc::new(server), port })
}

impl Serving {
    /// Where a browser finds the page.
    pub fn address(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Answers until `stop` is set.
    pub fn answer(&self, library: &Library, stop: &AtomicBool) {
        std::thread::scope(|scope| {
            for _ in 0..WORKERS {
                scope.spawn(|| {
                    while !stop.load(Ordering::Relaxed) {
                        if let Ok(Some(request)) = self.server.recv_timeout(LOOK) {
                            self.respond(library, request);
                        }
                    }
                });
            }
        });
    }

    fn respond(&self, library: &Library, request: Request) {
        let (code, content) = self.reply(library, &request);
        let bare = *request.method() == Method::Head;
        // A browser that has gone away wants no answer.
        let _ = send(code, &content, bare, &mut *request.into_writer());
    }

    fn reply(&self, library: &Library, request: &Request) -> (u16, Content) {
        if !matches!(request.method(), Method::Get | Method::Head) {
            return told(405, "only GET is answered");
        }
        answer(library, self.port, request.url(), &|name| {
            let mut found = request.headers().iter();
            let found = found.find(|header| header.field.as_str().as_str().eq_ignore_ascii_case(name));
            found.map(|header| header.value.as_str())
        })
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

/// Writes an answer, without its content if it is to be `bare`, after which the connection ends.
///
/// tiny_http has a thread for each connection that stays open, and one that comes when two do at once may wait until
/// another ends. Browsers keep theirs for minutes, and its own `Response` cannot tell them to close.
fn send(code: u16, content: &Content, bare: bool, writer: &mut dyn Write) -> io::Result<()> {
    let length = content.bytes.len();
    write!(writer, "HTTP/1.1 {code} {}\r\n", StatusCode(code).default_reason_phrase())?;
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
    if !bare {
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
