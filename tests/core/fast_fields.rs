//! Photons in fields that are faster than any photon has to be.

use glam::Vec2;
use lightloom_core::Progress;
use lightloom_core::flow::{
    Fade, FieldTrajectories, FitKind, FlowSettings, GridSize, Segment, Trajectories as _, fit_segment,
};

use crate::fit::photons;

/// A field of hardly any smoothness is fast between its photons: they leave it before they are.
#[test]
fn photons_keep_the_limit_of_the_fade_in_any_field() {
    let source: Vec<Vec2> = photons(300, Vec2::ONE).0.iter().map(|p| 0.3 + 0.3 * *p).collect();
    let target: Vec<Vec2> =
        source.iter().map(|p| Vec2::new(p.y, 1.0 - p.x) + 0.1 * (9.0 * *p).map(f32::sin)).collect();
    let mean = source.iter().zip(&target).map(|(a, b)| a.distance(*b)).sum::<f32>() / 300.0;
    for (alpha, fit) in [(1e-12, FitKind::Joint), (1e-8, FitKind::Joint), (1e-8, FitKind::Separate)] {
        let limit = 3.0;
        let fade = Fade::Smooth { start: 0.3, end: 0.9, limit };
        let settings = FlowSettings {
            alpha,
            fade,
            fit,
            grid: GridSize::Longer(64),
            steps: 40,
            ..FlowSettings::default()
        };
        let segment = Segment::new(&source, &target, Vec2::ONE, &settings);
        let (fields, report) = fit_segment(&segment, &Progress::new()).unwrap();
        let longest = source.iter().zip(&target).map(|(a, b)| a.distance(*b)).fold(0.0, f32::max);
        // The limit is the larger of 3 mean ways and 1.5 of one's own; within a step it may be passed by a little.
        let most = 1.1 * (limit * mean).max(1.5 * longest);
        assert!(report.peak_speed_ratio * f64::from(mean) < f64::from(most), "{alpha}: {report:?}");
        // Photons of a later pass come to places between those that the field was fitted to.
        let beside: Vec<Vec2> = source.iter().map(|p| *p + 0.004).collect();
        let mut carrier = FieldTrajectories::new(&fields, &beside, &target);
        let (mut before, mut now) = (beside.clone(), beside.clone());
        for n in 1..=400 {
            carrier.positions_at(f64::from(n) / 400.0, &mut now, &Progress::new()).unwrap();
            let fastest = now.iter().zip(&before).map(|(a, b)| 400.0 * a.distance(*b)).fold(0.0, f32::max);
            assert!(fastest < most, "{alpha}: {fastest} of {most} at {n}");
            before.clone_from(&now);
        }
    }
}
