// The name of a pose's run, and of its diagram in the tables: limb_twist_90, human_crouch.
#pragma once

#include "analysis/verdicts/case_record.hpp"

#include <string>

namespace experiments {

// body_motion_angle if the pose is an angle, otherwise body_pose.
std::string case_name(const analysis::CaseKey& of);

}  // namespace experiments
