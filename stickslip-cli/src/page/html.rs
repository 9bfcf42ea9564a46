//! A page as HTML: one file, no network, light or dark as the reader's browser asks.

use super::figure::{Data, address};
use super::table::Align;
use super::{Block, Cell, EmbeddedImage, Figure, Making, Mark, Page, Section, Table};
use maud::{DOCTYPE, Markup, PreEscaped, html};

const STYLE: &str = include_str!("style.css");

pub(super) fn page(page: &Page) -> Markup {
    html! {
        (DOCTYPE)
        // By which the program knows its pages, see `crate::files`.
        (PreEscaped("<!-- Stickslip -->"))
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                // An empty icon, so that browsers do not ask the network for one.
                link rel="icon" href="data:,";
                title { (page.title) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                nav { (contents(page)) }
                main {
                    h1 { (page.title) }
                    div.lead { @for block in &page.lead { (self::block(block)) } }
                    @for section in &page.sections { (self::section(section)) }
                    (making(&page.making))
                }
            }
        }
    }
}

fn contents(page: &Page) -> Markup {
    html! {
        p { "Contents" }
        ol {
            @for section in &page.sections {
                li {
                    a href={ "#" (address(&section.title)) } { (section.title) }
                    ol {
                        @for figure in section.blocks.iter().filter_map(Block::figure) {
                            li { a href={ "#" (figure.id) } { (figure.name) } }
                        }
                    }
                }
            }
            li { a href="#made" { "How this was made" } }
        }
    }
}

impl Block {
    fn figure(&self) -> Option<&Figure> {
        match self {
            Block::Figure(figure) => Some(figure),
            _ => None,
        }
    }
}

fn section(section: &Section) -> Markup {
    html! {
        section id=(address(&section.title)) {
            h2 { (section.title) }
            @for block in &section.blocks { (self::block(block)) }
        }
    }
}

fn block(block: &Block) -> Markup {
    html! {
        @match block {
            Block::Text(text) => p { (text) },
            Block::Sketch(text) => pre { (text) },
            Block::Warning(text) => p.warning { (text) },
            Block::Figure(figure) => (self::figure(figure)),
            Block::Table(table) => (self::table(table)),
        }
    }
}

fn figure(figure: &Figure) -> Markup {
    html! {
        figure id=(figure.id) {
            @for row in &figure.rows {
                div.row { @for image in row { (self::image(image)) } }
            }
            figcaption { b { (figure.name) "." } " " (figure.caption) }
        }
    }
}

fn image(image: &EmbeddedImage) -> Markup {
    html! {
        div.image {
            @match &image.data {
                Data::Svg(svg) => div.chart role="img" aria-label=(image.description) { (PreEscaped(svg)) },
                Data::Png(base64) => img src={ "data:image/png;base64," (base64) } alt=(image.description);,
            }
            @if !image.label.is_empty() { p { (image.label) } }
        }
    }
}

fn table(table: &Table) -> Markup {
    let class = |column: usize| match table.columns[column].align {
        Align::Left => None,
        Align::Right => Some("number"),
    };
    html! {
        div.table {
            table {
                caption { (table.caption) }
                thead {
                    tr {
                        @for (i, column) in table.columns.iter().enumerate() {
                            th scope="col" class=[class(i)] { (column.name) }
                        }
                    }
                }
                tbody {
                    @for row in &table.rows {
                        tr { @for (i, cell) in row.iter().enumerate() { td class=[class(i)] { (self::cell(cell)) } } }
                    }
                }
            }
        }
    }
}

fn cell(cell: &Cell) -> Markup {
    html! {
        @match cell {
            Cell::Text(text) | Cell::Number(text) => (text),
            Cell::Verdict(verdict) => span class=(verdict.class()) { (verdict.class()) },
            Cell::Judged(text, verdict, address) => a class=(verdict.class()) href={ "#" (address) } { (text) },
            Cell::Empty => "",
        }
    }
}

impl Mark {
    /// The word for it, which is its class of style too.
    fn class(self) -> &'static str {
        match self {
            Mark::Passed => "passed",
            Mark::Failed => "failed",
            Mark::Known => "known",
        }
    }
}

fn making(making: &Making) -> Markup {
    html! {
        details id="made" {
            summary { "How this was made" }
            dl {
                @for (name, value) in making.rows() {
                    dt { (name) }
                    dd { (value) }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::Column;
    use std::time::Duration;

    fn example() -> String {
        let figure = Figure::new("Figure 3", "A line & more").row(vec![
            EmbeddedImage::svg("<svg><path/></svg>", "a line"),
            EmbeddedImage::png(b"PNG", "dots").label("t = 2"),
        ]);
        let columns = vec![Column::text("case"), Column::number("x [m]")];
        let table = Table::new("Distances", columns).row(vec![Cell::text("R/4"), Cell::number(9.5, 2)]);
        let section = Section::new("Sphere").text("x < y").warning("it failed").figure(figure).table(table);
        let making = Making::now(Duration::from_secs(3)).note("Scale", "coarse");
        Page::new("A report", making).lead("All of it").section(section).html()
    }

    #[test]
    fn everything_stands_on_the_page() {
        let html = example();
        for part in [
            "<title>A report</title>",
            "<figure id=\"figure-3\">",
            "<a href=\"#figure-3\">Figure 3</a>",
            "<section id=\"sphere\">",
            "<svg><path/></svg>",
            "src=\"data:image/png;base64,UE5H\" alt=\"dots\"",
            "<td class=\"number\">9.50</td>",
            "<dd>coarse</dd>",
        ] {
            assert!(html.contains(part), "{part} is missing in {html}");
        }
    }

    #[test]
    fn text_is_text_and_no_markup() {
        let html = example();
        assert!(html.contains("x &lt; y") && html.contains("A line &amp; more"), "{html}");
    }

    #[test]
    fn nothing_comes_from_the_network() {
        let html = example();
        assert!(
            !html.contains("http://") && !html.contains("https://") && !html.contains("<script"),
            "{html}"
        );
    }
}
