//! Where messages go: into a file that does not grow without end, and the first and last ones into memory, for the report.

use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Most bytes of a log.
const MOST: usize = 4 << 20;
/// The last line of a log that became too long.
const END: &[u8] = b"the log ends here: it has reached its limit of 4 MiB\n";
/// Messages of the beginning that are remembered, where the graphics device is told.
const FIRST: usize = 30;
/// Messages of the end that are remembered.
const LAST: usize = 300;
/// Most bytes of a remembered message.
const LONGEST: usize = 4000;

/// The messages of this run.
pub(super) static RUN: OnceLock<Arc<Sink>> = OnceLock::new();

/// The place of all messages of a run. Writing never fails: a full disk is no reason to stop the work.
pub(super) struct Sink<W = File> {
    path: Option<PathBuf>,
    state: Mutex<State<W>>,
}

struct State<W> {
    /// The log; none where there is no place for it, or no longer.
    file: Option<W>,
    /// Bytes that it may still take.
    left: usize,
    first: Vec<String>,
    last: VecDeque<String>,
    /// Messages between the first and the last.
    forgotten: usize,
}

impl<W> Sink<W> {
    /// A place with a file of this name, or without.
    pub(super) fn new(file: Option<W>, path: Option<PathBuf>) -> Self {
        let (first, last) = (Vec::new(), VecDeque::new());
        Self { path, state: Mutex::new(State { file, left: MOST, first, last, forgotten: 0 }) }
    }

    pub(super) fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    fn state(&self) -> MutexGuard<'_, State<W>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The first and the last messages.
    pub(super) fn messages(&self) -> String {
        let state = self.state();
        let mut text = state.first.concat();
        if state.forgotten > 0 {
            text += &format!("… {} messages are left out …\n", state.forgotten);
        }
        state.last.iter().for_each(|message| text += message);
        text
    }
}

impl<W: Write> State<W> {
    /// Writes a message into the file; gives the file up where that fails, or it is full.
    fn write(&mut self, message: &[u8]) -> io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        if let Some(left) = self.left.checked_sub(message.len()) {
            self.left = left;
            return file.write_all(message);
        }
        let ended = file.write_all(END);
        self.file = None;
        ended
    }

    fn remember(&mut self, message: &[u8]) {
        let cut = &message[..message.len().min(LONGEST)];
        let mut message = String::from_utf8_lossy(cut).into_owned();
        if !message.ends_with('\n') {
            message += " …\n";
        }
        if self.first.len() < FIRST {
            return self.first.push(message);
        }
        self.last.push_back(message);
        if self.last.len() > LAST {
            self.last.pop_front();
            self.forgotten += 1;
        }
    }
}

/// Takes one message in each call.
impl<W: Write> Write for &Sink<W> {
    fn write(&mut self, message: &[u8]) -> io::Result<usize> {
        let mut state = self.state();
        state.remember(message);
        if let Err(error) = state.write(message) {
            state.file = None;
            state.remember(format!("the log cannot be written any more: {error}\n").as_bytes());
        }
        Ok(message.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_log_ends_at_its_limit_and_the_last_messages_are_remembered() {
        let mut file = Vec::new();
        let sink = Sink::new(Some(&mut file), None);
        let message = |i: usize| format!("{i:09} {}\n", "x".repeat(989));
        let count = MOST / 1000 + 50;
        (0..count).for_each(|i| (&sink).write_all(message(i).as_bytes()).unwrap());
        let told = sink.messages();
        let left_out = format!("… {} messages are left out …\n", count - FIRST - LAST);
        for part in
            [&*message(0), &message(FIRST - 1), &left_out, &message(count - LAST), &message(count - 1)]
        {
            assert!(told.contains(part), "{}", &part[..40.min(part.len())]);
        }
        assert!(!told.contains(&message(FIRST)) && !told.contains(&message(count - LAST - 1)));
        drop(sink);
        assert!(file.len() <= MOST + END.len() && file.ends_with(END));
        assert_eq!(file.windows(END.len()).filter(|part| *part == END).count(), 1);
    }

    #[test]
    fn a_full_disk_ends_the_log_and_nothing_else() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let sink = Sink::new(Some(Full), None);
        for message in ["one\n", "two\n", &"long".repeat(LONGEST)] {
            (&sink).write_all(message.as_bytes()).unwrap();
        }
        let told = sink.messages();
        assert_eq!(told.matches("cannot be written any more").count(), 1, "{told}");
        assert!(told.contains("one\n") && told.contains("two\n") && told.len() < LONGEST + 200);
    }
}
