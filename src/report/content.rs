//! The content of a report, independent of its layout: text, tables, plots and pictures.

use serde::Serialize;

use crate::number::short;
use crate::plot::Plot;

/// A section of a report.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Section {
    /// Short name, the stem of its files: letters, digits and `_`.
    pub name: &'static str,
    /// Headline.
    pub title: String,
    /// Its parts, in order.
    pub parts: Vec<Part>,
}

/// A part of a section.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// A paragraph, plain text.
    Text(String),
    /// A table.
    Table(Table),
    /// A plot.
    Plot(Plot),
    /// Pictures in a grid.
    Pictures(Pictures),
}

/// A table. Every row has one cell for each column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table {
    /// Stem of its CSV file.
    pub name: String,
    /// Caption, a sentence.
    pub caption: String,
    /// Names of the columns, with the unit where there is one: `seconds`, `error (plane)`.
    pub columns: Vec<&'static str>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// One cell for each column.
    pub cells: Vec<Cell>,
    /// Its emphasis.
    pub tone: Tone,
}

/// The emphasis of a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Tone {
    /// None.
    #[default]
    Plain,
    /// The project's own setting, or a recommended one.
    Marked,
    /// A missed bound.
    Bad,
}

/// A cell of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// Text.
    Text(String),
    /// A number; empty in files where it is not finite.
    Number(f64),
    /// An empty cell.
    Nothing,
}

/// Pictures in a grid, row by row.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pictures {
    /// Caption, a sentence.
    pub caption: String,
    /// Number of pictures side by side.
    pub columns: usize,
    /// The pictures.
    pub pictures: Vec<Picture>,
}

/// A picture with its label.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Picture {
    /// Label, a few words.
    pub label: String,
    /// A PNG file.
    #[serde(skip)]
    pub png: Vec<u8>,
}

impl Section {
    /// A section without parts.
    pub fn new(name: &'static str, title: impl Into<String>) -> Self {
        Self { name, title: title.into(), parts: Vec::new() }
    }

    /// Adds a paragraph.
    pub fn text(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Text(text.into()));
    }

    /// Adds a table.
    pub fn table(&mut self, table: Table) {
        self.parts.push(Part::Table(table));
    }

    /// Adds a plot.
    pub fn plot(&mut self, plot: Plot) {
        self.parts.push(Part::Plot(plot));
    }

    /// Adds pictures.
    pub fn pictures(&mut self, pictures: Pictures) {
        self.parts.push(Part::Pictures(pictures));
    }

    /// Its tables.
    pub fn tables(&self) -> impl Iterator<Item = &Table> {
        self.parts.iter().filter_map(|part| match part {
            Part::Table(table) => Some(table),
            _ => None,
        })
    }

    /// Its plots.
    pub fn plots(&self) -> impl Iterator<Item = &Plot> {
        self.parts.iter().filter_map(|part| match part {
            Part::Plot(plot) => Some(plot),
            _ => None,
        })
    }
}

impl Table {
    /// A table without rows.
    pub fn new(name: impl Into<String>, caption: impl Into<String>, columns: &[&'static str]) -> Self {
        Self { name: name.into(), caption: caption.into(), columns: columns.to_vec(), rows: Vec::new() }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// When the number of cells is not that of the columns.
    pub fn push(&mut self, tone: Tone, cells: Vec<Cell>) {
        assert_eq!(cells.len(), self.columns.len(), "one cell for each column of {}", self.name);
        self.rows.push(Row { cells, tone });
    }

    /// The table as CSV with a header, quoted where necessary.
    ///
    /// # Errors
    /// None in practice: the table is written to memory.
    pub fn to_csv(&self) -> csv::Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(&self.columns)?;
        for row in &self.rows {
            writer.write_record(row.cells.iter().map(Cell::exact))?;
        }
        writer.into_inner().map_err(|error| error.into_error().into())
    }
}

impl Cell {
    /// The cell with all digits of its number.
    fn exact(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value) if value.is_finite() => value.to_string(),
            Self::Number(_) | Self::Nothing => String::new(),
        }
    }

    /// The cell with three significant digits.
    pub(crate) fn short(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value) => short(*value),
            Self::Nothing => "–".to_owned(),
        }
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(value: usize) -> Self {
        Self::Number(value as f64)
    }
}

impl<T: Into<Cell>> From<Option<T>> for Cell {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Nothing, Into::into)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_table_is_read_back_by_another_reader() {
        let mut table = Table::new("t", "", &["name", "value", "hole"]);
        table.push(Tone::Plain, vec!["a \"b\", c".into(), 0.1.into(), Cell::Nothing]);
        table.push(Tone::Bad, vec!["".into(), f64::INFINITY.into(), 2_usize.into()]);
        let bytes = table.to_csv().unwrap();
        let mut reader = csv::Reader::from_reader(bytes.as_slice());
        let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.unwrap()).collect();
        assert_eq!(&rows[0][0], "a \"b\", c");
        assert_eq!(rows[0][1].parse::<f64>().unwrap(), 0.1);
        assert_eq!((&rows[0][2], &rows[1][1], &rows[1][2]), ("", "", "2"));
    }
}
