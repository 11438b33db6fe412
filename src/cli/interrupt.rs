//! Ctrl-C and the system's wish that the program ends, as at the end of a farm's time: the work stops and keeps what there is.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, OnceLock};
use std::time::Duration;

use lightloom_core::Progress;
use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// How often signals are looked for: a cancellation takes less than half a second.
const PERIOD: Duration = Duration::from_millis(50);

/// How long a run that the system ends still writes frames: farms kill what is there after ten seconds or more.
const GRACE: Duration = Duration::from_millis(8500);

/// A signal that ends the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Signal(i32);

impl Signal {
    /// The exit code of a program that it ended: 130 for Ctrl-C, 143 for SIGTERM.
    pub(super) fn exit_code(self) -> u8 {
        u8::try_from(128 + self.0).unwrap_or(u8::MAX)
    }
}

/// The number of the last signal, 0 before there was one.
fn last() -> &'static Arc<AtomicUsize> {
    static LAST: OnceLock<Arc<AtomicUsize>> = OnceLock::new();
    LAST.get_or_init(Arc::default)
}

/// The signal that came last; none before there was one.
pub(super) fn signal() -> Option<Signal> {
    let number = i32::try_from(last().load(Relaxed)).ok()?;
    (number != 0).then_some(Signal(number))
}

/// From now on the first signal cancels `progress`; a second one leaves at once.
pub(super) fn stops(progress: &Progress) {
    let come = Arc::new(AtomicBool::new(false));
    for number in [SIGINT, SIGTERM] {
        let listen = || {
            flag::register_conditional_shutdown(number, 128 + number, come.clone())?;
            flag::register_usize(number, last().clone(), usize::try_from(number).unwrap_or_default())?;
            flag::register(number, come.clone())
        };
        if let Err(error) = listen() {
            eprintln!("lightloom: signal {number} stops at once and keeps nothing: {error}");
        }
    }
    let progress = progress.clone();
    // It ends with the program.
    std::thread::spawn(move || {
        while !come.load(Relaxed) {
            std::thread::sleep(PERIOD);
        }
        match signal() {
            Some(Signal(SIGTERM)) => progress.cancel_within(GRACE),
            _ => progress.cancel(),
        }
    });
}
