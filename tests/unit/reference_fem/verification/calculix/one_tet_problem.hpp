// One tet, P1 or P2, held at two nodes and loaded at a third: the smallest problem that uses every card.
#pragma once

#include "reference_fem/verification/calculix/nodal_problem.hpp"

namespace test_support {

inline reference_fem::NodalProblem one_tet_problem(int element_order)
{
    pbs::TetMesh mesh;
    mesh.rest.resize(4, 3);
    mesh.rest << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.1;
    mesh.tets.resize(1, 4);
    mesh.tets << 0, 1, 2, 3;
    auto problem = reference_fem::nodal_problem(reference_fem::SimplexSpace(mesh, element_order), {.young_pa = 2e5, .poisson = 0.25});
    problem.held[0] = problem.held[2] = true;
    problem.held_at.row(2) << 0.5, 0.0, -0.25;
    problem.forces_n.row(3) << 0.0, -1.5, 0.0;
    return problem;
}

}  // namespace test_support
