// A cantilever under its weight and an end load: the reference's answer to it, and the time of its first linear solve.
#pragma once

#include "reference_fem/verification/calculix/nodal_problem.hpp"

#include <string>

namespace reference_fem {

// Nodes at the lowest x are held; the nodes at the highest x share the end load [N] equally.
struct LoadedCantilever {
    ElasticMaterial material;
    double density_kg_m3 = 1000.0;
    pbs::Vec3 gravity_m_s2 = pbs::Vec3::Zero(), end_load_n = pbs::Vec3::Zero();
};
NodalProblem cantilever_problem(const SimplexSpace& space, const LoadedCantilever& cantilever);
AnsweredProblem answered_cantilever(const pbs::TetMesh& mesh, int element_order, const LoadedCantilever& cantilever);

// Processor time of the first linear solve by the reference and by CalculiX.
struct FirstSolveTiming {
    int dofs = 0;
    double elements_s = 0.0;  // reference: triangulation, numbering of nodes
    double solve_s = 0.0;     // reference: stiffness, load, elimination, symbolic analysis, factor, solve
    double calculix_s = 0.0;  // CalculiX's whole process: deck read, solved, 7 digits printed, no restart file
    double reading_s = 0.0;   // CalculiX's process for a deck of the same nodes, tets and material without a step: started, read

    double speedup() const { return calculix_s / solve_s; }
    double speedup_with_elements() const { return calculix_s / (elements_s + solve_s); }
    double speedup_without_reading() const { return (calculix_s - reading_s) / solve_s; }
};

// Both solve in turn, with one thread each. Each time is the smallest of the repeats, which other work on the machine disturbed least;
// processor time is disturbed less than wall time. std::runtime_error where CalculiX does not finish.
FirstSolveTiming time_first_solve(const std::string& program, const pbs::TetMesh& mesh, int element_order,
                                  const LoadedCantilever& cantilever, int repeats);

}  // namespace reference_fem
