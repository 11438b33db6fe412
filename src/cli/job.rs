//! What every command that works does around its work: Ctrl-C, the folder, the progress, the summary.

use std::path::Path;

use lightloom_core::engine::{Comparison, Engine, Summary, prepare_folder, write_report};
use lightloom_core::flow::MotionMethod;
use lightloom_core::project::Project;
use lightloom_core::{Progress, Result};
use lightloom_report::{Report, Stability};

use super::args::ProjectArgs;
use super::interrupt;
use super::progress::{Display, Lines, Manner};

/// Told of each file that is complete.
type Saved<'a> = &'a (dyn Fn(&Path) + Sync);

/// What a command leaves in words.
pub(super) trait Outcome {
    /// The file for it in the output folder.
    const FILE: &'static str;
    /// Folders below the output folder that are written into, too.
    fn folders() -> Vec<&'static str> {
        Vec::new()
    }
    /// Whether the file is written.
    fn is_reported(&self) -> bool {
        true
    }

    fn to_json(&self) -> String;
    fn to_text(&self) -> String;
}

impl Outcome for Summary {
    const FILE: &'static str = "summary.json";

    fn is_reported(&self) -> bool {
        self.is_of_all()
    }
    fn to_json(&self) -> String {
        self.to_json()
    }
    fn to_text(&self) -> String {
        self.to_text()
    }
}

impl Outcome for Comparison {
    const FILE: &'static str = "compare.json";
    fn folders() -> Vec<&'static str> {
        MotionMethod::ALL.map(MotionMethod::name).to_vec()
    }
    fn to_json(&self) -> String {
        self.to_json()
    }
    fn to_text(&self) -> String {
        self.to_text()
    }
}

impl Outcome for Report {
    const FILE: &'static str = "report.json";
    fn folders() -> Vec<&'static str> {
        vec!["report"]
    }
    fn to_json(&self) -> String {
        self.to_json()
    }
    fn to_text(&self) -> String {
        self.to_text()
    }
}

impl Outcome for Stability {
    const FILE: &'static str = "stability.json";
    fn to_json(&self) -> String {
        self.to_json()
    }
    fn to_text(&self) -> String {
        self.to_text()
    }
}

/// Loads the project, shows how far `work` is, then writes and prints its summary.
pub(super) fn run<T: Outcome>(
    args: &ProjectArgs,
    out: &Path,
    work: impl FnOnce(&Engine, &Project, &Progress, Saved) -> Result<T>,
) -> Result<T> {
    args.common.set_threads()?;
    let (path, project) = (args.path()?, args.load()?);
    let assets = args.common.assets(path)?;
    prepare_folder(out, path, &project, "--out")?;
    for folder in T::folders() {
        prepare_folder(&out.join(folder), path, &project, "--out")?;
    }
    watch(args, out, |progress, saved| work(&Engine::new(assets), &project, progress, saved))
}

/// Shows how far `work` is, then writes and prints its summary.
pub(super) fn watch<T: Outcome>(
    args: &ProjectArgs,
    out: &Path,
    work: impl FnOnce(&Progress, Saved) -> Result<T>,
) -> Result<T> {
    let summary = shown((Lines::beside(args.common.json), args.common.progress), work)?;
    conclude(&summary, out, args.common.json)?;
    Ok(summary)
}

/// Shows on `lines` how far `work` is, until it ends or Ctrl-C stops it.
pub(super) fn shown<T>(
    (lines, manner): (Lines, Manner),
    work: impl FnOnce(&Progress, Saved) -> Result<T>,
) -> Result<T> {
    let progress = Progress::new();
    interrupt::stops(&progress);
    let display = Display::start(&progress, lines, manner);
    let saved = |path: &Path| {
        tracing::info!("saved '{}'", path.display());
        display.line(&manner.saved(path));
    };
    let done = work(&progress, &saved);
    if let Some(line) = done.as_ref().err().and_then(|error| manner.failed(error)) {
        display.line(&line);
    }
    done
}

/// Writes the summary as JSON, and prints it so or as a few lines.
fn conclude<T: Outcome>(summary: &T, dir: &Path, json: bool) -> Result<()> {
    let text = summary.to_json();
    if summary.is_reported() {
        write_report(dir, T::FILE, &text)?;
    }
    tracing::info!("{}", summary.to_text().trim_end());
    let shown = if json { text } else { summary.to_text() };
    Lines::Out.print(shown.trim_end())
}
