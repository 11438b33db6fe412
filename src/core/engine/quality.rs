//! Two named qualities of the same settings: the preview is the final render with smaller numbers.

use crate::project::Project;

/// How much work a picture is worth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quality {
    /// An answer at once: few photons, a coarse grid, one pass, a small picture.
    Preview,
    /// As the project says.
    Final,
}

impl Quality {
    /// The project with no more work in it than this quality is worth.
    pub fn apply(self, project: &Project) -> Project {
        let mut project = project.clone();
        if self == Self::Preview {
            let flow = &mut project.flow;
            flow.grid = flow.grid.at_most(64);
            flow.steps = flow.steps.min(30);
            flow.guides = flow.guides.min(20_000);
            let render = &mut project.render;
            let shrink = (480.0 / f64::from(render.width.max(render.height).max(1))).min(1.0);
            let side =
                |pixels: u32| (f64::from(pixels) * shrink).round().max(f64::from(pixels.min(16))) as u32;
            (render.width, render.height) = (side(render.width), side(render.height));
            render.photons = render.photons.min(50_000);
            render.passes = 1;
            render.background_samples = render.background_samples.min(16);
        }
        project
    }
}
