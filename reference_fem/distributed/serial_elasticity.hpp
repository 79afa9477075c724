// The distributed problem solved by the serial reference (SimplexSpace, its assembly and its solvers), to compare the distributed solution
// with.
#pragma once

#include "reference_fem/distributed/elastic_problem.hpp"

namespace reference_fem {

// Solves with problem.options.solver, on this process alone. pbs::InputError where check_problem finds one; a singular matrix, or not
// converging, is reported: converged = false.
ElasticSolution solve_serially(const pbs::TetMesh& mesh, const ElasticProblem& problem);

}  // namespace reference_fem
