// The elements of a space as arrays: what an energy over the tets needs of deal.II, computed once. On straight tets the gradients are
// those of the rest configuration (total Lagrangian).
#pragma once

#include "reference_fem/simplex_space.hpp"

#include <vector>

namespace reference_fem {

// Quadrature point q of tet t has the index t * points_per_tet + q.
struct ElementTables {
    int nodes_per_tet = 0, points_per_tet = 0;  // nodes: 4 or 10
    Eigen::VectorXd weights;                    // [m^3], #T * points: quadrature weight times Jacobian
    pbs::Positions shape_gradients;             // d N_a / d X [1/m], (#T * points * nodes) x 3

    // The nodes' gradients at point q of a tet, nodes x 3.
    auto gradients(Eigen::Index tet, int q) const
    {
        return shape_gradients.middleRows((tet * points_per_tet + q) * nodes_per_tet, nodes_per_tet);
    }
    double weight(Eigen::Index tet, int q) const { return weights(tet * points_per_tet + q); }  // [m^3]
};

// Quadrature with `points_1d` points a direction: exact to degree 2 points_1d - 1; 1 to 4.
ElementTables element_tables(const SimplexSpace& space, int points_1d);

// Any rule: points by their coordinates on corners 2, 3, 4; the weights add up to 1/6, the volume of the unit tet.
struct TetQuadrature {
    pbs::Positions points;    // #points x 3
    Eigen::VectorXd weights;  // #points
};
ElementTables element_tables(const SimplexSpace& space, const TetQuadrature& quadrature);  // any number of points; ElasticPotential takes 6

}  // namespace reference_fem
