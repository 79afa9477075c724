// The first linear solve of a cantilever on the judge's side and on CalculiX's, in one run, one thread each, median over the repeats.
#pragma once

#include "experiments/second_opinion/second_opinion_cases.hpp"

#include <string>

namespace experiments {

struct FirstSolveTiming {
    int vertices = 0, dofs = 0, repeats = 0;
    double elements_s = 0.0;  // ours: triangulation, numbering of nodes
    double solve_s = 0.0;     // ours: stiffness, load, elimination, symbolic analysis, factor, solve
    double calculix_s = 0.0;  // CalculiX's wall time from process start to end: deck read, solved, 7 digits printed, no restart file
    double reading_s = 0.0;   // CalculiX's wall time for the same deck with *NO ANALYSIS: started, read, checked

    double ours_s() const { return elements_s + solve_s; }
    double speedup() const { return calculix_s / ours_s(); }
    double speedup_without_reading() const { return (calculix_s - reading_s) / ours_s(); }
};

// std::runtime_error where CalculiX does not finish.
FirstSolveTiming time_first_solve(const std::string& program, const pbs::TetMesh& mesh, int element_order, const Cantilever& cantilever,
                                  int repeats);

}  // namespace experiments
