//! The files of a report: a page, tables as CSV, plots as SVG.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::content::Section;
use crate::page;
use crate::report::Report;
use lightloom_core::files::write_atomic;
use lightloom_core::{Error, Result};

impl Report {
    /// Writes `stem.html`, and into the folder `stem` beside it each table as CSV and each plot as SVG. Returns the paths.
    ///
    /// # Errors
    /// `Io` when a file cannot be written, `Numeric` when a plot holds a number that is not finite.
    pub fn write(&self, out: &Path, stem: &str) -> Result<Vec<PathBuf>> {
        let folder = out.join(stem);
        std::fs::create_dir_all(&folder).map_err(Error::io("create the folder", &folder))?;
        let mut files = vec![(out.join(stem).with_extension("html"), page::html(self)?.into_bytes())];
        for table in self.sections.iter().flat_map(Section::tables) {
            let csv = table
                .to_csv()
                .map_err(|error| Error::Numeric { stage: "report", what: error.to_string() })?;
            files.push((folder.join(format!("{}.csv", table.name)), csv));
        }
        for plot in self.sections.iter().flat_map(Section::plots) {
            files.push((folder.join(format!("{}.svg", plot.name)), plot.to_svg()?.into_bytes()));
        }
        for (path, bytes) in &files {
            write_atomic(path, |file| file.write_all(bytes))?;
        }
        Ok(files.into_iter().map(|(path, _)| path).collect())
    }
}
