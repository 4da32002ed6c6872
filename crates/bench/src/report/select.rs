//! A part of a table, as Markdown, for documents that show it.

use super::document::{Column, Table};
use super::{Report, markdown};

/// What is wanted of a table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// The table's name.
    pub table: String,
    /// Columns and what the cell of a row must hold there.
    pub conditions: Vec<(String, String)>,
    /// Columns in order, with titles in place of their own; none: all.
    pub columns: Vec<(String, Option<String>)>,
}

/// Why there is no such part.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum TableError {
    /// No table has the name.
    #[error("there is no table `{name}`; there are {}", known.join(", "))]
    NoTable {
        /// The name asked for.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// The table has no such column.
    #[error("the table `{table}` has no column `{name}`; it has {}", known.join(", "))]
    NoColumn {
        /// The table's name.
        table: String,
        /// The name asked for.
        name: String,
        /// All names.
        known: Vec<String>,
    },
    /// The conditions leave nothing.
    #[error("the table `{table}` has no row with {conditions}; leave conditions out or correct them")]
    NoRow {
        /// The table's name.
        table: String,
        /// What was asked of rows.
        conditions: String,
    },
}

impl Report {
    /// A part of a table, as Markdown.
    ///
    /// # Errors
    /// [`TableError`] where there is no such table, column or row.
    pub fn table(&self, selection: &Selection) -> Result<String, TableError> {
        let table = self.tables().find(|table| table.name == selection.table).ok_or_else(|| TableError::NoTable {
            name: selection.table.clone(),
            known: self.tables().map(|table| table.name.clone()).collect(),
        })?;
        let conditions: Result<Vec<(usize, &str)>, TableError> =
            selection.conditions.iter().map(|(name, value)| Ok((place(table, name)?, value.as_str()))).collect();
        let conditions = conditions?;
        let columns = columns(table, selection)?;
        let mut part = Table::new("", "", columns.iter().map(|(_, column)| column.clone()).collect());
        for row in &table.rows {
            if conditions.iter().all(|&(place, value)| row[place].text == value) {
                part.rows.push(columns.iter().map(|(place, _)| row[*place].clone()).collect());
            }
        }
        if part.rows.is_empty() {
            let conditions: Vec<String> =
                selection.conditions.iter().map(|(column, value)| format!("{column}={value}")).collect();
            return Err(TableError::NoRow { table: table.name.clone(), conditions: conditions.join(", ") });
        }
        Ok(markdown::table(&part))
    }
}

/// The columns that are wanted and where they stand.
fn columns(table: &Table, selection: &Selection) -> Result<Vec<(usize, Column)>, TableError> {
    if selection.columns.is_empty() {
        return Ok(table.columns.iter().cloned().enumerate().collect());
    }
    let column = |(name, title): &(String, Option<String>)| {
        let place = place(table, name)?;
        let column = table.columns[place].clone();
        Ok((
            place,
            match title {
                Some(title) => Column { title: title.clone(), group: String::new(), ..column },
                None => column,
            },
        ))
    };
    selection.columns.iter().map(column).collect()
}

fn place(table: &Table, name: &str) -> Result<usize, TableError> {
    table.columns.iter().position(|column| column.name == name).ok_or_else(|| TableError::NoColumn {
        table: table.name.clone(),
        name: name.to_owned(),
        known: table.columns.iter().map(|column| column.name.clone()).collect(),
    })
}
