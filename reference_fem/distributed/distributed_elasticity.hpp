// The linear reference beyond one machine: the same elements, loads and attachment as LinearElasticity, on a mesh spread over MPI ranks
// (deal.II's fully distributed triangulation), solved by conjugate gradients with Trilinos ML's smoothed aggregation.
//   MpiSession session(argc, argv);
//   const ElasticSolution solution = solve_distributed(mesh, problem);   // by all ranks at once, with the same arguments
//   solution.summary.converged; solution.displacement;
// The header is plain; deal.II is seen by the .cpp files alone.
#pragma once

#include "reference_fem/distributed/elastic_problem.hpp"
#include "reference_fem/iterative_options.hpp"

namespace reference_fem {

// pbs::InputError, on every rank alike, where check_problem finds one. Not converging is reported, not thrown.
ElasticSolution solve_distributed(const pbs::TetMesh& mesh, const ElasticProblem& problem, const IterativeOptions& options = {});

}  // namespace reference_fem
