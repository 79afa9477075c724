// A study: the runs whose records decide some claims. A new one is one file and one line in studies.cpp.
#pragma once

#include "analysis/case_record.hpp"
#include "experiments/scene.hpp"

#include <string>
#include <vector>

namespace experiments {

struct StudyRun {
    std::string name;  // its folder inside the study's
    Scene scene;
    double cost_s = 0.0;  // expected, on one core
};

struct StudyPlan {
    std::vector<StudyRun> runs;
    std::vector<analysis::LeftOut> left_out;  // what is not installed here
};

struct Study {
    std::string name, meaning, claims, cost;
    StudyPlan (*plan)(bool full);
};
const std::vector<Study>& studies();

StudyPlan plan_volume_study(bool full);

}  // namespace experiments
