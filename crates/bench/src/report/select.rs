//! A part of a table, as Markdown, for documents.

use super::document::{Column, Table};
use super::{Report, markdown};

/// A selection from a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// The table's name.
    pub table: String,
    /// Columns and the value that a row must have there.
    pub conditions: Vec<(String, String)>,
    /// Columns in order, with replacement titles; empty: all.
    pub columns: Vec<(String, Option<String>)>,
}

/// Why a selection is invalid.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// There is no table with this name.
    #[error("there is no table `{name}`; the tables are {}", known.join(", "))]
    NoTable {
        /// The requested name.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// The table has no such column.
    #[error("the table `{table}` has no column `{name}`; it has {}", known.join(", "))]
    NoColumn {
        /// The table's name.
        table: String,
        /// The requested name.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// No row matches the conditions.
    #[error("the table `{table}` has no row with {conditions}; correct or remove conditions")]
    NoRow {
        /// The table's name.
        table: String,
        /// The conditions.
        conditions: String,
    },
}

impl Report {
    /// A part of a table, as Markdown.
    ///
    /// # Errors
    /// [`TableError`] if there is no such table, column or row.
    pub fn table(&self, Selection { table: name, conditions, columns }: &Selection) -> Result<String, TableError> {
        let table = self.tables().find(|table| table.name == *name).ok_or_else(|| TableError::NoTable {
            name: name.clone(),
            known: self.tables().map(|table| table.name.clone()).collect(),
        })?;
        let places: Result<Vec<usize>, TableError> = conditions.iter().map(|(name, _)| place(table, name)).collect();
        let wanted: Vec<(usize, &str)> =
            places?.into_iter().zip(conditions.iter().map(|(_, value)| &**value)).collect();
        let mut columns: Vec<(usize, Column)> =
            columns.iter().map(|column| titled(table, column)).collect::<Result<_, _>>()?;
        if columns.is_empty() {
            columns = table.columns.iter().cloned().enumerate().collect();
        }
        let rows = table.rows.iter().filter(|row| wanted.iter().all(|&(place, value)| row[place].text == value));
        let rows = rows.map(|row| columns.iter().map(|(place, _)| row[*place].clone()).collect());
        let mut part = Table::new("", "", 0);
        part.rows = rows.collect();
        part.columns = columns.iter().map(|(_, column)| column.clone()).collect();
        if part.rows.is_empty() {
            let conditions: Vec<String> =
                conditions.iter().map(|(column, value)| format!("{column}={value}")).collect();
            return Err(TableError::NoRow { table: name.clone(), conditions: conditions.join(", ") });
        }
        Ok(markdown::table(&part))
    }
}

/// A selected column and its index.
fn titled(table: &Table, (name, title): &(String, Option<String>)) -> Result<(usize, Column), TableError> {
    let place = place(table, name)?;
    let column = table.columns[place].clone();
    let column = match title {
        Some(title) => Column { title: title.clone(), group: String::new(), ..column },
        None => column,
    };
    Ok((place, column))
}

fn place(table: &Table, name: &str) -> Result<usize, TableError> {
    table.columns.iter().position(|column| column.name == name).ok_or_else(|| TableError::NoColumn {
        table: table.name.clone(),
        name: name.to_owned(),
        known: table.columns.iter().map(|column| column.name.clone()).collect(),
    })
}
