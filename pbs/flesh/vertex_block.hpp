// The energy of the flesh (flesh_energy.hpp) along one vertex. It is exactly quadratic: moving x_i by s adds g_i . s + s . H_i s / 2, with
//   g_i = a_i (x_i - c_i) + sum_tets [ sum_j w_ij (x_i - x_j) + kappa (6 V - d) n_i ],
//   H_i = (a_i + sum_tets sum_j w_ij) I + sum_tets kappa n_i n_i^T,
// where n_i, the gradient of 6 V in x_i, is twice the area of the opposite face times its normal, and does not depend on x_i.
//   const std::vector<VertexStar> stars = vertex_stars(energy);
//   x.row(i) -= block_step(vertex_block(stars[i], i, x, centres)).transpose();   // the minimum along vertex i
#pragma once

#include "pbs/flesh/flesh_energy.hpp"

#include <array>
#include <vector>

namespace pbs {

// A tet as one of its vertices meets it. The others are in the order in which n_i = (x_1 - x_0) x (x_2 - x_0).
struct IncidentTet {
    std::array<int, 3> other;
    std::array<double, 3> w;  // of the edges to them [m]
    double kappa;             // [1/m^3]
    double d;                 // [m^3]
};

// The tets around a vertex, in the order of the mesh. diagonal: a_i + sum_tets sum_j w_ij [m], which is the sum of mu V0 |grad N_i|^2 and
// k_s beta_i^2, and therefore above zero where there is a tet.
struct VertexStar {
    std::vector<IncidentTet> tets;
    double hold = 0.0;      // a_i [m]
    double diagonal = 0.0;  // [m]
};
std::vector<VertexStar> vertex_stars(const FleshEnergy& energy);  // #V

struct VertexBlock {
    Vec3 gradient;            // g_i [m^2]
    Eigen::Matrix3d hessian;  // H_i [m]
    double diagonal;          // the smallest eigenvalue that H_i can have [m]
};
VertexBlock vertex_block(const VertexStar& star, int vertex, const Positions& x, const Positions& centres);

// H_i^-1 g_i [m] by H = L D L^T; zero where the diagonal is not above zero, as at a vertex without tets. A pivot is a Schur complement of
// diagonal * I + sum kappa n n^T and at least the diagonal; rounding may not decrease it further.
Vec3 block_step(const VertexBlock& block);

}  // namespace pbs
