// The bodies of pbskin_distributed: tets with what holds and loads them.
#pragma once

#include "reference_fem/distributed/elastic_problem.hpp"
#include "reference_fem/distributed/mpi_session.hpp"

#include <limits>
#include <string>

namespace experiments {

struct BodyArguments {
    int bar_tets = 0;       // cantilever [0, 10] x [0, 1]^2 m, of about so many tets
    int limb_vertices = 0;  // the built-in limb, held by the skeleton's springs as LinearElasticity is
    std::string mesh_file;  // a tet mesh, held and pulled as the bar is
    double held_below_m = std::numeric_limits<double>::quiet_NaN();    // bar and file: boundary triangles with x <= this are held; not a
                                                                       // number: those at the lowest x
    double pulled_above_m = std::numeric_limits<double>::quiet_NaN();  // and those with x >= this pulled; or at the highest x
    pbs::Vec3 traction_pa = pbs::Vec3::Zero();
    double twist_deg = 0.0, bend_deg = 0.0;  // of the limb's forearm, about x and z
};

struct LoadedBody {
    std::string name;
    pbs::TetMesh mesh;
    reference_fem::ElasticProblem problem;
};

// pbs::InputError where the file cannot be read or no body, or more than one, is asked for.
LoadedBody load_body(const BodyArguments& arguments, const reference_fem::LinearOptions& options);

// From rank 0 to all; options are not sent.
void broadcast(const reference_fem::MpiSession& session, LoadedBody& body);

}  // namespace experiments
