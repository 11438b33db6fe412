//! What the settings buy and what they cost, measured: a page with tables, plots and pictures.
//!
//! A report is a list of sections ([`section`]), each a file that measures one thing and returns a [`Chapter`]; `page`
//! gives chapters their form. What a section needs of a project it finds on the [`Workbench`].

mod chapter;
mod crop;
mod page;
mod pareto;
mod plot;
mod section;
mod slope;
mod ssim;
mod stability;
mod workbench;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde::Serialize;

pub use chapter::{Cell, Chapter, Part, Picture, Pictures, Row, Table, Tone};
pub use plot::{Axis, Line, Panel, Plot, Style};
pub use section::gamma::{GammaResponse, Response, gamma_response};
pub use stability::{Bound, EnergyOf, Limits, Measured, Size, Stability, StabilityRow, stability};
pub use workbench::Effort;

use lightloom_core::engine::Engine;
use lightloom_core::files::write_atomic;
use lightloom_core::project::Project;
use lightloom_core::{Error, Progress, Result};
use section::SECTIONS;
use workbench::Workbench;

/// Chapters with what a reader has to know of their making.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// Headline.
    pub title: String,
    /// What made it and on what: program, version, cores.
    pub made_by: String,
    /// What was measured, in order.
    pub chapters: Vec<Chapter>,
    /// Sections that are not there, and why.
    pub absent: Vec<Absent>,
    /// Seconds that it took.
    pub seconds: f64,
}

/// A section that is not there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Absent {
    /// Its name.
    pub section: &'static str,
    /// Why it is not there.
    pub why: String,
    /// Whether it failed; otherwise the project has nothing for it, or the run was stopped.
    pub failed: bool,
}

/// Measures a project: all sections that it has something for, or those in `only` (all when empty).
///
/// A section that fails is named as absent and the others go on. A run that is cancelled after its first section returns
/// what is there. `scratch` is a folder with room for the frames of a render, such as that of the report.
///
/// # Errors
/// A name in `only` that is no section; anything wrong with the project or its files; cancelled before anything was measured.
pub fn report(
    engine: &Engine,
    project: &Project,
    effort: Effort,
    only: &[String],
    scratch: &Path,
    progress: &Progress,
) -> Result<Report> {
    let start = Instant::now();
    let chosen = section::choose(only)?;
    progress.set_stages(chosen.iter().map(|section| (section.name, section.seconds(effort))).collect());
    let mut bench = Workbench::new(engine, project, effort, scratch, progress)?;
    let (mut chapters, mut absent) = (Vec::new(), Vec::new());
    for section in chosen {
        let mut leave_out = |why: String, failed| absent.push(Absent { section: section.name, why, failed });
        if let Some(why) = (section.needless)(project) {
            leave_out(why.to_owned(), false);
            continue;
        }
        match progress.check().and_then(|()| (section.measure)(&mut bench, progress)) {
            Ok(chapter) => chapters.push(chapter),
            Err(Error::Cancelled) if chapters.is_empty() => return Err(Error::Cancelled),
            Err(Error::Cancelled) => leave_out("the run was stopped".to_owned(), false),
            Err(error) => leave_out(error.to_string(), true),
        }
    }
    let (title, seconds) = (project.name.clone(), start.elapsed().as_secs_f64());
    Ok(Report { title, made_by: made_by(effort), chapters, absent, seconds })
}

/// Names of all sections, in order.
pub fn sections() -> impl Iterator<Item = &'static str> {
    SECTIONS.iter().map(|section| section.name)
}

fn made_by(effort: Effort) -> String {
    let size = match effort {
        Effort::Quick => "quick, at preview size",
        Effort::Full => "full size",
    };
    let threads = rayon::current_num_threads();
    format!("Lightloom {}, {threads} threads, {size}", env!("CARGO_PKG_VERSION"))
}

impl Report {
    /// Writes `stem.html`, and into the folder `stem` beside it each table as CSV and each plot as SVG. Returns the paths.
    ///
    /// # Errors
    /// `Io` when a file cannot be written, `Numeric` when a plot holds a number that is not finite.
    pub fn write(&self, out: &Path, stem: &str) -> Result<Vec<PathBuf>> {
        let folder = out.join(stem);
        std::fs::create_dir_all(&folder).map_err(Error::io("create the folder", &folder))?;
        let mut files = vec![(out.join(stem).with_extension("html"), page::html(self)?.into_bytes())];
        for table in self.chapters.iter().flat_map(Chapter::tables) {
            let csv = table
                .to_csv()
                .map_err(|error| Error::Numeric { stage: "report", what: error.to_string() })?;
            files.push((folder.join(format!("{}.csv", table.name)), csv));
        }
        for plot in self.chapters.iter().flat_map(Chapter::plots) {
            files.push((folder.join(format!("{}.svg", plot.name)), plot.to_svg()?.into_bytes()));
        }
        for (path, bytes) in &files {
            write_atomic(path, |file| file.write_all(bytes))?;
        }
        Ok(files.into_iter().map(|(path, _)| path).collect())
    }

    /// All of it but the pictures, as indented JSON.
    pub fn to_json(&self) -> String {
        // Plain numbers and strings: serialisation has nothing to fail on.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// Whether a section failed.
    pub fn has_failed(&self) -> bool {
        self.absent.iter().any(|absent| absent.failed)
    }

    /// What there is, as lines for people.
    pub fn to_text(&self) -> String {
        let mut text = format!("{}: {} sections in {:.0} s\n", self.title, self.chapters.len(), self.seconds);
        for chapter in &self.chapters {
            text += &format!("  {:<10} {}\n", chapter.name, chapter.title);
        }
        for Absent { section, why, failed } in &self.absent {
            text += &format!("  {section:<10} {}: {why}\n", if *failed { "failed" } else { "left out" });
        }
        text
    }
}
