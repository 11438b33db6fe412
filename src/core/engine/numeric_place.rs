//! Where numbers fail: the segment and the frame of a numeric error.

use crate::project::Project;
use crate::{Error, Result};

/// The result, whose numeric error names segment `number` by its frames.
pub(super) fn in_segment<T>(result: Result<T>, project: &Project, number: usize) -> Result<T> {
    let frame = |key: usize| project.keys.get(key).map_or(0, |key| key.frame);
    let place = || format!("in segment {number}, frames {} to {}", frame(number), frame(number + 1));
    result.map_err(|error| placed(error, place))
}

/// The result, whose numeric error names a frame.
pub(super) fn at_frame<T>(result: Result<T>, frame: Option<i32>) -> Result<T> {
    match frame {
        Some(frame) => result.map_err(|error| placed(error, || format!("on the way to frame {frame}"))),
        None => result,
    }
}

/// The error with the place of what is numeric in it.
fn placed(error: Error, place: impl FnOnce() -> String) -> Error {
    match error {
        Error::Numeric { stage, what } => Error::Numeric { stage, what: format!("{what} ({})", place()) },
        Error::Noted { error, notes } => Error::Noted { error: Box::new(placed(*error, place)), notes },
        other => other,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use std::sync::Arc;

    use glam::Vec2;
    use serde_json::json;

    use crate::engine::fitted_segment::FittedSegment;
    use crate::engine::{Engine, PlanePasses};
    use crate::flow::fade::Fade;
    use crate::flow::field::{Field, Grid};
    use crate::flow::{Fields, SegmentFlow};
    use crate::project::{AssetFolder, Project};
    use crate::render::TextureLayout;
    use crate::{Error, Progress};

    /// A field with one coefficient that is no number, among good ones.
    fn poisoned() -> SegmentFlow {
        let grid = Grid { cells: [8, 8], extent: Vec2::ONE };
        let count = 11 * 11;
        let mut psi = vec![0.0; count];
        psi[count / 2] = f32::NAN;
        let field = Field::from_potentials(grid, &psi, &vec![0.0; count]);
        SegmentFlow::Fields(Fields::from_nodes(vec![field; 8], 8, Fade::default(), 0.1))
    }

    #[test]
    fn a_field_that_is_no_number_stops_the_render_with_segment_and_frame() {
        let folder = tempfile::tempdir().unwrap();
        let row = |x: f64, i: u32| format!("{},{}\n", x + 0.002 * f64::from(i), 0.3 + 0.004 * f64::from(i));
        for (name, x) in [("a.csv", 0.2), ("b.csv", 0.6)] {
            let rows: String = (0..100).map(|i| row(x, i)).collect();
            std::fs::write(folder.path().join(name), rows).unwrap();
        }
        let key = |frame, file| json!({ "frame": frame, "shows": { "points": { "file": file } } });
        let text = json!({
            "lightloom": 1, "method": "guided",
            "keys": [key(1, "a.csv"), key(11, "b.csv"), key(21, "a.csv")],
            "flow": { "grid": 8, "steps": 8 },
            "render": { "width": 16, "height": 16, "photons": 100, "passes": 1 }
        });
        let path = folder.path().join("test.json");
        let project = Project::parse(text.to_string().as_bytes(), &path).unwrap();
        let engine = Engine::new(AssetFolder::new(&path, false).unwrap());
        let mut fitted = engine.fitted(&project, &Progress::new()).unwrap();
        let good = fitted.flow.segments[1].clone();
        let mut layers = good.layers.clone();
        layers[0].flow = Arc::new(poisoned());
        let (maps, reports) = (good.maps.clone(), good.reports.clone());
        fitted.flow.segments[1] = Arc::new(FittedSegment { maps, layers, reports, cost: good.cost });
        let layout = TextureLayout::new(Vec2::ONE, 16, 0.1);
        let frames = vec![1, 6, 11, 16, 21];
        let plane =
            PlanePasses { photons: 100, passes: 1, seed: 1, radius: 0.05, shrinks: false, layout, frames };
        let mut passes = 0;
        let done = fitted.run(&plane, folder.path(), &Progress::new(), &mut |_| {
            passes += 1;
            Ok(())
        });
        let Err(Error::Numeric { stage: "advect", what }) = done else { panic!("{done:?}") };
        // Frame 11 is the begin of the segment, whose first step is taken at once.
        assert!(what.contains("to frame 11)") && what.contains("segment 1, frames 11 to 21"), "{what}");
        assert_eq!(passes, 0, "there is no picture of it");
    }
}
