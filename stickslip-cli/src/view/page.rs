//! The page: its own files and two libraries, put together into one file that asks no network for anything.

use super::library::Content;
use super::route::Route;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::io::{self, Write};

const FRAME: &str = include_str!("page/index.html");
const STYLES: [&str; 2] = [include_str!("vendor/uplot.css"), include_str!("page/style.css")];
/// Modules by the names under which they import each other.
const MODULES: [(&str, &str); 22] = [
    ("three", include_str!("vendor/three.js")),
    ("uplot", include_str!("vendor/uplot.js")),
    ("stickslip/source", include_str!("page/source.js")),
    ("stickslip/frames", include_str!("page/frames.js")),
    ("stickslip/colors", include_str!("page/colors.js")),
    ("stickslip/stage", include_str!("page/stage.js")),
    ("stickslip/cloud", include_str!("page/cloud.js")),
    ("stickslip/skins", include_str!("page/skins.js")),
    ("stickslip/picking", include_str!("page/picking.js")),
    ("stickslip/arrows", include_str!("page/arrows.js")),
    ("stickslip/velocities", include_str!("page/velocities.js")),
    ("stickslip/forces", include_str!("page/forces.js")),
    ("stickslip/panel", include_str!("page/panel.js")),
    ("stickslip/bodies", include_str!("page/bodies.js")),
    ("stickslip/charts", include_str!("page/charts.js")),
    ("stickslip/layers", include_str!("page/layers.js")),
    ("stickslip/looking", include_str!("page/looking.js")),
    ("stickslip/measuring", include_str!("page/measuring.js")),
    ("stickslip/overlay", include_str!("page/overlay.js")),
    ("stickslip/playing", include_str!("page/playing.js")),
    ("stickslip/saving", include_str!("page/saving.js")),
    ("stickslip/main", include_str!("page/main.js")),
];

/// What the page may do: run what stands in it, and ask where it came from for data.
pub const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline' data:; style-src 'unsafe-inline'; \
                          connect-src 'self'; img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; \
                          frame-ancestors 'none'";

/// The page as it is served: it asks its server for data.
pub fn served() -> String {
    let [head, foot] = halves();
    head + &foot
}

/// The page with its head and its foot apart: between them stands what it is not to ask for.
pub fn halves() -> [String; 2] {
    let address = |text: &str| format!("data:text/javascript;base64,{}", STANDARD.encode(text));
    let imports: serde_json::Map<_, _> =
        MODULES.iter().map(|(name, text)| ((*name).to_owned(), address(text).into())).collect();
    let head = FRAME
        .replace("/* styles */", &STYLES.concat())
        .replace("/* modules */", &serde_json::json!({ "imports": imports }).to_string());
    let (head, foot) = head.split_once("<!-- data -->").expect("the page has a place for data");
    [head.to_owned(), foot.to_owned()]
}

/// Writes an answer into the page, packed by zlib.
///
/// # Errors
/// What the sink says.
pub fn embed(route: &Route, content: &Content, sink: &mut dyn Write) -> io::Result<()> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::default());
    packed.write_all(&content.bytes)?;
    let text = STANDARD.encode(packed.finish()?);
    writeln!(
        sink,
        "<script type=\"text/plain\" data-route=\"{route}\" data-kind=\"{}\">{text}</script>",
        content.kind
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_is_one_file_that_asks_no_network() {
        let page = served();
        assert!(
            page.starts_with("<!DOCTYPE html><!-- Stickslip -->"),
            "as `crate::files` knows pages of ours"
        );
        for (name, _) in MODULES {
            assert!(page.contains(&format!("\"{name}\":\"data:text/javascript;base64,")), "{name}");
        }
        assert!(
            !page.contains("src=\"http") && !page.contains("href=\"http") && !page.contains("/* modules */")
        );
    }

    #[test]
    fn every_import_of_a_module_is_a_module() {
        for (name, text) in MODULES.iter().filter(|(name, _)| name.starts_with("stickslip/")) {
            for line in text.lines().filter(|line| line.contains(" from \"")) {
                let wanted = line.split('"').nth(1).unwrap();
                assert!(MODULES.iter().any(|(known, _)| *known == wanted), "{name} imports {wanted}");
            }
        }
    }
}
