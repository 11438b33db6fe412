//! Pictures of one moment of the animation for pairs of grid resolution and gamma.

use super::section_def::{SectionDef, nothing_moves};
use crate::content::{Picture, Pictures, Section, Table, Tone};
use crate::context::Context;
use crate::crop::{Crop, shrunk};
use lightloom_core::engine::{Halfway, MovingSegment, covered_area};
use lightloom_core::export::png::encode;
use lightloom_core::flow::{FlowSettings, GridSize};
use lightloom_core::project::Project;
use lightloom_core::render::density::{KernelFilter, default_radius};
use lightloom_core::render::splat::Splatter;
use lightloom_core::render::{Image, ReceiverTexture, TextureLayout, plane_image};
use lightloom_core::{Progress, Result};

pub(super) const SECTION: SectionDef =
    SectionDef { name: "study", skip: nothing_moves, measure, seconds: [5.0, 50.0] };

/// Largest width of a picture in pixels.
const WIDTH: usize = 320;

/// The amount of work.
struct Sheet {
    grids: &'static [u32],
    gammas: &'static [f32],
    photons: usize,
    /// Most steps of the fit.
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

/// A flow of the sheet.
struct Place {
    grid: u32,
    gamma: f32,
    /// Whether it is the project's own.
    own: bool,
    halfway: Halfway,
}

fn measure(context: &mut Context, progress: &Progress) -> Result<Section> {
    let sheet = context.effort.pick(QUICK, FULL);
    progress.begin("study", (sheet.grids.len() * sheet.gammas.len()) as u64);
    let segment = context.flow_photons(sheet.photons, progress)?;
    let places = sheet.fit(&segment, &context.project, progress)?;
    let mut section = Section::new("study", "Grid resolution and gamma");
    section.text(format!(
        "The light halfway between the first two keys, by {} photons, for flows that differ in nothing but the grid \
         (rows) and gamma (columns). From left to right the light goes from streaming like a liquid, which keeps its \
         brightness and its lumps together, to spreading and gathering like a gas; from top to bottom the flow follows \
         finer detail. Where two rows look alike, the coarser grid does.",
        segment.flux().len()
    ));
    section.pictures(sheet.pictures(&places, &segment, &context.project)?);
    section.table(table(&places));
    Ok(section)
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
                places.push(Place { grid, gamma, own, halfway: segment.halfway(&flow, progress)? });
                progress.advance(1);
            }
        }
        Ok(places)
    }

    /// The light of all flows by one kernel, cropped to the part that is lit in any of them.
    fn pictures(&self, places: &[Place], segment: &MovingSegment, project: &Project) -> Result<Pictures> {
        let (extent, flux) = (segment.extent, segment.flux());
        let covered: f32 = places.iter().map(|place| covered_area(&place.halfway.positions, extent)).sum();
        let radius = default_radius(flux.len(), covered / places.len() as f32).min(0.5);
        let layout = TextureLayout::new(extent, self.texels, radius);
        let light = |place: &Place| {
            let mut texture = ReceiverTexture::new(layout);
            Splatter::default().splat(&place.halfway.positions, &flux, &mut texture);
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
    for Place { grid, gamma, own, halfway, .. } in places {
        let report = &halfway.report;
        table.push(
            if *own { Tone::Marked } else { Tone::Plain },
            vec![
                (*grid as usize).into(),
                f64::from(*gamma).into(),
                halfway.seconds.into(),
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
