//! Work on a thread of its own, in which a panic is a failure like another.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
#[cfg(test)]
use std::{
    cell::Cell,
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering::Relaxed},
    },
};

/// Guards the work of one thread.
#[derive(Clone, Debug)]
pub(super) struct Guard {
    /// A panic that a test planted: the next work ends with it.
    #[cfg(test)]
    planted: Arc<AtomicBool>,
}

impl Guard {
    /// The guard of the thread with this name; made on the thread that starts it.
    #[cfg_attr(not(test), expect(unused_variables, reason = "tests plant panics by name"))]
    pub(super) fn new(name: &str) -> Self {
        Self {
            #[cfg(test)]
            planted: Arc::new(AtomicBool::new(PLANTED.get().is_some_and(|planted| planted == name))),
        }
    }

    /// Does the work; an error is what a panic said.
    ///
    /// # Errors
    /// There was a panic.
    pub(super) fn run<T>(&self, work: impl FnOnce() -> T) -> Result<T, String> {
        catch_unwind(AssertUnwindSafe(|| {
            #[cfg(test)]
            assert!(!self.planted.swap(false, Relaxed), "a planted panic");
            work()
        }))
        .map_err(|panic| words(&*panic))
    }
}

/// The words of a panic.
fn words(panic: &(dyn Any + Send)) -> String {
    let words = panic.downcast_ref::<String>().map(String::as_str);
    words.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no reason was given").to_owned()
}

#[cfg(test)]
thread_local! {
    static PLANTED: Cell<Option<&'static str>> = const { Cell::new(None) };
}

/// Plants a panic into the first work of the threads with this name that `start` starts from this one.
#[cfg(test)]
pub(in crate::editor) fn planted<T>(name: &'static str, start: impl FnOnce() -> T) -> T {
    PLANTED.set(Some(name));
    let started = start();
    PLANTED.set(None);
    started
}
