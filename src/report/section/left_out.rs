//! What the project did not need, and what it would have cost.

use glam::Vec2;

use super::super::chapter::{Cell, Chapter, Part, Table, Tone};
use super::super::workbench::Workbench;
use super::stage::fit_seconds;
use super::{Section, nothing_moves};
use lightloom_core::constraint::{ActiveLine, ActiveWall, DirectedLine, Wall, Window};
use lightloom_core::engine::MovingSegment;
use lightloom_core::flow::{FitKind, FlowSettings, Segment, TurbulenceSettings};
use lightloom_core::{Progress, Result};

pub(crate) const SECTION: Section =
    Section { name: "left_out", needless: nothing_moves, measure, seconds: [8.0, 30.0] };

/// A part of the flow that can be absent.
struct Optional {
    what: &'static str,
    /// Whether the project does without it.
    absent: fn(&MovingSegment, &FlowSettings) -> bool,
    /// The same flow with it.
    with: fn(&MovingSegment, FlowSettings) -> Changed,
}

/// A flow with one part more.
struct Changed {
    settings: FlowSettings,
    lines: Vec<ActiveLine>,
    walls: Vec<ActiveWall>,
}

const PARTS: [Optional; 4] = [
    Optional {
        what: "a directed line across the plane",
        absent: |photons, _| photons.lines.is_empty(),
        with: |photons, settings| {
            let line = DirectedLine::new(across(photons.extent)).active(Window::ALWAYS, photons.extent);
            Changed { settings, lines: line.into_iter().collect(), walls: photons.walls.clone() }
        },
    },
    Optional {
        what: "a wall across half of the plane",
        absent: |photons, _| photons.walls.is_empty(),
        with: |photons, settings| {
            let wall = Wall::new(across(0.5 * photons.extent)).active(Window::ALWAYS);
            Changed { settings, lines: photons.lines.clone(), walls: wall.into_iter().collect() }
        },
    },
    Optional {
        what: "turbulence of strength 20",
        absent: |_, settings| settings.turbulence.is_none(),
        with: |photons, settings| {
            let turbulence = Some(TurbulenceSettings::default());
            let (lines, walls) = (photons.lines.clone(), photons.walls.clone());
            Changed { settings: FlowSettings { turbulence, ..settings }, lines, walls }
        },
    },
    Optional {
        what: "both potentials at once (gamma 0.5, joint)",
        absent: |_, settings| settings.fit == FitKind::Separate || [0.0, 1.0].contains(&settings.gamma),
        with: |photons, settings| {
            let (lines, walls) = (photons.lines.clone(), photons.walls.clone());
            Changed { settings: FlowSettings { gamma: 0.5, fit: FitKind::Joint, ..settings }, lines, walls }
        },
    },
];

/// Two points on the level of 2/5 of the plane, where seldom a photon sits exactly.
fn across(extent: Vec2) -> Vec<[f32; 2]> {
    vec![[0.1 * extent.x, 0.4 * extent.y], [0.9 * extent.x, 0.4 * extent.y]]
}

fn measure(bench: &mut Workbench, progress: &Progress) -> Result<Chapter> {
    progress.begin("left_out", 1 + PARTS.len() as u64);
    let photons = bench.first_move(progress)?;
    let settings = &bench.project.flow;
    let seconds = |course: &Segment| fit_seconds(bench.pick(2, 3), course, progress);
    let plain = seconds(&photons.segment(settings))?;
    progress.advance(1);
    let caption = format!(
        "Seconds of the flow from the first key ({} photons at most guide it): as the project has it, and with one part \
         more. What is absent costs nothing.",
        settings.guides
    );
    let mut table =
        Table::new("left_out", caption, &["part", "seconds without", "seconds with", "ratio", "why absent"]);
    for part in &PARTS {
        if (part.absent)(&photons, settings) {
            let Changed { settings, lines, walls } = (part.with)(&photons, settings.clone());
            let with = seconds(&Segment { lines: &lines, walls: &walls, ..photons.segment(&settings) })?;
            let ratio = with / plain;
            table.push(
                Tone::Plain,
                vec![part.what.into(), plain.into(), with.into(), ratio.into(), "not in the project".into()],
            );
        }
        progress.advance(1);
    }
    for left in bench.engine.check(&bench.project)?.plan.left_out {
        let nothing = || Cell::Nothing;
        table.push(Tone::Plain, vec![left.what.into(), nothing(), nothing(), nothing(), left.why.into()]);
    }
    let mut chapter = Chapter::new("left_out", "What was left out");
    chapter.parts.push(Part::Table(table));
    Ok(chapter)
}
