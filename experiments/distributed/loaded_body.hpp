// The bodies of pbskin_distributed: tets with their supports and loads.
#pragma once

#include "experiments/deformers/fem/fem_options.hpp"
#include "reference_fem/distributed/elastic_problem.hpp"

#include <limits>
#include <optional>
#include <string>

namespace experiments {

struct BodyArguments {
    // One of these. A file is held and pulled like the bar.
    int bar_tets = 0;       // a cantilever [0, 10] x [0, 1]^2 m of about this number of tets
    int limb_vertices = 0;  // the built-in limb, held by its bones with the smooth attachment of the reference
    std::string mesh_file;  // a tet mesh

    // Bar and file: vertices with x <= held_below_m are held, and those with x >= pulled_above_m are pulled. NaN: the lowest, the highest
    // x.
    double held_below_m = std::numeric_limits<double>::quiet_NaN();
    double pulled_above_m = std::numeric_limits<double>::quiet_NaN();
    pbs::Vec3 traction_pa = pbs::Vec3::Zero();
    double twist_deg = 0.0, bend_deg = 0.0;  // of the forearm of the limb, about x and z
};

struct LoadedBody {
    std::string name;
    pbs::TetMesh mesh;
    reference_fem::ElasticProblem problem;
    std::optional<FemOptions> held_by = {};  // the options of the attachment to bones; nothing if the body has none. On rank 0 only
};

// pbs::InputError if the file cannot be read, or if not exactly one body is asked for.
LoadedBody load_body(const BodyArguments& arguments, const reference_fem::LinearOptions& options);

// Sends the body from rank 0 to all ranks, without its options.
void broadcast(const reference_fem::MpiSession& session, LoadedBody& body);

}  // namespace experiments
