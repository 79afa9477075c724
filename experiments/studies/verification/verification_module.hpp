// The verification's entry into the module lib/libpbskin_fem.so, which carries deal.II.
#pragma once

#include "experiments/studies/verification/problem.hpp"

extern "C" const std::vector<experiments::VerificationProblem>* pbskin_verification_problems();
