// The page work_precision.md and the text for the terminal.
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"
#include "experiments/studies/work_precision/diagram_tables.hpp"

namespace experiments {

struct ComparisonRecords {
    std::vector<CaseRecords> cases;
    std::vector<ChosenSetting> chosen;
    std::vector<Diagram> diagrams;
    std::vector<Omission> omissions;
};

std::string page_of(const ComparisonRecords& records);

// For each comparison: the nearest group within each budget, over the mean of the evaluated poses or the only one of them.
std::string terminal_text(const ComparisonRecords& records);

}  // namespace experiments
