//! A thread that does the newest thing it was asked for: a newer request makes the older one stop.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use lightloom_core::Progress;
use lightloom_core::progress::Snapshot;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::editor::guard::Guard;

/// A thread with one slot for what it shall do next.
pub struct Worker<Q> {
    shared: Arc<Shared<Q>>,
    thread: Option<JoinHandle<()>>,
}

/// How much of the processor a worker may take. Each has threads of its own: in a common pool a short piece of work waits
/// until a long one, such as the picture without caustics, lets a thread go; the system shares more fairly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Share {
    /// All threads: it answers what is waited for.
    Whole,
    /// Half of them: it can wait.
    Half,
    /// One: there is little to do.
    One,
}

impl Share {
    /// The pool of the current thread, which is one of its threads; the common one where the system gives no more.
    fn pool(self) -> Option<ThreadPool> {
        let all = std::thread::available_parallelism().map_or(1, usize::from);
        let threads = match self {
            Self::Whole => all,
            Self::Half => (all / 2).max(1),
            Self::One => 1,
        };
        ThreadPoolBuilder::new().num_threads(threads).use_current_thread().build().ok()
    }
}

/// How long shielded work is left alone, although something newer waits.
const PATIENCE: Duration = Duration::from_millis(300);

struct Shared<Q> {
    state: Mutex<State<Q>>,
    changed: Condvar,
}

struct State<Q> {
    next: Option<Q>,
    /// The work that goes on; none while the thread waits.
    current: Option<Progress>,
    /// Since when a newer request does not stop it.
    shielded: Option<Instant>,
    closed: bool,
    panicked: Option<String>,
}

/// One request's time on the thread.
pub struct Turn<'a> {
    /// Cancelled when a newer request comes.
    pub progress: Progress,
    shield: &'a dyn Fn(bool),
}

impl Turn<'_> {
    /// Does something short that is finished even when a newer request comes meanwhile: else nothing would ever be seen
    /// while requests come quickly, as from a slider.
    pub fn shielded<T>(&self, work: impl FnOnce(&Progress) -> T) -> T {
        (self.shield)(true);
        let done = work(&self.progress);
        (self.shield)(false);
        done
    }
}

impl<Q> Shared<Q> {
    fn state(&self) -> MutexGuard<'_, State<Q>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn shield(&self, up: bool) {
        let mut state = self.state();
        state.shielded = up.then(Instant::now);
        if let (false, true, Some(current)) = (up, state.next.is_some(), &state.current) {
            current.cancel();
        }
    }
}

impl<Q: Send + 'static> Worker<Q> {
    /// Starts a thread called `name` that may take a `share` of the processor. `make` builds what does the work, on that thread, and again after a panic. Without a
    /// thread, which the system may refuse, requests are answered by nobody and [`Self::panicked`] says so.
    pub fn new<W: FnMut(Q, &Turn)>(
        name: &str,
        share: Share,
        wake: impl Fn() + Send + 'static,
        make: impl Fn() -> W + Send + 'static,
    ) -> Self {
        let state = State { next: None, current: None, shielded: None, closed: false, panicked: None };
        let shared = Arc::new(Shared { state: Mutex::new(state), changed: Condvar::new() });
        let theirs = shared.clone();
        let guard = Guard::new(name);
        let thread = std::thread::Builder::new().name(name.to_owned()).spawn(move || {
            let _pool = share.pool();
            while run(&theirs, &guard, &make) {
                wake();
            }
        });
        if let Err(error) = &thread {
            shared.state().panicked = Some(format!("the system starts no thread for {name}: {error}"));
        }
        Self { shared, thread: thread.ok() }
    }

    /// Asks for this in place of everything asked for before.
    pub fn ask(&self, request: Q) {
        let mut state = self.shared.state();
        state.next = Some(request);
        let left_alone = state.shielded.is_some_and(|since| since.elapsed() < PATIENCE);
        if let Some(current) = state.current.as_ref().filter(|_| !left_alone) {
            current.cancel();
        }
        self.shared.changed.notify_one();
    }

    /// Whether something is worked on or waits for it.
    pub fn is_busy(&self) -> bool {
        let state = self.shared.state();
        state.current.is_some() || state.next.is_some()
    }

    /// How far the work is that goes on.
    pub fn progress(&self) -> Option<Snapshot> {
        self.shared.state().current.as_ref().map(Progress::snapshot)
    }

    /// What a panic said, once: the work was given up, the thread goes on with the next request.
    pub fn panicked(&self) -> Option<String> {
        self.shared.state().panicked.take()
    }
}

/// Works until there is a panic (then true) or the end.
fn run<Q, W: FnMut(Q, &Turn)>(shared: &Shared<Q>, guard: &Guard, make: &impl Fn() -> W) -> bool {
    let mut work = make();
    while let Some((request, progress)) = next(shared) {
        let shield = |up: bool| shared.shield(up);
        let worked = guard.run(|| work(request, &Turn { progress, shield: &shield }));
        let mut state = shared.state();
        (state.current, state.shielded) = (None, None);
        if let Err(words) = worked {
            state.panicked = Some(words);
            return true;
        }
    }
    false
}

/// Waits for the next request; none at the end.
fn next<Q>(shared: &Shared<Q>) -> Option<(Q, Progress)> {
    let mut state = shared.state();
    loop {
        if state.closed {
            return None;
        }
        if let Some(request) = state.next.take() {
            let progress = Progress::new();
            state.current = Some(progress.clone());
            return Some((request, progress));
        }
        state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
    }
}

impl<Q> Drop for Worker<Q> {
    /// Stops the work and waits for the thread.
    fn drop(&mut self) {
        {
            let mut state = self.shared.state();
            state.closed = true;
            if let Some(current) = &state.current {
                current.cancel();
            }
            self.shared.changed.notify_one();
        }
        if let Some(thread) = self.thread.take() {
            // A panic of the thread was told already.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::mpsc::channel;

    use super::*;

    #[test]
    fn the_newest_request_wins_and_stale_work_stops() {
        let (done, seen) = channel();
        let worker = Worker::new(
            "test",
            Share::One,
            || {},
            move || {
                let done = done.clone();
                move |request: u32, turn: &Turn| {
                    // Request 1 never ends by itself.
                    while request == 1 && !turn.progress.is_cancelled() {
                        std::thread::sleep(Duration::from_millis(1));
                    }
                    done.send((request, turn.progress.is_cancelled())).unwrap();
                }
            },
        );
        worker.ask(1);
        while worker.progress().is_none() {
            std::thread::yield_now();
        }
        worker.ask(2);
        assert_eq!(seen.recv().unwrap(), (1, true));
        assert_eq!(seen.recv().unwrap(), (2, false));
    }

    #[test]
    fn shielded_work_is_finished_before_the_newer_request_is_taken() {
        let (done, seen) = channel();
        let (go, shall) = channel();
        let shall = Arc::new(Mutex::new(shall));
        let worker = Worker::new(
            "test",
            Share::One,
            || {},
            move || {
                let (done, shall) = (done.clone(), shall.clone());
                move |request: u32, turn: &Turn| {
                    let stopped = turn.shielded(|progress| {
                        done.send((request, false, false)).unwrap();
                        shall.lock().unwrap().recv().unwrap();
                        progress.is_cancelled()
                    });
                    done.send((request, stopped, turn.progress.is_cancelled())).unwrap();
                }
            },
        );
        worker.ask(1);
        assert_eq!(seen.recv().unwrap().0, 1);
        // Newer work waits now, and the older is in the middle of what it shall finish.
        worker.ask(2);
        go.send(()).unwrap();
        assert_eq!(seen.recv().unwrap(), (1, false, true));
        assert_eq!(seen.recv().unwrap().0, 2);
        go.send(()).unwrap();
        assert_eq!(seen.recv().unwrap(), (2, false, false));
    }

    #[test]
    fn a_panic_is_told_and_the_next_request_is_answered() {
        let (done, seen) = channel();
        let worker = Worker::new(
            "test",
            Share::One,
            || {},
            move || {
                let done = done.clone();
                move |request: u32, _: &Turn| {
                    assert_ne!(request, 1, "one is too much");
                    done.send(request).unwrap();
                }
            },
        );
        worker.ask(1);
        let told = loop {
            if let Some(told) = worker.panicked() {
                break told;
            }
            std::thread::yield_now();
        };
        assert!(told.contains("one is too much"), "{told}");
        worker.ask(2);
        assert_eq!(seen.recv().unwrap(), 2);
    }

    #[test]
    fn dropping_it_stops_the_work() {
        let worker = Worker::new(
            "test",
            Share::One,
            || {},
            || {
                |(): (), turn: &Turn| {
                    while !turn.progress.is_cancelled() {
                        std::thread::sleep(Duration::from_millis(1));
                    }
                }
            },
        );
        worker.ask(());
        while worker.progress().is_none() {
            std::thread::yield_now();
        }
        let begun = Instant::now();
        drop(worker);
        // It would wait for ever if the work were not stopped; the minute is for a busy machine.
        assert!(begun.elapsed() < Duration::from_secs(60));
    }
}
