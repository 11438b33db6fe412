//! The engine of the open document, shared by all workers and exports.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::Result;
use lightloom_core::engine::Engine;
use lightloom_core::project::Admitted;

use super::access::Access;

/// Documents whose engines are kept: the open one, and one that an export may still render.
const KEPT: usize = 2;

/// The engines of the documents that are worked on. Clones share them.
#[derive(Clone, Default)]
pub struct SharedEngine {
    /// The most recently used last.
    engines: Arc<Mutex<Vec<OfDocument>>>,
}

struct OfDocument {
    file: PathBuf,
    admitted: Admitted,
    engine: Engine,
}

impl SharedEngine {
    /// The engine that finds files beside the project file `file`; others where admitted.
    ///
    /// # Errors
    /// The folder of the project cannot be found.
    pub fn of(&self, file: &Path, access: &Access) -> Result<Engine> {
        let mut engines = self.engines.lock().unwrap_or_else(PoisonError::into_inner);
        let known =
            engines.iter().position(|known| known.file == file && known.admitted.is(access.admitted()));
        let known = match known {
            Some(known) => engines.remove(known),
            None => {
                let engine = Engine::new(access.assets(file)?);
                OfDocument { file: file.to_owned(), admitted: access.admitted().clone(), engine }
            }
        };
        let engine = known.engine.clone();
        engines.push(known);
        let surplus = engines.len().saturating_sub(KEPT);
        engines.drain(..surplus);
        Ok(engine)
    }
}
