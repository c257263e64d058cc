//! The two kinds of edges as executable steps, made in the way that the strategy wants.

use crate::decompose::{decompose, halve};
use crate::meet;
use crate::session::Work;
use crate::steps::transfer_then_regrasp;
use regrasp_api::{CallError, Configuration, Connection, Decomposition, EdgeKind, SearchPolicy};
use regrasp_plan::Segment;

/// Executable steps from one configuration to another along an edge of this kind; `None` if there are none.
pub(crate) fn joined(
    work: &mut Work<'_>,
    (kind, policy): (EdgeKind, &SearchPolicy),
    from: &Configuration,
    to: &Configuration,
) -> Result<Option<Vec<Segment>>, CallError> {
    match (kind, policy.decomposition, policy.connection) {
        (EdgeKind::Grasp, Decomposition::Halving, _) => halve(work, from, to),
        (EdgeKind::Grasp, ..) => decompose(work, from, to),
        (EdgeKind::TransferRegrasp, _, Connection::OneEnd) => transfer_then_regrasp(work, from, to),
        (EdgeKind::TransferRegrasp, ..) => meet::connect(work, from, to),
    }
}
