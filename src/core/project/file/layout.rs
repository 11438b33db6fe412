//! Pretty-printing of a project file: a value that fits stands on one line, such as a key frame or the points of a short
//! wall.

use super::merge::Piece;

/// Longest line in bytes, as in the example projects.
const LONGEST: usize = 110;

/// The formatting of a file, as detected from its text.
pub(super) struct Style<'a> {
    /// Indentation of one level.
    indent: &'a str,
    /// Line end.
    newline: &'static str,
    /// Text before the root object, such as a byte order mark.
    before: &'a str,
    /// Text after the root object, such as a line end.
    behind: &'a str,
}

impl<'a> Style<'a> {
    /// Detects the style of a text that holds one JSON object.
    pub(super) fn of(text: &'a str) -> Self {
        let start = text.find('{').unwrap_or(0);
        let end = text.rfind('}').map_or(text.len(), |brace| brace + 1);
        let gap = text.get(start + 1..).unwrap_or("");
        let gap = &gap[..gap.len() - gap.trim_start().len()];
        let indent = gap.rsplit_once('\n').map_or("", |(_, blank)| blank);
        Self {
            indent: if indent.is_empty() { "  " } else { indent },
            newline: if text.contains("\r\n") { "\r\n" } else { "\n" },
            before: &text[..start],
            behind: &text[end..],
        }
    }

    /// Formats a whole file.
    pub(super) fn format(&self, root: &Piece) -> String {
        let mut text = self.before.to_owned();
        self.write(root, 0, 0, &mut text);
        text + self.behind
    }

    /// Writes a piece whose first line begins after `column` bytes and whose further lines have `depth` levels of
    /// indentation.
    fn write(&self, piece: &Piece, depth: usize, column: usize, text: &mut String) {
        let start = text.len();
        // A comma may follow.
        if one_line(piece, LONGEST.saturating_sub(column + 1), text) {
            return;
        }
        text.truncate(start);
        match piece {
            Piece::Text(verbatim) => text.push_str(verbatim),
            Piece::List { items, .. } if items.iter().all(is_number_like) => {
                self.fill(items, depth + 1, text);
            }
            Piece::List { items, .. } => {
                let items = items.iter().map(|item| (String::new(), item));
                self.write_lines(['[', ']'], items, depth, text);
            }
            Piece::Object { members, .. } => {
                let members = members.iter().map(|(name, value)| (quoted(name) + ": ", value));
                self.write_lines(['{', '}'], members, depth, text);
            }
        }
    }

    /// Writes each part on a line of its own.
    fn write_lines<'p>(
        &self,
        [open, close]: [char; 2],
        parts: impl Iterator<Item = (String, &'p Piece<'p>)>,
        depth: usize,
        text: &mut String,
    ) {
        text.push(open);
        for (i, (label, part)) in parts.enumerate() {
            text.push_str(if i > 0 { "," } else { "" });
            self.begin_line(depth + 1, text);
            text.push_str(&label);
            self.write(part, depth + 1, self.width(depth + 1) + label.len(), text);
        }
        self.begin_line(depth, text);
        text.push(close);
    }

    /// Writes numbers or points, as many on a line as fit.
    fn fill(&self, items: &[Piece], depth: usize, text: &mut String) {
        text.push('[');
        let mut column = LONGEST;
        for (i, item) in items.iter().enumerate() {
            let mut word = String::new();
            self.write(item, depth, self.width(depth), &mut word);
            text.push_str(if i > 0 { "," } else { "" });
            if column + word.len() + 2 > LONGEST {
                self.begin_line(depth, text);
                column = self.width(depth);
            } else {
                text.push(' ');
                column += 1;
            }
            text.push_str(&word);
            column += word.len() + 1;
        }
        self.begin_line(depth - 1, text);
        text.push(']');
    }

    fn begin_line(&self, depth: usize, text: &mut String) {
        text.push_str(self.newline);
        (0..depth).for_each(|_| text.push_str(self.indent));
    }

    fn width(&self, depth: usize) -> usize {
        depth * self.indent.len()
    }
}

/// Writes a piece on one line of at most `room` bytes; false, with a part of it written, if it does not fit.
fn one_line(piece: &Piece, room: usize, text: &mut String) -> bool {
    let most = text.len() + room;
    let all = match piece {
        Piece::Text(verbatim) => {
            text.push_str(verbatim);
            !verbatim.contains('\n')
        }
        Piece::Object { members, .. } if members.is_empty() => {
            text.push_str("{}");
            true
        }
        Piece::List { items, broken: true } if !items.is_empty() => false,
        Piece::Object { broken: true, .. } => false,
        Piece::List { items, .. } => {
            text.push('[');
            let all = items.iter().enumerate().all(|(i, item)| {
                text.push_str(if i > 0 { ", " } else { "" });
                one_line(item, most.saturating_sub(text.len()), text)
            });
            text.push(']');
            all
        }
        Piece::Object { members, .. } => {
            text.push_str("{ ");
            let all = members.iter().enumerate().all(|(i, (name, value))| {
                text.push_str(if i > 0 { ", " } else { "" });
                text.push_str(&quoted(name));
                text.push_str(": ");
                one_line(value, most.saturating_sub(text.len()), text)
            });
            text.push_str(" }");
            all
        }
    };
    all && text.len() <= most
}

/// Whether a piece is a number or a list of numbers.
fn is_number_like(piece: &Piece) -> bool {
    match piece {
        Piece::Text(text) => !text.contains(['{', '"']),
        Piece::List { items, .. } => items.iter().all(is_number_like),
        Piece::Object { .. } => false,
    }
}

/// A name as a JSON string.
fn quoted(name: &str) -> String {
    serde_json::Value::from(name).to_string()
}
