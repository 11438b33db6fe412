//! Qualities: the limits of photons, cells and steps below the project's own numbers.
//!
//! Numbers of photons come from here and from the project alone. Two things may lower them further: point files with fewer
//! rows that are paired as given (`plan.rs`), and the memory of a live preview (`preview/mod.rs`).

use crate::constraint::Constraint;
use crate::matching::MatchingMethod;
use crate::project::Project;

/// The quality of a picture: a lower one is the same project with smaller numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quality {
    /// An answer while the hand still moves: 4000 photons, 32 cells, 12 steps.
    Draft,
    /// The quality to work with: 20 000 photons, 64 cells, 30 steps.
    Preview,
    /// The fields of the preview with 150 000 photons; 60 000 where walls stand, around which each finds its own path.
    Fine,
    /// As the project says.
    Final,
}

/// Upper limits of a quality.
struct Limits {
    photons: usize,
    /// Photons that fields are fitted to.
    guides: usize,
    /// Cells along each side of the field.
    cells: u32,
    steps: u32,
}

/// Most photons of a quality below the final one where walls stand.
const WALLED_PHOTONS: usize = 60_000;
/// Relative residual of the solver below the final quality: what is left shows on no screen.
const TOLERANCE: f32 = 1e-3;
/// Longest side of a picture below the final quality, pixels.
const SIDE: f64 = 480.0;
/// Widest kernel, plane units.
const WIDEST_KERNEL: f32 = 0.5;
/// Light paths per pixel of the background below the final quality.
const BACKGROUND_SAMPLES: u32 = 16;

impl Quality {
    /// The qualities of a live preview, the cheapest first.
    pub const LIVE: [Self; 3] = [Self::Draft, Self::Preview, Self::Fine];

    fn limits(self) -> Option<Limits> {
        match self {
            Self::Draft => Some(Limits { photons: 4_000, guides: 4_000, cells: 32, steps: 12 }),
            Self::Preview => Some(Limits { photons: 20_000, guides: 20_000, cells: 64, steps: 30 }),
            Self::Fine => Some(Limits { photons: 150_000, guides: 20_000, cells: 64, steps: 30 }),
            Self::Final => None,
        }
    }

    /// Most photons of one pass where no walls stand; none where the project's own number counts.
    pub fn photons(self) -> Option<usize> {
        self.limits().map(|limits| limits.photons)
    }

    /// Most anchors of a map around walls.
    pub(super) fn anchors(self) -> usize {
        match self {
            Self::Draft => 128,
            Self::Preview | Self::Fine => 512,
            Self::Final => crate::matching::ANCHORS,
        }
    }

    /// The quality at which photons of this one are matched, and fields fitted for them.
    pub(super) fn fitted_at(self) -> Self {
        if self == Self::Fine { Self::Preview } else { self }
    }

    /// The project with no more work in it than this quality is worth: one pass of a small picture below the final
    /// quality.
    pub fn apply(self, project: &Project) -> Project {
        let mut project = project.clone();
        let Some(limits) = self.limits() else { return project };
        let flow = &mut project.flow;
        flow.grid = flow.grid.at_most(limits.cells);
        flow.steps = flow.steps.min(limits.steps);
        // Photons that are all guides need no second way through the fields: their frames fall out of the fit.
        let all = self.fitted_at() == self;
        flow.guides = if all { limits.guides as u32 } else { flow.guides.min(limits.guides as u32) };
        flow.tolerance = flow.tolerance.max(TOLERANCE);
        let photons = limits.photons.min(walled_limit(&project));
        let render = &mut project.render;
        let shrink = (SIDE / f64::from(render.width.max(render.height).max(1))).min(1.0);
        let side = |pixels: u32| (f64::from(pixels) * shrink).round().max(f64::from(pixels.min(16))) as u32;
        (render.width, render.height) = (side(render.width), side(render.height));
        let fewer = render.photons.max(1) as f32 / render.photons.clamp(1, photons as u64) as f32;
        // A kernel chosen for more photons is widened until as many lie under it.
        render.radius = render.radius.map(|radius| (radius * fewer.sqrt()).min(WIDEST_KERNEL));
        render.photons = render.photons.min(photons as u64);
        render.passes = 1;
        render.background_samples = render.background_samples.min(BACKGROUND_SAMPLES);
        project
    }

    /// The photons of one pass of a project to which this quality was applied. Where rows are paired as given, their
    /// number is that of the files, up to the limit of the quality.
    pub(super) fn photons_of(self, project: &Project) -> usize {
        match project.matching {
            MatchingMethod::Given => {
                self.photons().map_or(usize::MAX, |most| most.min(walled_limit(project)))
            }
            MatchingMethod::Transport => usize::try_from(project.render.photons).unwrap_or(usize::MAX),
        }
    }
}

/// Most photons where walls stand; no limit elsewhere.
fn walled_limit(project: &Project) -> usize {
    let walled = project.fits() && project.constraints.iter().any(is_wall);
    if walled { WALLED_PHOTONS } else { usize::MAX }
}

fn is_wall(constraint: &Constraint) -> bool {
    constraint.is_enabled() && matches!(constraint, Constraint::Wall(_))
}
