//! Modal questions and messages, drawn by egui: a system without dialogs would answer for the user.

use super::modal::modal;
use egui::{Button, Context, Key, RichText};

/// A question, or a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Question {
    /// The document has unsaved changes and is about to be left.
    Unsaved {
        /// Title of the document.
        title: String,
    },
    /// Unsaved work of an earlier run was found.
    Recover {
        /// Title of the document.
        title: String,
        /// Age of the last change, in words.
        when: String,
        /// Whether the file has changed since.
        file_changed: bool,
    },
    /// Another program changed the file since it was read.
    Changed {
        /// The file.
        title: String,
        /// Whether the document has unsaved changes too.
        unsaved: bool,
    },
    /// An export of an earlier run was cut off.
    Export {
        /// Name of the project.
        title: String,
        /// Folder of the frames.
        folder: String,
    },
    /// Files lie outside of the project's folder: picked ones, or those that an opened project names.
    Outside {
        /// What lies outside.
        title: String,
        /// The files, a line each; empty where the title names the only one.
        files: String,
        /// Label of the answer that leaves them out.
        no: &'static str,
    },
    /// A message.
    Message {
        /// Title.
        title: String,
        /// Reason and remedy.
        text: String,
    },
}

/// The answer to a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Save the changes; recover the work; reload the file; copy the files; go on with the export.
    Yes,
    /// Discard the changes; delete the recovered work; keep the document; trust the files; forget the export.
    No,
    /// Change nothing; close a message; offer the recovered work or the export again at the next start.
    Cancel,
}

struct Words {
    title: String,
    text: String,
    /// Labels of yes, no and cancel; empty ones are not shown.
    labels: [&'static str; 3],
}

impl Question {
    fn words(&self) -> Words {
        match self {
            Self::Unsaved { title } => Words {
                title: format!("Save the changes in '{title}'?"),
                text: "Otherwise they are lost.".into(),
                labels: ["Save", "Discard", "Cancel"],
            },
            Self::Recover { title, when, file_changed } => Words {
                title: format!("Recover '{title}'?"),
                text: format!(
                    "The program ended before the changes of {when} were saved. They can be recovered; {}",
                    if *file_changed {
                        "but another program has changed the file since, and saving would overwrite it."
                    } else {
                        "the file itself is as it was last saved."
                    }
                ),
                labels: ["Recover", "Delete", "Ask again later"],
            },
            Self::Changed { title, unsaved } => Words {
                title: format!("'{title}' was changed by another program"),
                text: if *unsaved {
                    "Reloading discards your changes.".into()
                } else {
                    "Reload it, or keep the open version.".into()
                },
                labels: ["Reload", "Keep open version", ""],
            },
            Self::Export { title, folder } => Words {
                title: format!("Go on with the export of '{title}'?"),
                text: format!(
                    "The program ended before all frames in '{folder}' were finished. What is there is kept; the project is rendered as it was when the export began."
                ),
                labels: ["Go on", "Forget it", "Ask again later"],
            },
            Self::Outside { title, files, no } => Words {
                title: title.clone(),
                text: format!(
                    "{files}A copy beside the project is made when it is saved: then it opens on every machine. Or trust the \
                     file for good: it stays where it is, and projects on this machine may read it, in the window and \
                     from the command line."
                ),
                labels: ["Copy beside the project", "Trust for good", no],
            },
            Self::Message { title, text } => {
                Words { title: title.clone(), text: text.clone(), labels: ["", "", "Close"] }
            }
        }
    }

    /// Shows the question and returns the answer once given. Enter is yes, Escape is cancel.
    pub fn show(&self, ctx: &Context) -> Option<Answer> {
        let Words { title, text, labels } = self.words();
        let mut answer = None;
        let shown = modal(ctx, "question").show(ctx, |ui| {
            ui.set_width(400.0);
            ui.label(RichText::new(title).heading());
            ui.add_space(4.0);
            ui.label(text);
            ui.add_space(10.0);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                for (label, meant) in labels.into_iter().zip([Answer::Yes, Answer::No, Answer::Cancel]) {
                    if label.is_empty() {
                        continue;
                    }
                    let main = meant == Answer::Yes || labels[0].is_empty();
                    let fill = if main {
                        ui.visuals().selection.bg_fill
                    } else {
                        ui.visuals().widgets.inactive.weak_bg_fill
                    };
                    if ui.add(Button::new(label).fill(fill)).clicked() {
                        answer = Some(meant);
                    }
                }
            });
        });
        if ctx.input(|i| i.key_pressed(Key::Enter)) {
            let main = if labels[0].is_empty() { Answer::Cancel } else { Answer::Yes };
            return answer.or(Some(main));
        }
        // Beside a question without cancel a click does nothing.
        answer.or((shown.should_close() && !labels[2].is_empty()).then_some(Answer::Cancel))
    }
}
