// The records of the fit put together: DIR/sag.csv, swing.csv, poisson.csv, poisson_poses.csv, valley.csv, and what they say: fit.json,
// fit.md and a text for the terminal.
#pragma once

#include "experiments/studies/fit/poisson_fit.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

nlohmann::json to_json(const ElasticPoses& elastic);  // what did not converge, and how well the rest is interpolated

// Of the study's folder and the folders of its runs that ended; what belongs on the terminal.
std::string write_fit_report(const std::string& folder, const std::vector<std::string>& finished);

}  // namespace experiments
