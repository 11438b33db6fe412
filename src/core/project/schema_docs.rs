//! The documentation of fields in the schema, for error messages that name the allowed range.

use serde_json::Value;

/// The description of the field at a path such as `keys[1].shows.image`, if the schema has one.
pub(super) fn description(schema: &Value, path: &str) -> Option<String> {
    let mut node = schema;
    for step in path.split('.') {
        let (name, indices) = step.split_at(step.find('[').unwrap_or(step.len()));
        node = child(schema, node, name)?;
        for _ in indices.matches('[') {
            node = resolve(schema, node)?.get("items")?;
        }
    }
    let description = node.get("description").or_else(|| resolve(schema, node)?.get("description"))?;
    Some(description.as_str()?.replace("\\[", "[").replace("\\]", "]").replace('\n', " "))
}

/// The property `name` of `node`, also where `node` is a choice of several forms.
fn child<'a>(schema: &'a Value, node: &'a Value, name: &str) -> Option<&'a Value> {
    let node = resolve(schema, node)?;
    if let Some(found) = node.get("properties").and_then(|p| p.get(name)) {
        return Some(found);
    }
    // A map: any name has the same form.
    if let Some(found) = node.get("additionalProperties").filter(|form| form.is_object()) {
        return Some(found);
    }
    let forms = ["oneOf", "anyOf", "allOf"].iter().filter_map(|key| node.get(key)?.as_array()).flatten();
    forms.into_iter().find_map(|form| child(schema, form, name))
}

/// Follows a `$ref` to its definition.
pub(super) fn resolve<'a>(schema: &'a Value, node: &'a Value) -> Option<&'a Value> {
    match node.get("$ref").and_then(Value::as_str) {
        Some(reference) => schema.pointer(reference.strip_prefix('#')?),
        None => Some(node),
    }
}
