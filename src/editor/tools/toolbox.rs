//! The tools and the active one.

use super::tool::{Gesture, Ghost, PointerMode, Tool, ToolContext};
use super::{directed_line, erase, pan, probe, select, target, wall, zoom};
use crate::editor::action::Action;

/// All tools in the order of the toolbar: a new one is a file and a line here.
pub fn all() -> Vec<Box<dyn Tool>> {
    vec![
        Box::<select::Select>::default(),
        Box::<directed_line::DrawLine>::default(),
        Box::<wall::DrawWall>::default(),
        Box::<erase::Erase>::default(),
        Box::<target::Place>::default(),
        Box::<probe::Probe>::default(),
        Box::new(pan::Pan),
        Box::new(zoom::Zoom),
    ]
}

/// The tools and the active one.
pub struct Toolbox {
    tools: Vec<Box<dyn Tool>>,
    in_hand: usize,
}

impl Default for Toolbox {
    fn default() -> Self {
        Self { tools: all(), in_hand: 0 }
    }
}

impl Toolbox {
    /// The tools, in the order of the toolbar.
    pub fn tools(&self) -> impl Iterator<Item = &dyn Tool> {
        self.tools.iter().map(|tool| &**tool)
    }

    /// The active tool.
    pub fn tool(&self) -> &dyn Tool {
        &*self.tools[self.in_hand]
    }

    /// Activates a tool by index; an unfinished gesture of another is discarded, its edits become an undo step.
    pub fn take(&mut self, tool: usize) -> Vec<Action> {
        let tool = tool.min(self.tools.len() - 1);
        if tool == self.in_hand {
            return Vec::new();
        }
        let settle = self.put_down();
        self.in_hand = tool;
        settle
    }

    /// Discards an unfinished gesture of the active tool.
    pub fn put_down(&mut self) -> Vec<Action> {
        let tool = &mut self.tools[self.in_hand];
        let busy = tool.is_busy();
        tool.put_down();
        if busy { vec![Action::Settle] } else { Vec::new() }
    }

    /// Passes a gesture to the active tool.
    pub fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        self.tools[self.in_hand].gesture(gesture, context)
    }

    /// The temporary shapes of the active tool.
    pub fn ghosts(&self, context: &ToolContext) -> Vec<Ghost> {
        self.tool().ghosts(context)
    }

    /// What handles the pointer.
    pub fn pointer_mode(&self) -> PointerMode {
        self.tool().pointer_mode()
    }
}

#[cfg(test)]
mod tests {
    use egui::Key;

    use super::*;
    use crate::editor::command::{COMMANDS, KeyPlace};

    #[test]
    fn no_tool_shares_its_key_or_name() {
        let toolbox = Toolbox::default();
        for (i, tool) in toolbox.tools().enumerate() {
            let taken = |key: Key| {
                COMMANDS
                    .iter()
                    .filter(|entry| entry.keys == KeyPlace::Everywhere)
                    .filter_map(|entry| entry.shortcut)
                    .any(|s| s.modifiers.is_none() && s.logical_key == key)
            };
            assert!(!taken(tool.info().key), "{} and a command", tool.info().name);
            for other in toolbox.tools().skip(i + 1) {
                assert!(
                    tool.info().key != other.info().key && tool.info().name != other.info().name,
                    "{}",
                    tool.info().name
                );
            }
        }
    }
}
