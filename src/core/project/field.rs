//! The field at fault where a project cannot be read.
//!
//! serde reads an object whose kind one of its members names (a lamp, a material, a line) as a whole, and has forgotten then
//! which member an error is about. That member is found by leaving out one after the other: without it the error is another.

use serde_json::Value;
use serde_path_to_error::{Path, Segment};

use super::Project;

/// The member that names the kind of an object.
const KIND: &str = "type";

/// The field that an error is about, such as `scene.lights[2].watts`; "." for the whole project.
pub(super) fn at_fault(text: &str, error: &serde_path_to_error::Error<serde_json::Error>) -> String {
    let Place { mut field, pointer } = Place::of(error.path());
    let is_of_value = error.inner().to_string().starts_with("invalid ");
    if is_of_value && let Some(name) = member(text, &pointer) {
        field += &format!("{}{name}", if field.is_empty() { "" } else { "." });
    }
    if field.is_empty() { ".".to_owned() } else { field }
}

/// A place in a project, as far as it is known: for people, and as a JSON pointer.
#[derive(Default)]
struct Place {
    field: String,
    pointer: String,
}

impl Place {
    fn of(path: &Path) -> Self {
        let mut place = Self::default();
        for segment in path {
            match segment {
                Segment::Seq { index } => {
                    place.field += &format!("[{index}]");
                    place.pointer += &format!("/{index}");
                }
                Segment::Map { key: name } | Segment::Enum { variant: name } => {
                    place.field += if place.field.is_empty() { "" } else { "." };
                    place.field += name;
                    place.pointer += &format!("/{}", name.replace('~', "~0").replace('/', "~1"));
                }
                Segment::Unknown => break,
            }
        }
        place
    }
}

/// The member at fault of the object at a JSON pointer.
fn member(text: &str, pointer: &str) -> Option<String> {
    let project: Value = serde_json::from_str(text).ok()?;
    let members = project.pointer(pointer)?.as_object()?;
    let complaint =
        |project: Value| serde_json::from_value::<Project>(project).err().map(|error| error.to_string());
    let whole = complaint(project.clone());
    let differs = |name: &&String| {
        let mut without = project.clone();
        let object = without.pointer_mut(pointer).and_then(Value::as_object_mut);
        object.and_then(|object| object.remove(*name)).is_some() && complaint(without) != whole
    };
    // Without the kind the error is another whatever is wrong.
    let (kind, others): (Vec<_>, Vec<_>) = members.keys().partition(|name| *name == KIND);
    others.into_iter().chain(kind).find(differs).cloned()
}
