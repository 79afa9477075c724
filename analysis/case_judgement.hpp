// One case measured with one metric and compared with a claim's bound: the frames that hold, their share and mean with intervals, the
// angles, and the worst frames.
#pragma once

#include "analysis/bootstrap.hpp"
#include "analysis/case_record.hpp"
#include "analysis/claims.hpp"

namespace analysis {

// For how much of a case the claim holds, in rising order.
enum class Extent { none, part, whole };

// A range of a sweep; both ends are sampled angles.
struct AngleRange {
    double from_deg = 0.0, to_deg = 0.0;  // equal for a single frame
};

// A frame whose value lies outside the bound.
struct FailingFrame {
    double frame = 0.0, time_s = 0.0, angle_deg = 0.0, value = 0.0, inverted_tets = 0.0;  // value: the metric; angle_deg is NaN for clips
};

// A record without frames gives the extent none and values of 0.
struct CaseJudgement {
    std::string scene, deformer, variant, metric, run;  // as in the record; the metric by the name that the claim uses
    CaseKey of = {};                                    // body, motion, deformer and settings of the record
    ClaimRule rule = ClaimRule::share_within;           // share_within or mean_within
    int iterations = 0, frames = 0;                     // iterations per step, 0 if the deformer has none; number of frames judged
    bool sweep = false;                                 // true for a sweep of angles, false for a clip
    Extent extent = Extent::none;                       // given by the rule; see experiments/verdicts/claims.toml
    Interval mean;                       // mean of the metric over the frames; it has no bounds for a sweep, whose frames are not a sample
    Interval share;                      // share of the frames within the bound
    std::vector<AngleRange> angles;      // only for a sweep. share_within: up to the first failure; mean_within: wherever it holds
    double last_angle_deg = 0.0;         // last angle of a sweep
    double least = 0.0, most = 0.0;      // range of the metric; both are NaN if any frame is
    int holding_with_inverted_tets = 0;  // frames within the bound although tets are inverted
    // share_within: at most three, the farthest outside first; values that are not a number come before all others
    std::vector<FailingFrame> deepest;
};

// Uses the claim's low, high, share, part and level. InputError as for metric_series.
CaseJudgement judge_case(const Claim& claim, const CaseRecord& record, const std::string& metric);

}  // namespace analysis
