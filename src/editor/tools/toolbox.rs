//! The tools, and the one in hand.

use super::tool::{Gesture, Ghost, PointerMode, Tool, ToolContext};
use super::{directed_line, erase, pan, probe, select, target, wall, zoom};
use crate::editor::action::Action;

/// All tools, as they stand in the bar: a new one is a file and a line here.
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

/// The tools, and the one in hand.
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
    /// The tools, as they stand in the bar.
    pub fn tools(&self) -> impl Iterator<Item = &dyn Tool> {
        self.tools.iter().map(|tool| &**tool)
    }

    /// The tool in hand.
    pub fn tool(&self) -> &dyn Tool {
        &*self.tools[self.in_hand]
    }

    /// Takes the tool at this place in the list; what another had begun is forgotten, what it had changed is a step.
    pub fn take(&mut self, tool: usize) -> Vec<Action> {
        let tool = tool.min(self.tools.len() - 1);
        if tool == self.in_hand {
            return Vec::new();
        }
        let settle = self.put_down();
        self.in_hand = tool;
        settle
    }

    /// Forgets what the tool in hand had begun: the document is another.
    pub fn put_down(&mut self) -> Vec<Action> {
        let tool = &mut self.tools[self.in_hand];
        let busy = tool.is_busy();
        tool.put_down();
        if busy { vec![Action::Settle] } else { Vec::new() }
    }

    /// Gives a gesture to the tool in hand.
    pub fn gesture(&mut self, gesture: Gesture, context: &ToolContext) -> Vec<Action> {
        self.tools[self.in_hand].gesture(gesture, context)
    }

    /// What the tool in hand shows.
    pub fn ghosts(&self, context: &ToolContext) -> Vec<Ghost> {
        self.tool().ghosts(context)
    }

    /// Who answers the pointer now.
    pub fn pointer_mode(&self) -> PointerMode {
        self.tool().pointer_mode()
    }
}

/// Whether a dialog or a menu is open, which keys belong to.
pub(crate) fn is_covered(ctx: &egui::Context) -> bool {
    egui::Popup::is_any_open(ctx) || ctx.memory(|memory| memory.top_modal_layer().is_some())
}

#[cfg(test)]
mod tests {
    use egui::Key;

    use super::*;
    use crate::editor::command::COMMANDS;

    #[test]
    fn no_tool_shares_its_key_or_name() {
        let toolbox = Toolbox::default();
        for (i, tool) in toolbox.tools().enumerate() {
            let taken = |key: Key| {
                COMMANDS
                    .iter()
                    .filter_map(|entry| entry.shortcut)
                    .any(|s| s.modifiers.is_none() && s.logical_key == key)
            };
            assert!(!taken(tool.key()), "{} and a command", tool.name());
            for other in toolbox.tools().skip(i + 1) {
                assert!(tool.key() != other.key() && tool.name() != other.name(), "{}", tool.name());
            }
        }
    }
}
