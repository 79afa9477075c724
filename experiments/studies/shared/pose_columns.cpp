#include "experiments/studies/shared/pose_columns.hpp"

namespace experiments {

using analysis::CaseKey;
using analysis::Columns;
using analysis::FrameMetrics;

const Columns<CaseKey>& pose_columns()
{
    static const Columns<CaseKey> columns = {{"body", &CaseKey::body, "", "name of the body"},
                                             {"motion", &CaseKey::motion, "", "twist, bend, or the name of a clip"},
                                             {"pose", &CaseKey::pose, "", "name of a pose in a clip"},
                                             {"angle_deg", &CaseKey::angle_deg, "deg", "angle of a joint that is twisted or bent"}};
    return columns;
}

const Columns<FrameMetrics>& volume_columns()
{
    static const Columns<FrameMetrics> columns = {
        {"volume_change_pct", &FrameMetrics::volume_change_pct, "%", "signed change of the whole volume"},
        {"volume_abs_change_pct", &FrameMetrics::volume_abs_change_pct, "%", "sum of the absolute changes of each tet"},
        {"inverted", &FrameMetrics::inverted_tets, "", "number of inverted tets"}};
    return columns;
}

}  // namespace experiments
