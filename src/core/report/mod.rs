//! What the settings do to a project, measured: tables and plots for those who choose them.

mod gamma_response;
mod plot;

pub use gamma_response::{GammaResponse, Response, gamma_response};
