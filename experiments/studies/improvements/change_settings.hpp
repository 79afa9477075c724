// The changes to PBS that the study compares, each with a few settings of its own parameter. Everything else is that of the scene.
//   for (const ChangeSetting& setting : change_settings(options, edge_lengths_m, RangeOfChanges{})) ...
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
    std::string setting;  // of its parameter, as it is recorded: k_bind_0.02; empty: it has none
    pbs::WeightKind weights = pbs::WeightKind::paper;
    pbs::PbsOptions options;
};

struct RangeOfChanges {
    std::vector<int> iterations = {1, 2, 4, 8, 16, 24, 48, 96};
    std::vector<double> k_bind_to_blended = {0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2};
    std::vector<int> region_tets = {16, 64, 256, 1024};
    std::vector<double> k_stretch = {0.05, 0.1, 0.5, 0.9};
    std::vector<double> k_bind = {0.1, 0.5};
};
nlohmann::json to_json(const RangeOfChanges& range);

// Every setting once, without its iterations. edge_lengths_m: rest lengths of the mesh's edges.
std::vector<ChangeSetting> change_settings(const pbs::PbsOptions& scene, const std::vector<double>& edge_lengths_m,
                                           const RangeOfChanges& range);

// The length at which an edge has the stiffness k, so that the mean over all edges is k too: then the scaling softens long edges and
// stiffens short ones, and the mesh as a whole is neither softer nor stiffer. By bisection, to 1e-12 of the longest edge; 0 < k < 1, some
// edges.
double neutral_length(double k, const std::vector<double>& edge_lengths_m);

}  // namespace experiments
