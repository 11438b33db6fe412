//! Results of a stage, remembered with the input they were made from.
//!
//! A memo is shared by all users of an [`Engine`](super::Engine). A result is found by its input, whoever made it, and
//! kept as long as a [`Slot`] holds it: each user keeps one result per quality and segment, so that memory stays bounded
//! whatever is edited.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, SystemTime};

use super::Quality;
use crate::{Progress, Result};

/// An input that equals only itself: the result of an earlier stage, by identity.
pub(super) struct Same<T: ?Sized>(Arc<T>);

impl<T: ?Sized> Same<T> {
    pub(super) fn of(result: &Arc<T>) -> Self {
        Self(result.clone())
    }
}

impl<T: ?Sized> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T: ?Sized> Clone for Same<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

/// Identity of a file's contents: its path, time of last change and size.
#[derive(Clone, PartialEq)]
pub(super) struct FileStamp {
    path: PathBuf,
    /// Absent where the system does not tell.
    state: Option<(SystemTime, u64)>,
}

impl FileStamp {
    /// The stamp of the file at `path` as it is now.
    pub(super) fn of(path: &Path) -> Self {
        let state = path.metadata().ok().and_then(|file| Some((file.modified().ok()?, file.len())));
        Self { path: path.to_owned(), state }
    }

    /// Whether the file is still the same.
    pub(super) fn is_current(&self) -> bool {
        *self == Self::of(&self.path)
    }

    /// The file's path.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }
}

/// The user on whose behalf results are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Client {
    /// The only one, such as a command.
    #[default]
    Main,
    /// The other side of a comparison in the editor.
    Comparison,
    /// Renders that run beside the editor.
    Export,
}

/// The place that keeps one result of a memo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Slot {
    pub(super) client: Client,
    pub(super) quality: Quality,
    /// The segment or key frame, from 0; 0 where results do not belong to one.
    pub(super) index: usize,
}

/// The remembered results of one stage.
pub(super) struct Memo<I, O> {
    entries: Mutex<Entries<I, O>>,
    /// Signalled when a result was made, or its making failed.
    settled: Condvar,
}

struct Entries<I, O> {
    made: Vec<Entry<I, O>>,
    making: Vec<Making<I>>,
}

struct Entry<I, O> {
    slots: Vec<Slot>,
    input: Arc<I>,
    output: O,
}

/// A result that some thread works on.
struct Making<I> {
    input: Arc<I>,
    progress: Progress,
}

/// Interval at which a thread that waits for another's result checks for cancellation.
const PATIENCE: Duration = Duration::from_millis(10);

impl<I, O> Default for Memo<I, O> {
    fn default() -> Self {
        let entries = Entries { made: Vec::new(), making: Vec::new() };
        Self { entries: Mutex::new(entries), settled: Condvar::new() }
    }
}

impl<I: PartialEq, O: Clone> Memo<I, O> {
    /// The result for `input`: the remembered one, the one that another thread is making, or a new one by `make`.
    /// A failed `make` is not remembered.
    ///
    /// # Errors
    /// Those of `make`; `Cancelled` while waiting for another thread.
    pub(super) fn get(
        &self,
        slot: Slot,
        input: I,
        progress: &Progress,
        make: impl FnOnce(&I) -> Result<O>,
    ) -> Result<O> {
        self.get_if(|_| true, slot, input, progress, make)
    }

    /// As [`Self::get`]; a remembered result counts only if it `holds` by what else it was made from.
    ///
    /// # Errors
    /// As [`Self::get`].
    pub(super) fn get_if(
        &self,
        holds: impl Fn(&O) -> bool,
        slot: Slot,
        input: I,
        progress: &Progress,
        make: impl FnOnce(&I) -> Result<O>,
    ) -> Result<O> {
        let input = Arc::new(input);
        loop {
            let mut entries = self.lock();
            match entries.take(slot, &input) {
                Some(output) if holds(&output) => return Ok(output),
                Some(_) => entries.made.retain(|entry| *entry.input != *input),
                None => (),
            }
            // A paused maker may rest for hours; its result is made twice then.
            let awaited = |making: &Making<I>| *making.input == *input && !making.progress.is_paused();
            if !entries.making.iter().any(awaited) {
                entries.making.push(Making { input: input.clone(), progress: progress.clone() });
                break;
            }
            drop(self.settled.wait_timeout(entries, PATIENCE).unwrap_or_else(PoisonError::into_inner));
            progress.check()?;
        }
        let making = Ticket { memo: self, input: &input };
        let output = make(&input)?;
        self.lock().keep(slot, &input, &output);
        drop(making);
        Ok(output)
    }

    /// The remembered result for `input`, of whichever slot.
    #[cfg(test)]
    fn peek(&self, input: &I) -> Option<O> {
        self.lock().made.iter().find(|entry| *entry.input == *input).map(|entry| entry.output.clone())
    }
}

impl<I, O> Memo<I, O> {
    fn lock(&self) -> MutexGuard<'_, Entries<I, O>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<I: PartialEq, O: Clone> Entries<I, O> {
    /// The result made from `input`, which `slot` keeps from now on.
    fn take(&mut self, slot: Slot, input: &I) -> Option<O> {
        let found = self.made.iter().position(|entry| *entry.input == *input)?;
        let output = self.made[found].output.clone();
        if !self.made[found].slots.contains(&slot) {
            self.release(slot);
            let kept = self.made.iter_mut().find(|entry| *entry.input == *input);
            kept.into_iter().for_each(|entry| entry.slots.push(slot));
        }
        Some(output)
    }

    fn keep(&mut self, slot: Slot, input: &Arc<I>, output: &O) {
        self.release(slot);
        self.made.push(Entry { slots: vec![slot], input: input.clone(), output: output.clone() });
    }

    /// Lets a slot forget its result; one that no slot holds any more goes.
    fn release(&mut self, slot: Slot) {
        self.made.iter_mut().for_each(|entry| entry.slots.retain(|kept| *kept != slot));
        self.made.retain(|entry| !entry.slots.is_empty());
    }
}

/// Marks a result as being made until it is dropped, also by an error or a panic.
struct Ticket<'a, I, O> {
    memo: &'a Memo<I, O>,
    input: &'a Arc<I>,
}

impl<I, O> Drop for Ticket<'_, I, O> {
    fn drop(&mut self) {
        self.memo.lock().making.retain(|making| !Arc::ptr_eq(&making.input, self.input));
        self.memo.settled.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Error;
    use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

    fn slot(client: Client, index: usize) -> Slot {
        Slot { client, quality: Quality::Final, index }
    }

    #[test]
    fn the_same_input_is_worked_out_once() {
        let (memo, mut runs) = (Memo::default(), 0);
        for input in [1, 1, 2, 2, 1] {
            let made = memo.get(slot(Client::Main, 0), input, &Progress::new(), |i| {
                runs += 1;
                Ok(10 * i)
            });
            assert_eq!(made.ok(), Some(10 * input));
        }
        assert_eq!(runs, 3);
    }

    #[test]
    fn a_failure_is_not_remembered() {
        let (memo, progress) = (Memo::<i32, i32>::default(), Progress::new());
        assert!(memo.get(slot(Client::Main, 0), 1, &progress, |_| Err(Error::Cancelled)).is_err());
        assert_eq!(memo.get(slot(Client::Main, 0), 1, &progress, |i| Ok(*i)).ok(), Some(1));
    }

    #[test]
    fn a_result_is_shared_by_clients_and_goes_when_no_slot_holds_it() {
        let (memo, progress) = (Memo::default(), Progress::new());
        let get = |client, index, input: i32| {
            memo.get(slot(client, index), input, &progress, |i| Ok::<i32, Error>(*i)).ok()
        };
        assert_eq!(get(Client::Main, 0, 1), Some(1));
        let never = |_: &i32| -> Result<i32> { panic!("it is remembered") };
        assert_eq!(memo.get(slot(Client::Export, 0), 1, &progress, never).ok(), Some(1));
        // Another segment takes nothing away; another input does, once both clients have it.
        assert_eq!((get(Client::Main, 1, 5), memo.peek(&1)), (Some(5), Some(1)));
        assert_eq!((get(Client::Main, 0, 2), memo.peek(&1)), (Some(2), Some(1)));
        assert_eq!((get(Client::Export, 0, 2), memo.peek(&1)), (Some(2), None));
    }

    #[test]
    fn two_threads_make_one_result_and_a_cancelled_maker_is_replaced() {
        let (memo, runs) = (Memo::default(), AtomicUsize::new(0));
        let get = |fails: bool| {
            memo.get(slot(Client::Main, 0), 7, &Progress::new(), |i| {
                runs.fetch_add(1, Relaxed);
                std::thread::sleep(Duration::from_millis(30));
                if fails { Err(Error::Cancelled) } else { Ok(*i) }
            })
        };
        std::thread::scope(|scope| {
            let workers = [(); 4].map(|()| scope.spawn(|| get(false)));
            workers
                .into_iter()
                .for_each(|worker| assert_eq!(worker.join().ok().and_then(Result::ok), Some(7)));
        });
        assert_eq!(runs.load(Relaxed), 1);
        let memo = Memo::<i32, i32>::default();
        std::thread::scope(|scope| {
            let slow = |_: &i32| {
                std::thread::sleep(Duration::from_millis(60));
                Err(Error::Cancelled)
            };
            let (memo, progress) = (&memo, Progress::new());
            let maker = scope.spawn(move || memo.get(slot(Client::Main, 0), 7, &progress, slow));
            std::thread::sleep(Duration::from_millis(20));
            let waited = memo.get(slot(Client::Export, 0), 7, &Progress::new(), |i| Ok(*i));
            assert_eq!(waited.ok(), Some(7));
            assert!(maker.join().is_ok_and(|made| made.is_err()));
        });
    }

    #[test]
    fn a_waiting_thread_can_be_cancelled_and_does_not_wait_for_a_paused_one() {
        let memo = Memo::<i32, i32>::default();
        let paused = Progress::new();
        std::thread::scope(|scope| {
            let (memo, maker) = (&memo, paused.clone());
            scope.spawn(move || {
                memo.get(slot(Client::Export, 0), 7, &maker, |i| {
                    std::thread::sleep(Duration::from_millis(100));
                    maker.check().map(|()| *i)
                })
            });
            std::thread::sleep(Duration::from_millis(20));
            let cancelled = Progress::new();
            cancelled.cancel();
            assert!(memo.get(slot(Client::Main, 0), 7, &cancelled, |i| Ok(*i)).is_err());
            paused.pause();
            assert_eq!(memo.get(slot(Client::Main, 0), 7, &Progress::new(), |_| Ok(8)).ok(), Some(8));
            paused.resume();
        });
    }
}
