// How the cost of a step grows with the mesh: ms_step = c (number of constraints)^exponent, over bodies of growing size.
#pragma once

#include "analysis/line_fit.hpp"
#include "experiments/studies/bench/mesh_timings.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

struct ScalingFit {
    std::string variant, precision;
    int threads = 1;
    analysis::Interval exponent;  // 95 %; bounds are NaN for two sizes
};

// One a variant, precision and number of threads that all meshes have; none for fewer than two meshes.
std::vector<ScalingFit> fit_scaling(const std::vector<MeshTimings>& meshes);

void to_json(nlohmann::json& json, const ScalingFit& fit);

}  // namespace experiments
