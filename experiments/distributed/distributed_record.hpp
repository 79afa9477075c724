// The records of pbskin_distributed: record.json and, if asked for, nodes.csv.
#pragma once

#include "analysis/records/tables.hpp"
#include "experiments/distributed/loaded_body.hpp"
#include "reference_fem/options.hpp"

#include <nlohmann/json_fwd.hpp>

namespace experiments {

// Everything that a solution depends on.
struct DistributedSettings {
    BodyArguments body;
    reference_fem::LinearOptions elastic{.element_order = 1, .poisson = 0.3};
    reference_fem::IterativeOptions iterative;
    bool serial = false;  // on one process, by the serial reference
};
nlohmann::json to_json(const DistributedSettings& settings);

nlohmann::json to_json(const DistributedSettings& settings, const LoadedBody& body, const reference_fem::ElasticSolution& solution);

struct DisplacedNode {
    int first = 0, second = 0;
    pbs::Vec3 displacement_m;
};
extern const analysis::Columns<DisplacedNode> node_columns;  // nodes.csv

void write_nodes(const std::string& path, const reference_fem::ElasticSolution& solution);

}  // namespace experiments
