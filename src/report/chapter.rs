//! What a section of the report has to say: words, tables, plots and pictures, before they take a form.

use serde::Serialize;

use super::plot::Plot;

/// One section of a report, done.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Chapter {
    /// Short name, the stem of its files: letters, digits and `_`.
    pub name: &'static str,
    /// Its headline.
    pub title: String,
    /// What it says, in order.
    pub parts: Vec<Part>,
}

/// A piece of a chapter.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Part {
    /// A paragraph, plain text.
    Text(String),
    /// Numbers in rows.
    Table(Table),
    /// Lines and points over an axis.
    Plot(Plot),
    /// Pictures in a grid.
    Pictures(Pictures),
}

/// Numbers in rows under their names. Every row has one cell for each column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table {
    /// Stem of its CSV file.
    pub name: String,
    /// What it shows, a sentence.
    pub caption: String,
    /// Names of the columns, with the unit where there is one: `seconds`, `error (plane)`.
    pub columns: Vec<&'static str>,
    /// The rows.
    pub rows: Vec<Row>,
}

/// A row of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// One for each column.
    pub cells: Vec<Cell>,
    /// How it stands out.
    pub tone: Tone,
}

/// What a row is to the reader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Tone {
    /// One among others.
    #[default]
    Plain,
    /// The project's own setting, or the one to choose.
    Marked,
    /// Misses its bound.
    Bad,
}

/// One place of a table.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Cell {
    /// Words.
    Text(String),
    /// A number; not finite is written as nothing.
    Number(f64),
    /// Nothing is known, or asked.
    Nothing,
}

/// Pictures in a grid, row by row.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pictures {
    /// What they show, a sentence.
    pub caption: String,
    /// Pictures side by side.
    pub columns: usize,
    /// The pictures.
    pub pictures: Vec<Picture>,
}

/// One picture with its name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Picture {
    /// What it is, some words.
    pub label: String,
    /// A PNG file.
    #[serde(skip)]
    pub png: Vec<u8>,
}

impl Chapter {
    /// An empty chapter.
    pub fn new(name: &'static str, title: impl Into<String>) -> Self {
        Self { name, title: title.into(), parts: Vec::new() }
    }

    /// Adds a paragraph.
    pub fn say(&mut self, text: impl Into<String>) {
        self.parts.push(Part::Text(text.into()));
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
    /// When it has not one cell for each column.
    pub fn push(&mut self, tone: Tone, cells: Vec<Cell>) {
        assert_eq!(cells.len(), self.columns.len(), "one cell for each column of {}", self.name);
        self.rows.push(Row { cells, tone });
    }

    /// Comma separated, under the names of the columns; quoted where it must be.
    ///
    /// # Errors
    /// None that writing to memory could have.
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
    /// All digits of a number, for programs.
    fn exact(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value) if value.is_finite() => value.to_string(),
            Self::Number(_) | Self::Nothing => String::new(),
        }
    }

    /// As a reader wants it: three digits that count.
    pub(super) fn short(&self) -> String {
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value) => short(*value),
            Self::Nothing => "–".to_owned(),
        }
    }
}

/// A number with three digits that count, as `1234`, `0.0123` or `1.23e-7`.
pub(super) fn short(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if !value.is_finite() => "not finite".to_owned(),
        0.0 => "0".to_owned(),
        1e6.. => format!("{value:.2e}"),
        100.0.. => format!("{value:.0}"),
        1e-3.. => {
            let digits = (2.0 - size.log10().floor()).max(0.0) as usize;
            let text = format!("{value:.digits$}");
            // Whole numbers stay whole.
            if value.fract() == 0.0 { format!("{value}") } else { text }
        }
        _ => format!("{value:.2e}"),
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
    fn numbers_keep_three_digits_that_count() {
        let cases = [
            (0.0, "0"),
            (1234.4, "1234"),
            (12.345, "12.3"),
            (3.0, "3"),
            (0.012345, "0.0123"),
            (1.2345e-7, "1.23e-7"),
            (-2.5e7, "-2.50e7"),
            (f64::NAN, "not finite"),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
    }

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
