//! Tables of numbers and verdicts.

use maud::{Markup, Render};

/// A table with a caption.
#[derive(Clone, Debug)]
pub struct Table {
    /// What it holds.
    pub caption: Markup,
    /// Its columns, from the left.
    pub columns: Vec<Column>,
    /// Its rows, each as long as there are columns.
    pub rows: Vec<Vec<Cell>>,
}

/// A column of a table.
#[derive(Clone, Debug)]
pub struct Column {
    pub(super) name: String,
    pub(super) align: Align,
}

/// Where the contents of a column stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Align {
    Left,
    Right,
}

/// An entry of a table.
#[derive(Clone, Debug)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number as it is to be read.
    Number(String),
    /// Whether something holds.
    Verdict(Mark),
    /// Words or a number that show whether something holds by their colour, with the address of more on the page.
    Judged(String, Mark, String),
    /// Nothing to say.
    Empty,
}

/// Whether something holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// It does.
    Passed,
    /// It does not.
    Failed,
    /// It does not, as is known and explained.
    Known,
}

impl Table {
    /// A table without rows yet.
    pub fn new(caption: impl Render, columns: Vec<Column>) -> Self {
        Table { caption: caption.render(), columns, rows: Vec::new() }
    }

    /// Adds a row; cells that are missing at its end are empty.
    pub fn row(mut self, mut cells: Vec<Cell>) -> Self {
        cells.resize(self.columns.len(), Cell::Empty);
        self.rows.push(cells);
        self
    }
}

impl Column {
    /// A column of words.
    pub fn text(name: impl Into<String>) -> Self {
        Column { name: name.into(), align: Align::Left }
    }

    /// A column of numbers, which stand on the right.
    pub fn number(name: impl Into<String>) -> Self {
        Column { name: name.into(), align: Align::Right }
    }
}

impl Mark {
    /// Passed if it holds, else failed.
    pub fn of(holds: bool) -> Self {
        if holds { Mark::Passed } else { Mark::Failed }
    }
}

impl Cell {
    /// Words.
    pub fn text(text: impl Into<String>) -> Self {
        Cell::Text(text.into())
    }

    /// A number with this many decimals; nothing where it is not finite.
    pub fn number(value: f64, decimals: usize) -> Self {
        if value.is_finite() { Cell::Number(signed(format!("{value:.decimals$}"))) } else { Cell::Empty }
    }

    /// A whole number.
    pub fn count(value: usize) -> Self {
        Cell::Number(value.to_string())
    }

    /// A share in percent with its sign, with this many decimals: 0.02 is `+2.0 %`.
    pub fn percent(share: f64, decimals: usize) -> Self {
        if share.is_finite() {
            Cell::Number(format!("{} %", signed(format!("{:+.decimals$}", 100.0 * share))))
        } else {
            Cell::Empty
        }
    }

    /// A number of any size with three digits: `2.53e-7`.
    pub fn scientific(value: f64) -> Self {
        if value.is_finite() { Cell::Number(signed(format!("{value:.2e}"))) } else { Cell::Empty }
    }
}

/// The number with a true minus sign.
fn signed(number: String) -> String {
    number.replace('-', "\u{2212}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(cell: Cell) -> String {
        match cell {
            Cell::Number(text) => text,
            other => format!("{other:?}"),
        }
    }

    #[test]
    fn numbers_are_written_as_they_are_read() {
        assert_eq!(shown(Cell::number(-1.25, 1)), "\u{2212}1.2");
        assert_eq!(shown(Cell::percent(0.021, 1)), "+2.1 %");
        assert_eq!(shown(Cell::scientific(2.531e-7)), "2.53e\u{2212}7");
        assert_eq!(shown(Cell::number(f64::NAN, 2)), "Empty");
    }

    #[test]
    fn short_rows_are_filled() {
        let table = Table::new("t", vec![Column::text("a"), Column::number("b")]).row(vec![Cell::text("x")]);
        assert!(matches!(table.rows[0][1], Cell::Empty));
    }
}
