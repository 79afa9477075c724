// What pbskin_distributed writes: record.json and, where asked, nodes.csv.
#pragma once

#include "experiments/distributed/loaded_body.hpp"

#include <nlohmann/json_fwd.hpp>

namespace experiments {

nlohmann::json to_json(const LoadedBody& body, const reference_fem::ElasticSolution& solution);

// first,second,x_m,y_m,z_m: a node by the two vertices it lies halfway between, and its displacement.
void write_nodes(const std::string& path, const reference_fem::ElasticSolution& solution);

}  // namespace experiments
