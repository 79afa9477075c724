// One case under one metric against a claim's bound: which frames hold, their share and mean with intervals, the angles, the worst frames.
#pragma once

#include "analysis/bootstrap.hpp"
#include "analysis/case_record.hpp"
#include "analysis/claims.hpp"

namespace analysis {

// Of a case, for how much of it the claim holds; in rising order.
enum class Extent { none, part, whole };

// Of a sweep, both ends among the angles that were sampled.
struct AngleRange {
    double from_deg = 0.0, to_deg = 0.0;  // equal for a single frame
};

// A frame outside the bound.
struct FailingFrame {
    double frame = 0.0, time_s = 0.0, angle_deg = 0.0, value = 0.0, inverted_tets = 0.0;  // value: of the metric; angle_deg NaN for clips
};

// A record without frames gives extent none and values of 0.
struct CaseJudgement {
    std::string scene, deformer, variant, metric, run;  // as in the record; the metric as the claim names it
    CaseKey of = {};                                    // body, motion, deformer and settings of the record
    ClaimRule rule = ClaimRule::share_within;           // share_within or mean_within
    int iterations = 0, frames = 0;                     // iterations a step, 0: the deformer has none; frames judged
    bool sweep = false;                                 // of angles, not a clip
    Extent extent = Extent::none;                       // by the rule, see experiments/verdicts/claims.toml
    Interval mean;                                      // of the metric over the frames; a sweep's frames are no sample and have no bounds
    Interval share;                                     // of frames within the bound
    std::vector<AngleRange> angles;                     // of a sweep: share_within up to the first failure, mean_within wherever it holds
    double last_angle_deg = 0.0;                        // of a sweep
    double least = 0.0, most = 0.0;                     // of the metric; both NaN where a frame is
    int holding_with_inverted_tets = 0;                 // frames within the bound although tets are inverted
    std::vector<FailingFrame> deepest;  // share_within: at most three, farthest outside first; what is not a number before all
};

// By the claim's low, high, share, part and level. InputError as metric_series.
CaseJudgement judge_case(const Claim& claim, const CaseRecord& record, const std::string& metric);

}  // namespace analysis
