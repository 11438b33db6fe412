//! Exports beside editing: each renders a frozen project on threads of its own, one after the other.

mod convergence;
mod form;
mod job;
mod job_list;
mod options;
mod path_field;
mod queue;
mod record;
mod status_line;
mod window;

pub use convergence::Point;
pub use job::{Cost, ExportJob, ExportSettings, Growing, Outcome, Status};
pub use options::ExportOptions;
pub use queue::Exports;
pub use record::{ExportRecord, InterruptedExport, interrupted};
pub use status_line::status_line;
pub use window::ExportWindow;
