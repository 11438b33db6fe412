//! Groups of photons that share a flow.

use std::sync::Arc;

use crate::flow::SegmentFlow;

/// Groups that flow together.
#[derive(Clone, serde::Deserialize, serde::Serialize)]
pub(super) struct Layer {
    pub(super) groups: Vec<usize>,
    pub(super) flow: Arc<SegmentFlow>,
}
