// A linear elastic body with what holds and loads it, as arrays that can be sent between processes, and its solution in a form that does
// not depend on how many processes found it.
#pragma once

#include "reference_fem/attachment.hpp"
#include "reference_fem/distributed/phase_clock.hpp"
#include "reference_fem/linear_elasticity.hpp"

namespace reference_fem {

// The same arrays on every rank.
struct ElasticProblem {
    LinearOptions options;                      // its solver is for solve_serially; the formulation is `displacement`, whatever it says
    std::vector<int> held_vertices;             // a boundary triangle with all three corners among them stays at rest
    std::vector<int> pulled_vertices;           // ... bears the traction, unless it is held
    pbs::Vec3 traction_pa = pbs::Vec3::Zero();  // [N/m^2]
    Attachment attachment;                      // the skeleton's springs and prescribed tets, as in LinearElasticity
    pbs::Positions spring_targets;              // [m], #S x 3
    pbs::Positions vertex_targets;              // [m], #V x 3, read at the vertices of prescribed tets only; may be empty without them
};

// The same values on every rank.
struct ElasticSummary {
    std::string solver;                                    // its name, of a direct one with the version
    int ranks = 1;                                         // MPI processes; 1 of solve_serially
    long long tets = 0, dofs = 0;                          // of the whole mesh; prescribed degrees of freedom count too
    long long tets_of_rank_min = 0, tets_of_rank_max = 0;  // that a rank owns: the fewest, the most
    PhaseTime mesh, assembly, setup, solve;                // of the slowest rank; setup: multigrid hierarchy, or factor
    double peak_mb = 0.0;                                  // as peak_memory_mb() of the rank that needed most
    int iterations = 0;                                    // of conjugate gradients; 0 of a direct solver
    double relative_residual = 0.0;                        // |K u - f| / |f| over the free degrees of freedom, recomputed from the solution
    bool converged = false;                                // false: the displacement is whatever was reached, or not finite
    double compliance_j = 0.0;                             // load times displacement; the springs' pull counts as load
};

// On rank 0; empty on the others.
struct ElasticSolution {
    pbs::Edges nodes;             // the two vertices a node lies halfway between, a vertex twice for itself; increasing, #nodes x 2
    pbs::Positions displacement;  // [m], #nodes x 3
    ElasticSummary summary;       // on every rank
};

// pbs::InputError where an option, the mesh or the problem is out of bounds, or nothing holds a part of the mesh.
void check_problem(const pbs::TetMesh& mesh, const ElasticProblem& problem);

}  // namespace reference_fem
