// How much of a verification problem to run, and with which deliberate error.
#pragma once

#include "reference_fem/verification/verification_row.hpp"

namespace reference_fem {

struct Effort {
    bool full = false;          // all meshes of the sequence
    double lambda_error = 0.0;  // for tests: a relative error of the solver's first Lame parameter, unknown to the reference values
};

}  // namespace reference_fem
