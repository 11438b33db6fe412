//! Bad inputs in one table: what goes in, words that must come out, what came out. With `UPDATE_PAGES=1` the tables are
//! written anew as pages beside the report.

use std::fmt::{Display, Write as _};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

mod drawn;
mod fuzz;
mod meshes;
mod pictures;
mod points;
pub(crate) mod projects;
mod seeds;

/// An input and what came of it.
pub(crate) struct Row {
    input: String,
    /// Words of which all must be observed, in this order, parted by " … ".
    expected: String,
    observed: String,
}

impl Row {
    /// An input that must be refused with these words.
    pub(crate) fn refused<T>(
        input: impl Into<String>,
        words: &str,
        observe: impl FnOnce() -> Result<T, String>,
    ) -> Self {
        let told = |_| "no note".to_owned();
        Self::new(input.into(), format!("refused: … {words}"), || observe().map(told))
    }

    /// An input that must be read, with these words in its notes.
    fn read(
        input: impl Into<String>,
        words: &str,
        observe: impl FnOnce() -> Result<Vec<String>, String>,
    ) -> Self {
        Self::new(input.into(), format!("read … {words}"), || observe().map(|notes| notes.join("; ")))
    }

    fn new(input: String, expected: String, observe: impl FnOnce() -> Result<String, String>) -> Self {
        let start = Instant::now();
        let observed = match catch_unwind(AssertUnwindSafe(observe)) {
            Ok(Ok(notes)) if notes.is_empty() => "read".to_owned(),
            Ok(Ok(notes)) => format!("read: {notes}"),
            Ok(Err(error)) => format!("refused: {error}"),
            Err(_) => "PANIC".to_owned(),
        };
        let taken = start.elapsed();
        if taken > Duration::from_secs(1) {
            println!("{input}: {taken:.1?}");
        }
        Self { input, expected, observed }
    }

    fn holds(&self) -> bool {
        let mut rest = &*self.observed;
        self.expected.split(" … ").all(|words| {
            let found = rest.find(words).map(|at| at + words.len());
            rest = found.map_or(rest, |end| &rest[end..]);
            found.is_some()
        })
    }
}

/// The text of an error without the folder of the test, which has another name in each run.
pub(crate) fn told(error: impl Display, folder: &Path) -> String {
    without(&error.to_string(), folder)
}

fn without(text: &str, folder: &Path) -> String {
    let mut text = text.to_owned();
    for folder in [folder.to_owned(), folder.canonicalize().unwrap_or_default()] {
        if !folder.as_os_str().is_empty() {
            text = text.replace(&format!("{}/", folder.display()), "");
            text = text.replace(&*folder.to_string_lossy(), ".");
        }
    }
    text
}

fn page(name: &str) -> PathBuf {
    crate::root().join("src/report/pages").join(name)
}

/// Whether the pages are written anew.
fn updates_pages() -> bool {
    std::env::var_os("UPDATE_PAGES").is_some()
}

/// Text as it stands in a cell of a table, of a readable length.
fn cell(text: &str) -> String {
    const MOST: usize = 220;
    let one_line = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let printable: String = one_line.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    let cut = printable.chars().count() > MOST;
    let text: String = printable.chars().take(MOST).collect();
    text.replace('|', "\\|").replace('<', "&lt;") + if cut { " …" } else { "" }
}

fn table() -> Vec<(&'static str, Vec<Row>)> {
    vec![
        ("Project files", projects::rows()),
        ("Files that a project names", projects::asset_rows()),
        ("Lines and walls", drawn::rows()),
        ("Pictures", pictures::rows()),
        ("Points", points::rows()),
        ("Meshes (OBJ, MTL)", meshes::rows()),
        ("Scenes (glTF)", crate::gltf::hostile::rows()),
    ]
}

fn markdown(groups: &[(&str, Vec<Row>)]) -> String {
    let count: usize = groups.iter().map(|(_, rows)| rows.len()).sum();
    let refused =
        groups.iter().flat_map(|(_, rows)| rows).filter(|row| row.observed.starts_with("refused")).count();
    let mut text = format!(
        "# Bad inputs, and what comes of them\n\nWritten by the tests (`tests/core/hostile`): {count} inputs, of which {refused} \
         are refused and {} read, 0 panics. Damaged files without number are in [fuzzing.md](fuzzing.md).\n",
        count - refused
    );
    for (title, rows) in groups {
        let _ =
            write!(text, "\n## {title} ({})\n\n| input | expected | observed |\n|---|---|---|\n", rows.len());
        for row in rows {
            let _ = writeln!(
                text,
                "| {} | {} | {} |",
                cell(&row.input),
                cell(row.expected.trim_end_matches(" … ")),
                cell(&row.observed)
            );
        }
    }
    text
}

#[test]
fn bad_inputs_are_refused_or_read_with_a_note() {
    let groups = table();
    let wrong: Vec<_> = groups
        .iter()
        .flat_map(|(_, rows)| rows)
        .filter(|row| !row.holds())
        .map(|row| format!("{}: {:?}: {}", row.input, row.expected, row.observed))
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    // Elsewhere the system's words differ.
    if cfg!(target_os = "linux") {
        let (path, text) = (page("hostile_inputs.md"), markdown(&groups));
        if updates_pages() {
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(&path, text).unwrap();
        } else {
            let now = std::fs::read_to_string(&path).unwrap_or_default();
            let help = "UPDATE_PAGES=1 cargo test --release -p lightloom_core --test core hostile::bad";
            assert!(
                now == text,
                "src/report/pages/hostile_inputs.md is of another program; to write it anew: {help}"
            );
        }
    }
}
