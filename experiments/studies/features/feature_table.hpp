// The cost of features as a table: medians over rounds taken by turns, and the median of the ratios within a round, which what disturbs
// the machine disturbs less than a ratio of medians.
#pragma once

#include "analysis/records/csv_table.hpp"
#include "experiments/studies/shared/timed_rounds.hpp"
#include "experiments/studies/features/feature_cost.hpp"

#include <optional>
#include <string>
#include <vector>

namespace experiments {

struct FeatureRow {
    std::string scene, feature;
    std::vector<SceneCost> without, with;  // a round each, as many of both
    std::optional<AnswerChange> change;
};

// Of one figure of both runs in each round.
struct Compared {
    Spread without, with, ratio;  // ratio: with / without in the same round
};
Compared compare(const FeatureRow& row, double SceneCost::*figure);

analysis::CsvTable features_csv(const std::vector<FeatureRow>& rows);
std::string features_markdown(const analysis::CsvTable& table);  // of what features_csv wrote

}  // namespace experiments
