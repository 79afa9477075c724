// What the records of the jiggle study's runs say, as Markdown tables.
//   const std::string text = jiggle_report(run);
#pragma once

#include <string>

namespace experiments {

// run: folder of one that ended. A jolt: what the zone is, and a line a setting; a walk: a line a stiffness.
std::string jiggle_report(const std::string& run);

}  // namespace experiments
