// Values that a study measured for a claim, with their intervals, and their comparison with the claim's bound.
//   for (const Measurement& measured : measurements("measurements.csv")) ...
#pragma once

#include "analysis/statistics/statistics.hpp"
#include "analysis/verdicts/case_record.hpp"
#include "analysis/verdicts/claims.hpp"

#include <string>
#include <vector>

namespace analysis {

// One case measured with one metric and compared with a claim's bound: the frames that hold, their share and mean with intervals, the
// angles, and the worst frames.
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

// The rows of the file `csv`: claim, quantity, the fields of the key, value, low, high and unit. The columns limit, n and not_reached exist
// if a row uses one of them. run is left empty. InputError as for read_csv, for a missing column, for a cell that is not a number, and for
// an unknown limit.
std::vector<Measurement> measurements(const std::string& csv);
CsvTable measurement_table(const std::vector<Measurement>& measurements);  // the table that measurements() reads; run is not part of it

// is_judged: the value is one of the claim's quantities, and its key agrees with claim.of. is_control: one of the quantities with another
// key.
bool is_judged(const Claim& claim, const Measurement& measured);
bool is_control(const Claim& claim, const Measurement& measured);

QuantityBound bound_of(const Claim& claim, const std::string& quantity);  // from claim.bounds, otherwise the claim's low and high

// whole: the interval lies within the claim's bound on the quantity; part: only the value does; none: the value does not, or is not a
// number.
Extent extent_of(const Claim& claim, const Measurement& measured);

std::string bound_text(const QuantityBound& bound);  // 0.9 to 1.1; 30 or more

}  // namespace analysis
