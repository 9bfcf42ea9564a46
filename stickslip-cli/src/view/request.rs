//! The head of a request over HTTP, read with limits: of bytes, of lines, of time.
//!
//! RFC 9112. A head is a line `GET /address HTTP/1.1` and lines `name: value`, up to an empty one. What follows it, a
//! body, is not read: no request that is answered has one.

use std::io::{self, ErrorKind, Read};

/// Bytes that a head may have: browsers send less than two thousand.
const LONGEST_HEAD: usize = 16 << 10;
/// Headers that it may have.
const MOST_HEADERS: usize = 100;

/// What somebody asks for.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Request {
    /// `GET`
    pub method: String,
    /// `/index`
    pub address: String,
    headers: Vec<(String, String)>,
}

/// A request that gets no answer but a status.
#[derive(Debug, PartialEq, Eq)]
pub struct NoRequest {
    /// 400, 408 or 431; none where the other side has gone away.
    pub code: Option<u16>,
    /// Why.
    pub reason: &'static str,
}

impl Request {
    /// Reads the head of a request, and nothing behind it but what came with its end.
    ///
    /// # Errors
    /// It is none, has more than a head may have, or takes longer than `from` waits.
    pub fn read(from: &mut dyn Read) -> Result<Self, NoRequest> {
        let mut head = Vec::new();
        let mut piece = [0; 1024];
        loop {
            let read = match from.read(&mut piece) {
                Ok(0) => return Err(NoRequest { code: None, reason: "the other side has gone away" }),
                Ok(read) => read,
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(error) => return Err(NoRequest::of(&error)),
            };
            // An end may lie across two pieces.
            let before = head.len().saturating_sub(END.len() - 1);
            head.extend_from_slice(&piece[..read]);
            if let Some(end) = head[before..].windows(END.len()).position(|found| found == END) {
                head.truncate(before + end);
                return Self::parse(&head);
            }
            if head.len() > LONGEST_HEAD {
                return Err(NoRequest { code: Some(431), reason: "the head of the request is too long" });
            }
        }
    }

    /// What a head says, without the empty line at its end.
    fn parse(head: &[u8]) -> Result<Self, NoRequest> {
        let wrong = || NoRequest { code: Some(400), reason: "that is no request over HTTP" };
        let head = str::from_utf8(head).map_err(|_| wrong())?;
        let mut lines = head.split("\r\n");
        let words: Vec<&str> = lines.next().unwrap_or_default().split(' ').collect();
        let [method, address, "HTTP/1.0" | "HTTP/1.1"] = words[..] else { return Err(wrong()) };
        if !is_word(method) || address.is_empty() || address.contains(is_no_sign) {
            return Err(wrong());
        }
        let mut headers = Vec::new();
        for line in lines {
            let (name, value) = line.split_once(':').ok_or_else(wrong)?;
            let value = value.trim_matches([' ', '\t']);
            if !is_word(name) || value.contains(|letter: char| letter.is_control() && letter != '\t') {
                return Err(wrong());
            }
            if headers.len() == MOST_HEADERS {
                return Err(NoRequest { code: Some(431), reason: "the request has too many headers" });
            }
            headers.push((name.to_string(), value.to_string()));
        }
        let request = Request { method: method.to_string(), address: address.to_string(), headers };
        // Of two hosts, one may be meant for whoever stands in between.
        if request.all("Host").nth(1).is_some() { Err(wrong()) } else { Ok(request) }
    }

    /// The value of a header, the first of its name.
    pub fn header(&self, name: &str) -> Option<&str> {
        self.all(name).next()
    }

    fn all(&self, name: &str) -> impl Iterator<Item = &str> {
        let named = self.headers.iter().filter(move |(key, _)| key.eq_ignore_ascii_case(name));
        named.map(|(_, value)| value.as_str())
    }
}

/// The end of a head.
const END: &[u8] = b"\r\n\r\n";

impl NoRequest {
    fn of(error: &io::Error) -> Self {
        match error.kind() {
            ErrorKind::TimedOut | ErrorKind::WouldBlock => {
                NoRequest { code: Some(408), reason: "the request took too long" }
            }
            _ => NoRequest { code: None, reason: "the other side has gone away" },
        }
    }
}

/// Whether a text is a token: letters, digits and some signs.
fn is_word(text: &str) -> bool {
    !text.is_empty()
        && text.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"!#$%&'*+-.^_`|~".contains(&byte))
}

/// What no address has.
fn is_no_sign(letter: char) -> bool {
    !letter.is_ascii_graphic()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gives its bytes in pieces of this length, then fails.
    struct Slow<'a>(&'a [u8], usize);

    impl Read for Slow<'_> {
        fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
            if self.0.is_empty() {
                return Err(ErrorKind::TimedOut.into());
            }
            let length = self.1.min(self.0.len()).min(to.len());
            to[..length].copy_from_slice(&self.0[..length]);
            self.0 = &self.0[length..];
            Ok(length)
        }
    }

    #[test]
    fn a_head_is_read_however_it_comes() {
        let text = b"GET /frame/3 HTTP/1.1\r\nhost:  127.0.0.1:80\r\nX-Empty:\r\n\r\n";
        for piece in [1, 2, 3, 7, 1000] {
            let request = Request::read(&mut Slow(text, piece)).unwrap();
            assert_eq!((request.method.as_str(), request.address.as_str()), ("GET", "/frame/3"));
            assert_eq!(request.header("Host"), Some("127.0.0.1:80"));
            assert_eq!((request.header("x-empty"), request.header("Origin")), (Some(""), None));
        }
    }

    /// What it announces is neither believed nor waited for.
    #[test]
    fn a_body_is_not_read() {
        let text = b"GET / HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999999\r\n\r\n";
        assert_eq!(Request::read(&mut Slow(text, 1000)).unwrap().address, "/");
    }

    #[test]
    fn what_is_no_request_gets_a_status() {
        let code = |text: &[u8]| Request::read(&mut Slow(text, 1000)).unwrap_err().code;
        for wrong in [
            "GET /\r\n\r\n",
            "GET / HTTP/2\r\n\r\n",
            "GET  / HTTP/1.1\r\n\r\n",
            "G T / HTTP/1.1\r\n\r\n",
            "GET /\u{e9} HTTP/1.1\r\n\r\n",
            "GET / HTTP/1.1\r\nHost\r\n\r\n",
            "GET / HTTP/1.1\r\nHost : a\r\n\r\n",
            "GET / HTTP/1.1\r\nHost: a\r\n folded: b\r\n\r\n",
            "GET / HTTP/1.1\r\nHost: a\r\nHOST: b\r\n\r\n",
            "GET / HTTP/1.1\r\nHost: a\0b\r\n\r\n",
            "\r\n\r\n",
        ] {
            assert_eq!(code(wrong.as_bytes()), Some(400), "{wrong:?}");
        }
        assert_eq!(code(b"GET / HTTP/1.1\r\nHost: \xff\r\n\r\n"), Some(400));
        assert_eq!(code(b"GET / HTTP/1.1\r\nHost: a\r\n"), Some(408));
        assert_eq!(code(&b"x".repeat(100_000)), Some(431));
        let many = format!("GET / HTTP/1.1\r\n{}\r\n", "a: b\r\n".repeat(MOST_HEADERS + 1));
        assert_eq!(code(many.as_bytes()), Some(431));
        let gone = Request::read(&mut &b"GET /"[..]).unwrap_err();
        assert_eq!(gone.code, None);
    }
}
