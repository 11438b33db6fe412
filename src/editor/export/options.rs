//! Options of an export, and the equivalent command line.

use std::path::{Path, PathBuf};

use lightloom_core::Error;
use lightloom_core::Result;
use lightloom_core::export::{FilmFormat, FrameFormat, FrameLayer};
use lightloom_core::project::{Project, frames};

/// The options that a user can set for an export; all else is taken from the project.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportOptions {
    /// Frames, such as 1-100, 1-100x5 or 1,5-10.
    pub frames: String,
    /// Picture size in pixels.
    pub size: [u32; 2],
    /// Progressive passes.
    pub passes: u32,
    /// Photons per pass.
    pub photons: u64,
    /// Picture formats.
    pub formats: Vec<FrameFormat>,
    /// Layers of EXR files.
    pub layers: Vec<FrameLayer>,
    /// The kind of film of all frames, where one is wanted.
    pub film: Option<FilmFormat>,
    /// The folder for the frames.
    pub folder: PathBuf,
}

/// Numbers for a purpose, made from the project's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Purpose {
    /// To see the movement: half the size, one pass of few photons.
    Draft,
    /// To show it around: the whole size, two passes.
    Review,
    /// As the project says.
    Final,
}

impl Purpose {
    /// All of them, with their names and what they are for.
    pub(super) const ALL: [(Self, &str, &str); 3] = [
        (Self::Draft, "Draft", "To see the movement: half the size, one pass of at most 200 000 photons."),
        (
            Self::Review,
            "Review",
            "To show it around within minutes: the whole size, two passes of at most 500 000 photons.",
        ),
        (Self::Final, "Final", "Size, passes and photons of the project."),
    ];

    /// The options for it, where `own` are those of the project.
    pub(super) fn apply(self, options: &ExportOptions, own: &ExportOptions) -> ExportOptions {
        // Films want even sides.
        let half = |pixels: u32| if pixels < 64 { pixels } else { (pixels / 2).next_multiple_of(2) };
        let (size, passes, photons) = match self {
            Self::Draft => (own.size.map(half), 1, own.photons.min(200_000)),
            Self::Review => (own.size, own.passes.min(2), own.photons.min(500_000)),
            Self::Final => (own.size, own.passes, own.photons),
        };
        ExportOptions { size, passes, photons, ..options.clone() }
    }
}

impl ExportOptions {
    /// The options of the project, with a folder beside its file.
    pub fn of(project: &Project, file: Option<&Path>) -> Self {
        let first = project.keys.first().map_or(1, |key| key.frame);
        let last = project.keys.last().map_or(first, |key| key.frame);
        let render = &project.render;
        Self {
            frames: project.output.frames.clone().unwrap_or_else(|| format!("{first}-{last}")),
            size: [render.width, render.height],
            passes: render.passes,
            photons: render.photons,
            formats: project.output.formats.clone(),
            layers: project.output.layers.clone(),
            film: None,
            folder: folder(project, file),
        }
    }

    /// Takes fields from `now` that still equal `before`: what the user did not set follows the project.
    pub fn follow(&mut self, before: &Self, now: &Self) {
        fn take<T: Clone + PartialEq>(own: &mut T, before: &T, now: &T) {
            if own == before {
                own.clone_from(now);
            }
        }
        take(&mut self.frames, &before.frames, &now.frames);
        take(&mut self.size, &before.size, &now.size);
        take(&mut self.passes, &before.passes, &now.passes);
        take(&mut self.photons, &before.photons, &now.photons);
        take(&mut self.formats, &before.formats, &now.formats);
        take(&mut self.layers, &before.layers, &now.layers);
        take(&mut self.film, &before.film, &now.film);
        take(&mut self.folder, &before.folder, &now.folder);
    }

    /// The project with these options.
    ///
    /// # Errors
    /// An invalid value, by its place.
    pub fn apply(&self, project: &Project) -> Result<Project> {
        frames::parse(&self.frames, "frames")?;
        if self.folder.as_os_str().is_empty() {
            return Err(Error::value("folder", "none is named; choose one for the frames"));
        }
        let mut project = project.clone();
        project.output.frames = Some(self.frames.clone());
        project.output.formats.clone_from(&self.formats);
        project.output.layers.clone_from(&self.layers);
        [project.render.width, project.render.height] = self.size;
        project.render.passes = self.passes;
        project.render.photons = self.photons;
        project.check()?;
        Ok(project)
    }

    /// The file of the film, in the folder of the frames.
    pub fn film_file(&self) -> Option<PathBuf> {
        self.film.map(|format| self.folder.join(format!("film.{}", format.extension())))
    }

    /// The command line that renders the same frames of the project file `file`, without the project's own values.
    pub fn command_line(&self, project: &Project, file: &Path) -> String {
        let own = Self::of(project, Some(file));
        let path = |path: &Path| quoted(&path.to_string_lossy());
        let mut line = format!("lightloom render {} --out {}", path(file), path(&self.folder));
        if self.frames != own.frames || project.output.frames.is_some() {
            // With an equals sign also where the list begins with a minus.
            line += &format!(" --frames={}", quoted(&self.frames));
        }
        if self.size != own.size {
            line += &format!(" --size {}x{}", self.size[0], self.size[1]);
        }
        if self.passes != own.passes {
            line += &format!(" --passes {}", self.passes);
        }
        if self.photons != own.photons {
            line += &format!(" --photons {}", self.photons);
        }
        if self.formats != own.formats {
            let names: Vec<_> = self.formats.iter().map(|format| format.extension()).collect();
            line += &format!(" --format {}", names.join(","));
        }
        if let Some(film) = self.film_file() {
            line += &format!(" --film {}", path(&film));
        }
        if self.layers != own.layers {
            let names: Vec<_> = self.layers.iter().map(|layer| layer.name()).collect();
            line += &format!(" --layers {}", names.join(","));
        }
        line
    }
}

/// A folder beside the project file, or in the user's home folder.
fn folder(project: &Project, file: Option<&Path>) -> PathBuf {
    let home =
        || directories::UserDirs::new().map_or_else(|| PathBuf::from("."), |dirs| dirs.home_dir().to_owned());
    let name = match file.and_then(Path::file_stem) {
        Some(stem) => stem.to_string_lossy().into_owned(),
        None if project.name.is_empty() => "untitled".into(),
        None => project.name.replace(['/', '\\', ':', ' ', ','], "_").to_lowercase(),
    };
    let beside = file.and_then(Path::parent).map_or_else(home, Path::to_owned);
    beside.join(format!("{name}_frames"))
}

/// Quoted for a POSIX shell where it needs to be.
fn quoted(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "/._-+=:,@%".contains(c);
    if !text.is_empty() && text.chars().all(plain) {
        return text.to_owned();
    }
    format!("'{}'", text.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use clap::Parser as _;

    use super::*;
    use crate::cli::args::{Cli, Command};

    /// The words of a line as a POSIX shell parts them: plain words and single quotes.
    fn words(line: &str) -> Vec<String> {
        let (mut words, mut word, mut quote, mut escaped) = (vec![], None::<String>, false, false);
        for c in line.chars() {
            match c {
                _ if escaped => {
                    word.get_or_insert_default().push(c);
                    escaped = false;
                }
                '\'' => {
                    quote = !quote;
                    word.get_or_insert_default();
                }
                '\\' if !quote => escaped = true,
                ' ' if !quote => words.extend(word.take()),
                c => word.get_or_insert_default().push(c),
            }
        }
        words.extend(word);
        words
    }

    #[test]
    fn the_command_line_gives_the_same_project_and_folder() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("it's a project, saved.json");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json");
        let project = Project::load(&source).unwrap();
        project.save(&file).unwrap();
        let own = ExportOptions::of(&project, Some(&file));
        let other = ExportOptions {
            frames: "-3-9x4,60".into(),
            size: [320, 200],
            passes: 3,
            photons: 1234,
            formats: vec![FrameFormat::Png],
            layers: vec![FrameLayer::Caustic, FrameLayer::Depth],
            film: Some(FilmFormat::Gif),
            folder: folder.path().join("two words $HOME \"and\" quotes'"),
        };
        for options in [own, other] {
            let line = options.command_line(&project, &file);
            let Some(Command::Render(args)) = Cli::try_parse_from(words(&line)).unwrap().command else {
                panic!("{line}")
            };
            let mut run = args.project.load().unwrap();
            let mut wanted = options.apply(&project).unwrap();
            // All frames by default are those that the window lists.
            assert_eq!(run.frames().unwrap(), wanted.frames().unwrap(), "{line}");
            (run.output.frames, wanted.output.frames) = (None, None);
            assert_eq!(args.film, options.film_file(), "{line}");
            assert_eq!((run, args.out), (wanted, options.folder), "{line}");
        }
    }

    #[test]
    fn a_purpose_costs_no_more_than_the_project_and_leaves_the_rest() {
        let project =
            Project::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json")).unwrap();
        let own = ExportOptions::of(&project, None);
        let mine = ExportOptions { frames: "3-5".into(), size: [99, 31], passes: 70, ..own.clone() };
        for (purpose, ..) in Purpose::ALL {
            let options = purpose.apply(&mine, &own);
            assert_eq!(options.frames, "3-5");
            assert!(options.photons <= own.photons && options.passes <= own.passes);
            assert!(options.size[0] <= own.size[0] && options.apply(&project).is_ok());
        }
        assert_eq!(Purpose::Final.apply(&mine, &own), ExportOptions { frames: "3-5".into(), ..own });
    }

    #[test]
    fn a_wish_that_cannot_be_is_refused_by_its_place() {
        let project =
            Project::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("projects/letters_free.json")).unwrap();
        let options = ExportOptions::of(&project, None);
        let refused = |options: ExportOptions| options.apply(&project).unwrap_err().to_string();
        assert!(refused(ExportOptions { frames: "9-1".into(), ..options.clone() }).starts_with("frames: "));
        assert!(refused(ExportOptions { size: [0, 10], ..options.clone() }).contains("render.width"));
        assert!(refused(ExportOptions { formats: vec![], ..options.clone() }).contains("output.formats"));
        assert!(refused(ExportOptions { folder: PathBuf::new(), ..options }).starts_with("folder: "));
    }
}
