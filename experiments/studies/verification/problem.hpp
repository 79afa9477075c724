// The problems that verify the reference. A new problem is a function that returns its rows, and one line in problem_list.cpp.
#pragma once

#include "pbs/character/character.hpp"
#include "reference_fem/verification/verification_record.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

using reference_fem::VerificationRow;
using reference_fem::VerificationRows;

struct Effort : reference_fem::Effort {
    // The built-in limb with about this number of vertices (0: its default), its tets cut into eight this number of times. The caller
    // meshes it, since only the caller links CGAL. Problems that need the limb have no rows where the function is empty.
    std::function<pbs::Character(int vertices, int refinements)> limb = {};
};

// The problems that need a character or PBS; reference_fem/verification/problems.hpp declares the others.
VerificationRows attached_limb_rows(const Effort& effort);
VerificationRows error_split_rows(const Effort& effort);
VerificationRows grid_convergence_rows(const Effort& effort);
VerificationRows nested_convergence_rows(const Effort& effort);
VerificationRows pbs_locking_rows(const Effort& effort);
VerificationRows calculix_rows(const Effort& effort);

struct VerificationProblem {
    std::string name;        // README.md states its truth
    double quick_s, full_s;  // expected time on one core
    std::function<VerificationRows(const Effort& effort)> rows;
};
const std::vector<VerificationProblem>& verification_problems();

}  // namespace experiments

// The verification's entry into the module lib/libpbskin_fem.so, which carries deal.II.
extern "C" const std::vector<experiments::VerificationProblem>* pbskin_verification_problems();
