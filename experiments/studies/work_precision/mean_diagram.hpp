// The mean of the diagrams of several poses: the settings that have an error in each of them, with the means of their times and errors.
//   diagrams.push_back(mean_diagram("human_mean_of_4_poses", "human, mean of 4 poses", poses));
#pragma once

#include "experiments/studies/work_precision/diagram.hpp"

#include <string>
#include <vector>

namespace experiments {

// poses: at least one diagram, all of the same comparison. key and name: those of the mean.
Diagram mean_diagram(const std::string& key, const std::string& name, const std::vector<Diagram>& poses);

}  // namespace experiments
