// The changes to PBS that the study compares, each with a few settings of its own parameter. Everything else is that of the scene.
//   for (const ChangeSetting& setting : change_settings(options, mean_edge_m, RangeOfChanges{})) ...
#pragma once

#include "pbs/character/character.hpp"
#include "pbs/solver/options.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace experiments {

inline const std::string baseline = "pbs";               // the scene's PBS, with which each change is compared
inline const std::string control = "other_stiffnesses";  // no change to the method: other values of its k_stretch and k_bind

struct ChangeSetting {
    std::string change;   // pbs, smooth_weights, bind_to_blended_position, region_volumes, k_by_edge_length, another_order, ...
    std::string setting;  // of its parameter, as it is recorded; empty: it has none
    pbs::WeightKind weights = pbs::WeightKind::paper;
    pbs::PbsOptions options;
};

struct RangeOfChanges {
    std::vector<int> iterations = {1, 2, 4, 8, 16, 24, 48, 96};
    std::vector<double> k_bind_to_blended = {0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2};
    std::vector<int> region_tets = {16, 64, 256, 1024};
    std::vector<double> edge_lengths = {0.5, 1.0, 2.0};  // at which k_stretch holds, over the mean edge
    std::vector<double> k_stretch = {0.05, 0.1, 0.5, 0.9};
    std::vector<double> k_bind = {0.1, 0.5};
};
nlohmann::json to_json(const RangeOfChanges& range);

// Every setting once, without its iterations. mean_edge_m: mean rest length of the mesh's edges [m].
std::vector<ChangeSetting> change_settings(const pbs::PbsOptions& scene, double mean_edge_m, const RangeOfChanges& range);

}  // namespace experiments
