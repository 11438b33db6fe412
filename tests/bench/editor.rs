//! What an artist waits for: `cargo bench --bench editor`, or with `-- bottles wall` a part of it. From an edit to the first new picture under the playhead, all
//! frames of the preview, and what a frame of the window costs its own thread while the workers work.
//!
//! The window runs without a screen: layout, gestures, actions and tessellation are in the figures, what a graphics card
//! or its substitute draws is not.

#[path = "../window/mod.rs"]
mod window;

use std::time::{Duration, Instant};

use egui_kittest::Harness;
use lightloom::editor::App;
use lightloom::editor::action::Action;
use lightloom::editor::document::Edit;
use lightloom::editor::preview::State;
use lightloom_core::constraint::{Constraint, Wall};
use lightloom_core::project::Project;

const EDITS: usize = 50;
const FRAME: Duration = Duration::from_millis(8);

fn main() {
    // Cargo asks benchmarks for their list, too.
    if std::env::args().any(|arg| arg == "--list") {
        return;
    }
    if asked("letters_free", "typing") {
        let told = typing("letters_free");
        println!("{told}");
    }
    for name in ["letters_free", "dark_glass", "bottles"] {
        measure(name, "gamma", |project, i| {
            let mut flow = project.flow.clone();
            flow.gamma = (i % 10) as f32 / 10.0 + 0.05;
            Edit::Flow(flow)
        });
        // The project's own walls and one that moves; then four more, so that light finds few straight ways.
        for (what, more) in [("wall", 0), ("walls", 4)] {
            let mut own = None;
            measure(name, what, |project, i| {
                let own = own.get_or_insert_with(|| project.constraints.clone());
                let wall = |x: f32| Constraint::Wall(Wall::new(vec![[x, 0.2], [x + 0.1, 0.5]]));
                let x = 0.3 + 0.4 * i as f32 / EDITS as f32;
                let more = (0..more).map(|j| 0.3 + 0.008 * j as f32);
                let constraints = own.iter().cloned().chain(more.chain([x]).map(wall)).collect();
                Edit::Constraints(constraints)
            });
        }
    }
}

/// Whether each word on the command line is one of these.
fn asked(name: &str, what: &str) -> bool {
    std::env::args()
        .skip(1)
        .filter(|arg| !arg.starts_with('-'))
        .all(|arg| [name, what].contains(&arg.as_str()))
}

/// Edits one after the other, half a second apart: the work of the last is still going on.
fn measure(name: &str, what: &str, mut edit: impl FnMut(&Project, usize) -> Edit) {
    if !asked(name, what) {
        return;
    }
    let folder = window::examples();
    let mut harness = window::window(&folder, name, Vec::new());
    window::until(&mut harness, "all light", is_fine);
    let middle = harness.state().document().project().keys.iter().map(|key| key.frame).sum::<i32>() / 2;
    harness.state_mut().ask(Action::Playhead(middle));
    window::until(&mut harness, "rest", is_fine);
    let (mut first, mut all) = (Vec::new(), Vec::new());
    for i in 0..EDITS {
        let painted = harness.state().preview().painted().number;
        let change = edit(harness.state().document().project(), i);
        let begun = Instant::now();
        harness.state_mut().ask(Action::Edit(change));
        harness.step();
        let seen = |app: &App| app.preview().is_current() && app.preview().painted().number > painted;
        frames_until(&mut harness, seen);
        first.push(begun.elapsed());
        let pause = Instant::now();
        frames_until(&mut harness, |_| pause.elapsed() >= Duration::from_millis(500));
        // All frames at the preview's own quality, in a few of the runs: it is long.
        if i % 10 == 0 {
            window::until(&mut harness, "rest", is_fine);
            let change = edit(harness.state().document().project(), i + 5);
            let begun = Instant::now();
            harness.state_mut().ask(Action::Edit(change));
            harness.step();
            frames_until(&mut harness, |app| all_are(app, State::Preview));
            all.push(begun.elapsed());
            window::until(&mut harness, "rest", is_fine);
        }
    }
    println!("{name}, {what}: first picture {}; all frames {}", told(first), told(all));
}

/// Frames of the window at the pace of a fast screen: more of them would take the processor from the workers.
fn frames_until(harness: &mut Harness<App>, holds: impl Fn(&App) -> bool) {
    while !holds(harness.state()) {
        let begun = Instant::now();
        harness.step();
        std::thread::sleep(FRAME.saturating_sub(begun.elapsed()));
    }
}

/// A slider is dragged for a while: an edit in every frame of the window.
fn typing(name: &str) -> String {
    let folder = window::examples();
    let mut harness = window::window(&folder, name, Vec::new());
    window::until(&mut harness, "light", is_fine);
    let (mut frames, begun, mut i) = (Vec::new(), Instant::now(), 0);
    let (mut pictures, mut last) = (0, harness.state().preview().painted().number);
    while begun.elapsed() < Duration::from_secs(60) {
        let mut flow = harness.state().document().project().flow.clone();
        flow.gamma = (i % 97) as f32 / 96.0;
        harness.state_mut().ask(Action::Edit(Edit::Flow(flow)));
        i += 1;
        let frame = Instant::now();
        harness.step();
        frames.push(frame.elapsed());
        let number = harness.state().preview().painted().number;
        pictures += usize::from(number != last);
        last = number;
        std::thread::sleep(Duration::from_millis(16).saturating_sub(frames[frames.len() - 1]));
    }
    let long = frames.iter().filter(|frame| frame.as_millis() > 50).count();
    format!(
        "{name}, a minute of edits, one in each frame of the window: {pictures} pictures; the window's own time {}; {long} of {} over 50 ms",
        told(frames.clone()),
        frames.len()
    )
}

fn is_fine(app: &App) -> bool {
    all_are(app, State::Fine)
}

fn all_are(app: &App, state: State) -> bool {
    let keys = &app.document().project().keys;
    let mut frames = keys.first().map_or(0, |key| key.frame)..=keys.last().map_or(0, |key| key.frame);
    frames.all(|frame| app.preview().coverage().of(frame) >= state)
}

fn told(mut times: Vec<Duration>) -> String {
    times.sort();
    let ms = |time: Option<&Duration>| time.map_or(0.0, |time| time.as_secs_f64() * 1e3);
    format!("median {:.1} ms, worst {:.1} ms", ms(times.get(times.len() / 2)), ms(times.last()))
}
