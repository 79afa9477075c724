// improvements.md: which change has the largest mean gain in each group of poses at each budget, in sentences and tables.
//   finished.write("improvements.md", gains_page(gains_of(rows)));
#pragma once

#include "experiments/studies/work_precision/gains.hpp"

namespace experiments {

// gains: as gains_of returns them.
std::string gains_page(const std::vector<GainRow>& gains);

}  // namespace experiments
