// The distributed problem by the serial judge: SimplexSpace, its assembly and its solvers. What the distributed solution is held against.
#pragma once

#include "reference_fem/distributed/elastic_problem.hpp"

namespace reference_fem {

// By problem.options.solver, on this process alone. pbs::InputError where check_problem finds one; a singular matrix, or not converging, is
// reported: converged = false.
ElasticSolution solve_serially(const pbs::TetMesh& mesh, const ElasticProblem& problem);

}  // namespace reference_fem
