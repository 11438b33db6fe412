//! Unknown members of a file: those that the JSON schema does not have. A later version, a script or another program may have
//! written them.

use std::fmt::Write as _;

use serde_json::Value;

use super::tree::{Kind, Node};
use crate::project::schema_docs::resolve;

/// Longest place in a message, characters.
const SHOWN: usize = 120;

/// A JSON text without members that `schema` does not have, and the paths of those, such as `constraints[0].colour`; none if
/// the text is not JSON.
pub(in crate::project) fn strip(text: &str, schema: &Value) -> Option<(String, Vec<String>)> {
    let mut known = Known { root: schema, text: String::with_capacity(text.len()), left_out: Vec::new() };
    known.write(&Node::read(text).ok()?, Some(schema), "");
    Some((known.text, known.left_out))
}

struct Known<'a> {
    root: &'a Value,
    text: String,
    left_out: Vec<String>,
}

impl<'a> Known<'a> {
    /// Writes the known part of `node`; all of it if no schema fits, which the parser then reports.
    fn write(&mut self, node: &Node, schema: Option<&'a Value>, place: &str) {
        match (&node.kind, schema.and_then(|schema| self.choose(schema, node))) {
            (Kind::Object(members), Some(schema)) => self.write_object(members, schema, place),
            (Kind::List(items), Some(schema)) => {
                let item_schema = self.part(schema, "items");
                self.text.push('[');
                for (i, item) in items.iter().enumerate() {
                    if i > 0 {
                        self.text.push(',');
                    }
                    self.write(item, item_schema, &format!("{place}[{i}]"));
                }
                self.text.push(']');
            }
            _ => self.text.push_str(node.text),
        }
    }

    fn write_object(&mut self, members: &[(String, Node)], schema: &'a Value, place: &str) {
        self.text.push('{');
        let mut first = true;
        for (name, value) in members {
            let place = if place.is_empty() { name.clone() } else { format!("{place}.{name}") };
            let Some(schema) = self.member(schema, name) else {
                self.left_out.push(shown(&place));
                continue;
            };
            if !std::mem::take(&mut first) {
                self.text.push(',');
            }
            // Written by serde_json's own rules for strings; a string can always be written.
            let _ = write!(self.text, "{}:", Value::from(name.as_str()));
            self.write(value, Some(schema), &place);
        }
        self.text.push('}');
    }

    /// The schema of the member `name` of an object of this schema.
    fn member(&self, schema: &'a Value, name: &str) -> Option<&'a Value> {
        let own = schema.get("properties").and_then(|properties| properties.get(name));
        // A map: all names have the same schema.
        own.or_else(|| schema.get("additionalProperties").filter(|schema| schema.is_object()))
            .or_else(|| self.member(self.definition(schema)?, name))
    }

    /// The value of `key` in the schema or in the definition it refers to.
    fn part(&self, schema: &'a Value, key: &str) -> Option<&'a Value> {
        schema.get(key).or_else(|| self.part(self.definition(schema)?, key))
    }

    /// The definition that a schema refers to.
    fn definition(&self, schema: &'a Value) -> Option<&'a Value> {
        schema.get("$ref").and_then(|_| resolve(self.root, schema))
    }

    /// Of alternative schemas the one that `node` matches, by its tag; the schema itself if there are no alternatives.
    fn choose(&self, schema: &'a Value, node: &Node) -> Option<&'a Value> {
        let Some(schemas) = self.part(schema, "oneOf").or_else(|| self.part(schema, "anyOf")) else {
            return Some(schema);
        };
        schemas
            .as_array()?
            .iter()
            .find_map(|schema| self.choose(schema, node).filter(|schema| self.fits(schema, node)))
    }

    /// Whether a value has the schema's type and all required members, tags with the right value.
    fn fits(&self, schema: &'a Value, node: &Node) -> bool {
        let kind = match node.kind {
            Kind::Object(_) => "object",
            Kind::List(_) => "array",
            Kind::Leaf => return false,
        };
        let required = self.part(schema, "required").and_then(Value::as_array).into_iter().flatten();
        self.part(schema, "type").is_some_and(|own| own == kind)
            && required.filter_map(Value::as_str).all(|name| {
                let tag = self.member(schema, name).and_then(|schema| schema.get("const"));
                node.get(name).is_some_and(|own| tag.is_none_or(|tag| is(own, tag)))
            })
    }
}

/// Whether a value is the constant `tag`.
fn is(node: &Node, tag: &Value) -> bool {
    serde_json::from_str::<Value>(node.text).is_ok_and(|value| value == *tag)
}

/// A place for a message: escaped to one line and cut to [`SHOWN`].
fn shown(place: &str) -> String {
    let mut shown: String = place.chars().take(SHOWN).flat_map(char::escape_debug).collect();
    if place.chars().nth(SHOWN).is_some() {
        shown.push('…');
    }
    shown
}
