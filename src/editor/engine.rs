//! The engine of the open document, shared by all workers and exports.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::Result;
use lightloom_core::engine::Engine;
use lightloom_core::project::AssetFolder;

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
    external: bool,
    engine: Engine,
}

impl SharedEngine {
    /// The engine that finds files beside the project file `file`; anywhere if `external`.
    ///
    /// # Errors
    /// The folder of the project cannot be found.
    pub fn of(&self, file: &Path, external: bool) -> Result<Engine> {
        let mut engines = self.engines.lock().unwrap_or_else(PoisonError::into_inner);
        let known = engines.iter().position(|known| known.file == file && known.external == external);
        let known = match known {
            Some(known) => engines.remove(known),
            None => {
                let engine = Engine::new(AssetFolder::new(file, external)?);
                OfDocument { file: file.to_owned(), external, engine }
            }
        };
        let engine = known.engine.clone();
        engines.push(known);
        let surplus = engines.len().saturating_sub(KEPT);
        engines.drain(..surplus);
        Ok(engine)
    }
}
