//! Range, default and help of settings in the JSON schema.

use schemars::Schema;
use schemars::transform::Transform;
use serde_json::{Map, Value, json};

use super::{ANY, Choice, Kind, Setting};

/// Writes settings into the schema of the type that has them, as `#[schemars(transform = Describe(Self::SETTINGS))]`; on
/// an enumeration `Describe(Type::CHOICE)` describes its variants.
pub(crate) struct Describe<S>(pub S);

impl Transform for Describe<&'static [Setting]> {
    fn transform(&mut self, schema: &mut Schema) {
        self.0.iter().for_each(|setting| Describe(*setting).transform(schema));
    }
}

impl Transform for Describe<Setting> {
    fn transform(&mut self, schema: &mut Schema) {
        let Some(root) = schema.as_object_mut() else { return };
        for variant in root.get_mut("oneOf").and_then(Value::as_array_mut).into_iter().flatten() {
            if let Some(choice) = self.0.choices.iter().find(|choice| is_variant(variant, choice)) {
                variant["description"] = choice.help.into();
            }
            if let Some(variant) = variant.as_object_mut() {
                describe_property(variant, &self.0);
            }
        }
        describe_property(root, &self.0);
    }
}

/// Whether a variant of an enumeration is this choice: by its constant, its tag, or its only member.
fn is_variant(variant: &Value, choice: &Choice) -> bool {
    [&variant["const"], &variant["properties"]["type"]["const"], &variant["required"][0]]
        .into_iter()
        .any(|name| *name == choice.value)
}

/// Describes the member that the setting names, where the object has it.
fn describe_property(object: &mut Map<String, Value>, setting: &Setting) {
    let (name, is_element) = match setting.name().strip_suffix("[]") {
        Some(list) => (list, true),
        None => (setting.name(), false),
    };
    let property = object.get_mut("properties").and_then(|properties| properties.get_mut(name));
    let Some(property) = property.and_then(Value::as_object_mut) else { return };
    if !is_element {
        let words = format!("{} {}", setting.help, setting.in_words());
        property.insert("description".into(), words.trim().into());
        if !matches!(setting.kind, Kind::Switch | Kind::Choice) && !setting.default.is_empty() {
            property.insert("default".into(), default(setting));
        }
    }
    match property.get_mut("items").and_then(Value::as_object_mut) {
        Some(item) => restrict(item, setting),
        None => restrict(property, setting),
    }
}

fn default(setting: &Setting) -> Value {
    match setting.default {
        [only] => number(setting, *only),
        several => several.iter().map(|&value| number(setting, value)).collect(),
    }
}

fn number(setting: &Setting, value: f64) -> Value {
    if setting.kind == Kind::Whole { json!(value as i64) } else { json!(value) }
}

/// The range of a number, the values of a choice of numbers; a type that stands elsewhere has its own.
fn restrict(number_schema: &mut Map<String, Value>, setting: &Setting) {
    if number_schema.contains_key("$ref") {
        return;
    }
    let numbers: Option<Vec<u64>> = setting.choices.iter().map(|choice| choice.value.parse().ok()).collect();
    match (setting.kind, numbers) {
        (Kind::Choice, Some(numbers)) => {
            number_schema.insert("enum".into(), numbers.into());
        }
        (Kind::Real | Kind::Whole | Kind::Vector | Kind::Colour, _) if setting.range != ANY => {
            let [low, high] = setting.range.map(|end| number(setting, end));
            number_schema.insert(if setting.above { "exclusiveMinimum" } else { "minimum" }.into(), low);
            number_schema.insert("maximum".into(), high);
        }
        _ => {}
    }
}
