// The first linear solve of a cantilever on the judge's side and on CalculiX's, in one run, one thread each, by turns. Processor time,
// which other work on the machine disturbs less than wall time; of the repeats the smallest, the one that was disturbed least.
#pragma once

#include "experiments/studies/verification/calculix/second_opinion_cases.hpp"

#include <string>

namespace experiments {

struct FirstSolveTiming {
    int dofs = 0;
    double elements_s = 0.0;  // ours: triangulation, numbering of nodes
    double solve_s = 0.0;     // ours: stiffness, load, elimination, symbolic analysis, factor, solve
    double calculix_s = 0.0;  // CalculiX's whole process: deck read, solved, 7 digits printed, no restart file
    double reading_s = 0.0;   // CalculiX's process for a deck of the same nodes, tets and material without a step: started, read

    double speedup() const { return calculix_s / solve_s; }
    double speedup_with_elements() const { return calculix_s / (elements_s + solve_s); }
    double speedup_without_reading() const { return (calculix_s - reading_s) / solve_s; }
};

// std::runtime_error where CalculiX does not finish.
FirstSolveTiming time_first_solve(const std::string& program, const pbs::TetMesh& mesh, int element_order,
                                  const LoadedCantilever& cantilever, int repeats);

}  // namespace experiments
