// An elastic problem as an input deck of CalculiX 2.20 (G. Dhondt, CalculiX CrunchiX User's Manual; Debian's calculix-ccx).
//   write_calculix_deck(stream, problem, {});
// Elements C3D4 and C3D10, nodes and tets numbered from 1 in our order. A node that is held is held in all three components.
// Springs at points of the flesh are written as the equivalent ones (equivalent_springs.hpp). Each has a node behind the problem's own ones
// as its end, which *EQUATION ties to the nodes of its tet, and three elements SPRING1, springs to ground.
#pragma once

#include "reference_fem/verification/calculix/nodal_problem.hpp"

#include <iosfwd>
#include <string>

namespace reference_fem {

enum class CalculixAnalysis {
    linear,
    // NLGEOM: second Piola-Kirchhoff stress linear in the Green-Lagrange strain, the law of St Venant and Kirchhoff. Data grow linearly
    // with the fraction of the step.
    large_strain,
    none,  // nodes, tets and material without a step: the cost of reading
};

struct DeckOptions {
    CalculixAnalysis analysis = CalculixAnalysis::linear;
    double first_increment = 0.1;  // of the step, where large_strain
    double residual = 1e-9;        // at which Newton stops, over the mean force, where large_strain
    bool restart_file = true;      // CalculiX prints 7 digits; its restart file holds displacements in double
};

void write_calculix_deck(std::ostream& deck, const NodalProblem& problem, const DeckOptions& options);

// The nearest number that fits in 20 characters, with at least 14 digits: CalculiX refuses or, worse, cuts what is longer.
std::string calculix_number(double value);

}  // namespace reference_fem
