//! Requests to the viewer: an address, and headers.

use crate::is_one_in;
use crate::template::Template;
use std::sync::OnceLock;
use stickslip_cli::door::{PORT, Viewer};

/// Of requests for what takes long, one in so many is answered, all where they are replayed: the page, which is packed,
/// and fringes, which are drawn.
const ANSWERED: [(&str, u64); 2] = if cfg!(feature = "libfuzzer") {
    [("/", 50), ("/fringes/", 10_000)]
} else {
    [("/", 1), ("/fringes/", 1)]
};

/// Answers a request: its first line is the address, the others are headers.
pub fn run(bytes: &[u8]) {
    static VIEWER: OnceLock<Viewer> = OnceLock::new();
    let Ok(text) = str::from_utf8(bytes) else { return };
    let mut lines = text.lines();
    let address = lines.next().unwrap_or_default();
    let takes_long = |(kind, count): &(&str, u64)| {
        let is_asked = address == *kind || (kind.len() > 1 && address.starts_with(kind));
        is_asked && !is_one_in(*count, bytes)
    };
    if ANSWERED.iter().any(takes_long) {
        return;
    }
    let headers: Vec<(&str, &str)> =
        lines.filter_map(|line| line.split_once(':')).map(|(name, value)| (name, value.trim())).collect();
    let viewer =
        VIEWER.get_or_init(|| Viewer::open(&Template::get().path()).unwrap_or_else(|e| panic!("{e}")));
    let (code, content) = viewer.answer(address, &headers);
    assert!([200, 403, 404, 500].contains(&code), "{address}: {code}");
    let own = [format!("127.0.0.1:{PORT}"), format!("localhost:{PORT}")];
    let host = headers.iter().find(|(name, _)| name.eq_ignore_ascii_case("host")).map(|(_, host)| *host);
    if code != 403 {
        assert!(host.is_some_and(|host| own.iter().any(|own| own == host)), "{headers:?}");
    }
    // What is refused tells nothing but that.
    assert!(code == 200 || content.len() < 2000 + address.len(), "{code}");
}

/// Every kind of address.
pub fn seeds() -> Vec<Vec<u8>> {
    let addresses = [
        "/",
        "/index",
        "/pulse",
        "/energy",
        "/frame/1",
        "/column/1/velocity.x",
        "/skins",
        "/skins/1",
        "/skins/0/stress.xy",
        "/contacts/2",
        "/fringes/1",
        "/body/0",
        "/particle/0/3/pressure",
        "/../run.json",
    ];
    let headers = "Host: 127.0.0.1:8000\nOrigin: http://localhost:8000\nSec-Fetch-Site: same-origin\n";
    addresses.map(|address| format!("{address}\n{headers}").into_bytes()).into()
}
