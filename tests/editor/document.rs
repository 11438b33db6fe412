//! The document: whatever was done can be undone, to the byte.

use crate::window;

use std::fs;

use lightloom::editor::document::{Document, Edit, STEPS};
use lightloom_core::constraint::{Constraint, DirectedLine, Wall};
use lightloom_core::flow::MotionMethod;
use lightloom_core::project::Project;
use proptest::prelude::*;

/// Something a user does, with a number to choose by.
#[derive(Clone, Debug)]
enum Step {
    Gamma(f32),
    Exposure(f32),
    Line(f32, f32),
    Wall(f32, f32),
    Remove(usize),
    Rename(String),
    Retime(i32),
    Method(bool),
    Settle,
    Undo,
    Redo,
}

fn steps_taken() -> impl Strategy<Value = Vec<Step>> {
    let step = prop_oneof![
        (-0.5_f32..1.5).prop_map(Step::Gamma),
        (-3.0_f32..3.0).prop_map(Step::Exposure),
        (0.0_f32..1.0, 0.0_f32..1.0).prop_map(|(x, y)| Step::Line(x, y)),
        (0.0_f32..1.0, 0.0_f32..1.0).prop_map(|(x, y)| Step::Wall(x, y)),
        (0_usize..6).prop_map(Step::Remove),
        "[a-zA-Z ]{0,12}".prop_map(Step::Rename),
        (-20_i32..200).prop_map(Step::Retime),
        any::<bool>().prop_map(Step::Method),
        Just(Step::Settle),
        Just(Step::Settle),
        Just(Step::Undo),
        Just(Step::Redo),
    ];
    prop::collection::vec(step, 1..60)
}

/// The edit of a step; none for those that are no edit.
fn edit(step: &Step, project: &Project) -> Option<Edit> {
    Some(match step {
        Step::Gamma(gamma) => {
            let mut flow = project.flow.clone();
            flow.gamma = *gamma;
            Edit::Flow(flow)
        }
        Step::Exposure(exposure) => {
            let mut render = project.render.clone();
            render.view.exposure = *exposure;
            Edit::Render(render)
        }
        Step::Line(x, y) => {
            Edit::Add(vec![Constraint::DirectedLine(DirectedLine::new(vec![[*x, *y], [*y, *x]]))])
        }
        Step::Wall(x, y) => Edit::Add(vec![Constraint::Wall(Wall::new(vec![[*x, *y], [0.5, *x]]))]),
        Step::Remove(index) => Edit::Remove([*index].into()),
        Step::Rename(name) => Edit::Name(name.clone()),
        Step::Retime(frame) => {
            let mut keys = project.keys.clone();
            keys.last_mut()?.frame = *frame;
            Edit::Keys(keys)
        }
        Step::Method(linear) => Edit::Method(if *linear { MotionMethod::Linear } else { MotionMethod::Flow }),
        Step::Settle | Step::Undo | Step::Redo => return None,
    })
}

fn text(document: &mut Document) -> String {
    let project = document.project().clone();
    document.file().unwrap().text_of(&project).unwrap()
}

proptest! {
    #[test]
    fn undo_after_anything_leads_back_to_the_bytes_of_the_file(steps_taken in steps_taken()) {
        let examples = window::examples();
        let path = window::project(&examples, "bottles");
        let bytes = fs::read_to_string(&path).unwrap();
        let mut document = window::document(&path);
        for step in &steps_taken {
            match (step, edit(step, document.project())) {
                // What cannot be is refused and changes nothing.
                (_, Some(edit)) => {
                    let before = document.project().clone();
                    if document.edit(edit).is_err() {
                        prop_assert_eq!(&before, document.project());
                    }
                }
                (Step::Undo, None) => document.undo(),
                (Step::Redo, None) => document.redo(),
                _ => document.settle(),
            }
            prop_assert!(document.project().check().is_ok());
        }
        let end = text(&mut document);
        let mut steps = 0;
        while document.history().undoes().is_some() {
            document.undo();
            steps += 1;
        }
        prop_assert_eq!(text(&mut document), bytes);
        prop_assert!(!document.is_unsaved());
        // And forth again, as far as it was.
        for _ in 0..steps {
            document.redo();
        }
        prop_assert_eq!(text(&mut document), end);
    }
}

#[test]
fn one_gesture_is_one_step_and_an_abort_leaves_none() {
    let examples = window::examples();
    let mut document = window::document(&window::project(&examples, "letters_free"));
    let gamma = |document: &mut Document, gamma: f32| {
        let mut flow = document.project().flow.clone();
        flow.gamma = gamma;
        document.edit(Edit::Flow(flow)).unwrap();
    };
    for i in 0..10 {
        gamma(&mut document, i as f32 / 10.0);
    }
    document.settle();
    document.undo();
    assert_eq!(document.project().flow.gamma, 0.25);
    assert!(document.history().undoes().is_none());
    gamma(&mut document, 0.9);
    document.abort();
    assert_eq!(document.project().flow.gamma, 0.25);
    assert!(document.history().undoes().is_none());
}

#[test]
fn at_least_two_hundred_steps_can_be_undone() {
    let examples = window::examples();
    let mut document = window::document(&window::project(&examples, "letters_free"));
    for i in 0..STEPS + 50 {
        document.edit(Edit::Name(format!("name {i}"))).unwrap();
        document.settle();
    }
    let mut steps = 0;
    while document.history().undoes().is_some() {
        document.undo();
        steps += 1;
    }
    assert_eq!(steps, STEPS);
    assert_eq!(document.project().name, "name 49");
}
