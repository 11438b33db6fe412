//! Which files outside of its folder the open project may read.

use std::path::Path;

use lightloom_core::Result;
use lightloom_core::project::{Admitted, AssetFolder};

/// The admitted files at one moment: equal as long as nothing was added to the list, or where none is admitted, and no file that
/// the project reads has changed.
#[derive(Clone, Debug, Default)]
pub struct Access {
    admitted: Admitted,
    count: usize,
    edition: u64,
}

impl Access {
    /// The files that are admitted now.
    pub fn of(admitted: &Admitted) -> Self {
        Self { admitted: admitted.clone(), count: admitted.count(), edition: 0 }
    }

    /// The same for another edition of the files: what was read of an earlier one is read again.
    pub fn at(self, edition: u64) -> Self {
        Self { edition, ..self }
    }

    /// The list.
    pub fn admitted(&self) -> &Admitted {
        &self.admitted
    }

    /// Finds the files of the project file `file`.
    ///
    /// # Errors
    /// The folder of the project cannot be found.
    pub fn assets(&self, file: &Path) -> Result<AssetFolder> {
        Ok(AssetFolder::new(file, false)?.admitting(self.admitted.clone()))
    }
}

impl PartialEq for Access {
    fn eq(&self, other: &Self) -> bool {
        self.edition == other.edition
            && self.count == other.count
            && (self.count == 0 || self.admitted.is(&other.admitted))
    }
}
