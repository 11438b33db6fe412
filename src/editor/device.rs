//! The graphics device of the window: whether it is still there, and what is done where it is not.

use std::path::Path;
use std::process::{Command, exit};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Tells a program that takes the place of another, whose graphics device was lost, how many of them there were.
const LOST: &str = "LIGHTLOOM_DEVICES_LOST";
/// Most programs that take the place of others.
const MOST: u32 = 3;
/// The exit code where the same may succeed a little later.
pub(crate) const TRY_AGAIN: u8 = 75;

/// Tells the window that its graphics device is lost.
#[derive(Debug, Default)]
pub struct Device {
    lost: AtomicBool,
    /// Whether the window is being closed: devices go with it.
    closed: AtomicBool,
}

impl Device {
    /// The device is lost.
    pub fn lose(&self) {
        self.lost.store(true, Relaxed);
    }

    /// The device tells that it is gone. Returns whether it is lost: a window that is closed drops its device, too.
    pub(super) fn is_gone(&self, reason: wgpu::DeviceLostReason) -> bool {
        if reason == wgpu::DeviceLostReason::Destroyed && self.closed.load(Relaxed) {
            return false;
        }
        self.lose();
        true
    }

    /// Whether it is lost: nothing more can be drawn.
    pub fn is_lost(&self) -> bool {
        self.lost.load(Relaxed)
    }

    /// The window is being closed by its user.
    pub(super) fn close(&self) {
        self.closed.store(true, Relaxed);
    }
}

/// How many graphics devices were lost one after the other before this program started.
pub(super) fn lost_before() -> u32 {
    std::env::var(LOST).ok().and_then(|count| count.parse().ok()).unwrap_or(0)
}

/// Starts the program anew with a project in place of this one, whose window can draw no more and whose graphics library does
/// not survive being closed. Everything must be on the disk.
pub(super) fn start_anew(project: Option<&Path>) -> ! {
    let count = lost_before() + 1;
    let why = match std::env::current_exe() {
        _ if count > MOST => "again and again".to_owned(),
        Ok(program) => in_place(Command::new(program).args(project).env(LOST, count.to_string())).to_string(),
        Err(error) => error.to_string(),
    };
    tracing::error!("not started anew: {why}");
    eprintln!(
        "lightloom: the graphics device was lost ({why}); what was not saved is offered at the next start"
    );
    exit(TRY_AGAIN.into())
}

/// Runs a command in place of this program; returns only where that is refused.
#[cfg(unix)]
fn in_place(command: &mut Command) -> std::io::Error {
    std::os::unix::process::CommandExt::exec(command)
}

/// Runs a command after this program; returns only where that is refused.
#[cfg(not(unix))]
fn in_place(command: &mut Command) -> std::io::Error {
    match command.spawn() {
        Ok(_) => exit(0),
        Err(error) => error,
    }
}
