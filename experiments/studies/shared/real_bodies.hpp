// The real bodies that claims about characters rest on: those installed here, and why the others are not.
//   for (const std::string& body : installed_bodies(plan.left_out)) ...
#pragma once

#include "analysis/case_record.hpp"

#include <string>
#include <vector>

namespace experiments {

// human, man, lady, frankie: every one whose files are there; the others are added to `left_out`, with what they need.
std::vector<std::string> installed_bodies(std::vector<analysis::LeftOut>& left_out);

}  // namespace experiments
