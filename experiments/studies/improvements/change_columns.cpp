// The columns of points.csv.
#include "experiments/studies/improvements/measured_changes.hpp"
#include "experiments/studies/shared/posed_character.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace experiments {
namespace {

using analysis::Columns;
using analysis::within;

Columns<ChangePoint> distance_columns()
{
    Columns<ChangePoint> columns;
    for (std::size_t b = 0; b < budget_iterations.size(); ++b)
        columns.emplace_back(
            fmt::format("from_pbs_{}_pct", budget_iterations[b]), [b](auto& row) -> auto& { return row.distance_pct[b]; }, "%",
            fmt::format("distance from the baseline after {} iterations, at the joints outside the overlap", budget_iterations[b]));
    return columns;
}

}  // namespace

const Columns<ChangePoint> change_columns =
    within(&ChangePoint::of, pose_columns()) +
    Columns<ChangePoint>{{"change", &ChangePoint::change, "", "pbs, which is the baseline, or the name of a change to it"},
                         {"setting", &ChangePoint::setting, "", "value of the change's own parameter"},
                         {"iterations", &ChangePoint::iterations, "", "of Algorithm 1"},
                         {"outcome", &ChangePoint::outcome, "", "finished or not_finite"}} +
    within(&ChangePoint::ms, spread_columns("ms_median", "ms", "processor time per frame", {"_q1", "_q3"})) +
    Columns<ChangePoint>{{"error_joint_pct", &ChangePoint::error_joint_pct, "%", "error over the blended vertices outside the overlap"},
                         {"error_l2_pct", &ChangePoint::error_l2_pct, "%", "error over all vertices outside the overlap"}} +
    within(&ChangePoint::metrics, volume_columns()) + distance_columns() +
    Columns<ChangePoint>{
        {"reference", &ChangePoint::reference, "",
         "elements of the reference: quadratic or linear, _refined: on the tets cut into eight; or not_reached"},
        {"reference_error_joint_pct", &ChangePoint::reference_error_joint_pct, "%", "bound on the reference's own error, at the joints"},
        {"masked_share_pct", &ChangePoint::masked_share_pct, "%", "share of the volume that is left out because the body overlaps itself"}};

std::optional<double> ChangePoint::distance_from_baseline(int budget) const
{
    return distance_pct.at(std::ranges::find(budget_iterations, budget) - budget_iterations.begin());
}

}  // namespace experiments
