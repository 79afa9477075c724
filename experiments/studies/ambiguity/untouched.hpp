// Which claims a reading cannot change, and why: by how their figures are measured, not by what comes out.
//   const std::string reason = untouched_because("C10", reading, baseline);   // empty: it may
#pragma once

#include "experiments/studies/ambiguity/reading.hpp"

namespace experiments {

std::string untouched_because(const std::string& claim, const Reading& reading, const Reading& baseline);

}  // namespace experiments
