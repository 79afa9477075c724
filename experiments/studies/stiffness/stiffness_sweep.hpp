// One run of the stiffness study: one body, and one thing that is varied.
#pragma once

#include "experiments/studies/stiffness/stiffness_ratios.hpp"

namespace experiments {

struct StiffnessSweep {
    Varied varied = Varied::iterations;
    std::string body;
    bool full = false;
    std::vector<int> vertices = {0};  // 0: the body's own size
};
nlohmann::json to_json(const StiffnessSweep& sweep);

// Writes stiffness.csv and measurements.csv.
std::string record_stiffness(const StiffnessSweep& sweep, const std::string& folder);

}  // namespace experiments
