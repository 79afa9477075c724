// What each column of metrics.csv means: `pbskin list metrics`, `pbskin explain COLUMN`.
#pragma once

#include <string>
#include <vector>

namespace experiments {

struct MetricText {
    std::string name, unit, formula, meaning, source, cost;
};
const std::vector<MetricText>& metric_texts();

std::vector<std::string> symbols_of(const MetricText& metric);  // of its formula, each "name: what it is"

}  // namespace experiments
