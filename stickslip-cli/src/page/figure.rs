//! Figures: one image or many in rows, under one number and caption.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use maud::{Markup, Render};

/// Images with a caption.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Its address on the page: `figure-3`.
    pub id: String,
    /// Before the caption and in the table of contents: `Figure 3`.
    pub name: String,
    /// What is to be seen.
    pub caption: Markup,
    /// Rows of images; images of one row are equally wide.
    pub rows: Vec<Vec<EmbeddedImage>>,
}

/// An image that the page carries with it.
#[derive(Clone, Debug)]
pub struct EmbeddedImage {
    pub(super) data: Data,
    /// What the image shows, for readers who cannot see it.
    pub(super) description: String,
    /// Under the image; may be empty.
    pub(super) label: String,
}

#[derive(Clone, Debug)]
pub(super) enum Data {
    Svg(String),
    Png(String),
}

impl Figure {
    /// A figure without images yet; `name` is `Figure 3`, which gives the address `figure-3`.
    pub fn new(name: impl Into<String>, caption: impl Render) -> Self {
        let name = name.into();
        Figure { id: address(&name), name, caption: caption.render(), rows: Vec::new() }
    }

    /// Adds a row of images.
    pub fn row(mut self, images: Vec<EmbeddedImage>) -> Self {
        self.rows.push(images);
        self
    }
}

impl EmbeddedImage {
    /// A drawing of lines and letters, as SVG.
    pub fn svg(svg: &str, description: impl Into<String>) -> Self {
        // What precedes the element belongs to files only.
        let start = svg.find("<svg").unwrap_or(0);
        let data = Data::Svg(svg[start..].to_owned());
        EmbeddedImage { data, description: description.into(), label: String::new() }
    }

    /// A picture, the bytes of a PNG file.
    pub fn png(png: &[u8], description: impl Into<String>) -> Self {
        let data = Data::Png(STANDARD.encode(png));
        EmbeddedImage { data, description: description.into(), label: String::new() }
    }

    /// The same with a line under it.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }
}

/// The address on a page that a heading or a name has: `Poisson's ratio` is at `poisson-s-ratio`.
pub fn address(name: &str) -> String {
    let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.map(str::to_ascii_lowercase).collect::<Vec<_>>().join("-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_gives_an_address() {
        assert_eq!(Figure::new("Figure 3", "x").id, "figure-3");
        assert_eq!(address("Poisson's ratio, K & G"), "poisson-s-ratio-k-g");
    }

    #[test]
    fn what_precedes_the_drawing_is_left_out() {
        let image = EmbeddedImage::svg("<?xml version=\"1.0\"?>\n<svg></svg>", "nothing");
        assert!(matches!(image.data, Data::Svg(svg) if svg == "<svg></svg>"));
    }
}
