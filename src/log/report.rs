//! The report that a user sends with a question: versions, machine, settings, last messages. No content of any file.

use std::fmt::Write as _;

use super::sink::RUN;

/// A report as text. `sections` are what only the window knows: a title and a text each.
pub fn report(sections: &[(&str, String)]) -> String {
    let log = RUN.get();
    let place = log
        .and_then(|log| log.path())
        .map_or_else(|| "no file".into(), |path| format!("'{}'", path.display()));
    let messages = log.map_or_else(|| "there is no log".into(), |log| log.messages());
    let mut text = format!("Lightloom report\n\n{}\n", program());
    for (title, content) in sections {
        let _ = write!(text, "\n== {title} ==\n{}\n", content.trim_end());
    }
    let _ = write!(text, "\n== messages (the log is in {place}) ==\n{messages}\n");
    text
}

/// Version, system and processors in one line.
pub(super) fn program() -> String {
    let cores = std::thread::available_parallelism().map_or(0, std::num::NonZero::get);
    let [system, machine] = [std::env::consts::OS, std::env::consts::ARCH];
    format!("lightloom {}, {system} on {machine}, {cores} processors", env!("CARGO_PKG_VERSION"))
}
