//! What a file holds that this program does not know: members whose names the format's schema has no place for. A later
//! version, a script or another program may have written them.

use std::fmt::Write as _;

use serde_json::Value;

use super::tree::{Kind, Node};
use crate::project::schema_docs::resolve;

/// Longest part of an unknown name that is shown.
const SHOWN: usize = 120;

/// A JSON text without what `schema` does not know, and the places of what was left out, such as `constraints[0].colour`;
/// none where it is no JSON.
pub(in crate::project) fn without(text: &str, schema: &Value) -> Option<(String, Vec<String>)> {
    let mut known = Known { schema, text: String::with_capacity(text.len()), left_out: Vec::new() };
    known.write(&Node::read(text).ok()?, Some(schema), "");
    Some((known.text, known.left_out))
}

struct Known<'a> {
    schema: &'a Value,
    text: String,
    left_out: Vec<String>,
}

impl<'a> Known<'a> {
    /// Writes what is known of `node`; where the form is not known it is written whole, and reading it will tell.
    fn write(&mut self, node: &Node, form: Option<&'a Value>, place: &str) {
        match (&node.kind, form.and_then(|form| self.choose(form, node))) {
            (Kind::Object(members), Some(form)) => self.write_object(members, form, place),
            (Kind::List(items), Some(form)) => {
                let item_form = self.part(form, "items");
                self.text.push('[');
                for (i, item) in items.iter().enumerate() {
                    if i > 0 {
                        self.text.push(',');
                    }
                    self.write(item, item_form, &format!("{place}[{i}]"));
                }
                self.text.push(']');
            }
            _ => self.text.push_str(node.text),
        }
    }

    fn write_object(&mut self, members: &[(String, Node)], form: &'a Value, place: &str) {
        self.text.push('{');
        let mut first = true;
        for (name, value) in members {
            let place = if place.is_empty() { name.clone() } else { format!("{place}.{name}") };
            let Some(form) = self.member(form, name) else {
                self.left_out.push(shown(&place));
                continue;
            };
            if !std::mem::take(&mut first) {
                self.text.push(',');
            }
            // Written by serde_json's own rules for strings; a string can always be written.
            let _ = write!(self.text, "{}:", Value::from(name.as_str()));
            self.write(value, Some(form), &place);
        }
        self.text.push('}');
    }

    /// The form of the member `name`, where an object of this form may have one.
    fn member(&self, form: &'a Value, name: &str) -> Option<&'a Value> {
        let own = form.get("properties").and_then(|properties| properties.get(name));
        // A map: any name has the same form.
        own.or_else(|| form.get("additionalProperties").filter(|form| form.is_object()))
            .or_else(|| self.member(self.beyond(form)?, name))
    }

    /// The value that `key` has in the form or in the definition it refers to.
    fn part(&self, form: &'a Value, key: &str) -> Option<&'a Value> {
        form.get(key).or_else(|| self.part(self.beyond(form)?, key))
    }

    /// The definition that a form refers to.
    fn beyond(&self, form: &'a Value) -> Option<&'a Value> {
        form.get("$ref").and_then(|_| resolve(self.schema, form))
    }

    /// Of a choice between forms that which `node` has, by its tag; the form itself where there is no choice.
    fn choose(&self, form: &'a Value, node: &Node) -> Option<&'a Value> {
        let Some(forms) = self.part(form, "oneOf").or_else(|| self.part(form, "anyOf")) else {
            return Some(form);
        };
        forms.as_array()?.iter().find_map(|form| self.choose(form, node).filter(|form| self.fits(form, node)))
    }

    /// Whether a value is of the form's type and has all members that the form requires, tags with the right value.
    fn fits(&self, form: &'a Value, node: &Node) -> bool {
        let kind = match node.kind {
            Kind::Object(_) => "object",
            Kind::List(_) => "array",
            Kind::Leaf => return false,
        };
        let required = self.part(form, "required").and_then(Value::as_array).into_iter().flatten();
        self.part(form, "type").is_some_and(|own| own == kind)
            && required.filter_map(Value::as_str).all(|name| {
                let tag = self.member(form, name).and_then(|form| form.get("const"));
                node.get(name).is_some_and(|own| tag.is_none_or(|tag| is(own, tag)))
            })
    }
}

/// Whether a value is the constant `tag`.
fn is(node: &Node, tag: &Value) -> bool {
    serde_json::from_str::<Value>(node.text).is_ok_and(|value| value == *tag)
}

/// A place as a message shows it: on one line and not longer than anybody reads.
fn shown(place: &str) -> String {
    let mut shown: String = place.chars().take(SHOWN).flat_map(char::escape_debug).collect();
    if place.chars().nth(SHOWN).is_some() {
        shown.push('…');
    }
    shown
}
