//! Names that no other element of a list has.

/// `name`, or the first of "name 2", "name 3", … that is not taken.
pub(super) fn unique_name(name: &str, taken: impl Fn(&str) -> bool) -> String {
    let numbered = (2..).map(|number| format!("{name} {number}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| !taken(name)).unwrap_or_default()
}
