// The real bodies that claims about characters are measured on.
//   for_each_installed_body(plan.left_out, [&](const std::string& body) { plan.runs.push_back(run_of(body)); });
#pragma once

#include "analysis/verdicts/case_record.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

// Those of human, man, lady and frankie whose files are installed. The others are added to `left_out` with what they need.
std::vector<std::string> installed_bodies(std::vector<analysis::LeftOut>& left_out);

// Calls `plan` for each of them. A body that `plan` refuses by InputError, for example because a clip is missing, is left out too.
void for_each_installed_body(std::vector<analysis::LeftOut>& left_out, const std::function<void(const std::string& body)>& plan);

}  // namespace experiments
