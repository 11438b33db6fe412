//! The export window: settings of a new export, and the status of all exports.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use egui::{
    Button, Color32, ColorImage, Context, DragValue, Grid, Response, RichText, ScrollArea, TextEdit,
    TextureHandle, TextureOptions, Ui, vec2,
};
use lightloom_core::export::FrameFormat;
use lightloom_core::project::Project;
use lightloom_core::render::Image;

use super::status_line::{colour, controls, words};
use super::{ExportJob, ExportOptions, ExportSettings, Exports, Growing};
use crate::editor::context::EditorContext;
use crate::editor::dialogs::{PickRequest, Picker, Purpose};
use crate::editor::{playback, templates, theme};

/// Width of the settings, points.
const LEFT: f32 = 350.0;

/// The export window.
pub struct ExportWindow {
    /// Whether it is open.
    pub open: bool,
    /// Whether the project may read files outside its folder.
    pub external: bool,
    /// The options as set by the user.
    options: Option<ExportOptions>,
    /// The project's own options and file when last shown.
    own: Option<(ExportOptions, Option<PathBuf>)>,
    /// Time limit in minutes, and whether it is used.
    limit: (f64, bool),
    /// The preview texture, with its job and passes, and its frame.
    picture: Option<([usize; 2], i32, TextureHandle)>,
}

impl Default for ExportWindow {
    fn default() -> Self {
        Self { open: false, external: false, options: None, own: None, limit: (10.0, false), picture: None }
    }
}

impl ExportWindow {
    /// Sets the output folder.
    pub fn set_folder(&mut self, folder: PathBuf) {
        if let Some(options) = &mut self.options {
            options.folder = folder;
        }
    }

    /// Shows the window if it is open.
    pub fn show(
        &mut self,
        ctx: &Context,
        editor: &mut EditorContext,
        exports: &mut Exports,
        picker: &mut Picker,
    ) {
        if !self.open {
            return;
        }
        let project = editor.document.project().clone();
        let file = editor.document.path().map(ToOwned::to_owned);
        self.follow(ExportOptions::of(&project, file.as_deref()), file);
        let mut open = true;
        let middle = ctx.content_rect().center() - vec2(390.0, 260.0);
        let window = egui::Window::new("Export").open(&mut open).collapsible(false).resizable(false);
        window.default_pos(middle).fixed_size([780.0, 470.0]).show(ctx, |ui| {
            ui.horizontal_top(|ui| {
                ui.vertical(|ui| {
                    ui.set_width(LEFT);
                    ui.set_min_height(450.0);
                    self.settings(ui, editor, &project, picker);
                    self.begin(ui, editor, &project, exports);
                });
                ui.separator();
                ui.vertical(|ui| {
                    ui.set_min_width(380.0);
                    self.jobs(ui, editor, exports);
                });
            });
        });
        self.open = open;
    }

    /// Options not set by the user follow the project; another file resets all.
    fn follow(&mut self, own: ExportOptions, file: Option<PathBuf>) {
        match (&mut self.options, &self.own) {
            (Some(options), Some((before, of))) if *of == file => options.follow(before, &own),
            (options, _) => *options = Some(own.clone()),
        }
        self.own = Some((own, file));
    }

    fn settings(&mut self, ui: &mut Ui, editor: &EditorContext, project: &Project, picker: &mut Picker) {
        let (Some(options), Some((own, _))) = (&mut self.options, &self.own) else { return };
        Grid::new("export settings").num_columns(2).spacing([12.0, 8.0]).show(ui, |ui| {
            name(
                ui,
                "Frames",
                "Which frames are rendered, such as 1-100, 1-100x5 or 1,5-10.",
                &mut options.frames,
                &own.frames,
            );
            ui.horizontal(|ui| {
                let field = TextEdit::singleline(&mut options.frames).desired_width(120.0);
                ui.add(field).accessible_name("Frames");
                let played = playback::played(project, editor.session);
                let marked = editor.session.marks != [None; 2];
                let button = ui.add_enabled(marked, Button::new("Marked range"));
                if button.on_hover_text("From the in point to the out point of the timeline.").clicked() {
                    options.frames = format!("{}-{}", played.start(), played.end());
                }
            });
            ui.end_row();
            name(
                ui,
                "Size",
                "Width and height of the pictures in pixels, 16 to 16384.",
                &mut options.size,
                &own.size,
            );
            ui.horizontal(|ui| {
                for (side, label) in options.size.iter_mut().zip(["Width in pixels", "Height in pixels"]) {
                    ui.add(DragValue::new(side).range(16..=16_384).suffix(" px")).accessible_name(label);
                }
            });
            ui.end_row();
            name(
                ui,
                "Passes",
                "Each pass has its own photons: more passes, less noise, sharper edges.",
                &mut options.passes,
                &own.passes,
            );
            ui.add(DragValue::new(&mut options.passes).range(1..=100_000).speed(0.2))
                .accessible_name("Passes");
            ui.end_row();
            name(
                ui,
                "Photons",
                "Photons of one pass. More photons make a finer picture and need more memory.",
                &mut options.photons,
                &own.photons,
            );
            let photons = DragValue::new(&mut options.photons)
                .range(1..=100_000_000)
                .speed(2_000.0)
                .custom_formatter(|n, _| grouped(n));
            ui.add(photons).accessible_name("Photons per pass");
            ui.end_row();
            name(
                ui,
                "Formats",
                "EXR: linear half floats in layers, for compositing. PNG: display values.",
                &mut options.formats,
                &own.formats,
            );
            ui.horizontal(|ui| formats(ui, &mut options.formats));
            ui.end_row();
            ui.label("Time").on_hover_text(
                "Without a limit all passes are rendered. The first pass is always completed.",
            );
            ui.horizontal(|ui| {
                ui.checkbox(&mut self.limit.1, "Stop after");
                let minutes =
                    DragValue::new(&mut self.limit.0).range(0.1..=10_000.0).speed(0.1).suffix(" min");
                ui.add_enabled(self.limit.1, minutes).accessible_name("Minutes");
            });
            ui.end_row();
            name(
                ui,
                "Folder",
                "The output folder; created if it does not exist.",
                &mut options.folder,
                &own.folder,
            );
            ui.horizontal(|ui| {
                let mut text = options.folder.to_string_lossy().into_owned();
                let text_before = text.clone();
                let field = TextEdit::singleline(&mut text).desired_width(170.0);
                let shown = ui.add(field).accessible_name("Folder").on_hover_text(&text_before);
                if shown.changed() {
                    options.folder = text.into();
                }
                if ui.button("Browse…").clicked() {
                    let start = options.folder.parent().map(ToOwned::to_owned);
                    picker.ask(PickRequest::new(Purpose::ExportFolder).in_folder(start), ui.ctx());
                }
            });
            ui.end_row();
        });
    }

    /// The export button, and the equivalent command line.
    fn begin(&mut self, ui: &mut Ui, editor: &EditorContext, project: &Project, exports: &mut Exports) {
        let Some(options) = &self.options else { return };
        let applied = options.apply(project);
        let frames = applied.as_ref().ok().and_then(|project| project.frames().ok()).unwrap_or_default();
        ui.add_space(10.0);
        let text = match frames.len() {
            1 => "Export 1 frame".to_owned(),
            count => format!("Export {count} frames"),
        };
        let button = Button::new(RichText::new(text).strong()).fill(ui.visuals().selection.bg_fill);
        let begin = ui.add_enabled_ui(applied.is_ok(), |ui| ui.add_sized([LEFT - 8.0, 30.0], button)).inner;
        if let Err(error) = &applied {
            ui.colored_label(theme::BAD, error.to_string());
        }
        if let Ok(project) = applied.as_ref()
            && begin.clicked()
        {
            let shown =
                if frames.contains(&editor.session.playhead) { Some(editor.session.playhead) } else { None };
            exports.add(ExportSettings {
                project: Arc::new(project.clone()),
                file: templates::file_of(editor.document),
                external: self.external,
                folder: options.folder.clone(),
                limit: self.limit.1.then(|| Duration::from_secs_f64(60.0 * self.limit.0.clamp(0.1, 1e6))),
                shown: shown.or(frames.get(frames.len() / 2).copied()).unwrap_or_default(),
            });
        }
        ui.add_space(10.0);
        command_line(ui, editor, project, options, self.external);
    }

    fn jobs(&mut self, ui: &mut Ui, editor: &EditorContext, exports: &mut Exports) {
        let jobs = exports.jobs().to_vec();
        if jobs.is_empty() {
            ui.weak("Exports run in the background, from the project as it is when they start. Each pass refines all frames, so that you can stop at any time.");
            return;
        }
        ui.horizontal(|ui| {
            ui.strong("Exports");
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if jobs.iter().any(|job| !job.is_open()) && ui.small_button("Clear finished").clicked() {
                    exports.clear();
                    self.picture = None;
                }
            });
        });
        let active = jobs.iter().position(|job| job.is_open()).unwrap_or(jobs.len() - 1);
        jobs[active].show(editor.session.playhead);
        ScrollArea::vertical().max_height(430.0).auto_shrink([false, true]).show(ui, |ui| {
            // The one at work first, then the newest.
            let others = (0..jobs.len()).rev().filter(|index| *index != active);
            for index in std::iter::once(active).chain(others) {
                let job = &jobs[index];
                ui.push_id(index, |ui| {
                    if index == active {
                        self.picture(ui, index, job);
                    }
                    card(ui, job);
                });
                ui.add_space(6.0);
            }
        });
    }

    /// The preview picture of a running job.
    fn picture(&mut self, ui: &mut Ui, index: usize, job: &ExportJob) {
        let Some(Growing { frame, passes, image }) = job.picture() else { return };
        let now = [index, passes];
        if !matches!(&self.picture, Some((of, shown, _)) if *of == now && *shown == frame) {
            let texture = ui.ctx().load_texture("export", on_screen(&image), TextureOptions::LINEAR);
            self.picture = Some((now, frame, texture));
        }
        if let Some((.., texture)) = &self.picture {
            let passes = if passes == 1 { "1 pass".into() } else { format!("{passes} passes") };
            let label = format!("Frame {frame} after {passes}");
            let shown = egui::Image::new(texture).max_size(vec2(376.0, 230.0)).corner_radius(3.0);
            let tip = format!("{label}. The frame under the playhead is shown after the next pass.");
            ui.add(shown.alt_text(&label)).on_hover_text(tip);
            ui.label(RichText::new(label).small().weak());
        }
    }
}

/// The label of a setting: double click resets it.
fn name<T: Clone + PartialEq>(ui: &mut Ui, label: &str, tip: &str, value: &mut T, own: &T) {
    let text = if value == own { RichText::new(label) } else { RichText::new(label).strong() };
    let response: Response = ui.add(egui::Label::new(text).sense(egui::Sense::click()));
    if response
        .on_hover_text(format!("{tip} Double click resets it to the project's value."))
        .double_clicked()
    {
        value.clone_from(own);
    }
}

/// A count in groups of three digits.
fn grouped(count: f64) -> String {
    let digits = format!("{count:.0}");
    let group = |(i, digit): (usize, char)| {
        let parted = i > 0 && (digits.len() - i) % 3 == 0;
        [parted.then_some('\u{2009}'), Some(digit)].into_iter().flatten().collect::<Vec<_>>()
    };
    digits.chars().enumerate().flat_map(group).collect()
}

fn formats(ui: &mut Ui, chosen: &mut Vec<FrameFormat>) {
    for format in FrameFormat::ALL {
        let mut on = chosen.contains(&format);
        if ui.checkbox(&mut on, format.extension().to_uppercase()).changed() {
            // In the order of the list, whatever was clicked first.
            *chosen = FrameFormat::ALL
                .into_iter()
                .filter(|f| if *f == format { on } else { chosen.contains(f) })
                .collect();
        }
    }
}

fn command_line(
    ui: &mut Ui,
    editor: &EditorContext,
    project: &Project,
    options: &ExportOptions,
    external: bool,
) {
    ui.label("Equivalent command line");
    let Some(file) = editor.document.path() else {
        ui.weak("Save the project to see its command line.");
        return;
    };
    let mut line = options.command_line(project, file);
    if external {
        line += " --allow-external";
    }
    let mut text = line.as_str();
    let field = TextEdit::multiline(&mut text).font(egui::TextStyle::Monospace).desired_rows(3);
    ui.add(field.desired_width(LEFT - 8.0)).accessible_name("Command line");
    ui.horizontal(|ui| {
        if ui.small_button("Copy").clicked() {
            ui.ctx().copy_text(line.clone());
        }
        if editor.document.is_unsaved() {
            ui.weak("It renders the file as last saved.");
        }
    });
}

fn card(ui: &mut Ui, job: &ExportJob) {
    let fill = ui.visuals().faint_bg_color;
    egui::Frame::new().fill(fill).corner_radius(4.0).inner_margin(8.0).show(ui, |ui| {
        ui.set_width(ui.available_width());
        let status = job.status();
        ui.label(RichText::new(job.settings().folder.to_string_lossy()).small().weak());
        ui.colored_label(colour(&status, ui), words(job));
        if !job.is_open() {
            return;
        }
        let bar = egui::ProgressBar::new(job.progress().overall as f32).show_percentage().corner_radius(4);
        ui.add(bar).accessible_name("Progress");
        if let Some(cost) = job.cost() {
            let (memory, scratch) = (size(cost.memory_mib), size(cost.scratch_mib));
            let text = format!(
                "Up to {memory} of memory for any number of frames; {scratch} of scratch space in the folder."
            );
            ui.label(RichText::new(text).small().weak());
        }
        ui.horizontal(|ui| controls(ui, job));
    });
}

fn size(mib: f64) -> String {
    if mib < 1000.0 { format!("{mib:.0} MiB") } else { format!("{:.1} GiB", mib / 1024.0) }
}

/// Screen values in 0..=1 as bytes.
fn on_screen(image: &Image) -> ColorImage {
    let byte = |value: f32| (255.0 * value.clamp(0.0, 1.0)).round() as u8;
    let pixels = image.pixels.iter().map(|c| Color32::from_rgb(byte(c.x), byte(c.y), byte(c.z))).collect();
    ColorImage::new([image.width, image.height], pixels)
}
