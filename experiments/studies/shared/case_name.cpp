#include "experiments/studies/shared/case_name.hpp"

#include <fmt/format.h>

namespace experiments {

std::string case_name(const analysis::CaseKey& of)
{
    return of.angle_deg ? fmt::format("{}_{}_{:g}", of.body, of.motion, *of.angle_deg) : of.body + "_" + of.pose;
}

}  // namespace experiments
