//! The parts of a flow that the project leaves out, and what they would cost.

use glam::Vec2;

use super::section_def::{SectionDef, nothing_moves};
use crate::content::{Cell, Section, Table, Tone};
use crate::context::Context;
use crate::stages::flow_seconds;
use lightloom_core::constraint::{ActiveLine, ActiveWall, DirectedLine, Wall, Window};
use lightloom_core::flow::{FitKind, FlowSettings, Segment, TurbulenceSettings};
use lightloom_core::{Progress, Result};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "left_out", skip: nothing_moves, measure, seconds: [8.0, 30.0] };

/// An optional part of a flow.
struct Optional {
    what: &'static str,
    /// Whether a flow lacks it.
    is_absent: fn(&Flow) -> bool,
    /// Adds it.
    add: fn(&mut Flow),
}

/// The settings and constraints of a flow.
#[derive(Clone)]
struct Flow {
    extent: Vec2,
    settings: FlowSettings,
    lines: Vec<ActiveLine>,
    walls: Vec<ActiveWall>,
}

const PARTS: [Optional; 4] = [
    Optional {
        what: "a directed line across the plane",
        is_absent: |flow| flow.lines.is_empty(),
        add: |flow| {
            let line = DirectedLine::new(across(flow.extent)).active(Window::ALWAYS, flow.extent);
            flow.lines = line.into_iter().collect();
        },
    },
    Optional {
        what: "a wall across half of the plane",
        is_absent: |flow| flow.walls.is_empty(),
        add: |flow| {
            let wall = Wall::new(across(0.5 * flow.extent)).active(Window::ALWAYS);
            flow.walls = wall.into_iter().collect();
        },
    },
    Optional {
        what: "turbulence of strength 20",
        is_absent: |flow| flow.settings.turbulence.is_none(),
        add: |flow| flow.settings.turbulence = Some(TurbulenceSettings::default()),
    },
    Optional {
        what: "both potentials at once (gamma 0.5, joint)",
        is_absent: |flow| flow.settings.fit == FitKind::Separate || [0.0, 1.0].contains(&flow.settings.gamma),
        add: |flow| (flow.settings.gamma, flow.settings.fit) = (0.5, FitKind::Joint),
    },
];

/// A horizontal line at 2/5 of the height, where hardly a photon lies exactly.
fn across(extent: Vec2) -> Vec<[f32; 2]> {
    vec![[0.1 * extent.x, 0.4 * extent.y], [0.9 * extent.x, 0.4 * extent.y]]
}

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    progress.begin("left_out", PARTS.len() as u64);
    let photons = context.moving_segment(progress)?;
    let seconds = |Flow { settings, lines, walls, .. }: &Flow| {
        let segment = Segment { lines, walls, ..photons.segment(settings) };
        flow_seconds(context.effort.pick(2, 3), &segment, progress)
    };
    let own = Flow {
        extent: photons.extent,
        settings: context.project.flow.clone(),
        lines: photons.lines.clone(),
        walls: photons.walls.clone(),
    };
    let without = seconds(&own)?;
    let caption = format!(
        "Seconds of the flow from the first key ({} photons at most guide it): as the project has it, and with one part \
         more. What is absent costs nothing.",
        own.settings.guides
    );
    let columns = ["part", "seconds without", "seconds with", "ratio", "why absent"];
    let mut table = Table::new("left_out", caption, &columns);
    for part in &PARTS {
        if (part.is_absent)(&own) {
            let mut flow = own.clone();
            (part.add)(&mut flow);
            let with = seconds(&flow)?;
            let numbers = [without, with, with / without].map(Cell::from);
            let cells = [part.what.into()].into_iter().chain(numbers).chain(["not in the project".into()]);
            table.push(Tone::Plain, cells.collect());
        }
        progress.advance(1);
    }
    for left in context.engine.check(&context.project)?.plan.left_out {
        let cells = [left.what.into(), Cell::Nothing, Cell::Nothing, Cell::Nothing, left.why.into()];
        table.push(Tone::Plain, cells.to_vec());
    }
    let mut section = Section::new("left_out", "What was left out");
    section.table(table);
    Ok(section)
}
