//! The commands: one list for menus, command palette and shortcuts.

use egui::{Key, KeyboardShortcut, Modifiers};

/// A command of the program.
#[expect(missing_docs, reason = "each is described where it is listed, in COMMANDS")]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Command {
    New,
    NewEmpty,
    Open,
    Import,
    Save,
    SaveAs,
    Collect,
    ReloadAssets,
    Quit,
    Undo,
    Redo,
    Copy,
    Cut,
    Paste,
    Duplicate,
    Delete,
    SelectAll,
    SelectNone,
    Reverse,
    Join,
    Split,
    Group,
    Ungroup,
    PlayPause,
    NextFrame,
    PreviousFrame,
    NextKey,
    PreviousKey,
    FirstFrame,
    LastFrame,
    MarkIn,
    MarkOut,
    ClearMarks,
    ToggleLoop,
    AddKey,
    FitView,
    ActualSize,
    ZoomIn,
    ZoomOut,
    BothViews,
    PlaneView,
    ShotView,
    OrbitView,
    ShowArrows,
    ShowStreamlines,
    ShowTrails,
    ShowGrid,
    ShowTarget,
    ShowDrawn,
    ShowDivergence,
    ShowCurl,
    ShowResidual,
    ShowTears,
    FalseColour,
    Compare,
    Snapping,
    Export,
    Player,
    Palette,
    Shortcuts,
    Preferences,
    Tour,
    SaveReport,
    Larger,
    Smaller,
    NormalSize,
    DarkTheme,
    LightTheme,
    SystemTheme,
    MoveObject,
    TurnObject,
    ScaleObject,
    SnapToTable,
    AimAtGlass,
    AimAtReceiver,
    FrameSelected,
    DuplicateObject,
    DeleteObject,
    SwitchObject,
    SoloObject,
    LookThroughCamera,
    AlignCamera,
}

/// A menu of the menu bar.
#[expect(missing_docs, reason = "each is what it is called")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    File,
    Edit,
    Scene,
    Play,
    View,
    Help,
}

/// Name, menu and shortcut of a command.
#[derive(Clone, Copy, Debug)]
pub struct CommandInfo {
    /// The command.
    pub command: Command,
    /// Its menu.
    pub menu: Menu,
    /// Its name.
    pub name: &'static str,
    /// Its shortcut.
    pub shortcut: Option<KeyboardShortcut>,
    /// Where the shortcut counts.
    pub keys: KeyPlace,
}

/// Where a shortcut counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyPlace {
    /// Everywhere, but for what the orbit view takes.
    Everywhere,
    /// Over the orbit view.
    OrbitView,
}

const NONE: Modifiers = Modifiers::NONE;
const CTRL: Modifiers = Modifiers::COMMAND;
const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);
const CTRL_ALT: Modifiers = Modifiers::COMMAND.plus(Modifiers::ALT);
const ALT: Modifiers = Modifiers::ALT;
const SHIFT: Modifiers = Modifiers::SHIFT;

const fn on(command: Command, menu: Menu, name: &'static str, modifiers: Modifiers, key: Key) -> CommandInfo {
    CommandInfo {
        command,
        menu,
        name,
        shortcut: Some(KeyboardShortcut::new(modifiers, key)),
        keys: KeyPlace::Everywhere,
    }
}

/// A command of the scene, with a key that counts over the orbit view.
const fn scene(command: Command, name: &'static str, modifiers: Modifiers, key: Key) -> CommandInfo {
    CommandInfo { keys: KeyPlace::OrbitView, ..on(command, Menu::Scene, name, modifiers, key) }
}

const fn off(command: Command, menu: Menu, name: &'static str) -> CommandInfo {
    CommandInfo { command, menu, name, shortcut: None, keys: KeyPlace::Everywhere }
}

/// All commands, in the order of the menus.
pub const COMMANDS: &[CommandInfo] = &[
    on(Command::New, Menu::File, "New", CTRL, Key::N),
    off(Command::NewEmpty, Menu::File, "New empty project"),
    on(Command::Open, Menu::File, "Open…", CTRL, Key::O),
    on(Command::Import, Menu::File, "Import…", CTRL, Key::I),
    on(Command::Save, Menu::File, "Save", CTRL, Key::S),
    on(Command::SaveAs, Menu::File, "Save as…", CTRL_SHIFT, Key::S),
    off(Command::Collect, Menu::File, "Collect…"),
    off(Command::ReloadAssets, Menu::File, "Reload assets"),
    on(Command::Export, Menu::File, "Export…", CTRL, Key::E),
    on(Command::Player, Menu::File, "Player", CTRL_SHIFT, Key::P),
    on(Command::Preferences, Menu::File, "Preferences", CTRL, Key::Comma),
    on(Command::Quit, Menu::File, "Quit", CTRL, Key::Q),
    on(Command::Undo, Menu::Edit, "Undo", CTRL, Key::Z),
    on(Command::Redo, Menu::Edit, "Redo", CTRL_SHIFT, Key::Z),
    on(Command::Cut, Menu::Edit, "Cut", CTRL, Key::X),
    on(Command::Copy, Menu::Edit, "Copy", CTRL, Key::C),
    on(Command::Paste, Menu::Edit, "Paste", CTRL, Key::V),
    on(Command::Duplicate, Menu::Edit, "Duplicate", CTRL, Key::D),
    on(Command::Delete, Menu::Edit, "Delete", NONE, Key::Delete),
    on(Command::SelectAll, Menu::Edit, "Select all", CTRL, Key::A),
    on(Command::SelectNone, Menu::Edit, "Select none", CTRL_SHIFT, Key::A),
    on(Command::Reverse, Menu::Edit, "Reverse direction", NONE, Key::R),
    on(Command::Join, Menu::Edit, "Join lines", CTRL, Key::J),
    on(Command::Split, Menu::Edit, "Split at points", CTRL_SHIFT, Key::J),
    on(Command::Group, Menu::Edit, "Group", CTRL, Key::G),
    on(Command::Ungroup, Menu::Edit, "Ungroup", CTRL_SHIFT, Key::G),
    on(Command::Snapping, Menu::Edit, "Snapping", ALT, Key::S),
    scene(Command::MoveObject, "Move object", NONE, Key::G),
    scene(Command::TurnObject, "Turn object", NONE, Key::R),
    scene(Command::ScaleObject, "Scale object", NONE, Key::S),
    scene(Command::SnapToTable, "Snap to table", NONE, Key::T),
    scene(Command::AimAtGlass, "Aim at the glass", NONE, Key::A),
    scene(Command::AimAtReceiver, "Aim at the receiver", SHIFT, Key::A),
    scene(Command::DuplicateObject, "Duplicate object", CTRL, Key::D),
    scene(Command::DeleteObject, "Delete object", NONE, Key::Delete),
    scene(Command::SwitchObject, "Switch object on or off", NONE, Key::H),
    scene(Command::SoloObject, "Solo object", SHIFT, Key::H),
    scene(Command::FrameSelected, "Frame selected", NONE, Key::F),
    scene(Command::LookThroughCamera, "Look through the camera", NONE, Key::Num0),
    scene(Command::AlignCamera, "Align camera to view", CTRL_ALT, Key::Num0),
    on(Command::PlayPause, Menu::Play, "Play or pause", NONE, Key::Space),
    on(Command::NextFrame, Menu::Play, "Next frame", NONE, Key::Period),
    on(Command::PreviousFrame, Menu::Play, "Previous frame", NONE, Key::Comma),
    on(Command::NextKey, Menu::Play, "Next key frame", SHIFT, Key::Period),
    on(Command::PreviousKey, Menu::Play, "Previous key frame", SHIFT, Key::Comma),
    on(Command::FirstFrame, Menu::Play, "First frame", NONE, Key::Home),
    on(Command::LastFrame, Menu::Play, "Last frame", NONE, Key::End),
    on(Command::MarkIn, Menu::Play, "Set in point", NONE, Key::I),
    on(Command::MarkOut, Menu::Play, "Set out point", NONE, Key::O),
    on(Command::ClearMarks, Menu::Play, "Clear in and out points", ALT, Key::I),
    on(Command::ToggleLoop, Menu::Play, "Loop", NONE, Key::L),
    on(Command::AddKey, Menu::Play, "Add key frame", NONE, Key::K),
    on(Command::FitView, Menu::View, "Fit", CTRL, Key::Num0),
    on(Command::ActualSize, Menu::View, "Actual size", CTRL, Key::Num1),
    on(Command::ZoomIn, Menu::View, "Zoom in", NONE, Key::Plus),
    on(Command::ZoomOut, Menu::View, "Zoom out", NONE, Key::Minus),
    on(Command::BothViews, Menu::View, "Plane and shot", NONE, Key::Num1),
    on(Command::PlaneView, Menu::View, "Plane only", NONE, Key::Num2),
    on(Command::ShotView, Menu::View, "Shot only", NONE, Key::Num3),
    on(Command::OrbitView, Menu::View, "Orbit view", NONE, Key::Num4),
    on(Command::ShowDrawn, Menu::View, "Lines and walls", CTRL, Key::H),
    on(Command::ShowTarget, Menu::View, "Target", NONE, Key::T),
    on(Command::ShowArrows, Menu::View, "Flow arrows", NONE, Key::F),
    on(Command::ShowStreamlines, Menu::View, "Streamlines", SHIFT, Key::F),
    on(Command::ShowTrails, Menu::View, "Photon trails", SHIFT, Key::T),
    on(Command::ShowGrid, Menu::View, "Flow grid", NONE, Key::G),
    off(Command::ShowDivergence, Menu::View, "Divergence"),
    off(Command::ShowCurl, Menu::View, "Curl"),
    off(Command::ShowResidual, Menu::View, "Residual of the fit"),
    off(Command::ShowTears, Menu::View, "Tears and cracks"),
    off(Command::FalseColour, Menu::View, "Light in false colours"),
    on(Command::Compare, Menu::View, "Compare", NONE, Key::C),
    on(Command::Larger, Menu::View, "Larger interface", CTRL, Key::Plus),
    on(Command::Smaller, Menu::View, "Smaller interface", CTRL, Key::Minus),
    off(Command::NormalSize, Menu::View, "Reset interface scale"),
    off(Command::DarkTheme, Menu::View, "Dark theme"),
    off(Command::LightTheme, Menu::View, "Light theme"),
    off(Command::SystemTheme, Menu::View, "Theme of the system"),
    on(Command::Palette, Menu::Help, "Find a command", CTRL, Key::P),
    on(Command::Shortcuts, Menu::Help, "Shortcuts", NONE, Key::F1),
    off(Command::Tour, Menu::Help, "Tour"),
    off(Command::SaveReport, Menu::Help, "Save report"),
];

impl Command {
    /// Name, menu and shortcut.
    pub fn info(self) -> Option<&'static CommandInfo> {
        COMMANDS.iter().find(|entry| entry.command == self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_share_a_key_or_a_name() {
        for (i, a) in COMMANDS.iter().enumerate() {
            for b in &COMMANDS[..i] {
                assert!(
                    a.shortcut.is_none() || a.shortcut != b.shortcut || a.keys != b.keys,
                    "{} and {}",
                    a.name,
                    b.name
                );
                assert!(a.name != b.name && a.command != b.command, "{}", a.name);
            }
        }
    }
}
