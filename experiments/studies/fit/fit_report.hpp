// The records of the fit put together: DIR/sag.csv, swing.csv, poisson.csv, poisson_poses.csv, valley.csv, and what they say: fit.json,
// fit.md and a text for the terminal.
#pragma once

#include "experiments/studies/finished_runs.hpp"
#include "experiments/studies/fit/poisson_fit.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace experiments {

nlohmann::json to_json(const ElasticPoses& elastic);  // what did not converge, and how well the rest is interpolated

// Returns the text for the terminal.
std::string write_fit_report(const FinishedRuns& finished);

}  // namespace experiments
