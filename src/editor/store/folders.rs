//! The folders for recovery files, backups and preferences.

use std::ffi::OsString;
use std::path::PathBuf;

use directories::ProjectDirs;

/// Environment variable that overrides the folder of recovery files and backups.
pub const STATE_VARIABLE: &str = "LIGHTLOOM_STATE_DIR";
/// Environment variable that overrides the folder of the preferences.
pub const CONFIG_VARIABLE: &str = "LIGHTLOOM_CONFIG_DIR";

/// The editor's folders; they need not exist yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Folders {
    /// For recovery files and backups.
    pub state: PathBuf,
    /// For the preferences.
    pub config: PathBuf,
}

impl Folders {
    /// The user's folders: from the environment variables, or the system's defaults (on Linux
    /// `~/.local/state/lightloom` and `~/.config/lightloom`). None where the user has no home.
    pub fn of_user() -> Option<Self> {
        let own = ProjectDirs::from("", "", "lightloom");
        let own = own.as_ref();
        let state = || own.map(|dirs| dirs.state_dir().unwrap_or(dirs.data_local_dir()).to_owned());
        let config = || own.map(|dirs| dirs.config_dir().to_owned());
        Some(Self {
            state: named(std::env::var_os(STATE_VARIABLE)).or_else(state)?,
            config: named(std::env::var_os(CONFIG_VARIABLE)).or_else(config)?,
        })
    }

    /// Folder of the examples of this version, unpacked.
    pub fn examples(&self) -> PathBuf {
        self.state.join("examples").join(env!("CARGO_PKG_VERSION"))
    }

    /// Folder of the journals of open documents.
    pub fn recovery(&self) -> PathBuf {
        self.state.join("recovery")
    }

    /// Folder of the records of exports at work.
    pub fn exports(&self) -> PathBuf {
        self.state.join("exports")
    }

    /// Folder of the logs.
    pub fn logs(&self) -> PathBuf {
        self.state.join("logs")
    }

    /// Folder of backups: the previous version of each saved file.
    pub fn backups(&self) -> PathBuf {
        self.state.join("backups")
    }
}

/// The folder in a variable; none if it is empty.
fn named(variable: Option<OsString>) -> Option<PathBuf> {
    variable.filter(|name| !name.is_empty()).map(PathBuf::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_variable_names_no_folder() {
        assert_eq!(named(Some(OsString::new())), None);
        assert_eq!(named(Some("a".into())), Some(PathBuf::from("a")));
    }
}
