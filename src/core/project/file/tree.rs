//! JSON syntax tree over borrowed text: each value with its source text, members in order. Unchanged values are written with
//! that text, which keeps numbers as they were typed.

use std::fmt;

use serde::de::{Deserialize, Deserializer, MapAccess, Visitor};
use serde_json::value::RawValue;

/// Deepest nesting, the limit of serde_json.
const DEEPEST: usize = 128;

/// A JSON value with its source text.
#[derive(Clone, Debug)]
pub(super) struct Node<'a> {
    /// Source text without surrounding white space.
    pub(super) text: &'a str,
    pub(super) kind: Kind<'a>,
}

/// The content of a value.
#[derive(Clone, Debug)]
pub(super) enum Kind<'a> {
    /// A number, a string, true, false or null.
    Leaf,
    List(Vec<Node<'a>>),
    /// Names (without their escapes) and values, in the order of the text.
    Object(Vec<(String, Node<'a>)>),
}

impl<'a> Node<'a> {
    /// Parses a JSON text.
    pub(super) fn read(text: &'a str) -> serde_json::Result<Self> {
        let raw: &RawValue = serde_json::from_str(text)?;
        Self::below(raw.get(), 0)
    }

    fn below(text: &'a str, depth: usize) -> serde_json::Result<Self> {
        if depth > DEEPEST {
            return Err(serde::de::Error::custom("nested too deep"));
        }
        let kind = match text.as_bytes().first() {
            Some(b'[') => {
                let items: Vec<&RawValue> = serde_json::from_str(text)?;
                let items = items.into_iter().map(|item| Self::below(item.get(), depth + 1));
                Kind::List(items.collect::<serde_json::Result<_>>()?)
            }
            Some(b'{') => {
                let Members(members) = serde_json::from_str(text)?;
                let members =
                    members.into_iter().map(|(name, value)| Ok((name, Self::below(value.get(), depth + 1)?)));
                Kind::Object(members.collect::<serde_json::Result<_>>()?)
            }
            _ => Kind::Leaf,
        };
        Ok(Self { text, kind })
    }

    /// The value of a member; none if there is no such member, or this is no object.
    pub(super) fn get(&self, name: &str) -> Option<&Self> {
        self.members().iter().find(|(own, _)| own == name).map(|(_, value)| value)
    }

    /// The members of an object; empty for other values.
    pub(super) fn members(&self) -> &[(String, Node<'a>)] {
        match &self.kind {
            Kind::Object(members) => members,
            Kind::Leaf | Kind::List(_) => &[],
        }
    }
}

/// The members of one object in order, duplicates included.
struct Members<'a>(Vec<(String, &'a RawValue)>);

impl<'de: 'a, 'a> Deserialize<'de> for Members<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;
        impl<'de> Visitor<'de> for InOrder {
            type Value = Members<'de>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut members = Vec::new();
                while let Some(member) = map.next_entry()? {
                    members.push(member);
                }
                Ok(Members(members))
            }
        }
        deserializer.deserialize_map(InOrder)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn values_keep_the_text_they_were_written_in() {
        let node = Node::read(" { \"a\": [ 1.50, -0 ], \"b\" : \"\\u00e4\", \"a\": {} }\n").unwrap();
        let names: Vec<_> = node.members().iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["a", "b", "a"]);
        assert_eq!(node.get("a").unwrap().text, "[ 1.50, -0 ]");
        assert_eq!(node.get("b").unwrap().text, "\"\\u00e4\"");
        let Kind::List(items) = &node.get("a").unwrap().kind else { panic!("a list") };
        assert_eq!(items.iter().map(|item| item.text).collect::<Vec<_>>(), ["1.50", "-0"]);
    }

    #[test]
    fn nesting_without_end_is_refused() {
        let deep = |levels: usize| "[".repeat(levels) + &"]".repeat(levels);
        assert!(Node::read(&deep(100)).is_ok());
        assert!(Node::read(&deep(100_000)).is_err());
    }
}
