//! The panels: all projects are shown, edits are asked for and never made, and every setting says what the core says.

mod settings;
mod support;

use egui::accesskit::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use lightloom::editor::action::Action;
use lightloom::editor::document::Edit;
use lightloom::editor::look::object::SceneObject;
use lightloom::editor::panels::{PANELS, PanelInfo};
use lightloom::editor::selection::Selection;
use lightloom::editor::session::{Focus, Panel};
use lightloom_core::constraint::{Constraint, Wall};
use lightloom_core::project::Project;
use support::{PanelHarness, examples, panel_harness};

/// All panels, each with what is opened in it, one after the other.
fn focused(project: &Project) -> impl Iterator<Item = (&'static PanelInfo, Focus)> + '_ {
    PANELS
        .iter()
        .flat_map(|entry| support::firsts(project, entry.panel).into_iter().map(move |focus| (entry, focus)))
}

fn with_two_walls() -> Project {
    let mut project = support::example("letters");
    let mut lower = Wall::new(vec![[0.35, 0.405], [0.62, 0.34]]);
    lower.name = "lower hollow".to_owned();
    project.constraints.push(Constraint::Wall(lower));
    project
}

/// The last edit that was asked for.
fn last_edit(harness: &PanelHarness) -> Edit {
    let mut edits = harness.state().asked.iter().filter_map(|action| match action {
        Action::Edit(edit) => Some(edit.clone()),
        _ => None,
    });
    edits.next_back().expect("an edit")
}

#[test]
fn every_panel_shows_every_project_and_asks_for_nothing_by_itself() {
    for (name, project) in examples() {
        for (entry, focus) in focused(&project) {
            let mut harness = panel_harness(project.clone(), entry.panel);
            harness.state_mut().session.focus = focus;
            harness.state_mut().session.selection = Selection::all(0..project.constraints.len());
            harness.run();
            assert!(harness.state().asked.is_empty(), "{name}, {}: {:?}", entry.name, harness.state().asked);
        }
    }
}

#[test]
fn no_two_inputs_of_a_panel_bear_the_same_name() {
    for (project_name, project) in examples() {
        for (entry, focus) in focused(&project) {
            let mut harness = panel_harness(project.clone(), entry.panel);
            harness.state_mut().session.focus = focus;
            harness.run();
            let mut names: Vec<(Role, String)> = harness
                .root()
                .children_recursive()
                .map(|node| node.accesskit_node())
                .filter(|node| egui::accessibility::is_input(node.role()))
                .map(|node| (node.role(), node.label().unwrap_or_default()))
                .collect();
            names.sort_by_key(|(role, name)| (format!("{role:?}"), name.clone()));
            let twice = names.windows(2).find(|pair| pair[0] == pair[1]);
            assert_eq!(twice, None, "{project_name}, {}", entry.name);
        }
    }
}

#[test]
fn the_gamma_slider_asks_for_that_gamma_and_does_not_write_it() {
    let before = support::example("letters_free");
    let mut harness = panel_harness(before.clone(), Panel::Flow);
    harness.state_mut().applies = false;
    harness.get_by_role_and_label(Role::Slider, "Gamma").set_value_accesskit(0.75);
    harness.run();
    let mut flow = before.flow.clone();
    flow.gamma = 0.75;
    assert_eq!(last_edit(&harness), Edit::Flow(flow));
    assert_eq!(**harness.state().document.project(), before);
}

#[test]
fn a_field_that_is_left_as_it_was_keeps_the_digits_that_it_does_not_show() {
    let mut project = support::example("letters_free");
    project.flow.gamma = 0.123_456_79;
    let mut harness = panel_harness(project, Panel::Flow);
    for typed in [None, Some("0.2")] {
        harness.get_by_role_and_label(Role::SpinButton, "Gamma value").click();
        harness.run();
        if let Some(typed) = typed {
            harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
            harness.event(egui::Event::Text(typed.to_owned()));
        }
        harness.key_press(egui::Key::Enter);
        harness.run();
        let expected = if typed.is_some() { 0.2 } else { 0.123_456_79 };
        assert_eq!(harness.state().document.project().flow.gamma, expected);
    }
}

#[test]
fn a_double_click_on_the_name_resets() {
    let mut project = support::example("letters_free");
    project.flow.gamma = 0.1;
    let mut harness = panel_harness(project, Panel::Flow);
    support::double_click(&mut harness, Role::Label, "Gamma");
    assert_eq!(harness.state().document.project().flow.gamma, 0.5);
}

#[test]
fn a_double_click_on_a_number_keeps_it_and_what_is_typed_replaces_it() {
    // Both clicks within one frame, and one after the other: the first makes a text field of the number.
    for apart in [false, true] {
        let mut project = support::example("letters_free");
        project.flow.gamma = 0.125;
        let mut harness = panel_harness(project, Panel::Flow);
        let gamma = |harness: &PanelHarness| harness.state().document.project().flow.gamma;
        support::double_click_in(&mut harness, Role::SpinButton, "Gamma value", apart);
        assert_eq!(gamma(&harness), 0.125, "{apart}");
        harness.event(egui::Event::Text("0.75".to_owned()));
        harness.key_press(egui::Key::Enter);
        harness.run();
        assert_eq!(gamma(&harness), 0.75, "{apart}");
    }
}

#[test]
fn a_double_click_on_one_number_of_several_changes_none() {
    let project = support::example("bottles");
    let objects = [SceneObject::Mesh(0), SceneObject::Light(0), SceneObject::Camera, SceneObject::Receiver];
    for object in objects {
        let mut harness = panel_harness(project.clone(), Panel::Scene);
        harness.state_mut().session.focus.object = Some(object);
        harness.run();
        let numbers: Vec<String> = harness
            .root()
            .children_recursive()
            .map(|node| node.accesskit_node())
            .filter(|node| node.role() == Role::SpinButton)
            .filter_map(|node| node.label())
            .collect();
        assert!(numbers.len() > 3, "{object:?}: {numbers:?}");
        for number in numbers {
            harness.get_by_role_and_label(Role::SpinButton, &number).scroll_to_me();
            harness.run();
            support::double_click(&mut harness, Role::SpinButton, &number);
            harness.key_press(egui::Key::Escape);
            harness.run();
            assert_eq!(**harness.state().document.project(), project, "{number}");
        }
    }
}

#[test]
fn what_is_selected_comes_into_view() {
    let mut harness = panel_harness(support::example("bottles"), Panel::Scene);
    let height = 320.0;
    harness.set_size(egui::vec2(support::WIDTH, height));
    harness.run();
    let objects = [
        (SceneObject::Receiver, "Receiver: Turn z"),
        (SceneObject::Mesh(0), "Mesh round bottle"),
        (SceneObject::Camera, "Camera: Position x"),
        (SceneObject::Light(0), "Light green lamp"),
        (SceneObject::Receiver, "Receiver: Turn z"),
    ];
    for (object, value) in objects {
        harness.state_mut().session.focus.object = Some(object);
        // It opens and scrolls slowly.
        harness.run_steps(20);
        let seen = harness.get_all_by_label_contains(value).next().unwrap().rect();
        assert!(seen.top() >= 0.0 && seen.bottom() <= height, "{object:?}: {seen:?}");
    }
}

#[test]
fn a_value_beyond_the_range_never_leaves_a_panel() {
    let project = support::example("letters_free");
    for value in [-3.0, 7.0, f64::NAN, f64::INFINITY] {
        let mut harness = panel_harness(project.clone(), Panel::Flow);
        harness.get_by_role_and_label(Role::SpinButton, "Gamma value").set_value_accesskit(value);
        harness.run();
        let gamma = harness.state().document.project().flow.gamma;
        assert!((0.0..=1.0).contains(&gamma), "{value} gave {gamma}");
    }
}

#[test]
fn a_preset_sets_the_flow_in_one_click() {
    let mut harness = panel_harness(support::example("letters_free"), Panel::Flow);
    harness.get_by_label("Preset Storm").click();
    harness.run();
    assert_eq!(harness.state().document.project().flow.turbulence.as_ref().map(|t| t.strength), Some(50.0));
}

#[test]
fn a_click_selects_what_was_drawn_and_ctrl_adds() {
    let mut harness = panel_harness(with_two_walls(), Panel::Drawn);
    harness.get_by_label("upper hollow").click();
    harness.run();
    assert_eq!(harness.state().session.selection, Selection::one(0));
    harness.get_by_label("lower hollow").click_modifiers(egui::Modifiers::COMMAND);
    harness.run();
    assert_eq!(harness.state().session.selection, Selection::all([0, 1]));
    harness.get_by_role_and_label(Role::Slider, "Thickness").set_value_accesskit(0.1);
    harness.run();
    for constraint in &harness.state().document.project().constraints {
        let Constraint::Wall(wall) = constraint else { panic!("a wall") };
        assert_eq!(wall.thickness, 0.1);
    }
}

#[test]
fn what_is_locked_keeps_its_values_and_stays() {
    let mut harness = panel_harness(with_two_walls(), Panel::Drawn);
    harness.get_by_label("Lock: upper hollow").click();
    harness.run();
    harness.state_mut().session.selection = Selection::all([0, 1]);
    harness.run();
    let before = harness.state().document.project().constraints[0].clone();
    harness.get_by_role_and_label(Role::Slider, "Thickness").set_value_accesskit(0.1);
    harness.run();
    harness.get_by_label("Delete what is selected").click();
    harness.run();
    assert_eq!(harness.state().document.project().constraints, [before]);
}

#[test]
fn the_eye_and_solo_of_a_caustic_change_the_window_and_not_the_project() {
    let project = support::example("bottles");
    let mut harness = panel_harness(project.clone(), Panel::Caustics);
    harness.get_by_label("Hide: white").click();
    harness.run();
    assert!(!harness.state().session.shows_group(1));
    harness.get_by_label("Solo: blue").click();
    harness.run();
    assert!(harness.state().session.shows_group(2) && !harness.state().session.shows_group(0));
    assert_eq!(**harness.state().document.project(), project);
}

#[test]
fn a_caustic_of_a_key_frame_takes_a_colour_and_forgets_it_again() {
    let mut harness = panel_harness(support::example("bottles"), Panel::Caustics);
    harness.state_mut().session.focus.caustic = Some(0);
    harness.state_mut().session.focus.key = Some(0);
    harness.run();
    let slider = |harness: &PanelHarness, value| {
        harness.get_by_role_and_label(Role::Slider, "Brightness").set_value_accesskit(value);
    };
    slider(&harness, 2.0);
    harness.run();
    assert_eq!(harness.state().document.project().keys[0].caustics["green"].brightness, 2.0);
    slider(&harness, 1.0);
    harness.run();
    assert!(harness.state().document.project().keys[0].caustics.is_empty());
}

#[test]
fn a_mesh_becomes_glass_in_one_click() {
    let mut project = support::example("bottles");
    project.scene.as_mut().unwrap().meshes[0].material = None;
    let mut harness = panel_harness(project, Panel::Scene);
    harness.state_mut().session.focus.object = Some(SceneObject::Mesh(0));
    harness.run();
    harness.get_by_label("Assign glass").click();
    harness.run();
    let project: &Project = harness.state().document.project();
    let material = project.scene.as_ref().unwrap().meshes[0].material.as_ref();
    assert!(material.is_some_and(|material| material.is_specular()));
}

#[test]
fn a_project_keeps_one_format_at_least() {
    let mut harness = panel_harness(support::example("letters"), Panel::Render);
    for format in ["EXR", "PNG"] {
        harness.get_by_role_and_label(Role::CheckBox, format).click();
        harness.run();
    }
    assert_eq!(harness.state().document.project().output.formats.len(), 1);
}

#[test]
fn nothing_is_wider_than_the_panel() {
    for (name, project) in examples() {
        for (entry, focus) in focused(&project) {
            let mut harness = panel_harness(project.clone(), entry.panel);
            harness.state_mut().session.focus = focus;
            harness.state_mut().session.selection = Selection::all(0..project.constraints.len());
            harness.run();
            // Tables of the tree itself stand nowhere.
            let beyond = |node: &egui_kittest::Node| {
                node.accesskit_node().raw_bounds().is_some_and(|bounds| bounds.x1 > f64::from(support::WIDTH))
            };
            let wide = harness.root().children_recursive().find(beyond);
            assert!(wide.is_none(), "{name}, {}: {wide:?}", entry.name);
        }
    }
}

/// To look at: `cargo test --release --test editor panels -- --ignored` writes pictures of all panels to `target/panels`.
#[test]
#[ignore = "writes pictures, which only an eye can judge"]
fn pictures_of_every_panel() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("target/panels");
    std::fs::create_dir_all(&folder).unwrap();
    for (theme, shade) in [(egui::Theme::Dark, "dark"), (egui::Theme::Light, "light")] {
        for name in ["bottles", "rabbit_fine", "letters"] {
            let project = support::example(name);
            for (entry, focus) in focused(&project) {
                let mut harness = support::panel_harness_in(project.clone(), entry.panel, theme);
                harness.state_mut().session.focus = focus;
                harness.state_mut().session.selection = Selection::all(0..project.constraints.len());
                harness.run();
                for folded in ["Advanced", "Project", "Camera", "Receiver", "Sky"] {
                    if let Some(header) = harness.query_by_label(folded) {
                        header.click_accesskit();
                        harness.run();
                    }
                }
                let path = folder.join(format!("{name}_{}_{shade}.png", entry.name.to_lowercase()));
                harness.render().unwrap().save(path).unwrap();
            }
        }
    }
    let mut harness = panel_harness(support::example("rabbit_fine"), Panel::Flow);
    // Tooltips want more room than the panel.
    harness.set_size(egui::vec2(480.0, 640.0));
    for name in ["Gamma", "Alpha", "Beta", "Strength"] {
        harness.get_by_role_and_label(Role::Label, name).hover();
        harness.run_steps(8);
        harness.render().unwrap().save(folder.join(format!("tooltip_{}.png", name.to_lowercase()))).unwrap();
    }
}

#[test]
fn a_selected_point_is_moved_by_number_and_a_loop_stays_closed() {
    use lightloom_core::constraint::{Constraint, Wall};
    let corners = [[0.2, 0.2], [0.6, 0.2], [0.6, 0.6], [0.2, 0.2]];
    let project = Project {
        constraints: vec![Constraint::Wall(Wall::new(corners.to_vec()))],
        ..support::example("letters_free")
    };
    for (point, moved) in [(1, vec![1]), (0, vec![0, 3])] {
        let mut harness = panel_harness(project.clone(), Panel::Drawn);
        harness.state_mut().session.selection = Selection::point(0, point);
        harness.run();
        harness.get_by_role_and_label(Role::SpinButton, "Point x").set_value_accesskit(0.25);
        harness.run();
        let Edit::Change(changed) = last_edit(&harness) else { panic!("no change") };
        let mut expected = corners;
        moved.into_iter().for_each(|place| expected[place][0] = 0.25);
        assert_eq!(changed[0].1.points(), expected);
    }
}
