//! The content of a report, independent of its presentation: [`markdown`](super::markdown) and [`html`](super::html) both render
//! it.

use super::headline::Figure;
use super::plot::Plot;

/// A whole report.
#[derive(Clone, Debug)]
pub(crate) struct Document {
    pub(crate) title: String,
    /// What a page begins with.
    pub(crate) figures: Vec<Figure>,
    pub(crate) sections: Vec<Section>,
}

/// A part with a heading.
#[derive(Clone, Debug)]
pub(crate) struct Section {
    pub(crate) title: String,
    pub(crate) blocks: Vec<Block>,
}

/// One thing in a section.
#[derive(Clone, Debug)]
pub(crate) enum Block {
    /// A paragraph.
    Text(String),
    /// Statements derived from the data.
    Findings(Vec<Finding>),
    /// A table.
    Table(Table),
    /// Curves.
    Plot(Plot),
    /// Images in a row.
    Strip(Vec<Shot>),
    /// An image compared with its reference.
    Pair(Box<Pair>),
}

/// A statement derived from the data, with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finding {
    pub(crate) verdict: Verdict,
    pub(crate) text: String,
}

/// Whether the method is ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Verdict {
    Wins,
    Loses,
    /// In some images but not in others, or in time but not in error; the statement says where.
    Depends,
    Open,
}

impl Verdict {
    /// A word for it, so that it does not rely on colour.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Verdict::Wins => "wins",
            Verdict::Loses => "loses",
            Verdict::Depends => "depends",
            Verdict::Open => "note",
        }
    }
}

/// A table. Every row has a cell for each column.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    /// Its stable name.
    pub(crate) name: String,
    pub(crate) caption: String,
    pub(crate) columns: Vec<Column>,
    pub(crate) rows: Vec<Vec<Cell>>,
    /// Detailed: a page may collapse it.
    pub(crate) folded: bool,
}

/// A column of a table.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    /// Its stable name.
    pub(crate) name: String,
    /// Its heading.
    pub(crate) title: String,
    /// The common heading of this and neighbouring columns; empty for none.
    pub(crate) group: String,
    /// Whether it holds numbers, which are right-aligned.
    pub(crate) number: bool,
}

/// A cell of a table.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Cell {
    pub(crate) text: String,
    /// The number behind the text, by which a page sorts.
    pub(crate) value: Option<f64>,
    /// Length of the bar behind the number, in [0, 1].
    pub(crate) bar: Option<f64>,
}

/// An image: its file name and title.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Shot {
    pub(crate) file: String,
    pub(crate) size: [u32; 2],
    pub(crate) title: String,
}

/// An image, its reference, and their difference.
#[derive(Clone, Debug)]
pub(crate) struct Pair {
    pub(crate) picture: Shot,
    pub(crate) reference: Shot,
    pub(crate) difference: Shot,
    pub(crate) mean_flip: f64,
    pub(crate) rmse: f64,
}

impl Section {
    pub(crate) fn new(title: impl Into<String>, blocks: Vec<Block>) -> Section {
        Section { title: title.into(), blocks }
    }
}

impl Finding {
    pub(crate) fn new(verdict: Verdict, text: impl Into<String>) -> Finding {
        Finding { verdict, text: text.into() }
    }
}

impl Column {
    /// A column of words.
    pub(crate) fn words(name: impl Into<String>, title: impl Into<String>) -> Column {
        Column { name: name.into(), title: title.into(), group: String::new(), number: false }
    }

    /// A column of numbers.
    pub(crate) fn numbers(name: impl Into<String>, title: impl Into<String>) -> Column {
        Column { number: true, ..Column::words(name, title) }
    }

    /// The same below a common heading.
    pub(crate) fn below(self, group: impl Into<String>) -> Column {
        Column { group: group.into(), ..self }
    }
}

impl Cell {
    /// A number, or an empty cell if there is none.
    pub(crate) fn number(value: Option<f64>, text: impl Fn(f64) -> String) -> Cell {
        Cell { text: value.map(text).unwrap_or_default(), value, bar: None }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Cell {
        Cell { text: text.into(), value: None, bar: None }
    }
}

impl Table {
    /// A table without rows.
    pub(crate) fn new(name: impl Into<String>, caption: impl Into<String>, columns: Vec<Column>) -> Table {
        Table { name: name.into(), caption: caption.into(), columns, rows: Vec::new(), folded: false }
    }

    /// The same, collapsible.
    pub(crate) fn folded(self) -> Table {
        Table { folded: true, ..self }
    }

    /// The same without columns that are empty in all rows.
    pub(crate) fn without_empty_columns(mut self) -> Table {
        let filled: Vec<bool> =
            (0..self.columns.len()).map(|column| self.rows.iter().any(|row| !row[column].text.is_empty())).collect();
        let mut place = filled.iter();
        self.columns.retain(|_| place.next() == Some(&true));
        for row in &mut self.rows {
            let mut place = filled.iter();
            row.retain(|_| place.next() == Some(&true));
        }
        self
    }

    /// Adjacent columns under one heading, with their number.
    pub(crate) fn groups(&self) -> Vec<(&str, usize)> {
        self.columns
            .chunk_by(|a, b| a.group == b.group)
            .map(|columns| (columns[0].group.as_str(), columns.len()))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_columns_go_and_the_others_stay_in_place() {
        let columns = ["a", "b", "c"].map(|name| Column::numbers(name, name)).to_vec();
        let mut table = Table::new("t", "", columns);
        table.rows = vec![vec!["1".into(), "".into(), "2".into()], vec!["".into(), "".into(), "3".into()]];
        let table = table.without_empty_columns();
        assert_eq!(table.columns.iter().map(|column| column.name.as_str()).collect::<Vec<_>>(), ["a", "c"]);
        assert_eq!(table.rows[1], ["".into(), "3".into()]);
    }

    #[test]
    fn neighbours_share_a_heading() {
        let columns = vec![
            Column::words("a", "a"),
            Column::numbers("b", "b").below("CPU"),
            Column::numbers("c", "c").below("CPU"),
            Column::numbers("d", "d").below("GPU"),
        ];
        assert_eq!(Table::new("t", "", columns).groups(), [("", 1), ("CPU", 2), ("GPU", 1)]);
    }
}
