// The problems that the judge is verified by. A new one is a function that returns its rows and one line in problem_list.cpp.
#pragma once

#include "reference_fem/verification/verification_row.hpp"

#include "pbs/character/character.hpp"

#include <functional>

namespace experiments {

struct Effort {
    bool full = false;          // the whole ladder of meshes
    double lambda_error = 0.0;  // for tests: a relative error in the solver's first Lame parameter, of which no reference knows
    // The built-in limb of about so many vertices, 0: its default, its tets cut into eight so many times; meshed by the caller, who has
    // CGAL. Empty: no limb.
    std::function<pbs::Character(int vertices, int refinements)> limb = {};
};

struct VerificationProblem {
    std::string name, meaning;
    double quick_s, full_s;  // expected, on one core
    VerificationRows (*rows)(const Effort& effort);
};
const std::vector<VerificationProblem>& verification_problems();

}  // namespace experiments
