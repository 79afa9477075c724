// The positions that the skeleton prescribes, as arrays, and the report of a solver's set-up.
#pragma once

#include "pbs/geometry/tet_mesh.hpp"

#include <string>
#include <vector>

namespace reference_fem {

// Springs tie material points to targets. Every node of a prescribed tet is at its target. The bind constraint keeps vertices at a distance
// from moving points, by the energy sum_i k_i / 2 (|x_i - q_i| - d_i)^2.
struct Attachment {
    pbs::Positions spring_points = {};      // rest points [m], #S x 3; a point outside the tets is left out and counted
    Eigen::VectorXd spring_stiffness = {};  // [N/m], #S
    // All nodes of these tets are held. A mid-edge node follows the mean of its edge's ends, which is exact for affine targets.
    std::vector<int> prescribed_tets = {};
    Eigen::VectorXd bind_distance = {};   // d_i [m], #V, or empty: nothing is bound. Not for LinearElasticity
    Eigen::VectorXd bind_stiffness = {};  // k_i [N/m], #V; 0: this vertex is not bound
};

// For records: what was built, by which library, in how many seconds of wall time.
struct SetupSummary {
    int dofs = 0;  // number of unknowns, including prescribed ones and, with taylor_hood, one pressure per vertex
    double assemble_s = 0.0, analyse_s = 0.0, factor_s = 0.0;  // the last analysis and factor; assembly only of LinearElasticity, else 0
    std::string elements;                                      // e.g. "deal.II 9.4.1"
    std::string solver;                                        // e.g. "CHOLMOD 3.0.14 supernodal, METIS"
    std::string blas;                                          // the BLAS that was resolved
    bool factored = false;              // false: the matrix is singular in double; every solve then reports finite = false
    double reciprocal_condition = 0.0;  // the solver's own rough estimate
    std::vector<int> spring_tet;        // tet that holds each spring point, -1: outside
};

}  // namespace reference_fem
