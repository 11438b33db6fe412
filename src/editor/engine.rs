//! The engine of the open document, shared by all workers and exports.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::sync::{Arc, Mutex, PoisonError};

use lightloom_core::Result;
use lightloom_core::engine::Engine;
use lightloom_core::project::Admitted;

use super::access::Access;
use super::store::preferences::Preferences;

/// Documents whose engines are kept: the open one, and one that an export may still render.
const KEPT: usize = 2;

/// The engines of the documents that are worked on. Clones share them.
#[derive(Clone)]
pub struct SharedEngine {
    /// The most recently used last.
    engines: Arc<Mutex<Vec<OfDocument>>>,
    /// What the positions of a preview may take, MB.
    preview_megabytes: Arc<AtomicU32>,
}

impl Default for SharedEngine {
    fn default() -> Self {
        let megabytes = Preferences::default().preview_megabytes;
        Self { engines: Arc::default(), preview_megabytes: Arc::new(megabytes.into()) }
    }
}

struct OfDocument {
    file: PathBuf,
    admitted: Admitted,
    engine: Engine,
}

impl SharedEngine {
    /// Forgets all that was made from files: it is read again. Exports go on with what they have.
    pub fn forget(&self) {
        self.engines.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// Limits the memory of previews to so many MB. Whether that changed.
    pub fn limit_previews(&self, megabytes: u32) -> bool {
        self.preview_megabytes.swap(megabytes, Relaxed) != megabytes
    }

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
        let bytes = self.preview_megabytes.load(Relaxed) as usize * 1_000_000;
        let engine = known.engine.clone().with_preview_memory(bytes);
        engines.push(known);
        let surplus = engines.len().saturating_sub(KEPT);
        engines.drain(..surplus);
        Ok(engine)
    }
}
