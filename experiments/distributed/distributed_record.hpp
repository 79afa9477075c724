// The records of pbskin_distributed: record.json and, if asked for, nodes.csv.
#pragma once

#include "analysis/records/typed_table.hpp"
#include "experiments/distributed/loaded_body.hpp"

#include <nlohmann/json_fwd.hpp>

namespace experiments {

nlohmann::json to_json(const LoadedBody& body, const reference_fem::ElasticSolution& solution);

struct DisplacedNode {
    int first = 0, second = 0;
    pbs::Vec3 displacement_m;
};
extern const analysis::Columns<DisplacedNode> node_columns;  // nodes.csv

void write_nodes(const std::string& path, const reference_fem::ElasticSolution& solution);

}  // namespace experiments
