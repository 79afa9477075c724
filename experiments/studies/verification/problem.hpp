// The problems that verify the reference. A new one is a function that returns its rows and one line in problem_list.cpp.
#pragma once

#include "pbs/character/character.hpp"
#include "reference_fem/verification/effort.hpp"

#include <functional>
#include <string>
#include <vector>

namespace experiments {

using reference_fem::VerificationRow;
using reference_fem::VerificationRows;

struct Effort : reference_fem::Effort {
    // The built-in limb of about so many vertices (0: its default), its tets cut into eight so many times. The caller meshes it, since only
    // the caller links CGAL. Empty: no limb.
    std::function<pbs::Character(int vertices, int refinements)> limb = {};
};

// Those that need a character or another program; the others are declared in reference_fem/verification/common.hpp.
VerificationRows attached_limb_rows(const Effort& effort);
VerificationRows error_split_rows(const Effort& effort);
VerificationRows grid_convergence_rows(const Effort& effort);
VerificationRows pbs_locking_rows(const Effort& effort);
VerificationRows calculix_rows(const Effort& effort);
VerificationRows distributed_rows(const Effort& effort);

struct VerificationProblem {
    std::string name, meaning;
    double quick_s, full_s;  // expected, on one core
    std::function<VerificationRows(const Effort& effort)> rows;
};
const std::vector<VerificationProblem>& verification_problems();

}  // namespace experiments
