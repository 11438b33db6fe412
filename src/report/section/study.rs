//! Grid resolution and gamma, side by side: one moment of the animation for each pair.

use super::super::chapter::{Chapter, Part, Picture, Pictures, Table, Tone};
use super::super::crop::{Crop, shrunk};
use super::super::workbench::Workbench;
use super::{Section, nothing_moves};
use lightloom_core::engine::{Halfway, MovingSegment, covered_area};
use lightloom_core::export::png::encode;
use lightloom_core::flow::{FlowSettings, GridSize, Movement};
use lightloom_core::project::Project;
use lightloom_core::render::density::{KernelFilter, default_radius};
use lightloom_core::render::splat::Splatter;
use lightloom_core::render::{Image, ReceiverTexture, TextureLayout, plane_image};
use lightloom_core::{Progress, Result};

pub(crate) const SECTION: Section =
    Section { name: "study", needless: nothing_moves, measure, seconds: [5.0, 50.0] };

/// Pixels side by side of a picture, at most.
const WIDTH: usize = 320;

/// How much is drawn.
struct Sheet {
    grids: &'static [u32],
    gammas: &'static [f32],
    photons: usize,
    /// Steps of the fit at most.
    steps: u32,
    /// Texels along the longer side of the plane.
    texels: usize,
}

const QUICK: Sheet =
    Sheet { grids: &[16, 64], gammas: &[0.0, 0.5, 1.0], photons: 10_000, steps: 12, texels: 384 };
const FULL: Sheet = Sheet {
    grids: &[16, 32, 64, 128],
    gammas: &[0.0, 0.25, 0.5, 0.75, 1.0],
    photons: 40_000,
    steps: 30,
    texels: 768,
};

/// One flow of the sheet.
struct Place {
    grid: u32,
    gamma: f32,
    /// Whether the project has it so.
    own: bool,
    still: Halfway,
}

fn measure(bench: &mut Workbench, progress: &Progress) -> Result<Chapter> {
    let sheet = bench.pick(QUICK, FULL);
    progress.begin("study", (sheet.grids.len() * sheet.gammas.len()) as u64);
    // The study is one of fields, whatever the project's method.
    let project = Project { method: Movement::Flow, ..bench.project.clone() };
    let segment = bench.engine.moving_segment(&project, Some(sheet.photons), &progress.inner())?;
    let places = sheet.fit(&segment, &bench.project, progress)?;
    let mut chapter = Chapter::new("study", "Grid resolution and gamma");
    chapter.say(format!(
        "The light halfway between the first two keys, by {} photons, for flows that differ in nothing but the grid \
         (rows) and gamma (columns). From left to right the light goes from streaming like a liquid, which keeps its \
         brightness and its lumps together, to spreading and gathering like a gas; from top to bottom the flow follows \
         finer detail. Where two rows look alike, the coarser grid does.",
        segment.flux().len()
    ));
    chapter.parts.push(Part::Pictures(sheet.pictures(&places, &segment, &bench.project)?));
    chapter.parts.push(Part::Table(table(&places)));
    Ok(chapter)
}

impl Sheet {
    /// All flows, row by row.
    fn fit(&self, segment: &MovingSegment, project: &Project, progress: &Progress) -> Result<Vec<Place>> {
        let mut places = Vec::new();
        for &grid in self.grids {
            for &gamma in self.gammas {
                let size = GridSize::Longer(grid);
                let steps = project.flow.steps.min(self.steps);
                let flow = FlowSettings { grid: size, gamma, steps, ..project.flow.clone() };
                let own = project.flow.grid == size && project.flow.gamma == gamma;
                places.push(Place { grid, gamma, own, still: segment.halfway(&flow, progress)? });
                progress.advance(1);
            }
        }
        Ok(places)
    }

    /// The light of all flows by one kernel, cut to where light is in any of them.
    fn pictures(&self, places: &[Place], segment: &MovingSegment, project: &Project) -> Result<Pictures> {
        let (extent, flux) = (segment.extent, segment.flux());
        let covered: f32 = places.iter().map(|place| covered_area(&place.still.positions, extent)).sum();
        let radius = default_radius(flux.len(), covered / places.len() as f32).min(0.5);
        let layout = TextureLayout::new(extent, self.texels, radius);
        let light = |place: &Place| {
            let mut texture = ReceiverTexture::new(layout);
            Splatter::default().splat(&place.still.positions, &flux, &mut texture);
            KernelFilter::default().filter(&mut texture, radius);
            plane_image(&texture, extent, segment.plane_material)
        };
        let lights: Vec<Image> = places.iter().map(light).collect();
        let all = lights.iter().cloned().reduce(|a, b| a.plus(&b));
        let crop = Crop::lit(&all.unwrap_or_else(|| Image::new(1, 1)));
        let view = project.render.view.view();
        let picture = |(place, light): (&Place, &Image)| {
            let shown = view.apply(&shrunk(&crop.cut(light), WIDTH));
            let own = if place.own { ", as the project has it" } else { "" };
            let label = format!("grid {}, gamma {}{own}", place.grid, place.gamma);
            Ok(Picture { label, png: encode(&shown)? })
        };
        let caption = "The lit part of the plane, seen straight on.".to_owned();
        let pictures = places.iter().zip(&lights).map(picture).collect::<Result<_>>()?;
        Ok(Pictures { caption, columns: self.gammas.len(), pictures })
    }
}

fn table(places: &[Place]) -> Table {
    let columns =
        ["grid", "gamma", "seconds", "fit residual", "divergence", "curl", "dispersion", "peak speed"];
    let caption = "The same flows in numbers: seconds of the fit; the share of the guidance that the field leaves \
                   undone; divergence and curl where the photons are; how differently neighbours move; the fastest \
                   photons over the mean straight speed.";
    let mut table = Table::new("study", caption, &columns);
    for Place { grid, gamma, own, still, .. } in places {
        let report = &still.report;
        table.push(
            if *own { Tone::Marked } else { Tone::Plain },
            vec![
                (*grid as usize).into(),
                f64::from(*gamma).into(),
                still.seconds.into(),
                report.fit_residual.into(),
                report.divergence_rms.into(),
                report.curl_rms.into(),
                report.dispersion.into(),
                report.peak_speed_ratio.into(),
            ],
        );
    }
    table
}
