// A linear elastic body with what holds and loads it, as arrays that can be sent between processes, and its solution in
// a form that does not depend on how many processes found it.
#pragma once

#include "pbs/geometry/cost.hpp"
#include "pbs/geometry/tet_mesh.hpp"
#include "reference_fem/attachment.hpp"
#include "reference_fem/linear_elasticity.hpp"
#include "reference_fem/options.hpp"

#include <ctime>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace reference_fem {

// Seconds of one phase: on the wall, and of this process's processor time. On a machine that others use the latter is
// the one to compare; a rank that waits for another polls, so its waiting counts in both. cpu_s is the sum over the
// threads of the process.
struct PhaseTime {
    double wall_s = 0.0, cpu_s = 0.0;  // [s]
};

// Starts when it is made.
class PhaseClock {
public:
    // since the start; the clock runs on
    PhaseTime elapsed() const { return {wall_.seconds(), processor_seconds() - start_}; }

private:
    static double processor_seconds()
    {
        std::timespec time{};
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }

    pbs::Stopwatch wall_;
    double start_ = processor_seconds();
};

// The same arrays on every rank.
struct ElasticProblem {
    LinearOptions options;  // its solver is for solve_serially; the formulation is `displacement`, whatever it says
    std::vector<int> held_vertices;             // a boundary triangle with all three corners among them stays at rest
    std::vector<int> pulled_vertices;           // ... bears the traction, unless it is held
    pbs::Vec3 traction_pa = pbs::Vec3::Zero();  // [N/m^2]
    Attachment attachment;                      // the skeleton's springs and prescribed tets, as in LinearElasticity
    pbs::Positions spring_targets;              // [m], #S x 3
    pbs::Positions
        vertex_targets;  // [m], #V x 3, read at the vertices of prescribed tets only; may be empty without them
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
    double relative_residual = 0.0;  // |K u - f| / |f| over the free degrees of freedom, recomputed from the solution
    bool converged = false;          // false: the displacement is whatever was reached, or not finite
    double compliance_j = 0.0;       // load times displacement; the springs' pull counts as load
};

// On rank 0; empty on the others.
struct ElasticSolution {
    pbs::Edges
        nodes;  // the two vertices a node lies halfway between, a vertex twice for itself; increasing, #nodes x 2
    pbs::Positions displacement;  // [m], #nodes x 3
    ElasticSummary summary;       // on every rank
};

// pbs::InputError where an option, the mesh or the problem is out of bounds, or nothing holds a part of the mesh.
void check_problem(const pbs::TetMesh& mesh, const ElasticProblem& problem);

// The most memory this process has had resident, as the kernel counts it (VmHWM).
// In units of 2^20 bytes, since the process began; it never decreases.
double peak_memory_mb();

// The nodes of prescribed tets, named by the two vertices they lie halfway between, and where they go.
// The set of those nodes, over prescribed_tets of an attachment.
class PrescribedNodes {
public:
    // The mesh and the targets [m], #V x 3, outlive it.
    PrescribedNodes(const pbs::TetMesh& mesh, const Attachment& attachment, const pbs::Positions& vertex_targets);

    // [m], the mean of its ends' for a mid-edge node; nothing where no prescribed tet has the node. ends: lower first,
    // a vertex twice for itself.
    std::optional<pbs::Vec3> displacement(const std::pair<int, int>& ends) const;

private:
    const pbs::TetMesh& mesh_;
    const pbs::Positions& vertex_targets_;
    std::set<std::pair<int, int>> nodes_;
};

// MPI for the whole life of a program, and the data that ranks exchange before there is a distributed mesh. This header
// includes no MPI.
//   MpiSession session(argv);
//   if (session.rank() == 0) mesh = read_tet_mesh(file).mesh;
//   session.broadcast(mesh.rest);
// One a program, over MPI_COMM_WORLD; its end ends MPI.
class MpiSession {
public:
    explicit MpiSession(char** argv);  // of main; one thread a rank
    ~MpiSession();

    int rank() const;                                // from 0
    int ranks() const;                               // all of MPI_COMM_WORLD
    [[noreturn]] void abort(int exit_status) const;  // ends all ranks: for an error that one of them met alone

    // Sends from rank 0 to all; called by all ranks. The arrays of the others take the size of rank 0's.
    void broadcast(std::string& text) const;
    void broadcast(std::vector<int>& values) const;  // of any length
    void broadcast(Eigen::VectorXd& values) const;   // to the bit
    void broadcast(pbs::Positions& points) const;    // #P x 3
    void broadcast(pbs::Tets& tets) const;           // #T x 4

private:
    class Implementation;
    std::unique_ptr<Implementation> implementation_;
};

// The linear reference beyond one machine: the same elements, loads and attachment as LinearElasticity, on a mesh
// spread over MPI ranks (deal.II's fully distributed triangulation), solved by conjugate gradients with Trilinos ML's
// smoothed aggregation.
//   MpiSession session(argv);
//   const ElasticSolution solution = solve_distributed(mesh, problem);   // by all ranks at once, with the same
//   arguments solution.summary.converged; solution.displacement;
// The header is plain; deal.II is seen by the .cpp files alone.
// pbs::InputError, on every rank alike, where check_problem finds one. Not converging is reported, not thrown.
ElasticSolution solve_distributed(const pbs::TetMesh& mesh, const ElasticProblem& problem,
                                  const IterativeOptions& options = {});

// The distributed problem solved by the serial reference (SimplexSpace, its assembly and its solvers), to compare the
// distributed solution with. Solves with problem.options.solver, on this process alone. pbs::InputError where
// check_problem finds one; a singular matrix, or not converging, is reported: converged = false.
ElasticSolution solve_serially(const pbs::TetMesh& mesh, const ElasticProblem& problem);

}  // namespace reference_fem
