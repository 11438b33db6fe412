//! One file: what it declares, what it imports, which paths it names.

use std::collections::BTreeSet;

use crate::tokens::tokens;

/// Segments of a path, `crate`, `self` and `super` among them.
pub(crate) type Path = Vec<String>;

/// One name of a `use` declaration; a glob has the name `*`.
#[derive(Debug, PartialEq)]
pub(crate) struct Use {
    pub(crate) name: String,
    pub(crate) path: Path,
    /// `pub use`, of any reach.
    pub(crate) exported: bool,
}

/// What a file says, before any name is looked up.
#[derive(Default)]
pub(crate) struct Module {
    /// `mod name;`
    pub(crate) children: Vec<String>,
    /// Items that are declared outside all braces.
    pub(crate) items: BTreeSet<String>,
    pub(crate) uses: Vec<Use>,
    /// Paths outside `use` declarations; a single name too.
    pub(crate) paths: BTreeSet<Path>,
}

const DECLARES: [&str; 8] = ["fn", "struct", "enum", "trait", "type", "const", "static", "union"];

impl Module {
    pub(crate) fn read(text: &str) -> Self {
        let tokens = merge_inline_modules(tokens(text));
        let token = |i: usize| tokens.get(i).map_or("", String::as_str);
        let (mut module, mut depth, mut i) = (Self::default(), 0, 0);
        while i < tokens.len() {
            match token(i) {
                "{" => depth += 1,
                "}" => depth -= 1,
                "mod" if token(i + 2) == ";" => module.children.push(token(i + 1).into()),
                "mod" if token(i + 2) == "{" => _ = module.items.insert(token(i + 1).into()),
                // Not the `use<...>` of a type.
                "use" if token(i + 1) != "<" => {
                    let exported = matches!(token(i.wrapping_sub(1)), "pub" | ")");
                    i = module.read_use(&tokens, i + 1, &mut Vec::new(), exported);
                }
                word if depth == 0 && DECLARES.contains(&word) && !DECLARES.contains(&token(i + 1)) => {
                    module.items.insert(token(i + 1).into());
                }
                word if is_word(word) && token(i.wrapping_sub(1)) != "." => {
                    let mut path = vec![word.to_owned()];
                    while token(i + 1) == "::" && is_word(token(i + 2)) {
                        path.push(token(i + 2).into());
                        i += 2;
                    }
                    module.paths.insert(path);
                }
                _ => {}
            }
            i += 1;
        }
        module
    }

    /// A use tree from `i` on, below `prefix`; returns the index of the `;`, `,` or `}` behind it.
    fn read_use(&mut self, tokens: &[String], mut i: usize, prefix: &mut Path, exported: bool) -> usize {
        let kept = prefix.len();
        loop {
            match tokens[i].as_str() {
                "::" => i += 1,
                "{" => {
                    while tokens[i] != "}" {
                        i = self.read_use(tokens, i + 1, prefix, exported);
                    }
                    i += 1;
                    break;
                }
                ";" | "," | "}" => {
                    if prefix.len() > kept {
                        self.keep_use(prefix, None, exported);
                    }
                    break;
                }
                "as" => {
                    self.keep_use(prefix, Some(&tokens[i + 1]), exported);
                    i += 2;
                    break;
                }
                word => {
                    prefix.push(word.into());
                    i += 1;
                }
            }
        }
        prefix.truncate(kept);
        i
    }

    fn keep_use(&mut self, path: &Path, name: Option<&String>, exported: bool) {
        let mut path = path.clone();
        if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
            path.pop();
        }
        let name = name.unwrap_or(&path[path.len() - 1]).clone();
        self.uses.push(Use { name, path, exported });
    }
}

fn is_word(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// `super` inside `mod name { ... }` is the file itself.
fn merge_inline_modules(mut tokens: Vec<String>) -> Vec<String> {
    for start in 0..tokens.len().saturating_sub(2) {
        if tokens[start] == "mod" && tokens[start + 2] == "{" {
            let mut depth = 0;
            for token in &mut tokens[start + 2..] {
                depth += i32::from(*token == "{") - i32::from(*token == "}");
                if depth == 0 {
                    break;
                }
                if token == "super" {
                    *token = "self".into();
                }
            }
        }
    }
    tokens
}

#[test]
fn uses_are_read_with_groups_and_names() {
    let module = Module::read("pub use a::{self, b::{C, D as E}, f::*}; use super::G;");
    let read: Vec<_> = module.uses.iter().map(|u| (u.name.as_str(), u.path.join("::"), u.exported)).collect();
    let expected = [
        ("a", "a", true),
        ("C", "a::b::C", true),
        ("E", "a::b::D", true),
        ("*", "a::f::*", true),
        ("G", "super::G", false),
    ];
    assert_eq!(read, expected.map(|(name, path, exported)| (name, path.to_owned(), exported)));
}

#[test]
fn texts_comments_and_unit_tests_are_not_read() {
    let module = Module::read(
        "/* a::b */ fn x() { \"c::d\"; r#\"e::f\"#; '\\'' ; ':'; g::h() } // i::j\n#[cfg(test)] mod tests { k::l }",
    );
    let paths: Vec<_> =
        module.paths.iter().filter(|path| path.len() > 1).map(|path| path.join("::")).collect();
    assert_eq!(paths, ["g::h"]);
    assert!(module.items.contains("x"));
}
