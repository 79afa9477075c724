// orders.csv and targets.csv: what each order gives after the paper's 24 iterations and in the limit, and when it first reaches a target.
//   const std::vector<TargetRow> rows = target_rows(of.of, measured);
// A target is a residual or an absolute volume change: those that `plain` has after 24 iterations in file order in the same precision, and
// the paper's 0.5 % and 2 %. It is reached at the first iteration at which the value is not above it. Up to the 64th, every iteration is
// looked at, then steps of two per cent. Where an order does not reach a target within all iterations, the record states the limit, which
// lies above the bound.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/studies/equal_quality/equal_quality.hpp"

#include <optional>

namespace experiments {

const analysis::Columns<analysis::CaseKey>& order_key_columns();  // body, motion, pose, angle_deg, order, precision

struct OrderRow {
    analysis::CaseKey of;  // body, motion, angle or pose, order, precision
    std::string sequence;
    Spread ms_iteration;
    double residual_24 = 0.0, volume_abs_change_24_pct = 0.0;        // after 24 iterations; residual: Look::combined
    double residual_limit = 0.0, volume_abs_change_limit_pct = 0.0;  // after the last iteration
    double residual_half = 0.0, volume_abs_change_half_pct = 0.0;    // after half of them: the limit is reached where it is the same
    int iterations = 0;                                              // the last one
};
extern const analysis::Columns<OrderRow> order_columns;

struct TargetRow {
    analysis::CaseKey of;
    std::string sequence;
    std::string target;  // residual_of_plain, volume_of_plain, volume_2_pct, volume_05_pct
    double bound = 0.0;  // a ratio, or per cent
    bool reached = false;
    std::optional<int> iterations = {};  // nothing if it was not reached
    std::optional<double> ms = {};       // those iterations in the median time of one
    double limit = 0.0;                  // the value that the order converges to
};
extern const analysis::Columns<TargetRow> target_columns;

// The first look at which the value is not above the bound.
std::optional<int> first_within(const IterationPath& path, double Look::*value, double bound);

// One row per order, precision and sequence. of: body, motion, angle or pose.
std::vector<OrderRow> order_rows(const analysis::CaseKey& of, const std::vector<MeasuredOrder>& measured);

// One row per order, precision, sequence and target. std::logic_error without `plain` in file order.
std::vector<TargetRow> target_rows(const analysis::CaseKey& of, const std::vector<MeasuredOrder>& measured);

}  // namespace experiments
