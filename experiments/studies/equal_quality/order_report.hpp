// The conclusion of the study: each order is compared with `plain` after 24 iterations and at equal residuals and volume changes.
#pragma once

#include "experiments/studies/equal_quality/order_rows.hpp"

namespace experiments {

// One per case, order and precision, over file order and the random sequences.
struct OrderSummary {
    analysis::CaseKey of;
    double iteration_ms = 0.0;              // in file order
    double ratio_to_plain_spread = 0.0;     // time of an iteration of plain in the spread sequence over this one's
    double volume_abs_change_24_pct = 0.0;  // in file order
    double random_low_pct = 0.0, random_median_pct = 0.0, random_high_pct = 0.0;  // absolute volume change after 24 iterations
    double volume_to_random_plain = 0.0;       // in file order, over the median of plain in random sequences; above 1 it is a loss
    double residual_to_random_plain = 0.0;     // the same of the residual
    double volume_abs_change_limit_pct = 0.0;  // in file order
};
extern const analysis::Columns<OrderSummary> summary_columns;
std::vector<OrderSummary> summaries(const std::vector<OrderRow>& rows);

// One per case, order, precision and target. A speed-up is the ratio of the times to the target. There is none where either never
// reaches it.
struct EqualAnswer {
    analysis::CaseKey of;
    std::string target;
    double bound = 0.0;
    std::optional<int> iterations = {};  // in file order
    std::optional<double> ms = {};
    double limit = 0.0;
    int random_reached = 0, random = 0;                  // random sequences that reach it
    std::optional<double> random_median_ms = {};         // of all random sequences, if all reach it
    std::optional<double> speedup_to_plain = {};         // plain in file order
    std::optional<double> speedup_to_plain_spread = {};  // plain in the spread sequence
    std::optional<double> random_speedup_to_plain = {};  // medians of random sequences
};
extern const analysis::Columns<EqualAnswer> answer_columns;
std::vector<EqualAnswer> equal_answers(const std::vector<TargetRow>& rows);

// Both tables as Markdown, with a sentence on each.
std::string order_report(const std::vector<OrderSummary>& orders, const std::vector<EqualAnswer>& answers);

}  // namespace experiments
