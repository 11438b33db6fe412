//! The panels have a control for every setting of the core.

use std::collections::BTreeSet;

use lightloom::editor::panels::controls;
use lightloom_core::project::settings;
use lightloom_core::setting::{ANY, Kind};

#[test]
fn every_setting_stands_in_a_panel() {
    let shown: BTreeSet<&str> = controls().map(|control| control.setting.place).collect();
    // The list has them: name, eye, padlock, and the heads of groups; what a caustic shows is chosen as what all show.
    let rows = ["constraints[].name", "constraints[].enabled", "constraints[].locked", "constraints[].group"];
    let elsewhere = |place: &str| rows.contains(&place) || place == "keys[].caustics.NAME.shows";
    let wanted = settings().map(|setting| setting.place).filter(|place| !elsewhere(place));
    let missing: Vec<_> = wanted.filter(|place| !shown.contains(place)).collect();
    assert!(shown.len() > 80 && missing.is_empty(), "{missing:?}");
}

#[test]
fn every_control_shows_a_setting_of_the_core_as_it_is() {
    for control in controls() {
        let setting = &control.setting;
        assert!(settings().any(|other| other == setting), "{}", setting.place);
        assert!(!control.label.is_empty(), "{}", setting.place);
        assert_eq!(control.labels.len(), setting.choices.len(), "{}", setting.place);
        let [low, high] = control.slider;
        let is_inside = setting.range[0] <= low && low < high && high <= setting.range[1];
        let is_number = matches!(setting.kind, Kind::Real | Kind::Whole) && setting.range != ANY;
        assert!(!is_number || is_inside, "{}", setting.place);
    }
}
