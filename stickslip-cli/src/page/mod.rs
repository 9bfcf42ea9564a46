//! Reports: one HTML file that holds everything it shows and asks no network for anything.
//!
//! A [`Page`] is a title, sections with [`Figure`]s and [`Table`]s, and how it was made;
//! [`Page::write`] turns it into HTML.

mod figure;
mod html;
mod making;
mod table;

pub use figure::{EmbeddedImage, Figure, address};
pub use making::Making;
pub use table::{Cell, Column, Mark, Table};

use crate::drawing::DrawError;
use crate::files;
use maud::{Markup, Render};
use std::path::Path;

/// A report.
#[derive(Clone, Debug)]
pub struct Page {
    /// Above everything, and the name of the browser's tab.
    pub title: String,
    /// Under the title: what the reader has before them and what came out.
    pub lead: Vec<Block>,
    /// One after the other; the table of contents names them.
    pub sections: Vec<Section>,
    /// How it was made, folded up at the end.
    pub making: Making,
}

/// A part of a page under a heading.
#[derive(Clone, Debug)]
pub struct Section {
    /// The heading.
    pub title: String,
    /// In the order of reading.
    pub blocks: Vec<Block>,
}

/// What stands in a section.
#[derive(Clone, Debug)]
pub enum Block {
    /// A paragraph.
    Text(Markup),
    /// A paragraph that the reader must not miss: something failed.
    Warning(Markup),
    /// A sketch in characters.
    Sketch(String),
    /// Pictures and charts with a caption.
    Figure(Figure),
    /// Numbers.
    Table(Table),
}

impl Page {
    /// A page with no sections yet.
    pub fn new(title: impl Into<String>, making: Making) -> Self {
        Page { title: title.into(), lead: Vec::new(), sections: Vec::new(), making }
    }

    /// Adds a paragraph under the title.
    pub fn lead(mut self, paragraph: impl Render) -> Self {
        self.lead.push(Block::Text(paragraph.render()));
        self
    }

    /// Adds a paragraph under the title that stands out.
    pub fn warning(mut self, paragraph: impl Render) -> Self {
        self.lead.push(Block::Warning(paragraph.render()));
        self
    }

    /// Adds a section.
    pub fn section(mut self, section: Section) -> Self {
        self.sections.push(section);
        self
    }

    /// The page as HTML.
    pub fn html(&self) -> String {
        html::page(self).into_string()
    }

    /// Writes the page.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), DrawError> {
        files::write(path, files::PAGE, |file| file.write_all(self.html().as_bytes()))
            .map_err(|source| DrawError::Write { path: path.to_path_buf(), source })
    }
}

impl Section {
    /// A section with nothing under its heading yet.
    pub fn new(title: impl Into<String>) -> Self {
        Section { title: title.into(), blocks: Vec::new() }
    }

    /// Adds a paragraph: a text, or markup of `maud::html!`.
    pub fn text(self, paragraph: impl Render) -> Self {
        self.block(Block::Text(paragraph.render()))
    }

    /// Adds a paragraph that stands out.
    pub fn warning(self, paragraph: impl Render) -> Self {
        self.block(Block::Warning(paragraph.render()))
    }

    /// Adds a sketch in characters, line by line as it stands.
    pub fn sketch(self, lines: impl Into<String>) -> Self {
        self.block(Block::Sketch(lines.into()))
    }

    /// Adds a figure.
    pub fn figure(self, figure: Figure) -> Self {
        self.block(Block::Figure(figure))
    }

    /// Adds a table.
    pub fn table(self, table: Table) -> Self {
        self.block(Block::Table(table))
    }

    fn block(mut self, block: Block) -> Self {
        self.blocks.push(block);
        self
    }
}
