//! The numbers of a flow, and notes on it.

use serde::Serialize;

use super::pairing::TransportCost;
use crate::Note;
use crate::flow::{FlowReport, FlowSettings};
use crate::note::About;

/// The numbers of the flow, the worst over all segments.
#[derive(Clone, Debug, Serialize)]
pub struct FlowNumbers {
    /// The report of the fits.
    #[serde(flatten)]
    pub flow: FlowReport,
    /// Mean squared distance of the matching, plane units squared.
    pub transport_cost: f64,
    /// The same over a lower bound of the optimum; absent where rows are paired as given, and where the method has no
    /// transport map to tell one (a comparison takes that of the other methods).
    pub transport_cost_ratio: Option<f64>,
    /// Flux of all photons over the requested flux; the frame farthest from 1.
    pub flux_ratio: f64,
}

impl FlowNumbers {
    /// Of each layer of one segment.
    pub(super) fn of_segment(reports: Vec<FlowReport>, cost: &TransportCost) -> impl Iterator<Item = Self> {
        let (transport_cost, transport_cost_ratio) = (cost.mean(), cost.ratio(cost.bound));
        // Each layer has photons of its own, so those that walls shut off add up.
        let unreachable = reports.iter().map(|report| report.unreachable).sum();
        let of = move |flow| {
            let flow = FlowReport { unreachable, ..flow };
            Self { flow, transport_cost, transport_cost_ratio, flux_ratio: 1.0 }
        };
        reports.into_iter().map(of)
    }

    /// The worse of two in every number.
    pub(super) fn worst(self, other: Self) -> Self {
        let ratios = [self.transport_cost_ratio, other.transport_cost_ratio];
        Self {
            flow: self.flow.worst(&other.flow),
            transport_cost: self.transport_cost.max(other.transport_cost),
            transport_cost_ratio: ratios.into_iter().flatten().reduce(f64::max),
            flux_ratio: if (other.flux_ratio - 1.0).abs() > (self.flux_ratio - 1.0).abs() {
                other.flux_ratio
            } else {
                self.flux_ratio
            },
        }
    }
}

/// A note on photons that walls shut off from their targets.
pub(super) fn note_on_walls(flow: &FlowReport) -> Option<Note> {
    (flow.unreachable > 0).then(|| {
        About::Setting("constraints").note(format!(
            "walls shut {} photons off from their targets: these go straight through; leave a gap, or move the target",
            flow.unreachable
        ))
    })
}

/// A note on a solver that stopped above the tolerance of the project.
pub(super) fn note_on_solver(flow: &FlowReport, tolerance: f64) -> Option<Note> {
    (flow.solver_error > tolerance).then(|| {
        About::Setting(FlowSettings::ALPHA.place).note(format!(
            "the fit stopped after {} iterations with velocities that are {:.1e} off where {tolerance:.0e} is asked for: take a larger alpha, or a lower beta and weight of lines",
            flow.solver_iterations, flow.solver_error
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn photons_shut_off_add_up_over_the_layers_of_a_segment() {
        let reports = [2, 3].map(|unreachable| FlowReport { unreachable, ..FlowReport::default() }).to_vec();
        let numbers = FlowNumbers::of_segment(reports, &TransportCost::default()).reduce(FlowNumbers::worst);
        assert_eq!(numbers.map(|numbers| numbers.flow.unreachable), Some(5));
    }

    #[test]
    fn a_solver_that_gave_up_is_noted_and_one_that_arrived_is_not() {
        let flow = |solver_error| FlowReport { solver_error, ..FlowReport::default() };
        assert!(note_on_solver(&flow(1.5), 1e-4).is_some_and(|note| note.text.contains("1.5e0")));
        assert_eq!(note_on_solver(&flow(1e-4), 1e-4), None);
    }
}
